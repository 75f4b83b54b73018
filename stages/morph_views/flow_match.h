/* flow_match.h - dense matching of two pictures: optical flow in both directions.
 *
 * The flow of a pixel leads to the same scene point in the other picture, px (x right, y down). */
#ifndef REMODEL_FLOW_MATCH_H
#define REMODEL_FLOW_MATCH_H

#include "stages/morph_views/epipolar.h"
#include "stages/morph_views/morph_params.h"
#include "stages/morph_views/opencv_features.h"

struct flow {
    int width, height;
    float *uv;         /* w * h * 2; all planes are owned */
    float *confidence; /* w * h: 0 (filled from neighbours, or hidden in the other picture) to 1 */
    float *nearness;   /* w * h: greater where nearer, comparable between neighbours; all 0 if unknown */
};
enum status flow_init(struct flow *f, int width, int height, struct err *err);
void flow_release(struct flow *f);

/* Prepares a picture for matching: R G B, perceptually nearly uniform, with the median grey at 0.5 for any exposure. */
enum status match_image(struct image *out, const struct image *linear, struct err *err);

/* flows[0]: from the first to the second picture; flows[1]: back. pictures: from match_image, of the same size. Feature
 * matches are candidates, whether they agree with the geometry or not. Where the two flows contradict each other, flow
 * is filled from the far side and confidence is 0. Same bits for any number of threads. */
enum status match_pictures(struct flow flows[2], const struct image pictures[2], const struct pair_geometry *geometry,
                           const struct feature_match *matches, int match_count, const struct morph_params *params,
                           struct err *err);

/* The steps of match_pictures: discrete search for whole-pixel flow (flow_match.c), subpixel refinement
 * (flow_refine.c), and left-right check with filling (flow_check.c). from: picture 0 or 1. */
enum status match_whole_pixels(struct flow *flow, const struct image pictures[2], int from,
                               const struct pair_geometry *geometry, const struct feature_match *matches,
                               int match_count, const struct morph_params *params, struct err *err);
enum status flow_refine(struct flow *flow, const struct image pictures[2], int from,
                        const struct pair_geometry *geometry, const struct morph_params *params, struct err *err);
enum status flow_check(struct flow flows[2], const struct image pictures[2], const struct pair_geometry *geometry,
                       struct err *err);

#endif
