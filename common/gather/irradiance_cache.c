/* irradiance_cache.c - irradiance at many points: indirect light from few records, direct light at each point.
 *
 * Overview. Light that surfaces reflect changes slowly along a surface. It is gathered at records (cache_record.c) and
 * extrapolated from those nearby. Light of lamps and of the sky through openings is gathered at each point by rays
 * towards them, since shadows have edges. What a ray sees, and its direction, decide which of the two it
 * belongs to, so all light is counted exactly once.
 *
 * Placing. Points of every 32nd column and row come first, then of every 16th, and so on to all. On each level, the
 * points that no record covers yet become records, all at once. Records therefore depend on the points alone, not on
 * threads or on their order; about twice as many are made as one after another would take.
 *
 * Mathematics. A record at p_i with normal n_i and radius R_i is off by e_i = |p - p_i| / R_i + sqrt(1 - n . n_i) at
 * (p, n) [Ward 1988]. It covers the point if e_i < a; the irradiance is the mean of the records' extrapolations with
 * the weights 1 - e_i / a, which fade to 0 at the border. With gradients, errors grow with the square of e_i: a = 1.6
 * sqrt(target), found on a room of patches and confirmed on photographed rooms (docs/benchmarks.md). A record that lies
 * in front of the point is not used: things between them may hide what it sees. Radii are limited to a few points'
 * spacing below, so that corners do not get a record at each point, and to a tenth of the scene above.
 *
 * Two fields. For the quotient of irradiance in two fields, each record holds both, from the same rays; its radius is
 * the smaller one. Direct light is gathered in both by the same rays until the quotient is known well enough, so that
 * noise which both share does not count, and none is spent where nothing has changed. Where the light in the second
 * field counts by itself, as on a wall that an edit adds, it ends when that light is known, too, and cells are cut by
 * the noise of the light.
 *
 * Errors of the quotient. Both fields have the same rays, so b - q a has the noise that they do not share: of direct
 * light replicate by replicate, of records cell by cell. Where the edit changes nothing it is 0, whatever the noise of
 * each.
 *
 * Cells. With a step above 1, points are gathered at the corners of cells, and within those whose quotients differ by
 * more than the target and four times their noise, or whose points do not lie between the corners (grid_cells.c).
 * Means of lights that are equal before and after are equal: the quotient of what does not change is exactly 1.
 *
 * Source: [Ward 1988] for records, [Ward 1992b] for gradients. Different here: direct light at each point; weights that
 * fade; placing by levels. */
#include "common/gather/irradiance_cache.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/base/parallel.h"
#include "common/gather/cache_record.h"
#include "common/gather/cache_tree.h"
#include "common/gather/grid_cells.h"

enum { COARSEST = 32, CHUNK = 64, RECORD_RAYS = 1024, FEW_RAYS = 256, DIRECT_RAYS = 64 };
static const double SPREAD = 1.6;    /* a over the square root of the target */
static const double SPACINGS = 1;    /* a record reaches at least that many points' spacing */
static const double WIDEST = 0.1;    /* of the points' box: a record reaches at most that far */
static const double IN_FRONT = 0.05; /* of the radius */
static const double PARALLEL = 0.95; /* least cosine of normals between which light is interpolated */
static const double OFF = 0.25; /* of a cell's size: how far its points may be from the place between its corners */
static const double SHARE = 1;  /* of the target, for each of records and direct light; most points are far below it */

static const double OWN =
    4; /* of the target: how well the light in each field must be known where the quotient counts */

enum { SIDES = 2 };

/* Luminance in each field. */
struct irradiance_sides {
    double light[SIDES];
};

/* A record in one field, or in both. */
struct record {
    struct cache_record side[SIDES]; /* they share the radius */
    double change_error;             /* standard error of the luminance of b - q a */
};

struct side {
    const struct light_field *field;
    const struct gather_point *points;
    struct irradiance *results;
};

