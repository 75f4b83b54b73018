/* fuzz_irradiance_points.c - files of points at which to compute irradiance: any bytes give points with finite
 * positions and unit normals, or an error message. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "common/light/surface_points.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char folder[FUZZ_PATH], path[FUZZ_PATH + 64];
    struct surface_points points;
    struct err err = ERR_INIT;
    fuzz_folder(folder);
    snprintf(path, sizeof path, "%s/points.txt", folder);
    FILE *fp = fopen(path, "wb");
    if (!fp || fwrite(data, 1, size, fp) != size || fclose(fp)) abort();
    if (surface_points_read(&points, path, &err)) {
        if (!err.text[0] || points.list || points.count) abort();
    } else {
        if (points.count < 1) abort();
        for (int i = 0; i < points.count; i++) {
            const struct surface_point *p = &points.list[i];
            if (!isfinite(vec3_length(p->at)) || !(fabs(vec3_length(p->normal) - 1) < 1e-9)) abort();
        }
        surface_points_release(&points);
    }
    unlink(path);
    rmdir(folder);
    return 0;
}
