/* expand.c - planes of segments by local expansion moves [Taniai 2018].
 *
 * The energy (plane_problem.h) is made small move by move. A move proposes one plane to all segments of a region: each
 * keeps its plane (label 0) or takes the proposal (label 1). Because the pairwise terms are metric, the best of these
 * 2^n labellings is a minimum cut [Boykov 2001]; max_flow.h finds it. So a whole wall can turn in one move, and the
 * energy never rises. With E(0, 0) = a, E(0, 1) = b, E(1, 0) = c and E(1, 1) = 0 the costs of an edge (i, j) become
 * [Kolmogorov 2004]
 *   terminal weights  c - a at i, -c at j;   arc i -> j with capacity b + c - a >= 0
 *
 * The view is divided into cells of SCALES sizes; a region is a cell and the eight around it. Cells that are APART
 * cells apart in both directions have disjoint regions that share no edge, and are moved in parallel; the
 * planes outside a region are those from before the group began, so that the result does not depend on threads.
 *
 * A wall that no picture decides takes the plane of the part that one does, however large it is: after the first pass
 * the scene's dominant planes (scene_planes.h) are offered to all segments at once. Each is then fitted to the segments
 * that took it (plane_refit.h), and offered again, REFITS times. The ground (gravity.h) is offered with them, unless
 * the votes know it better, and is not fitted: a lawn matches nothing.
 *
 * Floor, ceiling and walls that are known before (plane_prior.h) are offered first. Each takes the place of the plane
 * of votes that is about the same, and is not fitted: what little matches on a blank wall would move it by chance.
 *
 * What differs from the source: the nodes are segments, not pixels; proposals also come from the sweep, from
 * neighbouring views and from horizontal and vertical planes (plane_proposals.h); data costs are only computed while
 * they can still pay off. */
#include "stages/segment_depth/expand.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "stages/segment_depth/max_flow.h"
#include "stages/segment_depth/plane_proposals.h"
#include "stages/segment_depth/plane_refit.h"

#define SCALES             4
#define NEGLIGIBLE         0.03 /* energy that a segment need not be moved for */
#define MAX_PAIRWISE_SHARE 0.3f /* a data cost may rise by this part of max_pairwise; else the proposal is skipped */
#define UNITS_PER_ENERGY   1e7  /* energies are rounded to multiples of 1 / UNITS_PER_ENERGY */
#define SAME_KNOWN         0.06 /* of a known plane's inverse distance, and radians */
#define SAME_GROUND        0.15 /* of the ground's inverse distance, and radians */
#define MIN_SHARE          0.03 /* of all votes: weight of a plane of the scene, in the first round */
#define MIN_SHARE_LATER    0.10 /* ... in later ones, where neighbours vote, too */
#define REFITS             2
#define APART              4 /* distance in cells between those that are moved in parallel */

static const double cell_segments[SCALES] = {2.5, 7, 20, 50}; /* side of a cell, in sides of a mean segment */

struct cells {
    int across, down;
    int *first;   /* across * down + 1 */
    int *members; /* segments by cell */
};

struct worker {
    struct max_flow flow;
    int *local;   /* index of a segment in the region, -1 outside */
    int *region;  /* the region's segments */
    float *unary; /* of the proposed plane, by index in the region */
};

struct expander {
    const struct plane_problem *p;
    const struct segmentation *s;
    struct plane *plane, *before; /* before: at the start of the group, for segments outside a region */
    float *unary, *min_unary;     /* data cost of each segment's current plane; minimum over all planes tried */
    float *max_pairwise;          /* maximum of each segment's pairwise terms */
    struct cells cells[SCALES];
    struct rng rng;
    struct worker *workers;
    int pass, passes, scale;
    const int *group; /* the cells that are being moved */
    struct err *errs; /* one per worker */
};

/* Whether a segment can gain no more than NEGLIGIBLE: its plane matches as well as any that was tried, and its
 * neighbours agree. */
static bool converged(const struct expander *x, const struct worker *w, int i)
{
    double gain = (double)(x->unary[i] - x->min_unary[i]);
    for (int t = x->s->first_border[i]; t < x->s->first_border[i + 1] && gain < NEGLIGIBLE; t++) {
        const int j = x->s->borders[t].other;
        gain += problem_pairwise_cost(x->p, i, t, x->plane[i], w->local[j] < 0 ? x->before[j] : x->plane[j]);
    }
    return gain < NEGLIGIBLE;
}

