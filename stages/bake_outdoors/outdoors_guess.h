/* outdoors_guess.h - what lies in directions that no picture shows. */
#ifndef REMODEL_OUTDOORS_GUESS_H
#define REMODEL_OUTDOORS_GUESS_H

#include "common/texture/outdoors.h"
#include "stages/bake_outdoors/sky_fit.h"

/* Fills what no picture shows. Without any known pixel the picture stays black. to_sun: unit direction of the sun, NULL
 * if it is unknown. *sky: the sky that was fitted. ST_NOMEM. Same bits for any number of threads. */
enum status outdoors_guess(struct outdoors *o, const struct vec3 *to_sun, struct sky_fit *sky, struct err *err);

#endif
