/* inherit.c - depth of border areas that no evidence holds in front of their surroundings.
 *
 * At the picture's border a near depth is out of view of most neighbours, which costs less than a bad match. A dark or
 * changed area there matches badly at every depth that can be seen; so it moves to the front, as a block. Raising the
 * cost of being out of view would cure it, but pushes true foreground away. So blocks are found by what surrounds them.
 *
 * Two adjacent segments are connected if their planes lie within `jump` steps at their border. A segment is held if half
 * of the area of it and of those connected to it has confidence. Connected segments that are not held form a block. A
 * block floats if it touches the picture's border, and more than FLOATING of its outline (without that border) lies more
 * than `jump` steps in front of what adjoins. The outline is weighted as the smoothness cost is: contact with an object
 * of another colour hardly counts. A surface that continues one that was matched does not float, nor does a blank one
 * with a matched rim.
 *
 * A floating block takes over what lies behind: planes P that are harmonic on the segment graph,
 *   P_i = sum_j w_ij P_j / sum_j w_ij   over the adjacent segments, with the weights of the smoothness cost,
 * with those of the adjoining segments given; only of the farther ones, if they differ by more than `jump`. So it
 * continues a slanted surface, and blends different ones. Blocks may float on blocks, so this is repeated ROUNDS
 * times. */
#include "stages/segment_depth/inherit.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/sort.h"
#include "common/layers/layered_depth.h"
#include "common/math/numbers.h"

#define FLOATING   0.75
#define ROUNDS     3
#define ITERATIONS 200

struct inherit {
    const struct plane_problem *p;
    const struct segmentation *s;
    struct plane *planes;
    bool *held;
    int *block;           /* of each segment: its first segment + 1; 0: none yet, or held */
    int *members;         /* of the block */
    struct plane *behind; /* of each segment of the block: what it takes over */
    double *rim;          /* inverse depths of the adjoining segments */
};

/* Steps by which segment i lies in front of the other side of its border t. */
static double steps_in_front(const struct inherit *x, int i, int t)
{
    const struct border *b = &x->s->borders[t];
    const double u = (double)b->u, v = (double)b->v;
    return (plane_at(x->planes[i], u, v) - plane_at(x->planes[b->other], u, v)) / x->p->step;
}

static bool connected(const struct inherit *x, int i, int t)
{
    return fabs(steps_in_front(x, i, t)) <= x->p->params->jump;
}

static void find_held(struct inherit *x, const double *confidence)
{
    const struct segmentation *s = x->s;
    for (int i = 0; i < s->count; i++) {
        int area = s->segments[i].pixels, sure = confidence[i] >= DEPTH_INHERITED ? area : 0;
        for (int t = s->first_border[i]; t < s->first_border[i + 1]; t++) {
            const int j = s->borders[t].other;
            if (!connected(x, i, t)) continue;
            area += s->segments[j].pixels;
            if (confidence[j] >= DEPTH_INHERITED) sure += s->segments[j].pixels;
        }
        x->held[i] = given_depth_has(x->p->given, i) || 2 * sure >= area;
    }
}

/* Lists the block of segment `from` in members; returns how many. */
static int gather_block(struct inherit *x, int from)
{
    int count = 0;
    x->block[from] = from + 1;
    x->members[count++] = from;
    for (int k = 0; k < count; k++)
        for (int i = x->members[k], t = x->s->first_border[i]; t < x->s->first_border[i + 1]; t++) {
            const int j = x->s->borders[t].other;
            if (x->block[j] || x->held[j] || !connected(x, i, t)) continue;
            x->block[j] = from + 1;
            x->members[count++] = j;
        }
    return count;
}

static bool floats(const struct inherit *x, int count)
{
    const int own = x->block[x->members[0]];
    double outline = 0, front = 0;
    bool at_border = false;
    for (int k = 0; k < count; k++) {
        const int i = x->members[k];
        const struct segment *g = &x->s->segments[i];
        at_border = at_border || !g->x0 || !g->y0 || g->x1 == x->s->width - 1 || g->y1 == x->s->height - 1;
        for (int t = x->s->first_border[i]; t < x->s->first_border[i + 1]; t++) {
            if (x->block[x->s->borders[t].other] == own) continue;
            outline += (double)x->p->weights[t];
            if (steps_in_front(x, i, t) > x->p->params->jump) front += (double)x->p->weights[t];
        }
    }
    return at_border && outline > 0 && front > FLOATING * outline;
}

