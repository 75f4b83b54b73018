/* rows.c - see rows.h.
 *
 * Overview. Rays by the cosine say which patches a place sees: each counts 1 / rays. Those that leave the model through
 * a window are left to rays that go to the window itself, spread evenly over the solid angle of its pane [Urena 2013];
 * those that leave it elsewhere count as they are. A ray to a window that leaves through it sees a patch of the sky,
 * and the photographed outdoors; one that meets a reveal or furniture counts nothing, because rays by the cosine see
 * that. So each direction belongs to one kind of ray, and no weights have to be shared.
 *
 * A sun in the photographed outdoors is sought by rays within its cone; there the other rays leave it out. The sun of
 * other hours is a direction: a ray to it from each place.
 *
 * A lamp's irradiance has a closed form (lamp.c), times the share of it that a place sees: shadow rays to places spread
 * over the lamp, weighted by the light that each sends. Of a planned lamp each such place brings its part of the light,
 * by the photometry of its maker.
 *
 * Every row has random numbers of its own, so that its bits do not depend on threads. */
#include "stages/light_levels/rows.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "common/gather/strategy.h"
#include "common/light/sobol.h"
#include "common/math/numbers.h"

enum { SUN_RAYS = 16, LAMP_RAYS = 64, LEAST_WINDOW_RAYS = 16, CHUNK = 16 };

/* What one thread works with. */
struct scratch {
    float *share; /* of each patch */
    int *touched, count;
};

struct job {
    struct light_rows *rows;
    const struct light_groups *groups;
    const struct light_patches *patches;
    const struct row_place *places;
    struct scratch *scratch;
    struct err *errors; /* of each thread */
    struct progress progress;
    int rays;
    uint64_t key;
};

/* One origin of a row. */
struct source {
    const struct job *job;
    struct scratch *scratch;
    struct light_row *row;
    float *direct;
    struct gather_point point;
    struct vec3 from; /* a little off the surface */
    struct rng rng;
    double weight; /* of the origin in its row */
};

/* A packet of rays that wait to be traced. */
struct packet {
    struct vec3 from[RAY_PACKET], direction[RAY_PACKET];
    double value[RAY_PACKET]; /* what each stands for: irradiance of a radiance of 1 */
    int count;
};

static void add_direct(const struct source *s, int group, struct rgb value)
{
    float *to = s->direct + 3 * (size_t)group;
    to[0] += (float)value.r;
    to[1] += (float)value.g;
    to[2] += (float)value.b;
}

static bool is_sun(const struct field_sky *sky, struct vec3 direction, struct rgb radiance)
{
    if (!(rgb_luminance(radiance) > sky->bright)) return false;
    for (int i = 0; i < sky->sun_count; i++)
        if (vec3_dot(direction, sky->suns[i].normal) >= sky->suns[i].cone) return true;
    return false;
}

/* A ray that leaves by a window brings `value` times the radiance of the sky there. */
static void see_sky(const struct source *s, int window, struct vec3 direction, double value)
{
    const struct light_groups *g = s->job->groups;
    struct rgb radiance;
    model_field_outdoors(&radiance, g->field, s->from, direction);
    if (!is_sun(&g->field->sky, direction, radiance)) add_direct(s, g->sky + window, rgb_scale(radiance, value));
    if (g->beam > g->patch)
        add_direct(s, groups_patch(g, window, sky_patch_at(&g->patches, direction)), rgb_grey(value));
}

/* ----------------------------------------------------------------------------------------------- rays by the cosine */

static void add_share(const struct source *s, int patch, double share)
{
    if (!(s->scratch->share[patch] > 0)) s->scratch->touched[s->scratch->count++] = patch;
    s->scratch->share[patch] += (float)share;
}