static int64_t capacity_from(double energy) { return (int64_t)(energy * UNITS_PER_ENERGY); }

struct expansion {
    struct expander *x;
    struct worker *w;
    struct plane proposal;
};

/* Data costs of the proposal for the region's segments. */
static void unary_costs(void *ctx, size_t begin, size_t end, int thread)
{
    const struct expansion *m = ctx;
    struct expander *x = m->x;
    const struct plane p = m->proposal;
    (void)thread;
    for (size_t k = begin; k < end; k++) {
        const int i = m->w->region[k];
        const struct plane own = x->plane[i];
        if (k + 1 < end) match_prefetch(x->p->m, m->w->region[k + 1], p);
        if (own.a == p.a && own.b == p.b && own.c == p.c) {
            m->w->unary[k] = x->unary[i];
        } else if (x->pass > 0 && x->scale == 0 && converged(x, m->w, i)) {
            m->w->unary[k] = PLANE_FORBIDDEN;
        } else {
            m->w->unary[k] = problem_unary_cost(x->p, i, p, x->unary[i] + MAX_PAIRWISE_SHARE * x->max_pairwise[i]);
            x->min_unary[i] = fminf(x->min_unary[i], m->w->unary[k]);
        }
    }
}

/* Minimizes the energy over which segments of the region take the proposal, and assigns it to them. */
static void expansion_move(struct expander *x, struct worker *w, int count, struct plane proposal, struct err *err)
{
    const struct segmentation *s = x->s;
    int edges = 0;
    for (int k = 0; k < count; k++) edges += s->first_border[w->region[k] + 1] - s->first_border[w->region[k]];
    if (max_flow_begin(&w->flow, count, edges, err)) return;
    bool improvable = false;
    struct expansion move = {x, w, proposal};
    parallel_for((size_t)count, 128, unary_costs, &move);
    for (int k = 0; k < count; k++) {
        const int i = w->region[k];
        improvable = improvable || w->unary[k] < x->unary[i];
        max_flow_terminal(&w->flow, k, capacity_from((double)w->unary[k] - (double)x->unary[i]));
    }
    for (int k = 0; k < count; k++) {
        const int i = w->region[k];
        for (int t = s->first_border[i]; t < s->first_border[i + 1]; t++) {
            const struct border *border = &s->borders[t];
            const int j = border->other, other = w->local[j];
            if (other >= 0 && j < i) continue;
            const struct plane pi = x->plane[i], pj = other < 0 ? x->before[j] : x->plane[j];
            const double kept = problem_pairwise_cost(x->p, i, t, pi, pj);
            const double i_moves = problem_pairwise_cost(x->p, i, t, proposal, pj);
            if (other < 0) {
                max_flow_terminal(&w->flow, k, capacity_from(i_moves - kept));
                improvable = improvable || i_moves < kept;
                continue;
            }
            const double j_moves = problem_pairwise_cost(x->p, i, t, pi, proposal);
            const int64_t a = capacity_from(kept), b = capacity_from(j_moves), c = capacity_from(i_moves);
            improvable = improvable || a > 0;
            max_flow_terminal(&w->flow, k, c - a);
            max_flow_terminal(&w->flow, other, -c);
            const int64_t both = b + c - a;
            max_flow_edge(&w->flow, k, other, both > 0 ? both : 0, 0);
        }
    }
    if (!improvable || max_flow_solve(&w->flow, err)) return;
    for (int k = 0; k < count; k++) {
        const int i = w->region[k];
        if (!max_flow_on_sink_side(&w->flow, k) || !(w->unary[k] < PLANE_FORBIDDEN)) continue;
        x->plane[i] = proposal;
        x->unary[i] = w->unary[k];
    }
}

/* Lists the cell's segments and those of the eight cells around it in w->region; returns how many. */
static int gather_region(const struct cells *c, struct worker *w, int cell)
{
    const int cx = cell % c->across, cy = cell / c->across;
    int count = 0;
    for (int y = cy > 0 ? cy - 1 : 0; y <= cy + 1 && y < c->down; y++)
        for (int k = c->first[y * c->across + (cx > 0 ? cx - 1 : 0)];
             k < c->first[y * c->across + (cx + 1 < c->across ? cx + 1 : cx) + 1]; k++) {
            w->local[c->members[k]] = count;
            w->region[count++] = c->members[k];
        }
    return count;
}

