/* fuzz_place_list.c - reader of places.txt: any bytes give places of finite size, or an error that names the file. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/light_levels/place_list.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct place_list list = {0};
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (place_list_read(&list, path, NULL, &err)) {
        if (!strstr(err.text, path) || list.items || list.count) abort();
    } else {
        for (int i = 0; i < list.count; i++) {
            const struct light_place_mark *p = &list.items[i];
            if (!p->name || !*p->name || p->line < 1 || !isfinite(p->height)) abort();
            for (int k = 0; k < 2; k++)
                if (!isfinite(p->photo ? p->pixel[k] : p->at[k]) || !(p->size[k] >= 0) || !isfinite(p->size[k]))
                    abort();
            for (int k = 0; k < i; k++)
                if (!strcmp(list.items[k].name, p->name)) abort();
        }
        place_list_release(&list);
    }
    unlink(path);
    return 0;
}
