/* model_metre.h - how long a metre is in a model: known by the scene's scale, else guessed by its rooms' height. */
#ifndef REMODEL_MODEL_METRE_H
#define REMODEL_MODEL_METRE_H

#include "common/model/model_axes.h"
#include "common/model/model_plan.h"

struct model_metre {
    double units;     /* of the model */
    double low, high; /* 95 % of a guess; both are `units` where the scale is known */
    bool guessed;
};

/* typical: the height of rooms, m, that a guess goes by. A scene without a scale and without rooms has metres of one
 * unit. ST_NOMEM. */
enum status model_metre_find(struct model_metre *m, const struct model_axes *axes, const struct model_plan *plan,
                             double typical, struct err *err);

#define MODEL_METRE_ROOM 2.5 /* a typical height of rooms, m */
/* Room heights between which 95 % of homes lie, for messages. */
extern const double model_metre_heights[2];

#endif
