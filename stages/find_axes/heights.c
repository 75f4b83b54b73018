/* heights.c - see heights.h.
 *
 * Thesis 4.4.1: heights of points whose normals are within 25 degrees of up, in three clusters by k-means; the largest is
 * the floor. k-means is solved exactly (stages/find_axes/kmeans1d.h). A cluster's mean is pulled by whatever furniture fell to it,
 * so that a cluster only says where to look: the height is the densest window within it, about 2.5 cm of a room, then a
 * robust mean around that (Tukey's biweight). */
#include "stages/find_axes/heights.h"

#include <stdlib.h>

#include "common/base/sort.h"
#include "stages/find_axes/blocks.h"
#include "stages/find_axes/directions.h"
#include "stages/find_axes/kmeans1d.h"

enum { CLUSTERS = 3, ITERATIONS = 20 };
/* of the scene's size */
static const double WINDOW = 0.008;  /* whose densest place is sought: about 2.5 cm of a room */
static const double REACH = 0.02;    /* around it, beyond which points never count */
static const double NOT_SMALL = 0.2; /* of the largest cluster */
static const double LEAST_SPREAD = 1e-6;
/* spreads beyond which points do not count: fewer than the usual 4.685, as what lies by a floor or a ceiling - carpets,
 * beams, what noise rounds off - lies on one side of it and pulls */
static const double BIWEIGHT = 2;
static const double LEAST_SLOPE = 0.1; /* of the weights' sum: heights without a peak */

struct place {
    struct vec3 p;
    size_t at; /* in the cloud: a total order */
};

static int by_height(const void *a, const void *b)
{
    const struct place *x = a, *y = b;
    if (x->p.z != y->p.z) return x->p.z < y->p.z ? -1 : 1;
    return (x->at > y->at) - (x->at < y->at);
}

static enum status collect(struct place **places, double **heights, size_t *count, int side, const struct mat3 *axes,
                           struct vec3 origin, const struct point_cloud *cloud, double angle, struct err *err)
{
    const double least = cos(angle * M_PI / 180);
    const struct vec3 up = vec3_make(side * axes->m[2][0], side * axes->m[2][1], side * axes->m[2][2]);
    *count = 0;
    for (int pass = 0; pass < 2; pass++) {
        size_t n = 0;
        for (size_t i = 0; i < cloud->count; i++) {
            if (vec3_dot(cloud_normal(&cloud->points[i]), up) < least) continue;
            const struct vec3 p = mat3_apply(*axes, vec3_sub(cloud->points[i].position, origin));
            if (!(side * p.z < 0)) continue;
            if (pass) (*places)[n] = (struct place){p, i};
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

/* The densest window of a range of heights: its middle; returns how many it holds. */
static size_t densest(double *middle, const double *heights, size_t begin, size_t end, double window)
{
    size_t first = begin, best = begin, most = 0;
    for (size_t i = begin; i < end; i++) {
        while (heights[i] - heights[first] > window) first++;
        if (i - first + 1 <= most) continue;
        most = i - first + 1;
        best = first;
    }
    *middle = (heights[best] + heights[best + most - 1]) / 2;
    return most;
}

static size_t lower_bound(const double *heights, size_t count, double value)
{
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (heights[middle] < value)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
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

/* Robust mean of the heights in reach, from *height on. scratch: room for all of them. */
static void settle(struct level *level, const double *heights, size_t count, double size, double *scratch)
{
    for (int round = 0; round < ITERATIONS; round++) {
        const size_t begin = lower_bound(heights, count, level->height - REACH * size);
        const size_t end = lower_bound(heights, count, level->height + REACH * size);
        double sum = 0, all = 0;
        if (begin == end) return;
        for (size_t i = begin; i < end; i++) scratch[i - begin] = fabs(heights[i] - level->height);
        sort_doubles(scratch, end - begin);
        level->spread = fmax(scratch[(end - begin) / 2] / 0.6745, LEAST_SPREAD * size);
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

/* From blocks of space, and from what a tilt does to the height at the points' middle, seen from the origin. */
static enum status find_error(struct level *level, const struct place *places, const double *heights, size_t count,
                              double size, struct vec3 tilt_error, struct err *err)
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
    /* an M-estimator's: what its blocks pull, over how fast the pull falls with the height */
    if (all > 0)
        level->error =
            hypot(sqrt(sum) / fmax(slope, LEAST_SLOPE * all), hypot(y / all * tilt_error.x, x / all * tilt_error.y));
    return ST_OK;
}

/* Where to begin. Of the floor's clusters the largest counts, by its densest window: tables and chairs may share a
 * cluster larger than the floor's, but not a height. What stands below a ceiling - beams, lamps, the heads of windows -
 * may show more than the ceiling does, and more sharply, and nothing is above it: its cluster is the highest that is not
 * small. */
static double level_to_begin_with(const double *heights, const size_t *begin, int k, int side, double window)
{
    double middle[CLUSTERS] = {0};
    size_t count[CLUSTERS] = {0}, most = 0;
    int densest_one = 0, highest = k - 1;
    for (int j = 0; j < k; j++) {
        count[j] = densest(&middle[j], heights, begin[j], begin[j + 1], window);
        if (count[j] > count[densest_one]) densest_one = j;
        if (begin[j + 1] - begin[j] > most) most = begin[j + 1] - begin[j];
    }
    while ((double)(begin[highest + 1] - begin[highest]) < NOT_SMALL * (double)most) highest--;
    return middle[side > 0 ? densest_one : highest];
}

enum status find_level(struct level *level, int side, const struct mat3 *axes, struct vec3 origin,
                       struct vec3 tilt_error, const struct point_cloud *cloud, const struct axes_params *params,
                       struct err *err)
{
    struct place *places = NULL;
    double *heights = NULL, *scratch = NULL, size = 0;
    size_t count = 0, begin[CLUSTERS + 1];
    *level = (struct level){0};
    enum status st = cloud_size(&size, cloud, origin, err);
    if (!st) st = collect(&places, &heights, &count, side, axes, origin, cloud, params->up_angle, err);
    level->asked = count;
    const double part = side > 0 ? params->least_floor : params->least_ceiling;
    const double least = fmax(part * (double)cloud->count, 1);
    const int k = count < CLUSTERS ? (int)count : CLUSTERS;
    if (!st && (double)count >= least) {
        st = kmeans1d(begin, heights, count, k, err);
        scratch = malloc(count * sizeof *scratch);
        if (!st && !scratch) st = err_nomem(err, "heights", count * sizeof *scratch);
        if (!st) {
            level->height = level_to_begin_with(heights, begin, k, side, WINDOW * size);
            settle(level, heights, count, size, scratch);
            const double far = 2 * REACH * size;
            level->beyond = side > 0 ? lower_bound(heights, count, level->height - far)
                                     : count - lower_bound(heights, count, level->height + far);
            st = find_error(level, places, heights, count, size, tilt_error, err);
        }
    }
    free(scratch);
    free(places);
    free(heights);
    return st;
}
