/* level_year.h - daylight over a year's hours, from a weather file. */
#ifndef REMODEL_LEVELS_YEAR_H
#define REMODEL_LEVELS_YEAR_H

#include "common/daylight/daylight_metrics.h"
#include "common/daylight/weather.h"
#include "stages/light_levels/level_sums.h"

/* Rooms that are darker or brighter than they seem, by so many standard errors of the model; the first one is as it
 * seems. */
enum { LEVEL_YEARS = 5 };
extern const double level_year_sigmas[LEVEL_YEARS];

/* Sets counts[k * points + i] of each point i and room k: of the hours of daylight_metrics.h that the weather file has;
 * *hours of them. north: degrees in the model's frame. Same bits for any number of threads. ST_DATA: the file has none
 * of the hours. */
enum status level_year_count(struct daylight_point *counts, int *hours, const struct level_points *points,
                             const struct level_light *light, const struct weather *weather, double north,
                             const struct levels_params *params, struct err *err);

#endif
