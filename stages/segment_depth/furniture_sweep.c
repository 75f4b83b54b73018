/* furniture_sweep.c - tables, seats and fronts of furniture, by planes before the faces of the model.
 *
 * Overview. Sparse points are rare on furniture, so that the range of depths that they give may end behind a table; and
 * where it does not, planes of constant depth match no table top that is seen at a grazing angle. But furniture is
 * level, or parallel to walls. So planes parallel to the floor, and to the walls that the view sees, are swept towards
 * the camera, their distances in a fixed ratio. A segment gains what it matches better there than on its own plane and
 * on its face. Single segments of a few pixels match by chance somewhere, so gains are averaged with those of adjacent
 * segments of similar colour. Connected segments that gain most on about the same plane are a surface if they are large
 * enough and match well; its distance is then refined. Surfaces that depth had found by itself count alike, on the
 * planes that they have: other views may have missed them.
 *
 * Source: sweeps along the directions of a scene [Gallup 2007]; the rest is new. */
#include "stages/segment_depth/furniture_sweep.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/math/numbers.h"

#define FIRST      0.94  /* distance of the farthest plane, relative to that of the face */
#define STEP       5.0   /* of the distances, as part of them, in pixels of the focal length */
#define NEAREST    0.15  /* of the camera's height above the floor: distance of the nearest plane, and ... */
#define SEEN_FROM  0.25  /* ... of the nearest point of it */
#define BLANK      0.35f /* a segment that matches that well has no need of another plane */
#define LEAST_GAIN 0.3f  /* of a segment on a surface, averaged */
#define GOOD       0.55  /* largest matching cost of a surface */
#define TEXTURE    14.0  /* match_texture() of a surface, at least: a blank wall in different light matches anywhere */
#define BEFORE     1.03  /* factor by which it must be nearer than its face */
#define SMALLEST   0.001 /* part of the view that a surface fills at least */
#define DISTINCT   0.4   /* gain of a segment that matches distinctly */
#define SAME       0.01  /* part of the inverse depth by which a segment may be off a plane and lie on it */
#define ALIKE      2     /* planes by which adjacent segments of a surface may differ */
#define UPRIGHT    0.95  /* cosine between the normals of level planes and the vertical, at least, and ... */
#define LEVEL      0.2   /* ... those of upright planes, at most */
#define PARALLEL   0.999 /* cosine between normals that count as one */
#define NEAR_VIEWS 0xfu  /* other views with which planes are matched: the four that suit best, which come first */

enum { SEEN_BY = 2 };   /* other views, at least, see a segment where it is found */
enum { OWN = 1 << 20 }; /* number of a segment's own plane, as depth found it before */
enum { AVERAGES = 3, MOST_PLANES = 128, REFINE = 8, MOST_DIRECTIONS = 8 };

/* Planes with one normal: n . X = distance, X in the axes of the view. */
struct direction {
    struct vec3 normal; /* a unit vector */
    double farthest;    /* distance */
    double ratio;       /* of the distances of successive planes */
    int planes;
};

struct sweep {
    const struct plane_problem *p;
    const struct plane *start; /* of each segment */
    struct direction directions[MOST_DIRECTIONS];
    int count;
    double height;    /* of the camera above the floor */
    struct plane now; /* the plane that is tried */
    float *own;       /* matching cost on the segment's own plane or on its face, whichever is less */
    float *cost, *gain, *next, *best;
    float *own_gain; /* of the own plane over the face, averaged */
    int *number;     /* of the plane with each segment's best gain, in all directions; OWN; -1: none */
};

static const struct plane *face_of(const struct plane_problem *p, int i)
{
    return p->prior && p->prior->expected[i] >= 0 ? &p->prior->planes[p->prior->expected[i]] : NULL;
}

/* The height of the camera above the floor that the view is expected to see; 0: none. */
static double height_above_floor(const struct plane_problem *p)
{
    for (int k = 0; p->prior && k < p->prior->count; k++) {
        const struct vec3 n = plane_normal(p->view, p->prior->planes[k]);
        if (vec3_dot(n, p->down) > UPRIGHT * vec3_length(n)) return 1 / vec3_length(n);
    }
    return 0;
}

