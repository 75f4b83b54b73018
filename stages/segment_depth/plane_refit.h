/* plane_refit.h - a plane that many segments share, moved to where they match best together. */
#ifndef REMODEL_PLANE_REFIT_H
#define REMODEL_PLANE_REFIT_H

#include "stages/segment_depth/plane_problem.h"

/* Moves the scene's plane k to where the sum of the unary terms of the `count` segments in `members`, which lie on it,
 * is smallest: near where it is; or made horizontal or vertical, if it nearly is and if that costs little. */
void plane_refit(struct scene_planes *scene, int k, const int *members, int count, const struct plane_problem *p);

#endif
