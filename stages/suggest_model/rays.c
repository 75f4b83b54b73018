/* rays.c - lines of sight from points alone.
 *
 * A coarse depth buffer per view has 64 x 64 cells. Each point covers the cells that a cube of the cloud's grid covers,
 * so that a near surface has no gaps. The depth of a cell is that of its first surface: of the first 4 % of depth that
 * hold a twentieth of the weight of the cell's points, or a seventh of that of a surface with a point of usual weight
 * in each cube. Weights are divided by the square of the depth, as a far surface has more points in a cell. So stray
 * points in the air, which may be the nearest, hide nothing. A point less than 4 % behind that depth is visible. */
#include "stages/suggest_model/rays.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/sort.h"
#include "common/math/numbers.h"

enum { COLUMNS = 64, MAX_RAYS = 8 }; /* of a depth buffer, per side; of a point */
enum { STEPS = 512, WINDOW = 4 };    /* of depth in a cell; steps that a surface takes */
static const double BEHIND = 1.04;   /* times the depth of a cell: points farther away are hidden */
static const double STEP = 0.01;     /* of log depth */
static const double SHARE = 0.05;    /* of a cell's points: a surface, which hides what is behind it */
static const double DENSE = 0.15;    /* of the points of a surface without gaps: likewise */

void ray_list_release(struct ray_list *list)
{
    if (!list) return;
    free(list->rays);
    *list = (struct ray_list){0};
}

/* Where a point is in the view's depth buffer; false: outside the picture, or it faces away. *z: its depth. */
static bool find_place(const struct view *v, const struct cloud_point *p, double *column, double *row, double *z)
{
    double x, y;
    const struct vec3 to = vec3_sub(v->center, p->position);
    if (vec3_dot(to, cloud_normal(p)) <= 0) return false;
    *z = view_project(v, p->position, &x, &y);
    if (*z <= 0 || !(x >= 0 && y >= 0 && x < v->width && y < v->height)) return false;
    *column = x * COLUMNS / v->width;
    *row = y * COLUMNS / v->height;
    return true;
}

/* The point's cell, -1: none. */
static int cell_of(const struct view *v, const struct cloud_point *p, double *z)
{
    double column, row;
    return find_place(v, p, &column, &row, z) ? (int)row * COLUMNS + (int)column : -1;
}

struct sighting {
    int view;
    double distance;
};

/* Adds a point's weight to the cells that it covers, as large as its cube. */
static void add_point(float *steps, const struct view *v, const struct cloud_point *p, double edge, double nearest,
                      double weight)
{
    double column, row, z;
    if (!find_place(v, p, &column, &row, &z)) return;
    const double rx = 0.5 * edge * v->fx / z * COLUMNS / v->width, ry = 0.5 * edge * v->fy / z * COLUMNS / v->height;
    const int low[2] = {clamp_int((int)(column - rx), 0, COLUMNS - 1), clamp_int((int)(row - ry), 0, COLUMNS - 1)};
    const int high[2] = {clamp_int((int)(column + rx), 0, COLUMNS - 1), clamp_int((int)(row + ry), 0, COLUMNS - 1)};
    const int step = clamp_int((int)(log(z / nearest) / STEP), 0, STEPS - 1);
    const double part = weight / (z * z * (high[0] - low[0] + 1) * (high[1] - low[1] + 1));
    for (int y = low[1]; y <= high[1]; y++)
        for (int x = low[0]; x <= high[0]; x++) steps[(y * COLUMNS + x) * STEPS + step] += (float)part;
}

