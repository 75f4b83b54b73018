/* whole_photo.c - see whole_photo.h. */
#include "stages/report/whole_photo.h"

#include <math.h>
#include <stdlib.h>

/* Of the views that a ray goes through, the one whose axis is nearest. */
static struct whole_photo_pixel find_pixel(struct vec3 ray, const struct mat3 *turns, const struct view *views,
                                           int count)
{
    struct whole_photo_pixel found = {-1, 0, 0};
    double nearest = 0;
    for (int i = 0; i < count; i++) {
        const struct vec3 p = mat3_apply(turns[i], ray);
        if (!(p.z > nearest)) continue;
        const double u = views[i].fx * p.x / p.z + views[i].cx, v = views[i].fy * p.y / p.z + views[i].cy;
        if (!(u >= 0 && v >= 0 && u < views[i].width && v < views[i].height)) continue;
        found = (struct whole_photo_pixel){i, (float)u, (float)v};
        nearest = p.z;
    }
    return found;
}

enum status whole_photo_init(struct whole_photo *w, const struct lens *lenses, const struct view *views, int count,
                             int orientation, int upright, struct err *err)
{
    const struct camera *camera = &lenses[0].camera;
    struct mat3 *turns = malloc((size_t)count * sizeof *turns);
    int width, height;
    page_thumb_size(camera->width, camera->height, orientation, upright, &width, &height);
    const bool lies = orientation >= 5;
    *w = (struct whole_photo){lies ? height : width, lies ? width : height, NULL};
    w->pixels = malloc((size_t)width * (size_t)height * sizeof *w->pixels);
    if (!turns || !w->pixels) err_nomem(err, "pixels of a photo", (size_t)width * (size_t)height * sizeof *w->pixels);
    for (int i = 0; !err->status && i < count; i++) turns[i] = mat3_from_quat(lenses[i].view_from_photo);
    for (int y = 0; !err->status && y < w->height; y++)
        for (int x = 0; x < w->width; x++) {
            struct whole_photo_pixel *to = &w->pixels[(size_t)y * (size_t)w->width + (size_t)x];
            struct vec3 ray;
            int sx, sy;
            page_upright_source(orientation, width, height, x, y, &sx, &sy);
            const double u = (sx + 0.5) * camera->width / width, v = (sy + 0.5) * camera->height / height;
            *to = camera_unproject(camera, u, v, &ray) ? find_pixel(ray, turns, views, count)
                                                       : (struct whole_photo_pixel){-1, 0, 0};
        }
    free(turns);
    return err->status;
}

void whole_photo_release(struct whole_photo *w)
{
    free(w->pixels);
    *w = (struct whole_photo){0};
}

static bool is_known(const struct image *known, int x, int y)
{
    const float *at = image_at(known, x, y);
    return at[0] > 0 || at[1] > 0 || at[2] > 0;
}

struct sum {
    double rgb[3], weight;
};

/* Adds the bilinear sample at (u, v), of samples that are known. */
static void add_sample(struct sum *sum, const struct image *im, const struct image *known, double u, double v)
{
    const double x = fmin(fmax(u - 0.5, 0), im->width - 1), y = fmin(fmax(v - 0.5, 0), im->height - 1);
    const int x0 = (int)x, y0 = (int)y;
    for (int k = 0; k < 4; k++) {
        const int xi = x0 + (k & 1), yi = y0 + (k >> 1);
        const double weight = ((k & 1) ? x - x0 : 1 - (x - x0)) * ((k >> 1) ? y - y0 : 1 - (y - y0));
        if (!(weight > 0) || !is_known(known, xi, yi)) continue;
        const float *rgb = image_at(im, xi, yi);
        for (int c = 0; c < 3; c++) sum->rgb[c] += weight * (double)rgb[c];
        sum->weight += weight;
    }
}

/* How far one goes in the view from a pixel to the next along a row (step 1) or a column (step: the width). */
static void find_step(const struct whole_photo_pixel *at, bool has_next, bool has_previous, int step, double by[2])
{
    const struct whole_photo_pixel *next = at + step, *previous = at - step;
    by[0] = by[1] = 0;
    if (has_next && next->view == at->view)
        by[0] = (double)next->u - (double)at->u, by[1] = (double)next->v - (double)at->v;
    else if (has_previous && previous->view == at->view)
        by[0] = (double)at->u - (double)previous->u, by[1] = (double)at->v - (double)previous->v;
}

