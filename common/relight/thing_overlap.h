/* thing_overlap.h - how deep a thing would stand in another one. */
#ifndef REMODEL_THING_OVERLAP_H
#define REMODEL_THING_OVERLAP_H

#include "common/model/thing_volume.h"
#include "common/relight/placed_thing.h"

/* Sets *depth to the smallest shift of `a`, in one of eight directions or upwards, that takes it out of `b`; 0 if they
 * overlap by no more than outlines are off. other: the number of `b` in the volume; b NULL: the thing of
 * that number, where it was photographed. Same bits for any number of threads. ST_NOMEM. */
enum status thing_overlap_depth(double *depth, const struct thing_volume *v, const struct placed_thing *a,
                                const struct placed_thing *b, uint32_t other, struct err *err);

#endif
