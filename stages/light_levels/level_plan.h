/* level_plan.h - illuminance of the work planes on the floor plan, in false colours with isolines. */
#ifndef REMODEL_LEVELS_PLAN_H
#define REMODEL_LEVELS_PLAN_H

#include "common/relight/planned_lamps.h"
#include "stages/light_levels/sensors.h"

/* What a picture shows: a value of each point, and its unit. */
struct level_picture {
    const char *title, *unit;
    const double *values;
    bool annual;                       /* in % of the hours of a year */
    const double (*ends)[2];           /* of each area: the ends of its mean's interval; NULL: none is known */
    const struct planned_lamps *lamps; /* NULL: none */
    const double *shines;              /* of each of them: 0 for those that are off */
};

enum status level_plan_write(const struct level_picture *picture, const struct sensors *sensors,
                             const struct model_plan *plan, const char *path, struct err *err);

#endif
