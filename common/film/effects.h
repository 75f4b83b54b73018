/* effects.h - effect layers: keyframed colour changes of the picture or of a region of space [Colburn 2014, 3.6.1].
 *
 * Layers are applied to a finished frame in file order, each to the result of the layers before it. The frame's z gives
 * a pixel's position in the world; docs/formats.md describes the file. In scene-linear, premultiplied colour:
 *   saturation s   c + w (s - 1) (c - Y); keeps the Rec.709 luminance Y; limited so that no channel falls below 0
 *   brightness b   c (1 + w (b - 1))
 *   color r g b    as brightness, with a factor for each channel
 * Weight w: 1 for the whole picture; for a box, 1 inside and exp(-d^2 / (2 falloff^2)) at distance d from it; outside a
 * box, 1 minus that. */
#ifndef REMODEL_EFFECTS_H
#define REMODEL_EFFECTS_H

#include "common/base/provenance.h"
#include "common/base/textfile.h"
#include "common/capture/camera_set.h"
#include "common/layers/rendered_frame.h"

#define MAX_EFFECT_LAYERS 64

enum effect_kind { EFFECT_SATURATION, EFFECT_BRIGHTNESS, EFFECT_COLOR };
enum effect_region { EFFECT_ALL, EFFECT_INSIDE, EFFECT_OUTSIDE };
enum effect_curve { EFFECT_LINEAR, EFFECT_CUBIC };

struct effect_key {
    double time;     /* seconds from the start of the path */
    double value[3]; /* EFFECT_COLOR: red, green, blue; other kinds use the first only */
};

struct effect_layer {
    char *name;
    enum effect_kind kind;
    enum effect_region region;
    enum effect_curve curve; /* interpolation between keys */
    struct vec3 low, high;   /* corners of the box, in the world */
    double falloff;          /* scene units; 0: hard edge */
    struct effect_key *keys;
    int key_count;
};

struct effects { /* {0} is valid and changes nothing */
    struct effect_layer *layers;
    int layer_count;
};

/* ST_DATA with file, line, what was found and what was expected; on failure e is left empty. */
enum status effects_read(struct effects *e, const char *path, struct err *err);
/* Reads the layers from the next line of an open file to its end: an effects file without its first line. */
enum status effects_read_layers(struct effects *e, struct textfile *t, struct err *err);
/* The file reads back to the same bits. prov may be NULL. ST_DATA: layers that effects_read would reject. */
enum status effects_write(const struct effects *e, const char *path, const struct provenance *prov, struct err *err);
/* Appends the layers of `from` to those of `e` and leaves `from` empty. On failure neither changes. ST_DATA: more than
 * MAX_EFFECT_LAYERS. */
enum status effects_append(struct effects *e, struct effects *from, struct err *err);
void effects_release(struct effects *e);

/* Interpolates between keys: linearly, or by a monotone cubic (common/math/monotone.h) with slope 0 at the first and
 * the last key. Constant before the first key and after the last. */
void effect_layer_value(const struct effect_layer *layer, double time, double value[3]);

/* Applies the layers to the rgba of a frame rendered by `camera`. A pixel with z 0 is outside every box. Layers that
 * are the identity at `time` cost nothing and change no bit. Colours stay 0 or above. Same bits for any thread
 * count. */
void effects_apply(const struct effects *e, double time, const struct view *camera, struct rendered_frame *frame);

#endif
