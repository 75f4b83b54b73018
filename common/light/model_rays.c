/* model_rays.c - pictures of a solid model by ray tracing.
 *
 * A picture is traced in packets of neighbouring pixels of a row. Embree works in single precision; which face a ray
 * hits comes from there, and everything else is computed from the face's plane in double precision, so that a depth
 * does not depend on how the face was cut into triangles.
 *
 * A plane n . p = o of the model is seen by a pinhole camera at c with a depth whose inverse is linear in the pixel:
 * the ray through (u, v) is c + z d, with d = R^T ((u - cx) / fx, (v - cy) / fy, 1), so 1 / z = n . d / (o - n . c). */
#include "common/light/model_rays.h"

#include <math.h>
#include <string.h>

#include "common/base/parallel.h"

enum { ROWS = 4 };

static enum status build(struct model_rays *m, enum model_glass glass, const struct model_extra *extra, struct err *err)
{
    struct solid_triangles triangles = {0};
    m->ids = 1;
    solid_mesh_triangulate(&triangles, &m->mesh, err);
    for (int i = 0; !err->status && i < triangles.count; i++) {
        const struct solid_triangle *t = &triangles.triangles[i];
        struct vec3 corners[3];
        if (glass == MODEL_WITHOUT_GLASS && solid_face_is_pane(&m->mesh, t->face)) continue;
        for (int k = 0; k < 3; k++) corners[k] = m->mesh.vertices[t->v[k]].p;
        if (!(vec3_length(vec3_cross(vec3_sub(corners[1], corners[0]), vec3_sub(corners[2], corners[0]))) > 0))
            continue;
        ray_scene_add_triangle(&m->rays, corners, (uint32_t)t->face, err);
    }
    for (int i = 0; !err->status && extra && i < extra->count; i++)
        ray_scene_add_triangle(&m->rays, extra->triangles[i], (uint32_t)(m->mesh.face_count + i), err);
    if (!err->status) ray_scene_commit(&m->rays, err);
    for (int i = 0; !err->status && i < m->mesh.name_count; i++)
        if (m->mesh.names[i].id >= m->ids) m->ids = m->mesh.names[i].id + 1;
    solid_triangles_release(&triangles);
    return err->status;
}

enum status model_rays_build(struct model_rays *m, enum model_glass glass, struct err *err)
{
    return build(m, glass, NULL, err);
}

enum status model_rays_read_with(struct model_rays *m, const char *path, enum model_glass glass,
                                 const struct model_extra *extra, struct provenance *prov, struct err *err)
{
    *m = (struct model_rays){0};
    if (!solid_mesh_read(&m->mesh, path, prov, err)) build(m, glass, extra, err);
    if (err->status) model_rays_release(m);
    return err->status;
}

enum status model_rays_read(struct model_rays *m, const char *path, enum model_glass glass, struct provenance *prov,
                            struct err *err)
{
    return model_rays_read_with(m, path, glass, NULL, prov, err);
}

void model_rays_release(struct model_rays *m)
{
    if (!m) return;
    ray_scene_release(&m->rays);
    solid_mesh_release(&m->mesh);
    *m = (struct model_rays){0};
}

void model_rays_bounds(const struct model_rays *m, struct vec3 *low, struct vec3 *high)
{
    *low = *high = m->mesh.vertex_count ? m->mesh.vertices[0].p : vec3_make(0, 0, 0);
    for (int i = 1; i < m->mesh.vertex_count; i++) {
        const struct vec3 p = m->mesh.vertices[i].p;
        *low = vec3_make(p.x < low->x ? p.x : low->x, p.y < low->y ? p.y : low->y, p.z < low->z ? p.z : low->z);
        *high = vec3_make(p.x > high->x ? p.x : high->x, p.y > high->y ? p.y : high->y, p.z > high->z ? p.z : high->z);
    }
}

double model_rays_size(const struct model_rays *m)
{
    struct vec3 low, high;
    model_rays_bounds(m, &low, &high);
    const struct vec3 side = vec3_sub(high, low);
    return fmax(side.x, fmax(side.y, side.z));
}

double model_rays_height(const struct model_rays *m)
{
    struct vec3 low, high;
    model_rays_bounds(m, &low, &high);
    return high.z - low.z;
}

double model_rays_area(const struct model_rays *m)
{
    double sum = 0;
    for (int i = 0; i < m->mesh.face_count; i++) sum += solid_mesh_area(&m->mesh, i);
    return sum;
}

bool model_rays_near(const struct model_rays *m, struct vec3 p)
{
    struct vec3 low, high;
    model_rays_bounds(m, &low, &high);
    return m->mesh.vertex_count && p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y &&
           p.z <= high.z;
}

struct picture_job {
    uint32_t *faces;
    const struct model_rays *model;
    struct vec3 from;
    int width;
    model_ray_fn *direction;
    const void *ctx;
};

static void trace_packet(const struct picture_job *job, int x, int y)
{
    struct vec3 from[RAY_PACKET], direction[RAY_PACKET];
    struct ray_hit hits[RAY_PACKET];
    uint32_t *faces = job->faces + (size_t)y * (size_t)job->width + x;
    const int count = job->width - x < RAY_PACKET ? job->width - x : RAY_PACKET;
    unsigned active = 0;
    for (int k = 0; k < count; k++) {
        faces[k] = 0;
        from[k] = job->from;
        if (job->direction(job->ctx, x + k, y, &direction[k])) active |= 1u << k;
    }
    const unsigned hit = active ? ray_scene_hit_packet(&job->model->rays, from, direction, active, hits) : 0;
    for (int k = 0; k < count; k++)
        if (hit >> k & 1) faces[k] = hits[k].id + 1;
}

static void trace_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct picture_job *job = ctx;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < job->width; x += RAY_PACKET) trace_packet(job, x, (int)y);
}

void model_rays_picture(uint32_t *faces, const struct model_rays *m, struct vec3 from, int width, int height,
                        model_ray_fn *direction, const void *ctx)
{
    struct picture_job job = {faces, m, from, width, direction, ctx};
    parallel_for((size_t)height, ROWS, trace_rows, &job);
}

struct pinhole {
    struct view view;
    struct mat3 model_from_cam;
};

static bool pinhole_ray(const void *ctx, int x, int y, struct vec3 *direction)
{
    const struct pinhole *p = ctx;
    const struct view *v = &p->view;
    *direction = mat3_apply(p->model_from_cam, vec3_make((x + 0.5 - v->cx) / v->fx, (y + 0.5 - v->cy) / v->fy, 1));
    return true;
}

void model_rays_view(uint32_t *faces, const struct model_rays *m, const struct view *view)
{
    const struct pinhole p = {*view, mat3_transpose(view->cam_from_world)};
    model_rays_picture(faces, m, view->center, view->width, view->height, pinhole_ray, &p);
}

void model_face_inverse_depth(double plane[3], const struct solid_face *face, const struct view *view)
{
    const struct vec3 n = mat3_apply(view->cam_from_world, face->normal);
    const double off = face->offset - vec3_dot(face->normal, view->center);
    const double scale = off != 0 ? 1 / off : 0;
    plane[0] = scale * n.x / view->fx;
    plane[1] = scale * n.y / view->fy;
    plane[2] = scale * n.z - plane[0] * view->cx - plane[1] * view->cy;
}
