/* mixture.h - an integral over the hemisphere by rays of several strategies, weighted together. */
#ifndef REMODEL_MIXTURE_H
#define REMODEL_MIXTURE_H

#include "common/gather/strategy.h"

enum {
    MIXTURE_MAX = 33,       /* strategies; beyond that the weakest emitters are left to the others */
    MIXTURE_REPLICATES = 8, /* independent scramblings */
    MIXTURE_MIN = 64        /* rays of an integral */
};

enum mixture_part {
    MIXTURE_ALL,
    MIXTURE_LIGHTS /* what shines itself in the direction of emitters: lamps and the sky; no other strategies */
};

/* Filled by mixture_*_init(); belongs to one point. */
struct mixture {
    const struct light_field *field;
    struct gather_point point;
    enum mixture_part part;
    struct brdf lobe; /* kind BRDF_LAMBERT: none, the integral of radiance times cosine */
    struct vec3 view;
    struct strategy strategies[MIXTURE_MAX];
    double share[MIXTURE_MAX]; /* of the rays; they sum to 1 */
    int count;
    struct rgb replicates[MIXTURE_REPLICATES]; /* the last gather's independent values, whose mean is its result */
    int least;                                 /* rays of mixture_gather(), MIXTURE_MIN unless the caller sets less */
};

void mixture_init(struct mixture *m, const struct light_field *f, struct gather_point p, enum mixture_part part);
/* For the integral of radiance times the lobe of a brdf and the cosine, towards a viewer. */
void mixture_lobe_init(struct mixture *m, const struct light_field *f, struct gather_point p, const struct brdf *brdf,
                       struct vec3 view);

/* Traces at most `rays` rays, or m->least, and at least MIXTURE_REPLICATES of each strategy. With `learn`, the shares
 * of a next call go by the noise of each strategy. Sets everything of *e. The same key gives the same bits. */
void mixture_gather(struct irradiance *e, struct mixture *m, int rays, uint64_t key, bool learn);
/* The same until the standard error of the luminance is at most `target` of it, or `most` rays are spent. The luminance
 * `beside` is added to the integral's own: what else arrives there. */
void mixture_gather_to(struct irradiance *e, struct mixture *m, double target, double beside, int least, int most,
                       uint64_t key);

/* Whether light seen in a direction is part of MIXTURE_LIGHTS. */
bool mixture_is_light(const struct mixture *lights, struct vec3 direction, enum light_source seen);

#endif
