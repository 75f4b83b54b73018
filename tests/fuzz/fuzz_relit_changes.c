/* fuzz_relit_changes.c - relight --materials: any bytes give a picture of finite radiance, or an error with the
 * file. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/relight/integrals.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

enum { PIXELS = 3 }; /* of each surface one */

static void must(enum status st)
{
    if (st) abort();
}

/* A glossy material, a painted face and an object without light, under two lamps. */
static void make_integrals(struct exr_image *im)
{
    static const char *const groups[] = {"before", "after", "specular", "lamp0", "lamp1"};
    static const double values[5][PIXELS] = {{1, 1, 0}, {2, 1, 0}, {0.1, 0, 0}, {0.5, 0.1, 0}, {0, 0.2, 0}};
    struct err err = ERR_INIT;
    struct exr_plane *plane;
    char name[32];
    must(exr_image_init(im, PIXELS, 1, &err));
    for (int g = 0; g < 5; g++)
        for (int c = 0; c < 3; c++) {
            snprintf(name, sizeof name, "%s.%c", groups[g], "RGB"[c]);
            must(exr_add_plane(im, name, EXR_FLOAT, &plane, &err));
            for (int i = 0; i < PIXELS; i++) plane->f[i] = (float)values[g][i];
        }
    must(exr_add_plane(im, "surface", EXR_UINT, &plane, &err));
    for (uint32_t i = 0; i < PIXELS; i++) plane->u[i] = i + 1;
    must(exr_set_attribute(im, "remodel:lamp0", "spot", &err));
    must(exr_set_attribute(im, "remodel:lamp1", "ceiling lamp", &err));
    must(exr_set_attribute(im, "remodel:surface0", "material 0.05 0.2 0.1 0.1 floor", &err));
    must(exr_set_attribute(im, "remodel:surface1", "face 0 0.1 0.1 0.2 wall/west/in", &err));
    must(exr_set_attribute(im, "remodel:surface2", "object 0.1 0.1 0 0 vase", &err));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct exr_image integrals = {0};
    struct model_picture picture = {0};
    struct err err = ERR_INIT;

    make_integrals(&integrals);
    must(model_picture_resize(&picture, PIXELS, 1, &err));
    for (int i = 0; i < 3 * PIXELS; i++) picture.rgb[i] = 0.25F;
    fuzz_file(path, data, size);
    if (integrals_change(&picture, &integrals, path, &err)) {
        if (!strstr(err.text, path)) abort();
    } else {
        for (int i = 0; i < 3 * PIXELS; i++)
            if (!isfinite(picture.rgb[i]) || picture.rgb[i] < 0) abort();
    }
    model_picture_release(&picture);
    exr_image_release(&integrals);
    unlink(path);
    return 0;
}