struct cache {
    const struct irradiance_cache_job *job;
    struct side sides[SIDES];
    int side_count;
    struct record *records;
    size_t record_count, capacity;
    struct cache_tree tree;
    double accuracy, widest; /* a; the longest reach a R */
    size_t *wanted;          /* points that become records */
    size_t wanted_count;
    unsigned char *is_wanted;
    int step, grid_step;    /* of the level; of the cells */
    struct grid_cells grid; /* points to evaluate */
};

static bool is_point(const struct gather_point *p) { return vec3_length(p->normal) > 0; }

/* Whether light in the second field counts by itself at a point, not by the quotient. */
static bool is_whole(const struct cache *c, size_t i) { return c->job->other.whole && c->job->other.whole[i]; }

/* ----------------------------------------------------------------------------------------------------------- lookup */

struct lookup_side {
    struct gather_point point;
    double error, radiance[LIGHT_SOURCES], nearest, mean_inverse;
    struct rgb sum;
};

struct lookup {
    const struct cache *cache;
    double weight, change_error;
    struct lookup_side side[SIDES];
};

/* The weight of a record at a point, not above 0 where it does not count. */
static double weigh(const struct cache *c, const struct cache_record *r, const struct gather_point *p)
{
    const struct vec3 by = vec3_sub(p->at, r->point.at);
    const double distance = vec3_length(by) / r->radius;
    if (!(distance < c->accuracy)) return 0;
    const double off = distance + sqrt(fmax(0, 1 - vec3_dot(p->normal, r->point.normal)));
    if (vec3_dot(by, vec3_add(p->normal, r->point.normal)) / 2 < -IN_FRONT * r->radius) return 0;
    return 1 - off / c->accuracy;
}

static void add_side(struct lookup_side *l, const struct cache_record *r, double w)
{
    l->sum = rgb_add(l->sum, rgb_scale(cache_record_at(r, l->point), w));
    l->error += w * r->error;
    for (int s = 0; s < LIGHT_SOURCES; s++) l->radiance[s] += w * r->light[s];
    l->mean_inverse += w * r->mean_inverse;
    if (r->nearest < l->nearest) l->nearest = r->nearest;
}

static void add_record(void *ctx, int index)
{
    struct lookup *l = ctx;
    const struct cache *c = l->cache;
    const struct record *r = &c->records[index];
    double w = 1;
    for (int k = 0; k < c->side_count; k++) w = fmin(w, weigh(c, &r->side[k], &l->side[k].point));
    if (!(w > 0)) return;
    l->weight += w;
    l->change_error += w * r->change_error;
    for (int k = 0; k < c->side_count; k++) add_side(&l->side[k], &r->side[k], w);
}

static void look_up(struct lookup *l, const struct cache *c, size_t i)
{
    *l = (struct lookup){.cache = c};
    for (int k = 0; k < c->side_count; k++)
        l->side[k] = (struct lookup_side){.point = c->sides[k].points[i], .nearest = INFINITY};
    cache_tree_find(&c->tree, l->side[0].point.at, add_record, l);
}

/* ---------------------------------------------------------------------------------------------------------- placing */

static void mark_row(void *ctx, size_t begin, size_t end, int thread)
{
    const struct cache *c = ctx;
    const size_t width = (size_t)c->job->width;
    (void)thread;
    for (size_t row = begin; row < end; row++)
        for (size_t x = 0; x < width; x += (size_t)c->step) {
            const size_t i = row * (size_t)c->step * width + x;
            struct lookup l;
            if (!is_point(&c->job->points[i])) continue;
            look_up(&l, c, i);
            c->is_wanted[i] = !(l.weight > 0);
        }
}

static void list_wanted(struct cache *c)
{
    const size_t points = (size_t)c->job->width * (size_t)c->job->height;
    c->wanted_count = 0;
    for (size_t i = 0; i < points; i++) {
        if (c->is_wanted[i]) c->wanted[c->wanted_count++] = i;
        c->is_wanted[i] = 0;
    }
}

