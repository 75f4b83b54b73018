/* plane_proposals.h - planes that an expansion move may propose to segments. */
#ifndef REMODEL_PLANE_PROPOSALS_H
#define REMODEL_PLANE_PROPOSALS_H

#include "common/base/rng.h"
#include "stages/segment_depth/plane_problem.h"

/* The random numbers of one cell in one pass: the same for any order in which cells are visited. */
struct cell_random {
    const struct rng *rng;
    uint64_t cell, index;
};

static inline double random_number(struct cell_random *r) { return rng_uniform(r->rng, r->cell, r->index++); }
static inline int random_member(struct cell_random *r, const int *members, int count)
{
    return members[(int)(random_number(r) * count)];
}

/* planes: the current ones, one per segment. The functions that return a bool return false if there is no such
 * plane. */

/* The plane through the centroids of three random members at their current depths. */
bool proposal_through_three(struct plane *out, const struct plane_problem *p, const struct plane *planes,
                            const int *members, int count, struct cell_random *random);

/* The horizontal plane through segment i's centroid: floors and ceilings. */
bool proposal_horizontal(struct plane *out, const struct plane_problem *p, const struct plane *planes, int i);

/* The vertical plane through the centroids of segments i and j: walls. */
bool proposal_of_family(struct plane *out, const struct plane_problem *p, const struct plane *planes, int i,
                        int family);
bool proposal_vertical(struct plane *out, const struct plane_problem *p, const struct plane *planes, int i, int j);

/* One of the best local minima of segment i's matching cost in the plane sweep, with the segment's current slant or
 * none. */
struct plane proposal_from_sweep(const struct plane_problem *p, const struct plane *planes, int i,
                                 struct cell_random *random);

/* Segment i's plane with its depth changed by up to `change` in 1/z, and its slant by up to `change` over `size`
 * pixels. Half of the planes of constant depth stay constant. */
struct plane proposal_perturbed(const struct plane_problem *p, const struct plane *planes, int i, double change,
                                double size, struct cell_random *random);

#endif