static void trace_cosine_packet(const struct source *s, const struct packet *p)
{
    const struct light_groups *g = s->job->groups;
    struct ray_hit hits[RAY_PACKET];
    const unsigned hit = ray_scene_hit_packet(&g->field->model.rays, p->from, p->direction, (1u << p->count) - 1, hits);
    for (int k = 0; k < p->count; k++) {
        const int patch = hit >> k & 1 ? patches_hit(s->job->patches, &hits[k]) : -1;
        if (patch >= 0)
            add_share(s, patch, p->value[k]);
        else
            s->row->away += (float)p->value[k];
        if (hit >> k & 1) continue;
        const int window = groups_window(g, s->from, p->direction[k]);
        if (window == g->windows_count - 1) see_sky(s, window, p->direction[k], PI * p->value[k]);
    }
}

static void trace_cosine(const struct source *s, int rays)
{
    struct sobol points = sobol_make(&s->rng, 0, rays);
    struct packet p = {.count = 0};
    struct strategy way;
    strategy_cosine(&way, s->point);
    for (int i = 0; i < rays; i++) {
        double u[4];
        points.sample = (uint32_t)i;
        sobol_group(&points, 0, u);
        p.from[p.count] = s->from;
        p.value[p.count] = s->weight / rays;
        if (strategy_sample(&way, u, &p.direction[p.count]))
            p.count++;
        else
            s->row->away += (float)(s->weight / rays);
        if (p.count < RAY_PACKET) continue;
        trace_cosine_packet(s, &p);
        p.count = 0;
    }
    if (p.count) trace_cosine_packet(s, &p);
}

/* ---------------------------------------------------------------------------------------------------- through panes */

static void trace_pane_packet(const struct source *s, const struct packet *p, int window)
{
    const struct light_groups *g = s->job->groups;
    double away[RAY_PACKET];
    for (int k = 0; k < RAY_PACKET; k++) away[k] = INFINITY;
    const unsigned blocked =
        ray_scene_blocked_packet(&g->field->model.rays, p->from, p->direction, away, (1u << p->count) - 1);
    for (int k = 0; k < p->count; k++)
        if (!(blocked >> k & 1) && groups_window(g, s->from, p->direction[k]) == window)
            see_sky(s, window, p->direction[k], p->value[k]);
}

static void trace_pane(const struct source *s, const struct strategy *way, int window, int rays)
{
    struct sobol points = sobol_make(&s->rng, 1 + (uint64_t)window, rays);
    struct packet p = {.count = 0};
    for (int i = 0; i < rays; i++) {
        double u[4];
        points.sample = (uint32_t)i;
        sobol_group(&points, 1, u);
        if (!strategy_sample(way, u, &p.direction[p.count])) continue;
        const double density = strategy_density(way, p.direction[p.count]);
        if (!(density > 0)) continue;
        p.from[p.count] = s->from;
        p.value[p.count] = s->weight * vec3_dot(p.direction[p.count], s->point.normal) / (density * rays);
        if (++p.count < RAY_PACKET) continue;
        trace_pane_packet(s, &p, window);
        p.count = 0;
    }
    if (p.count) trace_pane_packet(s, &p, window);
}

/* Rays are shared out by the light that windows would send if nothing hid them. */
static void trace_panes(const struct source *s, int rays)
{
    const struct light_groups *g = s->job->groups;
    struct strategy way;
    double sum = 0;
    for (int i = 0; i + 1 < g->windows_count; i++)
        if (strategy_emitter(&way, s->point, &g->windows[i].pane)) sum += way.estimate;
    for (int i = 0; i + 1 < g->windows_count; i++) {
        if (!strategy_emitter(&way, s->point, &g->windows[i].pane)) continue;
        const int own = sum > 0 ? (int)(rays * way.estimate / sum) : 0;
        trace_pane(s, &way, i, own > LEAST_WINDOW_RAYS ? own : LEAST_WINDOW_RAYS);
    }
}

/* ------------------------------------------------------------------------------------------------------------- suns */

