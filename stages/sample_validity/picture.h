/* picture.h - picture of the regions of valid viewpoints, after [Colburn 2014, figure 3.1].
 *
 * Four maps: the start's above the end's; left how far back each cell is valid, right how far towards the scene. x of
 * the reference frame points right, y down. Colours run from dark blue (z = 0) through green to yellow (the farthest z
 * of the map); invalid cells are grey. The view mesh is drawn in white, the origin as a red dot. */
#ifndef REMODEL_SAMPLE_VALIDITY_PICTURE_H
#define REMODEL_SAMPLE_VALIDITY_PICTURE_H

#include "common/film/validity.h"

enum status validity_picture_write(const struct validity *v, const struct view_mesh *mesh, const char *path,
                                   struct err *err);

#endif
