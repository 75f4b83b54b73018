/* traced_model.c - see traced_model.h. */
#include "stages/evaluate/traced_model.h"

#include <math.h>
#include <string.h>

#include "common/base/parallel.h"

enum { ROWS = 4 };

enum status traced_model_read(struct traced_model *m, const char *path, struct err *err)
{
    struct solid_triangles triangles = {0};
    *m = (struct traced_model){.ids = 1};
    enum status st = solid_mesh_read(&m->mesh, path, err);
    if (!st) st = solid_mesh_triangulate(&triangles, &m->mesh, err);
    for (int i = 0; !st && i < triangles.count; i++) {
        const struct solid_triangle *t = &triangles.triangles[i];
        struct vec3 corners[3];
        if (!strncmp(m->mesh.bodies[m->mesh.faces[t->face].body].name, "glass/", 6)) continue;
        for (int k = 0; k < 3; k++) corners[k] = m->mesh.vertices[t->v[k]].p;
        if (!(vec3_length(vec3_cross(vec3_sub(corners[1], corners[0]), vec3_sub(corners[2], corners[0]))) > 0))
            continue;
        st = ray_scene_add_triangle(&m->rays, corners, (uint32_t)t->face, err);
    }
    if (!st) st = ray_scene_commit(&m->rays, err);
    for (int i = 0; !st && i < m->mesh.name_count; i++)
        if (m->mesh.names[i].id >= m->ids) m->ids = m->mesh.names[i].id + 1;
    solid_triangles_release(&triangles);
    if (st) traced_model_release(m);
    return st;
}

void traced_model_release(struct traced_model *m)
{
    ray_scene_release(&m->rays);
    solid_mesh_release(&m->mesh);
    *m = (struct traced_model){0};
}

struct trace_job {
    uint32_t *ids;
    float *distance;
    const struct traced_model *model;
    const struct model_frame *frame;
    const struct true_picture *camera;
    const struct vec3 *points;
    struct vec3 from; /* the camera's centre, in the model's frame */
    struct mat3 world_from_camera;
};

static void hit_pixel(const struct trace_job *job, size_t i, const struct ray_hit *hit)
{
    const struct solid_face *f = &job->model->mesh.faces[hit->id];
    job->ids[i] = (uint32_t)solid_face_id(&job->model->mesh, (int)hit->id);
    if (!job->points || !(vec3_length(job->points[i]) > 0)) return;
    const struct vec3 p = mat3_apply(job->world_from_camera, vec3_sub(job->points[i], job->camera->pose.translation));
    const double off = vec3_dot(f->normal, model_from_truth_point(job->frame, p)) - f->offset;
    job->distance[i] = (float)(fabs(off) * truth_per_model_unit(job->frame));
}

static void trace_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct trace_job *job = ctx;
    const int width = job->camera->lens.width;
    (void)thread;
    for (size_t i = begin * (size_t)width; i < end * (size_t)width; i += RAY_PACKET) {
        struct vec3 from[RAY_PACKET], direction[RAY_PACKET], ray;
        struct ray_hit hits[RAY_PACKET];
        unsigned active = 0;
        for (size_t k = 0; k < RAY_PACKET && i + k < end * (size_t)width; k++) {
            const size_t at = i + k, x = at % (size_t)width, y = at / (size_t)width;
            job->ids[at] = 0;
            job->distance[at] = 0;
            if (!camera_unproject(&job->camera->lens, (double)x + 0.5, (double)y + 0.5, &ray)) continue;
            from[k] = job->from;
            direction[k] = model_from_truth_direction(job->frame, mat3_apply(job->world_from_camera, ray));
            active |= 1u << k;
        }
        const unsigned hit = active ? ray_scene_hit_packet(&job->model->rays, from, direction, active, hits) : 0;
        for (size_t k = 0; k < RAY_PACKET; k++)
            if (hit >> k & 1) hit_pixel(job, i + k, &hits[k]);
    }
}

void traced_model_faces(uint32_t *ids, float *distance, const struct traced_model *m, const struct model_frame *frame,
                        const struct true_picture *camera, const struct vec3 *points)
{
    struct trace_job job = {ids, distance, m, frame, camera, points, {0, 0, 0}, {{{0}}}};
    job.from = model_from_truth_point(frame, pose_center(&camera->pose));
    job.world_from_camera = mat3_transpose(mat3_from_quat(camera->pose.rotation));
    parallel_for((size_t)camera->lens.height, ROWS, trace_rows, &job);
}
