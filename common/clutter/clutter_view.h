/* clutter_view.h - what a view shows in front of the model: its layers without the model's own surfaces, ready to be
 * drawn, and what it sees everywhere, by which it confirms or denies the clutter of other views. */
#ifndef REMODEL_CLUTTER_VIEW_H
#define REMODEL_CLUTTER_VIEW_H

#include "common/layers/layer_view.h"
#include "common/model/thing_mask.h"
#include "common/texture/view_ids.h"

/* What a view sees at a pixel, and within one pixel of it. */
struct clutter_sight {
    float nearest;  /* 1 / z of the nearest surface, 0: not known */
    uint8_t sure;   /* least confidence that the depths deserve, 255: full */
    uint8_t shows;  /* largest part of a pixel that clutter covers, 255: all */
    uint16_t thing; /* that the pixel itself shows; 0: none, or not known */
};

/* {0} is the empty state; everything is owned. Depths are in scene units. */
struct clutter_view {
    struct layered_depth depth;  /* size and segments only */
    struct layer_view layers;    /* texels of clutter; the others are empty. Its photo has things without depth, too */
    struct clutter_sight *sight; /* per pixel */
    size_t bytes;                /* of memory */
    bool knows_things;           /* thing of `sight` is set */
};

#define CLUTTER_SURE 255.0f

/* Takes the contents of `depth`, also on failure. ids: of the same view. things: of the same view; NULL: none are
 * known. ST_DATA: their sizes differ, or a pixel's id has no segment. */
enum status clutter_view_make(struct clutter_view *v, struct layered_depth *depth, const struct view_ids *ids,
                              const struct thing_mask *things, const char *name, struct err *err);
/* The clutter that the view shows at a position in its picture, bilinear: premultiplied colour, and how much of the
 * pixel it covers. */
void clutter_view_sample(float rgba[4], const struct clutter_view *v, double x, double y);
size_t clutter_view_bytes(const struct view *view); /* of memory that it needs, about */
void clutter_view_release(struct clutter_view *v);

#endif
