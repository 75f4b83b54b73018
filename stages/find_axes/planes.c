/* planes.c - see planes.h.
 *
 * Points whose normals are near an axis, with its sign, are counted by their place along it; peaks of the counts are
 * planes. Of all planes together the turn of the axes and every plane's offset are found by robust least squares on the
 * points' distances (Tukey's biweight, with each plane's own spread); each plane's offset is eliminated, which leaves
 * three unknowns. Then planes are sought again with better axes and a narrower reach, from coarse to fine.
 * Standard errors come from blocks of space (blocks.h). */
#include "stages/find_axes/planes.h"

#include <stdint.h>
#include <stdlib.h>

#include "stages/find_axes/blocks.h"
#include "stages/find_axes/directions.h"

enum {
    CLASSES = 6,       /* axis and side */
    MOST_PLANES = 256, /* in all */
    BINS = 4096,       /* of a class's histogram */
    LEVELS = 3,
    ITERATIONS = 8,
    STEPS = 128, /* of a plane's histogram of distances */
    NONE = 255,  /* no class */
};
/* of the median distance of points from the origin */
static const double WIDTHS[LEVELS] = {0.03, 0.012, 0.006}; /* bins, from level to level */
static const double LEAST_SPREAD = 1e-6;
static const double BIWEIGHT = 4.685;

struct search {
    const struct point_cloud *cloud;
    struct vec3 origin;
    struct mat3 axes;
    uint8_t *classes; /* of each point */
    double size;      /* median distance of points from the origin */
    struct room_plane *planes;
    int count;
    int begin[CLASSES + 1]; /* planes of a class */
    double reach;
};

