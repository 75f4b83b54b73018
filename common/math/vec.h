/* vec.h - 3-vectors, 3x3 matrices, unit quaternions, in double precision, passed by value.
 *
 * Matrices are row-major, m[row][column], and multiply column vectors. Quaternions are w x y z. A rotation named
 * a_from_b maps coordinates in b to coordinates in a. */
#ifndef REMODEL_VEC_H
#define REMODEL_VEC_H

#include <math.h>

struct vec3 {
    double x, y, z;
};
struct mat3 {
    double m[3][3];
};
struct quat {
    double w, x, y, z;
};

static inline struct vec3 vec3_make(double x, double y, double z) { return (struct vec3){x, y, z}; }
static inline struct vec3 vec3_add(struct vec3 a, struct vec3 b) { return vec3_make(a.x + b.x, a.y + b.y, a.z + b.z); }
static inline struct vec3 vec3_sub(struct vec3 a, struct vec3 b) { return vec3_make(a.x - b.x, a.y - b.y, a.z - b.z); }
static inline struct vec3 vec3_scale(struct vec3 a, double s) { return vec3_make(a.x * s, a.y * s, a.z * s); }
static inline double vec3_dot(struct vec3 a, struct vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline struct vec3 vec3_cross(struct vec3 a, struct vec3 b)
{
    return vec3_make(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static inline double vec3_length(struct vec3 a) { return sqrt(vec3_dot(a, a)); }
/* The zero vector stays zero. */
static inline struct vec3 vec3_normalize(struct vec3 a)
{
    double n = vec3_length(a);
    return n > 0 ? vec3_scale(a, 1 / n) : a;
}
static inline struct vec3 mat3_apply(struct mat3 a, struct vec3 v)
{
    return vec3_make(a.m[0][0] * v.x + a.m[0][1] * v.y + a.m[0][2] * v.z,
                     a.m[1][0] * v.x + a.m[1][1] * v.y + a.m[1][2] * v.z,
                     a.m[2][0] * v.x + a.m[2][1] * v.y + a.m[2][2] * v.z);
}
static inline struct vec3 mat3_row(struct mat3 m, int i) { return vec3_make(m.m[i][0], m.m[i][1], m.m[i][2]); }
static inline struct mat3 mat3_transpose(struct mat3 a)
{
    struct mat3 t;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) t.m[i][j] = a.m[j][i];
    return t;
}
static inline struct mat3 mat3_multiply(struct mat3 a, struct mat3 b)
{
    struct mat3 c;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) c.m[i][j] = a.m[i][0] * b.m[0][j] + a.m[i][1] * b.m[1][j] + a.m[i][2] * b.m[2][j];
    return c;
}

/* q must have unit length (not checked). */
struct mat3 mat3_from_quat(struct quat q);
/* The unit quaternion with w >= 0. */
struct quat quat_from_mat3(struct mat3 r);
/* Of unit length; q is not zero. */
static inline struct quat quat_normalize(struct quat q)
{
    const double length = sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    return (struct quat){q.w / length, q.x / length, q.y / length, q.z / length};
}
/* The rotation by b, then by a. */
static inline struct quat quat_multiply(struct quat a, struct quat b)
{
    return (struct quat){a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                         a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
/* The inverse rotation of a quaternion of unit length. */
static inline struct quat quat_conjugate(struct quat q) { return (struct quat){q.w, -q.x, -q.y, -q.z}; }
/* The angle of the rotation from a to b, 0 to pi; both of unit length. */
double quat_angle(struct quat a, struct quat b);
/* From a (t = 0) to b (t = 1) at constant speed, by the shorter way [Shoemake 1985]; all of unit length. */
struct quat quat_slerp(struct quat a, struct quat b, double t);
/* Eigenvalues of a symmetric matrix in ascending order, and the eigenvectors as rows of `vectors`, signed so that the
 * component of largest magnitude is positive. */
void mat3_eigen_symmetric(struct mat3 a, double values[3], struct mat3 *vectors);

#endif
