/* view_image.c - the picture of a rectified view on disk. */
#include "common/capture/view_image.h"

#include <string.h>

#include "common/image/exr.h"
#include "common/image/luminance.h"
#include "common/product/product.h"

static const char *const channel_names[VIEW_CHANNELS] = {"R", "G", "B", "A", "sigma", "clipped"};

enum status view_planes_read(struct view_planes *p, const char *folder, const struct view *view, int count,
                             struct provenance *prov, struct err *err)
{
    struct exr_image *exr = &p->exr;
    char path[FILE_PATH];
    if (product_path_in(path, folder, PRODUCT_VIEW, &(struct product_key){.view = view->name}, err) ||
        exr_read_product(exr, PRODUCT_VIEW, path, channel_names, count, prov, err))
        return err->status;
    if (exr->width != view->width || exr->height != view->height)
        return err_set(err, ST_DATA, "%s has %d x %d pixels, but its camera %d x %d; make the views again.", path,
                       exr->width, exr->height, view->width, view->height);
    for (int c = 0; c < count; c++) {
        p->channel[c] = exr_find(exr, channel_names[c])->f;
        if (!p->channel[c])
            return err_set(err, ST_DATA,
                           "%s: channel %s contains integers, wanted half or float; make the views again.", path,
                           channel_names[c]);
    }
    return ST_OK;
}

void view_planes_release(struct view_planes *p)
{
    exr_image_release(&p->exr);
    *p = (struct view_planes){0};
}

enum status view_image_read(struct image *im, const char *folder, const struct view *view, struct provenance *prov,
                            struct err *err)
{
    struct view_planes planes = {0};
    const size_t pixels = (size_t)view->width * (size_t)view->height;

    *im = (struct image){0};
    if (!view_planes_read(&planes, folder, view, 4, prov, err)) image_init(im, view->width, view->height, 4, err);
    for (size_t c = 0; !err->status && c < 4; c++)
        for (size_t i = 0; i < pixels; i++) im->data[4 * i + c] = planes.channel[c][i];
    view_planes_release(&planes);
    return err->status;
}

/* Rounds to six binary digits: noise is not known more precisely, and the rest would not compress. */
static float rounded(float v)
{
    uint32_t bits;
    memcpy(&bits, &v, sizeof bits);
    bits = (bits + 0x20000u) & ~0x3ffffu;
    memcpy(&v, &bits, sizeof v);
    return v;
}

static enum status add_quality(struct exr_image *exr, const struct image *im, const struct photo_quality *quality,
                               struct err *err)
{
    struct exr_plane *sigma = NULL, *clipped = NULL;
    if (exr_add_plane(exr, "sigma", EXR_HALF, &sigma, err) || exr_add_plane(exr, "clipped", EXR_HALF, &clipped, err))
        return err->status;
    sigma = exr_find(exr, "sigma");
    for (size_t i = 0; i < (size_t)im->width * (size_t)im->height; i++) {
        const float *p = im->data + 4 * i;
        if (!(p[3] > 0)) continue;
        sigma->f[i] = rounded(photo_relative_sigma(quality->variance[i], luminance_of(p)));
        clipped->f[i] = quality->marks[i];
    }
    return ST_OK;
}

enum status view_image_write(const struct image *im, const struct photo_quality *quality, const char *path,
                             const struct view *view, const struct provenance *prov, const char *radiometry,
                             struct err *err)
{
    struct exr_image exr = {0};

    if (im->channels != 4 || im->width != view->width || im->height != view->height)
        err_set(err, ST_INTERNAL, "cannot write %s: a picture of %d x %d with %d channels is not view %s.", path,
                im->width, im->height, im->channels, view->name);
    if (!err->status) exr_init_rgba(&exr, im->data, im->width, im->height, err);
    if (!err->status && quality) add_quality(&exr, im, quality, err);
    if (!err->status && !exr_set_attribute(&exr, "remodel:radiometry", radiometry, err)) {
        view_image_set_camera(&exr, view);
        exr_write(&exr, path, prov, err);
    }
    exr_image_release(&exr);
    return err->status;
}

/* OpenEXR's standard attribute worldToCamera: p_cam = p_world M for row vectors (x y z 1), so the translation is the
 * last row; its camera axes are x right, y UP, z forward, left-handed, whereas a view's y points down. Hence
 *   M = [ R^T F  0 ]    F = diag(1, -1, 1), R = cam_from_world, t = translation,
 *       [ t^T F  1 ]    stored row by row. */
void view_image_set_camera(struct exr_image *im, const struct view *view)
{
    static const double flip[3] = {1, -1, 1};
    const double t[3] = {view->translation.x, view->translation.y, view->translation.z};
    for (int column = 0; column < 3; column++) {
        for (int row = 0; row < 3; row++)
            im->world_to_camera[4 * row + column] = (float)(flip[column] * view->cam_from_world.m[column][row]);
        im->world_to_camera[12 + column] = (float)(flip[column] * t[column]);
        im->world_to_camera[4 * column + 3] = 0;
    }
    im->world_to_camera[15] = 1;
    im->has_world_to_camera = true;
}
