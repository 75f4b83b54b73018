/* expand.c - local expansion moves (Taniai et al., "Continuous 3D Label Stereo Matching Using Local Expansion Moves", 2018) on the graph
 * of segments.
 *
 * The energy's pairs are metric (plane_problem.h), so that a choice between the old planes and one new plane is a least cut
 * (max_flow.h).
 *
 * The view is cut into cells of several sizes. A move proposes one plane to all segments of a cell and of the eight
 * around it; the best choice of those who take it is found at once, so that a whole wall may turn at one time. Cells
 * four apart in both directions do not touch each other's regions and move side by side. */
#include "stages/segment_depth/expand.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "common/base/rng.h"
#include "stages/segment_depth/max_flow.h"

#define SCALES 4
#define TRIFLE 0.03 /* of energy */
#define SWAY   0.3f /* a plane that costs a segment more than its own by so much of `hold` is not looked at for it */
#define UNITS  1e7  /* integers a unit of energy */
#define APART  4    /* cells that move side by side are so many apart */

static const double cell_segments[SCALES] = {2.5, 7, 20, 50}; /* a cell's side in segments' */

struct cells {
    int across, down;
    int *first;   /* across * down + 1 */
    int *members; /* segments by cell */
};

struct worker {
    struct max_flow flow;
    int *local;   /* a segment's number in the region, -1 outside */
    int *region;  /* the region's segments */
    float *unary; /* of the proposed plane */
};

struct expander {
    const struct plane_problem *p;
    const struct segmentation *s;
    struct plane *plane, *before; /* before: when the group of cells began to move; of what lies outside a region */
    float *unary, *least;         /* of each segment's present plane; the least that any plane tried has had */
    float *hold;                  /* the most that each segment's neighbours can make it pay */
    struct cells cells[SCALES];
    struct rng rng;
    struct worker *workers;
    int pass, passes, scale;
    const int *group; /* the cells that move now */
    struct err *errs; /* a worker each */
};

/* Whether a segment cannot gain more than a trifle: its plane matches as well as any that was tried, and its neighbours agree. */
static bool content(const struct expander *x, const struct worker *w, int i)
{
    double gain = (double)(x->unary[i] - x->least[i]);
    for (int t = x->s->first_touch[i]; t < x->s->first_touch[i + 1] && gain < TRIFLE; t++) {
        const int j = x->s->touches[t].other;
        gain += problem_pair(x->p, i, t, x->plane[i], w->local[j] < 0 ? x->before[j] : x->plane[j]);
    }
    return gain < TRIFLE;
}

static int64_t units(double energy) { return (int64_t)(energy * UNITS); }

struct move {
    struct expander *x;
    struct worker *w;
    struct plane proposal;
};

/* Of the proposal, to the region's segments. */
static void unary_costs(void *ctx, size_t begin, size_t end, int thread)
{
    const struct move *m = ctx;
    struct expander *x = m->x;
    const struct plane p = m->proposal;
    (void)thread;
    for (size_t k = begin; k < end; k++) {
        const int i = m->w->region[k];
        const struct plane own = x->plane[i];
        if (k + 1 < end) match_prefetch(x->p->m, m->w->region[k + 1], p);
        if (own.a == p.a && own.b == p.b && own.c == p.c) {
            m->w->unary[k] = x->unary[i];
        } else if (x->pass > 0 && x->scale == 0 && content(x, m->w, i)) {
            m->w->unary[k] = PLANE_NEVER;
        } else {
            m->w->unary[k] = problem_unary(x->p, i, p, x->unary[i] + SWAY * x->hold[i]);
            x->least[i] = fminf(x->least[i], m->w->unary[k]);
        }
    }
}

