/* gatherer.h - irradiance to a target error: chooses the estimator and its effort. */
#ifndef REMODEL_GATHER_GATHERER_H
#define REMODEL_GATHER_GATHERER_H

#include "common/base/param.h"
#include "common/gather/irradiance.h"

/* Parameters of every stage that gathers light: name, type, default, min, max, unit, help */
#define GATHER_PARAMS(X)                                                                                      \
    X(estimator, choice, "auto", 0, 0, "auto|rays|cache|hemicube",                                            \
      "how irradiance is computed; auto: rays at single points, the cache over a view")                       \
    X(target_error, double, 0.01, 0, 1, "",                                                                   \
      "relative error of irradiance at which a gather ends; 0: it always spends all that the next two allow") \
    X(hemicube, int, 512, 2, HEMICUBE_MAX, "px", "most pixels in a row of a hemicube; even")                  \
    X(rays, int, 65536, 64, 1 << 24, "", "most rays of a point, with rays")

struct gather_params {
    GATHER_PARAMS(PARAM_FIELD)
};
#define GATHER_PARAMS_DEFAULT        \
    {                                \
        GATHER_PARAMS(PARAM_DEFAULT) \
    }

/* ST_USAGE: values that contradict each other. */
enum status gather_params_check(const struct gather_params *p, struct err *err);

/* Whether pictures are to be gathered by the cache of irradiance; it needs a target above 0. */
bool gather_params_cache(const struct gather_params *p);

/* Owned by the caller; used by several threads at once. */
struct gatherer;
enum status gatherer_make(struct gatherer **g, const struct gather_params *p, struct err *err);
void gatherer_free(struct gatherer *g); /* NULL is allowed */

/* The irradiance at a point. `key` selects random numbers where an estimator uses some: the same key, point and field
 * give the same bits. */
void gatherer_irradiance(struct irradiance *e, const struct gatherer *g, const struct light_field *f,
                         struct gather_point p, uint64_t key);

#endif
