/* cross_view.c - cross-view consistency, after [Zitnick 2007].
 *
 * Samples of a segment are carried from its plane into each neighbour by the homography of the plane. With g the number
 * of steps of inverse depth by which the neighbour's surface lies nearer than the sample there, a sample costs
 *   |g| <= AGREE_STEPS   OCCLUDED_COST |g| / AGREE_STEPS: the two agree
 *   g > AGREE_STEPS      OCCLUDED_COST: the sample is occluded in the neighbour, whose picture says nothing of it
 *   g < -AGREE_STEPS     more, up to OCCLUDED_COST + the neighbour's confidence: it sees through the sample, so that
 *                        one of the two depths is wrong
 *   no depth there       UNKNOWN_COST
 * And the other way round: the neighbours' surfaces are carried into the view. A sample that lies more than AGREE_STEPS
 * behind one sees through it, and costs up to FRONT_WEIGHT times that surface's confidence. Without this a segment that
 * matches badly, such as a glossy front, hides behind its neighbours' surfaces, where no picture speaks against it. One
 * neighbour alone may be wrong about what only it sees: at each sample the highest cost counts as the second highest.
 *
 * What differs from the source: neighbours' depths are those of the previous round, weighted by their segments'
 * confidence; they count in both directions; and the neighbours' planes, expressed in this view, become proposals of
 * the expansion moves. */
#include "stages/segment_depth/cross_view.h"

#include <math.h>
#include <stdlib.h>

#include "common/math/lanes.h"

#define AGREE_STEPS    2.0f  /* steps between planes that agree */
#define OCCLUDED_COST  0.15f /* more than agreement costs, less than a violation of the neighbour's line of sight */
#define UNKNOWN_COST   0.15f
#define MIN_OCCLUDER   0.3f  /* confidence from which on a surface may occlude */
#define MIN_CONFIDENCE 0.15f /* minimum weight of a neighbour's segment */
#define FRONT_WEIGHT   1.5f  /* cost of seeing through a confident surface: more than of being seen through */
#define MIN_FRONT      0.05f /* minimum confidence of a surface that the view would see through */

/* Expresses plane `p` of view `other` in `view`: as n . X = 1 in the camera's axes, transformed by the relative pose.
 * False if the plane passes through the camera's centre. */
static bool plane_from_neighbour(struct plane *out, const double p[3], const struct view *view,
                                 const struct view *other)
{
    const struct vec3 n = plane_normal(other, (struct plane){p[0], p[1], p[2]});
    const struct mat3 r = mat3_multiply(other->cam_from_world, mat3_transpose(view->cam_from_world));
    const struct vec3 t = vec3_sub(other->translation, mat3_apply(r, view->translation));
    const double w = 1 - vec3_dot(n, t);
    if (!(fabs(w) > 1e-9)) return false;
    *out = plane_of_normal(view, vec3_scale(mat3_apply(mat3_transpose(r), n), 1 / w));
    return isfinite(out->a) && isfinite(out->b) && isfinite(out->c);
}

/* Picks pixels spread over each segment. */
static enum status sample_segments(struct cross_view *x, const struct segmentation *s, struct err *err)
{
    x->samples = malloc(((size_t)s->count + 1) * sizeof *x->samples);
    if (!x->samples) return err_nomem(err, "samples of segments", (size_t)s->count * sizeof *x->samples);
    for (int i = 0; i < s->count; i++)
        for (int k = 0; k < CROSS_SAMPLES; k++) {
            const struct segment *g = &s->segments[i];
            const int pixel = s->pixel[g->first + g->pixels * (2 * k + 1) / (2 * CROSS_SAMPLES)];
            x->samples[i][0][k] = (float)(pixel % s->width) + 0.5f;
            x->samples[i][1][k] = (float)(pixel / s->width) + 0.5f;
        }
    return ST_OK;
}

