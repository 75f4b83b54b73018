/* rays.c - lines of sight from points alone.
 *
 * A coarse depth buffer per view holds the nearest point in each of 64 x 64 cells; a point within 4 % of that depth is
 * visible. */
#include "stages/suggest_model/rays.h"

#include <stdlib.h>

#include "common/base/array.h"

enum { COLUMNS = 64, MAX_RAYS = 8 }; /* of a depth buffer, per side; of a point */
static const double BEHIND = 1.04;   /* times the nearest depth in a cell: points farther away are hidden */

void ray_list_release(struct ray_list *list)
{
    if (!list) return;
    free(list->rays);
    *list = (struct ray_list){0};
}

/* The point's cell in the view's depth buffer, -1 if it is outside the picture or faces away; *z: its depth. */
static int cell_of(const struct view *v, const struct cloud_point *p, double *z)
{
    double x, y;
    const struct vec3 to = vec3_sub(v->center, p->position);
    if (vec3_dot(to, cloud_normal(p)) <= 0) return -1;
    *z = view_project(v, p->position, &x, &y);
    if (*z <= 0 || !(x >= 0 && y >= 0 && x < v->width && y < v->height)) return -1;
    const int column = (int)(x * COLUMNS / v->width), row = (int)(y * COLUMNS / v->height);
    return row * COLUMNS + column;
}

struct sighting {
    int view;
    double distance;
};

enum status rays_find(struct ray_list *list, const struct point_cloud *cloud, const struct view *views, int view_count,
                      struct err *err)
{
    const size_t cells = (size_t)COLUMNS * COLUMNS * (size_t)view_count;
    float *nearest = malloc((cells + 1) * sizeof *nearest);
    size_t capacity = 0;
    if (!nearest) err_nomem(err, "depth buffers", cells * sizeof *nearest);
    *list = (struct ray_list){0};
    for (size_t i = 0; !err->status && i < cells; i++) nearest[i] = 1e30f;
    for (int v = 0; !err->status && v < view_count; v++)
        for (size_t i = 0; i < cloud->count; i++) {
            double z;
            const int at = cell_of(&views[v], &cloud->points[i], &z);
            float *n = &nearest[(size_t)v * COLUMNS * COLUMNS + (size_t)(at < 0 ? 0 : at)];
            if (at >= 0 && z < *n) *n = (float)z;
        }
    for (size_t i = 0; !err->status && i < cloud->count; i++) {
        struct sighting nearby[MAX_RAYS];
        const int max_count = cloud->points[i].views < MAX_RAYS ? cloud->points[i].views : MAX_RAYS;
        int count = 0;
        for (int v = 0; v < view_count; v++) {
            double z;
            const int at = cell_of(&views[v], &cloud->points[i], &z);
            if (at < 0 || z > BEHIND * (double)nearest[(size_t)v * COLUMNS * COLUMNS + (size_t)at]) continue;
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
    free(nearest);
    if (err->status) ray_list_release(list);
    return err->status;
}
