/* sample.c - sampling of the valid viewpoints of each end of a move.
 *
 * [Colburn 2014, 3.4.2]: a grid in x and y over twice the bounding box of the views' centres at z = 0; from each valid
 * cell a search along z, both ways, for the range of valid z. The step doubles while viewpoints are valid and halves
 * from the first invalid one on, down to the tolerance. Moves on the axis have a single cell, the origin. Viewpoints
 * are tested in small pictures; for some cells the search is repeated in full ones to report the error.
 *
 * What differs. If fewer than a quarter of the cells are valid, the grid is shrunk around the origin by halves. f may
 * be longer than the views' mean focal length, because hand-held photos do not fill a frame seen from between them: the
 * zoom maximises the fraction of valid cells times zoom^-ZOOM_COST. If the origin is invalid at every zoom, the limits
 * are raised so that it is valid, since moves are drawn in towards it. */
#include "stages/sample_validity/sample.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "stages/sample_validity/move_layout.h"

#define PARAM_STRUCT struct validity_params
const struct param validity_param_table[] = {VALIDITY_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

#define FIRST_STEP  16  /* of the search along z, in tolerances */
#define MAX_SHIFT   1.0 /* of the search along z, in median depths: farther off, the picture only gets flatter */
#define GRID_SIZES  4   /* number of grid sizes tried, each half of the one before */
#define ZOOM_STEP   0.05
#define ZOOM_COST   4   /* exponent of the zoom's cost */
#define ZOOM_CELLS  5   /* columns and rows of the grid that tests a zoom */
#define LIMIT_SLACK 1.2 /* raised limits, relative to the values at the origin */

struct cell_sampler { /* one per thread */
    struct validity *v;
    struct viewpoint_test test;
};

static enum status is_valid(struct cell_sampler *s, const struct shot_end *end, double x, double y, double z,
                            bool *valid, struct err *err)
{
    const struct view camera = shot_end_camera(&s->v->shot, end, world_from_shot(&s->v->shot, x, y, z));
    return viewpoint_is_valid(valid, &s->test, &camera, err);
}

/* Searches for the last valid z forwards (1) or backwards (-1) from z = 0, which is valid. */
static enum status search_z(struct cell_sampler *s, const struct shot_end *end, double x, double y, int direction,
                            double *z, struct err *err)
{
    const double max_z = MAX_SHIFT * s->v->shot.median_depth;
    double step = FIRST_STEP * s->v->step;
    bool failed = false;
    *z = 0;
    while (step > 0.75 * s->v->step) {
        bool valid = false;
        if (fabs(*z) + step <= max_z && is_valid(s, end, x, y, *z + direction * step, &valid, err)) return err->status;
        failed |= !valid;
        if (valid) *z += direction * step;
        step *= failed ? 0.5 : 2;
    }
    return ST_OK;
}

enum cell_task {
    CELL_TEST,   /* test z = 0 alone */
    CELL_SEARCH, /* search z; whether z = 0 is valid is known */
    CELL_ALL
};

static enum status sample_cell(struct cell_sampler *s, const struct shot_end *end, enum cell_task task,
                               struct validity_cell *c, struct err *err)
{
    if (task != CELL_SEARCH) is_valid(s, end, c->x, c->y, 0, &c->valid, err);
    if (task == CELL_TEST) return err->status;
    if (!err->status && c->valid) search_z(s, end, c->x, c->y, -1, &c->low, err);
    if (!err->status && c->valid) search_z(s, end, c->x, c->y, 1, &c->high, err);
    return err->status;
}

/* extent: size of the grid in units of the bounding box of the centres. shrink: factor by which it is then scaled about
 * the origin. */
static void place_cells(struct validity_region *r, const struct shot_setup *shot, bool on_axis, double extent,
                        double shrink)
{
    for (int i = 0; !on_axis && i < r->columns * r->rows; i++) {
        const int at[2] = {i % r->columns, i / r->columns}, count[2] = {r->columns, r->rows};
        double position[2];
        for (int k = 0; k < 2; k++) {
            const double middle = 0.5 * (shot->low[k] + shot->high[k]), size = extent * (shot->high[k] - shot->low[k]);
            position[k] = shrink * (middle + size * ((at[k] + 0.5) / count[k] - 0.5));
        }
        r->cells[i].x = position[0];
        r->cells[i].y = position[1];
    }
}

/* Counts the valid cells at z = 0 of a coarse grid over the bounding box of the centres. */
static enum status count_valid(struct cell_sampler *s, double focal, int *count, struct err *err)
{
    const struct shot_end end = {.target = s->v->shot.centroid, .focal = focal};
    struct validity_cell cells[ZOOM_CELLS * ZOOM_CELLS] = {0};
    struct validity_region r = {ZOOM_CELLS, ZOOM_CELLS, cells};
    *count = 0;
    place_cells(&r, &s->v->shot, false, 1, 1);
    for (int i = 0; i < ZOOM_CELLS * ZOOM_CELLS; i++) {
        bool valid;
        if (is_valid(s, &end, cells[i].x, cells[i].y, 0, &valid, err)) return err->status;
        *count += valid;
    }
    return ST_OK;
}

/* Raises the limits so that the origin is valid. */
static enum status raise_limits(struct cell_sampler *s, const char *center_view, struct err *err)
{
    struct validity *v = s->v;
    struct viewpoint at;
    const struct view camera = shot_aim(&v->shot, v->shot.origin, v->shot.centroid, v->shot.lens.fx);
    if (viewpoint_measure(&at, &s->test, &camera, err)) return err->status;
    if (!isfinite(at.h))
        return err_set(err, ST_DATA,
                       "the scene cannot be seen from the position of the centremost view %s: no viewpoint is valid. "
                       "Check that view's depth map.",
                       center_view);
    v->limits.max_h = fmax(v->limits.max_h, LIMIT_SLACK * at.h);
    v->limits.max_outside = fmax(v->limits.max_outside, LIMIT_SLACK * at.outside);
    s->test.limits = v->limits;
    return ST_OK;
}

/* Sets the zoom, and with it f: the best one at which the origin is valid; if there is none, the largest, and raises
 * the limits. */
static enum status find_zoom(struct cell_sampler *s, double max_zoom, const char *center_view, struct err *err)
{
    struct validity *v = s->v;
    const double focal = v->shot.lens.fx;
    double best = 0;

    for (int i = 0;; i++) {
        const double zoom = 1 + ZOOM_STEP * i, discount = pow(zoom, -ZOOM_COST);
        const struct view camera = shot_aim(&v->shot, v->shot.origin, v->shot.centroid, focal * zoom);
        bool valid;
        int count;
        if (zoom > max_zoom + 1e-9 || discount <= best) break;
        if (viewpoint_is_valid(&valid, &s->test, &camera, err)) return err->status;
        if (!valid) continue;
        if (count_valid(s, focal * zoom, &count, err)) return err->status;
        const double merit = discount * count / (ZOOM_CELLS * ZOOM_CELLS);
        if (merit > best) best = merit, v->zoom = zoom;
    }
    if (!(best > 0)) v->zoom = max_zoom;
    v->shot.lens.fx = v->shot.lens.fy = focal * v->zoom;
    return best > 0 ? ST_OK : raise_limits(s, center_view, err);
}

struct cell_job {
    struct cell_sampler *samplers; /* one per thread */
    const struct shot_end *end;
    struct validity_cell *cells;
    struct err *errors; /* one per cell */
    enum cell_task task;
    struct progress progress;
};

static void sample_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct cell_job *job = ctx;
    for (size_t i = begin; i < end; i++) {
        sample_cell(&job->samplers[thread], job->end, job->task, &job->cells[i], &job->errors[i]);
        progress_add(&job->progress, 1);
    }
}

