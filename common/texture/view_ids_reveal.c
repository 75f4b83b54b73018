/* view_ids_reveal.c - reading and writing reveal/VIEW.exr (docs/formats.md): channels layer0.id, layer0.Z, layer1.id,
 * ... */
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/file_path.h"
#include "common/base/ledger.h"
#include "common/capture/view_image.h"
#include "common/image/exr.h"
#include "common/texture/view_ids.h"

enum status view_reveal_init(struct view_reveal *v, int width, int height, int layers, struct err *err)
{
    *v = (struct view_reveal){0};
    if (width < 1 || height < 1 || (int64_t)width * height > INT_MAX || layers < 0)
        return err_set(err, ST_DATA, "%d layers of %d x %d revealed pixels: not a picture.", layers, width, height);
    const size_t pixels = (size_t)width * (size_t)height;
    v->width = width;
    v->height = height;
    v->id = calloc((size_t)layers + 1, sizeof *v->id);
    v->z = calloc((size_t)layers + 1, sizeof *v->z);
    bool made = v->id && v->z;
    for (; made && v->layers < layers; v->layers++) {
        v->id[v->layers] = calloc(pixels, sizeof **v->id);
        v->z[v->layers] = calloc(pixels, sizeof **v->z);
        made = v->id[v->layers] && v->z[v->layers];
    }
    if (made) return ST_OK;
    view_reveal_release(v);
    return err_nomem(err, "revealed surfaces", pixels * (size_t)layers * 8);
}

void view_reveal_release(struct view_reveal *v)
{
    if (!v) return;
    for (int k = 0; v->id && v->z && k < v->layers; k++) {
        free(v->id[k]);
        free(v->z[k]);
    }
    free(v->id);
    free(v->z);
    *v = (struct view_reveal){0};
}

static void channel_name(char name[EXR_NAME_SIZE], int layer, const char *channel)
{
    snprintf(name, EXR_NAME_SIZE, "layer%d.%s", layer, channel);
}

static bool same_bytes(const char *a, const char *b)
{
    FILE *f = fopen(a, "rb"), *g = fopen(b, "rb");
    bool same = f && g;
    for (int c = 0; same && c != EOF;) {
        c = getc(f);
        same = c == getc(g);
    }
    if (f) fclose(f);
    if (g) fclose(g);
    return same;
}

/* Puts the file `made` at `path`, or removes it if there is such a file already. */
static enum status replace_if_changed(const char *made, const char *path, bool *changed, struct err *err)
{
    *changed = !same_bytes(made, path);
    if (!*changed) {
        unlink(made);
        return ST_OK;
    }
    if (ledger_add(path, made, err)) {
        unlink(made);
        return err->status;
    }
    if (!rename(made, path)) return ST_OK;
    const int reason = errno;
    unlink(made);
    errno = reason;
    return err_errno(err, "replace", path);
}

enum status view_reveal_write(const struct view_reveal *v, const struct view *view, const char *path,
                              const struct provenance *prov, bool *changed, struct err *err)
{
    const size_t pixels = (size_t)v->width * (size_t)v->height;
    const char *slash = strrchr(path, '/');
    const int folder = slash ? (int)(slash - path) + 1 : 0;
    struct exr_image im = {0};
    char made[FILE_PATH];
    bool differs = false;
    if (snprintf(made, sizeof made, "%.*s.%s.new", folder, path, path + folder) >= FILE_PATH)
        return err_set(err, ST_IO, "%s: the path is too long.", path);
    exr_image_init(&im, v->width, v->height, err);
    /* a file has at least one channel: without anything revealed, layer 0 is empty */
    for (int k = 0; !err->status && (k < v->layers || k == 0); k++) {
        struct exr_plane *plane;
        char name[EXR_NAME_SIZE];
        channel_name(name, k, "id");
        if (!exr_add_plane(&im, name, EXR_UINT, &plane, err) && k < v->layers)
            memcpy(plane->u, v->id[k], pixels * sizeof *plane->u);
        channel_name(name, k, "Z");
        if (!err->status && !exr_add_plane(&im, name, EXR_FLOAT, &plane, err) && k < v->layers)
            memcpy(plane->f, v->z[k], pixels * sizeof *plane->f);
    }
    if (!err->status) {
        view_image_set_camera(&im, view);
        exr_write(&im, made, prov, err);
    }
    if (!err->status) replace_if_changed(made, path, &differs, err);
    if (changed) *changed = differs;
    exr_image_release(&im);
    return err->status;
}

static enum status take_layer(struct view_reveal *v, int k, const struct exr_image *im, const char *path,
                              struct err *err)
{
    const size_t pixels = (size_t)v->width * (size_t)v->height;
    char name[EXR_NAME_SIZE];
    channel_name(name, k, "id");
    const struct exr_plane *id = exr_find(im, name);
    channel_name(name, k, "Z");
    const struct exr_plane *z = exr_find(im, name);
    if (!id || !id->u || !z || !z->f)
        return err_set(err, ST_DATA,
                       "%s: channels layer%d.id (uint) and layer%d.Z (float) are missing; run trace_ids "
                       "again.",
                       path, k, k);
    for (size_t i = 0; i < pixels; i++) {
        const float above = k ? v->z[k - 1][i] : 0;
        const bool valid =
            id->u[i] ? id->u[i] <= INT_MAX && z->f[i] > 0 && z->f[i] >= above && (!k || v->id[k - 1][i]) : z->f[i] == 0;
        if (!valid)
            return err_set(err, ST_DATA,
                           "%s: pixel (%zu, %zu) of layer %d has id %u and Z %g, wanted surfaces from the "
                           "first layer on, in order of Z; run trace_ids again.",
                           path, i % (size_t)v->width, i / (size_t)v->width, k, id->u[i], (double)z->f[i]);
    }
    memcpy(v->id[k], id->u, pixels * sizeof *id->u);
    memcpy(v->z[k], z->f, pixels * sizeof *z->f);
    return ST_OK;
}

enum status view_reveal_read(struct view_reveal *v, const struct view *view, const char *path, struct provenance *prov,
                             struct err *err)
{
    struct exr_image im = {0};
    *v = (struct view_reveal){0};
    exr_read_product(&im, PRODUCT_REVEAL, path, NULL, 0, prov, err);
    if (!err->status && (im.count % 2 || !im.count))
        err_set(err, ST_DATA, "%s has %d channels, wanted layer0.id, layer0.Z, layer1.id, ...; run trace_ids again.",
                path, im.count);
    if (!err->status && view && (im.width != view->width || im.height != view->height))
        err_set(err, ST_DATA, "%s is %d x %d px, but the view is %d x %d px; run trace_ids again.", path, im.width,
                im.height, view->width, view->height);
    if (!err->status) view_reveal_init(v, im.width, im.height, im.count / 2, err);
    for (int k = 0; !err->status && k < im.count / 2; k++) take_layer(v, k, &im, path, err);
    if (err->status) view_reveal_release(v);
    exr_image_release(&im);
    return err->status;
}
