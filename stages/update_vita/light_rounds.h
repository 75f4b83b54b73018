/* light_rounds.h - rounds of light from sample to sample, until little changes. */
#ifndef REMODEL_LIGHT_ROUNDS_H
#define REMODEL_LIGHT_ROUNDS_H

#include "stages/update_vita/transport.h"

/* One round: the most that a sample changed, and may still change, as parts of its irradiance. */
struct round {
    double change, left;
};

struct rounds {
    struct rgb *values; /* 2 j: quotient, 2 j + 1: irradiance of sample j; owned */
    struct round *list; /* owned */
    int count;
    bool settled; /* before the most rounds were done */
    int bounded;  /* samples whose albedo would be above LIGHT_ALBEDO_MAX */
};

/* reflecting, 0 to 1: the part of what texels send out that follows the light on them; the rest stays as it was. The
 * caller releases r in each case. */
enum status rounds_run(struct rounds *r, const struct transport *t, double reflecting, int most, double tolerance,
                       struct err *err);
void rounds_release(struct rounds *r);

#endif
