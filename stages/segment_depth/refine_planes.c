/* refine_planes.c - local search for a plane per segment, in the manner of PatchMatch [Bleyer 2011].
 *
 * In each pass every segment tries the planes of its neighbours (propagation), perturbations that halve from pass to
 * pass (random search, here on a fixed pattern), a constant depth, and a least-squares plane through the centroids
 * around it; it keeps the plane of minimum energy given its neighbours' planes. The energy is the one of expand.c, with
 * all pixels matched.
 *
 * What differs from the source: nodes are segments. They are coloured greedily so that no two adjacent segments have
 * one colour; the segments of a colour are refined in parallel while their neighbours stay fixed, so that the result
 * does not depend on threads. Planes are fitted to the planes at the start of the pass. */
#include "stages/segment_depth/refine_planes.h"

#include <assert.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/base/progress.h"

struct refine {
    const struct plane_problem *p;
    const struct segmentation *s;
    double step, perturbation; /* of 1/z; perturbation: in this pass */
    struct plane *plane, *before;
    float *unary; /* unary terms of the current planes */
    const int *members;
};

static double pairwise_sum(const struct refine *r, int i, struct plane p)
{
    double sum = 0;
    for (int t = r->s->first_border[i]; t < r->s->first_border[i + 1]; t++)
        sum += problem_pairwise_cost(r->p, i, t, p, r->plane[r->s->borders[t].other]);
    return sum;
}

static void try_plane(struct refine *r, int i, struct plane p, double *best)
{
    const double pairwise = pairwise_sum(r, i, p),
                 size = (double)r->s->segments[i].pixels / r->p->params->segment_pixels;
    if (pairwise + size * (double)MATCH_BEST >= *best) return;
    const float unary = problem_unary_cost(r->p, i, p, (float)(*best - pairwise));
    if (pairwise + (double)unary < *best) {
        *best = pairwise + (double)unary;
        r->plane[i] = p;
        r->unary[i] = unary;
    }
}

static struct plane plane_through(double u, double v, double inverse_z, double a, double b)
{
    return (struct plane){a, b, inverse_z - a * u - b * v};
}

/* Weighted least squares over the centroids of the segment, its neighbours and their neighbours; the weight is a
 * segment's size, reduced by its difference in colour and in depth. False if the centroids do not span a plane. */
static bool fit_plane(const struct refine *r, int i, struct plane *fit)
{
    const struct segmentation *s = r->s;
    const struct segment *g = &s->segments[i];
    double m[3][3] = {{0}}, rhs[3] = {0}, center = plane_at(r->before[i], g->cx, g->cy);
    double tolerance = 3 * r->step;
    for (int t = s->first_border[i] - 1; t < s->first_border[i + 1]; t++) {
        /* t == first - 1: the segment itself */
        int near = t < s->first_border[i] ? i : s->borders[t].other;
        for (int k = s->first_border[near] - 1; k < s->first_border[near + 1]; k++) {
            int j = k < s->first_border[near] ? near : s->borders[k].other;
            const struct segment *h = &s->segments[j];
            double d = plane_at(r->before[j], h->cx, h->cy), off = (d - center) / tolerance, colour = 0;
            for (int c = 0; c < 3; c++) colour += pow((double)(h->colour[c] - g->colour[c]) / 12, 2);
            double w = h->pixels / ((1 + colour) * (1 + off * off * off * off));
            const double q[3] = {h->cx - g->cx, h->cy - g->cy, 1};
            for (int a = 0; a < 3; a++) {
                for (int b = 0; b < 3; b++) m[a][b] += w * q[a] * q[b];
                rhs[a] += w * q[a] * d;
            }
        }
    }
    double spread = 1e-3 * (m[0][0] + m[1][1]) + 1e-9;
    m[0][0] += spread; /* regularizes towards a constant depth if the centroids are collinear */
    m[1][1] += spread;
    struct vec3 x = {m[0][0], m[1][0], m[2][0]}, y = {m[0][1], m[1][1], m[2][1]}, z = {m[0][2], m[1][2], m[2][2]};
    struct vec3 e = {rhs[0], rhs[1], rhs[2]};
    double det = vec3_dot(x, vec3_cross(y, z));
    if (!(fabs(det) > 1e-12 * m[2][2] * m[2][2] * m[2][2])) return false;
    double a = vec3_dot(e, vec3_cross(y, z)) / det, b = vec3_dot(x, vec3_cross(e, z)) / det;
    double c = vec3_dot(x, vec3_cross(y, e)) / det;
    *fit = plane_through(g->cx, g->cy, c, a, b);
    return isfinite(a) && isfinite(b) && isfinite(c);
}

