/* model_clearance.c - how far points and straight ways are from the surfaces of a solid model.
 *
 * The distance between a segment and a triangle that do not meet is between an end of the segment and the triangle, or
 * between the segment and an edge of the triangle. All three kinds are computed exactly, so no thin wall or pane lies
 * between points that were looked at. A segment that keeps a positive distance from all surfaces is inside a solid as a
 * whole or not at all, so that one of its points decides.
 *
 * A point is inside closed surfaces where the solid angles under which it sees their triangles add up to 4 pi (the
 * winding number is 1), and outside where they cancel. A triangle's solid angle is that of [vanOosterom 1983]. On a
 * surface the sum is not defined, so the distance is looked at first. */
#include "common/light/model_clearance.h"

#include <math.h>

#define ON_SURFACE 1e-6 /* of the model's size */

static double clamp_share(double x) { return fmin(1, fmax(0, x)); }

/* The least distance between two segments p + s d and q + t e, s and t in [0, 1]; either may be a point. */
static double segments_distance(struct vec3 p, struct vec3 d, struct vec3 q, struct vec3 e)
{
    const struct vec3 r = vec3_sub(p, q);
    const double dd = vec3_dot(d, d), ee = vec3_dot(e, e), de = vec3_dot(d, e), dr = vec3_dot(d, r),
                 er = vec3_dot(e, r);
    const double det = dd * ee - de * de;
    /* parallel segments: any s will do, as t then follows and s follows from t */
    double s = det > 1e-14 * dd * ee ? clamp_share((de * er - ee * dr) / det) : 0;
    const double t = ee > 0 ? clamp_share((de * s + er) / ee) : 0;
    s = dd > 0 ? clamp_share((de * t - dr) / dd) : 0;
    return vec3_length(vec3_sub(vec3_add(r, vec3_scale(d, s)), vec3_scale(e, t)));
}

/* Whether the foot of p on the triangle's plane is in the triangle. normal: of any length but 0. */
static bool is_over(struct vec3 p, const struct vec3 corner[3], struct vec3 normal)
{
    for (int k = 0; k < 3; k++) {
        const struct vec3 edge = vec3_sub(corner[(k + 1) % 3], corner[k]);
        if (vec3_dot(vec3_cross(edge, vec3_sub(p, corner[k])), normal) < 0) return false;
    }
    return true;
}

double clearance_of_triangle(struct vec3 from, struct vec3 to, const struct vec3 corner[3])
{
    const struct vec3 way = vec3_sub(to, from);
    const struct vec3 normal = vec3_cross(vec3_sub(corner[1], corner[0]), vec3_sub(corner[2], corner[0]));
    const double length = vec3_length(normal);
    double least = INFINITY;
    for (int k = 0; k < 3; k++)
        least = fmin(least, segments_distance(from, way, corner[k], vec3_sub(corner[(k + 1) % 3], corner[k])));
    if (!(length > 0)) return least;
    const double a = vec3_dot(vec3_sub(from, corner[0]), normal) / length;
    const double b = vec3_dot(vec3_sub(to, corner[0]), normal) / length;
    if (is_over(from, corner, normal)) least = fmin(least, fabs(a));
    if (is_over(to, corner, normal)) least = fmin(least, fabs(b));
    if (a * b < 0 && is_over(vec3_add(from, vec3_scale(way, a / (a - b))), corner, normal)) return 0;
    return least;
}

static bool boxes_are_apart(double a, double b, double c0, double c1, double c2, double margin)
{
    return fmin(a, b) - margin > fmax(c0, fmax(c1, c2)) || fmax(a, b) + margin < fmin(c0, fmin(c1, c2));
}

/* Whether a segment is nearer than `margin` to a surface. */
static bool is_near(const struct model_rays *m, struct vec3 from, struct vec3 to, double margin)
{
    for (int i = 0; i < m->rays.triangle_count; i++) {
        const struct vec3 *c = m->rays.triangles[i].corner;
        if (boxes_are_apart(from.x, to.x, c[0].x, c[1].x, c[2].x, margin) ||
            boxes_are_apart(from.y, to.y, c[0].y, c[1].y, c[2].y, margin) ||
            boxes_are_apart(from.z, to.z, c[0].z, c[1].z, c[2].z, margin))
            continue;
        if (clearance_of_triangle(from, to, c) < margin) return true;
    }
    return false;
}

/* The solid angle of a triangle from p, positive if its normal points away from p. */
static double solid_angle(const struct vec3 corner[3], struct vec3 p)
{
    const struct vec3 a = vec3_sub(corner[0], p), b = vec3_sub(corner[1], p), c = vec3_sub(corner[2], p);
    const double la = vec3_length(a), lb = vec3_length(b), lc = vec3_length(c);
    const double triple = vec3_dot(a, vec3_cross(b, c));
    return 2 * atan2(triple, la * lb * lc + vec3_dot(a, b) * lc + vec3_dot(b, c) * la + vec3_dot(c, a) * lb);
}

static bool winds_around(const struct model_rays *m, struct vec3 p)
{
    double sum = 0;
    for (int i = 0; i < m->rays.triangle_count; i++) sum += solid_angle(m->rays.triangles[i].corner, p);
    return sum > 2 * M_PI;
}

bool model_rays_inside(const struct model_rays *m, struct vec3 p, double margin)
{
    return is_near(m, p, p, margin) || winds_around(m, p);
}

bool model_rays_enclose(const struct model_rays *m, struct vec3 p)
{
    return model_rays_inside(m, p, ON_SURFACE * model_rays_size(m));
}

double model_rays_gap(const struct model_rays *m, struct vec3 from, struct vec3 direction, bool *front)
{
    struct ray_hit hit;
    if (!ray_scene_hit(&m->rays, from, direction, &hit)) return INFINITY;
    if (front) *front = hit.front;
    return hit.t;
}

bool model_rays_way_is_free(const struct model_rays *m, struct vec3 from, struct vec3 to, double margin)
{
    return !is_near(m, from, to, margin) && !winds_around(m, from);
}