double furniture_sweep_nearest(const struct plane_problem *p)
{
    const double height = height_above_floor(p);
    return height > 0 ? 1 / (SEEN_FROM * height) : 0;
}

static void add_direction(struct sweep *s, struct vec3 normal, double farthest)
{
    for (int k = 0; k < s->count; k++)
        if (vec3_dot(s->directions[k].normal, normal) > PARALLEL) {
            s->directions[k].farthest = fmax(s->directions[k].farthest, farthest);
            return;
        }
    if (s->count < MOST_DIRECTIONS)
        s->directions[s->count++] = (struct direction){.normal = normal, .farthest = farthest};
}

/* Level planes below the camera, and upright ones parallel to the walls. */
static void list_directions(struct sweep *s)
{
    const struct plane_prior *prior = s->p->prior;
    for (int k = 0; k < prior->count; k++) {
        const struct vec3 n = plane_normal(s->p->view, prior->planes[k]), unit = vec3_normalize(n);
        const double down = vec3_dot(unit, s->p->down);
        if (down > UPRIGHT || fabs(down) < LEVEL) add_direction(s, unit, FIRST / vec3_length(n));
    }
}

static void set_steps(struct direction *d, double nearest, double focal)
{
    const double range = fmax(1, d->farthest / nearest);
    d->ratio = fmax(1 + STEP / focal, pow(range, 1.0 / MOST_PLANES));
    d->planes = (int)fmin(MOST_PLANES, ceil(log(range) / log(d->ratio)));
}

/* A direction's plane k. */
static struct plane plane_of(const struct sweep *s, int direction, double k)
{
    const struct direction *d = &s->directions[direction];
    return plane_of_normal(s->p->view, vec3_scale(d->normal, pow(d->ratio, k) / d->farthest));
}

static bool is_before(const struct sweep *s, int i, struct plane plane)
{
    const struct segment *g = &s->p->m->segments->segments[i];
    const struct plane *face = face_of(s->p, i);
    return face && plane_at(plane, g->cx, g->cy) > BEFORE * plane_at(*face, g->cx, g->cy);
}

static bool may_lie(const struct sweep *s, int i, struct plane plane)
{
    return s->own[i] > BLANK && is_before(s, i, plane) &&
           plane_within(plane, &s->p->m->segments->segments[i], s->p->min_inverse_z, s->p->max_inverse_z);
}

static void match_own(void *ctx, size_t begin, size_t end, int thread)
{
    struct sweep *s = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        const struct plane *face = face_of(s->p, (int)i);
        unsigned seen = 0;
        s->own[i] = match_cost_sweep(s->p->m, (int)i, s->start[i], ~0u, &seen);
        if (!face) continue;
        const float there = match_cost_sweep(s->p->m, (int)i, *face, ~0u, NULL);
        if (is_before(s, (int)i, s->start[i]) && __builtin_popcount(seen) >= SEEN_BY)
            s->own_gain[i] = there - s->own[i];
        s->own[i] = fminf(s->own[i], there);
    }
}

static void match_now(void *ctx, size_t begin, size_t end, int thread)
{
    struct sweep *s = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        unsigned seen = 0;
        s->cost[i] = may_lie(s, (int)i, s->now) ? match_cost_sweep(s->p->m, (int)i, s->now, NEAR_VIEWS, &seen) : NAN;
        if (__builtin_popcount(seen) < SEEN_BY) s->cost[i] = NAN; /* what leaves the other pictures costs little */
        s->gain[i] = isnan(s->cost[i]) ? 0 : s->own[i] - s->cost[i];
    }
}

/* Averages values with those of adjacent segments, as far as these are similar. */
static void average(struct sweep *s, float **values, float **next)
{
    const struct segmentation *g = s->p->m->segments;
    for (int i = 0; i < g->count; i++) {
        float sum = (*values)[i] * (float)g->segments[i].pixels, weight = (float)g->segments[i].pixels;
        for (int t = g->first_border[i]; t < g->first_border[i + 1]; t++) {
            const int j = g->borders[t].other;
            const float w = s->p->weights[t] * (float)g->segments[j].pixels;
            sum += w * (*values)[j];
            weight += w;
        }
        (*next)[i] = sum / weight;
    }
    float *swap = *values;
    *values = *next;
    *next = swap;
}