/* Distance to the nearest of the four neighbours; INFINITY if there is none. */
static double spacing(const struct irradiance_cache_job *j, size_t i)
{
    const int x = (int)(i % (size_t)j->width), y = (int)(i / (size_t)j->width);
    const int dx[4] = {1, -1, 0, 0}, dy[4] = {0, 0, 1, -1};
    double nearest = INFINITY;
    for (int k = 0; k < 4; k++) {
        const int u = x + dx[k], v = y + dy[k];
        if (u < 0 || v < 0 || u >= j->width || v >= j->height) continue;
        const struct gather_point *p = &j->points[(size_t)v * (size_t)j->width + (size_t)u];
        if (is_point(p)) nearest = fmin(nearest, vec3_length(vec3_sub(p->at, j->points[i].at)));
    }
    return nearest;
}

static double direct_luminance(const struct cache *c, int side, size_t i)
{
    struct mixture m;
    struct irradiance e;
    mixture_init(&m, c->sides[side].field, c->sides[side].points[i], MIXTURE_LIGHTS);
    if (!m.count) return 0;
    mixture_gather(&e, &m, DIRECT_RAYS, c->job->key + i, false);
    return rgb_luminance(e.value);
}

/* By what light changes from the first field to the second, direct light included; 0: it was dark. */
static double quotient_of(const struct irradiance_sides *l) { return l->light[0] > 0 ? l->light[1] / l->light[0] : 0; }

/* Whether a record of both fields is known well enough: their quotient to the target, and each of them to OWN of it, or
 * the target too where it counts by itself. */
static bool is_record_known(const struct record *r, const struct cache *c, size_t i, const double beside[SIDES])
{
    const double target = SHARE * c->job->target;
    const double own = c->side_count == 1 || is_whole(c, i) ? target : OWN * target;
    for (int k = 0; k < c->side_count; k++)
        if (r->side[k].error > own * (beside[k] + rgb_luminance(r->side[k].value))) return false;
    return c->side_count == 1 || r->change_error <= target * (beside[1] + rgb_luminance(r->side[1].value));
}

/* Gathers a record in each field, with as many rays as the more demanding one asks for. */
static void gather_record(struct record *r, const struct cache *c, size_t i)
{
    struct cache_cells cells[SIDES];
    double beside[SIDES] = {0};
    int spent = 0;
    for (int k = 0; k < c->side_count; k++) beside[k] = direct_luminance(c, k, i);
    for (int rays = c->side_count == SIDES ? FEW_RAYS : RECORD_RAYS;; rays *= 4) {
        struct irradiance_sides l = {{0}};
        for (int k = 0; k < c->side_count; k++) {
            cache_record_gather_once(&r->side[k], c->sides[k].field, c->sides[k].points[i], rays, c->job->key + i,
                                     c->side_count == SIDES ? &cells[k] : NULL);
            l.light[k] = beside[k] + rgb_luminance(r->side[k].value);
        }
        r->change_error = c->side_count == SIDES ? cache_cells_error(&cells[0], &cells[1], quotient_of(&l)) : 0;
        spent += r->side[0].rays;
        if (is_record_known(r, c, i, beside) || rays >= 16 * RECORD_RAYS) break;
    }
    for (int k = 0; k < c->side_count; k++) r->side[k].rays = spent;
}

static void gather_records(void *ctx, size_t begin, size_t end, int thread)
{
    struct cache *c = ctx;
    (void)thread;
    for (size_t n = begin; n < end; n++) {
        const size_t i = c->wanted[n];
        struct record *r = &c->records[c->record_count + n];
        double radius = INFINITY;
        gather_record(r, c, i);
        for (int k = 0; k < c->side_count; k++) radius = fmin(radius, r->side[k].radius);
        const double gap = spacing(c->job, i), least = isfinite(gap) ? SPACINGS * gap / c->accuracy : 0;
        radius = fmin(fmax(radius, least), c->widest / c->accuracy);
        if (!(radius > 0)) radius = 1e-9 * c->widest / c->accuracy;
        for (int k = 0; k < c->side_count; k++) r->side[k].radius = radius;
        if (c->job->done) c->job->done(c->job->done_ctx, 0);
    }
}

