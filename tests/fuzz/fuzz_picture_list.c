/* fuzz_picture_list.c - reader of pictures.txt: any bytes give names, which are read back as written, or an error that
 * names the file. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/texture/picture_list.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char folder[FUZZ_PATH], path[FUZZ_PATH + 16];
    struct picture_list list = {0}, again = {0};
    struct provenance prov = {0};
    struct err err = ERR_INIT;

    fuzz_folder(folder);
    snprintf(path, sizeof path, "%s/pictures.txt", folder);
    FILE *f = fopen(path, "wb");
    if (!f || fwrite(data, 1, size, f) != size || fclose(f)) abort();
    if (picture_list_read(&list, folder, NULL, &err)) {
        if (!strstr(err.text, path)) abort();
    } else if (!picture_list_write(&list, folder, &prov, &err)) {
        if (picture_list_read(&again, folder, NULL, &err) || again.count != list.count) abort();
        for (int i = 0; i < list.count; i++)
            if (strcmp(list.names[i], again.names[i]) != 0) abort();
    }
    picture_list_release(&list);
    picture_list_release(&again);
    unlink(path);
    rmdir(folder);
    return 0;
}
