/* pose_agreement.h - whether given cameras agree with what their photos show, and what may be wrong with them.
 *
 * A match agrees if the two rays meet, within a room, before both cameras. Where few do, the poses are read in other
 * ways: those in which other programs state poses, and the mistakes that converters make. */
#ifndef REMODEL_POSE_AGREEMENT_H
#define REMODEL_POSE_AGREEMENT_H

#include "common/base/err.h"
#include "common/capture/pose.h"

struct pose_match {
    int first, second;   /* of the poses */
    struct vec3 rays[2]; /* in their cameras, of length 1 */
    double room;         /* radians */
};

struct pose_agreement {
    double share;        /* of the matches that agree */
    double best;         /* the same of the poses read in the best other way */
    const char *reading; /* that way, for people: "as poses that ..." */
};

#define AGREE_LEAST  0.3 /* share below which cameras contradict their photos */
#define AGREE_SURELY 0.6 /* share of another reading that explains why */

/* ST_NOMEM. */
enum status pose_agreement_measure(struct pose_agreement *a, const struct pose *poses, int pose_count,
                                   const struct pose_match *matches, int match_count, struct err *err);

#endif
