/* placed_thing.c - see placed_thing.h. */
#include "common/relight/placed_thing.h"

struct vec3 placed_thing_place(const struct placed_thing *p, struct vec3 at)
{
    return vec3_add(mat3_apply(p->turn, at), p->shift);
}

struct view placed_thing_camera(const struct placed_thing *p, const struct view *camera)
{
    struct view v = *camera;
    v.cam_from_world = mat3_multiply(camera->cam_from_world, p->turn);
    v.center = mat3_apply(mat3_transpose(p->turn), vec3_sub(camera->center, p->shift));
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, v.center), -1);
    return v;
}

struct vec3 placed_thing_origin(const struct placed_thing *p, struct vec3 at)
{
    return mat3_apply(mat3_transpose(p->turn), vec3_sub(at, p->shift));
}
