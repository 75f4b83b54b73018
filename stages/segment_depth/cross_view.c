/* cross_view.c - see cross_view.h. */
#include "stages/segment_depth/cross_view.h"

#include <math.h>
#include <stdlib.h>

#define AGREE            2.0 /* steps: planes nearer than this agree, the less the farther */
#define HIDDEN           0.15f /* cost of being hidden from a neighbour: dearer than agreeing, cheaper than standing in its way */
#define UNKNOWN          0.15f
#define LEAST_OCCLUDER   0.3f  /* confidence of what is believed to hide something */
#define LEAST_CONFIDENCE 0.15f /* what a neighbour's unsure segment still counts */

/* The plane of `other` that is `p` here: as n . X = 1 in the camera's axes, carried by the pose. False: it passes through
 * the camera's centre. */
static bool plane_from_neighbour(struct plane *out, const double p[3], const struct view *view,
                                 const struct view *other)
{
    const struct vec3 n = {p[0] * other->fx, p[1] * other->fy, p[0] * other->cx + p[1] * other->cy + p[2]};
    const struct mat3 r = mat3_multiply(other->cam_from_world, mat3_transpose(view->cam_from_world));
    const struct vec3 t = vec3_sub(other->translation, mat3_apply(r, view->translation));
    const double w = 1 - vec3_dot(n, t);
    if (!(fabs(w) > 1e-9)) return false;
    const struct vec3 m = vec3_scale(mat3_apply(mat3_transpose(r), n), 1 / w);
    *out = (struct plane){m.x / view->fx, m.y / view->fy, m.z - m.x / view->fx * view->cx - m.y / view->fy * view->cy};
    return isfinite(out->a) && isfinite(out->b) && isfinite(out->c);
}

/* Places spread over each segment, in pixel coordinates. */
static enum status make_places(struct cross_view *x, const struct segmentation *s, struct err *err)
{
    x->places = malloc(((size_t)s->count * CROSS_PLACES + 1) * sizeof *x->places);
    if (!x->places) return err_nomem(err, "places of segments", (size_t)s->count * CROSS_PLACES * sizeof *x->places);
    for (int i = 0; i < s->count; i++)
        for (int k = 0; k < CROSS_PLACES; k++) {
            const struct segment *g = &s->segments[i];
            const int pixel = s->pixel[g->first + g->pixels * (2 * k + 1) / (2 * CROSS_PLACES)];
            float *at = x->places[i * CROSS_PLACES + k];
            at[0] = (float)(pixel % s->width) + 0.5f;
            at[1] = (float)(pixel / s->width) + 0.5f;
        }
    return ST_OK;
}

struct center {
    double u, v;
    int pixels;
};

static enum status segment_centers(struct center **centers, const struct layered_depth *d, struct err *err)
{
    struct center *c = calloc((size_t)d->segment_count + 1, sizeof *c);
    if (!c) return err_nomem(err, "centres of segments", (size_t)d->segment_count * sizeof *c);
    for (int y = 0; y < d->height; y++)
        for (int x = 0; x < d->width; x++) {
            struct center *at = &c[d->interior.id[(size_t)y * (size_t)d->width + (size_t)x]];
            at->u += x + 0.5;
            at->v += y + 0.5;
            at->pixels++;
        }
    *centers = c;
    return ST_OK;
}

/* round 0 counts, round 1 fills. */
static void place_proposals(struct cross_view *x, const struct segmentation *s, const struct view *view,
                            const struct view *other, const struct layered_depth *d, const struct center *centers,
                            int round)
{
    for (int k = 1; k <= d->segment_count; k++) {
        const struct depth_segment *g = &d->segments[k - 1];
        double u, v;
        struct plane plane;
        if (!centers[k].pixels) continue;
        const double cu = centers[k].u / centers[k].pixels, cv = centers[k].v / centers[k].pixels;
        const double inverse = g->plane[0] * cu + g->plane[1] * cv + g->plane[2];
        if (!(inverse > 0)) continue;
        const struct vec3 world = view_unproject(other, cu, cv, 1 / inverse);
        if (!(view_project(view, world, &u, &v) > 0) || !(u >= 0 && v >= 0 && u < s->width && v < s->height)) continue;
        const int label = s->label[(size_t)v * (size_t)s->width + (size_t)u];
        if (label < 0 || !plane_from_neighbour(&plane, g->plane, view, other)) continue;
        if (round == 0)
            x->first_proposal[label + 2]++;
        else
            x->proposals[x->first_proposal[label + 1]++] = plane;
    }
}

