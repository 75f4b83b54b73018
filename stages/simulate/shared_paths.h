/* shared_paths.h - radiance along rays that hit surfaces close to each other: path tracing with shared paths.
 *
 * Each ray's path goes on from the surface that it hits, and where it ends up lights the surfaces of all other rays of
 * the group, too. The estimate of each ray has the same expectation as if it were traced alone. Units: radiance,
 * scene-linear Rec.709. */
#ifndef REMODEL_SIMULATE_SHARED_PATHS_H
#define REMODEL_SIMULATE_SHARED_PATHS_H

#include "stages/simulate/path_trace.h"

#define SHARED_RAYS 16 /* in a group; a multiple of RAY_PACKET, at most 32 */

/* Adds one estimate to radiance[i] for each ray i whose bit in `active` is set; the others are not read. s->sample
 * counts the estimates of the group; s must be made for at least SHARED_RAYS times their number. Adds the number of
 * rays traced to *rays. */
void shared_paths_radiance(struct rgb radiance[SHARED_RAYS], const struct world *w,
                           const struct path_ray ray[SHARED_RAYS], uint32_t active, const struct sobol *s,
                           uint64_t *rays);

#endif
