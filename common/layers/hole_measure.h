/* hole_measure.h - how bad the holes of a picture are (thesis 3.4.2).
 *
 *   H = sum over the hole pixels of d^3 / (w h)
 * d: the distance in px from a hole pixel to the nearest one that is none, of a picture whose longer side is 1200 px. A
 * picture at s times that size is measured with d / s, so that H does not depend on how large holes are looked at, but
 * for what is too small to be seen. A hole is a pixel that no segment covers, before anything is filled. */
#ifndef REMODEL_HOLE_MEASURE_H
#define REMODEL_HOLE_MEASURE_H

#include <stdint.h>

#include "common/base/err.h"

#define H_REFERENCE_SIDE 1200

/* hole: width * height, 1 where there is a hole; scratch: as many. INFINITY if nothing else is there. */
enum status hole_measure(double *h, const uint8_t *hole, int width, int height, float *scratch, struct err *err);

#endif
