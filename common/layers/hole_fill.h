/* hole_fill.h - fills what a novel camera sees of no view, from the far side: a hole is where a near surface moved
 * away from a farther one, so the farther one is what belongs there (thesis 3.6.1).
 *
 * A hole is where alpha is 0. Holes narrower than `diameter` (no diameter x diameter square of hole pixels holds the
 * pixel): the mean of the known pixels in 7x7 by the soft z weights of the reversed depth (z normalised and reversed:
 * the farthest counts 1), repeated over what is filled so far until the far side has come across. Wider ones: a
 * pull-push pyramid with the same preference among each 2x2 and, coming back, among the four coarser neighbours.
 * Picture borders are no special case.
 */
#ifndef REMODEL_HOLE_FILL_H
#define REMODEL_HOLE_FILL_H

#include <stddef.h>
#include <stdint.h>

#include "common/layers/rendered_frame.h"
#include "common/layers/soft_z.h"

/* Fills rgba and z in the holes and sets unfilled_fraction. sigma: relative uncertainty of the depths, for
 * the width of the reversed soft z. diameter 0 fills nothing. Same bits for any number of threads. */
enum status hole_fill(struct rendered_frame *frame, const struct soft_z *soft, float sigma, int diameter,
                      struct err *err);

/* The narrow half, for a filler that does the wide holes otherwise: the pixels of holes that no diameter x diameter
 * square of hole pixels holds: *count of them, and behind them in the list the others, *empty in all; each in picture
 * order; the caller frees *list ... */
enum status hole_narrow_pixels(uint32_t **list, size_t *count, size_t *empty, const struct rendered_frame *frame,
                               int diameter, struct err *err);
/* ... and the filling of such pixels alone, from what is known as far as `diameter` around. */
enum status hole_fill_pixels(struct rendered_frame *frame, const uint32_t *list, size_t count,
                             const struct soft_z *soft, float sigma, int diameter, struct err *err);

#endif
