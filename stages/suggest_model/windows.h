/* windows.h - windows of a wall from what the views show of its plane. */
#ifndef REMODEL_WINDOWS_H
#define REMODEL_WINDOWS_H

#include "stages/suggest_model/suggest.h"
#include "stages/suggest_model/wall_raster.h"

/* Replaces the openings of a wall: adds those that the views show, and removes those, found from points, that the views
 * contradict or show better. */
enum status windows_suggest(struct suggestion *s, int wall, const struct wall_raster *raster,
                            const struct suggest_params *params, struct err *err);

#endif