static void trace_suns(const struct source *s)
{
    const struct light_groups *g = s->job->groups;
    for (int i = 0; i < g->field->sky.sun_count; i++) {
        struct sobol points = sobol_make(&s->rng, 1000 + (uint64_t)i, SUN_RAYS);
        struct strategy way;
        if (!strategy_emitter(&way, s->point, &g->field->sky.suns[i])) continue;
        for (int k = 0; k < SUN_RAYS; k++) {
            struct vec3 direction;
            struct rgb radiance;
            double u[4];
            points.sample = (uint32_t)k;
            sobol_group(&points, 2, u);
            if (!strategy_sample(&way, u, &direction)) continue;
            const double value =
                s->weight * vec3_dot(direction, s->point.normal) / (strategy_density(&way, direction) * SUN_RAYS);
            if (ray_scene_blocked(&g->field->model.rays, s->from, direction, INFINITY)) continue;
            model_field_outdoors(&radiance, g->field, s->from, direction);
            if (is_sun(&g->field->sky, direction, radiance))
                add_direct(s, g->sun + groups_window(g, s->from, direction), rgb_scale(radiance, value));
        }
    }
}

static void trace_beam_packet(const struct source *s, const struct packet *p, const int patches[RAY_PACKET])
{
    const struct light_groups *g = s->job->groups;
    double away[RAY_PACKET];
    for (int k = 0; k < RAY_PACKET; k++) away[k] = INFINITY;
    const unsigned blocked =
        ray_scene_blocked_packet(&g->field->model.rays, p->from, p->direction, away, (1u << p->count) - 1);
    for (int k = 0; k < p->count; k++)
        if (!(blocked >> k & 1))
            add_direct(s, groups_beam(g, groups_window(g, s->from, p->direction[k]), patches[k]),
                       rgb_grey(p->value[k]));
}

static void trace_beams(const struct source *s)
{
    const struct light_groups *g = s->job->groups;
    struct packet p = {.count = 0};
    int patches[RAY_PACKET];
    for (int k = SKY_GROUND + 1; k < g->patches.count; k++) {
        const struct vec3 direction = sky_patch_direction(&g->patches, k);
        const double cosine = vec3_dot(direction, s->point.normal);
        if (!(cosine > 0)) continue;
        p.from[p.count] = s->from;
        p.direction[p.count] = direction;
        p.value[p.count] = s->weight * cosine;
        patches[p.count++] = k;
        if (p.count < RAY_PACKET) continue;
        trace_beam_packet(s, &p, patches);
        p.count = 0;
    }
    if (p.count) trace_beam_packet(s, &p, patches);
}

bool rows_sees_sun(const struct model_field *f, struct gather_point p, struct vec3 to_sun)
{
    if (!(vec3_dot(p.normal, to_sun) > 0)) return false;
    const struct vec3 from = vec3_add(p.at, vec3_scale(p.normal, f->model.rays.epsilon));
    return !ray_scene_blocked(&f->model.rays, from, to_sun, INFINITY);
}

/* ------------------------------------------------------------------------------------------------------------ lamps */

/* What place (u, v) of a lamp sends to the point; *reach: where along *direction a surface that is parallel to it does
 * not hide it any more; *distance: where it is. */
static double lamp_sends(const struct source *s, const struct lamp *l, const double u[2], struct vec3 *direction,
                         double *reach, double *distance)
{
    double a = 2 * u[0] - 1, b = 2 * u[1] - 1;
    if (l->shape == LAMP_DISK) {
        a = sqrt(u[0]) * cos(2 * PI * u[1]);
        b = sqrt(u[0]) * sin(2 * PI * u[1]);
    }
    const struct vec3 at = vec3_add(l->centre, vec3_add(vec3_scale(l->x, a), vec3_scale(l->y, b)));
    const struct vec3 to = vec3_sub(at, s->from);
    *distance = vec3_length(to);
    if (!(*distance > 0)) return 0;
    *direction = vec3_scale(to, 1 / *distance);
    const double cosine = -vec3_dot(*direction, l->normal), rise = vec3_dot(*direction, s->point.normal);
    if (!(cosine > 0 && rise > 0)) return 0;
    *reach = *distance - s->job->groups->field->reach / cosine;
    return rgb_luminance(lamp_radiance(l, vec3_scale(*direction, -1))) * cosine * rise / (*distance * *distance);
}

