/* model_rays.c - see model_rays.h. */
#include "common/light/model_rays.h"

#include <string.h>

#include "common/base/parallel.h"

enum { ROWS = 4 };

enum status model_rays_make(struct ray_scene *rays, const struct solid_mesh *mesh, bool glass, struct err *err)
{
    struct solid_triangles triangles = {0};
    enum status st = solid_mesh_triangulate(&triangles, mesh, err);
    for (int i = 0; !st && i < triangles.count; i++) {
        const struct solid_triangle *t = &triangles.triangles[i];
        struct vec3 corners[3];
        if (!glass && !strncmp(mesh->bodies[mesh->faces[t->face].body].name, "glass/", 6)) continue;
        for (int k = 0; k < 3; k++) corners[k] = mesh->vertices[t->v[k]].p;
        if (!(vec3_length(vec3_cross(vec3_sub(corners[1], corners[0]), vec3_sub(corners[2], corners[0]))) > 0))
            continue;
        st = ray_scene_add_triangle(rays, corners, (uint32_t)t->face, err);
    }
    if (!st) st = ray_scene_commit(rays, err);
    solid_triangles_release(&triangles);
    return st;
}

struct view_job {
    int32_t *face;
    float *z;
    const struct ray_scene *rays;
    const struct view *camera;
    struct mat3 turn;
};

static void trace_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct view_job *job = ctx;
    const struct view *c = job->camera;
    const size_t width = (size_t)c->width;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (size_t x = 0; x < width; x += RAY_PACKET) {
            struct vec3 from[RAY_PACKET], direction[RAY_PACKET];
            struct ray_hit hits[RAY_PACKET];
            const size_t count = width - x < RAY_PACKET ? width - x : RAY_PACKET;
            for (size_t k = 0; k < count; k++) {
                const struct vec3 ray = {((double)(x + k) + 0.5 - c->cx) / c->fx, ((double)y + 0.5 - c->cy) / c->fy, 1};
                from[k] = c->center;
                direction[k] = mat3_apply(job->turn, ray);
            }
            const unsigned hit = ray_scene_hit_packet(job->rays, from, direction, (1u << count) - 1, hits);
            for (size_t k = 0; k < count; k++) {
                const size_t at = y * width + x + k;
                job->face[at] = hit >> k & 1 ? (int32_t)hits[k].id : -1;
                if (job->z) job->z[at] = hit >> k & 1 ? (float)hits[k].t : 0;
            }
        }
}

void model_rays_view(int32_t *face, float *z, const struct ray_scene *rays, const struct view *camera)
{
    struct view_job job = {face, z, rays, camera, mat3_transpose(camera->cam_from_world)};
    parallel_for((size_t)camera->height, ROWS, trace_rows, &job);
}
