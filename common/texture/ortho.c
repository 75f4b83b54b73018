/* ortho.c - see ortho.h. */
#include "common/texture/ortho.h"

#include <math.h>

static const double HORIZONTAL = 0.99; /* |normal . up| from which a surface is a floor or a ceiling */
static const double PARALLEL = 0.999;

void ortho_axes(struct vec3 *right, struct vec3 *down, struct vec3 normal)
{
    const struct vec3 up = fabs(normal.z) >= HORIZONTAL ? vec3_make(0, 1, 0) : vec3_make(0, 0, 1);
    *right = vec3_normalize(vec3_cross(up, normal));
    *down = vec3_cross(*right, normal);
}

void ortho_matrix(double matrix[3][4], struct vec3 right, struct vec3 down, double side, double left, double top)
{
    const double x[3] = {right.x, right.y, right.z}, y[3] = {down.x, down.y, down.z};
    for (int k = 0; k < 3; k++) {
        matrix[0][k] = x[k] / side;
        matrix[1][k] = y[k] / side;
        matrix[2][k] = 0;
    }
    matrix[0][3] = -left / side;
    matrix[1][3] = -top / side;
    matrix[2][3] = 1;
}

static struct vec3 row(const double m[4]) { return vec3_make(m[0], m[1], m[2]); }

struct vec3 ortho_point(const double matrix[3][4], double x, double y, struct vec3 normal, double offset)
{
    const struct vec3 u = row(matrix[0]), v = row(matrix[1]);
    return vec3_add(vec3_scale(normal, offset), vec3_add(vec3_scale(u, (x - matrix[0][3]) / vec3_dot(u, u)),
                                                         vec3_scale(v, (y - matrix[1][3]) / vec3_dot(v, v))));
}

bool ortho_sees(const double matrix[3][4], struct vec3 normal)
{
    return fabs(vec3_dot(vec3_normalize(vec3_cross(row(matrix[0]), row(matrix[1]))), normal)) > PARALLEL;
}
