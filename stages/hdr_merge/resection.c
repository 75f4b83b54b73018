/* resection.c - the pose of a camera from pixels that show known points: space resection.
 *
 * Overview. Each mark is a ray of the camera, through whatever lens. Three marks have up to four poses
 * (three_points.c). All sets of three among up to eight marks that lie far apart give first poses; the most promising
 * ones that differ from each other are refined on all marks by least squares. The best is the answer. Others that fit
 * nearly as well are returned, too: the corners of one window lie in a plane, and a plane that is small, far or seen
 * nearly from the front has a second pose, mirrored in effect [Schweighofer 2006]; three marks have several.
 *
 * Mathematics. The residual of a mark is the angle from its ray to the point, along two directions across the ray,
 * times the pixels per radian that the lens has there along these directions: a distance in pixels to first order.
 * Unlike the point's pixel, it is finite for any pose, so that a fisheye of 180 degrees and points behind a camera need
 * no care. With J, the derivatives of the residuals by rotation and centre at the solution, the covariance of the pose
 * is sigma^2 (J^T J)^-1. The 95 % interval is t sigma, where sigma^2 is the sum of squares over the 2 N - 6 degrees of
 * freedom and t the quantile of Student's distribution, which is larger the fewer marks there are [Student 1908]; it is
 * at least that of the stated standard error of a mark. A pose fits nearly as well if its sum of squares exceeds the
 * least one by less than 9 sigma^2, three standard errors of a single residual.
 *
 * Sources: [Haralick 1994] for three points, [Schweighofer 2006] for the two poses of a plane. What differs: the second
 * pose comes from the sets of three marks like the first; least squares are Ceres's Levenberg-Marquardt. On simulated
 * windows seen from 4 to 64 m away (640 x 480 pixels, f = 500), a start that mirrors the first pose found another pose
 * in 2 of 16 000 cases, which is not worth its code. */
#include "stages/hdr_merge/resection.h"

#include <math.h>
#include <string.h>

#include "common/math/ceres_least_squares.h"
#include "common/math/inverse.h"
#include "common/math/student.h"
#include "stages/hdr_merge/three_points.h"

enum {
    UNKNOWNS = 6, /* a rotation vector and the centre's offset in units of the points' extent */
    SPREAD = 8,   /* marks whose sets of three are tried */
    STARTS = 16,  /* first poses that are refined */
    ITERATIONS = 100,
};

static const double SAME_START = 0.05, SAME_POSE = 1e-3; /* radians, and distance over the points' extent */
static const double MIN_PIVOT = 1e-12;                   /* of the normal equations, relative to their largest term */
static const double NEARLY = 9; /* difference of two sums of squares, in variances of a residual */

struct rays { /* what refinement reads */
    const struct resection_mark *marks;
    int count;
    struct vec3 ray[RESECTION_MAX], across[RESECTION_MAX][2]; /* unit vectors, orthogonal */
    double scale[RESECTION_MAX][2][2];                        /* pixels by radians along `across` */
    struct pose start;
    double extent; /* largest distance of a point from the first */
};

struct candidate {
    struct pose pose;
    double squares; /* sum over the residuals, px^2 */
};

/* ------------------------------------------------------------------------------------------------------- residuals */

/* The angles from ray i to the direction p, along the two directions across the ray. */
static void angles_to(const struct rays *r, int i, struct vec3 p, double angles[2])
{
    const double a = vec3_dot(r->across[i][0], p), b = vec3_dot(r->across[i][1], p), ahead = vec3_dot(r->ray[i], p);
    const double aside = hypot(a, b), angle = atan2(aside, ahead);
    const double scale = aside > 0 ? angle / aside : 0;
    angles[0] = aside > 0 ? a * scale : angle;
    angles[1] = b * scale;
}

static void residuals_at(const struct rays *r, const struct pose *pose, double *residuals)
{
    const struct mat3 turn = mat3_from_quat(pose->rotation);
    for (int i = 0; i < r->count; i++) {
        double angles[2];
        angles_to(r, i, vec3_add(mat3_apply(turn, r->marks[i].point), pose->translation), angles);
        for (int k = 0; k < 2; k++)
            residuals[2 * i + k] = r->scale[i][k][0] * angles[0] + r->scale[i][k][1] * angles[1];
    }
}

static double squares_at(const struct rays *r, const struct pose *pose)
{
    double residuals[2 * RESECTION_MAX], sum = 0;
    residuals_at(r, pose, residuals);
    for (int i = 0; i < 2 * r->count; i++) sum += residuals[i] * residuals[i];
    return sum;
}

static struct mat3 rotation_of(struct vec3 vector)
{
    const double angle = vec3_length(vector);
    const struct vec3 axis = vec3_scale(vector, angle > 0 ? sin(angle / 2) / angle : 0.5);
    return mat3_from_quat((struct quat){cos(angle / 2), axis.x, axis.y, axis.z});
}