/* Makes records of the wanted points, all at once. */
static enum status add_records(struct cache *c, struct err *err)
{
    if (array_reserve(&c->records, &c->capacity, c->record_count + c->wanted_count, sizeof *c->records,
                      "a cache of irradiance", err))
        return err->status;
    parallel_for(c->wanted_count, 1, gather_records, c);
    for (size_t k = 0; k < c->wanted_count; k++) {
        const struct cache_record *r = &c->records[c->record_count].side[0];
        if (cache_tree_add(&c->tree, (int)c->record_count++, r->point.at, c->accuracy * r->radius, err))
            return err->status;
    }
    return ST_OK;
}

static enum status add_level(struct cache *c, struct err *err)
{
    const size_t rows = ((size_t)c->job->height + (size_t)c->step - 1) / (size_t)c->step;
    parallel_for(rows, 1, mark_row, c);
    list_wanted(c);
    return add_records(c, err);
}

static void mark_listed(void *ctx, size_t begin, size_t end, int thread)
{
    const struct cache *c = ctx;
    (void)thread;
    for (size_t n = begin; n < end; n++) {
        const size_t i = c->grid.wanted[n];
        struct lookup l;
        if (!is_point(&c->job->points[i])) continue;
        look_up(&l, c, i);
        c->is_wanted[i] = !(l.weight > 0);
    }
}

/* Covers the points that the grid wants. */
static enum status add_listed(struct cache *c, struct err *err)
{
    parallel_for(c->grid.wanted_count, CHUNK, mark_listed, c);
    list_wanted(c);
    return add_records(c, err);
}

/* ------------------------------------------------------------------------------------------------------- evaluation */

/* Standard error of the luminance of b - q a, replicate by replicate: the noise that both fields do not share. */
static double change_error(const struct mixture m[SIDES], double q)
{
    double sum = 0, squares = 0;
    for (int r = 0; r < MIXTURE_REPLICATES; r++) {
        const double d = rgb_luminance(m[1].replicates[r]) - q * rgb_luminance(m[0].replicates[r]);
        sum += d;
        squares += d * d;
    }
    const double variance = fmax(0, squares - sum * sum / MIXTURE_REPLICATES);
    return sqrt(variance / (MIXTURE_REPLICATES * (MIXTURE_REPLICATES - 1.0)));
}

/* The same rays in both fields, until the quotient is known, and the light in the second field where it counts by
 * itself. The result is the standard error of b - q a. */
static double gather_direct_of_both(struct irradiance e[SIDES], const struct cache *c, size_t i,
                                    const double beside[SIDES])
{
    struct mixture m[SIDES];
    double error = 0;
    int spent = 0;
    for (int k = 0; k < SIDES; k++) {
        e[k] = (struct irradiance){.nearest = INFINITY};
        mixture_init(&m[k], c->sides[k].field, c->sides[k].points[i], MIXTURE_LIGHTS);
    }
    if (!m[0].count && !m[1].count) return 0;
    for (int rays = DIRECT_RAYS;; rays *= 4) {
        struct irradiance_sides l;
        for (int k = 0; k < SIDES; k++) {
            if (m[k].count) mixture_gather(&e[k], &m[k], rays, c->job->key + i, false);
            l.light[k] = beside[k] + rgb_luminance(e[k].value);
        }
        spent += e[0].rays > e[1].rays ? e[0].rays : e[1].rays;
        error = change_error(m, quotient_of(&l));
        const bool whole = is_whole(c, i), is_dark = !(l.light[1] > 0 && (whole || l.light[0] > 0));
        const double noise = whole ? fmax(error, rgb_luminance(e[1].error)) : error;
        if (is_dark || !(noise > SHARE * c->job->target * l.light[1]) || spent + 4 * rays > c->job->rays) break;
    }
    for (int k = 0; k < SIDES; k++) e[k].rays = spent;
    return error;
}

