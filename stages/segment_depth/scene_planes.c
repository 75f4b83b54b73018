/* scene_planes.c - dominant planes, the best supported first.
 *
 * A vote supports a plane if at its place both have the same inverse depth, to a step or DEPTH_PART of it, whichever is
 * more, and slant, to as much over SLANT_PIXELS: blank parts follow a plane at best to a few hundredths, however fine
 * the steps are. The plane that most weight supports, of those that weigh most by themselves, is fitted to the
 * votes that support it, by least squares of inverse depth, which is linear in the picture; then these votes are
 * removed and the next plane is found. */
#include "stages/segment_depth/scene_planes.h"

#include <math.h>
#include <stdlib.h>

#define DEPTH_PART   0.02
#define SLANT_PIXELS 40.0
#define VOTED_PLANES 12
#define TRIED        128 /* planes whose support is measured */
#define FITS         2

static bool supports(const struct plane_vote *v, struct plane p, double step)
{
    const double here = plane_at(p, v->u, v->v), tolerance = fmax(step, DEPTH_PART * here);
    return fabs(plane_at(v->plane, v->u, v->v) - here) < tolerance &&
           SLANT_PIXELS * hypot(v->plane.a - p.a, v->plane.b - p.b) < tolerance;
}

static double support_of(struct plane p, const struct plane_vote *votes, int count, double step)
{
    double sum = 0;
    for (int i = 0; i < count; i++)
        if (supports(&votes[i], p, step)) sum += votes[i].weight;
    return sum;
}

/* Fits a plane to the votes that support p; p itself if they do not span one. */
static struct plane fitted(struct plane p, const struct plane_vote *votes, int count, double step)
{
    double w = 0, u = 0, v = 0, d = 0, uu = 0, uv = 0, vv = 0, ud = 0, vd = 0;
    for (int i = 0; i < count; i++) {
        const struct plane_vote *o = &votes[i];
        if (!supports(o, p, step)) continue;
        const double z = plane_at(o->plane, o->u, o->v);
        w += o->weight;
        u += o->weight * o->u;
        v += o->weight * o->v;
        d += o->weight * z;
        uu += o->weight * o->u * o->u;
        uv += o->weight * o->u * o->v;
        vv += o->weight * o->v * o->v;
        ud += o->weight * o->u * z;
        vd += o->weight * o->v * z;
    }
    if (!(w > 0)) return p;
    u /= w, v /= w, d /= w;
    uu = uu / w - u * u, uv = uv / w - u * v, vv = vv / w - v * v, ud = ud / w - u * d, vd = vd / w - v * d;
    const double det = uu * vv - uv * uv;
    if (!(det > 1e-3 * (uu + vv) * (uu + vv)) || !(uu + vv > SLANT_PIXELS * SLANT_PIXELS)) return p;
    const double a = (ud * vv - vd * uv) / det, b = (vd * uu - ud * uv) / det;
    return (struct plane){a, b, d - a * u - b * v};
}

static int compare_weight(const void *a, const void *b)
{
    const struct plane_vote *x = a, *y = b;
    if (x->weight != y->weight) return x->weight > y->weight ? -1 : 1;
    if (x->plane.c != y->plane.c) return x->plane.c < y->plane.c ? -1 : 1;
    if (x->v != y->v) return x->v < y->v ? -1 : 1;
    return x->u < y->u ? -1 : x->u > y->u;
}

static int compare_plane(const void *a, const void *b)
{
    const struct plane_vote *x = a, *y = b;
    if (x->plane.c != y->plane.c) return x->plane.c < y->plane.c ? -1 : 1;
    if (x->plane.a != y->plane.a) return x->plane.a < y->plane.a ? -1 : 1;
    if (x->plane.b != y->plane.b) return x->plane.b < y->plane.b ? -1 : 1;
    return compare_weight(a, b);
}

/* The distinct planes of the votes, by weight; returns how many. votes are sorted by plane. */
static int list_planes(struct plane_vote *out, struct plane_vote *votes, int count)
{
    int n = 0;
    qsort(votes, (size_t)count, sizeof *votes, compare_plane);
    for (int i = 0; i < count; i++) {
        if (n && memcmp(&out[n - 1].plane, &votes[i].plane, sizeof votes[i].plane) == 0)
            out[n - 1].weight += votes[i].weight;
        else
            out[n++] = votes[i];
    }
    qsort(out, (size_t)n, sizeof *out, compare_weight);
    return n;
}

enum status scene_planes_find(struct scene_planes *s, const struct plane_vote *votes, int count, double step,
                              double least, struct err *err)
{
    struct plane_vote *left = malloc(((size_t)count + 1) * 2 * sizeof *left), *planes = left + count + 1;
    s->count = s->known;
    s->has_ground = false;
    s->voted_ground = 0;
    if (!left) return err_nomem(err, "planes of a scene", ((size_t)count + 1) * 2 * sizeof *left);
    int n = 0;
    for (int i = 0; i < count; i++)
        if (votes[i].plane.a != 0 || votes[i].plane.b != 0) left[n++] = votes[i];
    while (s->count < s->known + VOTED_PLANES) {
        const int distinct = list_planes(planes, left, n);
        struct plane best = {0, 0, 0};
        double most = 0;
        for (int k = 0; k < distinct && k < TRIED; k++) {
            const double support = support_of(planes[k].plane, left, n, step);
            if (!(support > most)) continue;
            most = support;
            best = planes[k].plane;
        }
        if (!(most >= least)) break;
        struct plane fit = best;
        for (int k = 0; k < FITS; k++) fit = fitted(fit, left, n, step);
        if (support_of(fit, left, n, step) >= most) best = fit;
        s->count++;
        scene_planes_set(s, s->count - 1, best);
        int kept = 0;
        for (int i = 0; i < n; i++)
            if (!supports(&left[i], best, step)) left[kept++] = left[i];
        n = kept;
    }
    free(left);
    return ST_OK;
}
