/* view_tiles.h - the tiles of a viewpoint: for each of its views, the faces that it shows or may show after an edit. */
#ifndef REMODEL_VIEW_TILES_H
#define REMODEL_VIEW_TILES_H

#include "stages/bake_vdta/own_view.h"

/* Adds the tiles of one view to the bake, with their texels' roles and the viewpoint's own colours.
 *
 * all: every texel of every face in the frame, seen or hidden, as in the thesis. Otherwise what the view shows, and
 * what an edit reveals to it, each with a margin of MARGIN texels for viewpoints nearby.
 * view: index of the view in the viewpoint. Own texels are marked as made from ATLAS_VIEWS + view. */
enum status view_tiles_add(struct bake *b, const struct own_view *v, int view, bool all, struct err *err);

#endif
