/* irradiance_cache.c - irradiance at many points: indirect light from few records, direct light at each point.
 *
 * Overview. Light that surfaces reflect changes slowly along a surface. It is gathered at records (cache_record.c) and
 * extrapolated from those nearby. Light of lamps and of the sky through openings is gathered at each point by rays towards
 * them, since shadows have edges. The two are told apart by what a ray sees and in which direction, so that together
 * they are all light.
 *
 * Placing. Points of every 32nd column and row come first, then of every 16th, and so on to all. On each level, the points
 * that no record covers yet become records, all at once. Records therefore depend on the points alone, not on threads or
 * on their order; about twice as many are made as one after another would take.
 *
 * Mathematics. A record at p_i with normal n_i and radius R_i is off by e_i = |p - p_i| / R_i + sqrt(1 - n . n_i) at (p, n)
 * [Ward 1988]. It covers the point if e_i < a; the irradiance is the mean of the records' extrapolations with the weights
 * 1 - e_i / a, which fade to 0 at the border. With gradients, errors grow with the square of e_i: a = 1.6 sqrt(target),
 * found on a room of patches and confirmed on photographed rooms (docs/benchmarks.md). A record that lies in front of the
 * point is not used: things between them may hide what it sees. Radii are limited to a few points' spacing below, so that
 * corners do not get a record at each point, and to a tenth of the scene above.
 *
 * Source: [Ward 1988] for records, [Ward 1992b] for gradients. Different here: direct light at each point; weights that fade;
 * placing by levels. */
#include "common/gather/irradiance_cache.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/base/parallel.h"
#include "common/gather/cache_record.h"
#include "common/gather/cache_tree.h"

enum { COARSEST = 32, CHUNK = 64, RECORD_RAYS = 1024, DIRECT_RAYS = 64 };
static const double SPREAD = 1.6;    /* a over the square root of the target */
static const double SPACINGS = 1;    /* a record reaches at least that many points' spacing */
static const double WIDEST = 0.1;    /* of the points' box: a record reaches at most that far */
static const double IN_FRONT = 0.05; /* of the radius */
static const double SHARE = 1; /* of the target, for each of records and direct light; most points are far below it */

struct cache {
    const struct irradiance_cache_job *job;
    struct irradiance *results;
    struct cache_record *records;
    size_t record_count, capacity;
    struct cache_tree tree;
    double accuracy, widest; /* a; the longest reach a R */
    size_t *wanted;          /* points that become records */
    size_t wanted_count;
    unsigned char *is_wanted;
    int step;
};

static bool is_point(const struct gather_point *p) { return vec3_length(p->normal) > 0; }

/* -------------------------------------------------------------------------------------------------------------- lookup */

struct lookup {
    const struct cache *cache;
    struct gather_point point;
    double weight, error, radiance[LIGHT_SOURCES], nearest, mean_inverse;
    struct rgb sum;
};

static void add_record(void *ctx, int index)
{
    struct lookup *l = ctx;
    const struct cache_record *r = &l->cache->records[index];
    const struct vec3 by = vec3_sub(l->point.at, r->point.at);
    const double distance = vec3_length(by) / r->radius;
    if (!(distance < l->cache->accuracy)) return;
    const double off = distance + sqrt(fmax(0, 1 - vec3_dot(l->point.normal, r->point.normal)));
    const double w = 1 - off / l->cache->accuracy;
    if (!(w > 0)) return;
    if (vec3_dot(by, vec3_add(l->point.normal, r->point.normal)) / 2 < -IN_FRONT * r->radius) return;
    l->weight += w;
    l->sum = rgb_add(l->sum, rgb_scale(cache_record_at(r, l->point), w));
    l->error += w * r->error;
    for (int s = 0; s < LIGHT_SOURCES; s++) l->radiance[s] += w * r->light[s];
    l->mean_inverse += w * r->mean_inverse;
    if (r->nearest < l->nearest) l->nearest = r->nearest;
}

static void look_up(struct lookup *l, const struct cache *c, size_t i)
{
    *l = (struct lookup){.cache = c, .point = c->job->points[i], .nearest = INFINITY};
    cache_tree_find(&c->tree, l->point.at, add_record, l);
}