enum status cross_view_make(struct cross_view *x, const struct segmentation *s, const struct camera_set *set,
                            int view_idx, const int *neighbours, int count, double step,
                            const struct depth_source *source, struct err *err)
{
    const struct view *view = &set->views[view_idx];
    struct center *centers[MAX_NEIGHBOURS] = {NULL};
    x->step = step;
    enum status st = make_places(x, s, err);
    if (!st && !(x->first_proposal = calloc((size_t)s->count + 3, sizeof *x->first_proposal)))
        st = err_nomem(err, "proposals", (size_t)s->count * sizeof(int));
    for (int k = 0; !st && k < count; k++) {
        struct cross_neighbour *n = &x->neighbours[k];
        match_homography(n->base, n->shift, view, &set->views[neighbours[k]]);
        x->count = k + 1;
        st = source->read(source->ctx, neighbours[k], &n->depth, err);
        if (!st) st = segment_centers(&centers[k], &n->depth, err);
    }
    for (int round = 0; !st && round < 2; round++) {
        for (int k = 0; k < count; k++)
            place_proposals(x, s, view, &set->views[neighbours[k]], &x->neighbours[k].depth, centers[k], round);
        if (round) break;
        for (int i = 1; i <= s->count + 1; i++) x->first_proposal[i] += x->first_proposal[i - 1];
        const size_t all = (size_t)x->first_proposal[s->count + 1];
        if (!(x->proposals = malloc((all + 1) * sizeof *x->proposals)))
            st = err_nomem(err, "proposals", all * sizeof *x->proposals);
    }
    for (int k = 0; k < count; k++) free(centers[k]);
    return st;
}

void cross_view_release(struct cross_view *x)
{
    if (!x) return;
    for (int k = 0; k < x->count; k++) layered_depth_release(&x->neighbours[k].depth);
    free(x->places);
    free(x->first_proposal);
    free(x->proposals);
    *x = (struct cross_view){0};
}

/* How many steps nearer the neighbour's surface is than the point; false if the neighbour knows nothing there. */
static bool nearer_by(const struct cross_view *x, const struct cross_neighbour *n, double u, double v, double inverse,
                      double *steps, float *confidence)
{
    double p[3], turned = n->base[2][0] * u + n->base[2][1] * v + n->base[2][2];
    for (int i = 0; i < 3; i++) p[i] = n->base[i][0] * u + n->base[i][1] * v + n->base[i][2] + n->shift[i] * inverse;
    if (!(p[2] > 1e-9)) return false;
    const double nu = p[0] / p[2], nv = p[1] / p[2];
    if (!(nu >= 0 && nv >= 0 && nu < n->depth.width && nv < n->depth.height)) return false;
    const uint32_t id = n->depth.interior.id[(size_t)nv * (size_t)n->depth.width + (size_t)nu];
    if (!id) return false;
    const struct depth_segment *g = &n->depth.segments[id - 1];
    const double there = g->plane[0] * nu + g->plane[1] * nv + g->plane[2];
    if (!(there > 0)) return false;
    *steps = (there - inverse / p[2]) * p[2] * p[2] / (fmax(turned, 0.1) * x->step);
    *confidence = (float)g->confidence;
    return true;
}

float cross_view_cost(const struct cross_view *x, int segment, struct plane plane, unsigned *hidden)
{
    float sum = 0;
    *hidden = 0;
    if (!x->count) return 0;
    for (int k = 0; k < x->count; k++) {
        int behind = 0;
        for (int i = 0; i < CROSS_PLACES; i++) {
            const float *at = x->places[segment * CROSS_PLACES + i];
            double steps;
            float confidence, cost;
            if (!nearer_by(x, &x->neighbours[k], (double)at[0], (double)at[1],
                           plane_at(plane, (double)at[0], (double)at[1]), &steps, &confidence)) {
                cost = UNKNOWN;
            } else if (fabs(steps) <= AGREE) {
                cost = HIDDEN * (float)(fabs(steps) / AGREE);
            } else if (steps > 0) {
                cost = HIDDEN;
                behind += confidence > LEAST_OCCLUDER;
            } else {
                cost = HIDDEN + fmaxf(confidence, LEAST_CONFIDENCE) * fminf(1, (float)(-steps - AGREE) / (float)AGREE);
            }
            sum += cost;
        }
        if (behind > CROSS_PLACES / 2) *hidden |= 1u << k;
    }
    return sum / (float)(x->count * CROSS_PLACES);
}

double cross_view_agreeing(const struct cross_view *x, int segment, struct plane plane)
{
    double sum = 0;
    for (int k = 0; k < x->count; k++) {
        const float *at = x->places[segment * CROSS_PLACES + CROSS_PLACES / 2];
        double steps;
        float confidence;
        if (nearer_by(x, &x->neighbours[k], (double)at[0], (double)at[1], plane_at(plane, (double)at[0], (double)at[1]),
                      &steps, &confidence) &&
            fabs(steps) <= AGREE)
            sum += (double)confidence;
    }
    return sum;
}
