/* frame_points.c - evidence for blank walls.
 *
 * Photos of blank walls match nothing, so that there are no points on them. Their feet and heads are straight edges
 * (find_frame); between the two the wall is taken as seen. A wall that few places show counts less. */
#include "stages/suggest_model/frame_points.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"

#define FULL_SUPPORT 5.0 /* places that show a wall, for points of confidence 1 */
#define MOST_POINTS  2000000

enum status frame_points_add(struct point_cloud *cloud, const struct room_frame *frame, const struct model_axes *axes,
                             double height, double edge, struct err *err)
{
    size_t room = cloud->count;
    for (int k = 0; !err->status && k < frame->wall_count; k++) {
        const struct frame_wall *w = &frame->walls[k];
        const struct vec3 along = frame->headings[w->heading].along, across = frame_across(frame, w->heading),
                          normal = model_from_world_direction(axes, vec3_scale(across, w->side));
        const double length = (w->to - w->from) * axes->scale;
        const int columns = (int)(length / edge), rows = (int)(height / edge);
        if (w->support < 2 || columns < 1 || (double)columns * rows > MOST_POINTS) continue;
        for (int i = 0; !err->status && i < columns; i++) {
            const struct vec3 foot = model_from_world_point(
                axes, vec3_add(vec3_scale(across, w->offset),
                               vec3_scale(along, w->from + (i + 0.5) * (w->to - w->from) / columns)));
            if (array_reserve(&cloud->points, &room, cloud->count + (size_t)rows, sizeof *cloud->points, "points", err))
                break;
            for (int j = 0; j < rows; j++) {
                struct cloud_point p = {.position = {foot.x, foot.y, (j + 0.5) * height / rows},
                                        .views = (uint16_t)(w->support < 65535 ? w->support : 65535),
                                        .confidence = (float)fmin(1, w->support / FULL_SUPPORT)};
                cloud_set_normal(&p, vec3_normalize(vec3_make(normal.x, normal.y, 0)));
                cloud->points[cloud->count++] = p;
            }
        }
    }
    return err->status;
}
