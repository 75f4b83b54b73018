/* relit.h - a picture under the light that an edit makes [Colburn 2014, 5.5]. */
#ifndef REMODEL_RELIT_H
#define REMODEL_RELIT_H

#include "common/gather/irradiance_cache.h"
#include "stages/relight/pixels.h"
#include "stages/relight/relight_params.h"

/* How far a pixel's quotient can be trusted: the channel A of the picture of quotients. */
#define RELIT_SURE    1.0f
#define RELIT_BOUNDED 0.5f /* the rule of light_quotient.c applied, or there was no light before */
#define RELIT_NONE    0.0f /* no surface of the model: its light stays */

/* {0} is the empty state; everything is owned. */
struct relit {
    int width, height;
    struct irradiance *before, *after; /* irradiance at the pixels */
    float (*quotient)[4];              /* R G B, and A as above */
    float (*albedo)[3];                /* that picture and light imply, bounded: pi L / E */
    float (*specular)[2][3];           /* what gloss reflects before and after; NULL: no pixel is glossy */
    double gather_seconds;
    size_t records;
};

/* Relights the picture: its radiance is that after the edit. picture: as render_model drew it. The caller releases r in
 * each case. Same bits for any number of threads. */
enum status relit_make(struct relit *r, struct model_picture *picture, const struct pixels *p,
                       const struct light_change *c, const struct relight_params *params, struct err *err);
void relit_release(struct relit *r);

#endif
