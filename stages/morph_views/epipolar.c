/* epipolar.c - epipolar lines [Hartley 2004, 9] from posed cameras with lens distortion, or from a fundamental matrix.
 *
 * Posed: the ray of a pixel is projected into the other photo at two depths; the line passes through both images. A
 * distorting lens makes it a curve, which is replaced by its chord, or by the tangent at a given point. 1/z runs nearly
 * linearly along the curve, which locates the point. Fundamental matrix: the line is F p, or F' p in the other
 * direction; a pose recovered for a guessed focal length says which direction along it is nearer. */
#include "stages/morph_views/epipolar.h"

#include <math.h>

#define TANGENT    0.02 /* half length of the chord that replaces a tangent, of the range of 1/z */
#define MIN_SPREAD 0.05 /* px, between the images of the nearest and the farthest depth; less gives no line */

static bool line_through(double u0, double v0, double u1, double v1, struct epipolar_line *line)
{
    double dx = u1 - u0, dy = v1 - v0, length = hypot(dx, dy);
    if (!(length > MIN_SPREAD) || !isfinite(length)) return false;
    dx /= length;
    dy /= length;
    *line = (struct epipolar_line){(float)dx, (float)dy, (float)(dy * u0 - dx * v0)};
    return true;
}

/* Image in the other film of the point at depth z on a ray of photo `from`; z may be infinite. False: not visible. */
static bool project_at_depth(const struct pair_geometry *g, int from, struct vec3 ray, double z, double *u, double *v)
{
    const struct posed_photo *a = &g->photos[from], *b = &g->photos[!from];
    struct mat3 world_from_a = mat3_transpose(a->photo_from_world);
    struct vec3 at;
    if (isinf(z)) {
        at = mat3_apply(b->photo_from_world, mat3_apply(world_from_a, ray));
    } else {
        struct vec3 p = vec3_scale(ray, z / ray.z);
        struct vec3 world = mat3_apply(world_from_a, vec3_sub(p, a->translation));
        at = vec3_add(mat3_apply(b->photo_from_world, world), b->translation);
    }
    double pu, pv;
    if (!camera_project(&b->lens, at, &pu, &pv)) return false;
    film_map(g->films[!from]->film_from_photo, pu, pv, u, v);
    return true;
}

static bool posed_line(const struct pair_geometry *g, int from, double x, double y, const double *at,
                       struct epipolar_line *line)
{
    const struct posed_photo *a = &g->photos[from];
    struct vec3 ray;
    double pu, pv, u0, v0, u1, v1, far = 1 / a->far, near = 1 / a->near;
    film_map(g->films[from]->photo_from_film, x, y, &pu, &pv);
    if (!camera_unproject(&a->lens, pu, pv, &ray) || ray.z <= 0) return false;
    if (!project_at_depth(g, from, ray, 1 / far, &u0, &v0) || !project_at_depth(g, from, ray, 1 / near, &u1, &v1))
        return false;
    double length = (u1 - u0) * (u1 - u0) + (v1 - v0) * (v1 - v0);
    if (at && length > MIN_SPREAD * MIN_SPREAD) { /* 1/z is nearly linear between the far and the near end */
        double part = ((at[0] - u0) * (u1 - u0) + (at[1] - v0) * (v1 - v0)) / length;
        double middle = far + (near - far) * fmin(fmax(part, 0), 1), half = (near - far) * TANGENT;
        struct epipolar_line tangent;
        if (project_at_depth(g, from, ray, 1 / fmax(middle - half, 0), &pu, &pv) &&
            project_at_depth(g, from, ray, 1 / (middle + half), &u1, &v1) && line_through(pu, pv, u1, v1, &tangent)) {
            *line = tangent;
            return true;
        }
        return false;
    }
    return line_through(u0, v0, u1, v1, line);
}

/* Image in the other picture of the point at 1/z = s on a ray of the guessed camera of picture `from`. */
static bool project_guessed(const struct pair_geometry *g, int from, double x, double y, double s, double *u, double *v)
{
    double ray[3] = {(x - g->width / 2.0) / g->focal, (y - g->height / 2.0) / g->focal, 1}, p[3];
    const double *r = g->rotation, *t = g->translation;
    for (int i = 0; i < 3; i++) {
        if (from == 0)
            p[i] = r[3 * i] * ray[0] + r[3 * i + 1] * ray[1] + r[3 * i + 2] * ray[2] + s * t[i];
        else
            p[i] = r[i] * (ray[0] - s * t[0]) + r[3 + i] * (ray[1] - s * t[1]) + r[6 + i] * (ray[2] - s * t[2]);
    }
    if (p[2] < 1e-3) return false;
    *u = g->focal * p[0] / p[2] + g->width / 2.0;
    *v = g->focal * p[1] / p[2] + g->height / 2.0;
    return true;
}

static bool fundamental_line(const struct pair_geometry *g, int from, double x, double y, struct epipolar_line *line)
{
    const double *f = g->fundamental;
    double l[3], u0, v0, u1, v1;
    for (int i = 0; i < 3; i++)
        l[i] = from == 0 ? f[3 * i] * x + f[3 * i + 1] * y + f[3 * i + 2] : f[i] * x + f[3 + i] * y + f[6 + i];
    double length = hypot(l[0], l[1]);
    if (!(length > 0)) return false;
    /* the line is l0 u + l1 v + l2 = 0, so that (l1, -l0) points along it */
    double dx = l[1] / length, dy = -l[0] / length, c = l[2] / length;
    if (project_guessed(g, from, x, y, 0.01, &u0, &v0) && project_guessed(g, from, x, y, 0.02, &u1, &v1) &&
        dx * (u1 - u0) + dy * (v1 - v0) < 0) {
        dx = -dx;
        dy = -dy;
        c = -c;
    }
    *line = (struct epipolar_line){(float)dx, (float)dy, (float)c};
    return true;
}

bool epipolar_line_at(const struct pair_geometry *g, int from, double x, double y, const double *at,
                      struct epipolar_line *line)
{
    switch (g->kind) {
    case EPIPOLAR_POSED:
        return posed_line(g, from, x, y, at, line);
    case EPIPOLAR_FUNDAMENTAL:
        return fundamental_line(g, from, x, y, line);
    default:
        return false;
    }
}