/* One move. */
static void expand(struct expander *x, struct worker *w, int count, struct plane proposal, struct err *err)
{
    const struct segmentation *s = x->s;
    int edges = 0;
    for (int k = 0; k < count; k++) edges += s->first_touch[w->region[k] + 1] - s->first_touch[w->region[k]];
    if (max_flow_begin(&w->flow, count, edges, err)) return;
    bool hope = false;
    struct move move = {x, w, proposal};
    parallel_for((size_t)count, 128, unary_costs, &move);
    for (int k = 0; k < count; k++) {
        const int i = w->region[k];
        hope = hope || w->unary[k] < x->unary[i];
        max_flow_terminal(&w->flow, k, units((double)w->unary[k] - (double)x->unary[i]));
    }
    for (int k = 0; k < count; k++) {
        const int i = w->region[k];
        for (int t = s->first_touch[i]; t < s->first_touch[i + 1]; t++) {
            const struct touch *touch = &s->touches[t];
            const int j = touch->other, other = w->local[j];
            if (other >= 0 && j < i) continue;
            const struct plane pi = x->plane[i], pj = other < 0 ? x->before[j] : x->plane[j];
            const double kept = problem_pair(x->p, i, t, pi, pj);
            const double i_moves = problem_pair(x->p, i, t, proposal, pj);
            if (other < 0) {
                max_flow_terminal(&w->flow, k, units(i_moves - kept));
                hope = hope || i_moves < kept;
                continue;
            }
            const double j_moves = problem_pair(x->p, i, t, pi, proposal);
            const int64_t a = units(kept), b = units(j_moves), c = units(i_moves);
            hope = hope || a > 0;
            max_flow_terminal(&w->flow, k, c - a);
            max_flow_terminal(&w->flow, other, -c);
            const int64_t both = b + c - a;
            max_flow_edge(&w->flow, k, other, both > 0 ? both : 0, 0);
        }
    }
    if (!hope || max_flow_solve(&w->flow, err)) return;
    for (int k = 0; k < count; k++) {
        const int i = w->region[k];
        if (!max_flow_on_sink_side(&w->flow, k) || !(w->unary[k] < PLANE_NEVER)) continue;
        x->plane[i] = proposal;
        x->unary[i] = w->unary[k];
    }
}

struct dice {
    const struct rng *rng;
    uint64_t cell, index;
};
static double roll(struct dice *d) { return rng_uniform(d->rng, d->cell, d->index++); }
static int pick(struct dice *d, const int *from, int count) { return from[(int)(roll(d) * count)]; }

/* Through the centroids of three segments at their present depths. */
static bool plane_through_three(const struct expander *x, const int *members, int count, struct dice *d,
                                struct plane *out)
{
    const struct segment *g[3];
    double z[3];
    for (int k = 0; k < 3; k++) {
        const int i = pick(d, members, count);
        g[k] = &x->s->segments[i];
        z[k] = plane_at(x->plane[i], g[k]->cx, g[k]->cy);
    }
    const double ux = g[1]->cx - g[0]->cx, uy = g[1]->cy - g[0]->cy, vx = g[2]->cx - g[0]->cx, vy = g[2]->cy - g[0]->cy;
    const double det = ux * vy - uy * vx, reach = hypot(ux, uy) * hypot(vx, vy);
    if (!(fabs(det) > 0.2 * reach) || !(reach > 0)) return false;
    const double a = ((z[1] - z[0]) * vy - (z[2] - z[0]) * uy) / det,
                 b = ((z[2] - z[0]) * ux - (z[1] - z[0]) * vx) / det;
    *out = (struct plane){a, b, z[0] - a * g[0]->cx - b * g[0]->cy};
    return true;
}

/* Of the camera's axes: where a segment's middle is now. */
static struct vec3 middle_of(const struct expander *x, int i)
{
    const struct segment *g = &x->s->segments[i];
    const struct view *v = x->p->view;
    const double z = 1 / plane_at(x->plane[i], g->cx, g->cy);
    return vec3_make((g->cx - v->cx) / v->fx * z, (g->cy - v->cy) / v->fy * z, z);
}

