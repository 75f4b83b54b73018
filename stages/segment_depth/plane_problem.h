/* plane_problem.h - the energy that a plane for every segment is to make small.
 *
 *   sum over segments i of  size_i (match_cost + points + cross_view) + slant [P_i is not constant]
 * + sum over touching i, j of smoothness w_ij min(gap(P_i, P_j) / step, jump) / jump
 *
 * A segment whose depth is given has one plane, which costs nothing; any other costs PLANE_NEVER.
 * size_i is in segments of mean size; gap is the mean difference of the two planes at the middle of the border and at both
 * centroids: zero where the planes are the same, so that a surface may slant for nothing, and never more than the way by a third plane. */
#ifndef REMODEL_PLANE_PROBLEM_H
#define REMODEL_PLANE_PROBLEM_H

#include "stages/segment_depth/cross_view.h"
#include "stages/segment_depth/given_depth.h"
#include "stages/segment_depth/plane_match.h"
#include "stages/segment_depth/point_evidence.h"
#include "stages/segment_depth/segment_params.h"

struct plane_problem { /* borrows all that it points to */
    const struct view *view;
    struct vec3 down; /* in the view's axes */
    const struct matcher *m;
    const struct point_evidence *points;
    const struct cross_view *cross;  /* NULL in the first round */
    const struct given_depth *given; /* NULL: nothing is */
    const float *weights;            /* a touch each, as touch_weights() */
    const struct segment_params *params;
    double least, most, step; /* inverse depths of the sweep */
    const float *cost;        /* planes a segment: matching alone, at constant depths; NULL after the first round */
    int planes;
    const float
        *least_match; /* after the first round: of each segment, what it may hardly match better than; or NULL */
    bool rough;       /* every fourth pixel will do */
};

/* Later rounds begin where the one before ended. */
static inline int problem_passes(const struct plane_problem *p)
{
    return p->cross ? (p->params->passes + 1) / 2 : p->params->passes;
}

#define PLANE_NEVER 1e4f /* the cost of a plane that leaves the depths */

/* PLANE_NEVER also if it would be more than `most`, as far as can be said without looking at the pictures. */
float problem_unary(const struct plane_problem *p, int segment, struct plane plane, float most);
double problem_pair(const struct plane_problem *p, int segment, int touch, struct plane own, struct plane other);

#endif
