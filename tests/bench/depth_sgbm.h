/* depth_sgbm.h - the baseline of the bench `depth`: OpenCV's semi-global matching, the usual first choice for depth
 * of a rectified pair. */
#ifndef REMODEL_BENCH_DEPTH_SGBM_H
#define REMODEL_BENCH_DEPTH_SGBM_H

#ifdef __cplusplus
extern "C" {
#endif
#include "common/base/err.h"

struct sgbm_settings {
    int disparities; /* 0 to this; a multiple of 16 */
    int block;       /* side of the compared block, px, odd */
    int p1, p2;      /* cost of a disparity change by one, or by more, per pixel of a block and channel */
    int uniqueness;  /* margin of the best match over the second, % */
    int widen;       /* match all columns: pads the pictures on the left by the number of disparities */
};

/* Disparities of `left`, px, 0 unknown, with one path in each of eight directions (MODE_HH). Pictures: 8-bit, 3
 * channels, w * h. Unless they are padded, as many columns on the left as there are disparities stay unknown. */
enum status sgbm_match(float *disparity, const unsigned char *left, const unsigned char *right, int width, int height,
                       const struct sgbm_settings *settings, struct err *err);

#ifdef __cplusplus
}
#endif
#endif
