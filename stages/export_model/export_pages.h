/* export_pages.h - pages of an atlas as pictures of 8 bits for other programs. */
#ifndef REMODEL_EXPORT_PAGES_H
#define REMODEL_EXPORT_PAGES_H

#include "common/texture/atlas.h"

/* The exposure at which one texel in a hundred of the whole atlas is saturated: radiance times this is 1 at white. */
enum status export_exposure(double *exposure, const struct atlas *a, const char *folder, struct err *err);

/* OUT/pageN.png, sRGB. In a tile's rectangle texels that are missing take the nearest one of the tile, so that reading
 * between texels shows no dark seams. */
enum status export_pages_write(const struct atlas *a, const char *folder, double exposure, const char *out,
                               struct provenance *prov, struct err *err);

#endif
