/* fuzz_colmap.c - COLMAP's text models: any bytes give a consistent model that can be written and read back, or an
 * error.
 *
 * The input is cameras.txt, images.txt and points3D.txt, separated by lines "%%"; missing parts are empty. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/capture/sfm_model.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static char folder[FUZZ_PATH];
static const char *const names[] = {"cameras.txt", "images.txt", "points3D.txt"};

static void part_path(char *path, size_t size, int part) { snprintf(path, size, "%s/%s", folder, names[part]); }

static void remove_folder(void)
{
    char path[FUZZ_PATH + 64];
    for (int i = 0; i < 3; i++) {
        part_path(path, sizeof path, i);
        unlink(path);
    }
    rmdir(folder);
}

static void write_part(int part, const void *bytes, size_t size)
{
    char path[FUZZ_PATH + 64];
    part_path(path, sizeof path, part);
    FILE *fp = fopen(path, "wb");
    if (!fp || (size && fwrite(bytes, 1, size, fp) != size) || fclose(fp)) abort();
}

/* Indices are in range, tracks and observations refer to each other, rotations have length 1. */
static void check(const struct sfm_model *m)
{
    for (int i = 0; i < m->image_count; i++) {
        struct quat q = m->images[i].cam_from_world.rotation;
        if (m->images[i].camera_idx < 0 || m->images[i].camera_idx >= m->camera_count) abort();
        if (!(fabs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1) < 1e-12)) abort();
        if (i && strcmp(m->images[i - 1].name, m->images[i].name) >= 0) abort();
    }
    for (int i = 0; i < m->point_count; i++) {
        if (i && m->points[i - 1].id >= m->points[i].id) abort();
        for (int k = 0; k < m->points[i].track_count; k++) {
            struct sfm_track t = m->points[i].track[k];
            if (t.image_idx < 0 || t.image_idx >= m->image_count) abort();
            const struct sfm_image *im = &m->images[t.image_idx];
            if (t.observation_idx < 0 || t.observation_idx >= im->observation_count) abort();
            if (im->observations[t.observation_idx].point_id != m->points[i].id) abort();
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static int made;
    struct sfm_model m, again;
    struct err err = ERR_INIT;

    if (!made++) {
        fuzz_folder(folder);
        if (atexit(remove_folder)) abort();
    }
    size_t at = 0;
    for (int part = 0; part < 3; part++) {
        const uint8_t *end = part < 2 ? memmem(data + at, size - at, "%%\n", 3) : NULL;
        size_t length = end ? (size_t)(end - data) - at : size - at;
        write_part(part, data + at, length);
        at += length + (end ? 3 : 0);
    }
    if (sfm_model_read_text(&m, folder, NULL, &err)) {
        if (!err.text[0] || m.images || m.cameras || m.points) abort();
        return 0;
    }
    check(&m);
    if (!sfm_model_write_text(&m, folder, NULL, &err)) {
        if (sfm_model_read_text(&again, folder, NULL, &err)) abort();
        if (again.image_count != m.image_count || again.point_count != m.point_count ||
            again.camera_count != m.camera_count)
            abort();
        sfm_model_release(&again);
    }
    sfm_model_release(&m);
    return 0;
}
