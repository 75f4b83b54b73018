/* fuzz_sfm_import.c - the folder of structure-from-motion models: any bytes in it give views that later stages can
 * read, or an error.
 *
 * The input is models.txt, photos.txt and a model's cameras.txt, images.txt, points3D.txt, separated by lines "%%";
 * missing parts are replaced by valid ones. The photos are a, b and c, of 64 x 48. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/capture/camera_set.h"
#include "tests/fuzz/fuzz.h"
#include "tests/fuzz/fuzz_scratch.h"

/* files of a stage, which are not in the library */
#include "stages/sfm_import/choose_model.c"
#include "stages/sfm_import/import_model.c"
#include "stages/sfm_import/importer_photos.c"
#include "stages/sfm_import/importer_residuals.c"
#include "stages/sfm_import/lens_fit.c"
#include "stages/sfm_import/name_lines.c"
#include "stages/sfm_import/residual_table.c"
#include "stages/sfm_import/view_cameras.c"

static char folder[FUZZ_PATH];
enum { PARTS = 5, FILES = 10 };
static const char *const names[FILES] = {"models.txt",     "photos.txt",      "0/cameras.txt",  "0/images.txt",
                                         "0/points3D.txt", "out/cameras.txt", "out/images.txt", "out/points3D.txt",
                                         "out/lenses.txt", "out/views.mk"};
static const char *const valid[PARTS] = {
    "remodel-sfm 2\n0 colmap nothing\n",
    "a 00000000000000000000000000000000\nb 00000000000000000000000000000001\nc 2\n",
    "1 SIMPLE_RADIAL 64 48 60 32 24 -0.1\n",
    "1 1 0 0 0 0 0 0 1 a.jpg\n32 24 1\n2 1 0 0 0 -0.5 0 0 1 b.jpg\n17 24 1\n",
    "1 0 0 2 9 9 9 0.5 1 0 2 0\n",
};

static void in_folder(char *path, size_t size, const char *name) { snprintf(path, size, "%s/%s", folder, name); }

static void remove_folder(void)
{
    static const char *const folders[] = {"0", "out"};
    char path[FUZZ_PATH + 64];
    for (int i = 0; i < FILES; i++) {
        in_folder(path, sizeof path, names[i]);
        unlink(path);
    }
    for (int i = 0; i < 2; i++) {
        in_folder(path, sizeof path, folders[i]);
        rmdir(path);
    }
    rmdir(folder);
}

static void make_folder(void)
{
    char path[FUZZ_PATH + 64];
    fuzz_folder(folder);
    if (atexit(remove_folder)) abort();
    in_folder(path, sizeof path, "0");
    if (mkdir(path, 0777)) abort();
}

static void write_part(int part, const void *bytes, size_t size)
{
    char path[FUZZ_PATH + 64];
    in_folder(path, sizeof path, names[part]);
    FILE *fp = fopen(path, "wb");
    if (!fp || (size && fwrite(bytes, 1, size, fp) != size) || fclose(fp)) abort();
}

/* Later stages must read what was imported: cameras and lenses of the same views. */
static void check(const struct imported *in)
{
    char out[FUZZ_PATH + 64], lenses[FUZZ_PATH + 64];
    struct camera_set set;
    struct lens_list list;
    struct err err = ERR_INIT;
    in_folder(out, sizeof out, "out");
    in_folder(lenses, sizeof lenses, "out/lenses.txt");
    if (import_write(in, out, NULL, &err) || camera_set_read(&set, out, NULL, &err) ||
        lens_list_read(&list, lenses, NULL, &err)) {
        fprintf(stderr, "%s\n", err.text);
        abort();
    }
    if (set.view_count != list.count || set.view_count < 2) abort();
    for (int i = 0; i < set.view_count; i++) {
        const struct view *v = &set.views[i];
        if (strcmp(v->name, list.lenses[i].view) || !(v->fx > 0 && v->fy > 0)) abort();
        for (int k = 0; k < set.model.images[i].observation_count; k++) {
            const struct sfm_observation *o = &set.model.images[i].observations[k];
            if (!(o->u >= 0 && o->v >= 0 && o->u <= v->width && o->v <= v->height)) abort();
        }
    }
    camera_set_release(&set);
    lens_list_release(&list);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static int made;
    char text[6][8] = {"a", "a.jpg", "b", "b.jpg", "c", "c.jpg"};
    struct photo_record records[3] = {{0}};
    const struct photo_list photos = {records, 3};
    const struct sfm_import_params params = SFM_IMPORT_PARAMS_DEFAULT;
    struct sfm_model model;
    struct imported in;
    struct err err = ERR_INIT;
    enum given_cameras given;
    char *name = NULL;

    for (int i = 0; i < 3; i++) {
        records[i] =
            (struct photo_record){.id = text[2 * i], .file = text[2 * i + 1], .info = {.width = 64, .height = 48}};
        snprintf(records[i].hash, sizeof records[i].hash, "%032d", i);
    }
    if (!made++) make_folder();
    int part = 0;
    for (size_t at = 0; part < PARTS && at < size; part++) {
        const uint8_t *end = part < PARTS - 1 ? memmem(data + at, size - at, "%%\n", 3) : NULL;
        size_t length = end ? (size_t)(end - data) - at : size - at;
        write_part(part, data + at, length);
        at += length + (end ? 3 : 0);
    }
    for (; part < PARTS; part++) write_part(part, valid[part], strlen(valid[part]));

    if (import_check_photos(folder, &photos, &err) && !err.text[0]) abort();
    err = (struct err)ERR_INIT;
    if (import_choose(&model, &name, &given, folder, &photos, NULL, &err)) {
        if (!err.text[0] || model.images || name) abort();
        return 0;
    }
    if (!import_model(&in, &model, &photos, &params, &err))
        check(&in);
    else if (!err.text[0] || in.model.images || in.lenses.lenses)
        abort();
    import_release(&in);
    sfm_model_release(&model);
    free(name);
    return 0;
}
