/* heights.c - heights of floor and ceiling.
 *
 * [Colburn 2014, 4.4.1]: the heights of points with normals within 25 degrees of up are grouped into three clusters
 * by k-means; the largest is the floor. Here k-means is solved exactly (stages/find_axes/kmeans1d.h). Furniture
 * pulls the mean of its cluster, so a cluster only gives a range of heights: the height is the densest window in
 * that range, about 2.5 cm of a room, refined to the robust mean around it (Tukey's biweight). The ceiling is not in
 * the source.
 *
 * Which cluster. For the floor the lowest one whose densest window is not much emptier than the densest of all: tables
 * and chairs may share a larger cluster than the floor's, but not a height; and a table or a bed near the cameras may
 * have more points than the floor, but nothing is below that. For the ceiling the highest one that is not small: beams
 * and lamps below it may have more and sharper points, but nothing is above it.
 *
 * Error. The robust mean is an M-estimator: with weights w and distances d its standard error is that of the
 * gradient sum w d over the slope sum (w d)'. Neighbouring points err alike, so gradients are summed over blocks of
 * space, and the blocks count as independent (blocks.h). A tilt of the axes moves the height by the tilt times the
 * distance of the points' middle from the origin, which is added in squares.
 *
 * O(n log n) for n points, by sorting; windows and ranges are then found in one pass or by binary search. */
#include "stages/find_axes/heights.h"

#include <stdlib.h>

#include "common/base/sort.h"
#include "stages/find_axes/blocks.h"
#include "stages/find_axes/directions.h"
#include "stages/find_axes/kmeans1d.h"

enum { CLUSTERS = 3, ITERATIONS = 20 };
/* as fractions of the scene's size (blocks.h) */
static const double WINDOW = 0.008; /* for the densest heights: about 2.5 cm of a room */
static const double REACH = 0.02;   /* max distance of points that count for a level */
static const double MIN_SPREAD = 1e-6;
static const double MIN_CLUSTER = 0.2; /* of a ceiling, as a fraction of the largest cluster */
static const double MIN_WINDOW = 0.4;  /* of a floor, as a fraction of the densest window */
/* spreads at which a point's weight is zero: fewer than the usual 4.685, because points near a floor or ceiling
 * (carpets, beams, rounded corners) lie on one side of it and bias the mean */
static const double BIWEIGHT = 2;
static const double MIN_SLOPE = 0.1; /* as a fraction of the sum of weights: for heights without a peak */

struct height_point {
    struct vec3 p; /* in the axes, from the origin */
    size_t at;     /* in the cloud: a total order */
};

static int by_height(const void *a, const void *b)
{
    const struct height_point *x = a, *y = b;
    if (x->p.z != y->p.z) return x->p.z < y->p.z ? -1 : 1;
    return (x->at > y->at) - (x->at < y->at);
}

static enum status collect(struct height_point **places, double **heights, size_t *count, int side,
                           const struct mat3 *axes, struct vec3 origin, const struct point_cloud *cloud, double angle,
                           struct err *err)
{
    const double min_cos = cos(angle * M_PI / 180);
    const struct vec3 up = vec3_make(side * axes->m[2][0], side * axes->m[2][1], side * axes->m[2][2]);
    *count = 0;
    for (int pass = 0; pass < 2; pass++) {
        size_t n = 0;
        for (size_t i = 0; i < cloud->count; i++) {
            if (vec3_dot(cloud_normal(&cloud->points[i]), up) < min_cos) continue;
            const struct vec3 p = mat3_apply(*axes, vec3_sub(cloud->points[i].position, origin));
            if (!(side * p.z < 0)) continue;
            if (pass) (*places)[n] = (struct height_point){p, i};
            n++;
        }
        *count = n;
        if (pass) break;
        *places = malloc((n + 1) * sizeof **places);
        *heights = malloc((n + 1) * sizeof **heights);
        if (!*places || !*heights) return err_nomem(err, "points that look up or down", n * sizeof **places);
    }
    qsort(*places, *count, sizeof **places, by_height);
    for (size_t i = 0; i < *count; i++) (*heights)[i] = (*places)[i].p.z;
    return ST_OK;
}

/* The middle of the densest window of heights[begin .. end); returns the number of heights in it. */
static size_t densest(double *middle, const double *heights, size_t begin, size_t end, double window)
{
    size_t first = begin, best = begin, max_count = 0;
    for (size_t i = begin; i < end; i++) {
        while (heights[i] - heights[first] > window) first++;
        if (i - first + 1 <= max_count) continue;
        max_count = i - first + 1;
        best = first;
    }
    *middle = (heights[best] + heights[best + max_count - 1]) / 2;
    return max_count;
}

static bool is_lower(const void *height, const void *value) { return *(const double *)height < *(const double *)value; }

/* The first height that is at least `value`. */
static size_t lower_bound(const double *heights, size_t count, double value)
{
    return sort_place(heights, count, sizeof *heights, is_lower, &value);
}

static double weight(double distance, double spread)
{
    const double u = distance / (BIWEIGHT * spread);
    return fabs(u) < 1 ? (1 - u * u) * (1 - u * u) : 0;
}

