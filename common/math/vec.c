/* vec.c - rotations, and eigenvectors of symmetric 3x3 matrices.
 *
 * A rotation matrix becomes a quaternion by the method of [Shepperd 1978]: the component of largest magnitude is taken
 * from the diagonal and the others relative to it, which is stable for every angle. Eigenvectors are found by cyclic
 * Jacobi rotations [Golub 2013, 8.5]: each zeroes one element off the diagonal, until their sum is below 1e-18 of the
 * diagonal's. The matrix becomes diagonal, and the rows of v its eigenvectors. */
#include "common/math/vec.h"

struct mat3 mat3_from_quat(struct quat q)
{
    double w = q.w, x = q.x, y = q.y, z = q.z;
    return (struct mat3){{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                          {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                          {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

struct quat quat_from_mat3(struct mat3 r)
{
    double t = r.m[0][0] + r.m[1][1] + r.m[2][2];
    double q[4]; /* w x y z, up to a common factor */
    if (t >= r.m[0][0] && t >= r.m[1][1] && t >= r.m[2][2]) {
        q[0] = 1 + t;
        q[1] = r.m[2][1] - r.m[1][2];
        q[2] = r.m[0][2] - r.m[2][0];
        q[3] = r.m[1][0] - r.m[0][1];
    } else {
        int i = r.m[1][1] > r.m[0][0] ? 1 : 0;
        if (r.m[2][2] > r.m[i][i]) i = 2;
        int j = (i + 1) % 3, k = (i + 2) % 3;
        q[0] = r.m[k][j] - r.m[j][k];
        q[1 + i] = 1 + r.m[i][i] - r.m[j][j] - r.m[k][k];
        q[1 + j] = r.m[j][i] + r.m[i][j];
        q[1 + k] = r.m[k][i] + r.m[i][k];
    }
    double s = 1 / sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (q[0] < 0) s = -s;
    return (struct quat){q[0] * s, q[1] * s, q[2] * s, q[3] * s};
}

/* Half the angle between two rotations, as an angle between quaternions: 0 to pi / 2, precise at both ends. *sign gets
 * -1 if the shorter way leads to -b, which is the same rotation as b. */
static double half_angle(struct quat a, struct quat b, double *sign)
{
    *sign = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z < 0 ? -1 : 1;
    const double u[] = {a.w, a.x, a.y, a.z}, v[] = {b.w, b.x, b.y, b.z};
    double difference = 0, sum = 0;
    for (int i = 0; i < 4; i++) {
        difference += (u[i] - *sign * v[i]) * (u[i] - *sign * v[i]);
        sum += (u[i] + *sign * v[i]) * (u[i] + *sign * v[i]);
    }
    return 2 * atan2(sqrt(difference), sqrt(sum));
}

double quat_angle(struct quat a, struct quat b)
{
    double sign;
    return 2 * half_angle(a, b, &sign);
}

struct quat quat_slerp(struct quat a, struct quat b, double t)
{
    double sign;
    const double half = half_angle(a, b, &sign);
    double from = 1 - t, to = t;
    if (half > 1e-6) { /* below, a straight line differs by less than rounding */
        from = sin((1 - t) * half) / sin(half);
        to = sin(t * half) / sin(half);
    }
    to *= sign;
    return quat_normalize(
        (struct quat){from * a.w + to * b.w, from * a.x + to * b.x, from * a.y + to * b.y, from * a.z + to * b.z});
}

void mat3_eigen_symmetric(struct mat3 a, double values[3], struct mat3 *vectors)
{
    struct mat3 v = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (int sweep = 0; sweep < 64; sweep++) {
        double off = fabs(a.m[0][1]) + fabs(a.m[0][2]) + fabs(a.m[1][2]);
        double diagonal = fabs(a.m[0][0]) + fabs(a.m[1][1]) + fabs(a.m[2][2]);
        if (off == 0 || off <= 1e-18 * diagonal) break;
        for (int p = 0; p < 2; p++) {
            for (int q = p + 1; q < 3; q++) {
                if (a.m[p][q] == 0) continue;
                double theta = (a.m[q][q] - a.m[p][p]) / (2 * a.m[p][q]);
                double t = copysign(1, theta) / (fabs(theta) + sqrt(theta * theta + 1));
                double c = 1 / sqrt(t * t + 1), s = t * c;
                for (int k = 0; k < 3; k++) { /* columns p and q */
                    double x = a.m[k][p], y = a.m[k][q];
                    a.m[k][p] = c * x - s * y;
                    a.m[k][q] = s * x + c * y;
                }
                for (int k = 0; k < 3; k++) { /* rows p and q, also of the eigenvectors */
                    double x = a.m[p][k], y = a.m[q][k];
                    a.m[p][k] = c * x - s * y;
                    a.m[q][k] = s * x + c * y;
                    x = v.m[p][k], y = v.m[q][k];
                    v.m[p][k] = c * x - s * y;
                    v.m[q][k] = s * x + c * y;
                }
            }
        }
    }
    int order[3] = {0, 1, 2};
    for (int i = 0; i < 2; i++) {
        for (int j = 0; j < 2 - i; j++) {
            if (a.m[order[j]][order[j]] <= a.m[order[j + 1]][order[j + 1]]) continue;
            int swap = order[j];
            order[j] = order[j + 1];
            order[j + 1] = swap;
        }
    }
    for (int i = 0; i < 3; i++) {
        const double *from = v.m[order[i]];
        int largest = 0;
        for (int k = 1; k < 3; k++)
            if (fabs(from[k]) > fabs(from[largest])) largest = k;
        values[i] = a.m[order[i]][order[i]];
        for (int k = 0; k < 3; k++) vectors->m[i][k] = from[largest] < 0 ? -from[k] : from[k];
    }
}