/* The mean over the pixel, of n x n samples where it covers about n pixels of the view. */
static void add_area(struct sum *sum, const struct whole_photo *w, const struct image *im, const struct image *known,
                     int x, int y)
{
    const struct whole_photo_pixel *at = &w->pixels[(size_t)y * (size_t)w->width + (size_t)x];
    double across[2], down[2];
    find_step(at, x + 1 < w->width, x > 0, 1, across);
    find_step(at, y + 1 < w->height, y > 0, w->width, down);
    const int n = (int)fmin(8, fmax(1, ceil(fmax(hypot(across[0], across[1]), hypot(down[0], down[1])))));
    for (int k = 0; k < n * n; k++) {
        const double a = (k % n + 0.5) / n - 0.5, b = (double)(k / n) / n + 0.5 / n - 0.5;
        add_sample(sum, im, known, (double)at->u + a * across[0] + b * down[0],
                   (double)at->v + a * across[1] + b * down[1]);
    }
}

static struct sum find_colour(const struct whole_photo *w, const struct image *layers, const struct image *known,
                              const float fallback[3], bool smooth, int x, int y)
{
    const struct whole_photo_pixel *at = &w->pixels[(size_t)y * (size_t)w->width + (size_t)x];
    struct sum sum = {{0}, 0};
    if (at->view < 0) return sum;
    const struct image *layer = &layers[at->view];
    if (layer->data && smooth) {
        add_area(&sum, w, layer, &known[at->view], x, y);
        return sum;
    }
    const float *rgb = layer->data ? image_at(layer, (int)at->u, (int)at->v) : fallback;
    return (struct sum){{(double)rgb[0], (double)rgb[1], (double)rgb[2]}, 1};
}

static unsigned char display(double linear) { return (unsigned char)(255 * srgb_from_linear((float)linear) + 0.5f); }

enum status whole_photo_picture(struct picture *p, const struct whole_photo *w, const struct image *layers,
                                const struct image *known, const float fallback[3], bool smooth, unsigned char *covered,
                                struct err *err)
{
    if (picture_init(p, w->width, w->height, err)) return err->status;
    for (int y = 0; y < w->height; y++)
        for (int x = 0; x < w->width; x++) {
            const size_t i = (size_t)y * (size_t)w->width + (size_t)x;
            const struct sum sum = find_colour(w, layers, known, fallback, smooth, x, y);
            if (covered) covered[i] = sum.weight > 0;
            for (int c = 0; sum.weight > 0 && c < 3; c++) p->rgb[3 * i + (size_t)c] = display(sum.rgb[c] / sum.weight);
        }
    return ST_OK;
}

static double linear(unsigned char value) { return (double)linear_from_srgb((float)value / 255); }

static bool is_well_exposed(const unsigned char *rgb)
{
    for (int c = 0; c < 3; c++)
        if (rgb[c] < 25 || rgb[c] > 235) return false;
    return true;
}

void whole_photo_find_gain(double gain[3], const struct picture *p, const unsigned char *covered,
                           const struct picture *rest)
{
    double here[3] = {0}, there[3] = {0};
    for (size_t i = 0; i < (size_t)p->width * (size_t)p->height; i++)
        if (covered[i] && is_well_exposed(p->rgb + 3 * i) && is_well_exposed(rest->rgb + 3 * i))
            for (size_t c = 0; c < 3; c++) {
                here[c] += linear(p->rgb[3 * i + c]);
                there[c] += linear(rest->rgb[3 * i + c]);
            }
    for (int c = 0; c < 3; c++) gain[c] = there[c] > 0 ? here[c] / there[c] : 1;
}

void whole_photo_fill(struct picture *p, const unsigned char *covered, const struct picture *rest, const double gain[3])
{
    for (size_t i = 0; i < (size_t)p->width * (size_t)p->height; i++)
        for (size_t c = 0; !covered[i] && c < 3; c++)
            p->rgb[3 * i + c] = display(gain[c] * linear(rest->rgb[3 * i + c]));
}
