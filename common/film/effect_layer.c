/* effect_layer.c - interpolation of an effect layer's values and boxes.
 *
 * Keys and boxes are knots in time. Between two knots every number is linear in time, or a monotone cubic of itself
 * [Fritsch 1984]. For a box these numbers are its middle, half its size, and its fall-off: interpolated corners could
 * change places. Orientations follow the shortest rotation from one to the next [Shoemake 1985]. A cubic interpolates
 * the sum of the angles, so that the speed of turning has no jump at a knot; its axis may change there. */
#include "common/film/effect_layer.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/monotone.h"

void effect_layer_release(struct effect_layer *l)
{
    if (!l) return;
    free(l->name);
    free(l->boxes);
    free(l->keys);
    *l = (struct effect_layer){0};
}

/* The knots around a time. Outside all knots the two around it are the same; beside the first and the last there is
 * no other, and the knot is repeated. */
struct span {
    int knot[4]; /* the two around the time are the second and the third */
    double time[4];
    double t; /* 0 at the second knot, 1 at the third */
};

/* first: the first of `count` knots of `size` bytes, which begin with their time. */
static struct span span_at(const void *first, size_t size, int count, double time)
{
    const char *bytes = first;
    struct span s;
    double knot;
    int after = 0;

    for (; after < count; after++) {
        memcpy(&knot, bytes + (size_t)after * size, sizeof knot);
        if (knot > time) break;
    }
    s.knot[1] = after ? after - 1 : 0;
    s.knot[2] = after < count ? after : count - 1;
    const bool between = s.knot[1] < s.knot[2];
    s.knot[0] = between && s.knot[1] ? s.knot[1] - 1 : s.knot[1];
    s.knot[3] = between && s.knot[2] < count - 1 ? s.knot[2] + 1 : s.knot[2];
    for (int i = 0; i < 4; i++) memcpy(&s.time[i], bytes + (size_t)s.knot[i] * size, sizeof s.time[i]);
    s.t = between ? (time - s.time[1]) / (s.time[2] - s.time[1]) : 0;
    return s;
}

/* Slope at knot i, 1 or 2; 0 at the first and the last knot, where the value becomes constant. */
static double slope_at(const struct span *s, const double v[4], int i)
{
    const double h0 = s->time[i] - s->time[i - 1], h1 = s->time[i + 1] - s->time[i];
    return h0 > 0 && h1 > 0 ? monotone_slope(h0, (v[i] - v[i - 1]) / h0, h1, (v[i + 1] - v[i]) / h1) : 0;
}

/* A number at the span's time, from its values at the four knots. */
static double value_at(const struct span *s, enum effect_curve curve, const double v[4])
{
    const double h = s->time[2] - s->time[1];
    if (curve == EFFECT_CUBIC && h > 0)
        return monotone_value(v[1], v[2], h, slope_at(s, v, 1), slope_at(s, v, 2), s->t);
    return v[1] + s->t * (v[2] - v[1]);
}

void effect_layer_value(const struct effect_layer *l, double time, double value[3])
{
    const struct span s = span_at(l->keys, sizeof *l->keys, l->key_count, time);
    for (int k = 0; k < 3; k++) {
        double v[4];
        for (int i = 0; i < 4; i++) v[i] = l->keys[s.knot[i]].value[k];
        value[k] = value_at(&s, l->curve, v);
    }
}

bool effect_box_is_turned(const struct effect_box *box)
{
    const struct quat *q = &box->box_from_world;
    return q->w != 0 || q->x != 0 || q->y != 0 || q->z != 0;
}

static struct quat axes_of(const struct effect_box *box)
{
    return effect_box_is_turned(box) ? quat_normalize(box->box_from_world) : (struct quat){1, 0, 0, 0};
}

static struct quat rotation_at(const struct span *s, enum effect_curve curve, const struct effect_box *const b[4])
{
    double turned[4] = {0}; /* from the second knot */
    struct quat q[4];

    for (int i = 0; i < 4; i++) q[i] = axes_of(b[i]);
    turned[0] = -quat_angle(q[0], q[1]);
    turned[2] = quat_angle(q[1], q[2]);
    turned[3] = turned[2] + quat_angle(q[2], q[3]);
    const bool eased = curve == EFFECT_CUBIC && turned[2] > 0;
    return quat_slerp(q[1], q[2], eased ? value_at(s, curve, turned) / turned[2] : s->t);
}

void effect_layer_box(const struct effect_layer *l, double time, struct effect_box *box)
{
    enum { NUMBERS = 7 };
    double v[NUMBERS][4], at[NUMBERS];
    const struct effect_box *b[4];

    assert(l->box_count > 0);
    const struct span s = span_at(l->boxes, sizeof *l->boxes, l->box_count, time);
    for (int i = 0; i < 4; i++) b[i] = &l->boxes[s.knot[i]];
    *box = *b[1];
    box->time = time;
    if (effect_box_is_turned(b[1]) || effect_box_is_turned(b[2])) box->box_from_world = rotation_at(&s, l->curve, b);
    if (b[1] == b[2]) return;
    for (int i = 0; i < 4; i++) {
        const struct vec3 half = vec3_scale(vec3_sub(b[i]->high, b[i]->low), 0.5), middle = vec3_add(b[i]->low, half);
        const double numbers[] = {middle.x, middle.y, middle.z, half.x, half.y, half.z, b[i]->falloff};
        for (int k = 0; k < NUMBERS; k++) v[k][i] = numbers[k];
    }
    for (int k = 0; k < NUMBERS; k++) at[k] = value_at(&s, l->curve, v[k]);
    double *const low[] = {&box->low.x, &box->low.y, &box->low.z};
    double *const high[] = {&box->high.x, &box->high.y, &box->high.z};
    for (int k = 0; k < 3; k++) { /* rounding may lead beyond the limit */
        *low[k] = fmax(at[k] - at[3 + k], -MAX_EFFECT_COORDINATE);
        *high[k] = fmin(at[k] + at[3 + k], MAX_EFFECT_COORDINATE);
    }
    box->falloff = at[NUMBERS - 1];
}
