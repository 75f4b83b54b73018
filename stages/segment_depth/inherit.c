/* inherit.c - depth of border areas that no evidence holds in front of their surroundings.
 *
 * At the picture's border a near depth is out of view of most neighbours, which costs less than a bad match. A dark or
 * changed area there matches badly at every depth that can be seen; so it moves to the front, as a block. Raising the
 * cost of being out of view would cure it, but pushes true foreground away. So blocks are found by what surrounds them.
 *
 * Two adjacent segments are connected if their planes lie within `jump` steps at their border. A segment is held if it
 * and those connected to it have a mean confidence of at least `held`, and if its surface, of connected segments with
 * that mean, is large enough: confidence times size, in mean segments, sums to MIN_HELD. So are segments on a dominant
 * plane of the scene (scene_planes.h), and slanted planes that continue a held one: at both centres they agree within
 * COPLANAR steps. So a blank ceiling or floor, which comes near towards the border, stays on its plane. The others take
 * the inverse depths d that minimize
 *   sum over adjacent i, j  w_ij |d_i - d_j|  +  far_bias sum_i size_i d_i,    d_i at most what it was,
 * given those of held segments. w_ij is the weight of the smoothness cost, so that contact with an object of another
 * colour hardly counts; contact with held foreground counts `keep` times that. Nothing is moved forwards. An area stays
 * in front as long as its contact with held foreground outweighs its contact with what lies behind, and the bias. A
 * ramp costs as much as a jump, so that it does not hold a block.
 *
 * The minimum is found level by level [Hochbaum 2001]: the segments above a level and those below it are separated by a
 * minimum cut, independently of other levels. Levels are `jump` steps apart. Only areas that touch the picture's border
 * above the level are cut: inside the picture thin objects are often unsure, and neighbours see them.
 *
 * What differs from the source: d only says which surface an area continues: one between the lowest level that cuts the
 * area off and the level below. The area takes over planes P that are harmonic on the segment graph,
 *   P_i = sum_j w_ij P_j / sum_j w_ij,
 * given the planes of the adjoining segments between these levels. So it continues a slanted surface, and blends
 * different ones. A segment that this moves by at most `jump` steps keeps its plane. All this is repeated, up to ROUNDS
 * times, since a segment that was held by chance may now be alone. */
#include "stages/segment_depth/inherit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/numbers.h"
#include "stages/segment_depth/max_flow.h"

#define MIN_HELD   8 /* mean segments of confidence 1 */
#define MAX_LEVELS 64
#define ROUNDS     3
#define ITERATIONS 200
#define COPLANAR   2   /* steps by which planes of one surface may differ */
#define CAPACITY   1e6 /* of weight 1 */

struct caution {
    double held;           /* mean confidence */
    double keep, far_bias; /* as above */
};
/* If another round follows: few depths are confirmed yet. In the last one, a bias of 0.02 sends unsure foreground
 * behind its surroundings. */
static const struct caution early = {0.1, 3, 0}, last = {0.3, 1.0, 0.005};

struct inherit {
    const struct plane_problem *p;
    const struct segmentation *s;
    struct plane *planes;
    const double *confidence;
    struct caution caution;
    double spacing, level; /* of levels, and the one that is cut; inverse depths */
    bool *held, *listed;
    int *members;         /* segments of an area */
    int *node;            /* of each member: its place among the members */
    int *cut_at;          /* of each segment: number of the lowest level that it is cut off at; 0: none */
    struct plane *behind; /* of each segment that is cut off: what it takes over */
    struct max_flow flow;
};

/* Inverse depth of segment i at border t. */
static double at_border(const struct inherit *x, int i, int t)
{
    const struct border *b = &x->s->borders[t];
    return plane_at(x->planes[i], (double)b->u, (double)b->v);
}

static double at_centre(const struct inherit *x, int i)
{
    return plane_at(x->planes[i], x->s->segments[i].cx, x->s->segments[i].cy);
}

/* Whether segment i is connected to the other side of its border t. */
static bool connected(const struct inherit *x, int i, int t)
{
    return fabs(at_border(x, i, t) - at_border(x, x->s->borders[t].other, t)) <= x->p->params->jump * x->p->step;
}

/* Lists the area of segment `from` in members: the segments that `joins` adds across their borders. Returns how many.
 */
static int gather(struct inherit *x, int from, bool (*joins)(const struct inherit *x, int i, int t))
{
    int count = 0;
    x->listed[from] = true;
    x->members[count++] = from;
    for (int k = 0; k < count; k++)
        for (int i = x->members[k], t = x->s->first_border[i]; t < x->s->first_border[i + 1]; t++) {
            const int j = x->s->borders[t].other;
            if (x->listed[j] || !joins(x, i, t)) continue;
            x->listed[j] = true;
            x->members[count++] = j;
        }
    return count;
}

