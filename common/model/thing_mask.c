/* thing_mask.c - see thing_mask.h. */
#include "common/model/thing_mask.h"

#include <string.h>

#include "common/capture/view_image.h"
#include "common/image/exr.h"

enum status thing_mask_write(const uint32_t *mask, const struct view *view, const char *path,
                             const struct provenance *prov, struct err *err)
{
    struct exr_image im = {0};
    struct exr_plane *plane;
    if (!exr_image_init(&im, view->width, view->height, err) && !exr_add_plane(&im, "id", EXR_UINT, &plane, err)) {
        memcpy(plane->u, mask, (size_t)view->width * (size_t)view->height * sizeof *mask);
        view_image_set_camera(&im, view);
        exr_write(&im, path, prov, err);
    }
    exr_image_release(&im);
    return err->status;
}

enum status thing_mask_read(uint32_t **mask, const struct view *view, const char *path, uint32_t max_id,
                            struct provenance *prov, struct err *err)
{
    static const char *const names[] = {"id"};
    const size_t pixels = (size_t)view->width * (size_t)view->height;
    struct exr_image im = {0};
    *mask = NULL;
    if (exr_read_product(&im, PRODUCT_THING_MASK, path, names, 1, prov, err)) return err->status;
    struct exr_plane *plane = exr_find(&im, "id");
    if (!plane->u)
        err_set(err, ST_DATA, "%s: channel id has the wrong type; run find_things again.", path);
    else if (im.width != view->width || im.height != view->height)
        err_set(err, ST_DATA, "%s is %d x %d px, but the view is %d x %d px; run find_things again.", path, im.width,
                im.height, view->width, view->height);
    for (size_t i = 0; !err->status && i < pixels; i++)
        if (plane->u[i] > max_id)
            err_set(err, ST_DATA, "%s: pixel (%zu, %zu) is of thing %u, but there are %u; run find_things again.", path,
                    i % (size_t)view->width, i / (size_t)view->width, plane->u[i], max_id);
    if (!err->status) {
        *mask = plane->u;
        plane->u = NULL;
    }
    exr_image_release(&im);
    return err->status;
}
