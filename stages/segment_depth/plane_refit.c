/* plane_refit.c - the parameters of a plane from all segments that lie on it, as PEARL estimates its models again
 * between two labellings [Isack 2012].
 *
 * The planes of one kind are a linear space of (a, b, c): of all planes it has three dimensions, of vertical ones two,
 * of horizontal ones one. Its basis is orthonormal over the members' centroids, so that a step along it moves their
 * inverse depths by one step on average. Each coordinate in turn moves up and down by a distance that halves from pass
 * to pass, as long as the sum of the members' unary terms falls.
 *
 * Most of a blank ceiling matches at any depth, so that few votes decide its slant. A horizontal plane has only its
 * height unknown, and the few parts that can be matched decide that. The plane of lowest cost is taken; a horizontal or
 * vertical one counts as SNAP_GAIN cheaper per member. */
#include "stages/segment_depth/plane_refit.h"

#include <math.h>

#include "common/base/parallel.h"

#define MAX_MEMBERS 1500  /* of more members, one in two, three ... is used, so that at most these remain */
#define FIRST_STEPS 2.0   /* how far a coordinate moves in the first pass, in steps */
#define PASSES      5     /* the last moves by an eighth of a step */
#define MOVES       3     /* maximum number of moves of a coordinate in one direction, in a pass */
#define SCAN_STEPS  16    /* how far up and down the height of a horizontal plane is looked for first */
#define SNAP        0.3   /* radians: how far a plane may be from horizontal or vertical to be made so */
#define SNAP_GAIN   0.005 /* how much less a horizontal or vertical plane costs, per member */
#define BLOCKS      32    /* partial sums of costs: the same for any number of threads */

struct refit {
    const struct plane_problem *p;
    struct scene_planes *scene; /* plane k is the one that is tried: planes of the scene cost less than others */
    int k;
    const int *members;
    int count, stride; /* every stride-th member */
    double sums[BLOCKS];
};

static int member(const struct refit *r, int n) { return r->members[(size_t)n * (size_t)r->stride]; }

static void sum_block(void *ctx, size_t begin, size_t end, int thread)
{
    struct refit *r = ctx;
    (void)thread;
    for (size_t b = begin; b < end; b++) {
        const int64_t from = (int64_t)r->count * (int64_t)b / BLOCKS,
                      to = (int64_t)r->count * (int64_t)(b + 1) / BLOCKS;
        r->sums[b] = 0;
        for (int n = (int)from; n < (int)to; n++)
            r->sums[b] += (double)problem_unary_cost(r->p, member(r, n), r->scene->planes[r->k], INFINITY);
    }
}

static double cost_of(struct refit *r, struct plane plane)
{
    double sum = 0;
    scene_planes_set(r->scene, r->k, plane);
    parallel_for(BLOCKS, 1, sum_block, r);
    for (int b = 0; b < BLOCKS; b++) sum += r->sums[b];
    return sum;
}

/* The mean over the members' pixels of the product of two planes' inverse depths. */
static double product(const struct refit *r, struct plane p, struct plane q)
{
    double sum = 0, pixels = 0;
    for (int n = 0; n < r->count; n++) {
        const struct segment *g = &r->p->m->segments->segments[member(r, n)];
        sum += g->pixels * plane_at(p, g->cx, g->cy) * plane_at(q, g->cx, g->cy);
        pixels += g->pixels;
    }
    return sum / pixels;
}

static struct plane moved(struct plane p, double d, struct plane by)
{
    return (struct plane){p.a + d * by.a, p.b + d * by.b, p.c + d * by.c};
}

/* A linear space of planes. */
struct space {
    struct plane basis[3];
    int dimensions;
};

/* Makes the basis orthonormal over the members, by Gram and Schmidt, twice for accuracy. Drops what they do not span.
 */
