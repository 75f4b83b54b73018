/* near.h - comparison of computed with expected numbers, within a fraction of the expected one. */
#ifndef REMODEL_TESTS_NEAR_H
#define REMODEL_TESTS_NEAR_H

#include "tests/unit/scratch.h"

#include <math.h>

#define assert_near(got, expected, fraction)                                                                     \
    do {                                                                                                         \
        const double got_ = (got), expected_ = (expected);                                                       \
        if (!(fabs(got_ - expected_) <= (fraction)*fabs(expected_)))                                             \
            fail_msg("%s is %.9g, expected %.9g within %g %%", #got, got_, expected_, 100 * (double)(fraction)); \
    } while (0)

#endif
