/* texture_seams.h - gradients of an atlas across the boundaries between its sources, and beside them.
 *
 * A boundary pair is two neighbouring texels of a tile from two different views. Beside it are the pairs in the same
 * direction, up to SEAM_REACH texels farther on either side, whose two texels come from the same view. A pair's energy
 * is the sum over R, G, B of the squared difference in sRGB (white: `white`). */
#ifndef REMODEL_TEXTURE_SEAMS_H
#define REMODEL_TEXTURE_SEAMS_H

#include "common/texture/atlas.h"

#define SEAM_REACH 3 /* texels */

struct texture_seams { /* sums over pairs */
    double across, beside;
    uint64_t across_pairs, beside_pairs;
};

/* Adds a tile in a fixed order. Boundaries without any pair beside them are left out. */
void texture_seams_add(struct texture_seams *s, const struct atlas_page *page, const struct atlas_tile *tile,
                       double white);
/* The mean energy across over the mean energy beside; false: there is none. */
bool texture_seams_ratio(const struct texture_seams *s, double *ratio);

#endif
