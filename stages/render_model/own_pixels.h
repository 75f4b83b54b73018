/* own_pixels.h - the pixels of an original view that an edit leaves alone [Colburn 2014, 4.6]. */
#ifndef REMODEL_RENDER_OWN_PIXELS_H
#define REMODEL_RENDER_OWN_PIXELS_H

#include "stages/render_model/drawn_room.h"

/* Sets same[y * width + x] to 1 where the view's photo shows what it would show after the edit: the unedited and the
 * edited model have the same face in the same plane with the same texture, there and within `margin` px, and no clutter
 * is cleared there. Panes of glass count as faces. Without an edit all is 1. gone: gets 1 where what the photo shows is
 * left out. */
enum status own_pixels_find(uint8_t *same, uint8_t *gone, const struct room *room, int view, struct provenance *prov,
                            struct err *err);

/* Gives `picture` the photo's own pixels where `same` is 1. Where the view looks past the photo's border nothing is
 * shown. */
enum status own_pixels_draw(struct model_picture *picture, const uint8_t *same, const struct room *room, int view,
                            struct provenance *prov, struct err *err);

#endif
