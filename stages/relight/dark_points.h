/* dark_points.h - quotients of furniture whose point lies where no light comes. */
#ifndef REMODEL_RELIGHT_DARK_POINTS_H
#define REMODEL_RELIGHT_DARK_POINTS_H

#include "common/gather/irradiance.h"
#include "stages/relight/pixels.h"

/* Furniture without light before the edit, or after it, takes the mean quotient of the nearest pixels that have one,
 * and counts as bounded. Where no pixel has one, all stay. Same bits for any number of threads. ST_NOMEM. */
enum status dark_points_fill(float (*quotient)[4], const struct irradiance *before, const struct irradiance *after,
                             const struct pixels *p, bool things, struct err *err);

#endif