static double gather_direct(struct irradiance e[SIDES], const struct cache *c, size_t i, const double beside[SIDES])
{
    struct mixture m;
    if (c->side_count == SIDES) return gather_direct_of_both(e, c, i, beside);
    mixture_init(&m, c->job->field, c->job->points[i], MIXTURE_LIGHTS);
    e[0] = (struct irradiance){.nearest = INFINITY};
    if (m.count)
        mixture_gather_to(e, &m, SHARE * c->job->target, beside[0], DIRECT_RAYS, c->job->rays, c->job->key + i);
    return 0;
}

static double both(double a, double b) { return sqrt(a * a + b * b); }

static void add_indirect(struct irradiance *e, const struct lookup_side *l, double weight)
{
    const double scale = 1 / weight, direct = rgb_luminance(e->value), error = l->error * scale;
    double sum = 0;
    for (int s = 0; s < LIGHT_SOURCES; s++) sum += e->from[s] = e->from[s] * direct + l->radiance[s] * scale;
    for (int s = 0; s < LIGHT_SOURCES && sum > 0; s++) e->from[s] /= sum;
    e->value = rgb_add(e->value, rgb_scale(l->sum, scale));
    e->error = rgb_make(both(e->error.r, error), both(e->error.g, error), both(e->error.b, error));
    e->mean_inverse = l->mean_inverse * scale;
    e->nearest = fmin(e->nearest, l->nearest);
}

static void evaluate(void *ctx, size_t begin, size_t end, int thread)
{
    struct cache *c = ctx;
    (void)thread;
    for (size_t n = begin; n < end; n++) {
        const size_t i = c->grid.wanted[n];
        struct irradiance e[SIDES];
        struct lookup l;
        double beside[SIDES] = {0};
        if (!is_point(&c->job->points[i])) continue;
        look_up(&l, c, i);
        for (int k = 0; k < c->side_count; k++) beside[k] = rgb_luminance(l.side[k].sum) / l.weight;
        const double error = both(gather_direct(e, c, i, beside), l.change_error / l.weight);
        for (int k = 0; k < c->side_count; k++) {
            add_indirect(&e[k], &l.side[k], l.weight);
            c->sides[k].results[i] = e[k];
        }
        const double light = rgb_luminance(e[c->side_count - 1].value);
        if (c->job->other.errors) c->job->other.errors[i] = light > 0 ? (float)(error / light) : 0;
    }
    if (c->job->done) c->job->done(c->job->done_ctx, end - begin);
}

/* ---------------------------------------------------------------------------------------------------- interpolation */

static void cell_weights(const struct grid_cell *cell, int x, int y, double weights[4])
{
    const double u = cell->x[1] > cell->x[0] ? (x - cell->x[0]) / (double)(cell->x[1] - cell->x[0]) : 0;
    const double v = cell->y[1] > cell->y[0] ? (y - cell->y[0]) / (double)(cell->y[1] - cell->y[0]) : 0;
    weights[0] = (1 - u) * (1 - v), weights[1] = u * (1 - v), weights[2] = (1 - u) * v, weights[3] = u * v;
}

/* Whether a point lies near the place between the corners, and has the direction of one of them. */
static bool is_between(const struct gather_point *p, const struct gather_point *const corners[4],
                       const double weights[4], double most)
{
    struct vec3 at = {0, 0, 0};
    double cosine = -1;
    for (int k = 0; k < 4; k++) {
        at = vec3_add(at, vec3_scale(corners[k]->at, weights[k]));
        cosine = fmax(cosine, vec3_dot(p->normal, corners[k]->normal));
    }
    return cosine > PARALLEL && vec3_length(vec3_sub(p->at, at)) <= most;
}

