/* film_flicker.c - see film_flicker.h.
 *
 * A surface that moves through the picture keeps its colour in a steady film, whatever the camera does. Sampling alone
 * changes it a little: fine texture is interpolated differently in each frame. */
#include "stages/report/film_flicker.h"

#include <math.h>
#include <stdlib.h>

#include "common/image/exr.h"
#include "common/image/luminance.h"
#include "common/product/product.h"
#include "stages/report/passing.h"

enum { PAIRS = 12, STEP = 3 };

#define SAME_DEPTH 0.02 /* largest relative difference of depth of one surface */
#define DARK       0.01 /* luminance below which differences count as if it were this bright */

/* The luminance of a place in a frame; below 0: the frame does not show it. */
static double luminance_at(const struct flicker_picture *f, struct vec3 place)
{
    const struct view *c = &f->camera;
    double u, v, sum = 0;
    const double z = view_project(c, place, &u, &v);
    const double x = floor(u - 0.5), y = floor(v - 0.5);
    if (!(z > 0) || !(x >= 0 && y >= 0 && x < c->width - 1 && y < c->height - 1)) return -1;
    for (int k = 0; k < 4; k++) {
        const size_t i = ((size_t)y + (size_t)(k >> 1)) * (size_t)c->width + (size_t)x + (size_t)(k & 1);
        const double weight = (k & 1 ? u - 0.5 - x : 1.5 + x - u) * (k >> 1 ? v - 0.5 - y : 1.5 + y - v);
        if (!(fabs((double)f->z[i] - z) <= SAME_DEPTH * z)) return -1;
        sum += weight * (double)f->luminance[i];
    }
    return sum;
}

static enum status add_value(struct flicker_values *v, float value, struct err *err)
{
    if (v->count == v->capacity) {
        const size_t more = v->capacity ? 2 * v->capacity : 4096;
        float *grown = realloc(v->values, more * sizeof *grown);
        if (!grown) return err_nomem(err, "differences", more * sizeof *grown);
        v->values = grown;
        v->capacity = more;
    }
    v->values[v->count++] = value;
    return ST_OK;
}

enum status film_flicker_add(struct flicker_values *v, const struct flicker_picture *frame,
                             const struct flicker_picture *next, int step, struct err *err)
{
    const struct view *c = &frame->camera;
    for (int y = step / 2; y < c->height; y += step)
        for (int x = step / 2; x < c->width; x += step) {
            const size_t i = (size_t)y * (size_t)c->width + (size_t)x;
            if (!(frame->z[i] > 0)) continue;
            const double now = (double)frame->luminance[i];
            const double then = luminance_at(next, view_unproject(c, x + 0.5, y + 0.5, (double)frame->z[i]));
            if (!(now >= 0) || !(then >= 0)) continue;
            if (add_value(v, (float)(fabs(then - now) / fmax(fmin(now, then), DARK)), err)) return err->status;
        }
    return ST_OK;
}

static int by_value(const void *a, const void *b)
{
    const float v = *(const float *)a, w = *(const float *)b;
    return v < w ? -1 : v > w;
}

double film_flicker_quantile(struct flicker_values *v, double fraction)
{
    if (!v->count) return 0;
    qsort(v->values, v->count, sizeof *v->values, by_value);
    return (double)v->values[(size_t)fmin(floor(fraction * (double)v->count), (double)(v->count - 1))];
}

void film_flicker_release(struct flicker_values *v)
{
    free(v->values);
    *v = (struct flicker_values){.values = NULL};
}

/* --------------------------------------------------------------------------------------------------- frames on disk */

static void picture_release_planes(struct flicker_picture *p)
{
    free(p->luminance);
    *p = (struct flicker_picture){.luminance = NULL};
}

/* *known: false if the frame cannot be read. */
static enum status read_frame(struct flicker_picture *p, bool *known, const struct view *camera, const char *folder,
                              const char *film, struct err *err)
{
    static const char *const names[] = {"R", "G", "B", "Z"};
    const struct product_key key = {.film = film, .frame = camera->name};
    const size_t pixels = (size_t)camera->width * (size_t)camera->height;
    struct exr_image im = {0};
    struct err why = ERR_INIT;
    const struct exr_plane *planes[4] = {NULL};
    char path[FILE_PATH];
    *known = false;
    if (!product_path_below(path, folder, PRODUCT_FRAME, &key, &why)) exr_read(&im, path, names, 4, &why);
    if (why.status) passing_refuse(why.text, err);
    bool whole = !why.status && im.width == camera->width && im.height == camera->height;
    for (int k = 0; whole && k < 4; k++) whole = (planes[k] = exr_find(&im, names[k])) && planes[k]->f;
    if (whole && !(p->luminance = malloc(2 * pixels * sizeof *p->luminance)))
        err_nomem(err, "a frame", 2 * pixels * sizeof *p->luminance);
    if (whole && !err->status) {
        p->camera = *camera;
        p->z = p->luminance + pixels;
        for (size_t i = 0; i < pixels; i++) {
            const float rgb[3] = {planes[0]->f[i], planes[1]->f[i], planes[2]->f[i]};
            p->luminance[i] = luminance_of(rgb);
            p->z[i] = planes[3]->f[i];
        }
        *known = true;
    }
    exr_image_release(&im);
    return err->status;
}

enum status film_flicker_measure(double *middle, double *high, bool *known, const struct camera_path *path,
                                 const char *folder, const char *film, struct err *err)
{
    const int last = path->frame_count - 1, pairs = last < PAIRS ? last : PAIRS;
    struct flicker_values v = {.values = NULL};
    *known = pairs > 0;
    for (int k = 0; *known && !err->status && k < pairs; k++) {
        const int at = (int)((long)last * k / pairs);
        struct flicker_picture now = {.luminance = NULL}, next = {.luminance = NULL};
        if (!read_frame(&now, known, &path->frames[at].camera, folder, film, err) && *known)
            read_frame(&next, known, &path->frames[at + 1].camera, folder, film, err);
        if (!err->status && *known) film_flicker_add(&v, &now, &next, STEP, err);
        picture_release_planes(&now);
        picture_release_planes(&next);
    }
    *known = *known && v.count;
    *middle = film_flicker_quantile(&v, 0.5);
    *high = film_flicker_quantile(&v, 0.95);
    film_flicker_release(&v);
    return err->status;
}
