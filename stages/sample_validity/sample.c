/* sample.c - see sample.h. */
#include "stages/sample_validity/sample.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "stages/sample_validity/layout.h"

#define PARAM_STRUCT struct validity_params
const struct param validity_param_table[] = {VALIDITY_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

#define FIRST_STEP    16  /* tolerances */
#define MOST_BACK     1.0 /* median depths: farther off, zoomed in, it is but a flatter picture */
#define GRID_HALVINGS 4   /* sizes of the grid that are tried */
#define ZOOM_STEP     0.05
#define ZOOM_COST     4   /* places count by zoom^-4 */
#define ZOOM_PLACES   5   /* a side */
#define SLACK         1.2 /* over what the centremost place leaves, where no place is valid */

struct sampler { /* of one thread */
    struct validity *v;
    struct viewpoint_test test;
};

static enum status is_valid(struct sampler *s, const struct shot_end *end, double x, double y, double z, bool *valid,
                            struct err *err)
{
    const struct view camera = shot_end_camera(&s->v->shot, end, shot_place(&s->v->shot, x, y, z));
    return viewpoint_is_valid(valid, &s->test, &camera, err);
}

/* How far along z, forwards (1) or backwards (-1), places are valid. z = 0 is. */
static enum status search(struct sampler *s, const struct shot_end *end, double x, double y, int way, double *z,
                          struct err *err)
{
    const double most = MOST_BACK * s->v->shot.median_depth;
    double step = FIRST_STEP * s->v->step;
    bool failed = false;
    *z = 0;
    while (step > 0.75 * s->v->step) {
        bool valid = false;
        if (fabs(*z) + step <= most && is_valid(s, end, x, y, *z + way * step, &valid, err)) return err->status;
        failed |= !valid;
        if (valid) *z += way * step;
        step *= failed ? 0.5 : 2;
    }
    return ST_OK;
}

static enum status sample_cell(struct sampler *s, const struct shot_end *end, bool glance, struct validity_cell *c,
                               struct err *err)
{
    enum status st = is_valid(s, end, c->x, c->y, 0, &c->valid, err);
    if (glance) return st;
    if (!st && c->valid) st = search(s, end, c->x, c->y, -1, &c->low, err);
    if (!st && c->valid) st = search(s, end, c->x, c->y, 1, &c->high, err);
    return st;
}

/* extent: of the grid, in sizes of the box of the centres; part: by which it is drawn together around the origin. */
static void place_cells(struct validity_region *r, const struct shot *shot, bool on_axis, double extent, double part)
{
    for (int i = 0; !on_axis && i < r->columns * r->rows; i++) {
        const int at[2] = {i % r->columns, i / r->columns}, of[2] = {r->columns, r->rows};
        double place[2];
        for (int k = 0; k < 2; k++) {
            const double middle = 0.5 * (shot->low[k] + shot->high[k]), size = extent * (shot->high[k] - shot->low[k]);
            place[k] = part * (middle + size * ((at[k] + 0.5) / of[k] - 0.5));
        }
        r->cells[i].x = place[0];
        r->cells[i].y = place[1];
    }
}

/* The places at z = 0, of ZOOM_PLACES a side over the box of the centres, that are valid. */
static enum status count_valid(struct sampler *s, double focal, int *count, struct err *err)
{
    const struct shot_end end = {.target = s->v->shot.centroid, .focal = focal};
    struct validity_cell cells[ZOOM_PLACES * ZOOM_PLACES] = {0};
    struct validity_region r = {ZOOM_PLACES, ZOOM_PLACES, cells};
    *count = 0;
    place_cells(&r, &s->v->shot, false, 1, 1);
    for (int i = 0; i < ZOOM_PLACES * ZOOM_PLACES; i++) {
        bool valid;
        if (is_valid(s, &end, cells[i].x, cells[i].y, 0, &valid, err)) return err->status;
        *count += valid;
    }
    return ST_OK;
}

/* Sets the zoom, and with it f: the origin must be valid, for moves are drawn together towards it where they must. Where it
 * is at no zoom, the largest, and limits that it keeps. */
static enum status find_zoom(struct sampler *s, double max_zoom, const char *center_view, struct err *err)
{
    struct validity *v = s->v;
    const double focal = v->shot.lens.fx;
    double best = 0;

    for (int i = 0;; i++) {
        const double zoom = 1 + ZOOM_STEP * i, worth = pow(zoom, -ZOOM_COST);
        const struct view camera = shot_aim(&v->shot, v->shot.origin, v->shot.centroid, focal * zoom);
        bool valid;
        int count;
        if (zoom > max_zoom + 1e-9 || worth <= best) break;
        if (viewpoint_is_valid(&valid, &s->test, &camera, err)) return err->status;
        if (!valid) continue;
        if (count_valid(s, focal * zoom, &count, err)) return err->status;
        const double merit = worth * count / (ZOOM_PLACES * ZOOM_PLACES);
        if (merit > best) best = merit, v->zoom = zoom;
    }
    if (!(best > 0)) v->zoom = max_zoom;
    v->shot.lens.fx = v->shot.lens.fy = focal * v->zoom;
    if (best > 0) return ST_OK;

    struct viewpoint at;
    const struct view camera = shot_aim(&v->shot, v->shot.origin, v->shot.centroid, v->shot.lens.fx);
    if (viewpoint_measure(&at, &s->test, &camera, err)) return err->status;
    if (!isfinite(at.h))
        return err_set(
            err, ST_DATA,
            "the place of the centremost view %s shows nothing of the scene's middle: no viewpoint is valid. "
            "Look at its depth map.",
            center_view);
    v->limits.max_h = fmax(v->limits.max_h, SLACK * at.h);
    v->limits.max_outside = fmax(v->limits.max_outside, SLACK * at.outside);
    s->test.limits = v->limits;
    return ST_OK;
}

struct cell_job {
    struct sampler *samplers; /* a thread */
    const struct shot_end *end;
    struct validity_cell *cells;
    struct err *errors; /* a cell */
    bool glance;        /* whether they are valid at z = 0, no more */
    struct progress progress;
};

static void sample_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct cell_job *job = ctx;
    for (size_t i = begin; i < end; i++) {
        sample_cell(&job->samplers[thread], job->end, job->glance, &job->cells[i], &job->errors[i]);
        progress_add(&job->progress, 1);
    }
}