/* Precomputes what cross_view_cost() reads, close together in memory. */
static enum status prepare_neighbour(struct cross_neighbour *n, const struct cross_view *x, int segments,
                                     struct err *err)
{
    const size_t planes = (size_t)n->depth.segment_count + 1, size = ((size_t)segments + 1) * sizeof *n->warps;
    n->warps = aligned_alloc(32, size);
    n->planes = calloc(planes, sizeof *n->planes);
    if (!n->warps || !n->planes) return err_nomem(err, "samples of segments", size);
    for (int i = 0; i < segments; i++)
        for (int k = 0; k < CROSS_SAMPLES; k++) {
            const double u = (double)x->samples[i][0][k], v = (double)x->samples[i][1][k];
            for (int j = 0; j < 3; j++)
                n->warps[i].rotated[j][k] = (float)(n->base[j][0] * u + n->base[j][1] * v + n->base[j][2]);
        }
    for (size_t k = 1; k < planes; k++) {
        const struct depth_segment *g = &n->depth.segments[k - 1];
        n->planes[k] =
            (struct cross_plane){(float)g->plane[0], (float)g->plane[1], (float)g->plane[2], (float)g->confidence};
    }
    return ST_OK;
}

/* Carries the neighbour's surface into the view; the nearest one stays. Pixels that nothing falls on say nothing. */
static enum status see_neighbour(struct cross_neighbour *n, const struct cross_view *x, const struct segmentation *s,
                                 const struct view *view, const struct view *other, struct err *err)
{
    const int width = n->depth.width, height = n->depth.height;
    const size_t pixels = (size_t)s->width * (size_t)s->height, size = ((size_t)s->count + 1) * sizeof *n->fronts;
    double base[3][3], shift[3];
    float *nearest = calloc(pixels, sizeof *nearest);
    uint8_t *confidence = calloc(pixels, 1);
    n->fronts = malloc(size);
    if (!nearest || !confidence || !n->fronts) err_nomem(err, "surfaces of a neighbour", pixels * 5 + size);
    matcher_homography(base, shift, other, view);
    for (int i = 0; !err->status && i < width * height; i++) {
        const uint32_t id = n->depth.interior.id[i];
        if (!id) continue;
        const struct cross_plane *plane = &n->planes[id];
        const double u = i % width + 0.5, v = i / width + 0.5; /* centre of the pixel */
        const double inverse = (double)plane->a * u + (double)plane->b * v + (double)plane->c;
        double q[3];
        for (int j = 0; j < 3; j++) q[j] = base[j][0] * u + base[j][1] * v + base[j][2] + shift[j] * inverse;
        if (!(inverse > 0) || !(q[2] > 1e-9)) continue;
        const double to_u = q[0] / q[2], to_v = q[1] / q[2];
        if (!(to_u >= 0 && to_v >= 0 && to_u < s->width && to_v < s->height)) continue;
        const size_t at = (size_t)to_v * (size_t)s->width + (size_t)to_u;
        const float here = (float)(inverse / q[2]);
        if (!(here > nearest[at])) continue;
        nearest[at] = here;
        confidence[at] = (uint8_t)lrintf(255 * fminf(fmaxf(plane->confidence, MIN_FRONT), 1));
    }
    for (int i = 0; !err->status && i < s->count; i++)
        for (int k = 0; k < CROSS_SAMPLES; k++) {
            const size_t at = (size_t)x->samples[i][1][k] * (size_t)s->width + (size_t)x->samples[i][0][k];
            n->fronts[i].inverse[k] = nearest[at];
            n->fronts[i].confidence[k] = confidence[at];
        }
    free(nearest);
    free(confidence);
    return err->status;
}

struct centroid {
    double u, v;
    int pixels;
};

static enum status segment_centroids(struct centroid **centers, const struct layered_depth *d, struct err *err)
{
    struct centroid *c = calloc((size_t)d->segment_count + 1, sizeof *c);
    if (!c) return err_nomem(err, "centres of segments", (size_t)d->segment_count * sizeof *c);
    for (int y = 0; y < d->height; y++)
        for (int x = 0; x < d->width; x++) {
            struct centroid *at = &c[d->interior.id[(size_t)y * (size_t)d->width + (size_t)x]];
            at->u += x + 0.5;
            at->v += y + 0.5;
            at->pixels++;
        }
    *centers = c;
    return ST_OK;
}

