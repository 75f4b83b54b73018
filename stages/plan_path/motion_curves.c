/* motion_curves.c - curves through keys.
 *
 * Shape and timing of a path are separate. The shape is a cubic Hermite spline over chord length. Its tangent at a key
 * is the mean of the directions of the adjoining chords, which is the direction of a centripetal Catmull-Rom spline: no
 * loops, no cusps, and a line stays a line [Yuksel 2011]. The timing is a monotone cubic (common/math/monotone.h) from
 * time to chord length: a key's time changes the camera's speed but not its path, and the camera never overshoots a
 * key, whereas a C2 spline over time could leave the region that the photos cover. Keys at constant velocity give
 * constant velocity.
 *
 * Orientations are handled alike, over the sum of the angles between keys. Their shape is the cubic in cumulative form
 * of [Kim 1995], q0 exp(w1 b1) exp(w2 b2) exp(w3 b3), whose angular velocities at the ends are 3 w1 and 3 w3. */
#include "stages/plan_path/motion_curves.h"

#include <stdlib.h>

#include "common/math/monotone.h"

#define MIN_DISTANCE 1e-12 /* relative to the distance from the origin: a shorter chord's direction is rounding noise */
#define MIN_ANGLE    1e-9  /* radians, likewise */

/* ---------------------------------------------------------------------------------------------------------- numbers */

enum status curve_init(struct curve *c, int count, struct err *err)
{
    const size_t n = (size_t)(count > 0 ? count : 1);
    *c = (struct curve){.time = calloc(3 * n, sizeof *c->time), .count = count};
    if (!c->time) return err_nomem(err, "keys", 3 * n * sizeof *c->time);
    c->value = c->time + n;
    c->slope = c->value + n;
    return ST_OK;
}

void curve_release(struct curve *c)
{
    if (!c) return;
    free(c->time);
    *c = (struct curve){0};
}

void curve_fit(struct curve *c, bool rest)
{
    const double *t = c->time, *v = c->value;
    const int n = c->count;
#define H(i) (t[(i) + 1] - t[i])
#define S(i) ((v[(i) + 1] - v[i]) / H(i))
    for (int i = 1; i < n - 1; i++) c->slope[i] = monotone_slope(H(i - 1), S(i - 1), H(i), S(i));
    if (n == 2) c->slope[0] = c->slope[1] = S(0);
    if (n > 2) {
        c->slope[0] = monotone_end_slope(H(0), S(0), H(1), S(1));
        c->slope[n - 1] = monotone_end_slope(H(n - 2), S(n - 2), H(n - 3), S(n - 3));
    }
#undef H
#undef S
    if (n && (rest || n == 1)) c->slope[0] = c->slope[n - 1] = 0;
}

/* Index of the last key at or before `time`; the time is at or after the first key and before the last. */
static int interval_of(const struct curve *c, double time)
{
    int low = 0, high = c->count - 1;
    while (high - low > 1) {
        const int mid = low + (high - low) / 2;
        if (c->time[mid] <= time)
            low = mid;
        else
            high = mid;
    }
    return low;
}

double curve_at(const struct curve *c, double time)
{
    if (!(time > c->time[0])) return c->value[0];
    if (time >= c->time[c->count - 1]) return c->value[c->count - 1];
    const int i = interval_of(c, time);
    const double h = c->time[i + 1] - c->time[i];
    return monotone_value(c->value[i], c->value[i + 1], h, c->slope[i], c->slope[i + 1], (time - c->time[i]) / h);
}

/* ------------------------------------------------------------------------------------------------------ quaternions */

/* The rotation by the length of a vector about its direction. */
static struct quat quat_exp(struct vec3 v)
{
    const double angle = vec3_length(v), part = angle > 0 ? sin(angle / 2) / angle : 0.5;
    return (struct quat){cos(angle / 2), part * v.x, part * v.y, part * v.z};
}

/* The inverse of quat_exp, of length <= pi. */
static struct vec3 quat_log(struct quat q)
{
    const struct vec3 v = vec3_scale(vec3_make(q.x, q.y, q.z), q.w < 0 ? -1 : 1);
    const double sine = vec3_length(v);
    return vec3_scale(v, sine > 0 ? 2 * atan2(sine, fabs(q.w)) / sine : 2);
}

struct quat motion_rotation_between(struct quat a, struct quat b, struct vec3 da, struct vec3 db, double t)
{
    const struct vec3 first = vec3_scale(da, 1.0 / 3), last = vec3_scale(db, 1.0 / 3);
    const struct quat from = quat_multiply(a, quat_exp(first)), to = quat_multiply(b, quat_exp(vec3_scale(last, -1)));
    const struct vec3 middle = quat_log(quat_multiply(quat_conjugate(from), to));
    const double u = 1 - t;
    struct quat q = quat_multiply(a, quat_exp(vec3_scale(first, 1 - u * u * u)));
    q = quat_multiply(q, quat_exp(vec3_scale(middle, t * t * (3 - 2 * t))));
    q = quat_multiply(q, quat_exp(vec3_scale(last, t * t * t)));
    return quat_normalize(q);
}

