/* depth_sgbm.h - the baseline of the bench `depth`: OpenCV's semi-global matching, which is what programs that need
 * depth from a rectified pair call first. */
#ifndef REMODEL_BENCH_DEPTH_SGBM_H
#define REMODEL_BENCH_DEPTH_SGBM_H

#ifdef __cplusplus
extern "C" {
#endif
#include "common/base/err.h"

struct sgbm_settings {
    int disparities; /* 0 .. this, a multiple of 16 */
    int block;       /* px, odd: what is compared */
    int p1, p2;      /* what a change of disparity by one, or by more, costs; a pixel of a block and a channel */
    int uniqueness;  /* %: by how much the best must win */
    int widen;       /* match all columns: the pictures get as many more on the left as there are disparities */
};

/* Disparities of `left`, px, 0 unknown, one path in each of eight directions (MODE_HH).
 * Pictures: 8-bit, 3 channels, w * h. Of themselves they give no disparity to as many columns on the left as there are
 * disparities. */
enum status sgbm_match(float *disparity, const unsigned char *left, const unsigned char *right, int width, int height,
                       const struct sgbm_settings *settings, struct err *err);

#ifdef __cplusplus
}
#endif
#endif