/* Cells are independent, so each thread has its own and draws its pictures alone. */
static enum status sample_cells(struct sampler *s, const struct shot_end *end, struct validity_cell *cells, int count,
                                bool glance, const char *what, struct err *err)
{
    const int threads = parallel_threads();
    struct cell_job job = {.end = end, .cells = cells, .glance = glance};
    job.samplers = calloc((size_t)threads, sizeof *job.samplers);
    job.errors = calloc((size_t)count + 1, sizeof *job.errors);
    enum status st = job.samplers && job.errors ? ST_OK : err_nomem(err, "places", (size_t)count * sizeof *job.errors);

    for (int t = 0; !st && t < threads; t++) {
        job.samplers[t].v = s->v;
        viewpoint_test_like(&job.samplers[t].test, &s->test);
    }
    if (!st) {
        progress_start(&job.progress, what, count, "places");
        parallel_for((size_t)count, 1, sample_some, &job);
        progress_end(&job.progress);
    }
    for (int i = 0; !st && i < count; i++)
        if (job.errors[i].status) st = err_set(err, job.errors[i].status, "%s", job.errors[i].text);
    for (int t = 0; job.samplers && t < threads; t++) {
        s->test.renders += job.samplers[t].test.renders;
        viewpoint_test_release(&job.samplers[t].test);
    }
    free(job.samplers);
    free(job.errors);
    return st;
}

/* Finds the limits of some places, evenly among the valid ones, again in larger pictures. */
static enum status compare(struct sampler *s, const struct shot_end *end, const struct validity_region *r, int wanted,
                           struct sampling_error *e, struct err *err)
{
    const int valid = validity_region_count(r), few = wanted < valid ? wanted : valid, side = s->test.limits.side;
    struct validity_cell *again = calloc((size_t)few + 1, sizeof *again);
    const struct validity_cell **of = calloc((size_t)few + 1, sizeof *of);
    int seen = 0, taken = 0;

    enum status st = again && of ? ST_OK : err_nomem(err, "places", (size_t)few * sizeof *again);
    for (int i = 0; !st && i < r->columns * r->rows && taken < few; i++) {
        const struct validity_cell *c = &r->cells[i];
        if (!c->valid || seen++ < (2 * taken + 1) * valid / (2 * few)) continue;
        again[taken] = (struct validity_cell){.x = c->x, .y = c->y};
        of[taken++] = c;
    }
    s->test.limits.side = H_REFERENCE_SIDE;
    if (!st && taken) st = sample_cells(s, end, again, taken, false, "places in full pictures", err);
    s->test.limits.side = side;
    for (int i = 0; !st && i < taken; i++) {
        const double apart[2] = {fabs(again[i].low - of[i]->low) / s->v->step,
                                 fabs(again[i].high - of[i]->high) / s->v->step};
        for (int k = 0; k < 2; k++) {
            e->limits++;
            e->within += apart[k] < 1.5;
            e->worst = fmax(e->worst, apart[k]);
        }
    }
    free(again);
    free(of);
    return st;
}

