/* level_script.h - levels.js: light by groups at the points of plans, for the page of light levels.
 *
 * One call, remodelLevels({...}), whose members docs/formats/light.md describes. */
#ifndef REMODEL_LEVEL_SCRIPT_H
#define REMODEL_LEVEL_SCRIPT_H

#include "common/daylight/lux_scale.h"
#include "common/model/model_plan.h"
#include "stages/light_levels/level_days.h"
#include "stages/light_levels/sensors.h"

struct level_script {
    const struct level_points *points;
    const struct sensors *sensors;
    const struct model_plan *plan;
    const struct level_light *light;
    const struct state_list *states;
    const struct levels_params *params;
    const struct lux_scale *scale;
    const struct sun_time *day; /* one more day; NULL: none */
    bool metric;
};

enum status level_script_write(const struct level_script *s, const char *path, struct err *err);

#endif