static void orthonormalize(struct space *s, const struct refit *r)
{
    int n = 0;
    for (int k = 0; k < s->dimensions; k++) {
        const double whole = product(r, s->basis[k], s->basis[k]);
        struct plane rest = s->basis[k];
        for (int round = 0; round < 2; round++)
            for (int j = 0; j < n; j++) rest = moved(rest, -product(r, rest, s->basis[j]), s->basis[j]);
        const double left = product(r, rest, rest);
        if (left > 1e-8 * whole) s->basis[n++] = moved((struct plane){0, 0, 0}, 1 / sqrt(left), rest);
    }
    s->dimensions = n;
}

static struct plane projected(struct plane plane, const struct space *s, const struct refit *r)
{
    struct plane sum = {0, 0, 0};
    for (int k = 0; k < s->dimensions; k++) sum = moved(sum, product(r, plane, s->basis[k]), s->basis[k]);
    return sum;
}

/* Moves *plane by `d` along `by`, up to MOVES times, as long as *cost falls. */
static void descend(struct refit *r, struct plane *plane, double *cost, double d, struct plane by)
{
    for (int move = 0; move < MOVES; move++) {
        const struct plane next = moved(*plane, d, by);
        const double c = cost_of(r, next);
        if (!(c < *cost)) return;
        *cost = c;
        *plane = next;
    }
}

/* Moves *plane within the space to where it costs least; returns the cost. */
static double search(struct refit *r, struct plane *plane, const struct space *s)
{
    const double step = r->p->step;
    const struct plane start = *plane;
    double cost = cost_of(r, start);
    for (int k = -SCAN_STEPS; s->dimensions == 1 && k <= SCAN_STEPS; k++) {
        const struct plane next = moved(start, k * step, s->basis[0]);
        const double c = cost_of(r, next);
        if (!(c < cost)) continue;
        cost = c;
        *plane = next;
    }
    for (int pass = s->dimensions == 1; pass < PASSES; pass++)
        for (int k = 0; k < s->dimensions; k++)
            for (int sign = -1; sign <= 1; sign += 2)
                descend(r, plane, &cost, sign * FIRST_STEPS * pow(0.5, pass) * step, s->basis[k]);
    return cost;
}

/* The spaces of planes of the kinds that `plane` nearly is; all planes first. Returns how many. */
static int list_spaces(struct space spaces[2], struct plane plane, const struct plane_problem *p)
{
    const struct view *v = p->view;
    const struct vec3 n = plane_normal(v, plane);
    const double upright = fabs(vec3_dot(n, p->down)) / vec3_length(n);
    spaces[0] = (struct space){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 3};
    if (upright > cos(SNAP)) {
        spaces[1] = (struct space){{plane_of_normal(v, p->down)}, 1};
        return 2;
    }
    if (upright < sin(SNAP)) {
        const struct vec3 axis = fabs(p->down.x) < 0.7 ? vec3_make(1, 0, 0) : vec3_make(0, 1, 0),
                          across = vec3_normalize(vec3_cross(p->down, axis));
        spaces[1] = (struct space){{plane_of_normal(v, across), plane_of_normal(v, vec3_cross(p->down, across))}, 2};
        return 2;
    }
    return 1;
}

void plane_refit(struct scene_planes *scene, int k, const int *members, int count, const struct plane_problem *p)
{
    const int stride = count / MAX_MEMBERS + 1;
    struct refit r = {
        .p = p, .scene = scene, .k = k, .members = members, .count = (count + stride - 1) / stride, .stride = stride};
    const struct plane plane = scene->planes[k];
    struct plane best = plane;
    struct space spaces[2];
    if (count < 3) return;
    const int kinds = list_spaces(spaces, plane, p);
    double lowest = cost_of(&r, plane); /* kept to the last bit unless another costs less */
    for (int kind = 0; kind < kinds; kind++) {
        orthonormalize(&spaces[kind], &r);
        struct plane found = projected(plane, &spaces[kind], &r);
        const double cost = search(&r, &found, &spaces[kind]) - (kind ? SNAP_GAIN * r.count : 0);
        if (!(cost < lowest)) continue;
        lowest = cost;
        best = found;
    }
    scene_planes_set(scene, k, best);
}
