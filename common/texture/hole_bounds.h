/* hole_bounds.h - keeps the colours of a filled hole within those around it. */
#ifndef REMODEL_TEXTURE_HOLE_BOUNDS_H
#define REMODEL_TEXTURE_HOLE_BOUNDS_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/err.h"
#include "common/texture/synthesis.h"

/* Sets limit[3 * texel] to the nearest colour within bounds for each unseen texel whose value lies beyond them, and
 * beyond[texel] to 1; else to 0. The bounds are those of the clean texels within `reach` of the nearest clean one,
 * nearest[texel]; negative: none, and no bounds. *any: some texel lies beyond. ST_NOMEM. */
enum status hole_bounds_find(float *limit, uint8_t *beyond, bool *any, const struct synthesis_picture *picture,
                             const int32_t *nearest, int reach, struct err *err);

#endif
