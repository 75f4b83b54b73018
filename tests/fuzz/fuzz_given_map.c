/* fuzz_given_map.c - depth of other programs as EXR, PFM, PNG or TIFF: any bytes give a map of the size that it states,
 * or an error that names the file. The first byte of the input chooses the extension. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/segment_depth/given_map.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const extensions[] = {"exr", "pfm", "png", "tiff"};
    char folder[FUZZ_PATH], path[FUZZ_PATH + 16], *found = NULL;
    struct given_map m = {0};
    struct err err = ERR_INIT;

    if (!size) return 0;
    fuzz_folder(folder);
    snprintf(path, sizeof path, "%s/v.%s", folder, extensions[data[0] % 4]);
    FILE *f = fopen(path, "wb");
    if (!f || fwrite(data + 1, 1, size - 1, f) != size - 1 || fclose(f)) abort();
    if (given_map_find(&found, folder, "v", &err) || !found || strcmp(found, path) != 0) abort();
    if (given_map_read(&m, found, &err)) {
        if (!strstr(err.text, path) || m.samples) abort();
    } else {
        if (m.width < 1 || m.height < 1) abort();
        for (size_t i = 0; i < (size_t)m.width * (size_t)m.height; i++)
            if (isinf(m.samples[i])) abort();
        if (given_map_clear_sentinel(&m, &err)) abort();
        given_map_release(&m);
    }
    free(found);
    unlink(path);
    rmdir(folder);
    return 0;
}