/* The greatest inverse depth of an adjoining segment that the block takes over; 0 if none adjoins. */
static double farther_side(struct inherit *x, int count)
{
    const int own = x->block[x->members[0]];
    size_t rim = 0;
    for (int k = 0; k < count; k++)
        for (int i = x->members[k], t = x->s->first_border[i]; t < x->s->first_border[i + 1]; t++) {
            const struct border *b = &x->s->borders[t];
            if (x->block[b->other] == own) continue;
            x->rim[rim++] = plane_at(x->planes[b->other], (double)b->u, (double)b->v);
        }
    if (!rim) return 0;
    sort_doubles(x->rim, rim);
    const double low = x->rim[rim / 10], high = x->rim[rim - 1 - rim / 10];
    return fmax(0.5 * (low + high), low + x->p->params->jump * x->p->step);
}

static void take_over(struct inherit *x, int count, bool *inherited)
{
    const struct segmentation *s = x->s;
    const int own = x->block[x->members[0]];
    const double limit = farther_side(x, count);
    for (int k = 0; k < count; k++) x->behind[x->members[k]] = (struct plane){0, 0, 0}; /* unknown yet */
    for (int round = 0; round < ITERATIONS; round++)
        for (int n = 0; n < count; n++) {
            const int i = x->members[round & 1 ? count - 1 - n : n];
            struct plane sum = {0, 0, 0};
            double total = 0;
            for (int t = s->first_border[i]; t < s->first_border[i + 1]; t++) {
                const struct border *b = &s->borders[t];
                const bool inside = x->block[b->other] == own;
                const struct plane other = (inside ? x->behind : x->planes)[b->other];
                const double d = plane_at(other, (double)b->u, (double)b->v), w = (double)x->p->weights[t];
                if (inside ? !(other.c != 0) : !(d > 0) || d > limit) continue;
                sum = (struct plane){sum.a + w * other.a, sum.b + w * other.b, sum.c + w * other.c};
                total += w;
            }
            if (total > 0) x->behind[i] = (struct plane){sum.a / total, sum.b / total, sum.c / total};
        }
    for (int k = 0; k < count; k++) {
        const int i = x->members[k];
        const struct segment *g = &s->segments[i];
        struct plane plane = x->behind[i];
        if (!(plane.c != 0)) continue;
        if (!plane_within(plane, g, x->p->min_inverse_z, x->p->max_inverse_z))
            plane =
                (struct plane){0, 0, clamp(plane_at(plane, g->cx, g->cy), x->p->min_inverse_z, x->p->max_inverse_z)};
        x->planes[i] = plane;
        inherited[i] = true;
    }
}

enum status inherit_planes(struct plane *planes, bool *inherited, const double *confidence,
                           const struct plane_problem *p, struct err *err)
{
    const struct segmentation *s = p->m->segments;
    const size_t count = (size_t)s->count + 1, borders = (size_t)s->first_border[s->count] + 1;
    struct inherit x = {.p = p, .s = s, .planes = planes};
    x.held = malloc(count * sizeof *x.held);
    x.block = malloc(count * sizeof *x.block);
    x.members = malloc(count * sizeof *x.members);
    x.behind = malloc(count * sizeof *x.behind);
    x.rim = malloc(borders * sizeof *x.rim);
    const enum status st = x.held && x.block && x.members && x.behind && x.rim
                               ? ST_OK
                               : err_nomem(err, "blocks of segments", count * 33 + borders * sizeof *x.rim);
    for (int round = 0; !st && round < ROUNDS; round++) {
        bool changed = false;
        find_held(&x, confidence);
        for (int i = 0; i < s->count; i++) x.block[i] = 0;
        for (int i = 0; i < s->count; i++) {
            if (x.block[i] || x.held[i]) continue;
            const int members = gather_block(&x, i);
            if (!floats(&x, members)) continue;
            take_over(&x, members, inherited);
            changed = true;
        }
        if (!changed) break;
    }
    free(x.held);
    free(x.block);
    free(x.members);
    free(x.behind);
    free(x.rim);
    return st;
}
