/* fuzz_given_cameras.c - cameras in transforms.json, Metashape's XML, RealityScan's CSV and the list of images of a
 * Bundler model: any bytes give cameras that are valid, or an error. The first line of the input is the file's name. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "stages/sfm/bundler_model.h"
#include "stages/sfm/csv_model.h"
#include "stages/sfm/metashape_model.h"
#include "stages/sfm/transforms_model.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

static const char bundle[] = "# Bundle file v0.3\n2 0\n60 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 0\n"
                             "60 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0\n";

static enum status (*const readers[])(struct sfm_model *m, bool *found, const char *folder,
                                      const struct photo_list *photos, struct provenance *prov, struct err *err) = {
    transforms_model_read, metashape_model_read, csv_model_read, bundler_model_read};
static const char *const names[] = {"transforms.json", "cameras.xml", "cameras.csv", "images.lst"};

static void write_file(const char *folder, const char *name, const void *bytes, size_t size)
{
    char path[FUZZ_PATH + 64];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *fp = fopen(path, "wb");
    if (!fp || fwrite(bytes, 1, size, fp) != size || fclose(fp)) abort();
}

static void remove_file(const char *folder, const char *name)
{
    char path[FUZZ_PATH + 64];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    unlink(path);
}

static void check(const struct sfm_model *m)
{
    for (int i = 0; i < m->image_count; i++) {
        const struct quat q = m->images[i].cam_from_world.rotation;
        struct err err = ERR_INIT;
        if (!(fabs(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z - 1) < 1e-12)) abort();
        if (camera_check(&m->cameras[m->images[i].camera_idx].camera, &err)) abort();
        if (i && strcmp(m->images[i - 1].name, m->images[i].name) >= 0) abort();
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static char id[2][2] = {"a", "b"}, file[2][8] = {"a.jpg", "b.jpg"};
    struct photo_record records[2] = {{.id = id[0], .file = file[0], .info = {.width = 64, .height = 48}},
                                      {.id = id[1], .file = file[1], .info = {.width = 64, .height = 48}}};
    const struct photo_list photos = {records, 2};
    const uint8_t *end = memchr(data, '\n', size);
    char folder[FUZZ_PATH];
    if (!end) return 0;
    fuzz_folder(folder);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct sfm_model m;
        struct err err = ERR_INIT;
        bool found = false;
        if (strlen(names[i]) != (size_t)(end - data) || memcmp(names[i], data, (size_t)(end - data))) continue;
        write_file(folder, names[i], end + 1, size - (size_t)(end + 1 - data));
        if (i == 3) write_file(folder, "bundle.out", bundle, sizeof bundle - 1);
        if (!readers[i](&m, &found, folder, &photos, NULL, &err))
            check(&m);
        else if (!err.text[0] || m.images)
            abort();
        sfm_model_release(&m);
        remove_file(folder, names[i]);
        remove_file(folder, "bundle.out");
    }
    rmdir(folder);
    return 0;
}
