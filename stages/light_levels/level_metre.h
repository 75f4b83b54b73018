/* level_metre.h - how long a metre is in a model: known by the scene's scale, else guessed by its rooms' height. */
#ifndef REMODEL_LEVEL_METRE_H
#define REMODEL_LEVEL_METRE_H

#include "common/model/model_axes.h"
#include "common/model/model_plan.h"
#include "stages/light_levels/levels_params.h"

struct level_metre {
    double units;     /* of the model */
    double low, high; /* 95 % of a guess; both are `units` where the scale is known */
    bool guessed;
};

/* A scene without a scale and without rooms has metres of one unit. ST_NOMEM. */
enum status level_metre_find(struct level_metre *m, const struct model_axes *axes, const struct model_plan *plan,
                             const struct levels_params *params, struct err *err);

/* Room heights between which 95 % of homes lie, for messages. */
extern const double level_metre_heights[2];

#endif
