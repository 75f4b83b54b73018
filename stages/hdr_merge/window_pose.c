/* window_pose.c - the pose of a lighting reference image that looks straight out of a window.
 *
 * The rays of two pixels of the horizon span a horizontal plane, so that their cross product is the vertical in the
 * camera's frame, of two signs: the one that agrees better with the image's upwards direction. This gives roll and
 * pitch. The azimuth is that of the window: the image's axis points straight out. Without a horizon the camera counts
 * as level. What lies outside is looked up by direction alone, so that the place hardly matters. */
#include "stages/hdr_merge/window_pose.h"

#include <math.h>

#include "common/math/numbers.h"

static const double CLOSEST = 5, STEEPEST = 80; /* degrees: between the rays; between the axis and the horizontal */

static enum status find_up(struct vec3 *up, const struct window_pose *w, const struct camera *lens, struct err *err)
{
    struct vec3 rays[2];
    *up = vec3_make(0, -1, 0);
    if (w->level) return ST_OK;
    for (int k = 0; k < 2; k++)
        if (!camera_unproject(lens, w->horizon[k][0], w->horizon[k][1], &rays[k]))
            return err_set(err, ST_DATA, "the lens has no ray for the pixel %.9g, %.9g of the horizon.",
                           w->horizon[k][0], w->horizon[k][1]);
    const struct vec3 across = vec3_cross(rays[0], rays[1]);
    if (vec3_length(across) < sin(CLOSEST * DEGREE))
        return err_set(err, ST_DATA,
                       "the two pixels of the horizon are less than %g degrees apart, or opposite to each other; "
                       "mark it near the left and the right edge of the image.",
                       CLOSEST);
    *up = vec3_scale(vec3_normalize(across), across.y > 0 ? -1 : 1);
    return ST_OK;
}

enum status window_pose_find(struct pose *cam_from_model, const struct window_pose *w, const struct camera *lens,
                             struct err *err)
{
    static const struct vec3 axis = {0, 0, 1};
    struct vec3 up;
    if (find_up(&up, w, lens, err)) return err->status;
    const struct vec3 level = vec3_sub(axis, vec3_scale(up, vec3_dot(up, axis)));
    if (vec3_length(level) < cos(STEEPEST * DEGREE))
        return err_set(err, ST_DATA,
                       "the image looks up or down by more than %g degrees, so that its direction does not follow from "
                       "the window; mark corners of it instead.",
                       STEEPEST);
    /* the camera's vectors of the model's directions out, up and the third one */
    const struct vec3 f = vec3_normalize(level), g = vec3_cross(up, f), o = w->out;
    const struct vec3 side = vec3_cross(vec3_make(0, 0, 1), o);
    const struct mat3 turn = {{{f.x * o.x + g.x * side.x, f.x * o.y + g.x * side.y, up.x},
                               {f.y * o.x + g.y * side.x, f.y * o.y + g.y * side.y, up.y},
                               {f.z * o.x + g.z * side.x, f.z * o.y + g.z * side.y, up.z}}};
    *cam_from_model = (struct pose){quat_from_mat3(turn), vec3_scale(mat3_apply(turn, w->at), -1)};
    return ST_OK;
}