/* Whether a surface hides a place of a lamp at a distance. */
static bool is_hidden(const struct source *s, const struct lamp *l, struct vec3 direction, double distance,
                      double reach)
{
    const struct ray_scene *scene = &s->job->groups->field->model.rays;
    struct ray_hit hit;
    if (!(reach > 0)) return false;
    if (ray_scene_blocked(scene, s->from, direction, reach)) return true;
    return ray_scene_hit(scene, s->from, direction, &hit) && model_field_hides_lamp(l, distance, &hit);
}

/* The share of a lamp's light that reaches the point. */
static double lamp_share(const struct source *s, const struct lamp *l, int lamp, int rays)
{
    struct sobol points = sobol_make(&s->rng, 2000 + (uint64_t)lamp, rays);
    double all = 0, seen = 0;
    for (int i = 0; i < rays; i++) {
        struct vec3 direction;
        double u[4], reach, distance;
        points.sample = (uint32_t)i;
        sobol_group(&points, 3, u);
        const double sent = lamp_sends(s, l, u, &direction, &reach, &distance);
        if (!(sent > 0)) continue;
        all += sent;
        if (!is_hidden(s, l, direction, distance, reach)) seen += sent;
    }
    return all > 0 ? seen / all : 0;
}

static void light_by_lamps(const struct source *s, int rays)
{
    const struct model_field *f = s->job->groups->field;
    for (int i = 0; i < f->lights.lamp_count; i++) {
        const struct lamp *l = &f->lights.lamps[i];
        if (f->lamps[i].off) continue;
        const double share = lamp_share(s, l, i, rays);
        if (share > 0) add_direct(s, i, rgb_scale(lamp_irradiance(l, s->point.at, s->point.normal), share * s->weight));
    }
}

static void light_by_planned(const struct source *s, int rays)
{
    const struct light_groups *g = s->job->groups;
    for (int i = 0; g->planned_lamps && i < g->planned_lamps->count; i++) {
        const struct planned_lamp *l = &g->planned_lamps->list[i];
        const int count = planned_lamp_is_wide(l) ? rays : 1;
        struct sobol points = sobol_make(&s->rng, 4000 + (uint64_t)i, count);
        double sum = 0;
        for (int k = 0; k < count; k++) {
            double u[4] = {0.5, 0.5, 0, 0};
            points.sample = (uint32_t)k;
            if (count > 1) sobol_group(&points, 3, u);
            const struct vec3 place = planned_lamp_place(l, u, g->metre), to = vec3_sub(place, s->from);
            const double lux = planned_lamp_illuminance(l, place, s->point.at, s->point.normal, g->metre);
            const double distance = vec3_length(to), reach = distance - g->field->reach;
            if (!(lux > 0)) continue;
            if (!(reach > 0) || !ray_scene_blocked(&g->field->model.rays, s->from, vec3_scale(to, 1 / distance), reach))
                sum += lux / count;
        }
        if (sum > 0) add_direct(s, g->planned + i, rgb_scale(l->colour, sum * s->weight));
    }
}

/* ------------------------------------------------------------------------------------------------------------- rows */

static int compare_ints(const void *a, const void *b)
{
    const int x = *(const int *)a, y = *(const int *)b;
    return (x > y) - (x < y);
}

static void finish_row(struct light_row *row, struct scratch *s, struct err *err)
{
    qsort(s->touched, (size_t)s->count, sizeof *s->touched, compare_ints);
    row->entries = malloc(((size_t)s->count + 1) * sizeof *row->entries);
    if (!row->entries) err_nomem(err, "form factors", (size_t)s->count * sizeof *row->entries);
    for (int i = 0; i < s->count; i++) {
        if (row->entries) row->entries[row->count++] = (struct row_entry){s->touched[i], s->share[s->touched[i]]};
        s->share[s->touched[i]] = 0;
    }
    s->count = 0;
}