static void keep_best(struct sweep *s, int number)
{
    for (int i = 0; i < s->p->m->segments->count; i++) {
        if (isnan(s->cost[i]) || !(s->gain[i] > s->best[i])) continue;
        s->best[i] = s->gain[i];
        s->number[i] = number;
    }
}

/* --------------------------------------------------------------------------------------------------------- surfaces */

static bool alike(const struct sweep *s, int i, int j)
{
    return s->number[i] >= 0 && s->number[j] >= 0 && s->number[i] / MOST_PLANES == s->number[j] / MOST_PLANES &&
           abs(s->number[i] - s->number[j]) <= ALIKE;
}

/* Walks through the segments that are connected with list[0]; returns their number. */
static int walk(const struct sweep *s, bool *walked, int *list)
{
    const struct segmentation *g = s->p->m->segments;
    int end = 1;
    walked[list[0]] = true;
    for (int begin = 0; begin < end; begin++)
        for (int t = g->first_border[list[begin]]; t < g->first_border[list[begin] + 1]; t++) {
            const int j = g->borders[t].other;
            if (walked[j] || !alike(s, list[begin], j)) continue;
            walked[j] = true;
            list[end++] = j;
        }
    return end;
}

static double texture_of(const struct sweep *s, const int *list, int count)
{
    double sum = 0, pixels = 0;
    for (int n = 0; n < count; n++) {
        const int size = s->p->m->segments->segments[list[n]].pixels;
        sum += size * match_texture(s->p->m, list[n]);
        pixels += size;
    }
    return sum / pixels;
}

/* The mean matching cost of a surface's pixels on a plane; NULL: on their own. */
static double cost_of(const struct sweep *s, const int *list, int count, const struct plane *plane)
{
    double sum = 0, pixels = 0;
    for (int n = 0; n < count; n++) {
        const int size = s->p->m->segments->segments[list[n]].pixels;
        float cost;
        if (match_evidence(s->p->m, list[n], plane ? *plane : s->start[list[n]], 0, &cost) < SEEN_BY)
            cost = MATCH_CHANCE;
        sum += size * (double)cost;
        pixels += size;
    }
    return sum / pixels;
}

/* The plane near a surface's mean one on which it matches best; *cost: there. */
static struct plane refine(const struct sweep *s, const int *list, int count, double *cost)
{
    double sum = 0;
    struct plane best = {0};
    const int direction = s->number[list[0]] / MOST_PLANES;
    for (int n = 0; n < count; n++) sum += s->number[list[n]] % MOST_PLANES;
    *cost = INFINITY;
    for (int k = -2 * REFINE; k <= 2 * REFINE; k++) {
        const struct plane plane = plane_of(s, direction, sum / count + (double)k / REFINE);
        const double c = cost_of(s, list, count, &plane);
        if (!(c < *cost)) continue;
        *cost = c;
        best = plane;
    }
    return best;
}

/* Adds a plane to the list, in place of that of the smallest surface if it is full. */
static void add_plane(struct furniture_planes *list, struct plane plane, int pixels)
{
    int at = list->count;
    if (list->count < FURNITURE_PLANES)
        list->count++;
    else
        for (int k = at = 0; k < list->count; k++)
            if (list->pixels[k] < list->pixels[at]) at = k;
    if (pixels <= list->pixels[at]) return;
    list->planes[at] = plane;
    list->pixels[at] = pixels;
}

