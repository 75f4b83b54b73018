/* mutual_matches.h - features of two photos that look alike. */
#ifndef REMODEL_MUTUAL_MATCHES_H
#define REMODEL_MUTUAL_MATCHES_H

#include "common/capture/match_list.h"
#include "common/capture/nearest_descriptors.h"

struct match_limits {
    double ratio; /* maximum angle between matching descriptors, as a fraction of the angle to the second nearest */
    double angle; /* maximum angle itself, radians */
};
#define MATCH_LIMITS \
    {                \
        0.8, 0.7     \
    }

/* Sets the matches of a pair that has none yet: features of a and b that are each other's nearest, and clearly nearer
 * than the second nearest [Lowe 2004]. Distances are angles between descriptors. ST_NOMEM. */
enum status mutual_matches_find(struct matched_pair *pair, const struct nearest_descriptors *a,
                                const struct nearest_descriptors *b, const struct match_limits *limits,
                                struct err *err);

#endif
