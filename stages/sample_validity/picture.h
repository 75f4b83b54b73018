/* picture.h - regions of valid viewpoints to look at, as thesis figure 3.1.
 *
 * Four maps: start above end, and how far back (left) and how far towards the scene (right) a place is valid. A map has
 * the frame's x to the right and y down; a cell's colour goes from dark blue (z = 0) over green to yellow (the farthest
 * z of that map); what is not valid is grey. The view mesh is drawn over it in white, the origin as a red dot. */
#ifndef REMODEL_SAMPLE_VALIDITY_PICTURE_H
#define REMODEL_SAMPLE_VALIDITY_PICTURE_H

#include "common/film/validity.h"

enum status validity_picture_write(const struct validity *v, const struct view_mesh *mesh, const char *path,
                                   struct err *err);

#endif