static bool plane_from_normal(const struct view *v, struct vec3 normal, struct vec3 point, struct plane *out)
{
    const double distance = vec3_dot(normal, point);
    if (!(fabs(distance) > 1e-6 * vec3_length(point))) return false;
    const double a = normal.x / distance / v->fx, b = normal.y / distance / v->fy;
    *out = (struct plane){a, b, normal.z / distance - a * v->cx - b * v->cy};
    return isfinite(a) && isfinite(b) && isfinite(out->c);
}

/* How floors and ceilings lie: level, through a segment. */
static bool level_plane(const struct expander *x, int i, struct plane *out)
{
    return plane_from_normal(x->p->view, x->p->down, middle_of(x, i), out);
}

/* How walls stand: upright, through two segments. */
static bool upright_plane(const struct expander *x, int i, int j, struct plane *out)
{
    const struct vec3 p = middle_of(x, i), along = vec3_sub(middle_of(x, j), p), n = vec3_cross(x->p->down, along);
    if (!(vec3_length(n) > 0.2 * vec3_length(along)) || i == j) return false;
    return plane_from_normal(x->p->view, vec3_normalize(n), p, out);
}

/* A depth at which the sweep found a segment to match better than at those beside it, one of the best few; with the
 * slant that the segment has now, or none. */
static struct plane plane_from_sweep(const struct expander *x, int i, struct dice *d)
{
    enum { MOST = 4 };
    const struct plane_problem *p = x->p;
    const float *cost = p->cost + (size_t)i * (size_t)p->planes;
    int best[MOST], count = 0;
    for (int l = 0; l < p->planes; l++) {
        if ((l > 0 && cost[l - 1] < cost[l]) || (l + 1 < p->planes && cost[l + 1] <= cost[l])) continue;
        int at = count < MOST ? count++ : cost[l] < cost[best[MOST - 1]] ? MOST - 1 : MOST;
        if (at == MOST) continue;
        for (; at > 0 && cost[best[at - 1]] > cost[l]; at--) best[at] = best[at - 1];
        best[at] = l;
    }
    const int label = count ? best[(int)(roll(d) * count)] : (int)(roll(d) * p->planes);
    const double z = p->least + label * p->step;
    const struct segment *g = &x->s->segments[i];
    struct plane now = x->plane[i];
    if (roll(d) < 0.5) now.a = now.b = 0;
    return (struct plane){now.a, now.b, z - now.a * g->cx - now.b * g->cy};
}

/* The plane of a segment, moved and turned a little: by about as much at the rim of a cell as in its middle. Half of the planes
 * that face the camera go on facing it. */
static struct plane shaken(const struct expander *x, int i, struct dice *d)
{
    const struct segment *g = &x->s->segments[i];
    const double reach = x->p->step * 2 * pow(0.5, x->pass);
    const double size = sqrt(x->p->params->segment_pixels) * (x->scale ? cell_segments[x->scale] : 1);
    struct plane p = x->plane[i];
    const double z = plane_at(p, g->cx, g->cy) + (2 * roll(d) - 1) * reach;
    if (p.a != 0 || p.b != 0 || roll(d) < 0.5) {
        p.a += (2 * roll(d) - 1) * reach / size;
        p.b += (2 * roll(d) - 1) * reach / size;
    }
    return (struct plane){p.a, p.b, z - p.a * g->cx - p.b * g->cy};
}

