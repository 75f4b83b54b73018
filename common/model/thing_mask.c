/* thing_mask.c - see thing_mask.h. */
#include "common/model/thing_mask.h"

#include <stdlib.h>
#include <string.h>

#include "common/capture/view_image.h"
#include "common/image/exr.h"

enum { CHANNELS = 2 };
static const char *const channels[CHANNELS] = {"id", "meets"};

static uint32_t **plane_of(struct thing_mask *m, int channel) { return channel ? &m->meets : &m->shows; }

enum status thing_mask_init(struct thing_mask *m, const struct view *view, struct err *err)
{
    const size_t pixels = (size_t)view->width * (size_t)view->height;
    for (int c = 0; c < CHANNELS; c++) *plane_of(m, c) = calloc(pixels + 1, sizeof **plane_of(m, c));
    if (m->shows && m->meets) return ST_OK;
    thing_mask_release(m);
    return err_nomem(err, "the things of a view", CHANNELS * pixels * sizeof *m->shows);
}

void thing_mask_release(struct thing_mask *m)
{
    free(m->shows);
    free(m->meets);
    *m = (struct thing_mask){0};
}

enum status thing_mask_write(const struct thing_mask *m, const struct view *view, const char *path,
                             const struct provenance *prov, struct err *err)
{
    struct exr_image im = {0};
    exr_image_init(&im, view->width, view->height, err);
    for (int c = 0; !err->status && c < CHANNELS; c++) {
        struct exr_plane *plane;
        const uint32_t *from = c ? m->meets : m->shows;
        if (!exr_add_plane(&im, channels[c], EXR_UINT, &plane, err))
            memcpy(plane->u, from, (size_t)view->width * (size_t)view->height * sizeof *from);
    }
    if (!err->status) {
        view_image_set_camera(&im, view);
        exr_write(&im, path, prov, err);
    }
    exr_image_release(&im);
    return err->status;
}

static enum status check_plane(const struct exr_plane *plane, const struct view *view, const char *path,
                               uint32_t max_id, struct err *err)
{
    if (!plane->u)
        return err_set(err, ST_DATA, "%s: channel %s has the wrong type; run find_things again.", path, plane->name);
    for (size_t i = 0; i < (size_t)view->width * (size_t)view->height; i++)
        if (plane->u[i] > max_id)
            return err_set(err, ST_DATA,
                           "%s: pixel (%zu, %zu) is of thing %u, but there are %u; run find_things again.", path,
                           i % (size_t)view->width, i / (size_t)view->width, plane->u[i], max_id);
    return ST_OK;
}

enum status thing_mask_read(struct thing_mask *m, const struct view *view, const char *path, uint32_t max_id,
                            struct provenance *prov, struct err *err)
{
    struct exr_image im = {0};
    *m = (struct thing_mask){0};
    if (exr_read_product(&im, PRODUCT_THING_MASK, path, channels, CHANNELS, prov, err)) return err->status;
    if (im.width != view->width || im.height != view->height)
        err_set(err, ST_DATA, "%s is %d x %d px, but the view is %d x %d px; run find_things again.", path, im.width,
                im.height, view->width, view->height);
    for (int c = 0; !err->status && c < CHANNELS; c++) check_plane(exr_find(&im, channels[c]), view, path, max_id, err);
    for (int c = 0; !err->status && c < CHANNELS; c++) {
        struct exr_plane *plane = exr_find(&im, channels[c]);
        *plane_of(m, c) = plane->u;
        plane->u = NULL;
    }
    exr_image_release(&im);
    return err->status;
}