/* The depths of the view's cells. steps has room for COLUMNS x COLUMNS x STEPS. */
static void find_fronts(float *front, float *steps, const struct view *v, const struct point_cloud *cloud,
                        const float *weight, double median)
{
    double farthest = 0, z;
    memset(steps, 0, sizeof *steps * COLUMNS * COLUMNS * STEPS);
    for (size_t i = 0; i < cloud->count; i++)
        if (cell_of(v, &cloud->points[i], &z) >= 0) farthest = fmax(farthest, z);
    const double nearest = farthest * exp(-STEPS * STEP);
    const double angle = v->width / (v->fx * COLUMNS) * v->height / (v->fy * COLUMNS); /* solid, of a cell */
    const double full = cloud->cell > 0 ? median * angle / (cloud->cell * cloud->cell) : HUGE_VAL;
    for (size_t i = 0; i < cloud->count; i++)
        add_point(steps, v, &cloud->points[i], cloud->cell, nearest, (double)weight[i]);
    for (int at = 0; at < COLUMNS * COLUMNS; at++) {
        const float *s = &steps[at * STEPS];
        double sum = 0;
        int k = 0;
        for (int i = 0; i < STEPS; i++) sum += (double)s[i];
        const double least = fmin(SHARE * sum, DENSE * full);
        while (k < STEPS - WINDOW && (double)(s[k] + s[k + 1] + s[k + 2] + s[k + 3]) < least) k++;
        while (k < STEPS - 1 && !(s[k] > 0)) k++;
        front[at] = sum > 0 ? (float)(nearest * exp(k * STEP)) : HUGE_VALF;
    }
}

/* The weight above which half of all weight lies. sorted has room for the weights. */
static double middle_weight(float *sorted, const float *weight, size_t count)
{
    double sum = 0, below = 0;
    size_t i = 0;
    memcpy(sorted, weight, count * sizeof *sorted);
    sort_floats(sorted, count);
    for (size_t k = 0; k < count; k++) sum += (double)sorted[k];
    while (i + 1 < count && (below += (double)sorted[i]) < 0.5 * sum) i++;
    return count ? (double)sorted[i] : 0;
}

enum status rays_find(struct ray_list *list, const struct point_cloud *cloud, const float *weight,
                      const struct view *views, int view_count, struct err *err)
{
    const size_t cells = (size_t)COLUMNS * COLUMNS;
    float *fronts = malloc((cells * (size_t)view_count + 1) * sizeof *fronts);
    float *steps = malloc(cells * STEPS * sizeof *steps);
    float *sorted = malloc((cloud->count + 1) * sizeof *sorted);
    size_t capacity = 0;
    double median = 0;
    if (!sorted || !fronts || !steps) err_nomem(err, "depth buffers", cells * (size_t)view_count * sizeof *fronts);
    *list = (struct ray_list){0};
    if (!err->status) median = middle_weight(sorted, weight, cloud->count);
    for (int v = 0; !err->status && v < view_count; v++)
        find_fronts(fronts + (size_t)v * cells, steps, &views[v], cloud, weight, median);
    for (size_t i = 0; !err->status && i < cloud->count; i++) {
        struct sighting nearby[MAX_RAYS];
        const int max_count = cloud->points[i].views < MAX_RAYS ? cloud->points[i].views : MAX_RAYS;
        int count = 0;
        for (int v = 0; v < view_count; v++) {
            double z;
            const int at = cell_of(&views[v], &cloud->points[i], &z);
            if (at < 0 || z > BEHIND * (double)fronts[(size_t)v * cells + (size_t)at]) continue;
            const double d = vec3_length(vec3_sub(views[v].center, cloud->points[i].position));
            if (count == max_count && d >= nearby[max_count - 1].distance) continue;
            int k = count < max_count ? count++ : max_count - 1;
            for (; k > 0 && nearby[k - 1].distance > d; k--) nearby[k] = nearby[k - 1];
            nearby[k] = (struct sighting){v, d};
        }
        if (array_reserve(&list->rays, &capacity, list->count + (size_t)count, sizeof *list->rays, "lines of sight",
                          err))
            break;
        for (int k = 0; k < count; k++) list->rays[list->count++] = (struct ray){nearby[k].view, i};
    }
    free(sorted);
    free(steps);
    free(fronts);
    if (err->status) ray_list_release(list);
    return err->status;
}
