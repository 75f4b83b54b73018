/* thin_points.c - merges points by cube and direction.
 *
 * Points are sorted by a key of cube and direction, so that the order of the result, and of each sum, depends on the
 * points alone. A mean over a cube is not pulled to the cube's middle: where a plane passes through two cubes, their
 * two means, weighted by their numbers of points, have the plane's position again. */
#include "stages/suggest_model/thin_points.h"

#include <stdlib.h>

#include "common/math/numbers.h"

enum { AXIS_BITS = 19, DIRECTIONS = 10 };

struct keyed {
    uint64_t key;
    size_t point;
};

static int compare(const void *a, const void *b)
{
    const struct keyed *x = a, *y = b;
    if (x->key != y->key) return x->key < y->key ? -1 : 1;
    return (x->point > y->point) - (x->point < y->point);
}

static uint64_t direction_of(const struct cloud_point *p)
{
    const double up = (double)p->normal[2];
    if (fabs(up) > 0.7) return up > 0 ? 8 : 9;
    const int sector = (int)floor((atan2((double)p->normal[1], (double)p->normal[0]) / PI + 1) * 4 + 0.5);
    return (uint64_t)sector % 8;
}

static uint64_t key_of(const struct cloud_point *p, double edge)
{
    const double at[3] = {p->position.x, p->position.y, p->position.z};
    const double most = 1 << (AXIS_BITS - 1);
    uint64_t key = 0;
    for (int k = 0; k < 3; k++)
        key = key << AXIS_BITS | (uint64_t)(clamp(floor(at[k] / edge), 1 - most, most - 1) + most);
    return key * DIRECTIONS + direction_of(p);
}

void thin_points_release(struct thin_points *thin)
{
    if (!thin) return;
    point_cloud_release(&thin->cloud);
    free(thin->weight);
    *thin = (struct thin_points){0};
}

/* The mean of a run of points. */
static struct cloud_point mean_of(const struct point_cloud *cloud, const struct keyed *run, size_t count,
                                  double *weight)
{
    struct vec3 position = {0, 0, 0}, normal = {0, 0, 0};
    struct cloud_point mean = cloud->points[run[0].point];
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        const struct cloud_point *p = &cloud->points[run[i].point];
        position = vec3_add(position, p->position);
        normal = vec3_add(normal, cloud_normal(p));
        if (p->views > mean.views) mean.views = p->views;
        sum += (double)p->confidence;
    }
    mean.position = vec3_scale(position, 1 / (double)count);
    if (vec3_length(normal) > 0) cloud_set_normal(&mean, vec3_normalize(normal));
    mean.confidence = (float)(sum / (double)count);
    *weight = sum;
    return mean;
}

enum status points_thin(struct thin_points *thin, const struct point_cloud *cloud, double edge, struct err *err)
{
    const size_t count = cloud->count;
    *thin = (struct thin_points){.cloud = {.points = malloc((count + 1) * sizeof *cloud->points), .cell = edge}};
    struct keyed *keyed = malloc((count + 1) * sizeof *keyed);
    thin->weight = malloc((count + 1) * sizeof *thin->weight);
    if (!keyed || !thin->weight || !thin->cloud.points) err_nomem(err, "points", count * sizeof *cloud->points);
    if (!err->status) {
        for (size_t i = 0; i < count; i++) keyed[i] = (struct keyed){key_of(&cloud->points[i], edge), i};
        qsort(keyed, count, sizeof *keyed, compare);
        for (size_t i = 0, end; i < count; i = end) {
            double weight;
            for (end = i + 1; end < count && keyed[end].key == keyed[i].key;) end++;
            thin->cloud.points[thin->cloud.count] = mean_of(cloud, keyed + i, end - i, &weight);
            thin->weight[thin->cloud.count++] = (float)weight;
        }
    }
    free(keyed);
    if (err->status) thin_points_release(thin);
    return err->status;
}