static void move_cell(struct expander *x, struct worker *w, int cell, struct err *err)
{
    const struct cells *c = &x->cells[x->scale];
    const struct plane_problem *p = x->p;
    const int own = c->first[cell + 1] - c->first[cell], *members = c->members + c->first[cell];
    if (!own) return;
    const int count = gather_region(c, w, cell);
    struct cell_random random = {&x->rng, (uint64_t)cell, (uint64_t)(x->pass * SCALES + x->scale) << 16};
    const int tries = x->scale < 2 ? 2 : 1; /* of each kind: moves of large cells cost more and rarely gain */
    struct plane proposal;
    if (p->cross && x->scale == 0 && !err->status) {
        const int i = random_member(&random, members, own), *first = p->cross->first_proposal + i;
        if (first[1] > first[0])
            expansion_move(x, w, count,
                           p->cross->proposals[first[0] + (int)(random_number(&random) * (first[1] - first[0]))], err);
    }
    for (int k = 0; k < tries && !err->status; k++)
        expansion_move(x, w, count, x->plane[random_member(&random, members, own)], err);
    if (x->scale == 0 && p->cost && !err->status) {
        const int i = random_member(&random, members, own);
        expansion_move(x, w, count, proposal_from_sweep(p, x->plane, i, &random), err);
    }
    const double change = p->step * 2 * pow(0.5, x->pass);
    const double size = sqrt(p->params->segment_pixels) * (x->scale ? cell_segments[x->scale] : 1);
    for (int k = 0; k < tries && !err->status; k++) {
        const int i = random_member(&random, members, own);
        expansion_move(x, w, count, proposal_perturbed(p, x->plane, i, change, size, &random), err);
    }
    for (int k = 0; k < tries && !err->status; k++)
        if (proposal_through_three(&proposal, p, x->plane, k ? w->region : members, k ? count : own, &random))
            expansion_move(x, w, count, proposal, err);
    for (int k = 0; k < tries && !err->status && x->scale > 0; k++) {
        const int *from = k ? w->region : members, n = k ? count : own;
        if (proposal_horizontal(&proposal, p, x->plane, random_member(&random, from, n)))
            expansion_move(x, w, count, proposal, err);
        const int j = random_member(&random, from, n), i = random_member(&random, from, n);
        if (proposal_vertical(&proposal, p, x->plane, i, j)) expansion_move(x, w, count, proposal, err);
        for (int f = 1; p->families && f < p->families->count; f++)
            if (proposal_of_family(&proposal, p, x->plane, random_member(&random, from, n), f))
                expansion_move(x, w, count, proposal, err);
    }
    for (int k = 0; k < count; k++) w->local[w->region[k]] = -1;
}

/* Collects the planes that the view's segments are on and those of its neighbours in the round before. */
static enum status find_scene_planes(const struct expander *x, struct err *err)
{
    const struct cross_view *cross = x->p->cross;
    const struct segmentation *s = x->s;
    const size_t most = (size_t)s->count + (size_t)(cross ? cross->first_proposal[s->count] : 0) + 1;
    struct plane_vote *votes = malloc(most * sizeof *votes);
    int count = 0;
    if (!votes) return err_nomem(err, "planes of a scene", most * sizeof *votes);
    for (int i = 0; i < s->count; i++) {
        const struct segment *g = &s->segments[i];
        votes[count++] = (struct plane_vote){x->plane[i], g->cx, g->cy, g->pixels};
        for (int k = cross ? cross->first_proposal[i] : 0; cross && k < cross->first_proposal[i + 1]; k++)
            votes[count++] = (struct plane_vote){cross->proposals[k], g->cx, g->cy, g->pixels};
    }
    double total = 0;
    for (int i = 0; i < count; i++) total += votes[i].weight;
    scene_planes_find(x->p->scene, votes, count, x->p->step, (cross ? MIN_SHARE_LATER : MIN_SHARE) * total, err);
    free(votes);
    return err->status;
}

