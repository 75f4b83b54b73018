/* fit_region_picture.c - what a fitted material does not explain, as dots on a view. */
#include <math.h>
#include <stdlib.h>

#include "common/capture/view_image.h"
#include "common/image/draw.h"
#include "common/image/luminance.h"
#include "common/image/photo.h"
#include "common/math/numbers.h"
#include "stages/fit_materials/fit_region.h"

enum { QUALITY = 90, MIN_RADIUS = 3 };
#define FULL_COLOUR 0.25 /* of the model's luminance */
#define WHITE       0.9  /* fraction of pixels that are not brighter than half of white */

static int max_seen(const struct region_fit *f, const struct observations *o, int views)
{
    int best = 0, most = -1;
    for (int view = 0; view < views; view++) {
        int count = 0;
        for (int i = 0; i < f->samples.count; i++) count += o->sights[f->first + i].view == view;
        if (count > most) best = view, most = count;
    }
    return best;
}

/* Colour of a relative residual: white at 0, red above, blue below. */
static void residual_colour(double residual, unsigned char colour[3])
{
    const double part = clamp(residual / FULL_COLOUR, -1, 1);
    const unsigned char faded = (unsigned char)lround(255 * (1 - fabs(part)));
    colour[0] = part >= 0 ? 255 : faded;
    colour[1] = faded;
    colour[2] = part >= 0 ? faded : 255;
}

enum status region_fit_picture(const struct region_fit *f, const struct observations *o,
                               const struct observed_scene *scene, const char *path, struct err *err)
{
    const int view = max_seen(f, o, scene->set->view_count);
    struct image im = {0};
    if (view_image_read(&im, scene->views, &scene->set->views[view], NULL, err) || image_expose(&im, WHITE, 0.5, err)) {
        image_release(&im);
        return err->status;
    }
    const double radius = fmax(MIN_RADIUS, im.width / 250.0);
    unsigned char *rgb = malloc(3 * (size_t)im.width * (size_t)im.height);
    if (rgb) image_to_srgb8(&im, rgb);
    const struct canvas canvas = {rgb, im.width, im.height};
    for (int i = 0; rgb && i < f->samples.count; i++) {
        const struct point_sight *s = &o->sights[f->first + i];
        const double model = luminance_of_doubles(f->predicted + 3 * i), seen = luminance_of_doubles(s->radiance);
        unsigned char colour[3];
        if (s->view != view) continue;
        residual_colour(model > 0 ? seen / model - 1 : seen > 0 ? 1 : 0, colour);
        draw_dot(&canvas, s->x, s->y, radius, colour);
    }
    if (rgb)
        jpeg_write(path, rgb, im.width, im.height, QUALITY, err);
    else
        err_nomem(err, "a picture", 3 * (size_t)im.width * (size_t)im.height);
    free(rgb);
    image_release(&im);
    return err->status;
}
