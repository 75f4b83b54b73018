/* planes.c - planes across the axes, and axes refined by them.
 *
 * For each axis and sign, the points with that normal are counted by their position along the axis; peaks of the
 * histogram are planes. The rotation of the axes and the offsets of all planes are found together by robust least
 * squares on the points' distances (Tukey's biweight, with a spread per plane); eliminating the offsets leaves three
 * unknowns. This is repeated with better axes and narrower bins, from coarse to fine. Standard errors come from blocks
 * of space (blocks.h). */
#include "stages/find_axes/planes.h"

#include <stdint.h>
#include <stdlib.h>

#include "common/math/rotation_fit.h"
#include "stages/find_axes/blocks.h"
#include "stages/find_axes/directions.h"

enum {
    CLASSES = 6,      /* axis and side */
    MAX_PLANES = 256, /* in total */
    BINS = 4096,      /* of a class's histogram */
    LEVELS = 3,
    ITERATIONS = 8,
    STEPS = 128, /* of a plane's histogram of distances */
    NONE = 255,  /* no class */
};
/* as fractions of the scene's size (blocks.h) */
static const double WIDTHS[LEVELS] = {0.03, 0.012, 0.006}; /* of bins, by level */
static const double MIN_SPREAD = 1e-6;
static const double BIWEIGHT = 4.685;

struct plane_search {
    const struct point_cloud *cloud;
    struct vec3 origin;
    struct mat3 axes;
    uint8_t *classes; /* of each point */
    double size;      /* of the scene */
    struct room_plane *planes;
    int count;
    int begin[CLASSES + 1]; /* planes of a class */
    double reach;
};

static double along(struct vec3 p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

static struct vec3 in_room(const struct plane_search *s, size_t i)
{
    return mat3_apply(s->axes, vec3_sub(s->cloud->points[i].position, s->origin));
}

static void classify(struct plane_search *s, double angle)
{
    const double min_cos = cos(angle * M_PI / 180);
    for (size_t i = 0; i < s->cloud->count; i++) {
        const struct vec3 n = mat3_apply(s->axes, cloud_normal(&s->cloud->points[i]));
        s->classes[i] = NONE;
        for (int k = 0; k < 3; k++)
            if (fabs(along(n, k)) > min_cos) s->classes[i] = (uint8_t)(2 * k + (along(n, k) > 0));
    }
}

/* Makes planes from the peaks of each class's histogram, highest first, down to min_plane of the points. */
static enum status find_peaks(struct plane_search *s, double width, double min_plane, struct err *err)
{
    size_t *histogram = calloc((size_t)CLASSES * BINS, sizeof *histogram);
    if (!histogram) return err_nomem(err, "a histogram", CLASSES * BINS * sizeof *histogram);
    for (size_t i = 0; i < s->cloud->count; i++) {
        if (s->classes[i] == NONE) continue;
        const double at = along(in_room(s, i), s->classes[i] / 2) / width + BINS / 2.0;
        if (at >= 1 && at < BINS - 1) histogram[s->classes[i] * BINS + (int)at]++;
    }
    s->count = 0;
    for (int c = 0; c < CLASSES; c++) {
        size_t *h = histogram + (size_t)c * BINS;
        s->begin[c] = s->count;
        while (s->count < MAX_PLANES) {
            int best = 1;
            for (int i = 1; i < BINS - 1; i++)
                if (h[i - 1] + h[i] + h[i + 1] > h[best - 1] + h[best] + h[best + 1]) best = i;
            const double mass = (double)(h[best - 1] + h[best] + h[best + 1]);
            if (!(mass > 0) || mass < min_plane * (double)s->cloud->count) break;
            const double middle = ((double)h[best + 1] - (double)h[best - 1]) / mass;
            s->planes[s->count++] = (struct room_plane){.axis = c / 2,
                                                        .side = c % 2 ? 1 : -1,
                                                        .offset = (best + 0.5 + middle - BINS / 2.0) * width,
                                                        .spread = width / 2};
            for (int i = best - 2; i <= best + 2; i++)
                if (i >= 0 && i < BINS) h[i] = 0;
        }
    }
    s->begin[CLASSES] = s->count;
    free(histogram);
    return ST_OK;
}

/* The nearest plane within reach of a point of its class, and its distance; -1: none. */
static int plane_of(const struct plane_search *s, size_t i, struct vec3 p, double *distance)
{
    const int c = s->classes[i];
    int best = -1;
    if (c == NONE) return -1;
    for (int j = s->begin[c]; j < s->begin[c + 1]; j++) {
        const double d = along(p, c / 2) - s->planes[j].offset;
        if (best >= 0 && !(fabs(d) < fabs(*distance))) continue;
        best = j;
        *distance = d;
    }
    return best >= 0 && fabs(*distance) < s->reach ? best : -1;
}

static double weight(const struct room_plane *plane, double distance)
{
    const double u = distance / (BIWEIGHT * plane->spread);
    return fabs(u) < 1 ? (1 - u * u) * (1 - u * u) : 0;
}

/* Derivative of a point's height over its plane with respect to the rotation of the axes: p x axis. */
static struct vec3 lever(struct vec3 p, int axis)
{
    return axis == 0 ? vec3_make(0, p.z, -p.y) : axis == 1 ? vec3_make(-p.z, 0, p.x) : vec3_make(p.y, -p.x, 0);
}

struct plane_sums { /* weighted sums over a plane's points */
    double w, d;
    struct vec3 lever, lever_d;
    struct mat3 lever_lever;
    size_t histogram[STEPS], count;
};

static void add_outer(struct mat3 *m, struct vec3 a, double w)
{
    const double v[3] = {a.x, a.y, a.z};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) m->m[i][j] += w * v[i] * v[j];
}

