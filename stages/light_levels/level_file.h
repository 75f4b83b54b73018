/* level_file.h - levels.txt and levels.exr: the illuminance at each point from each group, for sums of one's own. */
#ifndef REMODEL_LEVELS_FILE_H
#define REMODEL_LEVELS_FILE_H

#include "stages/light_levels/level_sums.h"
#include "stages/light_levels/sensors.h"

/* Writes both below a folder. */
enum status level_file_write(const struct level_points *points, const struct sensors *sensors,
                             const struct light_groups *groups, const char *folder, const struct provenance *prov,
                             struct err *err);

#endif