/* The start, changed by x. */
static struct pose changed_pose(const struct rays *r, const double x[UNKNOWNS])
{
    const struct mat3 turn = mat3_multiply(rotation_of(vec3_make(x[0], x[1], x[2])), mat3_from_quat(r->start.rotation));
    const struct vec3 center = vec3_add(pose_center(&r->start), vec3_scale(vec3_make(x[3], x[4], x[5]), r->extent));
    return (struct pose){quat_from_mat3(turn), vec3_scale(mat3_apply(turn, center), -1)};
}

static void evaluate(void *ctx, const double *x, double *residuals)
{
    const struct rays *r = ctx;
    const struct pose pose = changed_pose(r, x);
    residuals_at(r, &pose, residuals);
}

static enum status prepare_rays(struct rays *r, const struct camera *lens, const struct resection_mark *marks,
                                int count, const char *name, struct err *err)
{
    *r = (struct rays){.marks = marks, .count = count};
    for (int i = 0; i < count; i++) {
        const struct resection_mark *m = &marks[i];
        double pixel[2], by_point[2][3], by_lens[2][CAMERA_MAX_PARAMS];
        if (!camera_unproject(lens, m->x, m->y, &r->ray[i]) ||
            !camera_project_derivatives(lens, r->ray[i], pixel, by_point, by_lens))
            return err_set(err, ST_DATA, "image %s has a mark at %.9g, %.9g, where its lens has no ray.", name, m->x,
                           m->y);
        const struct vec3 b = r->ray[i];
        const struct vec3 other = fabs(b.x) < 0.5 ? vec3_make(1, 0, 0) : vec3_make(0, 1, 0);
        r->across[i][0] = vec3_normalize(vec3_cross(other, b));
        r->across[i][1] = vec3_cross(b, r->across[i][0]);
        for (int k = 0; k < 2; k++)
            for (int l = 0; l < 2; l++)
                r->scale[i][k][l] =
                    vec3_dot(vec3_make(by_point[k][0], by_point[k][1], by_point[k][2]), r->across[i][l]);
        r->extent = fmax(r->extent, vec3_length(vec3_sub(m->point, marks[0].point)));
    }
    return ST_OK;
}

/* ----------------------------------------------------------------------------------------------------------- starts */

static bool is_same(const struct pose *a, const struct pose *b, double limit, double extent)
{
    const struct quat p = a->rotation, q = b->rotation;
    const double turn = 2 * acos(fmin(fabs(p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z), 1));
    return turn <= limit && vec3_length(vec3_sub(pose_center(a), pose_center(b))) <= limit * extent;
}

/* Adds a pose to those kept, in order of fit: of poses that are the same, the better one; at most `max`. */
static void keep(struct candidate *kept, int *count, int max, struct candidate c, double same, double extent)
{
    for (int i = 0; i < *count; i++) {
        if (!is_same(&kept[i].pose, &c.pose, same, extent)) continue;
        if (kept[i].squares <= c.squares) return;
        (*count)--;
        memmove(&kept[i], &kept[i + 1], (size_t)(*count - i) * sizeof *kept);
        i--;
    }
    int at = *count;
    while (at > 0 && kept[at - 1].squares > c.squares) at--;
    if (at == max) return;
    if (*count < max) (*count)++;
    memmove(&kept[at + 1], &kept[at], (size_t)(*count - at - 1) * sizeof *kept);
    kept[at] = c;
}

/* Up to SPREAD marks, each as far as possible from those before it. */
static int spread_marks(int chosen[SPREAD], const struct rays *r)
{
    double distance[RESECTION_MAX];
    int count = 0, next = 0;
    for (int i = 0; i < r->count; i++) distance[i] = INFINITY;
    while (count < SPREAD && count < r->count) {
        chosen[count++] = next;
        for (int i = 0; i < r->count; i++)
            distance[i] = fmin(distance[i], vec3_length(vec3_sub(r->marks[i].point, r->marks[next].point)));
        for (int i = 0; i < r->count; i++)
            if (distance[i] > distance[next]) next = i;
    }
    return count;
}

static void try_three(struct candidate *starts, int *count, const struct rays *r, const int marks[3])
{
    struct pose poses[THREE_POINTS_MAX];
    struct vec3 rays[3], points[3];
    for (int k = 0; k < 3; k++) {
        rays[k] = r->ray[marks[k]];
        points[k] = r->marks[marks[k]].point;
    }
    const int found = three_points_poses(poses, rays, points);
    for (int i = 0; i < found; i++) {
        const struct candidate c = {poses[i], squares_at(r, &poses[i])};
        if (isfinite(c.squares)) keep(starts, count, STARTS, c, SAME_START, r->extent);
    }
}

static int find_starts(struct candidate starts[STARTS], const struct rays *r)
{
    int marks[SPREAD], count = 0;
    const int spread = spread_marks(marks, r);
    for (int i = 0; i < spread; i++)
        for (int j = i + 1; j < spread; j++)
            for (int k = j + 1; k < spread; k++)
                try_three(starts, &count, r, (const int[3]){marks[i], marks[j], marks[k]});
    return count;
}

/* ------------------------------------------------------------------------------------------------------- refinement */

