/* traced_model.c - see traced_model.h. */
#include "stages/evaluate/scene/traced_model.h"

#include <math.h>

struct true_camera {
    const struct model_frame *frame;
    const struct true_picture *camera;
    struct mat3 world_from_camera;
};

static bool true_ray(const void *ctx, int x, int y, struct vec3 *direction)
{
    const struct true_camera *c = ctx;
    struct vec3 ray;
    if (!camera_unproject(&c->camera->lens, x + 0.5, y + 0.5, &ray)) return false;
    *direction = model_from_truth_direction(c->frame, mat3_apply(c->world_from_camera, ray));
    return true;
}

/* The distance of a point in the camera's axes from a face's plane. */
static float plane_distance(const struct true_camera *c, const struct solid_face *f, struct vec3 point)
{
    const struct vec3 p = mat3_apply(c->world_from_camera, vec3_sub(point, c->camera->pose.translation));
    const double off = vec3_dot(f->normal, model_from_truth_point(c->frame, p)) - f->offset;
    return (float)(fabs(off) * model_frame_truth_per_unit(c->frame));
}

void traced_model_faces(uint32_t *ids, float *distance, const struct model_rays *m, const struct model_frame *frame,
                        const struct true_picture *camera, const struct vec3 *points)
{
    const struct true_camera c = {frame, camera, mat3_transpose(mat3_from_quat(camera->pose.rotation))};
    const size_t pixels = (size_t)camera->lens.width * (size_t)camera->lens.height;
    model_rays_picture(ids, m, model_from_truth_point(frame, pose_center(&camera->pose)), camera->lens.width,
                       camera->lens.height, true_ray, &c);
    for (size_t i = 0; i < pixels; i++) {
        const int face = (int)ids[i] - 1;
        distance[i] = 0;
        if (face < 0) continue;
        if (points && vec3_length(points[i]) > 0) distance[i] = plane_distance(&c, &m->mesh.faces[face], points[i]);
        ids[i] = (uint32_t)solid_face_id(&m->mesh, face);
    }
}