/* Round 0 counts the proposals of each segment, round 1 stores them. */
static void collect_proposals(struct cross_view *x, const struct segmentation *s, const struct view *view,
                              const struct view *other, const struct layered_depth *d, const struct centroid *centers,
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
                            const struct previous_depth_source *source, struct err *err)
{
    const struct view *view = &set->views[view_idx];
    struct centroid *centers[MAX_NEIGHBOURS] = {NULL};
    x->step = step;
    sample_segments(x, s, err);
    if (!err->status && !(x->first_proposal = calloc((size_t)s->count + 3, sizeof *x->first_proposal)))
        err_nomem(err, "proposals", (size_t)s->count * sizeof(int));
    for (int k = 0; !err->status && k < count; k++) {
        struct cross_neighbour *n = &x->neighbours[k];
        matcher_homography(n->base, n->shift, view, &set->views[neighbours[k]]);
        x->count = k + 1;
        if (!source->read(source->ctx, neighbours[k], &n->depth, err) &&
            !segment_centroids(&centers[k], &n->depth, err) && !prepare_neighbour(n, x, s->count, err))
            see_neighbour(n, x, s, view, &set->views[neighbours[k]], err);
    }
    for (int round = 0; !err->status && round < 2; round++) {
        for (int k = 0; k < count; k++)
            collect_proposals(x, s, view, &set->views[neighbours[k]], &x->neighbours[k].depth, centers[k], round);
        if (round) break;
        for (int i = 1; i <= s->count + 1; i++) x->first_proposal[i] += x->first_proposal[i - 1];
        const size_t all = (size_t)x->first_proposal[s->count + 1];
        if (!(x->proposals = malloc((all + 1) * sizeof *x->proposals)))
            err_nomem(err, "proposals", all * sizeof *x->proposals);
    }
    for (int k = 0; k < count; k++) free(centers[k]);
    return err->status;
}

void cross_view_release(struct cross_view *x)
{
    if (!x) return;
    for (int k = 0; k < x->count; k++) {
        layered_depth_release(&x->neighbours[k].depth);
        free(x->neighbours[k].warps);
        free(x->neighbours[k].fronts);
        free(x->neighbours[k].planes);
    }
    free(x->samples);
    free(x->first_proposal);
    free(x->proposals);
    *x = (struct cross_view){0};
}

/* For each sample of a segment at inverse depth `inverse`: the steps by which the neighbour's surface is nearer, and
 * that surface's confidence. Returns the mask of lanes where the neighbour has a depth. */
static inline i32x8 surface_gap(const struct cross_neighbour *n, int segment, f32x8 inverse, float step, f32x8 *steps,
                                f32x8 *confidence)
{
    const struct cross_warp *at = &n->warps[segment];
    f32x8 p[3];
    for (int j = 0; j < 3; j++) p[j] = f32x8_load(at->rotated[j]) + (float)n->shift[j] * inverse;
    const f32x8 zero = {0}, r = 1 / p[2];
    const f32x8 u = p[0] * r, v = p[1] * r;
    i32x8 known = p[2] > 1e-9f;
    known &= (u >= zero) & (v >= zero);
    known &= u < (float)n->depth.width;
    known &= v < (float)n->depth.height;
    *steps = *confidence = zero;
    if (!i32x8_any(known)) return known;
    const i32x8 pixel = i32x8_index(i32x8_truncate(v), n->depth.width, i32x8_truncate(u));
    const i32x8 none = {0}; /* plane 0, of no segment, is all zeros */
    const i32x8 id = i32x8_gather_if(known, (const int *)n->depth.interior.id, pixel, none) << 2;
    const float *planes = &n->planes->a;
    f32x8 there = f32x8_gather(planes, id) * u;
    there += f32x8_gather(planes + 1, id) * v;
    there += f32x8_gather(planes + 2, id);
    *confidence = f32x8_gather(planes + 3, id);
    /* steps of the view in a unit of the neighbour's inverse depth, at equal distance */
    const f32x8 scale = f32x8_max(f32x8_load(at->rotated[2]), f32x8_all(0.1f));
    const f32x8 per_step = 1 / (scale * step);
    *steps = (there * p[2] - inverse) * (p[2] * per_step);
    return known & (there > zero);
}