static void move_cell(struct expander *x, struct worker *w, int cell, struct err *err)
{
    const struct cells *c = &x->cells[x->scale];
    const int cx = cell % c->across, cy = cell / c->across, inner = c->first[cell + 1] - c->first[cell];
    const int *members = c->members + c->first[cell];
    int count = 0;
    if (!inner) return;
    for (int y = cy > 0 ? cy - 1 : 0; y <= cy + 1 && y < c->down; y++)
        for (int k = c->first[y * c->across + (cx > 0 ? cx - 1 : 0)];
             k < c->first[y * c->across + (cx + 1 < c->across ? cx + 1 : cx) + 1]; k++) {
            w->local[c->members[k]] = count;
            w->region[count++] = c->members[k];
        }
    struct dice d = {&x->rng, (uint64_t)cell, (uint64_t)(x->pass * SCALES + x->scale) << 16};
    const int tries = x->scale < 2 ? 2 : 1; /* of a kind: moves of large cells cost more and rarely gain */
    struct plane proposal;
    if (x->p->cross && x->scale == 0 && !err->status) {
        const int i = pick(&d, members, inner), *first = x->p->cross->first_proposal + i;
        if (first[1] > first[0])
            expand(x, w, count, x->p->cross->proposals[first[0] + (int)(roll(&d) * (first[1] - first[0]))], err);
    }
    for (int k = 0; k < tries && !err->status; k++) expand(x, w, count, x->plane[pick(&d, members, inner)], err);
    if (x->scale == 0 && x->p->cost && !err->status)
        expand(x, w, count, plane_from_sweep(x, pick(&d, members, inner), &d), err);
    for (int k = 0; k < tries && !err->status; k++) expand(x, w, count, shaken(x, pick(&d, members, inner), &d), err);
    for (int k = 0; k < tries && !err->status; k++)
        if (plane_through_three(x, k ? w->region : members, k ? count : inner, &d, &proposal))
            expand(x, w, count, proposal, err);
    for (int k = 0; k < tries && !err->status && x->scale > 0; k++) {
        const int *from = k ? w->region : members, n = k ? count : inner;
        if (level_plane(x, pick(&d, from, n), &proposal)) expand(x, w, count, proposal, err);
        if (upright_plane(x, pick(&d, from, n), pick(&d, from, n), &proposal)) expand(x, w, count, proposal, err);
    }
    for (int k = 0; k < count; k++) w->local[w->region[k]] = -1;
}

static void move_group(void *ctx, size_t begin, size_t end, int thread)
{
    struct expander *x = ctx;
    for (size_t k = begin; k < end; k++)
        if (!x->errs[thread].status) move_cell(x, &x->workers[thread], x->group[k], &x->errs[thread]);
}

static void first_costs(void *ctx, size_t begin, size_t end, int thread)
{
    struct expander *x = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        x->hold[i] = 0;
        for (int t = x->s->first_touch[i]; t < x->s->first_touch[i + 1]; t++)
            x->hold[i] += (float)x->p->params->smoothness * x->p->weights[t];
        x->least[i] = x->unary[i] = problem_unary(x->p, (int)i, x->plane[i], INFINITY);
    }
}

static enum status make_cells(struct cells *c, const struct segmentation *s, double side, struct err *err)
{
    c->across = (int)ceil(s->width / side);
    c->down = (int)ceil(s->height / side);
    const int count = c->across * c->down;
    c->first = calloc((size_t)count + 2, sizeof *c->first);
    c->members = malloc(((size_t)s->count + 1) * sizeof *c->members);
    if (!c->first || !c->members) return err_nomem(err, "cells of segments", (size_t)(count + s->count) * sizeof(int));
    for (int i = 0; i < s->count; i++)
        c->first[(int)(s->segments[i].cy / side) * c->across + (int)(s->segments[i].cx / side) + 2]++;
    for (int k = 0; k < count; k++) c->first[k + 2] += c->first[k + 1];
    for (int i = 0; i < s->count; i++)
        c->members[c->first[(int)(s->segments[i].cy / side) * c->across + (int)(s->segments[i].cx / side) + 1]++] = i;
    return ST_OK;
}