static void sum_up(const struct plane_search *s, struct plane_sums *sums)
{
    for (size_t i = 0; i < s->cloud->count; i++) {
        double d;
        const struct vec3 p = in_room(s, i);
        const int j = plane_of(s, i, p, &d);
        if (j < 0) continue;
        struct plane_sums *q = &sums[j];
        const double w = weight(&s->planes[j], d);
        const struct vec3 a = lever(p, s->planes[j].axis);
        q->histogram[(int)(fabs(d) / s->reach * STEPS)]++;
        q->count += w > 0;
        q->w += w;
        q->d += w * d;
        q->lever = vec3_add(q->lever, vec3_scale(a, w));
        q->lever_d = vec3_add(q->lever_d, vec3_scale(a, w * d));
        add_outer(&q->lever_lever, a, w);
    }
}

static double median_of(const struct plane_sums *q, double reach)
{
    size_t all = 0, seen = 0;
    int at = 0;
    for (int i = 0; i < STEPS; i++) all += q->histogram[i];
    while (at < STEPS - 1 && 2 * (seen + q->histogram[at]) < all) seen += q->histogram[at++];
    const double part = q->histogram[at] ? ((double)all / 2 - (double)seen) / (double)q->histogram[at] : 0.5;
    return reach * (at + part) / STEPS;
}

/* A Gauss-Newton step: the rotation, then every plane's offset and spread. *information: of the rotation. */
static void step(struct plane_search *s, const struct plane_sums *sums, bool turn, struct mat3 *information)
{
    struct mat3 unknown;
    struct vec3 right = {0}, w = {0};
    *information = (struct mat3){0};
    for (int j = 0; j < s->count; j++) {
        const struct plane_sums *q = &sums[j];
        const double scale = 1 / (s->planes[j].spread * s->planes[j].spread);
        if (!(q->w > 0)) continue;
        const struct vec3 mean = vec3_scale(q->lever, 1 / q->w);
        right = vec3_add(right, vec3_scale(vec3_sub(q->lever_d, vec3_scale(mean, q->d)), scale));
        for (int i = 0; i < 9; i++) information->m[i / 3][i % 3] += scale * q->lever_lever.m[i / 3][i % 3];
        add_outer(information, mean, -scale * q->w);
    }
    if (turn) w = vec3_scale(mat3_apply(rotation_inverse_of_known(*information, &unknown), right), -1);
    s->axes = rotation_turn(s->axes, w);
    for (int j = 0; j < s->count; j++) {
        const struct plane_sums *q = &sums[j];
        struct room_plane *p = &s->planes[j];
        p->count = q->count;
        if (!(q->w > 0)) continue;
        p->offset += q->d / q->w + vec3_dot(w, vec3_scale(q->lever, 1 / q->w));
        p->spread = fmin(fmax(median_of(q, s->reach) / 0.6745, MIN_SPREAD * s->size), s->reach);
    }
}

