/* quantities.h - areas of faces and the schedule of openings, as CSV.
 *
 * metric: lengths are in metres, and the heads of columns say so; otherwise they are in the unit of the model. */
#ifndef REMODEL_LEVELS_QUANTITIES_H
#define REMODEL_LEVELS_QUANTITIES_H

#include "common/model/model_plan.h"
#include "stages/light_levels/level_scene.h"

/* A line a face name: its area, and the part of light that it reflects. Faces that look outdoors are left out; of a
 * pane one side counts. */
enum status quantities_write(const struct level_light *light, bool metric, const char *path, struct err *err);
/* A line an opening of a wall, a ceiling or a floor. */
enum status quantities_write_openings(const struct model_plan *plan, bool metric, const char *path, struct err *err);

#endif