/* Before there are votes, the ground is the only plane of the scene. */
static void start_scene(struct scene_planes *scene, const struct plane_prior *prior, const struct plane *ground)
{
    *scene = (struct scene_planes){.count = 0};
    for (int k = 0; prior && k < prior->count; k++) {
        scene->known = ++scene->count;
        scene_planes_set(scene, k, prior->planes[k]);
    }
    if (!ground) return;
    scene->has_ground = true;
    scene_planes_set(scene, scene->count++, *ground);
}

/* How far a plane is from another, whose normal is n, in the units of n. */
static double plane_off(const struct view *view, struct plane p, struct vec3 n)
{
    return vec3_length(vec3_sub(plane_normal(view, p), n));
}

/* Moves each known plane to the plane of votes that is about the same: the view's own pictures know it better. */
static void follow_votes(struct scene_planes *scene, const struct view *view)
{
    for (int k = 0; k < scene->known; k++) {
        const struct vec3 n = plane_normal(view, scene->planes[k]);
        double least = SAME_KNOWN * vec3_length(n);
        int best = -1;
        for (int j = scene->known; j < scene->count; j++) {
            const double off = plane_off(view, scene->planes[j], n);
            if (!(off <= least)) continue;
            least = off;
            best = j;
        }
        if (best >= 0) scene_planes_set(scene, k, scene->planes[best]);
    }
}

/* Adds the ground to the planes of votes, in place of the last one if there are too many, unless one of them is about
 * the ground: then votes know it better, or what looks like the ground is a table. */
static void add_ground(struct scene_planes *scene, const struct view *view, struct plane ground)
{
    const struct vec3 n = plane_normal(view, ground);
    for (int k = 0; k < scene->count; k++)
        if (plane_off(view, scene->planes[k], n) <= SAME_GROUND * vec3_length(n)) {
            scene->voted_ground = k + 1;
            return;
        }
    if (scene->count < SCENE_PLANES) scene->count++;
    scene_planes_set(scene, scene->count - 1, ground);
    scene->has_ground = true;
}

/* Fits the scene's plane k to the segments that lie on it, which move with it; those whose depth is given stay.
 * members: room for all segments. */
static void refit_scene_plane(struct expander *x, int k, int *members)
{
    struct scene_planes *scene = x->p->scene;
    int count = 0;
    for (int i = 0; i < x->s->count; i++)
        if (!given_depth_has(x->p->given, i) && memcmp(&x->plane[i], &scene->planes[k], sizeof x->plane[i]) == 0)
            members[count++] = i;
    plane_refit(scene, k, members, count, x->p);
    for (int n = 0; n < count; n++) {
        const int i = members[n];
        x->plane[i] = scene->planes[k];
        x->unary[i] = problem_unary_cost(x->p, i, x->plane[i], INFINITY);
        x->min_unary[i] = fminf(x->min_unary[i], x->unary[i]);
    }
}

/* Offers the scene's planes to all segments at once. */
static enum status move_to_scene_planes(struct expander *x, struct err *err)
{
    struct worker *w = &x->workers[0];
    int *members = malloc(((size_t)x->s->count + 1) * sizeof *members);
    if (members)
        find_scene_planes(x, err);
    else
        err_nomem(err, "segments on a plane", (size_t)x->s->count * sizeof *members);
    if (!err->status) follow_votes(x->p->scene, x->p->view);
    if (x->p->ground) {
        if (!err->status) add_ground(x->p->scene, x->p->view, *x->p->ground);
        for (int i = 0; i < x->s->count; i++) x->unary[i] = problem_unary_cost(x->p, i, x->plane[i], INFINITY);
    }
    const int fitted = x->p->scene->count - x->p->scene->has_ground;
    memcpy(x->before, x->plane, (size_t)x->s->count * sizeof *x->plane);
    for (int i = 0; i < x->s->count; i++) w->local[i] = w->region[i] = i;
    for (int round = 0; !err->status && round <= REFITS; round++)
        for (int k = 0; !err->status && k < x->p->scene->count; k++) {
            if (round && k >= x->p->scene->known && k < fitted) refit_scene_plane(x, k, members);
            expansion_move(x, w, x->s->count, x->p->scene->planes[k], err);
        }
    for (int k = 0; !err->status && x->p->furniture && k < x->p->furniture->count; k++)
        expansion_move(x, w, x->s->count, x->p->furniture->planes[k], err);
    for (int i = 0; i < x->s->count; i++) w->local[i] = -1;
    free(members);
    return err->status;
}