static void refine_segment(struct refine *r, int i)
{
    const struct segmentation *s = r->s;
    const struct segment *g = &s->segments[i];
    double best = (double)r->unary[i] + pairwise_sum(r, i, r->plane[i]);
    struct plane fit;
    bool fitted = fit_plane(r, i, &fit);
    if (fitted) {
        double here = plane_at(r->plane[i], g->cx, g->cy);
        try_plane(r, i, fit, &best);
        try_plane(r, i, plane_through(g->cx, g->cy, here, fit.a, fit.b), &best);
    }
    for (int t = s->first_border[i]; t < s->first_border[i + 1]; t++) {
        struct plane p = r->plane[s->borders[t].other];
        struct plane own = r->plane[i];
        if (p.a != own.a || p.b != own.b || p.c != own.c) try_plane(r, i, p, &best);
    }
    double here = plane_at(r->plane[i], g->cx, g->cy);
    if (r->plane[i].a != 0 || r->plane[i].b != 0) try_plane(r, i, (struct plane){0, 0, here}, &best);
    for (int sign = -1; sign <= 1; sign += 2) {
        struct plane p = r->plane[i];
        p.c += sign * r->perturbation;
        try_plane(r, i, p, &best);
    }
    for (int k = 0; k < 4; k++) { /* rotations about the centroid that change the rim's 1/z by `perturbation` */
        double a = k < 2 ? (k ? 1 : -1) * 2 * r->perturbation / (g->x1 - g->x0 + 1) : 0;
        double b = k < 2 ? 0 : (k & 1 ? 1 : -1) * 2 * r->perturbation / (g->y1 - g->y0 + 1);
        struct plane p = r->plane[i];
        try_plane(r, i, plane_through(g->cx, g->cy, plane_at(p, g->cx, g->cy), p.a + a, p.b + b), &best);
    }
}

static void refine_colour(void *ctx, size_t begin, size_t end, int thread)
{
    struct refine *r = ctx;
    (void)thread;
    for (size_t k = begin; k < end; k++) refine_segment(r, r->members[k]);
}

static void initial_costs(void *ctx, size_t begin, size_t end, int thread)
{
    struct refine *r = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) r->unary[i] = problem_unary_cost(r->p, (int)i, r->plane[i], INFINITY);
}

/* Colours the segments greedily. members: the segments sorted by colour; those of colour c begin at first[c]. Returns
 * the number of colours, at most MAX_COLOURS. */
#define MAX_COLOURS 64
static int colour_segments(const struct segmentation *s, int *colour, int *members, int first[MAX_COLOURS + 1])
{
    int colours = 0;
    for (int i = 0; i < s->count; i++) {
        uint64_t taken = 0;
        for (int t = s->first_border[i]; t < s->first_border[i + 1]; t++)
            if (s->borders[t].other < i) taken |= (uint64_t)1 << colour[s->borders[t].other];
        for (colour[i] = 0; taken >> colour[i] & 1; colour[i]++) assert(colour[i] < MAX_COLOURS - 1);
        colours = colour[i] + 1 > colours ? colour[i] + 1 : colours;
    }
    for (int c = 0, n = 0; c <= colours; c++) {
        first[c] = n;
        for (int i = 0; i < s->count; i++)
            if (colour[i] == c) members[n++] = i;
    }
    return colours;
}

enum status refine_planes(struct plane *plane, const struct plane_problem *p, struct err *err)
{
    const struct segmentation *s = p->m->segments;
    struct refine r = {.p = p, .s = s, .step = p->step, .plane = plane};
    int *colour = malloc(((size_t)s->count + 1) * sizeof *colour), first[MAX_COLOURS + 1];
    int *members = malloc(((size_t)s->count + 1) * sizeof *members);
    struct progress progress;
    r.before = malloc(((size_t)s->count + 1) * sizeof *r.before);
    r.unary = malloc(((size_t)s->count + 1) * sizeof *r.unary);
    if (!colour || !members || !r.before || !r.unary) {
        err_nomem(err, "the refinement of planes", (size_t)s->count * 40);
        goto done;
    }
    r.members = members;
    int colours = colour_segments(s, colour, members, first);
    const int passes = problem_passes(p);
    progress_start(&progress, "refinement", (int64_t)passes * s->count, "segments");
    parallel_for((size_t)s->count, 64, initial_costs, &r);
    for (int pass = 0; pass < passes; pass++) {
        memcpy(r.before, plane, (size_t)s->count * sizeof *plane);
        r.perturbation = r.step * pow(0.5, pass);
        for (int c = 0; c < colours; c++) {
            r.members = members + first[c];
            parallel_for((size_t)(first[c + 1] - first[c]), 16, refine_colour, &r);
            progress_add(&progress, first[c + 1] - first[c]);
        }
    }
    progress_end(&progress);
done:
    free(colour);
    free(members);
    free(r.before);
    free(r.unary);
    return err->status;
}