static enum status take_surfaces(struct plane *planes, double *distinct, struct plane *found,
                                 struct furniture_planes *largest, struct sweep *s, struct err *err)
{
    const struct segmentation *g = s->p->m->segments;
    bool *walked = calloc((size_t)g->count + 1, sizeof *walked);
    int *list = malloc(((size_t)g->count + 1) * sizeof *list);
    if (!walked || !list) err_nomem(err, "surfaces of furniture", (size_t)g->count * 5);
    for (int i = 0; !err->status && i < g->count; i++) {
        double cost;
        int pixels = 0;
        if (walked[i] || s->number[i] < 0) continue;
        list[0] = i;
        const int count = walk(s, walked, list);
        for (int n = 0; n < count; n++) pixels += g->segments[list[n]].pixels;
        if (pixels < SMALLEST * g->width * g->height) continue;
        if (texture_of(s, list, count) < TEXTURE) continue;
        const bool own = s->number[i] == OWN;
        if (own) cost = cost_of(s, list, count, NULL);
        const struct plane plane = own ? planes[i] : refine(s, list, count, &cost);
        if (!(cost <= GOOD)) continue;
        if (!own) add_plane(largest, plane, pixels);
        for (int n = 0; n < count; n++) {
            const int k = list[n];
            const double gain = (double)(own ? s->own_gain[k] : s->best[k]);
            if (!own) planes[k] = plane;
            distinct[k] = fmax(own ? distinct[k] : 0, clamp(gain / DISTINCT, 0, 1));
            found[k] = planes[k];
        }
    }
    free(walked);
    free(list);
    return err->status;
}

static enum status sweep_init(struct sweep *s, struct err *err)
{
    const size_t count = (size_t)s->p->m->segments->count + 1;
    float **lists[] = {&s->own, &s->cost, &s->gain, &s->next, &s->best, &s->own_gain};
    for (int k = 0; k < 6; k++)
        if (!(*lists[k] = calloc(count, sizeof **lists[k]))) return err_nomem(err, "surfaces of furniture", count * 4);
    if (!(s->number = malloc(count * sizeof *s->number))) return err_nomem(err, "surfaces of furniture", count * 4);
    return ST_OK;
}

static void sweep_release(struct sweep *s)
{
    free(s->own);
    free(s->cost);
    free(s->gain);
    free(s->next);
    free(s->best);
    free(s->own_gain);
    free(s->number);
}

enum status furniture_sweep_find(struct plane *planes, double *distinct, struct plane *found,
                                 struct furniture_planes *largest, const struct plane_problem *p, struct err *err)
{
    const int count = p->m->segments->count;
    struct sweep s = {.p = p, .start = planes, .height = height_above_floor(p)};
    if (!(s.height > 0) || sweep_init(&s, err)) {
        sweep_release(&s);
        return err->status;
    }
    list_directions(&s);
    parallel_for((size_t)count, 64, match_own, &s);
    for (int n = 0; n < AVERAGES; n++) average(&s, &s.own_gain, &s.next);
    for (int i = 0; i < count; i++) {
        s.number[i] = s.own_gain[i] > LEAST_GAIN && is_before(&s, i, planes[i]) ? OWN : -1;
        s.best[i] = LEAST_GAIN;
    }
    for (int d = 0; d < s.count; d++) {
        set_steps(&s.directions[d], NEAREST * s.height, p->view->fx);
        for (int k = 0; k < s.directions[d].planes; k++) {
            s.now = plane_of(&s, d, k);
            parallel_for((size_t)count, 64, match_now, &s);
            for (int n = 0; n < AVERAGES; n++) average(&s, &s.gain, &s.next);
            keep_best(&s, d * MOST_PLANES + k);
        }
    }
    take_surfaces(planes, distinct, found, largest, &s, err);
    sweep_release(&s);
    return err->status;
}

void furniture_sweep_extend(double *distinct, struct plane *found, const struct plane *planes,
                            const struct plane_problem *p)
{
    for (int i = 0; p->furniture && i < p->m->segments->count; i++) {
        const struct segment *g = &p->m->segments->segments[i];
        const struct plane *face = face_of(p, i);
        const double at = plane_at(planes[i], g->cx, g->cy);
        bool still_found = false;
        for (int k = 0; k < p->furniture->count; k++)
            still_found |= fabs(plane_at(p->furniture->planes[k], g->cx, g->cy) - at) <= SAME * at;
        if (!face || !still_found || plane_at(found[i], g->cx, g->cy) > 0) continue;
        if (match_texture(p->m, i) < TEXTURE) continue;
        const float gain =
            match_cost_sweep(p->m, i, *face, ~0u, NULL) - match_cost_sweep(p->m, i, planes[i], ~0u, NULL);
        if (!(gain >= LEAST_GAIN) || !(at > BEFORE * plane_at(*face, g->cx, g->cy))) continue;
        distinct[i] = fmax(distinct[i], clamp((double)gain / DISTINCT, 0, 1));
        found[i] = planes[i];
    }
}