/* Inverse depths of a segment's samples on a plane. */
static f32x8 inverse_depths(const struct cross_view *x, int segment, struct plane plane)
{
    const float(*at)[CROSS_SAMPLES] = x->samples[segment];
    const f32x8 a = f32x8_all((float)plane.a), b = f32x8_all((float)plane.b);
    return a * f32x8_load(at[0]) + b * f32x8_load(at[1]) + (float)plane.c;
}

/* What it costs, at each sample, to see through the neighbours' surfaces. */
static inline f32x8 cost_behind(const struct cross_view *x, int segment, f32x8 inverse)
{
    const f32x8 zero = {0}, one = f32x8_all(1);
    const f32x8 per_agree = f32x8_all(1 / (AGREE_STEPS * (float)x->step));
    f32x8 sum = zero, highest = zero, second = zero;
    for (int k = 0; k < x->count; k++) {
        const struct cross_front *f = &x->neighbours[k].fronts[segment];
        const f32x8 gap = (f32x8_load(f->inverse) - inverse) * per_agree;
        const f32x8 through = f32x8_min(f32x8_max(gap - one, zero), one);
        const f32x8 cost = through * f32x8_from_i32(i32x8_from_u8(f->confidence));
        sum += cost;
        second = f32x8_max(second, f32x8_min(highest, cost));
        highest = f32x8_max(highest, cost);
    }
    return (sum - highest + second) * (FRONT_WEIGHT / 255);
}

float cross_view_cost(const struct cross_view *x, int segment, struct plane plane, unsigned *occluded)
{
    return cross_view_bounded(x, segment, plane, INFINITY, occluded);
}

float cross_view_bounded(const struct cross_view *x, int segment, struct plane plane, float max_cost,
                         unsigned *occluded)
{
    const float count = (float)(x->count * CROSS_SAMPLES), limit = max_cost * count;
    const f32x8 agree = f32x8_all(AGREE_STEPS), zero = {0};
    const f32x8 inverse = inverse_depths(x, segment, plane);
    f32x8 sum = cost_behind(x, segment, inverse);
    float all = f32x8_sum(sum);
    *occluded = 0;
    if (!x->count) return 0;
    for (int k = 0; k < x->count && !(all > limit); k++) {
        f32x8 steps, confidence;
        const i32x8 known = surface_gap(&x->neighbours[k], segment, inverse, (float)x->step, &steps, &confidence);
        const f32x8 off = f32x8_max(steps, zero - steps);
        const f32x8 near = f32x8_min(off, agree) * (OCCLUDED_COST / AGREE_STEPS);
        const f32x8 seen_through = (zero - steps - agree) * (1 / AGREE_STEPS);
        const f32x8 sure = f32x8_max(confidence, f32x8_all(MIN_CONFIDENCE));
        const f32x8 violation = sure * f32x8_min(f32x8_max(seen_through, zero), f32x8_all(1));
        sum += f32x8_if(known, near + violation, f32x8_all(UNKNOWN_COST));
        const i32x8 behind = (steps > agree) & (confidence > MIN_OCCLUDER);
        if (__builtin_popcount(i32x8_signs(known & behind)) > CROSS_SAMPLES / 2) *occluded |= 1u << k;
        all = f32x8_sum(sum);
    }
    return all / count;
}

double cross_view_support(const struct cross_view *x, int segment, struct plane plane)
{
    const f32x8 inverse = inverse_depths(x, segment, plane);
    double sum = 0;
    for (int k = 0; k < x->count; k++) {
        _Alignas(32) float steps[CROSS_SAMPLES], confidence[CROSS_SAMPLES];
        f32x8 s, c;
        const unsigned known = i32x8_signs(surface_gap(&x->neighbours[k], segment, inverse, (float)x->step, &s, &c));
        f32x8_store(steps, s);
        f32x8_store(confidence, c);
        if (known >> CROSS_SAMPLES / 2 & 1 && fabsf(steps[CROSS_SAMPLES / 2]) <= AGREE_STEPS)
            sum += (double)confidence[CROSS_SAMPLES / 2];
    }
    return sum;
}
