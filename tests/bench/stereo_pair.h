/* stereo_pair.h - the cameras that stereo_pair assigns to a rectified pair, because its own are unknown.
 *
 * Left and right have parallel axes along z, PAIR_BASELINE apart along x, this focal length at the size of the
 * pictures, and the principal point in their centre. So z = PAIR_FOCAL PAIR_BASELINE / disparity. */
#ifndef REMODEL_BENCH_STEREO_PAIR_H
#define REMODEL_BENCH_STEREO_PAIR_H

#define PAIR_FOCAL    1000.0 /* px */
#define PAIR_BASELINE 1.0

#endif
