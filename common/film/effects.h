/* effects.h - effect layers: keyframed colour changes of the picture or of a region of space [Colburn 2014, 3.6.1].
 *
 * Layers are applied to a finished frame in file order, each to the result of the layers before it. The frame's z gives
 * a pixel's position in the world; docs/formats.md describes the file. In scene-linear, premultiplied colour:
 *   saturation s   c + w (s - 1) (c - Y); keeps the Rec.709 luminance Y; limited so that no channel falls below 0
 *   brightness b   c (1 + w (b - 1))
 *   color r g b    as brightness, with a factor for each channel
 * Weight w: 1 for the whole picture; for a box, 1 inside and exp(-d^2 / (2 falloff^2)) at distance d from it; outside a
 * box, 1 minus that. A box may be turned, and may move over time (effect_layer.h). */
#ifndef REMODEL_EFFECTS_H
#define REMODEL_EFFECTS_H

#include "common/base/provenance.h"
#include "common/base/textfile.h"
#include "common/capture/camera_set.h"
#include "common/film/effect_layer.h"
#include "common/layers/rendered_frame.h"

#define MAX_EFFECT_LAYERS 64

struct effects { /* {0} is valid and changes nothing */
    struct effect_layer *layers;
    int layer_count;
};

/* ST_DATA with file, line, what was found and what was expected; on failure e is left empty. */
enum status effects_read(struct effects *e, const char *path, struct provenance *prov, struct err *err);
/* Reads the layers from the next line of an open file to its end: an effects file without its first line. */
enum status effects_read_layers(struct effects *e, struct textfile *t, struct err *err);
/* The file reads back to the same bits. prov may be NULL. ST_DATA: layers that effects_read would reject. */
enum status effects_write(const struct effects *e, const char *path, const struct provenance *prov, struct err *err);
/* Appends the layers of `from` to those of `e` and leaves `from` empty. On failure neither changes. ST_DATA: more than
 * MAX_EFFECT_LAYERS. */
enum status effects_append(struct effects *e, struct effects *from, struct err *err);
void effects_release(struct effects *e);

/* Applies the layers to the rgba of a frame rendered by `camera`. A pixel with z 0 is outside every box. Layers that
 * are the identity at `time` cost nothing and change no bit. Colours stay 0 or above. Same bits for any thread
 * count. */
void effects_apply(const struct effects *e, double time, const struct view *camera, struct rendered_frame *frame);

#endif
