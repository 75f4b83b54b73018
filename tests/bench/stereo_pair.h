/* stereo_pair.h - the cameras that stereo_pair gives to a rectified pair, whose own are not known.
 *
 * Left and right look along z, PAIR_BASELINE apart along x, with this focal length at the size of the pictures and the principal point
 * in their middle. So z = PAIR_FOCAL PAIR_BASELINE / disparity. */
#ifndef REMODEL_BENCH_STEREO_PAIR_H
#define REMODEL_BENCH_STEREO_PAIR_H

#define PAIR_FOCAL    1000.0 /* px */
#define PAIR_BASELINE 1.0

#endif
