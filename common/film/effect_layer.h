/* effect_layer.h - one effect layer: what it changes, where, and its interpolation over time (effects.h).
 *
 * A layer has keys of its value and, unless it applies to the whole picture, keys of its box. Scene units, seconds from
 * the start of the path. */
#ifndef REMODEL_EFFECT_LAYER_H
#define REMODEL_EFFECT_LAYER_H

#include <stdbool.h>

#include "common/math/vec.h"

#define MAX_EFFECT_COORDINATE 1e9 /* of a box, in magnitude */

enum effect_kind { EFFECT_SATURATION, EFFECT_BRIGHTNESS, EFFECT_COLOR };
enum effect_region { EFFECT_ALL, EFFECT_INSIDE, EFFECT_OUTSIDE };
enum effect_curve { EFFECT_LINEAR, EFFECT_CUBIC };

struct effect_key {
    double time;
    double value[3]; /* EFFECT_COLOR: red, green, blue; other kinds use the first only */
};

/* A box around the middle of low and high. A point p is at box_from_world (p - middle) along the box's axes, and the
 * box's size along them is high - low. */
struct effect_box {
    double time;
    struct vec3 low, high;      /* corners in the world of the box before it is turned about its middle */
    double falloff;             /* 0: hard edge */
    struct quat box_from_world; /* of any length; {0}: the world's axes */
};

struct effect_layer {
    char *name;
    enum effect_kind kind;
    enum effect_region region;
    enum effect_curve curve; /* interpolation between keys, and between boxes */
    struct effect_box *boxes;
    int box_count; /* 0 for EFFECT_ALL, otherwise 1 or more */
    struct effect_key *keys;
    int key_count;
};

void effect_layer_release(struct effect_layer *layer);

/* Interpolates between keys: linearly, or by a monotone cubic (common/math/monotone.h) with slope 0 at the first and
 * the last key. Constant before the first key and after the last. */
void effect_layer_value(const struct effect_layer *layer, double time, double value[3]);

/* The box at a time, in the same way: its middle, size and fall-off, and the angle along the shortest rotation from one
 * box's axes to the next one's. box_from_world gets unit length, or stays {0}. The layer has a box. */
void effect_layer_box(const struct effect_layer *layer, double time, struct effect_box *box);

/* Whether a box has axes of its own. */
bool effect_box_is_turned(const struct effect_box *box);

#endif
