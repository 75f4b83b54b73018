/* ends_climb.h - improvement of a move's ends off the grid. */
#ifndef REMODEL_ENDS_CLIMB_H
#define REMODEL_ENDS_CLIMB_H

#include "stages/plan_path/ends_search.h"

enum { CLIMB_ROUNDS = 32 }; /* at most; most climbs end before */

/* Ends of ever more parallax, from those of a start upwards. All have passed the coarse test of their path alone. */
struct ascent {
    struct move_ends up[CLIMB_ROUNDS + 2];
    int height, rounds;
    double length; /* of the next steps, in units of the grid's spacing */
};

/* Begins at ends whose parallax is measured, with the smooth surrogate's. */
enum status climb_begin(struct ascent *a, struct ends_search *s, const struct move_ends *from, struct err *err);

/* Climbs for some more rounds. */
enum status climb_on(struct ascent *a, struct ends_search *s, int rounds, struct err *err);

/* Replaces *best by the highest ends, above those of the start, whose whole path is valid, and measures them; *moved
 * says whether there are any. */
enum status climb_take_top(struct move_ends *best, bool *moved, const struct ascent *a, struct ends_search *s,
                           struct err *err);

#endif
