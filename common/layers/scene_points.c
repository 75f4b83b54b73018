/* scene_points.c - see scene_points.h. */
#include "common/layers/scene_points.h"

#include <stdlib.h>

#define CENTRAL_PART 0.5 /* of the picture's width and height */

enum status scene_points_collect(struct scene_points *points, const struct layer_scene *scene, struct err *err)
{
    const struct camera_set *set = scene->set;
    size_t max_count = 1;
    for (int i = 0; i < set->view_count; i++) max_count += (size_t)scene->depths[i].segment_count;
    *points = (struct scene_points){.points = malloc(max_count * sizeof *points->points)};
    if (!points->points) return err_nomem(err, "the points of a scene", max_count * sizeof *points->points);
    for (int i = 0; i < set->view_count; i++)
        for (int k = 0; k < scene->depths[i].segment_count; k++) {
            const struct view *v = &set->views[i];
            const struct segment_shape *shape = &scene->views[i].shapes[k];
            const double *plane = scene->depths[i].segments[k].plane;
            const double inverse = plane[0] * shape->u + plane[1] * shape->v + plane[2];
            if (!(inverse > 0) || !(shape->pixels > 0)) continue;
            const double across = fabs(2 * shape->u / v->width - 1), down = fabs(2 * shape->v / v->height - 1);
            points->points[points->count++] =
                (struct scene_point){view_unproject(v, shape->u, shape->v, 1 / inverse), shape->pixels, i,
                                     across <= CENTRAL_PART && down <= CENTRAL_PART};
        }
    if (points->count) return ST_OK;
    scene_points_release(points);
    return err_set(err, ST_DATA, "none of the %d depth maps has a segment with a depth: there is no scene to move in.",
                   set->view_count);
}

void scene_points_release(struct scene_points *points)
{
    if (!points) return;
    free(points->points);
    *points = (struct scene_points){0};
}