/* A start from which the solver fails is left out. */
static void refine(struct candidate *kept, int *count, struct rays *r, const struct candidate *start)
{
    const struct least_squares problem = {UNKNOWNS, 2 * r->count, evaluate, r, ITERATIONS};
    double x[UNKNOWNS] = {0};
    struct err failed = ERR_INIT;
    r->start = start->pose;
    if (ceres_least_squares(&problem, x, &failed)) return;
    struct candidate c = {.pose = changed_pose(r, x)};
    c.squares = squares_at(r, &c.pose);
    if (isfinite(c.squares)) keep(kept, count, STARTS, c, SAME_POSE, r->extent);
}

/* ----------------------------------------------------------------------------------------------------------- errors */

/* The covariance of r->start for residuals of standard error 1, in the unknowns' units. False: the marks leave a
 * change of the pose open. */
static bool find_covariance(double covariance[UNKNOWNS][UNKNOWNS], const struct rays *r)
{
    const double step = 1e-6;
    double columns[UNKNOWNS][2 * RESECTION_MAX], behind[2 * RESECTION_MAX], largest = 0;
    for (int k = 0; k < UNKNOWNS; k++) {
        double x[UNKNOWNS] = {0};
        x[k] = step;
        evaluate((void *)r, x, columns[k]);
        x[k] = -step;
        evaluate((void *)r, x, behind);
        for (int i = 0; i < 2 * r->count; i++) columns[k][i] = (columns[k][i] - behind[i]) / (2 * step);
    }
    for (int i = 0; i < UNKNOWNS; i++)
        for (int j = 0; j < UNKNOWNS; j++) {
            covariance[i][j] = 0;
            for (int k = 0; k < 2 * r->count; k++) covariance[i][j] += columns[i][k] * columns[j][k];
        }
    for (int i = 0; i < UNKNOWNS; i++) largest = fmax(largest, covariance[i][i]);
    return inverse_of_symmetric(&covariance[0][0], UNKNOWNS, MIN_PIVOT * largest);
}

/* Measures how a pose fits. False: a point is where the lens has no pixel, or its error is unknown. */
static bool measure(struct resection_pose *to, struct rays *r, const struct candidate *c, const struct camera *lens,
                    double click)
{
    double covariance[UNKNOWNS][UNKNOWNS], squares = 0, angles2 = 0, values[3];
    struct mat3 turn, vectors;
    r->start = c->pose;
    *to = (struct resection_pose){.cam_from_world = c->pose};
    for (int i = 0; i < r->count; i++) {
        const struct vec3 p = pose_apply(&c->pose, r->marks[i].point);
        double u, v, angles[2];
        if (!camera_project(lens, p, &u, &v)) return false;
        angles_to(r, i, p, angles);
        angles2 += angles[0] * angles[0] + angles[1] * angles[1];
        const double distance = hypot(u - r->marks[i].x, v - r->marks[i].y);
        squares += distance * distance;
        if (distance > to->max) to->worst = i;
        to->max = fmax(to->max, distance);
    }
    to->rms = sqrt(squares / r->count);
    to->degrees = sqrt(angles2 / r->count) * 180 / M_PI;
    if (!find_covariance(covariance, r)) return false;
    const int freedom = 2 * r->count - UNKNOWNS;
    const double spread = freedom ? student_quantile(freedom) * sqrt(c->squares / freedom) : 0;
    const double width = fmax(spread, student_quantile(0) * click), reach = width * r->extent;
    to->error = vec3_scale(vec3_make(sqrt(covariance[3][3]), sqrt(covariance[4][4]), sqrt(covariance[5][5])), reach);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) turn.m[i][j] = covariance[i][j];
    mat3_eigen_symmetric(turn, values, &vectors);
    to->turn_error = width * sqrt(fmax(values[2], 0)) * 180 / M_PI;
    return isfinite(to->error.x + to->error.y + to->error.z + to->turn_error);
}

enum status resection_find(struct resection *r, const struct camera *lens, const struct resection_mark *marks,
                           int count, double click, const char *name, struct err *err)
{
    struct candidate starts[STARTS], found[STARTS];
    struct rays rays;
    int found_count = 0;
    *r = (struct resection){0};
    if (count < RESECTION_MIN || count > RESECTION_MAX)
        return err_set(err, ST_DATA, "image %s has %d marks, wanted %d to %d.", name, count, (int)RESECTION_MIN,
                       (int)RESECTION_MAX);
    if (prepare_rays(&rays, lens, marks, count, name, err)) return err->status;
    const int start_count = find_starts(starts, &rays);
    for (int i = 0; i < start_count; i++) refine(found, &found_count, &rays, &starts[i]);
    double limit = INFINITY;
    for (int i = 0; i < found_count && r->count < RESECTION_POSES && found[i].squares <= limit; i++) {
        if (!measure(&r->poses[r->count], &rays, &found[i], lens, click)) continue;
        const int freedom = 2 * count - UNKNOWNS;
        const double variance = freedom ? found[i].squares / freedom : 0;
        if (!r->count++) limit = found[i].squares + NEARLY * fmax(variance, click * click);
    }
    if (r->count) return ST_OK;
    return err_set(err, ST_DATA,
                   "image %s has marks that no pose of a camera explains, or that lie on a line; mark at least four "
                   "corners that are not on a line.",
                   name);
}
