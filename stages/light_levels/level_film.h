/* level_film.h - a day as a film: the work planes on the plan, and a photograph in false colours and relit. */
#ifndef REMODEL_LEVEL_FILM_H
#define REMODEL_LEVEL_FILM_H

#include "common/daylight/weather.h"
#include "common/model/model_plan.h"
#include "stages/light_levels/level_days.h"
#include "stages/light_levels/level_views.h"
#include "stages/light_levels/sensors.h"

struct level_film {
    const struct level_points *points;
    const struct sensors *sensors;
    const struct model_plan *plan;
    const struct level_light *light;
    const struct level_views *views; /* the first one is shown; without any the plan alone */
    const struct state_list *states;
    const struct levels_params *params;
    const struct weather *weather; /* of which the day's sky is; NULL: a usual one of [light_levels] day_sky */
    const struct sun_time *day;
};

/* Frames every quarter of an hour while the sun is up. ST_DATA: no site is known, the sun does not rise, or the weather
 * file does not have the day; ST_IO: ffmpeg fails. */
enum status level_film_write(const struct level_film *f, const char *path, struct err *err);

#endif
