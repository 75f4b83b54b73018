/* ends_climb.h - improvement of a move's ends off the grid. */
#ifndef REMODEL_ENDS_CLIMB_H
#define REMODEL_ENDS_CLIMB_H

#include "stages/plan_path/ends_search.h"

/* Replaces *best, whose parallax is measured, by ends of more parallax whose whole path is valid and measured, if it
 * finds any; *moved says whether it did. */
enum status ends_improve(struct ends_search *s, struct move_ends *best, bool *moved, struct err *err);

#endif