static bool same_rule(const struct shot_end *a, const struct shot_end *b)
{
    return a->focal == b->focal && a->size == b->size && !memcmp(&a->target, &b->target, sizeof a->target) &&
           !memcmp(a->corner, b->corner, sizeof a->corner);
}

/* Places the cells. Where few of them are valid, the same number of them closer around the origin tells more: the grid
 * is halved until a quarter of the cells is valid, and is as large as has most of them if none is. */
static enum status draw_grid_together(struct sampler *s, const struct shot_end *end, struct validity_region *r,
                                      double extent, struct err *err)
{
    const int cells = r->columns * r->rows;
    double best = 1;
    int most = -1;
    enum status st = ST_OK;

    for (int i = 0; !st && i < GRID_HALVINGS && cells > 1 && 4 * most < cells; i++) {
        place_cells(r, &s->v->shot, false, extent, pow(0.5, i));
        st = sample_cells(s, end, r->cells, cells, true, "places to look at", err);
        const int valid = validity_region_count(r);
        if (valid > most) most = valid, best = pow(0.5, i);
    }
    place_cells(r, &s->v->shot, cells == 1, extent, best);
    for (int i = 0; i < cells; i++) r->cells[i].valid = false;
    return st;
}

static enum status sample_end(struct sampler *s, int at, const struct validity_params *params,
                              struct sampling_notes *notes, struct err *err)
{
    struct validity *v = s->v;
    struct validity_region *r = &v->region[at];
    const struct shot_end *end = &v->move.end[at];
    const int side = v->move.on_axis ? 1 : params->grid;

    if (validity_region_init(r, side, side, err)) return err->status;
    if (at && same_rule(end, &v->move.end[0])) {
        memcpy(r->cells, v->region[0].cells, (size_t)(side * side) * sizeof *r->cells);
        return ST_OK;
    }
    enum status st = draw_grid_together(s, end, r, params->extent, err);
    if (!st)
        st =
            sample_cells(s, end, r->cells, side * side, false, at ? "places for the end" : "places for the start", err);
    return st ? st : compare(s, end, r, params->check_cells, &notes->error, err);
}

/* An end without any valid place gets the origin, so that the camera stands still there. */
static void allow_origin(struct validity_region *r)
{
    int nearest = 0;
    double best = HUGE_VAL;
    for (int i = 0; i < r->columns * r->rows; i++) {
        const double d = hypot(r->cells[i].x, r->cells[i].y);
        if (d < best) best = d, nearest = i;
    }
    r->cells[nearest] = (struct validity_cell){.valid = true};
}

enum status validity_sample(struct validity *v, struct sampling_notes *notes, const struct layer_scene *scene,
                            const struct vec3 *ups, const struct subject_list *subjects,
                            const struct film_effect *effect, const struct validity_params *params, struct err *err)
{
    struct scene_points points = {0};
    struct sampler s = {.v = v};
    int center = 0;

    *notes = (struct sampling_notes){.asked_h = params->max_h, .asked_outside = params->max_outside};
    *v = (struct validity){.effect = *effect, .zoom = 1};
    v->limits = (struct viewpoint_limits){params->max_h, params->max_outside, params->check_side};
    s.test = (struct viewpoint_test){.scene = scene, .points = &points, .shot = &v->shot, .limits = v->limits};
    enum status st = scene_points_collect(&points, scene, err);
    if (!st) st = layout_find(&v->shot, &center, scene, &points, ups, params, err);
    if (!st) {
        notes->center_view = scene->set->views[center].name;
        v->step = params->tolerance * v->shot.median_depth;
        st = find_zoom(&s, params->max_zoom, notes->center_view, err);
    }
    if (!st) st = shot_move_make(&v->move, &v->shot, effect->move, subjects, err);
    for (int i = 0; !st && i < 2; i++) st = sample_end(&s, i, params, notes, err);
    for (int i = 0; !st && i < 2; i++)
        if (!validity_region_count(&v->region[i])) {
            notes->none[i] = true;
            allow_origin(&v->region[i]);
        }
    notes->renders = s.test.renders;
    viewpoint_test_release(&s.test);
    scene_points_release(&points);
    if (st) validity_release(v);
    return st;
}