static void trace_row(struct job *j, size_t i, int thread)
{
    const struct row_place *place = &j->places[i];
    struct light_row *row = &j->rows->rows[i];
    float *direct = j->rows->direct + 3 * (size_t)j->rows->groups * i;
    for (int k = 0; k < place->count; k++) {
        struct source s = {.job = j,
                           .scratch = &j->scratch[thread],
                           .row = row,
                           .direct = direct,
                           .point = place->origins[k],
                           .rng = rng_make((j->key + i) * PATCH_ORIGINS + (uint64_t)k, "light_levels", "rows"),
                           .weight = 1.0 / place->count};
        s.from = vec3_add(s.point.at, vec3_scale(s.point.normal, j->groups->field->model.rays.epsilon));
        trace_cosine(&s, j->rays / place->count);
        trace_panes(&s, j->rays / place->count);
        trace_suns(&s);
        if (j->groups->beam > j->groups->patch) trace_beams(&s);
        light_by_lamps(&s, LAMP_RAYS / place->count);
        light_by_planned(&s, LAMP_RAYS / place->count);
    }
    finish_row(row, &j->scratch[thread], &j->errors[thread]);
}

static void trace_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct job *j = ctx;
    for (size_t i = begin; i < end; i++) trace_row(j, i, thread);
    progress_add(&j->progress, (int64_t)(end - begin));
}

static enum status make_scratch(struct job *j, int patches, int threads, struct err *err)
{
    j->scratch = calloc((size_t)threads, sizeof *j->scratch);
    j->errors = calloc((size_t)threads, sizeof *j->errors);
    if (!j->scratch || !j->errors) return err_nomem(err, "rays", (size_t)threads * sizeof *j->scratch);
    for (int t = 0; t < threads; t++) {
        j->scratch[t].share = calloc((size_t)patches + 1, sizeof(float));
        j->scratch[t].touched = calloc((size_t)patches + 1, sizeof(int));
        if (!j->scratch[t].share || !j->scratch[t].touched)
            return err_nomem(err, "rays", (size_t)patches * sizeof(float));
    }
    return ST_OK;
}

enum status rows_trace(struct light_rows *r, const struct light_groups *g, const struct light_patches *p,
                       const struct row_place *places, int count, int rays, uint64_t key, const char *what,
                       struct err *err)
{
    const int threads = parallel_threads();
    struct job j = {.rows = r, .groups = g, .patches = p, .places = places, .rays = rays, .key = key};
    *r = (struct light_rows){.count = count, .groups = g->count};
    const size_t values = 3 * (size_t)count * (size_t)g->count;
    r->rows = calloc((size_t)count + 1, sizeof *r->rows);
    r->direct = calloc(values + 1, sizeof *r->direct);
    if (!r->rows || !r->direct) err_nomem(err, "light of groups", values * sizeof *r->direct);
    if (!err->status && !make_scratch(&j, p->count, threads, err)) {
        progress_start(&j.progress, what, count, "places");
        parallel_for((size_t)count, CHUNK, trace_some, &j);
        progress_end(&j.progress);
    }
    for (int t = 0; t < threads; t++) {
        if (!err->status && j.errors && j.errors[t].status) *err = j.errors[t];
        if (j.scratch) free(j.scratch[t].share);
        if (j.scratch) free(j.scratch[t].touched);
    }
    free(j.scratch);
    free(j.errors);
    return err->status;
}

void rows_release(struct light_rows *r)
{
    for (int i = 0; r->rows && i < r->count; i++) free(r->rows[i].entries);
    free(r->rows);
    free(r->direct);
    *r = (struct light_rows){0};
}
