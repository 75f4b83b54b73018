/* match.h - which point of one picture is which of the other, pixel by pixel and in both directions.
 *
 * A flow is, for each pixel of a picture, the way to the same thing's place in the other one, px (x right, y down). */
#ifndef REMODEL_MORPH_MATCH_H
#define REMODEL_MORPH_MATCH_H

#include "stages/morph_views/geometry.h"
#include "stages/morph_views/morph_params.h"
#include "stages/morph_views/opencv_features.h"

struct flow {
    int width, height;
    float *uv;   /* w * h * 2; owned */
    float *sure; /* w * h: 0 (guessed from the neighbourhood, or hidden in the other picture) to 1 */
    float *near; /* w * h: greater where nearer, comparable among neighbours; all 0 if that is not known */
};
enum status flow_init(struct flow *f, int width, int height, struct err *err);
void flow_release(struct flow *f);

/* A picture as matching sees it: R G B of roughly even steps to the eye, the median grey at 0.5 whatever the
 * exposure. */
enum status match_image(struct image *out, const struct image *linear, struct err *err);

/* flows[0]: from first to second, flows[1]: back. Whole pixels at first, then parts. Both pictures have one size, as
 * match_image leaves them. Where the two flows contradict each other the flow is filled from the far side, and `sure`
 * is 0. Matches are tried wherever they are, whether they obey the geometry or not. Same bits for any number of
 * threads. */
enum status match_pictures(struct flow flows[2], const struct image pictures[2], const struct geometry *geometry,
                           const struct feature_match *matches, int match_count, const struct morph_params *params,
                           struct err *err);

/* The parts of it, for tests and benches: the discrete search; parts of pixels; what the two contradict, filled. */
enum status match_whole_pixels(struct flow *flow, const struct image pictures[2], int from,
                               const struct geometry *geometry, const struct feature_match *matches, int match_count,
                               const struct morph_params *params, struct err *err);
enum status flow_refine(struct flow *flow, const struct image pictures[2], int from, const struct geometry *geometry,
                        const struct morph_params *params, struct err *err);
enum status flow_check(struct flow flows[2], const struct image pictures[2], const struct geometry *geometry,
                       struct err *err);

#endif
