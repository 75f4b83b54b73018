/* view_ids.c - reading and writing ids/VIEW.exr (docs/formats.md). */
#include "common/texture/view_ids.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "common/capture/view_image.h"
#include "common/image/exr.h"

enum { PLANES = 4 };
static const char *const names[PLANES] = {"id", "Z", "jump", "clutter"};
static const enum exr_type types[PLANES] = {EXR_UINT, EXR_FLOAT, EXR_HALF, EXR_HALF};

enum status view_ids_init(struct view_ids *v, int width, int height, struct err *err)
{
    *v = (struct view_ids){0};
    if (width < 1 || height < 1 || (int64_t)width * height > INT_MAX)
        return err_set(err, ST_DATA, "a picture of ids cannot have %d x %d pixels.", width, height);
    const size_t pixels = (size_t)width * (size_t)height;
    v->width = width;
    v->height = height;
    v->id = calloc(pixels, sizeof *v->id);
    v->z = calloc(pixels, sizeof *v->z);
    v->jump = calloc(pixels, sizeof *v->jump);
    v->clutter = calloc(pixels, sizeof *v->clutter);
    if (v->id && v->z && v->jump && v->clutter) return ST_OK;
    view_ids_release(v);
    return err_nomem(err, "a picture of ids", pixels * 16);
}

void view_ids_release(struct view_ids *v)
{
    if (!v) return;
    free(v->id);
    free(v->z);
    free(v->jump);
    free(v->clutter);
    *v = (struct view_ids){0};
}

enum status view_ids_write(const struct view_ids *v, const struct view *view, const char *path,
                           const struct provenance *prov, struct err *err)
{
    const void *planes[PLANES] = {v->id, v->z, v->jump, v->clutter};
    const size_t pixels = (size_t)v->width * (size_t)v->height;
    struct exr_image im = {0};
    exr_image_init(&im, v->width, v->height, err);
    for (int i = 0; !err->status && i < PLANES; i++) {
        struct exr_plane *plane;
        if (!exr_add_plane(&im, names[i], types[i], &plane, err))
            memcpy(plane->u ? (void *)plane->u : (void *)plane->f, planes[i], pixels * 4);
    }
    if (!err->status) {
        view_image_set_camera(&im, view);
        exr_write(&im, path, prov, err);
    }
    exr_image_release(&im);
    return err->status;
}

static enum status check_pixel(const struct view_ids *v, size_t i, const char *path, struct err *err)
{
    const bool valid = v->id[i] ? v->z[i] > 0 : v->z[i] == 0;
    if (valid && v->id[i] <= INT_MAX && v->jump[i] >= 0 && v->jump[i] <= VIEW_IDS_FAR && v->clutter[i] >= 0 &&
        v->clutter[i] <= 1)
        return ST_OK;
    return err_set(err, ST_DATA,
                   "%s: pixel (%zu, %zu) has id %u, Z %g, jump %g, clutter %g, wanted Z above 0 where there is an id "
                   "and 0 elsewhere, jump from 0 to %d, clutter from 0 to 1; run trace_ids again.",
                   path, i % (size_t)v->width, i / (size_t)v->width, v->id[i], (double)v->z[i], (double)v->jump[i],
                   (double)v->clutter[i], VIEW_IDS_FAR);
}

enum status view_ids_read(struct view_ids *v, const struct view *view, const char *path, struct provenance *prov,
                          struct err *err)
{
    struct exr_image im = {0};
    struct exr_plane *planes[PLANES] = {0};
    *v = (struct view_ids){0};
    exr_read_product(&im, PRODUCT_IDS, path, names, PLANES, prov, err);
    for (int i = 0; !err->status && i < PLANES; i++) {
        planes[i] = exr_find(&im, names[i]);
        if (i == 0 ? !planes[i]->u : !planes[i]->f)
            err_set(err, ST_DATA, "%s: channel %s has the wrong type; run trace_ids again.", path, names[i]);
    }
    if (!err->status && view && (im.width != view->width || im.height != view->height))
        err_set(err, ST_DATA, "%s is %d x %d px, but the view is %d x %d px; run trace_ids again.", path, im.width,
                im.height, view->width, view->height);
    if (err->status) {
        exr_image_release(&im);
        return err->status;
    }
    *v = (struct view_ids){im.width, im.height, planes[0]->u, planes[1]->f, planes[2]->f, planes[3]->f};
    planes[0]->u = NULL;
    for (int i = 1; i < PLANES; i++) planes[i]->f = NULL;
    exr_image_release(&im);
    for (size_t i = 0; !err->status && i < (size_t)v->width * (size_t)v->height; i++) check_pixel(v, i, path, err);
    if (err->status) view_ids_release(v);
    return err->status;
}
