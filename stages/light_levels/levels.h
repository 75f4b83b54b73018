/* levels.h - what a run of light_levels works with. */
#ifndef REMODEL_LEVELS_H
#define REMODEL_LEVELS_H

#include "common/daylight/lux_scale.h"
#include "common/daylight/weather.h"
#include "stages/light_levels/level_factors.h"
#include "stages/light_levels/level_sums.h"
#include "stages/light_levels/level_views.h"
#include "stages/light_levels/light_errors.h"
#include "stages/light_levels/sensors.h"
#include "stages/light_levels/sheet.h"

struct levels_files {
    struct light_change_files light;
    const char *fit, *sky; /* how far lamps, sun and sky may be off; NULL: not at all */
    const char *plan, *places, *states, *weather, *points, *before, *scale, *day, *factors;
    bool table; /* of `points`: all states */
    struct level_view_files shown;
    struct other_light_files other;
};

/* Everything but the paths is owned. */
struct levels_job {
    struct levels_files files;
    const char *out;
    struct levels_params params;
    struct provenance prov;
    struct level_scene scene;
    struct model_plan plan;
    struct place_list places;
    struct state_list states;
    struct level_light light;
    struct light_errors errors;
    struct sensors sensors;
    struct level_points levels; /* of the sensors */
    struct level_factors factors;
    struct other_light other; /* photos in states of switches */
    struct level_views views;
    struct light_sheet sheet, before;
    struct lux_scale scale;
    struct weather weather;
    struct sun_time day; /* where files.day names one */
};

/* Reads what the files name, computes, and writes the products below `out`. */
enum status levels_run(struct levels_job *j, struct err *err);
void levels_release(struct levels_job *j);

#endif
