/* rays.c - see rays.h. */
#include "stages/suggest_model/rays.h"

#include <stdlib.h>

enum { COLUMNS = 64, MOST_RAYS = 8 };
static const double BEHIND = 1.04; /* of the nearest depth in a cell: what lies farther is hidden */

void ray_list_release(struct ray_list *list)
{
    if (!list) return;
    free(list->rays);
    *list = (struct ray_list){0};
}

/* The cell of the view's depth buffer, -1 where the point is not in its picture; *z its depth. */
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

struct seen {
    int view;
    double distance;
};

enum status rays_find(struct ray_list *list, const struct point_cloud *cloud, const struct view *views, int view_count,
                      struct err *err)
{
    const size_t cells = (size_t)COLUMNS * COLUMNS * (size_t)view_count;
    float *nearest = malloc((cells + 1) * sizeof *nearest);
    size_t room = 0;
    enum status st = nearest ? ST_OK : err_nomem(err, "depth buffers", cells * sizeof *nearest);
    *list = (struct ray_list){0};
    for (size_t i = 0; !st && i < cells; i++) nearest[i] = 1e30f;
    for (int v = 0; !st && v < view_count; v++)
        for (size_t i = 0; i < cloud->count; i++) {
            double z;
            const int at = cell_of(&views[v], &cloud->points[i], &z);
            float *n = &nearest[(size_t)v * COLUMNS * COLUMNS + (size_t)(at < 0 ? 0 : at)];
            if (at >= 0 && z < *n) *n = (float)z;
        }
    for (size_t i = 0; !st && i < cloud->count; i++) {
        struct seen seen[MOST_RAYS];
        const int most = cloud->points[i].views < MOST_RAYS ? cloud->points[i].views : MOST_RAYS;
        int count = 0;
        for (int v = 0; v < view_count; v++) {
            double z;
            const int at = cell_of(&views[v], &cloud->points[i], &z);
            if (at < 0 || z > BEHIND * (double)nearest[(size_t)v * COLUMNS * COLUMNS + (size_t)at]) continue;
            const double d = vec3_length(vec3_sub(views[v].center, cloud->points[i].position));
            if (count == most && d >= seen[most - 1].distance) continue;
            int k = count < most ? count++ : most - 1;
            for (; k > 0 && seen[k - 1].distance > d; k--) seen[k] = seen[k - 1];
            seen[k] = (struct seen){v, d};
        }
        if (list->count + (size_t)count > room) {
            room = 2 * room + 4096;
            struct ray *more = realloc(list->rays, room * sizeof *more);
            if (!more) {
                st = err_nomem(err, "lines of sight", room * sizeof *more);
                break;
            }
            list->rays = more;
        }
        for (int k = 0; k < count; k++) list->rays[list->count++] = (struct ray){seen[k].view, i};
    }
    free(nearest);
    if (st) ray_list_release(list);
    return st;
}
