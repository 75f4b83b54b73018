/* view_faces.c - see view_faces.h.
 *
 * A jump lies between two neighbouring pixels of different surfaces if neither surface, continued to the other's pixel,
 * has the other's depth there: at the corner of two walls both agree, at the edge of a doorway neither does. */
#include "stages/trace_ids/view_faces.h"

#include <math.h>
#include <stdlib.h>

#include "common/math/distance.h"

static const double JUMP = 0.02; /* relative difference of depth */

struct plane_view { /* faces as a camera sees them: 1/z is linear in the pixel */
    const struct solid_mesh *mesh;
    const struct view *camera;
    struct mat3 turn;
};

/* Depth of the plane of a face at a pixel; 0 or below: it is not met there. */
static double plane_depth(const struct plane_view *v, int face, int x, int y)
{
    const struct view *c = v->camera;
    const struct solid_face *f = &v->mesh->faces[face];
    const struct vec3 ray = {(x + 0.5 - c->cx) / c->fx, (y + 0.5 - c->cy) / c->fy, 1};
    const double along = vec3_dot(f->normal, mat3_apply(v->turn, ray));
    const double z = (f->offset - vec3_dot(f->normal, c->center)) / along;
    return isfinite(z) ? z : 0;
}

static bool is_same_surface(const struct solid_mesh *mesh, int a, int b)
{
    const struct solid_face *p = &mesh->faces[a], *q = &mesh->faces[b];
    return a == b || (p->name == q->name && vec3_dot(p->normal, q->normal) > 1 - 1e-9 &&
                      fabs(p->offset - q->offset) <= 1e-6 * (1 + fabs(p->offset)));
}

static bool is_jump(const struct plane_view *v, const struct view_faces *f, int x0, int y0, int x1, int y1)
{
    const size_t p = (size_t)y0 * (size_t)f->width + (size_t)x0, q = (size_t)y1 * (size_t)f->width + (size_t)x1;
    if (f->face[p] < 0 || f->face[q] < 0) return f->face[p] != f->face[q];
    if (is_same_surface(v->mesh, f->face[p], f->face[q])) return false;
    const double there = plane_depth(v, f->face[p], x1, y1), here = plane_depth(v, f->face[q], x0, y0);
    const bool meets_there = there > 0 && fabs(there / f->z[q] - 1) < JUMP;
    const bool meets_here = here > 0 && fabs(here / f->z[p] - 1) < JUMP;
    return !meets_there && !meets_here;
}

static enum status find_jumps(struct view_faces *f, const struct plane_view *v, struct err *err)
{
    const size_t pixels = (size_t)f->width * (size_t)f->height;
    uint8_t *level = malloc(pixels);
    if (!level) return err_nomem(err, "jumps", pixels);
    for (size_t i = 0; i < pixels; i++) level[i] = 1;
    for (int y = 0; y < f->height; y++)
        for (int x = 0; x < f->width; x++) {
            const size_t at = (size_t)y * (size_t)f->width + (size_t)x;
            if (x + 1 < f->width && is_jump(v, f, x, y, x + 1, y)) level[at] = level[at + 1] = 0;
            if (y + 1 < f->height && is_jump(v, f, x, y, x, y + 1)) level[at] = level[at + (size_t)f->width] = 0;
        }
    enum status st = distance_squared(f->jump, level, f->width, f->height, err);
    for (size_t i = 0; !st && i < pixels; i++) f->jump[i] = fminf(sqrtf(f->jump[i]), JUMP_MAX);
    free(level);
    return st;
}

enum status view_faces_trace(struct view_faces *f, const struct solid_mesh *mesh, const struct ray_scene *rays,
                             const struct view *camera, struct err *err)
{
    const size_t pixels = (size_t)camera->width * (size_t)camera->height;
    const struct plane_view v = {mesh, camera, mat3_transpose(camera->cam_from_world)};
    *f = (struct view_faces){camera->width,
                             camera->height,
                             malloc(pixels * sizeof *f->face),
                             malloc(pixels * sizeof *f->z),
                             malloc(pixels * sizeof *f->jump),
                             calloc(pixels, sizeof *f->clutter)};
    if (!f->face || !f->z || !f->jump || !f->clutter) return err_nomem(err, "a view's faces", pixels * sizeof *f->z);
    model_rays_view(f->face, f->z, rays, camera);
    return find_jumps(f, &v, err);
}

void view_faces_release(struct view_faces *f)
{
    free(f->face);
    free(f->z);
    free(f->jump);
    free(f->clutter);
    *f = (struct view_faces){0};
}
