/* view_records.c - see view_records.h. */
#include "stages/trace_ids/view_records.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/file_path.h"
#include "common/image/exr.h"
#include "common/texture/face_index.h"

static const float CLEAN = 0.3f; /* clutter below which nothing stands in front */

struct sums {
    double z, cosine;
    int pixels, clean;
};

static void add_up(struct sums *sums, const struct view_faces *f, const struct solid_mesh *mesh,
                   const struct view *camera)
{
    const struct mat3 turn = mat3_transpose(camera->cam_from_world);
    for (int y = 0; y < f->height; y++)
        for (int x = 0; x < f->width; x++) {
            const size_t at = (size_t)y * (size_t)f->width + (size_t)x;
            if (f->face[at] < 0) continue;
            struct sums *s = &sums[solid_face_id(mesh, f->face[at])];
            const struct vec3 ray = {(x + 0.5 - camera->cx) / camera->fx, (y + 0.5 - camera->cy) / camera->fy, 1};
            const struct vec3 direction = mat3_apply(turn, ray);
            s->pixels++;
            s->clean += f->clutter[at] < CLEAN;
            s->z += f->z[at];
            s->cosine += fabs(vec3_dot(mesh->faces[f->face[at]].normal, direction)) / vec3_length(direction);
        }
}

static enum status write_record(const struct view_faces *f, const struct solid_mesh *mesh, const struct view *camera,
                                double scale, const char *path, const struct provenance *prov, struct err *err)
{
    int ids = 1, count = 0;
    for (int i = 0; i < mesh->name_count; i++)
        if (mesh->names[i].id >= ids) ids = mesh->names[i].id + 1;
    struct sums *sums = calloc((size_t)ids, sizeof *sums);
    struct face_record *records = calloc((size_t)ids, sizeof *records);
    enum status st = sums && records ? ST_OK : err_nomem(err, "faces", (size_t)ids * sizeof *records);
    if (!st) add_up(sums, f, mesh, camera);
    for (int i = 0; !st && i < ids; i++)
        if (sums[i].pixels)
            records[count++] =
                (struct face_record){i,
                                     {NULL, sums[i].pixels, sums[i].clean, sums[i].z / sums[i].pixels / scale,
                                      fmin(1, sums[i].cosine / sums[i].pixels)}};
    if (!st) st = face_records_write(records, count, path, prov, err);
    free(sums);
    free(records);
    return st;
}

enum status view_records_write(const struct view_faces *f, const struct solid_mesh *mesh, const struct view *camera,
                               double scale, const char *path, const struct provenance *prov, struct err *err)
{
    const size_t pixels = (size_t)f->width * (size_t)f->height, length = strlen(path);
    static const char *const names[] = {"id", "Z", "jump", "clutter"};
    static const enum exr_type types[] = {EXR_UINT, EXR_FLOAT, EXR_HALF, EXR_HALF};
    struct exr_image exr = {0};
    char record[FILE_PATH];
    if (length < 5 || length >= sizeof record || strcmp(path + length - 4, ".exr"))
        return err_set(err, ST_USAGE, "--out %s: wanted a file name that ends in .exr.", path);
    memcpy(record, path, length + 1);
    memcpy(record + length - 4, ".txt", 4);
    enum status st = write_record(f, mesh, camera, scale, record, prov, err);
    if (!st) st = exr_image_init(&exr, f->width, f->height, err);
    for (int k = 0; !st && k < 4; k++) st = exr_add_plane(&exr, names[k], types[k], NULL, err);
    for (size_t i = 0; !st && i < pixels; i++) {
        exr.planes[0].u[i] = f->face[i] < 0 ? 0 : (uint32_t)solid_face_id(mesh, f->face[i]);
        exr.planes[1].f[i] = (float)(f->z[i] / scale);
        exr.planes[2].f[i] = f->jump[i];
        exr.planes[3].f[i] = f->clutter[i];
    }
    if (!st) st = exr_write(&exr, path, prov, err);
    exr_image_release(&exr);
    return st;
}
