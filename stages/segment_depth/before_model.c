/* before_model.c - which segments of a view stand before the solid model, and which lie on it.
 *
 * A segment is off its face if its depth differs from that of the face. Adjacent segments off their faces whose planes
 * meet at the border are a thing.
 *
 * 1. A thing needs the evidence of two views: segments on whose depth AGREEING other views agree, or which other
 *    pictures match (furniture_sweep.h), must make up HELD_PART of it. Else all of it takes its face.
 * 2. What remains is cut in two by a minimum cut [Boykov 2001]: a strip of ceiling beside a beam has taken the depth of
 *    the beam, and so became a part of it. A segment pays for the side that the evidence speaks against: the log odds
 *      1.5 - 2.5 confidence - 0.5 min(agreeing views, 3) + 8 (cost of its depth to other views - that of its face)
 *          - 4 min(steps off its face, 20) / 20
 *    that it lies on its face, without the last term where a thing is held by pictures and the segment by nothing.
 *    Borders between segments of a similar colour pay if they are cut: within a thing where
 *    its planes meet, and, twice as much, between a thing and what lies on its face beside it.
 * What takes its face has no confidence. decisions/0083 says how the numbers were found. */
#include "stages/segment_depth/before_model.h"

#include <math.h>
#include <stdlib.h>

#include "common/layers/layered_depth.h"
#include "common/math/numbers.h"
#include "stages/segment_depth/max_flow.h"

#define OFF_PART   0.02 /* part of the inverse depth, and ... */
#define OFF_STEPS  1.0  /* ... steps, from which on a segment lies off its face */
#define MEET_STEPS 3.0  /* by which planes of one thing may differ at their border */
#define AGREEING   0.9  /* other views, weighted with their confidence */
#define HELD_PART  0.15 /* of a thing's pixels */
#define SAME_PART  0.06 /* by which a plane may differ from the one that furniture_sweep_find() found */

/* the log odds that a segment lies on its face */
#define ODDS            1.5
#define ODDS_DOUBTFUL   0.7 /* in place of those and the gap's, of what is doubtful */
#define ODDS_CONFIDENCE 2.5
#define ODDS_AGREEING   0.5 /* of each other view, of at most ... */
#define MOST_AGREEING   3.0
#define ODDS_CROSS      8.0
#define ODDS_GAP        4.0 /* of ... */
#define FAR_STEPS       20.0
#define CUT_THING       2.0 /* of a border of the weight 1: within a thing, and ... */
#define CUT_FACE        4.0 /* ... between a thing and the faces beside it */

#define UNITS_PER_ODDS 1e4 /* capacities of the cut are integers */

static bool is_off(const struct plane_problem *p, int segment, struct plane plane)
{
    const struct segment *g = &p->m->segments->segments[segment];
    const struct plane *face = problem_expects(p, segment);
    if (!face) return false;
    const double there = plane_at(*face, g->cx, g->cy);
    return !(fabs(plane_at(plane, g->cx, g->cy) - there) <= fmax(OFF_PART * there, OFF_STEPS * p->step));
}

