/* relit.h - a picture under the light that an edit makes [Colburn 2014, 5.5]. */
#ifndef REMODEL_RELIT_H
#define REMODEL_RELIT_H

#include "common/gather/irradiance_cache.h"
#include "stages/relight/penumbra.h"

/* {0} is the empty state; everything is owned. */
struct relit {
    int width, height;
    struct irradiance *before, *after; /* irradiance at the pixels */
    float *error;                      /* relative standard error of the quotient of luminance */
    float (*quotient)[4];              /* R G B, and A as above */
    float (*albedo)[3];                /* that picture and light imply, bounded: pi L / E */
    float (*specular)[2][3];           /* what gloss reflects before and after; NULL: no pixel is glossy */
    double median[2];                  /* luminance of the surfaces that are relit, before and after; 0: none */
    size_t records;
    struct penumbra_stats penumbra; /* edges of old light */
};

/* Relights the picture: its radiance is that after the edit. picture: as render_model drew it. The caller releases r in
 * each case. Same bits for any number of threads. */
enum status relit_make(struct relit *r, struct model_picture *picture, const struct pixels *p,
                       const struct light_change *c, const struct relight_params *params, struct err *err);
void relit_release(struct relit *r);

#endif
