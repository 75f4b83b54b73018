/* level_table.h - light at points that somebody gave, in the frame of the scene, on stdout. */
#ifndef REMODEL_LEVEL_TABLE_H
#define REMODEL_LEVEL_TABLE_H

#include "stages/light_levels/levels.h"

/* Irradiance of the photographed state: lines X Y Z NX NY NZ R G B LOW HIGH, the last two the ends of the
 * interval of 95 %, as factors. */
enum status level_table_print(struct levels_job *j, struct err *err);
/* A column for each state of the sheet: illuminance in lx or, without a scale, in the photographs' unit; `-` where a
 * state needs the scale. The first line names them. */
enum status level_table_print_states(struct levels_job *j, struct err *err);

#endif
