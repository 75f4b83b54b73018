/* disturb.h - random errors of simulated photos. */
#ifndef REMODEL_TESTS_DISTURB_H
#define REMODEL_TESTS_DISTURB_H

#include "common/base/rng.h"
#include "common/math/numbers.h"
#include "common/math/vec.h"

/* The normally distributed number k of the item i. */
static inline double normal(const struct rng *rng, uint64_t i, uint64_t k)
{
    return sqrt(-2 * log(1 - rng_uniform(rng, i, 2 * k))) * cos(2 * PI * rng_uniform(rng, i, 2 * k + 1));
}

/* The rotation q, followed by small ones about the axes, radians. */
static inline struct quat turned(struct quat q, double x, double y, double z)
{
    return quat_normalize(quat_multiply((struct quat){1, x / 2, y / 2, z / 2}, q));
}

#endif