static int root_of(int *parent, int i)
{
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

/* Whether the planes of two segments meet at the border between them. */
static bool planes_meet(const struct plane *planes, const struct plane_problem *p, int segment, const struct border *b)
{
    const double gap =
        plane_at(planes[segment], (double)b->u, (double)b->v) - plane_at(planes[b->other], (double)b->u, (double)b->v);
    return fabs(gap) <= MEET_STEPS * p->step;
}

/* What stands before the model while it is judged. Arrays: of each segment. */
struct before {
    const struct plane_problem *p;
    struct plane *planes;
    bool *inherited, *off;
    const double *confidence;
    const struct plane *found;
    bool *doubtful; /* part of a thing that is held by what pictures match, and itself held by nothing */
    int *number;    /* of the thing's first segment, then of the node in the cut */
};

static void take_face(struct before *x, int i)
{
    x->planes[i] = *problem_expects(x->p, i);
    x->inherited[i] = true;
    x->off[i] = false;
}

/* Joins adjacent segments off their faces whose planes meet. */
static void join_things(struct before *x)
{
    const struct segmentation *s = x->p->m->segments;
    for (int i = 0; i < s->count; i++)
        for (int t = s->first_border[i]; x->off[i] && t < s->first_border[i + 1]; t++) {
            const struct border *b = &s->borders[t];
            if (b->other > i && x->off[b->other] && planes_meet(x->planes, x->p, i, b))
                x->number[root_of(x->number, i)] = root_of(x->number, b->other);
        }
}

/* Whether a segment still is about where other pictures matched it best. */
static bool still_found(const struct before *x, int i)
{
    const struct segment *g = &x->p->m->segments->segments[i];
    const double found = plane_at(x->found[i], g->cx, g->cy);
    return found > 0 && fabs(plane_at(x->planes[i], g->cx, g->cy) - found) <= fmax(SAME_PART * found, x->p->step);
}

/* Whether other views agree on a segment's depth. */
static bool is_agreed_on(const struct before *x, int i)
{
    const struct plane_problem *p = x->p;
    return p->cross && !x->inherited[i] && x->confidence[i] >= DEPTH_INHERITED &&
           cross_view_support(p->cross, i, x->planes[i]) >= AGREEING;
}

/* Gives things without evidence of two views their faces. */
static enum status drop_things(struct before *x, struct err *err)
{
    const struct segmentation *s = x->p->m->segments;
    const size_t n = (size_t)s->count + 1;
    double *pixels = calloc(n, sizeof *pixels), *held = calloc(n, sizeof *held), *agreed = calloc(n, sizeof *agreed);
    if (!pixels || !held || !agreed) err_nomem(err, "things before the model", n * 24);
    for (int i = 0; !err->status && i < s->count; i++) x->number[i] = i;
    if (!err->status) join_things(x);
    for (int i = 0; !err->status && i < s->count; i++) {
        if (!x->off[i]) continue;
        const int thing = root_of(x->number, i);
        pixels[thing] += s->segments[i].pixels;
        const bool is_agreed = is_agreed_on(x, i);
        if (is_agreed) agreed[thing] += s->segments[i].pixels;
        if (is_agreed || still_found(x, i)) held[thing] += s->segments[i].pixels;
        x->doubtful[i] = !is_agreed && !still_found(x, i);
    }
    for (int i = 0; !err->status && i < s->count; i++) {
        const int thing = root_of(x->number, i);
        if (x->off[i] && !(held[thing] >= HELD_PART * pixels[thing])) take_face(x, i);
        if (agreed[thing] >= HELD_PART * pixels[thing]) x->doubtful[i] = false;
    }
    free(agreed);
    free(pixels);
    free(held);
    return err->status;
}

/* The log odds that the segment lies on its face. */
static double odds_of_face(const struct before *x, int i)
{
    const struct plane_problem *p = x->p;
    const struct segment *g = &p->m->segments->segments[i];
    const struct plane own = x->planes[i], face = *problem_expects(p, i);
    const double gap = fabs(plane_at(own, g->cx, g->cy) - plane_at(face, g->cx, g->cy)) / p->step;
    double odds = x->doubtful[i] ? ODDS_DOUBTFUL : ODDS - ODDS_GAP * fmin(gap / FAR_STEPS, 1);
    unsigned occluded;
    if (!x->inherited[i]) odds -= ODDS_CONFIDENCE * x->confidence[i];
    if (!p->cross) return odds;
    odds -= ODDS_AGREEING * fmin(cross_view_support(p->cross, i, own), MOST_AGREEING);
    return odds + ODDS_CROSS * ((double)cross_view_cost(p->cross, i, own, &occluded) -
                                (double)cross_view_cost(p->cross, i, face, &occluded));
}

static int64_t capacity_of(double odds) { return (int64_t)(odds * UNITS_PER_ODDS); }

/* Adds a segment and its borders to the cut; the sink's side are the faces. */
static void add_segment(struct max_flow *flow, const struct before *x, int i)
{
    const struct plane_problem *p = x->p;
    const struct segmentation *s = p->m->segments;
    double odds = odds_of_face(x, i) * s->segments[i].pixels / p->params->segment_pixels;
    for (int t = s->first_border[i]; t < s->first_border[i + 1]; t++) {
        const struct border *b = &s->borders[t];
        const double weight = (double)p->weights[t];
        if (!x->off[b->other]) {
            if (problem_expects(p, b->other)) odds += CUT_FACE * weight;
        } else if (b->other > i && planes_meet(x->planes, p, i, b)) {
            const int64_t capacity = capacity_of(CUT_THING * weight);
            max_flow_edge(flow, x->number[i], x->number[b->other], capacity, capacity);
        }
    }
    max_flow_terminal(flow, x->number[i], -capacity_of(odds));
}

/* Gives those parts of things their faces that are more likely on them. */
static enum status cut_things(struct before *x, struct err *err)
{
    const struct segmentation *s = x->p->m->segments;
    struct max_flow flow = {0};
    int nodes = 0, edges = 0;
    for (int i = 0; i < s->count; i++) {
        if (!x->off[i]) continue;
        x->number[i] = nodes++;
        edges += s->first_border[i + 1] - s->first_border[i];
    }
    if (!nodes || max_flow_begin(&flow, nodes, edges, err)) return err->status;
    for (int i = 0; i < s->count; i++)
        if (x->off[i]) add_segment(&flow, x, i);
    max_flow_solve(&flow, err);
    for (int i = 0; !err->status && i < s->count; i++)
        if (x->off[i] && max_flow_on_sink_side(&flow, x->number[i])) take_face(x, i);
    max_flow_release(&flow);
    return err->status;
}

enum status before_model_settle(struct plane *planes, bool *inherited, const double *confidence,
                                const struct plane *found, const struct plane_problem *p, struct err *err)
{
    const int count = p->m->segments->count;
    struct before x = {p,
                       planes,
                       inherited,
                       calloc((size_t)count + 1, sizeof *x.off),
                       confidence,
                       found,
                       calloc((size_t)count + 1, sizeof *x.doubtful),
                       malloc(((size_t)count + 1) * sizeof *x.number)};
    if (!x.off || !x.number || !x.doubtful) err_nomem(err, "things before the model", (size_t)count * 5);
    for (int i = 0; !err->status && i < count; i++) x.off[i] = !given_depth_has(p->given, i) && is_off(p, i, planes[i]);
    if (!err->status && !drop_things(&x, err)) cut_things(&x, err);
    free(x.off);
    free(x.number);
    free(x.doubtful);
    return err->status;
}
