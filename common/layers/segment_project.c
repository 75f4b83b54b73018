/* segment_project.c - projection of planar segments into a novel camera.
 *
 * A segment's plane p = (a, b, c), 1/z = p . (u, v, 1), and the relative pose X_view = R X_novel + t give, in pixels,
 *   M = K_view R K_novel^-1,   k = K_view t,   m = M^T p / (1 - p . k)
 *   1/z_novel = m . (x, y, 1),   (u, v, 1) ~ (M + k m^T) (x, y, 1)
 * the homography that the plane induces [Hartley 2004, 13.1]. The segment is not visible if 1 - p . k <= 0: the novel
 * camera is behind the plane.
 *
 * drawn_view.c does the same for four segments at once, with the same bits: keep the order of operations in both. */
#include "common/layers/segment_project.h"

#include <math.h>
#include <string.h>

static struct mat3 intrinsics(const struct view *v)
{
    return (struct mat3){{{v->fx, 0, v->cx}, {0, v->fy, v->cy}, {0, 0, 1}}};
}

static struct mat3 intrinsics_inverse(const struct view *v)
{
    return (struct mat3){{{1 / v->fx, 0, -v->cx / v->fx}, {0, 1 / v->fy, -v->cy / v->fy}, {0, 0, 1}}};
}

/* M and k of the pair of cameras. */
static void relate(double m[3][3], double k[3], const struct view *to, const struct view *from)
{
    const struct mat3 r = mat3_multiply(to->cam_from_world, mat3_transpose(from->cam_from_world));
    const struct vec3 t = vec3_sub(to->translation, mat3_apply(r, from->translation));
    const struct mat3 pixels = mat3_multiply(mat3_multiply(intrinsics(to), r), intrinsics_inverse(from));
    const struct vec3 shift = mat3_apply(intrinsics(to), t);
    memcpy(m, pixels.m, sizeof pixels.m);
    k[0] = shift.x;
    k[1] = shift.y;
    k[2] = shift.z;
}

void segment_relation_make(struct view_relation *r, const struct view *view, const struct view *novel)
{
    relate(r->m, r->k, view, novel);
    relate(r->inverse_m, r->inverse_k, novel, view);
    r->width = novel->width;
    r->height = novel->height;
}

static double row_at(const double row[3], double x, double y) { return row[0] * x + row[1] * y + row[2]; }

/* Clips a convex polygon to the half plane row . (u, v, 1) >= min. Returns the number of its points. */
static int clip_polygon(double (*points)[2], int count, const double row[3], double min)
{
    double kept[16][2];
    int n = 0;
    for (int i = 0; i < count; i++) {
        const double *a = points[i], *b = points[(i + 1) % count];
        const double fa = row_at(row, a[0], a[1]) - min, fb = row_at(row, b[0], b[1]) - min;
        if (fa >= 0) {
            kept[n][0] = a[0];
            kept[n++][1] = a[1];
        }
        if ((fa >= 0) != (fb >= 0)) {
            const double t = fa / (fa - fb);
            kept[n][0] = a[0] + t * (b[0] - a[0]);
            kept[n++][1] = a[1] + t * (b[1] - a[1]);
        }
    }
    memcpy(points, kept, (size_t)n * sizeof *points);
    return n;
}

/* Bounding box of the target pixels that the rectangle [u0, u1] x [v0, v1] of the plane touches; false: none. */
static bool target_rectangle(struct projected_segment *s, const struct view_relation *r, const double plane[3],
                             double to_target[3][3], double u0, double v0, double u1, double v1, double inverse_z)
{
    double points[8][2] = {{u0, v0}, {u1, v0}, {u1, v1}, {u0, v1}};
    double x0 = INFINITY, y0 = INFINITY, x1 = -INFINITY, y1 = -INFINITY;
    int count = 4;
    bool inside = true;

    for (int i = 0; i < 4; i++)
        inside &= row_at(plane, points[i][0], points[i][1]) >= PROJECT_MIN_RATIO * inverse_z &&
                  row_at(to_target[2], points[i][0], points[i][1]) >= PROJECT_MIN_RATIO;
    if (!inside) {
        count = clip_polygon(points, count, plane, PROJECT_MIN_RATIO * inverse_z);
        count = clip_polygon(points, count, to_target[2], PROJECT_MIN_RATIO);
    }
    for (int i = 0; i < count; i++) {
        const double w = 1 / row_at(to_target[2], points[i][0], points[i][1]);
        const double x = row_at(to_target[0], points[i][0], points[i][1]) * w;
        const double y = row_at(to_target[1], points[i][0], points[i][1]) * w;
        x0 = x < x0 ? x : x0;
        x1 = x > x1 ? x : x1;
        y0 = y < y0 ? y : y0;
        y1 = y > y1 ? y : y1;
    }
    if (!(x1 > 0 && y1 > 0 && x0 < r->width && y0 < r->height)) return false;
    s->x0 = x0 > 0.5 + PROJECT_SLACK ? (int)ceil(x0 - 0.5 - PROJECT_SLACK) : 0; /* pixels whose centres are inside */
    s->y0 = y0 > 0.5 + PROJECT_SLACK ? (int)ceil(y0 - 0.5 - PROJECT_SLACK) : 0;
    s->x1 = x1 - 0.5 + PROJECT_SLACK < r->width - 1 ? (int)floor(x1 - 0.5 + PROJECT_SLACK) : r->width - 1;
    s->y1 = y1 - 0.5 + PROJECT_SLACK < r->height - 1 ? (int)floor(y1 - 0.5 + PROJECT_SLACK) : r->height - 1;
    return s->x0 <= s->x1 && s->y0 <= s->y1;
}

bool segment_project(struct projected_segment *s, const struct view_relation *r, const struct depth_segment *segment,
                     const struct segment_shape *shape)
{
    const double *p = segment->plane;
    const double facing = 1 - (p[0] * r->k[0] + p[1] * r->k[1] + p[2] * r->k[2]);
    const double inverse_z = row_at(p, shape->u, shape->v);
    double to_target[3][3];

    if (shape->x1 < shape->x0 || !(facing > PROJECT_MIN_FACING) || !(inverse_z > 0)) return false;
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++) to_target[i][c] = r->inverse_m[i][c] + r->inverse_k[i] * p[c];
    if (!target_rectangle(s, r, p, to_target, shape->x0 - 0.5, shape->y0 - 0.5, shape->x1 + 1.5, shape->y1 + 1.5,
                          inverse_z))
        return false;
    for (int i = 0; i < 3; i++) s->inverse_z[i] = (r->m[0][i] * p[0] + r->m[1][i] * p[1] + r->m[2][i] * p[2]) / facing;
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++) s->from_target[i][c] = r->m[i][c] + r->k[i] * s->inverse_z[c];
    /* pixel centres are at + 0.5 and the padding is one texel: index = u - 0.5 + 1 */
    for (int i = 0; i < 2; i++)
        for (int c = 0; c < 3; c++) s->from_target[i][c] += 0.5 * s->from_target[2][c];
    s->u0 = shape->x0;
    s->v0 = shape->y0;
    s->u1 = shape->x1 + 2;
    s->v1 = shape->y1 + 2;
    return true;
}
