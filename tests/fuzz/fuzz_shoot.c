/* fuzz_shoot.c - cameras.txt: any bytes give lenses whose rays project back to their pixels and poses with the given
 * positions, or an error message. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "stages/simulate/shoot_file.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static void check_lens(const struct shoot_lens *l)
{
    for (int i = 0; i <= 16; i++) {
        const double x = l->width * (i % 5 / 4.0), y = l->height * (i % 4 / 3.0);
        struct vec3 ray;
        double u, v;
        if (!shoot_lens_ray(l, x, y, &ray)) {
            if (!(l->circle > 0)) abort(); /* only an image circle leaves pixels out */
            continue;
        }
        if (!(fabs(vec3_length(ray) - 1) < 1e-9) || !shoot_lens_project(l, ray, &u, &v)) abort();
        if (!(fabs(u - x) < 1e-4 && fabs(v - y) < 1e-4)) abort();
    }
    const struct camera c = shoot_lens_camera(l);
    struct err err = ERR_INIT;
    if (camera_check(&c, &err)) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char folder[FUZZ_PATH], path[FUZZ_PATH + 64];
    struct shoot s;
    struct err err = ERR_INIT;
    fuzz_folder(folder);
    snprintf(path, sizeof path, "%s/cameras.txt", folder);
    FILE *fp = fopen(path, "wb");
    if (!fp || fwrite(data, 1, size, fp) != size || fclose(fp)) abort();
    if (shoot_read(&s, folder, 1, NULL, &err)) {
        if (!err.text[0] || s.photos) abort();
    } else {
        for (int i = 0; i < s.lens_count; i++) check_lens(&s.lenses[i]);
        for (int i = 0; i < s.photo_count; i++) {
            const struct vec3 c = pose_center(&s.photos[i].cam_from_world), at = s.photos[i].at;
            if (!(vec3_length(vec3_sub(c, at)) <= 1e-6 * (1 + vec3_length(at)))) abort();
            if (shoot_find(&s, s.photos[i].name) != i) abort();
        }
        shoot_release(&s);
    }
    unlink(path);
    rmdir(folder);
    return 0;
}