static enum status init_workers(struct expander *x, int threads, struct err *err)
{
    x->workers = calloc((size_t)threads, sizeof *x->workers);
    x->errs = calloc((size_t)threads, sizeof *x->errs);
    const size_t n = (size_t)x->s->count + 1;
    bool ok = x->workers && x->errs;
    for (int t = 0; ok && t < threads; t++) {
        struct worker *w = &x->workers[t];
        ok = (w->local = malloc(n * sizeof *w->local)) && (w->region = malloc(n * sizeof *w->region)) &&
             (w->unary = malloc(n * sizeof *w->unary));
        for (size_t i = 0; ok && i < n; i++) w->local[i] = -1;
    }
    return ok ? ST_OK : err_nomem(err, "expansion moves", n * 12 * (size_t)threads);
}

static void release(struct expander *x, int threads)
{
    for (int t = 0; x->workers && t < threads; t++) {
        max_flow_release(&x->workers[t].flow);
        free(x->workers[t].local);
        free(x->workers[t].region);
        free(x->workers[t].unary);
    }
    for (int k = 0; k < SCALES; k++) {
        free(x->cells[k].first);
        free(x->cells[k].members);
    }
    free(x->workers);
    free(x->errs);
    free(x->unary);
    free(x->least);
    free(x->hold);
    free(x->before);
}

/* Large cells pay off at the beginning. */
static int scales_of(const struct expander *x)
{
    const int left = SCALES - (x->p->cross ? 1 : 0) - x->pass;
    return left > 2 ? left : 2;
}

enum status expand_planes(struct plane *plane, const struct plane_problem *p, struct err *err)
{
    struct plane_problem rough =
        *p; /* many planes tried count more than each one's last digit; refine_planes() adds that */
    rough.rough = true;
    struct expander x = {.p = &rough,
                         .s = p->m->segments,
                         .plane = plane,
                         .passes = problem_passes(p),
                         .rng = rng_make(1, "segment_depth", "expand")};
    const int threads = parallel_threads();
    struct progress progress;
    int *group = malloc(((size_t)x.s->count + 64) * sizeof *group);
    x.unary = malloc(((size_t)x.s->count + 1) * sizeof *x.unary);
    x.hold = malloc(((size_t)x.s->count + 1) * sizeof *x.hold);
    x.least = malloc(((size_t)x.s->count + 1) * sizeof *x.least);
    x.before = malloc(((size_t)x.s->count + 1) * sizeof *x.before);
    enum status st =
        group && x.unary && x.hold && x.least && x.before ? ST_OK : err_nomem(err, "planes", (size_t)x.s->count * 32);
    if (!st) st = init_workers(&x, threads, err);
    int cells = 0;
    for (int k = 0; !st && k < SCALES; k++) {
        st = make_cells(&x.cells[k], x.s, cell_segments[k] * sqrt(p->params->segment_pixels), err);
        cells += x.cells[k].across * x.cells[k].down;
    }
    if (!st) {
        parallel_for((size_t)x.s->count, 64, first_costs, &x);
        progress_start(&progress, "expansion", (int64_t)x.passes * cells, "cells");
    }
    for (x.pass = 0; !st && x.pass < x.passes; x.pass++) {
        for (x.scale = 0; !st && x.scale < scales_of(&x); x.scale++) {
            const struct cells *c = &x.cells[x.scale];
            for (int g = 0; !st && g < APART * APART; g++) {
                int count = 0;
                for (int y = g / APART; y < c->down; y += APART)
                    for (int cx = g % APART; cx < c->across; cx += APART) group[count++] = y * c->across + cx;
                x.group = group;
                memcpy(x.before, plane, (size_t)x.s->count * sizeof *plane);
                if (count >= 4 * threads)
                    parallel_for((size_t)count, 1, move_group, &x);
                else /* few and large: one after the other, the costs of each side by side */
                    move_group(&x, 0, (size_t)count, 0);
                progress_add(&progress, count);
                for (int t = 0; !st && t < threads; t++)
                    if (x.errs[t].status) {
                        *err = x.errs[t];
                        st = err->status;
                    }
            }
        }
    }
    if (!st) progress_end(&progress);
    release(&x, threads);
    free(group);
    return st;
}
