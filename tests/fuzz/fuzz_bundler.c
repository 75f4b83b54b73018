/* fuzz_bundler.c - Bundler's files: any bytes give a consistent model or an error. Each input is read with lists of 1,
 * 2 and 3 images. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/capture/sfm_model.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static const char *const names[] = {"b.jpg", "a.jpg", "c.jpg"};
static const int sizes[][2] = {{640, 480}, {480, 640}, {0, 0}};

static void check(const struct sfm_model *m)
{
    for (int i = 0; i < m->image_count; i++) {
        const struct camera *c = &m->cameras[m->images[i].camera_idx].camera;
        struct err err = ERR_INIT;
        if (camera_check(c, &err)) abort();
        for (int k = 0; k < m->images[i].observation_count; k++)
            if (!isfinite(m->images[i].observations[k].u) || !isfinite(m->images[i].observations[k].v)) abort();
    }
    for (int i = 0; i < m->point_count; i++)
        for (int k = 0; k < m->points[i].track_count; k++) {
            struct sfm_track t = m->points[i].track[k];
            if (t.image_idx < 0 || t.image_idx >= m->image_count) abort();
            if (m->images[t.image_idx].observations[t.observation_idx].point_id != m->points[i].id) abort();
        }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];

    fuzz_file(path, data, size);
    for (int count = 1; count <= 3; count++) {
        struct sfm_model m;
        struct err err = ERR_INIT;
        if (!sfm_model_read_bundler(&m, path, names, sizes, count, &err))
            check(&m);
        else if (!err.text[0] || m.images)
            abort();
        sfm_model_release(&m);
    }
    unlink(path);
    return 0;
}
