/* hole_measure.h - severity of the holes in a picture [Colburn 2014, 3.4.2].
 *
 *   H = sum over the hole pixels of d^3 / (w h)
 *
 * d: distance in px from a hole pixel to the nearest pixel that is not a hole, in a picture whose longer side is
 * 1200 px. At s times that size d / s is used, so H does not depend on the resolution, except for holes too small to
 * resolve. A hole pixel is one that no segment covers, before any filling. */
#ifndef REMODEL_HOLE_MEASURE_H
#define REMODEL_HOLE_MEASURE_H

#include <stdint.h>

#include "common/base/err.h"

#define H_REFERENCE_SIDE 1200

/* hole: width * height, 1 at hole pixels; scratch: width * height. *h is INFINITY if every pixel is a hole.
 * ST_NOMEM. */
enum status hole_measure(double *h, const uint8_t *hole, int width, int height, float *scratch, struct err *err);

#endif