static bool is_one_surface(const struct cache *c, int side, const struct grid_cell *cell, const size_t corners[4])
{
    const struct gather_point *p = c->sides[side].points;
    const struct gather_point *at[4];
    for (int k = 0; k < 4; k++) at[k] = &p[corners[k]];
    const double size = fmax(vec3_length(vec3_sub(at[3]->at, at[0]->at)), vec3_length(vec3_sub(at[2]->at, at[1]->at)));
    for (int y = cell->y[0]; y <= cell->y[1]; y++)
        for (int x = cell->x[0]; x <= cell->x[1]; x++) {
            const struct gather_point *q = &p[(size_t)y * (size_t)c->job->width + (size_t)x];
            double weights[4];
            cell_weights(cell, x, y, weights);
            if (is_point(q) && !is_between(q, at, weights, OFF * size)) return false;
        }
    return true;
}

static double channel(struct rgb a, int k) { return k == 0 ? a.r : k == 1 ? a.g : a.b; }

/* The largest and the smallest of four values differ by less than a part of them. */
static bool are_alike(const double v[4], double part)
{
    double low = v[0], high = v[0];
    for (int k = 1; k < 4; k++) low = fmin(low, v[k]), high = fmax(high, v[k]);
    return high - low <= part * low;
}

/* Whether the light at the corners tells that between them, up to its noise. */
static bool is_light_alike(const struct cache *c, const size_t corners[4])
{
    const float *errors = c->job->other.errors;
    bool any_whole = false;
    double error = 0, noise = 0; /* of the quotient; of light by itself */
    for (int k = 0; k < 4; k++) {
        const struct irradiance *e = &c->sides[1].results[corners[k]];
        const double value = rgb_luminance(e->value);
        any_whole |= is_whole(c, corners[k]);
        if (errors) error = fmax(error, (double)errors[corners[k]]);
        if (value > 0) noise = fmax(noise, rgb_luminance(e->error) / value);
    }
    for (int s = 0; s < 3; s++) {
        double quotient[4], light[4];
        for (int k = 0; k < 4; k++) {
            const double a = channel(c->sides[0].results[corners[k]].value, s);
            light[k] = channel(c->sides[1].results[corners[k]].value, s);
            quotient[k] = light[k] == a ? 1 : a > 0 ? light[k] / a : INFINITY;
        }
        if (!are_alike(quotient, c->job->target + 4 * error)) return false;
        if (any_whole && !are_alike(light, c->job->target + 4 * noise)) return false;
    }
    return true;
}

static bool is_flat(const void *ctx, const struct grid_cell *cell, const size_t corners[4])
{
    const struct cache *c = ctx;
    for (int k = 0; k < 4; k++)
        if (!is_point(&c->job->points[corners[k]])) return false;
    return is_light_alike(c, corners) && is_one_surface(c, 0, cell, corners) && is_one_surface(c, 1, cell, corners);
}

static struct irradiance between(const struct irradiance *all, const size_t corners[4], const double weights[4])
{
    struct irradiance e = {.nearest = INFINITY};
    for (int k = 0; k < 4; k++) {
        const struct irradiance *f = &all[corners[k]];
        e.value = rgb_add(e.value, rgb_scale(f->value, weights[k]));
        e.error = rgb_add(e.error, rgb_scale(f->error, weights[k]));
        for (int s = 0; s < LIGHT_SOURCES; s++) e.from[s] += weights[k] * f->from[s];
        e.mean_inverse += weights[k] * f->mean_inverse;
        e.nearest = fmin(e.nearest, f->nearest);
    }
    return e;
}

