/* light_summary.c - what is known of the light at the points of a list or of a view: a record, and pictures.
 *
 * Overview. A person wants to know whether irradiance can be trusted, and why not. The record has
 *   - shares: of the light by source (lamps, sky, textures, guesses, nothing), means over the lit points
 *   - errors: the quantiles 50 and 95 % and the maximum of the relative standard errors that the estimators state
 *   - examples: some points with their values, and a hemicube of what each receives (hemicube_picture.c). They are
 *     spread evenly over the ranking by error, the worst first, so that they show the good, the usual and the bad
 * Points without light have no relative error; they count as dark, and are ranked only if all are.
 *
 * Pictures of a view: white, the irradiance as if every surface were white, with dots at the examples; level, its
 * luminance on a logarithmic ramp between the 2nd and 98th percentile (at most a factor of 1000); unknown, the share
 * of light that was synthesised, guessed or missing. Pixels without a surface are hatched.
 *
 * Memory: the list of points, which the caller has, and one picture. */
#include "stages/gather_irradiance/light_summary.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/file_path.h"
#include "common/base/sort.h"
#include "common/image/draw.h"
#include "common/image/false_colour.h"
#include "common/image/photo.h"
#include "common/product/product.h"
#include "stages/gather_irradiance/hemicube_picture.h"

enum { QUALITY = 90, HEMICUBE = 256 /* pixels in a row of its top */ };
static const double LOWEST = 1e-3; /* of the brightest level: the least that the colours show */

static bool is_point(const struct gather_point *p) { return vec3_length(p->normal) > 0; }

static double relative_error(const struct irradiance *e)
{
    const double luminance = rgb_luminance(e->value);
    return luminance > 0 ? rgb_luminance(e->error) / luminance : 0;
}

/* ----------------------------------------------------------------------------------------------------------- record */

struct ranked {
    double error;
    size_t index;
};

/* The largest error first; equal ones in order of index. */
static int compare(const void *a, const void *b)
{
    const struct ranked *p = a, *q = b;
    if (p->error < q->error || p->error > q->error) return p->error < q->error ? 1 : -1;
    return (p->index > q->index) - (p->index < q->index);
}

/* Lit points, or if there is none all points. */
static size_t rank(struct ranked *to, const struct gather_point *points, const struct irradiance *e, size_t count,
                   bool any_lit)
{
    size_t n = 0;
    for (size_t i = 0; i < count; i++)
        if (is_point(&points[i]) && (!any_lit || rgb_luminance(e[i].value) > 0))
            to[n++] = (struct ranked){relative_error(&e[i]), i};
    qsort(to, n, sizeof *to, compare);
    return n;
}

static void choose(struct light_record *r, size_t *chosen, const struct ranked *ranked, size_t n,
                   const struct gather_point *points, const struct irradiance *e, int examples)
{
    const size_t most = examples < LIGHT_EXAMPLES_MAX ? (size_t)examples : LIGHT_EXAMPLES_MAX;
    const size_t count = most < n ? most : n;
    for (size_t i = 0; i < count; i++) {
        const struct ranked *at = &ranked[count > 1 ? i * (n - 1) / (count - 1) : 0];
        if (chosen) chosen[i] = at->index;
        r->examples[i] = (struct light_example){points[at->index], e[at->index].value, at->error};
    }
    r->example_count = (int)count;
}

enum status light_summarize(struct light_record *r, size_t chosen[LIGHT_EXAMPLES_MAX],
                            const struct gather_point *points, const struct irradiance *e, size_t count, int examples,
                            struct err *err)
{
    struct ranked *ranked = malloc((count + 1) * sizeof *ranked);
    *r = (struct light_record){0};
    if (!ranked) return err_nomem(err, "points", count * sizeof *ranked);
    for (size_t i = 0; i < count; i++) {
        if (!is_point(&points[i])) continue;
        r->points++;
        r->dark += !(rgb_luminance(e[i].value) > 0);
        for (int s = 0; s < LIGHT_SOURCES; s++) r->from[s] += e[i].from[s];
    }
    for (int s = 0; s < LIGHT_SOURCES && r->points > r->dark; s++) r->from[s] /= r->points - r->dark;
    const size_t n = rank(ranked, points, e, count, r->points > r->dark);
    if (n) {
        r->error[0] = ranked[n - 1 - n / 2].error;
        r->error[1] = ranked[(size_t)(0.05 * (double)(n - 1))].error;
        r->error[2] = ranked[0].error;
    }
    choose(r, chosen, ranked, n, points, e, examples);
    free(ranked);
    return ST_OK;
}

static enum status write_record(const struct gather_job *j, const char *name, const struct light_record *r,
                                struct err *err)
{
    char path[FILE_PATH], number[16];
    const struct product_key key = {.gathered = name, .name = number};
    for (int i = 0; i < r->example_count; i++) {
        snprintf(number, sizeof number, "%d", i + 1);
        if (product_path_in(path, j->out, PRODUCT_HEMICUBE, &key, err) ||
            hemicube_picture_write(&j->field.field, r->examples[i].point, HEMICUBE, path, err))
            return err->status;
    }
    if (product_path_in(path, j->out, PRODUCT_LIGHT_RECORD, &key, err)) return err->status;
    return light_record_write(r, path, &j->prov, err);
}