static double along(struct vec3 p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

static struct vec3 in_room(const struct search *s, size_t i)
{
    return mat3_apply(s->axes, vec3_sub(s->cloud->points[i].position, s->origin));
}

static void classify(struct search *s, double angle)
{
    const double least = cos(angle * M_PI / 180);
    for (size_t i = 0; i < s->cloud->count; i++) {
        const struct vec3 n = mat3_apply(s->axes, cloud_normal(&s->cloud->points[i]));
        s->classes[i] = NONE;
        for (int k = 0; k < 3; k++)
            if (fabs(along(n, k)) > least) s->classes[i] = (uint8_t)(2 * k + (along(n, k) > 0));
    }
}

/* Peaks of each class's histogram, those of most points first, until they have too few. */
static enum status seek(struct search *s, double width, double least, struct err *err)
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
        while (s->count < MOST_PLANES) {
            int best = 1;
            for (int i = 1; i < BINS - 1; i++)
                if (h[i - 1] + h[i] + h[i + 1] > h[best - 1] + h[best] + h[best + 1]) best = i;
            const double mass = (double)(h[best - 1] + h[best] + h[best + 1]);
            if (!(mass > 0) || mass < least * (double)s->cloud->count) break;
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

/* The plane on which a point lies, and its distance; -1: none. */
static int plane_of(const struct search *s, size_t i, struct vec3 p, double *distance)
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

/* How a point's height over its plane changes with a turn of the axes: by p x axis. */
static struct vec3 lever(struct vec3 p, int axis)
{
    return axis == 0 ? vec3_make(0, p.z, -p.y) : axis == 1 ? vec3_make(-p.z, 0, p.x) : vec3_make(p.y, -p.x, 0);
}

struct sums { /* of a plane's points, weighted */
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

static void sum_up(const struct search *s, struct sums *sums)
{
    for (size_t i = 0; i < s->cloud->count; i++) {
        double d;
        const struct vec3 p = in_room(s, i);
        const int j = plane_of(s, i, p, &d);
        if (j < 0) continue;
        struct sums *q = &sums[j];
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

static double median_of(const struct sums *q, double reach)
{
    size_t all = 0, seen = 0;
    int at = 0;
    for (int i = 0; i < STEPS; i++) all += q->histogram[i];
    while (at < STEPS - 1 && 2 * (seen + q->histogram[at]) < all) seen += q->histogram[at++];
    const double part = q->histogram[at] ? ((double)all / 2 - (double)seen) / (double)q->histogram[at] : 0.5;
    return reach * (at + part) / STEPS;
}

/* One step of Gauss and Newton: the turn, then every plane's offset and spread. *information: of the turn. */
static void step(struct search *s, const struct sums *sums, bool turn, struct mat3 *information)
{
    struct mat3 unknown;
    struct vec3 right = {0}, w = {0};
    *information = (struct mat3){0};
    for (int j = 0; j < s->count; j++) {
        const struct sums *q = &sums[j];
        const double scale = 1 / (s->planes[j].spread * s->planes[j].spread);
        if (!(q->w > 0)) continue;
        const struct vec3 mean = vec3_scale(q->lever, 1 / q->w);
        right = vec3_add(right, vec3_scale(vec3_sub(q->lever_d, vec3_scale(mean, q->d)), scale));
        for (int i = 0; i < 9; i++) information->m[i / 3][i % 3] += scale * q->lever_lever.m[i / 3][i % 3];
        add_outer(information, mean, -scale * q->w);
    }
    if (turn) w = vec3_scale(mat3_apply(inverse_of_known(*information, &unknown), right), -1);
    s->axes = turned_by(s->axes, w);
    for (int j = 0; j < s->count; j++) {
        const struct sums *q = &sums[j];
        struct room_plane *p = &s->planes[j];
        p->count = q->count;
        if (!(q->w > 0)) continue;
        p->offset += q->d / q->w + vec3_dot(w, vec3_scale(q->lever, 1 / q->w));
        p->spread = fmin(fmax(median_of(q, s->reach) / 0.6745, LEAST_SPREAD * s->size), s->reach);
    }
}

/* ----------------------------------------------------------------------------------------------------------- errors */

/* What the planes do not tell keeps the error that it had. */
static enum status find_errors(const struct search *s, const struct sums *sums, const struct mat3 *information,
                               struct vec3 *tilt, struct err *err)
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
    const struct mat3 inverse = inverse_of_known(*information, &unknown);
    const struct vec3 told = sandwich(inverse, gradients, BLOCKS * CLASSES);
    tilt->x = hypot(told.x, sqrt(fmax(unknown.m[0][0], 0)) * tilt->x);
    tilt->y = hypot(told.y, sqrt(fmax(unknown.m[1][1], 0)) * tilt->y);
    tilt->z = hypot(told.z, sqrt(fmax(unknown.m[2][2], 0)) * tilt->z);
    free(gradients);
    return ST_OK;
}

enum status find_planes(struct room_planes *planes, struct mat3 *axes, bool turn, struct vec3 *tilt_error,
                        struct vec3 origin, const struct point_cloud *cloud, const struct axes_params *params,
                        struct err *err)
{
    struct search s = {.cloud = cloud, .origin = origin, .axes = *axes};
    struct sums *sums = malloc(MOST_PLANES * sizeof *sums);
    struct mat3 information = {0};
    *planes = (struct room_planes){0};
    s.classes = malloc(cloud->count + 1);
    s.planes = calloc(MOST_PLANES, sizeof *s.planes);
    enum status st = sums && s.classes && s.planes
                         ? cloud_size(&s.size, cloud, origin, err)
                         : err_nomem(err, "planes", cloud->count + MOST_PLANES * sizeof *sums);
    for (int level = 0; !st && level < LEVELS && s.size > 0; level++) {
        const double width = WIDTHS[level] * s.size;
        classify(&s, params->plane_angle);
        st = seek(&s, width, params->least_plane, err);
        s.reach = 2 * width;
        for (int i = 0; !st && i < ITERATIONS; i++) {
            for (int j = 0; j < s.count; j++) sums[j] = (struct sums){0};
            sum_up(&s, sums);
            step(&s, sums, turn, &information);
        }
    }
    if (!st && s.count && turn) st = find_errors(&s, sums, &information, tilt_error, err);
    if (!st) {
        *axes = s.axes;
        planes->planes = s.planes;
        planes->count = s.count;
        s.planes = NULL;
    }
    free(s.planes);
    free(s.classes);
    free(sums);
    return st;
}

void room_planes_release(struct room_planes *planes)
{
    if (!planes) return;
    free(planes->planes);
    *planes = (struct room_planes){0};
}
