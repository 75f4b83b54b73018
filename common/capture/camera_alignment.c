/* camera_alignment.c - the similarity that aligns found with true cameras [Umeyama 1991].
 *
 * With x_i the found and y_i the true centres, both from their means, R is the rotation with the largest trace(R^T M),
 * M = sum y_i x_i^T, s = trace(R^T M) / sum |x_i|^2, t = mean y - s R mean x.
 *
 * Differs from the source: R comes from the eigenvectors of M^T M and not from an SVD of M, and if the centres are on a
 * line (the second singular value of M is 0), R is the rotation nearest to sum Q_i^T P_i instead, the sum of the turns
 * between the rotations P_i of the found and Q_i of the true cameras. */
#include "common/capture/camera_alignment.h"

#include <stdlib.h>

#include "common/base/sort.h"

static const double min_ratio = 1e-6; /* of the second to the first singular value; below: the centres are on a line */

static const double rounding = 1e-24; /* relative, of squared lengths: centres that differ by less coincide */

static void add_outer(struct mat3 *m, struct vec3 a, struct vec3 b)
{
    double u[3] = {a.x, a.y, a.z}, v[3] = {b.x, b.y, b.z};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) m->m[i][j] += u[i] * v[j];
}

/* Returns the largest trace(R^T m) of a rotation R, and sets *r to that R and *second to the ratio of m's second to
 * first singular value. Both triples of singular vectors are made right-handed, so that R is a rotation and the
 * third term of the trace has its sign. */
static double nearest_rotation(struct mat3 m, struct mat3 *r, double *second)
{
    double values[3];
    struct mat3 rows;
    mat3_eigen_symmetric(mat3_multiply(mat3_transpose(m), m), values, &rows);
    struct vec3 v1 = mat3_row(rows, 2), v2 = mat3_row(rows, 1), v3 = vec3_cross(v1, v2);
    struct vec3 m1 = mat3_apply(m, v1), m2 = mat3_apply(m, v2), u1 = vec3_normalize(m1);
    m2 = vec3_sub(m2, vec3_scale(u1, vec3_dot(u1, m2)));
    struct vec3 u2 = vec3_normalize(m2), u3 = vec3_cross(u1, u2);
    *second = vec3_length(m1) > 0 ? vec3_length(m2) / vec3_length(m1) : 0;
    *r = (struct mat3){0};
    add_outer(r, u1, v1);
    add_outer(r, u2, v2);
    add_outer(r, u3, v3);
    return vec3_length(m1) + vec3_length(m2) + vec3_dot(u3, mat3_apply(m, v3));
}

enum status camera_alignment_find(struct similarity *a, const struct pose *found, const struct pose *truth, int count,
                                  struct err *err)
{
    struct vec3 mean_found = {0, 0, 0}, mean_truth = {0, 0, 0};
    struct mat3 covariance = {0}, turns = {0};
    double spread = 0, true_spread = 0, size = 0, true_size = 0, second;
    for (int i = 0; i < count; i++) {
        mean_found = vec3_add(mean_found, vec3_scale(pose_center(&found[i]), 1.0 / count));
        mean_truth = vec3_add(mean_truth, vec3_scale(pose_center(&truth[i]), 1.0 / count));
    }
    for (int i = 0; i < count; i++) {
        struct vec3 x = vec3_sub(pose_center(&found[i]), mean_found), y = vec3_sub(pose_center(&truth[i]), mean_truth);
        struct mat3 turn =
            mat3_multiply(mat3_transpose(mat3_from_quat(truth[i].rotation)), mat3_from_quat(found[i].rotation));
        size += vec3_dot(pose_center(&found[i]), pose_center(&found[i]));
        true_size += vec3_dot(pose_center(&truth[i]), pose_center(&truth[i]));
        spread += vec3_dot(x, x);
        true_spread += vec3_dot(y, y);
        add_outer(&covariance, y, x);
        for (int j = 0; j < 9; j++) turns.m[j / 3][j % 3] += turn.m[j / 3][j % 3];
    }
    if (count < 2 || !(spread > rounding * size) || !(true_spread > rounding * true_size))
        return err_set(err, ST_DATA,
                       "there is no scale between the found cameras and the true ones: %d of them are known in both, "
                       "and at least two in different places are needed.",
                       count);
    double trace = nearest_rotation(covariance, &a->rotation, &second);
    if (second < min_ratio) {
        nearest_rotation(turns, &a->rotation, &second);
        trace = 0;
        for (int i = 0; i < count; i++)
            trace += vec3_dot(vec3_sub(pose_center(&truth[i]), mean_truth),
                              mat3_apply(a->rotation, vec3_sub(pose_center(&found[i]), mean_found)));
    }
    a->scale = trace / spread;
    a->translation = vec3_sub(mean_truth, vec3_scale(mat3_apply(a->rotation, mean_found), a->scale));
    if (!(a->scale > 0))
        return err_set(err, ST_DATA, "the found cameras' places have nothing to do with the true ones: no scale fits.");
    return ST_OK;
}

enum status camera_errors_measure(struct camera_errors *e, const struct similarity *a, const struct pose *found,
                                  const struct pose *truth, int count, struct err *err)
{
    double *centers = malloc((size_t)count * sizeof *centers), *turns = malloc((size_t)count * sizeof *turns);
    if (!centers || !turns) err_nomem(err, "errors of cameras", (size_t)count * sizeof *turns);
    *e = (struct camera_errors){0};
    for (int i = 0; !err->status && i < count; i++) {
        struct vec3 at =
            vec3_add(vec3_scale(mat3_apply(a->rotation, pose_center(&found[i])), a->scale), a->translation);
        struct mat3 aligned = mat3_multiply(mat3_from_quat(found[i].rotation), mat3_transpose(a->rotation));
        struct quat q = quat_from_mat3(mat3_multiply(aligned, mat3_transpose(mat3_from_quat(truth[i].rotation))));
        centers[i] = vec3_length(vec3_sub(at, pose_center(&truth[i])));
        turns[i] = 2 * atan2(vec3_length(vec3_make(q.x, q.y, q.z)), q.w) * 180 / M_PI;
        e->center_max = fmax(e->center_max, centers[i]);
        e->rotation_max = fmax(e->rotation_max, turns[i]);
    }
    if (!err->status) {
        e->center_median = sort_median(centers, (size_t)count);
        e->rotation_median = sort_median(turns, (size_t)count);
    }
    free(centers);
    free(turns);
    return err->status;
}
