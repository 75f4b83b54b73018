/* plan_picture.h - the plan of a model as a picture, to check it by eye. */
#ifndef REMODEL_BUILD_MODEL_PLAN_PICTURE_H
#define REMODEL_BUILD_MODEL_PLAN_PICTURE_H

#include "stages/build_model/plan/plan.h"

#define PICTURE_FRUSTUM 0.35 /* length of a frustum's edges, for a room 2.5 units high */

/* SVG: walls, openings and boxes with their names, rooms with their sizes, the photographs' positions and fields of
 * view (up to 60 degrees to either side of their axes), a scale bar. placer may be NULL: no photographs. metric: units
 * are metres. */
enum status plan_picture_write(const struct plan *plan, const struct placer *placer, bool metric, const char *path,
                               struct err *err);
/* Where the picture has a point x, y of the model: x px = place[2] (x - place[0]), y px = place[2] (place[1] - y). */
void plan_picture_place(const struct plan *plan, const struct placer *placer, double place[3]);

#endif