static bool joins_surface(const struct inherit *x, int i, int t)
{
    return x->held[x->s->borders[t].other] && connected(x, i, t);
}

/* Whether both sides of border t are slanted, and continue each other: at both centres their planes agree. */
static bool joins_plane(const struct inherit *x, int i, int t)
{
    const int j = x->s->borders[t].other;
    const struct segment *g = &x->s->segments[i], *h = &x->s->segments[j];
    const struct plane a = x->planes[i], b = x->planes[j];
    const double step = COPLANAR * x->p->step;
    return (a.a != 0 || a.b != 0) && (b.a != 0 || b.b != 0) &&
           fabs(plane_at(a, g->cx, g->cy) - plane_at(b, g->cx, g->cy)) <= step &&
           fabs(plane_at(a, h->cx, h->cy) - plane_at(b, h->cx, h->cy)) <= step;
}

static bool is_unsure_above(const struct inherit *x, int i) { return !x->held[i] && at_centre(x, i) >= x->level; }

static bool joins_unsure(const struct inherit *x, int i, int t)
{
    (void)i;
    return is_unsure_above(x, x->s->borders[t].other);
}

static double confidence_around(const struct inherit *x, int i)
{
    const struct segmentation *s = x->s;
    double area = s->segments[i].pixels, sum = area * x->confidence[i];
    for (int t = s->first_border[i]; t < s->first_border[i + 1]; t++) {
        const int j = s->borders[t].other;
        if (!connected(x, i, t)) continue;
        area += s->segments[j].pixels;
        sum += s->segments[j].pixels * x->confidence[j];
    }
    return sum / area;
}

static bool always_held(const struct inherit *x, int i)
{
    return given_depth_has(x->p->given, i) || scene_planes_have(x->p->scene, x->planes[i]);
}

static void find_held(struct inherit *x)
{
    const struct segmentation *s = x->s;
    for (int i = 0; i < s->count; i++) {
        x->held[i] = always_held(x, i) || confidence_around(x, i) >= x->caution.held;
        x->listed[i] = false;
    }
    for (int i = 0; i < s->count; i++) {
        double sure = 0;
        if (x->listed[i] || !x->held[i]) continue;
        const int count = gather(x, i, joins_surface);
        for (int k = 0; k < count; k++) sure += x->confidence[x->members[k]] * s->segments[x->members[k]].pixels;
        if (sure >= MIN_HELD * x->p->params->segment_pixels) continue;
        for (int k = 0; k < count; k++) x->held[x->members[k]] = always_held(x, x->members[k]);
    }
    memset(x->listed, 0, (size_t)s->count * sizeof *x->listed);
    for (int i = 0; i < s->count; i++) {
        if (x->listed[i] || !x->held[i]) continue;
        const int count = gather(x, i, joins_plane);
        for (int k = 0; k < count; k++) x->held[x->members[k]] = true;
    }
}

static bool touches_picture_border(const struct inherit *x, int count)
{
    for (int k = 0; k < count; k++) {
        const struct segment *g = &x->s->segments[x->members[k]];
        if (!g->x0 || !g->y0 || g->x1 == x->s->width - 1 || g->y1 == x->s->height - 1) return true;
    }
    return false;
}

/* Adds the terms of member k: on the sink's side it goes behind. */
static void add_terms(struct inherit *x, int k)
{
    const struct segmentation *s = x->s;
    const int i = x->members[k];
    double behind = -x->caution.far_bias * s->segments[i].pixels / x->p->params->segment_pixels;
    for (int t = s->first_border[i]; t < s->first_border[i + 1]; t++) {
        const int j = s->borders[t].other;
        const double w = (double)x->p->weights[t];
        const int64_t capacity = (int64_t)(w * CAPACITY);
        if (x->held[j])
            behind += at_border(x, j, t) >= x->level ? x->caution.keep * w : -w;
        else if (!is_unsure_above(x, j))
            behind -= w;
        else if (j > i)
            max_flow_edge(&x->flow, k, x->node[j], capacity, capacity);
    }
    max_flow_terminal(&x->flow, k, (int64_t)(behind * CAPACITY));
}

/* Cuts the area of the members at a level. */
static enum status cut_area(struct inherit *x, int count, int number, struct err *err)
{
    const struct segmentation *s = x->s;
    int edges = 0;
    for (int k = 0; k < count; k++) {
        const int i = x->members[k];
        x->node[i] = k;
        edges += s->first_border[i + 1] - s->first_border[i];
    }
    if (max_flow_begin(&x->flow, count, edges, err)) return err->status;
    for (int k = 0; k < count; k++) add_terms(x, k);
    if (max_flow_solve(&x->flow, err)) return err->status;
    for (int k = 0; k < count; k++) {
        int *cut_at = &x->cut_at[x->members[k]];
        if (!*cut_at && max_flow_on_sink_side(&x->flow, k)) *cut_at = number;
    }
    return ST_OK;
}