/* Derivative of weight times distance. */
static double weight_slope(double distance, double spread)
{
    const double u = distance / (BIWEIGHT * spread);
    return fabs(u) < 1 ? (1 - u * u) * (1 - 5 * u * u) : 0;
}

/* Robust mean of the heights within REACH, started at level->height. scratch: as large as heights. */
static void refine_level(struct height_level *level, const double *heights, size_t count, double size, double *scratch)
{
    for (int round = 0; round < ITERATIONS; round++) {
        const size_t begin = lower_bound(heights, count, level->height - REACH * size);
        const size_t end = lower_bound(heights, count, level->height + REACH * size);
        double sum = 0, all = 0;
        if (begin == end) return;
        for (size_t i = begin; i < end; i++) scratch[i - begin] = fabs(heights[i] - level->height);
        sort_doubles(scratch, end - begin);
        level->spread = fmax(scratch[(end - begin) / 2] / 0.6745, MIN_SPREAD * size);
        level->count = 0;
        for (size_t i = begin; i < end; i++) {
            const double w = weight(heights[i] - level->height, level->spread);
            sum += w * (heights[i] - level->height);
            all += w;
            level->count += w > 0;
        }
        const double step = all > 0 ? sum / all : 0;
        level->height += step;
        if (fabs(step) < 1e-9 * size) return;
    }
}

/* Standard error of the height, from blocks of space and from the effect of a tilt at the middle of the points. */
static enum status find_error(struct height_level *level, const struct height_point *places, const double *heights,
                              size_t count, double size, struct vec3 tilt_error, struct err *err)
{
    double *sums = calloc(BLOCKS, sizeof *sums), all = 0, slope = 0, x = 0, y = 0, sum = 0;
    if (!sums) return err_nomem(err, "blocks", BLOCKS * sizeof *sums);
    for (size_t i = lower_bound(heights, count, level->height - REACH * size);
         i < count && heights[i] < level->height + REACH * size; i++) {
        const double d = heights[i] - level->height, w = weight(d, level->spread);
        sums[block_of(places[i].p, size)] += w * d;
        all += w;
        slope += weight_slope(d, level->spread);
        x += w * places[i].p.x;
        y += w * places[i].p.y;
    }
    for (int i = 0; i < BLOCKS; i++) sum += sums[i] * sums[i];
    free(sums);
    /* of an M-estimator: the gradient's error over its slope */
    if (all > 0)
        level->error =
            hypot(sqrt(sum) / fmax(slope, MIN_SLOPE * all), hypot(y / all * tilt_error.x, x / all * tilt_error.y));
    return ST_OK;
}

/* The height at which refinement starts: of the cluster that the head of this file names. */
static double initial_height(const double *heights, const size_t *begin, int k, int side, double window)
{
    double middle[CLUSTERS] = {0};
    size_t count[CLUSTERS] = {0}, largest = 0;
    size_t most = 0;
    int lowest = 0, highest = k - 1;
    for (int j = 0; j < k; j++) {
        count[j] = densest(&middle[j], heights, begin[j], begin[j + 1], window);
        if (count[j] > most) most = count[j];
        if (begin[j + 1] - begin[j] > largest) largest = begin[j + 1] - begin[j];
    }
    while ((double)count[lowest] < MIN_WINDOW * (double)most) lowest++;
    while ((double)(begin[highest + 1] - begin[highest]) < MIN_CLUSTER * (double)largest) highest--;
    return middle[side > 0 ? lowest : highest];
}

enum status height_find_level(struct height_level *level, int side, const struct mat3 *axes, struct vec3 origin,
                              struct vec3 tilt_error, const struct point_cloud *cloud, const struct axes_params *params,
                              struct err *err)
{
    struct height_point *places = NULL;
    double *heights = NULL, *scratch = NULL, size = 0;
    size_t count = 0, begin[CLUSTERS + 1];
    *level = (struct height_level){0};
    if (!block_cloud_size(&size, cloud, origin, err))
        collect(&places, &heights, &count, side, axes, origin, cloud, params->up_angle, err);
    level->candidates = count;
    const double part = side > 0 ? params->min_floor : params->min_ceiling;
    const double min_count = fmax(part * (double)cloud->count, 1);
    const int k = count < CLUSTERS ? (int)count : CLUSTERS;
    if (!err->status && (double)count >= min_count) {
        kmeans1d(begin, heights, count, k, err);
        scratch = malloc(count * sizeof *scratch);
        if (!err->status && !scratch) err_nomem(err, "heights", count * sizeof *scratch);
        if (!err->status) {
            level->height = initial_height(heights, begin, k, side, WINDOW * size);
            refine_level(level, heights, count, size, scratch);
            const double far = 2 * REACH * size;
            level->beyond = side > 0 ? lower_bound(heights, count, level->height - far)
                                     : count - lower_bound(heights, count, level->height + far);
            find_error(level, places, heights, count, size, tilt_error, err);
        }
    }
    free(scratch);
    free(places);
    free(heights);
    return err->status;
}
