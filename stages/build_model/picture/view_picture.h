/* view_picture.h - a model seen from above, to check it by eye. */
#ifndef REMODEL_VIEW_PICTURE_H
#define REMODEL_VIEW_PICTURE_H

#include "common/model/solid_mesh.h"
#include "stages/build_model/plan/plan.h"

/* PNG: the mesh seen obliquely from above, orthographic, flat-shaded, cut below the ceilings, with the photographs'
 * frusta. */
enum status view_picture_write(const struct solid_mesh *mesh, const struct plan *plan, const struct placer *placer,
                               const char *path, struct err *err);

#endif
