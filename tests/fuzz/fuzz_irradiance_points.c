/* fuzz_irradiance_points.c - files of points at which to compute irradiance: any bytes give points with finite positions
 * and unit normals, or an error message. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "stages/simulate/irradiance.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char folder[FUZZ_PATH], path[FUZZ_PATH + 64];
    struct probe *list;
    struct err err = ERR_INIT;
    int count;
    fuzz_folder(folder);
    snprintf(path, sizeof path, "%s/points.txt", folder);
    FILE *fp = fopen(path, "wb");
    if (!fp || fwrite(data, 1, size, fp) != size || fclose(fp)) abort();
    if (irradiance_read_points(&list, &count, path, &err)) {
        if (!err.text[0] || list || count) abort();
    } else {
        if (count < 1) abort();
        for (int i = 0; i < count; i++)
            if (!isfinite(vec3_length(list[i].at)) || !(fabs(vec3_length(list[i].normal) - 1) < 1e-9)) abort();
        free(list);
    }
    unlink(path);
    rmdir(folder);
    return 0;
}
