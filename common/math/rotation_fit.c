/* rotation_fit.c - see rotation_fit.h. */
#include "common/math/rotation_fit.h"

#include <math.h>
#include <stdbool.h>

#define KNOWN 1e-4 /* of the largest eigenvalue: smaller ones are undetermined by the data */

struct mat3 rotation_turn(struct mat3 a, struct vec3 w)
{
    const double angle = vec3_length(w), half = angle > 0 ? sin(angle / 2) / angle : 0.5;
    const struct quat q = {cos(angle / 2), half * w.x, half * w.y, half * w.z};
    const struct mat3 r = mat3_multiply(mat3_from_quat(q), a);
    const struct vec3 x = vec3_normalize(mat3_row(r, 0));
    const struct vec3 y = vec3_normalize(vec3_sub(mat3_row(r, 1), vec3_scale(x, vec3_dot(x, mat3_row(r, 1)))));
    const struct vec3 z = vec3_cross(x, y);
    return (struct mat3){{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}}};
}

struct mat3 rotation_inverse_of_known(struct mat3 a, struct mat3 *unknown)
{
    struct mat3 vectors, inverse = {0};
    double values[3];
    *unknown = (struct mat3){0};
    mat3_eigen_symmetric(a, values, &vectors);
    for (int k = 0; k < 3; k++) {
        const bool known = values[k] > KNOWN * values[2];
        struct mat3 *to = known ? &inverse : unknown;
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) to->m[i][j] += vectors.m[k][i] * vectors.m[k][j] / (known ? values[k] : 1);
    }
    return inverse;
}

struct vec3 rotation_sandwich(struct mat3 inverse, const struct vec3 *gradients, int count)
{
    struct mat3 middle = {0};
    for (int b = 0; b < count; b++) {
        const double g[3] = {gradients[b].x, gradients[b].y, gradients[b].z};
        for (int i = 0; i < 9; i++) middle.m[i / 3][i % 3] += g[i / 3] * g[i % 3];
    }
    const struct mat3 c = mat3_multiply(mat3_multiply(inverse, middle), inverse);
    return vec3_make(sqrt(fmax(c.m[0][0], 0)), sqrt(fmax(c.m[1][1], 0)), sqrt(fmax(c.m[2][2], 0)));
}