/* ------------------------------------------------------------------------------------------------------------- placing */

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

static double direct_luminance(const struct cache *c, size_t i)
{
    struct mixture m;
    struct irradiance e;
    mixture_init(&m, c->job->field, c->job->points[i], MIXTURE_LIGHTS);
    if (!m.count) return 0;
    mixture_gather(&e, &m, DIRECT_RAYS, c->job->key + i, false);
    return rgb_luminance(e.value);
}

static void gather_records(void *ctx, size_t begin, size_t end, int thread)
{
    struct cache *c = ctx;
    (void)thread;
    for (size_t k = begin; k < end; k++) {
        const size_t i = c->wanted[k];
        struct cache_record *r = &c->records[c->record_count + k];
        cache_record_gather(r, c->job->field, c->job->points[i], SHARE * c->job->target, direct_luminance(c, i),
                            RECORD_RAYS, c->job->key + i);
        const double gap = spacing(c->job, i), least = isfinite(gap) ? SPACINGS * gap / c->accuracy : 0;
        r->radius = fmin(fmax(r->radius, least), c->widest / c->accuracy);
        if (!(r->radius > 0)) r->radius = 1e-9 * c->widest / c->accuracy;
    }
}

static enum status add_level(struct cache *c, struct err *err)
{
    const size_t rows = ((size_t)c->job->height + (size_t)c->step - 1) / (size_t)c->step;
    parallel_for(rows, 1, mark_row, c);
    list_wanted(c);
    if (array_reserve(&c->records, &c->capacity, c->record_count + c->wanted_count, sizeof *c->records,
                      "a cache of irradiance", err))
        return err->status;
    parallel_for(c->wanted_count, 1, gather_records, c);
    for (size_t k = 0; k < c->wanted_count; k++) {
        const struct cache_record *r = &c->records[c->record_count];
        if (cache_tree_add(&c->tree, (int)c->record_count++, r->point.at, c->accuracy * r->radius, err))
            return err->status;
    }
    return ST_OK;
}

/* ---------------------------------------------------------------------------------------------------------- evaluation */

static void gather_direct(struct irradiance *e, const struct cache *c, size_t i, double beside)
{
    struct mixture m;
    mixture_init(&m, c->job->field, c->job->points[i], MIXTURE_LIGHTS);
    *e = (struct irradiance){.nearest = INFINITY};
    if (m.count) mixture_gather_to(e, &m, SHARE * c->job->target, beside, DIRECT_RAYS, c->job->rays, c->job->key + i);
}

static double both(double a, double b) { return sqrt(a * a + b * b); }

static void add_indirect(struct irradiance *e, const struct lookup *l)
{
    const double scale = 1 / l->weight, direct = rgb_luminance(e->value), error = l->error * scale;
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
    for (size_t i = begin; i < end; i++) {
        struct lookup l;
        c->results[i] = (struct irradiance){0};
        if (!is_point(&c->job->points[i])) continue;
        look_up(&l, c, i);
        gather_direct(&c->results[i], c, i, rgb_luminance(l.sum) / l.weight);
        add_indirect(&c->results[i], &l);
    }
    if (c->job->done) c->job->done(c->job->done_ctx, end - begin);
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
    for (size_t i = 0; i < c->record_count; i++) stats->record_rays += c->records[i].rays;
    for (size_t i = 0; i < points; i++) stats->direct_rays += c->results[i].rays;
}

bool irradiance_cache_suits(const struct light_field *f) { return f->emitter_count < MIXTURE_MOST; }

enum status irradiance_cache_fill(struct irradiance *results, const struct irradiance_cache_job *j,
                                  struct irradiance_cache_stats *stats, struct err *err)
{
    struct cache c = {.job = j, .results = results};
    enum status st = start(&c, err);
    for (c.step = COARSEST; !st && c.step >= 1; c.step /= 2) st = add_level(&c, err);
    if (!st) parallel_for((size_t)j->width * (size_t)j->height, CHUNK, evaluate, &c);
    if (!st && stats) count(stats, &c);
    cache_tree_release(&c.tree);
    free(c.records);
    free(c.wanted);
    free(c.is_wanted);
    return st;
}
