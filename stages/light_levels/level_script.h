/* level_script.h - levels.js: light by groups at the points of plans, for the page of light levels.
 *
 * One call, remodelLevels({...}), whose members docs/formats/light.md describes. */
#ifndef REMODEL_LEVEL_SCRIPT_H
#define REMODEL_LEVEL_SCRIPT_H

#include "common/daylight/lux_scale.h"
#include "common/model/model_plan.h"
#include "stages/light_levels/light_errors.h"
#include "stages/light_levels/relit_light.h"
#include "stages/light_levels/sensors.h"

/* The points of work planes and places that plans show; owned. */
struct script_points {
    int *chosen, count, stride;
};

struct level_script {
    const struct script_points *chosen;
    const struct relit_light *relit; /* of these points */
    const struct level_days *days;
    const struct sensors *sensors;
    const struct model_plan *plan;
    const struct state_list *states;
    const struct levels_params *params;
    const struct lux_scale *scale;
    const struct light_errors *errors;
    const struct model_metre *metre;
    bool metric;
};

/* The caller frees p->chosen in each case. ST_NOMEM. */
enum status level_script_choose(struct script_points *p, const struct sensors *s, struct err *err);
enum status level_script_write(const struct level_script *s, const char *path, struct err *err);

#endif
