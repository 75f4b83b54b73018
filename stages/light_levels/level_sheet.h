/* level_sheet.h - fills the sheet: states, daylight factors, a year; and draws them on the plan. */
#ifndef REMODEL_LEVEL_SHEET_H
#define REMODEL_LEVEL_SHEET_H

#include "stages/light_levels/levels.h"

/* Writes O/lux/STATE.svg, then sheet.tsv. */
enum status level_sheet_make(struct levels_job *j, struct err *err);

#endif
