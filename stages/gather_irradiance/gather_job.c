/* gather_job.c - see gather_job.h. */
#include "stages/gather_irradiance/gather_job.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/log.h"
#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "common/base/sort.h"
#include "common/gather/irradiance_cache.h"

/* of the model's size: how far below a surface of the model a point may lie that was taken from the true surface */
static const double LIFT = 0.02;

struct task {
    struct irradiance *results;
    struct gather_point *points;
    const struct gather_job *job;
    struct progress progress;
    double lift;
};

void gather_job_release(struct gather_job *j)
{
    gatherer_free(j->gatherer);
    model_field_release(&j->field);
    thing_surfaces_release(&j->things);
    provenance_release(&j->prov);
}

static bool is_point(const struct gather_point *p) { return vec3_length(p->normal) > 0; }

static void gather_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct task *t = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        if (is_point(&t->points[i])) {
            model_field_lift(&t->job->field, &t->points[i], t->lift);
            gatherer_irradiance(&t->results[i], t->job->gatherer, &t->job->field.field, t->points[i], i);
        }
        progress_add(&t->progress, 1);
    }
}

static double relative_error(const struct irradiance *e)
{
    const double luminance = rgb_luminance(e->value);
    return luminance > 0 ? rgb_luminance(e->error) / luminance : 0;
}

static void report(const struct irradiance *results, const struct gather_point *points, size_t count, double errors[])
{
    double from[LIGHT_SOURCES] = {0}, rays = 0;
    size_t n = 0, dark = 0;
    for (size_t i = 0; i < count; i++) {
        if (!is_point(&points[i])) continue;
        for (int s = 0; s < LIGHT_SOURCES; s++) from[s] += results[i].from[s];
        dark += !(rgb_luminance(results[i].value) > 0);
        rays += results[i].rays;
        errors[n++] = relative_error(&results[i]);
    }
    if (!n) return;
    sort_doubles(errors, n);
    const double lit = n > dark ? (double)(n - dark) : 1;
    log_note("%zu points, %.3g rays each; relative error by the gather's own estimate %.2g %% (median), %.2g %% (most)",
             n, rays / (double)n, 100 * errors[n / 2], 100 * errors[n - 1]);
    log_note("mean shares of the light: %.1f %% photographed texels, %.1f %% synthesised texels, %.1f %% outdoors, "
             "%.1f %% outdoors beyond all pictures, %.1f %% lamps, %.1f %% furniture and objects",
             100 * from[LIGHT_TEXTURE] / lit, 100 * from[LIGHT_SYNTHESISED] / lit, 100 * from[LIGHT_SKY] / lit,
             100 * from[LIGHT_SKY_GUESSED] / lit, 100 * from[LIGHT_LAMP] / lit, 100 * from[LIGHT_OBJECT] / lit);
    if (from[LIGHT_MATERIAL] > 0) log_note("mean share of glossy materials: %.1f %%", 100 * from[LIGHT_MATERIAL] / lit);
    if (dark) log_note("%zu points are in the dark", dark);
}

static void lift_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct task *t = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++)
        if (is_point(&t->points[i])) model_field_lift(&t->job->field, &t->points[i], t->lift);
}

static void cache_done(void *ctx, size_t points) { progress_add(ctx, (int64_t)points); }

static enum status fill_cache(struct task *t, int width, int height, struct err *err)
{
    struct irradiance_cache_stats stats;
    const struct irradiance_cache_job cache = {.field = &t->job->field.field,
                                               .points = t->points,
                                               .width = width,
                                               .height = height,
                                               .target = t->job->params.target_error,
                                               .rays = t->job->params.rays,
                                               .done = cache_done,
                                               .done_ctx = &t->progress};
    parallel_for((size_t)width * (size_t)height, 64, lift_some, t);
    if (irradiance_cache_fill(t->results, &cache, &stats, err)) return err->status;
    log_note("%zu records of indirect light, %.3g rays each", stats.records,
             stats.records ? stats.record_rays / (double)stats.records : 0);
    return ST_OK;
}

/* width = 0: no grid */
static enum status gather_with(struct irradiance *results, struct gather_point *points, size_t count, int width,
                               const struct gather_job *j, const char *what, struct err *err)
{
    struct task t = {.results = results, .points = points, .job = j};
    double *errors = malloc((count + 1) * sizeof *errors);
    if (!errors) return err_nomem(err, "points", count * sizeof *errors);
    t.lift = LIFT * model_rays_size(&j->field.model);
    progress_start(&t.progress, what, (int64_t)count, "points");
    if (width)
        fill_cache(&t, width, (int)(count / (size_t)width), err);
    else
        parallel_for(count, 1, gather_some, &t);
    progress_end(&t.progress);
    if (!err->status) report(results, points, count, errors);
    free(errors);
    return err->status;
}

enum status gather_all(struct irradiance *results, struct gather_point *points, size_t count,
                       const struct gather_job *j, const char *what, struct err *err)
{
    return gather_with(results, points, count, 0, j, what, err);
}

enum status gather_grid(struct irradiance *results, struct gather_point *points, int width, int height,
                        const struct gather_job *j, const char *what, struct err *err)
{
    const bool is_cached = gather_params_cache(&j->params) && irradiance_cache_suits(&j->field.field);
    return gather_with(results, points, (size_t)width * (size_t)height, is_cached ? width : 0, j, what, err);
}