struct vec3 motion_position_between(struct vec3 a, struct vec3 b, struct vec3 da, struct vec3 db, double t)
{
    const double u = 1 - t;
    const struct vec3 bend = vec3_sub(vec3_scale(da, u), vec3_scale(db, t));
    return vec3_add(vec3_add(a, vec3_scale(vec3_sub(b, a), t * t * (3 - 2 * t))), vec3_scale(bend, t * u));
}

/* ----------------------------------------------------------------------------------------------------------- motion */

enum status motion_init(struct motion *m, int count, struct err *err)
{
    const size_t n = (size_t)(count > 0 ? count : 1);
    *m = (struct motion){.count = count};
    m->position = calloc(3 * n, sizeof *m->position);
    m->rotation = calloc(n, sizeof *m->rotation);
    if (!m->position || !m->rotation) return err_nomem(err, "keys", 3 * n * sizeof *m->position);
    m->tangent = m->position + n;
    m->rotation_tangent = m->tangent + n;
    return curve_init(&m->distance, count, err) || curve_init(&m->angle, count, err) ? err->status : ST_OK;
}

void motion_release(struct motion *m)
{
    if (!m) return;
    free(m->position);
    free(m->rotation);
    curve_release(&m->distance);
    curve_release(&m->angle);
    *m = (struct motion){0};
}

/* In: the chord from each key to the next. Out: the running sum of the chords' lengths, and in `chord` the tangents at
 * the keys: the mean of the directions of the nearest chords before and after that are longer than 0. */
static void fit_shape(struct vec3 *chord, double *sum, int count)
{
    struct vec3 before = {0};
    sum[0] = 0;
    for (int i = 0; i < count - 1; i++) {
        sum[i + 1] = sum[i] + vec3_length(chord[i]);
        chord[i] = sum[i + 1] > sum[i] ? vec3_normalize(chord[i]) : vec3_make(0, 0, 0);
    }
    chord[count - 1] = vec3_make(0, 0, 0);
    for (int i = count - 2; i >= 0; i--) /* each key: the direction of the next chord */
        if (!(vec3_length(chord[i]) > 0)) chord[i] = chord[i + 1];
    for (int i = 0; i < count; i++) {
        const struct vec3 after = chord[i];
        const bool moved = vec3_length(before) > 0, moves = vec3_length(after) > 0;
        chord[i] = moved && moves ? vec3_scale(vec3_add(before, after), 0.5) : moved ? before : after;
        if (i < count - 1 && sum[i + 1] > sum[i]) before = after;
    }
}

void motion_fit(struct motion *m, bool rest)
{
    for (int i = 0; i < m->count; i++) m->angle.time[i] = m->distance.time[i];
    for (int i = 0; i < m->count - 1; i++) {
        const double far = fmax(vec3_length(m->position[i]), vec3_length(m->position[i + 1]));
        m->tangent[i] = vec3_sub(m->position[i + 1], m->position[i]);
        m->rotation_tangent[i] = quat_log(quat_multiply(quat_conjugate(m->rotation[i]), m->rotation[i + 1]));
        if (!(vec3_length(m->tangent[i]) > MIN_DISTANCE * far)) m->tangent[i] = vec3_make(0, 0, 0);
        if (!(vec3_length(m->rotation_tangent[i]) > MIN_ANGLE)) m->rotation_tangent[i] = vec3_make(0, 0, 0);
    }
    fit_shape(m->tangent, m->distance.value, m->count);
    fit_shape(m->rotation_tangent, m->angle.value, m->count);
    curve_fit(&m->distance, rest);
    curve_fit(&m->angle, rest);
}

void motion_at(const struct motion *m, double time, struct vec3 *position, struct quat *rotation)
{
    const double *length = m->distance.value, *angle = m->angle.value;
    int i = 0;
    if (time >= m->distance.time[m->count - 1])
        i = m->count - 1;
    else if (time > m->distance.time[0])
        i = interval_of(&m->distance, time);
    *position = m->position[i];
    *rotation = m->rotation[i];
    if (i == m->count - 1 || !(time > m->distance.time[i])) return;
    double h = length[i + 1] - length[i];
    if (h > 0)
        *position =
            motion_position_between(m->position[i], m->position[i + 1], vec3_scale(m->tangent[i], h),
                                    vec3_scale(m->tangent[i + 1], h), (curve_at(&m->distance, time) - length[i]) / h);
    h = angle[i + 1] - angle[i];
    if (h > 0)
        *rotation = motion_rotation_between(m->rotation[i], m->rotation[i + 1], vec3_scale(m->rotation_tangent[i], h),
                                            vec3_scale(m->rotation_tangent[i + 1], h),
                                            (curve_at(&m->angle, time) - angle[i]) / h);
}

void motion_rates(const struct motion *m, bool last, struct vec3 *velocity, struct vec3 *angular_velocity)
{
    const int i = last ? m->count - 1 : 0;
    *velocity = vec3_scale(m->tangent[i], m->distance.slope[i]);
    *angular_velocity = vec3_scale(m->rotation_tangent[i], m->angle.slope[i]);
}
