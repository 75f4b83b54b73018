/* thing_overlap.h - how deep a thing would stand in another one. */
#ifndef REMODEL_THING_OVERLAP_H
#define REMODEL_THING_OVERLAP_H

#include "common/relight/placed_things.h"

/* Sets *depth to the least shift of `a`, to one of eight sides or up, after which it stands in `b` no more; 0: it does
 * not stand in it, or by no more than outlines are off. b NULL: the thing `other`, where it was photographed. What lies
 * flat is not solid: the depth is 0. Same bits for any number of threads. ST_NOMEM. */
enum status thing_overlap_depth(double *depth, const struct placed_things *t, const struct placed_thing *a,
                                const struct placed_thing *b, uint32_t other, struct err *err);

#endif