/* Samples cells on all threads; `what` names them for the progress line. */
static enum status sample_cells(struct cell_sampler *s, const struct shot_end *end, struct validity_cell *cells,
                                int count, enum cell_task task, const char *what, struct err *err)
{
    const int threads = parallel_threads();
    struct cell_job job = {.end = end, .cells = cells, .task = task};
    job.samplers = calloc((size_t)threads, sizeof *job.samplers);
    job.errors = calloc((size_t)count + 1, sizeof *job.errors);
    if (!job.samplers || !job.errors) err_nomem(err, "cells", (size_t)count * sizeof *job.errors);

    for (int t = 0; !err->status && t < threads; t++) {
        job.samplers[t].v = s->v;
        viewpoint_test_copy(&job.samplers[t].test, &s->test);
    }
    if (!err->status) {
        progress_start(&job.progress, what, count, "cells");
        parallel_for((size_t)count, 1, sample_some, &job);
        progress_end(&job.progress);
    }
    for (int i = 0; !err->status && i < count; i++)
        if (job.errors[i].status) err_set(err, job.errors[i].status, "%s", job.errors[i].text);
    for (int t = 0; job.samplers && t < threads; t++) {
        s->test.renders += job.samplers[t].test.renders;
        viewpoint_test_release(&job.samplers[t].test);
    }
    free(job.samplers);
    free(job.errors);
    return err->status;
}

