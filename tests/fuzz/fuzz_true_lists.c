/* fuzz_true_lists.c - readers of faces.txt and of irradiance at points: any bytes give a sound list, or an error. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/evaluate/light/irradiance_list.h"
#include "stages/evaluate/truth/true_faces.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct true_faces faces;
    struct irradiance_list points;
    struct err err = ERR_INIT, why = ERR_INIT;

    fuzz_file(path, data, size);
    if (true_faces_read(&faces, path, &err)) {
        if (!strstr(err.text, path) || faces.count) abort();
    }
    for (int i = 0; i < faces.count; i++)
        if (!isfinite(faces.faces[i].normal.x)) abort();
    true_faces_release(&faces);
    if (irradiance_list_read(&points, path, &why)) {
        if (!strstr(why.text, path) || points.count) abort();
    }
    for (int i = 0; i < points.count; i++)
        if (!(fabs(vec3_length(points.points[i].normal) - 1) < 1e-9) || !(points.points[i].rgb[0] >= 0)) abort();
    irradiance_list_release(&points);
    unlink(path);
    return 0;
}
