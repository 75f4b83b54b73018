/* normal_fit.c - normals of points by a robust fit to the depths around them.
 *
 * A plane is linear in inverse depth: z0 / z = 1 + a + b du + c dv, where (du, dv) is the offset in px from the pixel
 * and z0 its depth. a, b and c minimize
 *   sum_i w_i (z0 / z_i - 1 - a - b du_i - c dv_i)^2 / noise^2 + ((b - b0)^2 f_x^2 + (c - c0)^2 f_y^2) / PRIOR^2
 * over a lattice of SIDE x SIDE pixels of the window, by iteratively reweighted least squares. b0 and c0 are the slopes
 * of the given normal. The weights w = 1 / (1 + (r / (CUT noise))^2)^2 [Geman 1987] exclude other surfaces; the first
 * residuals r are those of the given normal.
 * The prior keeps the given slope where depths do not determine it. It is weak, since a narrow segment hardly
 * determines its own slant, and many have a constant depth for lack of evidence. */
#include "stages/fuse_points/normal_fit.h"

#include <stdbool.h>

#define SIDE   7 /* odd */
#define ROUNDS 3
#define PRIOR  0.3 /* standard deviation of a segment's slope: tangent of the angle at the pixel */
#define CUT    2.0

/* Solves m x = y, m symmetric and positive definite; false if it is not, by rounding. */
static bool solve(double x[3], double m[3][3], const double y[3])
{
    const double c0 = m[1][1] * m[2][2] - m[1][2] * m[1][2], c1 = m[0][2] * m[1][2] - m[0][1] * m[2][2],
                 c2 = m[0][1] * m[1][2] - m[0][2] * m[1][1];
    const double det = m[0][0] * c0 + m[0][1] * c1 + m[0][2] * c2;
    if (!(det > 0)) return false;
    const double d = m[0][0] * m[2][2] - m[0][2] * m[0][2], e = m[0][1] * m[0][2] - m[0][0] * m[1][2],
                 f = m[0][0] * m[1][1] - m[0][1] * m[0][1];
    x[0] = (c0 * y[0] + c1 * y[1] + c2 * y[2]) / det;
    x[1] = (c1 * y[0] + d * y[1] + e * y[2]) / det;
    x[2] = (c2 * y[0] + e * y[1] + f * y[2]) / det;
    return true;
}

struct vec3 normal_fit(struct vec3 normal, const float *inverse_z, const struct view *view, int x, int y, int window,
                       double noise)
{
    const double z0 = 1 / (double)inverse_z[(size_t)y * (size_t)view->width + (size_t)x];
    const double dx = (x + 0.5 - view->cx) / view->fx, dy = (y + 0.5 - view->cy) / view->fy;
    struct vec3 n = mat3_apply(view->cam_from_world, normal);
    const double along = n.x * dx + n.y * dy + n.z;
    if (!(along < 0)) return normal;
    const double prior[2] = {n.x / (view->fx * along), n.y / (view->fy * along)};
    const double stiff[2] = {view->fx * view->fx / (PRIOR * PRIOR), view->fy * view->fy / (PRIOR * PRIOR)};

    double q[SIDE * SIDE], u[SIDE * SIDE], v[SIDE * SIDE], fit[3] = {0, prior[0], prior[1]};
    int count = 0;
    for (int j = 0; j < SIDE; j++)
        for (int i = 0; i < SIDE; i++) {
            const int du = (2 * i - (SIDE - 1)) * window / (SIDE - 1), dv = (2 * j - (SIDE - 1)) * window / (SIDE - 1);
            if (x + du < 0 || y + dv < 0 || x + du >= view->width || y + dv >= view->height) continue;
            const double inverse = (double)inverse_z[(size_t)(y + dv) * (size_t)view->width + (size_t)(x + du)];
            if (!(inverse > 0)) continue;
            q[count] = z0 * inverse - 1;
            u[count] = du;
            v[count++] = dv;
        }
    const double per_noise = 1 / (noise * noise), cut = per_noise / (CUT * CUT);
    for (int round = 0; round < ROUNDS; round++) {
        double m[3][3] = {{0}}, right[3] = {0, stiff[0] * prior[0], stiff[1] * prior[1]};
        m[1][1] = stiff[0];
        m[2][2] = stiff[1];
        for (int i = 0; i < count; i++) {
            const double r = q[i] - fit[0] - fit[1] * u[i] - fit[2] * v[i], s = 1 + r * r * cut,
                         w = per_noise / (s * s);
            m[0][0] += w;
            m[0][1] += w * u[i];
            m[0][2] += w * v[i];
            m[1][1] += w * u[i] * u[i];
            m[1][2] += w * u[i] * v[i];
            m[2][2] += w * v[i] * v[i];
            right[0] += w * q[i];
            right[1] += w * u[i] * q[i];
            right[2] += w * v[i] * q[i];
        }
        if (!solve(fit, m, right)) return normal;
    }
    /* the plane of these slopes, scaled so that n . ray = 1 at the pixel; its negative faces the camera */
    n.x = fit[1] * view->fx;
    n.y = fit[2] * view->fy;
    n.z = 1 - n.x * dx - n.y * dy;
    return vec3_normalize(vec3_scale(mat3_apply(mat3_transpose(view->cam_from_world), n), -1));
}
