/* flicker.h - how steady the light of a relit film is. */
#ifndef REMODEL_FLICKER_H
#define REMODEL_FLICKER_H

#include "common/image/exr.h"
#include "common/texture/model_picture.h"
#include "stages/evaluate/measure/quantiles.h"

/* A frame before it was relit, and the quotient of its luminance after to before. {0} is the empty state; owned. */
struct film_frame {
    struct model_picture unlit;
    float *quotient; /* a pixel; below 0: furniture, the outdoors, an object, or dark */
};

/* Sets the quotients from the unlit picture, which is there, and the relit frame, as relight --frames writes it.
 * ST_DATA: the frame at PATH is another one, or damaged. */
enum status flicker_frame_set_quotients(struct film_frame *f, const struct exr_image *relit, const char *path,
                                        struct err *err);
void flicker_frame_release(struct film_frame *f);

/* Adds, for every pixel of a frame whose place the next one shows too, the relative difference of the place's quotients
 * in the two. Places whose light does not change by RELIT_CHANGE in either do not count. Returns the number added. */
uint64_t flicker_add(struct quantiles *differences, const struct film_frame *frame, const struct film_frame *next);

#endif
