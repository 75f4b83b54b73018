/* support.h - what a thing stands on or hangs from. */
#ifndef REMODEL_SUPPORT_H
#define REMODEL_SUPPORT_H

#include "common/light/model_rays.h"
#include "common/model/thing_list.h"
#include "common/model/thing_volume.h"

/* Sets box and number of voxels of each thing, `count` of them, and what supports it: that of floor, wall and ceiling
 * which is nearest to its lowest, side or highest voxels, if that is within `reach` (model units). */
void things_measure(struct thing *things, int count, const struct thing_volume *surfaces,
                    const struct model_rays *model, double reach);

/* How far the surface below a point is; infinite: there is none. */
double support_below(const struct model_rays *model, struct vec3 point);

#endif
