/* fuzz_lamp_indirect.c - reader of given indirect light: any bytes give finite irradiance at all points, or an
 * error. */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/fit_lights/indirect.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

enum { POINTS = 43 };

/* Two points, and a line of 41 points: five nodes. */
static void make_points(struct lit_point points[POINTS])
{
    for (int i = 0; i < POINTS; i++)
        points[i] = (struct lit_point){.at = {i < 2 ? i : 0.05 * (i - 2), 1, 0},
                                       .normal = {0, 0, 1},
                                       .kind = i < 2 ? NOTE_LIT : NOTE_LINE,
                                       .along = i < 2 ? 0 : (i - 2) / 40.0};
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct lit_point points[POINTS];
    const struct lit_scene scene = {.points = points, .point_count = POINTS};
    const struct model_axes axes = {.rotation = {1, 0, 0, 0}, .scale = 1};
    struct indirect in;
    struct err err = ERR_INIT;

    make_points(points);
    fuzz_file(path, data, size);
    if (indirect_init(&in, &scene, &err) || in.count != 5) abort();
    if (indirect_read(&in, &scene, &axes, path, NULL, &err)) {
        if (!strstr(err.text, path)) abort();
    } else {
        for (int i = 0; i < POINTS; i++)
            for (int c = 0; c < 3; c++)
                if (!(in.at[i][c] >= 0 && in.at[i][c] <= 1e30)) abort();
    }
    indirect_release(&in);
    unlink(path);
    return 0;
}
