/* fuzz_colmap_binary.c - COLMAP's binary models: any bytes give a consistent model or an error.
 *
 * The input is cameras.bin, images.bin and points3D.bin, each with the number of its bytes, 16 bits, in front; bytes
 * that are missing are no part of the files, and a points3D.bin of no bytes is missing. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/capture/sfm_model.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static char folder[FUZZ_PATH];
static const char *const names[] = {"cameras.bin", "images.bin", "points3D.bin"};

static void remove_files(void)
{
    char path[FUZZ_PATH + 64];
    for (int i = 0; i < 3; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        unlink(path);
    }
}

static void remove_folder(void)
{
    remove_files();
    rmdir(folder);
}

static void check(const struct sfm_model *m)
{
    for (int i = 0; i < m->image_count; i++) {
        const struct quat q = m->images[i].cam_from_world.rotation;
        if (m->images[i].camera_idx < 0 || m->images[i].camera_idx >= m->camera_count) abort();
        if (!(fabs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1) < 1e-12)) abort();
        if (i && strcmp(m->images[i - 1].name, m->images[i].name) >= 0) abort();
    }
    for (int i = 0; i < m->point_count; i++) {
        if (i && m->points[i - 1].id >= m->points[i].id) abort();
        for (int k = 0; k < m->points[i].track_count; k++) {
            const struct sfm_track t = m->points[i].track[k];
            if (t.image_idx < 0 || t.image_idx >= m->image_count) abort();
            if (m->images[t.image_idx].observations[t.observation_idx].point_id != m->points[i].id) abort();
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static int made;
    struct sfm_model m;
    struct err err = ERR_INIT;
    long long loose = 0;
    size_t at = 0;
    if (!made++) {
        fuzz_folder(folder);
        if (atexit(remove_folder)) abort();
    }
    remove_files();
    for (int part = 0; part < 3; part++) {
        char path[FUZZ_PATH + 64];
        size_t length = at + 2 <= size ? data[at] + 256U * data[at + 1] : 0;
        at += at + 2 <= size ? 2 : 0;
        if (length > size - at) length = size - at;
        snprintf(path, sizeof path, "%s/%s", folder, names[part]);
        FILE *fp = part == 2 && !length ? NULL : fopen(path, "wb");
        if (fp && (fwrite(data + at, 1, length, fp) != length || fclose(fp))) abort();
        at += length;
    }
    if (!sfm_model_read_given_binary(&m, folder, &loose, &err))
        check(&m);
    else if (!err.text[0] || m.images || m.cameras || m.points)
        abort();
    sfm_model_release(&m);
    return 0;
}
