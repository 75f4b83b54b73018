/* three_points.c - the pose of a camera from three points [Grunert 1841], in the form of [Haralick 1994].
 *
 * The camera sees the points P1, P2, P3 along the unit rays b1, b2, b3, at the unknown distances s1, s2, s3. The sides
 * of the triangle, a = |P2 P3|, b = |P1 P3|, c = |P1 P2|, and the angles between the rays are known, so
 *   s2^2 + s3^2 - 2 s2 s3 cos(b2, b3) = a^2,   and likewise for b and c.
 * With s2 = u s1 and s3 = v s1, s1 and u can be eliminated; a polynomial of degree 4 in v remains. It has up to four
 * positive roots, each a pose. Then s1 = b / sqrt(1 + v^2 - 2 v cos(b1, b3)), and the equation of c gives u.
 *
 * What differs: Haralick computes u by a quotient, whose denominator may vanish; here the quadratic equation of c gives
 * two values of u, and the caller drops the pose that does not see the points. Two roots that nearly coincide may
 * vanish because pixels are rounded, so places where the polynomial has an extremum are tried, too. Rays replace image
 * points: nothing assumes that a point is in front of an image plane. */
#include "stages/hdr_merge/three_points.h"

#include <math.h>

enum { DEGREE = 4 };

static const double MAX_RATIO = 1e6; /* of two distances */
static const double MIN_SINE = 1e-9; /* of an angle between sides or rays */

static double polynomial(const double *c, int degree, double x)
{
    double value = c[degree];
    for (int i = degree - 1; i >= 0; i--) value = value * x + c[i];
    return value;
}

/* The root between low and high, where the polynomial has different signs. */
static double root_between(const double *c, int degree, double low, double high)
{
    const bool rises = polynomial(c, degree, high) > 0;
    for (;;) {
        const double middle = low + (high - low) / 2;
        if (middle <= low || middle >= high) return middle;
        if ((polynomial(c, degree, middle) > 0) == rises)
            high = middle;
        else
            low = middle;
    }
}

/* Roots between 0 and MAX_RATIO where the sign changes, in ascending order: one at most between neighbouring
 * extrema. */
static int find_roots(double roots[DEGREE], const double *c, int degree, const double *extrema, int extrema_count)
{
    int count = 0;
    double low = 0;
    for (int i = 0; i <= extrema_count; i++) {
        const double high = i < extrema_count ? extrema[i] : MAX_RATIO;
        if ((polynomial(c, degree, low) > 0) != (polynomial(c, degree, high) > 0))
            roots[count++] = root_between(c, degree, low, high);
        low = high;
    }
    return count;
}

/* The roots of the polynomial, then its extrema. */
static int roots_and_extrema(double found[2 * DEGREE - 1], const double c[DEGREE + 1])
{
    double derivatives[DEGREE][DEGREE + 1], extrema[DEGREE] = {0}, roots[DEGREE];
    int count = 0;
    for (int i = 0; i <= DEGREE; i++) derivatives[0][i] = c[i];
    for (int k = 1; k < DEGREE; k++)
        for (int i = 0; i <= DEGREE - k; i++) derivatives[k][i] = (i + 1) * derivatives[k - 1][i + 1];
    for (int k = DEGREE - 1; k > 0; k--) {
        count = find_roots(roots, derivatives[k], DEGREE - k, extrema, count);
        for (int i = 0; i < count; i++) extrema[i] = roots[i];
    }
    const int root_count = find_roots(found, c, DEGREE, extrema, count);
    for (int i = 0; i < count; i++) found[root_count + i] = extrema[i];
    return root_count + count;
}

/* Axes of a triangle as rows: along its first side, across it in its plane, normal to the plane. */
static struct mat3 axes_of(const struct vec3 p[3])
{
    const struct vec3 along = vec3_normalize(vec3_sub(p[1], p[0]));
    const struct vec3 normal = vec3_normalize(vec3_cross(along, vec3_sub(p[2], p[0])));
    const struct vec3 across = vec3_cross(normal, along);
    return (struct mat3){{{along.x, along.y, along.z}, {across.x, across.y, across.z}, {normal.x, normal.y, normal.z}}};
}

static struct pose pose_of_triangle(const struct vec3 cam[3], const struct vec3 world[3])
{
    const struct mat3 turn = mat3_multiply(mat3_transpose(axes_of(cam)), axes_of(world));
    return (struct pose){quat_from_mat3(turn), vec3_sub(cam[0], mat3_apply(turn, world[0]))};
}

static double sine_of(struct vec3 a, struct vec3 b)
{
    return vec3_length(vec3_cross(vec3_normalize(a), vec3_normalize(b)));
}

int three_points_poses(struct pose poses[THREE_POINTS_MAX], const struct vec3 rays[3], const struct vec3 points[3])
{
    const double a = vec3_length(vec3_sub(points[1], points[2])), b = vec3_length(vec3_sub(points[0], points[2])),
                 c = vec3_length(vec3_sub(points[0], points[1]));
    const double ca = vec3_dot(rays[1], rays[2]), cb = vec3_dot(rays[0], rays[2]), cc = vec3_dot(rays[0], rays[1]);
    if (!(sine_of(vec3_sub(points[1], points[0]), vec3_sub(points[2], points[0])) > MIN_SINE) ||
        !(fmin(fmin(sine_of(rays[0], rays[1]), sine_of(rays[0], rays[2])), sine_of(rays[1], rays[2])) > MIN_SINE))
        return 0;
    const double p = a * a / (b * b), q = c * c / (b * b), d = p - q;
    const double quartic[DEGREE + 1] = {
        (1 + d) * (1 + d) - 4 * p * cc * cc,
        4 * (-d * (1 + d) * cb + 2 * p * cc * cc * cb - (1 - p - q) * ca * cc),
        2 * (d * d - 1 + 2 * d * d * cb * cb + 2 * (1 - q) * ca * ca - 4 * (p + q) * ca * cb * cc +
             2 * (1 - p) * cc * cc),
        4 * (d * (1 - d) * cb - (1 - p - q) * ca * cc + 2 * q * ca * ca * cb),
        (d - 1) * (d - 1) - 4 * q * ca * ca,
    };
    double ratios[2 * DEGREE - 1];
    const int count = roots_and_extrema(ratios, quartic);
    int found = 0;
    for (int i = 0; i < count; i++) {
        const double v = ratios[i], s1 = b / sqrt(1 + v * v - 2 * v * cb);
        const double root = sqrt(fmax(cc * cc - 1 + c * c / (s1 * s1), 0));
        for (int sign = -1; sign <= 1; sign += 2) {
            const double u = cc + sign * root;
            const struct vec3 cam[3] = {vec3_scale(rays[0], s1), vec3_scale(rays[1], s1 * u),
                                        vec3_scale(rays[2], s1 * v)};
            if (!(u > 0) || !(v > 0) || !(sine_of(vec3_sub(cam[1], cam[0]), vec3_sub(cam[2], cam[0])) > MIN_SINE))
                continue;
            poses[found++] = pose_of_triangle(cam, points);
        }
    }
    return found;
}
