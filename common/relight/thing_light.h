/* thing_light.h - what the surfaces of furniture send out, by the light that they get. */
#ifndef REMODEL_THING_LIGHT_H
#define REMODEL_THING_LIGHT_H

#include "common/gather/light_field.h"
#include "common/relight/light_things.h"

/* Sets the radiance of both sides of the things of `before`, and of `after`, whose triangles begin at `first` of all,
 * from the light in their fields. The fields see these very radiances, which hold the means that photos show when this
 * is called. after: things of `before`, each with all of its triangles once for each of its places. cube: the width of
 * what sends out alike. Same bits for any number of threads. ST_NOMEM. */
enum status thing_light_find(struct thing_surfaces *before, const struct light_field *was, struct thing_surfaces *after,
                             int first, const struct light_field *is, double cube, struct err *err);

#endif
