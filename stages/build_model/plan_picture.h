/* plan_picture.h - pictures for checking a model by eye: its plan, a view from above, its edges on the photographs. */
#ifndef REMODEL_BUILD_MODEL_PLAN_PICTURE_H
#define REMODEL_BUILD_MODEL_PLAN_PICTURE_H

#include "common/image/photo.h"
#include "common/model/solid_mesh.h"
#include "stages/build_model/layout.h"

#define PICTURE_FRUSTUM 0.35 /* length of a frustum's edges, for a room 2.5 units high */

/* SVG: walls, openings and boxes with their names, rooms with their sizes, the photographs' positions and fields of
 * view (up to 60 degrees to either side of their axes), a scale bar. placer may be NULL: no photographs. metric: units
 * are metres. */
enum status plan_picture_write(const struct plan *plan, const struct placer *placer, bool metric, const char *path,
                               struct err *err);

/* PNG: the mesh seen obliquely from above, orthographic, flat-shaded, cut below the ceilings, with the photographs'
 * frusta. */
enum status view_picture_write(const struct solid_mesh *mesh, const struct plan *plan, const struct placer *placer,
                               const char *path, struct err *err);

/* JPEG: the photograph, as it is stored, with the model's edges: bright where they are visible, thin where the model
 * hides them, blue for glass. At most `side` px wide and high. */
enum status overlay_write(const struct solid_mesh *mesh, const struct photo_camera *camera, const struct photo *photo,
                          int side, const char *path, struct err *err);

#endif