/* Samples some of the valid cells, evenly spread, again in full pictures and compares their limits. */
static enum status measure_error(struct cell_sampler *s, const struct shot_end *end, const struct validity_region *r,
                                 int wanted, struct sampling_error *e, struct err *err)
{
    const int valid = validity_region_count(r), few = wanted < valid ? wanted : valid, side = s->test.limits.side;
    struct validity_cell *again = calloc((size_t)few + 1, sizeof *again);
    const struct validity_cell **original = calloc((size_t)few + 1, sizeof *original);
    int seen = 0, taken = 0;

    if (!again || !original) err_nomem(err, "cells", (size_t)few * sizeof *again);
    for (int i = 0; !err->status && i < r->columns * r->rows && taken < few; i++) {
        const struct validity_cell *c = &r->cells[i];
        if (!c->valid || seen++ < (2 * taken + 1) * valid / (2 * few)) continue;
        again[taken] = (struct validity_cell){.x = c->x, .y = c->y};
        original[taken++] = c;
    }
    s->test.limits.side = H_REFERENCE_SIDE;
    if (!err->status && taken) sample_cells(s, end, again, taken, CELL_ALL, "cells in full pictures", err);
    s->test.limits.side = side;
    for (int i = 0; !err->status && i < taken; i++) {
        const double apart[2] = {fabs(again[i].low - original[i]->low) / s->v->step,
                                 fabs(again[i].high - original[i]->high) / s->v->step};
        for (int k = 0; k < 2; k++) {
            e->limits++;
            e->within += apart[k] < 1.5;
            e->worst = fmax(e->worst, apart[k]);
        }
    }
    free(again);
    free(original);
    return err->status;
}

static bool same_rule(const struct shot_end *a, const struct shot_end *b)
{
    return a->focal == b->focal && a->size == b->size && !memcmp(&a->target, &b->target, sizeof a->target) &&
           !memcmp(a->corner, b->corner, sizeof a->corner);
}

/* Places the cells: halves the grid until a quarter of them are valid; if that never happens, takes the size with the
 * most valid cells. *task: what is left to be done. */
static enum status fit_grid(struct cell_sampler *s, const struct shot_end *end, struct validity_region *r,
                            double extent, enum cell_task *task, struct err *err)
{
    const int cells = r->columns * r->rows;
    double best = 1, tested = 0;
    int max_valid = -1;

    for (int i = 0; !err->status && i < GRID_SIZES && cells > 1 && 4 * max_valid < cells; i++) {
        place_cells(r, &s->v->shot, false, extent, pow(0.5, i));
        sample_cells(s, end, r->cells, cells, CELL_TEST, "cells of the grid", err);
        const int valid = validity_region_count(r);
        if (valid > max_valid) max_valid = valid, best = pow(0.5, i);
        tested = pow(0.5, i);
    }
    *task = best == tested ? CELL_SEARCH : CELL_ALL;
    if (*task == CELL_SEARCH) return err->status;
    place_cells(r, &s->v->shot, cells == 1, extent, best);
    for (int i = 0; i < cells; i++) r->cells[i].valid = false;
    return err->status;
}

/* at: 0 start, 1 end. If both ends have the same rule, the end's region is a copy of the start's. */
static enum status sample_end(struct cell_sampler *s, int at, const struct validity_params *params,
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
    enum cell_task task;
    fit_grid(s, end, r, params->extent, &task, err);
    if (!err->status)
        sample_cells(s, end, r->cells, side * side, task, at ? "cells of the end" : "cells of the start", err);
    if (!err->status) measure_error(s, end, r, params->check_cells, &notes->error, err);
    return err->status;
}

/* Makes the cell nearest to the origin valid at the origin alone. */
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
    struct cell_sampler s = {.v = v};
    int center = 0;

    *notes = (struct sampling_notes){.requested_h = params->max_h, .requested_outside = params->max_outside};
    *v = (struct validity){.effect = *effect, .zoom = 1};
    v->limits = (struct viewpoint_limits){params->max_h, params->max_outside, params->check_side};
    s.test = (struct viewpoint_test){.scene = scene, .points = &points, .shot = &v->shot, .limits = v->limits};
    if (!scene_points_collect(&points, scene, err)) layout_find(&v->shot, &center, scene, &points, ups, params, err);
    if (!err->status) {
        notes->center_view = scene->set->views[center].name;
        v->step = params->tolerance * v->shot.median_depth;
        find_zoom(&s, params->max_zoom, notes->center_view, err);
    }
    if (!err->status) shot_move_make(&v->move, &v->shot, effect->move, subjects, err);
    for (int i = 0; !err->status && i < 2; i++) sample_end(&s, i, params, notes, err);
    for (int i = 0; !err->status && i < 2; i++)
        if (!validity_region_count(&v->region[i])) {
            notes->no_valid[i] = true;
            allow_origin(&v->region[i]);
        }
    notes->renders = s.test.renders;
    viewpoint_test_release(&s.test);
    scene_points_release(&points);
    if (err->status) validity_release(v);
    return err->status;
}
