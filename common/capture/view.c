/* view.c - projection into a rectified view, and views changed for a lens or a size. */
#include "common/capture/view.h"

double view_project(const struct view *view, struct vec3 world, double *u, double *v)
{
    struct vec3 p = vec3_add(mat3_apply(view->cam_from_world, world), view->translation);
    if (p.z > 0) {
        *u = view->fx * (p.x / p.z) + view->cx;
        *v = view->fy * (p.y / p.z) + view->cy;
    }
    return p.z;
}

struct vec3 view_unproject(const struct view *view, double u, double v, double z)
{
    struct vec3 p = vec3_make((u - view->cx) / view->fx * z, (v - view->cy) / view->fy * z, z);
    return mat3_apply(mat3_transpose(view->cam_from_world), vec3_sub(p, view->translation));
}

struct view view_from_lens_point(const struct view *camera, double a, double b, double focus)
{
    const struct vec3 offset = mat3_apply(mat3_transpose(camera->cam_from_world), vec3_make(a, b, 0));
    struct view v = *camera;

    v.center = vec3_add(camera->center, offset);
    v.translation.x -= a;
    v.translation.y -= b;
    v.cx += camera->fx * a / focus;
    v.cy += camera->fy * b / focus;
    return v;
}

void view_resize(struct view *view, int width, int height)
{
    const double x = (double)width / view->width, y = (double)height / view->height;
    view->fx *= x;
    view->cx *= x;
    view->fy *= y;
    view->cy *= y;
    view->width = width;
    view->height = height;
}
