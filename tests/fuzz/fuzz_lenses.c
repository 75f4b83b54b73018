/* fuzz_lenses.c - the list of lenses: any bytes give lenses that can be written and read back, or an error; projection
 * through any of them gives a finite pixel or fails. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/capture/lens_list.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void use_lens(const struct camera *c)
{
    for (int i = 0; i <= 4; i++)
        for (int j = 0; j <= 4; j++) {
            struct vec3 ray = {0, 0, 0};
            double u = 0, v = 0;
            if (!camera_unproject(c, c->width * (i / 4.0), c->height * (j / 4.0), &ray)) continue;
            if (!(fabs(vec3_length(ray) - 1) < 1e-9)) abort();
            if (camera_project(c, ray, &u, &v) && (!isfinite(u) || !isfinite(v))) abort();
        }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct lens_list list, again;
    struct err err = ERR_INIT;

    fuzz_file(path, data, size);
    if (lens_list_read(&list, path, NULL, &err)) {
        if (!err.text[0] || list.lenses) abort();
    } else {
        for (int i = 0; i < list.count; i++) {
            use_lens(&list.lenses[i].camera);
            if (lens_list_find(&list, list.lenses[i].view) != i) abort();
        }
        if (!lens_list_write(&list, path, NULL, &err)) {
            if (lens_list_read(&again, path, NULL, &err) || again.count != list.count) abort();
            for (int i = 0; i < list.count; i++)
                if (strcmp(list.lenses[i].photo, again.lenses[i].photo) ||
                    memcmp(list.lenses[i].camera.params, again.lenses[i].camera.params,
                           sizeof list.lenses[i].camera.params))
                    abort();
            lens_list_release(&again);
        }
        lens_list_release(&list);
    }
    unlink(path);
    return 0;
}