enum status light_summary_of_points(const struct gather_job *j, const char *name, const struct gather_point *points,
                                    const struct irradiance *e, size_t count, struct err *err)
{
    struct light_record r;
    if (light_summarize(&r, NULL, points, e, count, j->hemicubes, err)) return err->status;
    return write_record(j, name, &r, err);
}

/* --------------------------------------------------------------------------------------------------------- pictures */

struct sketch {
    const struct gather_job *job;
    const struct view *view;
    const struct gather_point *points;
    const struct irradiance *e;
    size_t pixels;
    char name[FILE_PATH]; /* below the folder of the job */
    unsigned char *rgb;
};

/* The ends of the colours: all but the darkest and the brightest 2 %. */
static enum status find_levels(double level[2], const struct sketch *s, struct err *err)
{
    double *sorted = malloc((s->pixels + 1) * sizeof *sorted);
    size_t n = 0;
    if (!sorted) return err_nomem(err, "a picture", s->pixels * sizeof *sorted);
    for (size_t i = 0; i < s->pixels; i++)
        if (is_point(&s->points[i])) sorted[n++] = rgb_luminance(s->e[i].value);
    sort_doubles(sorted, n);
    level[1] = n ? sorted[(size_t)(0.98 * (double)(n - 1))] : 0;
    level[0] = n ? fmax(sorted[(size_t)(0.02 * (double)(n - 1))], LOWEST * level[1]) : 0;
    free(sorted);
    return ST_OK;
}

static void put_hatched(unsigned char rgb[3], size_t pixel, int width)
{
    memset(rgb, (pixel % (size_t)width + pixel / (size_t)width) % 8 < 3 ? 120 : 165, 3);
}

static enum status write_picture(const struct sketch *s, enum product_id id, struct err *err)
{
    char path[FILE_PATH];
    for (size_t i = 0; i < s->pixels; i++)
        if (!is_point(&s->points[i])) put_hatched(s->rgb + 3 * i, i, s->view->width);
    if (product_path_in(path, s->job->out, id, &(struct product_key){.gathered = s->name}, err)) return err->status;
    return jpeg_write(path, s->rgb, s->view->width, s->view->height, QUALITY, err);
}

static void draw_examples(const struct sketch *s, const size_t *chosen, int count)
{
    const struct canvas k = {s->rgb, s->view->width, s->view->height};
    for (int i = 0; i < count; i++) {
        unsigned char colour[3];
        colour_of_category(i, colour);
        draw_dot(&k, (double)(chosen[i] % (size_t)k.width) + 0.5, (double)(chosen[i] / (size_t)k.width) + 0.5,
                 fmax(4, k.width / 70.0), colour);
    }
}

static enum status draw_white(const struct sketch *s, const size_t *chosen, int count, struct err *err)
{
    struct image im = {0};
    image_init(&im, s->view->width, s->view->height, 4, err);
    for (size_t i = 0; !err->status && i < s->pixels; i++) {
        const struct rgb v = s->e[i].value;
        const float pixel[4] = {(float)v.r, (float)v.g, (float)v.b, is_point(&s->points[i])};
        memcpy(im.data + 4 * i, pixel, sizeof pixel);
    }
    if (!err->status && !image_expose(&im, 0.9, 0.6, err)) {
        image_to_srgb8(&im, s->rgb);
        draw_examples(s, chosen, count);
        write_picture(s, PRODUCT_IRRADIANCE_WHITE, err);
    }
    image_release(&im);
    return err->status;
}

static enum status draw_levels(const struct sketch *s, const double level[2], struct err *err)
{
    const double span = level[0] > 0 ? log(level[1] / level[0]) : 0;
    for (size_t i = 0; i < s->pixels; i++) {
        const double luminance = rgb_luminance(s->e[i].value);
        colour_of_ramp(luminance > 0 && span > 0 ? log(luminance / level[0]) / span : 0, s->rgb + 3 * i);
    }
    return write_picture(s, PRODUCT_IRRADIANCE_LEVEL, err);
}

static enum status draw_unknown(const struct sketch *s, struct err *err)
{
    for (size_t i = 0; i < s->pixels; i++) {
        const double *from = s->e[i].from;
        colour_of_ramp(from[LIGHT_SYNTHESISED] + from[LIGHT_SKY_GUESSED] + from[LIGHT_NONE], s->rgb + 3 * i);
    }
    return write_picture(s, PRODUCT_IRRADIANCE_UNKNOWN, err);
}

enum status light_summary_of_view(const struct gather_job *j, const struct view *view,
                                  const struct gather_point *points, const struct irradiance *e, struct err *err)
{
    struct light_record r;
    size_t chosen[LIGHT_EXAMPLES_MAX];
    struct sketch s = {j, view, points, e, (size_t)view->width * (size_t)view->height, "", NULL};
    light_summarize(&r, chosen, points, e, s.pixels, j->hemicubes, err);
    s.rgb = malloc(3 * s.pixels);
    if (!err->status && !s.rgb) err_nomem(err, "a picture", 3 * s.pixels);
    if (!err->status && !file_path(s.name, "irradiance", view->name, "", err) && !find_levels(r.level, &s, err) &&
        !draw_white(&s, chosen, r.example_count, err) && !draw_levels(&s, r.level, err) && !draw_unknown(&s, err))
        write_record(j, s.name, &r, err);
    free(s.rgb);
    return err->status;
}