/* ----------------------------------------------------------------------------------------------------------- errors */

/* Rotations that the planes do not determine keep the error that they had. */
static enum status find_errors(const struct plane_search *s, const struct plane_sums *sums,
                               const struct mat3 *information, struct vec3 *tilt, struct err *err)
{
    struct vec3 *gradients = calloc((size_t)BLOCKS * CLASSES, sizeof *gradients);
    struct mat3 unknown;
    if (!gradients) return err_nomem(err, "blocks", BLOCKS * CLASSES * sizeof *gradients);
    for (size_t i = 0; i < s->cloud->count; i++) {
        double d;
        const struct vec3 p = in_room(s, i);
        const int j = plane_of(s, i, p, &d);
        if (j < 0 || !(sums[j].w > 0)) continue;
        const struct room_plane *plane = &s->planes[j];
        const double w = weight(plane, d) / (plane->spread * plane->spread);
        const struct vec3 a = vec3_sub(lever(p, plane->axis), vec3_scale(sums[j].lever, 1 / sums[j].w));
        struct vec3 *g = &gradients[block_of(p, s->size) * CLASSES + s->classes[i]];
        *g = vec3_add(*g, vec3_scale(a, w * d));
    }
    const struct mat3 inverse = rotation_inverse_of_known(*information, &unknown);
    const struct vec3 errors = rotation_sandwich(inverse, gradients, BLOCKS * CLASSES);
    tilt->x = hypot(errors.x, sqrt(fmax(unknown.m[0][0], 0)) * tilt->x);
    tilt->y = hypot(errors.y, sqrt(fmax(unknown.m[1][1], 0)) * tilt->y);
    tilt->z = hypot(errors.z, sqrt(fmax(unknown.m[2][2], 0)) * tilt->z);
    free(gradients);
    return ST_OK;
}

enum status planes_find(struct room_planes *planes, struct mat3 *axes, bool turn, struct vec3 *tilt_error,
                        struct vec3 origin, const struct point_cloud *cloud, const struct axes_params *params,
                        struct err *err)
{
    struct plane_search s = {.cloud = cloud, .origin = origin, .axes = *axes};
    struct plane_sums *sums = malloc(MAX_PLANES * sizeof *sums);
    struct mat3 information = {0};
    *planes = (struct room_planes){0};
    s.classes = malloc(cloud->count + 1);
    s.planes = calloc(MAX_PLANES, sizeof *s.planes);
    if (sums && s.classes && s.planes)
        block_cloud_size(&s.size, cloud, origin, err);
    else
        err_nomem(err, "planes", cloud->count + MAX_PLANES * sizeof *sums);
    for (int level = 0; !err->status && level < LEVELS && s.size > 0; level++) {
        const double width = WIDTHS[level] * s.size;
        classify(&s, params->plane_angle);
        find_peaks(&s, width, params->min_plane, err);
        s.reach = 2 * width;
        for (int i = 0; !err->status && i < ITERATIONS; i++) {
            for (int j = 0; j < s.count; j++) sums[j] = (struct plane_sums){0};
            sum_up(&s, sums);
            step(&s, sums, turn, &information);
        }
    }
    if (!err->status && s.count && turn) find_errors(&s, sums, &information, tilt_error, err);
    if (!err->status) {
        *axes = s.axes;
        planes->planes = s.planes;
        planes->count = s.count;
        s.planes = NULL;
    }
    free(s.planes);
    free(s.classes);
    free(sums);
    return err->status;
}

void planes_release(struct room_planes *planes)
{
    if (!planes) return;
    free(planes->planes);
    *planes = (struct room_planes){0};
}
