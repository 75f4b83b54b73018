/* effects.h - depth-localised effect layers: colours changed in a part of space, as it goes on in time (thesis 3.6.1).
 *
 * Layers are laid over a finished frame in the order written, each over what the ones before gave. Where a pixel is in
 * the world is told by the frame's z; the file is described in docs/formats.md. In scene-linear, premultiplied colour:
 *   saturation s   c + w (s - 1) (c - Y), Y the Rec.709 luminance, which stays; it ends where a colour would be below 0
 *   brightness b   c (1 + w (b - 1))
 *   color r g b    the same with a factor for each colour
 * w is 1 in the whole picture, or 1 in a box and exp(-d^2 / (2 falloff^2)) at distance d from it, or 1 less that. */
#ifndef REMODEL_EFFECTS_H
#define REMODEL_EFFECTS_H

#include "common/base/provenance.h"
#include "common/base/textfile.h"
#include "common/capture/camera_set.h"
#include "common/layers/rendered_frame.h"

#define EFFECT_LAYERS_MOST 64

enum effect_kind { EFFECT_SATURATION, EFFECT_BRIGHTNESS, EFFECT_COLOR };
enum effect_region { EFFECT_ALL, EFFECT_INSIDE, EFFECT_OUTSIDE };
enum effect_curve { EFFECT_LINEAR, EFFECT_CUBIC };

struct effect_key {
    double time;     /* seconds from the start of the path */
    double value[3]; /* of EFFECT_COLOR; of the others the first */
};

struct effect_layer {
    char *name;
    enum effect_kind kind;
    enum effect_region region;
    enum effect_curve curve; /* between keys */
    struct vec3 low, high;   /* corners of the box, in the world */
    double falloff;          /* scene units; 0: the box has a hard edge */
    struct effect_key *keys;
    int key_count;
};

struct effects { /* {0} is valid, and changes nothing */
    struct effect_layer *layers;
    int layer_count;
};

/* ST_DATA with file, line, what was found and what was wanted; e is left empty then. */
enum status effects_read(struct effects *e, const char *path, struct err *err);
/* The layers alone, from the next line of an open file to its end: what follows the first line of an effects file. */
enum status effects_read_layers(struct effects *e, struct textfile *t, struct err *err);
/* What is written reads back with the same bits. prov may be NULL. ST_DATA: layers that a file may not have. */
enum status effects_write(const struct effects *e, const char *path, const struct provenance *prov, struct err *err);
/* Moves the layers of `from`, which is empty then, behind those of `e`. ST_DATA: more than EFFECT_LAYERS_MOST. */
enum status effects_append(struct effects *e, struct effects *from, struct err *err);
void effects_release(struct effects *e);

/* Linear or a monotone cubic (common/math/monotone.h) between keys, held before the first and after the last; a cubic starts
 * and ends level. */
void effect_layer_value(const struct effect_layer *layer, double time, double value[3]);

/* Changes rgba of a frame of that camera; a pixel with z 0 is farther than any box. Layers that change nothing at
 * that time cost nothing and leave every bit. Colours do not go below 0. Same bits for any number of threads. */
void effects_apply(const struct effects *e, double time, const struct view *camera, struct rendered_frame *frame);

#endif
