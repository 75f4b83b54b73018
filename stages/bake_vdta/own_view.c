/* own_view.c - see own_view.h. */
#include "stages/bake_vdta/own_view.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/file_path.h"
#include "common/image/exr.h"

/* Takes a channel's memory; NULL: the file has no such channel, or it has another type. */
static float *take_float(struct exr_image *exr, const char *name)
{
    struct exr_plane *p = exr_find(exr, name);
    float *f = p ? p->f : NULL;
    if (p) p->f = NULL;
    return f;
}

static uint32_t *take_uint(struct exr_image *exr, const char *name)
{
    struct exr_plane *p = exr_find(exr, name);
    uint32_t *u = p ? p->u : NULL;
    if (p) p->u = NULL;
    return u;
}

static enum status check_size(const struct exr_image *exr, const struct view *camera, const char *path, struct err *err)
{
    if (exr->width == camera->width && exr->height == camera->height) return ST_OK;
    return err_set(err, ST_DATA, "%s has %d x %d pixels, but its camera %d x %d; make it again.", path, exr->width,
                   exr->height, camera->width, camera->height);
}

static void scale_depth(float *z, size_t pixels, double scale)
{
    for (size_t i = 0; i < pixels; i++) z[i] = (float)(scale * z[i]);
}

static enum status read_depth(struct own_view *v, const char *ids, double scale, struct err *err)
{
    static const char *const names[] = {"Z"};
    const struct view *camera = &v->view.camera;
    struct exr_image exr = {0};
    char path[FILE_PATH];
    enum status st = file_path(path, ids, camera->name, ".exr", err);
    if (!st) st = exr_read(&exr, path, names, 1, err);
    if (!st) st = check_size(&exr, camera, path, err);
    if (!st && !(v->z = take_float(&exr, "Z"))) st = err_set(err, ST_DATA, "%s: channel Z holds integers.", path);
    if (!st) scale_depth(v->z, (size_t)camera->width * (size_t)camera->height, scale);
    exr_image_release(&exr);
    return st;
}

static enum status read_layers(struct own_view *v, const char *reveal, double scale, struct err *err)
{
    const struct view *camera = &v->view.camera;
    struct exr_image exr = {0};
    char path[FILE_PATH], name[EXR_NAME_SIZE];
    enum status st = file_path(path, reveal, camera->name, ".exr", err);
    if (!st) st = exr_read(&exr, path, NULL, 0, err);
    if (!st) st = check_size(&exr, camera, path, err);
    int layers = 0;
    while (!st && snprintf(name, sizeof name, "layer%d.id", layers) > 0 && exr_find(&exr, name)) layers++;
    v->layer_id = calloc((size_t)layers + 1, sizeof *v->layer_id);
    v->layer_z = calloc((size_t)layers + 1, sizeof *v->layer_z);
    if (!st && (!v->layer_id || !v->layer_z)) st = err_nomem(err, "layers", (size_t)layers * sizeof *v->layer_z);
    for (int k = 0; !st && k < layers; k++) {
        v->layers = k + 1;
        snprintf(name, sizeof name, "layer%d.id", k);
        v->layer_id[k] = take_uint(&exr, name);
        snprintf(name, sizeof name, "layer%d.Z", k);
        v->layer_z[k] = take_float(&exr, name);
        if (!v->layer_id[k] || !v->layer_z[k])
            st = err_set(err, ST_DATA, "%s: layer %d lacks id or Z; make it again.", path, k);
        else
            scale_depth(v->layer_z[k], (size_t)camera->width * (size_t)camera->height, scale);
    }
    exr_image_release(&exr);
    return st;
}

enum status own_view_read(struct own_view *v, const char *views, const char *ids, const char *reveal,
                          const struct view *camera, double scale, const struct texture_params *params, struct err *err)
{
    *v = (struct own_view){0};
    enum status st = source_view_read(&v->view, views, ids, camera, params, err);
    if (!st) st = read_depth(v, ids, scale, err);
    if (!st) st = read_layers(v, reveal, scale, err);
    return st;
}

void own_view_release(struct own_view *v)
{
    source_view_release(&v->view);
    free(v->z);
    for (int k = 0; k < v->layers; k++) {
        free(v->layer_id[k]);
        free(v->layer_z[k]);
    }
    free(v->layer_id);
    free(v->layer_z);
    *v = (struct own_view){0};
}