static void fill_between(const void *ctx, size_t point, const size_t corners[4], const double weights[4])
{
    const struct cache *c = ctx;
    double error = 0;
    if (!is_point(&c->job->points[point])) return;
    for (int k = 0; k < SIDES; k++) c->sides[k].results[point] = between(c->sides[k].results, corners, weights);
    if (!c->job->other.errors) return;
    for (int k = 0; k < 4; k++) error += weights[k] * (double)c->job->other.errors[corners[k]];
    c->job->other.errors[point] = (float)error;
}

/* Evaluates points until all are set. */
static enum status evaluate_all(struct cache *c, struct err *err)
{
    const struct grid_fill fill = {c, is_flat, fill_between};
    while (!err->status && (c->grid.wanted_count || c->grid.count)) {
        if (add_listed(c, err)) return err->status;
        parallel_for(c->grid.wanted_count, CHUNK, evaluate, c);
        grid_cells_next(&c->grid, &fill, err);
    }
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------- fill */

static void clear_results(struct cache *c)
{
    const size_t points = (size_t)c->job->width * (size_t)c->job->height;
    for (int k = 0; k < c->side_count; k++)
        for (size_t i = 0; i < points; i++) c->sides[k].results[i] = (struct irradiance){0};
    for (size_t i = 0; c->job->other.errors && i < points; i++) c->job->other.errors[i] = 0;
}

static enum status start(struct cache *c, struct err *err)
{
    const struct irradiance_cache_job *j = c->job;
    const size_t points = (size_t)j->width * (size_t)j->height;
    struct vec3 low = {INFINITY, INFINITY, INFINITY}, high = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < points; i++) {
        const struct vec3 p = j->points[i].at;
        if (!is_point(&j->points[i])) continue;
        low = vec3_make(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
        high = vec3_make(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
    }
    if (!(low.x <= high.x)) low = high = vec3_make(0, 0, 0);
    c->accuracy = SPREAD * sqrt(j->target);
    c->widest = fmax(WIDEST * vec3_length(vec3_sub(high, low)), 1e-9);
    c->wanted = malloc((points + 1) * sizeof *c->wanted);
    c->is_wanted = calloc(points + 1, 1);
    if (!c->wanted || !c->is_wanted) return err_nomem(err, "a cache of irradiance", points * 9);
    return cache_tree_init(&c->tree, low, high, err);
}

static void count(struct irradiance_cache_stats *stats, const struct cache *c)
{
    const size_t points = (size_t)c->job->width * (size_t)c->job->height;
    *stats = (struct irradiance_cache_stats){.records = c->record_count};
    for (size_t i = 0; i < c->record_count; i++) stats->record_rays += c->records[i].side[0].rays;
    for (size_t i = 0; i < points; i++) stats->direct_rays += c->sides[0].results[i].rays;
}

bool irradiance_cache_suits(const struct light_field *f) { return f->emitter_count < MIXTURE_MAX; }

enum status irradiance_cache_fill(struct irradiance *results, const struct irradiance_cache_job *j,
                                  struct irradiance_cache_stats *stats, struct err *err)
{
    struct cache c = {.job = j, .sides = {{j->field, j->points, results}}, .side_count = j->other.field ? SIDES : 1};
    c.sides[1] = (struct side){j->other.field, j->other.points, j->other.results};
    c.grid_step = c.side_count == SIDES && j->other.step > 1 ? j->other.step : 1;
    clear_results(&c);
    start(&c, err);
    for (c.step = COARSEST; !err->status && c.step >= c.grid_step; c.step /= 2) add_level(&c, err);
    if (!err->status) grid_cells_start(&c.grid, j->width, j->height, c.grid_step, err);
    if (!err->status) evaluate_all(&c, err);
    if (!err->status && stats) count(stats, &c);
    grid_cells_release(&c.grid);
    cache_tree_release(&c.tree);
    free(c.records);
    free(c.wanted);
    free(c.is_wanted);
    return err->status;
}
