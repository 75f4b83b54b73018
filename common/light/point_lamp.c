/* point_lamp.c - see point_lamp.h. */
#include "common/light/point_lamp.h"

#include <math.h>

double point_lamp_factor(const struct model_rays *model, enum point_lamp_kind kind, struct vec3 lamp, struct vec3 at,
                         struct vec3 normal)
{
    const struct vec3 d = vec3_sub(lamp, at);
    const double r2 = vec3_dot(d, d), shines = kind == POINT_LAMP_ROUND ? sqrt(r2) : d.z;
    if (shines <= 0 || vec3_dot(d, normal) <= 0) return 0;
    const struct vec3 from = vec3_add(at, vec3_scale(normal, 4 * model->rays.epsilon));
    if (ray_scene_blocked(&model->rays, from, vec3_sub(lamp, from), 1)) return 0;
    return vec3_dot(d, normal) * shines / (r2 * r2);
}