static void move_cells(void *ctx, size_t begin, size_t end, int thread)
{
    struct expander *x = ctx;
    for (size_t k = begin; k < end; k++)
        if (!x->errs[thread].status) move_cell(x, &x->workers[thread], x->group[k], &x->errs[thread]);
}

static void initial_costs(void *ctx, size_t begin, size_t end, int thread)
{
    struct expander *x = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        x->max_pairwise[i] = 0;
        for (int t = x->s->first_border[i]; t < x->s->first_border[i + 1]; t++)
            x->max_pairwise[i] += (float)problem_pairwise_bound(x->p, t);
        x->min_unary[i] = x->unary[i] = problem_unary_cost(x->p, (int)i, x->plane[i], INFINITY);
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
    free(x->min_unary);
    free(x->max_pairwise);
    free(x->before);
}

/* Large cells pay off at the beginning: the first pass moves cells of all sizes, the second those of the smaller half,
 * later ones, and rounds after the first, whose segments are small, the smallest only. */
static int scale_count(const struct expander *x)
{
    return x->p->cross || x->pass > 1 ? 1 : x->pass ? SCALES / 2 : SCALES;
}

enum status expand_planes(struct plane *plane, const struct plane_problem *p, struct err *err)
{
    struct plane_problem rough = *p;
    rough.rough = true; /* many proposals matter more than exact costs, which refine_planes() adds */
    struct expander x = {.p = &rough,
                         .s = p->m->segments,
                         .plane = plane,
                         .passes = problem_passes(p),
                         .rng = rng_make(1, "segment_depth", "expand")};
    const int threads = parallel_threads();
    struct progress progress;
    int *group = malloc(((size_t)x.s->count + 64) * sizeof *group);
    x.unary = malloc(((size_t)x.s->count + 1) * sizeof *x.unary);
    x.max_pairwise = malloc(((size_t)x.s->count + 1) * sizeof *x.max_pairwise);
    x.min_unary = malloc(((size_t)x.s->count + 1) * sizeof *x.min_unary);
    x.before = malloc(((size_t)x.s->count + 1) * sizeof *x.before);
    if (group && x.unary && x.max_pairwise && x.min_unary && x.before)
        init_workers(&x, threads, err);
    else
        err_nomem(err, "planes", (size_t)x.s->count * 32);
    int cells = 0;
    for (int k = 0; !err->status && k < SCALES; k++) {
        make_cells(&x.cells[k], x.s, cell_segments[k] * sqrt(p->params->segment_pixels), err);
        cells += x.cells[k].across * x.cells[k].down;
    }
    if (!err->status) {
        if (p->scene) start_scene(p->scene, p->prior, p->ground);
        parallel_for((size_t)x.s->count, 64, initial_costs, &x);
        progress_start(&progress, "expansion", (int64_t)x.passes * cells, "cells");
    }
    for (x.pass = 0; !err->status && x.pass < x.passes; x.pass++) {
        for (x.scale = 0; !err->status && x.scale < scale_count(&x); x.scale++) {
            const struct cells *c = &x.cells[x.scale];
            for (int g = 0; !err->status && g < APART * APART; g++) {
                int count = 0;
                for (int y = g / APART; y < c->down; y += APART)
                    for (int cx = g % APART; cx < c->across; cx += APART) group[count++] = y * c->across + cx;
                x.group = group;
                memcpy(x.before, plane, (size_t)x.s->count * sizeof *plane);
                if (count >= 4 * threads)
                    parallel_for((size_t)count, 1, move_cells, &x);
                else /* few and large: in sequence, with the data costs of each in parallel */
                    move_cells(&x, 0, (size_t)count, 0);
                progress_add(&progress, count);
                for (int t = 0; !err->status && t < threads; t++)
                    if (x.errs[t].status) *err = x.errs[t];
            }
        }
        if (!err->status && p->scene && x.pass == 0) move_to_scene_planes(&x, err);
    }
    if (!err->status) progress_end(&progress);
    release(&x, threads);
    free(group);
    return err->status;
}
