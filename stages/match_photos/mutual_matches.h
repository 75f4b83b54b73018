/* mutual_matches.h - features of two photos that look alike. */
#ifndef REMODEL_MUTUAL_MATCHES_H
#define REMODEL_MUTUAL_MATCHES_H

#include "common/capture/match_list.h"
#include "stages/match_photos/matching_params.h"
#include "stages/match_photos/nearest.h"

/* Sets the matches of a pair that has none yet: features of a and b that are each other's nearest, and clearly nearer
 * than the second nearest [Lowe 2004]. Distances are angles between descriptors. ST_NOMEM. */
enum status mutual_matches_find(struct photo_pair *pair, const struct descriptor_blocks *a,
                                const struct descriptor_blocks *b, const struct matching_params *params,
                                struct err *err);

#endif