static enum status cut_level(struct inherit *x, int number, struct err *err)
{
    x->level = x->p->min_inverse_z + number * x->spacing;
    memset(x->listed, 0, (size_t)x->s->count * sizeof *x->listed);
    for (int i = 0; !err->status && i < x->s->count; i++) {
        if (x->listed[i] || !is_unsure_above(x, i)) continue;
        const int count = gather(x, i, joins_unsure);
        if (touches_picture_border(x, count)) cut_area(x, count, number, err);
    }
    return err->status;
}

/* Whether segment i, which is cut off, continues the plane of the other side of its border t. */
static bool continues(const struct inherit *x, int i, int t)
{
    const int j = x->s->borders[t].other, number = x->cut_at[i];
    if (x->cut_at[j]) return x->behind[j].c != 0 && abs(number - x->cut_at[j]) <= 1;
    const double d = at_border(x, j, t) - x->p->min_inverse_z;
    return d < number * x->spacing && (number == 1 || d >= (number - 1) * x->spacing);
}

static struct plane mean_plane(const struct inherit *x, int i)
{
    struct plane sum = {0, 0, 0};
    double total = 0;
    for (int t = x->s->first_border[i]; t < x->s->first_border[i + 1]; t++) {
        const int j = x->s->borders[t].other;
        if (!continues(x, i, t)) continue;
        const struct plane other = (x->cut_at[j] ? x->behind : x->planes)[j];
        const double w = (double)x->p->weights[t];
        sum = (struct plane){sum.a + w * other.a, sum.b + w * other.b, sum.c + w * other.c};
        total += w;
    }
    return total > 0 ? (struct plane){sum.a / total, sum.b / total, sum.c / total} : x->behind[i];
}

/* Replaces the planes of what is cut off. Returns whether any changed. */
static bool take_over(struct inherit *x, bool *inherited)
{
    const double min = x->p->min_inverse_z, max = x->p->max_inverse_z;
    bool changed = false;
    int count = 0;
    for (int i = 0; i < x->s->count; i++) {
        if (!x->cut_at[i]) continue;
        x->members[count++] = i;
        x->behind[i] = (struct plane){0, 0, 0}; /* unknown yet */
    }
    for (int round = 0; round < ITERATIONS; round++)
        for (int n = 0; n < count; n++) {
            const int i = x->members[round & 1 ? count - 1 - n : n];
            x->behind[i] = mean_plane(x, i);
        }
    for (int k = 0; k < count; k++) {
        const int i = x->members[k];
        const struct segment *g = &x->s->segments[i];
        struct plane plane = x->behind[i];
        if (!(plane.c != 0)) continue;
        if (!plane_within(plane, g, min, max))
            plane = (struct plane){0, 0, clamp(plane_at(plane, g->cx, g->cy), min, max)};
        if (!(at_centre(x, i) - plane_at(plane, g->cx, g->cy) > x->p->params->jump * x->p->step)) continue;
        x->planes[i] = plane;
        inherited[i] = changed = true;
    }
    return changed;
}

enum status inherit_planes(struct plane *planes, bool *inherited, const double *confidence,
                           const struct plane_problem *p, bool cautious, struct err *err)
{
    const struct segmentation *s = p->m->segments;
    const size_t count = (size_t)s->count + 1;
    const double range = PLANE_MAX_FACTOR * p->max_inverse_z - p->min_inverse_z;
    struct inherit x = {.p = p, .s = s, .planes = planes, .confidence = confidence};
    x.caution = cautious ? early : last;
    x.spacing = fmax(p->params->jump * p->step, range / MAX_LEVELS);
    x.held = malloc(count * sizeof *x.held);
    x.listed = malloc(count * sizeof *x.listed);
    x.members = malloc(count * sizeof *x.members);
    x.node = malloc(count * sizeof *x.node);
    x.cut_at = malloc(count * sizeof *x.cut_at);
    x.behind = malloc(count * sizeof *x.behind);
    if (!x.held || !x.listed || !x.members || !x.node || !x.cut_at || !x.behind)
        err_nomem(err, "border areas", count * 38);
    for (int round = 0; !err->status && round < ROUNDS; round++) {
        find_held(&x);
        memset(x.cut_at, 0, count * sizeof *x.cut_at);
        for (int n = 1; !err->status && n * x.spacing < range; n++) cut_level(&x, n, err);
        if (err->status || !take_over(&x, inherited)) break;
    }
    max_flow_release(&x.flow);
    free(x.held);
    free(x.listed);
    free(x.members);
    free(x.node);
    free(x.cut_at);
    free(x.behind);
    return err->status;
}
