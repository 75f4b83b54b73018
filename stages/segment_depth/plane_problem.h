/* plane_problem.h - the energy of an assignment of planes to segments.
 *
 *   E(P) = sum over segments i       size_i (match_cost + points + cross_view)                                (unary)
 *        + sum over adjacent i, j    smoothness w_ij min(gap(P_i, P_j) / step, jump) / jump              (pairwise)
 *                                    + slant length_ij [P_i != P_j] (slanted(P_i) + slanted(P_j))
 *
 * A dominant plane of the scene (scene_planes.h) is paid for already: it counts as not slanted, its points' cost has no
 * bias to the far side, it costs SCENE_GAIN less in the first round, and it may leave the range of depths, which
 * comes from points, by a factor of SCENE_REACH. So a blank ceiling that no view can match continues on the plane of
 * its matched part.
 *
 * Floor, ceiling and walls that are known before (plane_prior.h) are planes of the scene, too. They may leave the range
 * by a factor of KNOWN_REACH, since it comes from points, and a segment costs its prior's gain less on the one that its
 * ray meets first.
 *
 * Where no segments of the view vote for the scene's ground (gravity.h), it is one of the scene's planes all the same.
 * A segment that lies below it, by more than a tenth of the inverse depth, costs GROUND_COST more: the ground hides
 * what is there. The ground, voted for or not, may come nearer than other planes, by a factor of GROUND_REACH.
 *
 * A segment whose depth is given has one plane, of cost 0; any other costs PLANE_FORBIDDEN. size_i is in mean segments.
 * The gap is the mean difference of the two planes' inverse depths at the middle of the border and at both centroids:
 * zero for equal planes, so that a surface slants at no cost, and never more than the sum over a third plane
 * (metric).
 *
 * length_ij is the border's, in outlines of half a mean segment: 2 sqrt(segment_pixels). A slanted plane pays along its
 * outline, not in each segment: the segments that share it pay nothing between them, so that a wall seen at an angle
 * continues on its plane where no picture decides. This stands in for a cost paid once per plane [Delong 2012], which
 * needs all segments of a plane at once; here a move sees a region only, and regions move in parallel. It is a metric
 * too: for P != Q, s(P) + s(Q) <= s(P) + 2 s(R) + s(Q). */
#ifndef REMODEL_PLANE_PROBLEM_H
#define REMODEL_PLANE_PROBLEM_H

#include <math.h>

#include "stages/segment_depth/cross_view.h"
#include "stages/segment_depth/given_depth.h"
#include "stages/segment_depth/plane_match.h"
#include "stages/segment_depth/plane_prior.h"
#include "stages/segment_depth/plane_sweep.h"
#include "stages/segment_depth/point_evidence.h"
#include "stages/segment_depth/scene_planes.h"
#include "stages/segment_depth/segment_params.h"

#define FURNITURE_PLANES 12
struct furniture_planes { /* of the largest surfaces that furniture_sweep.h found */
    struct plane planes[FURNITURE_PLANES];
    int pixels[FURNITURE_PLANES];
    int count;
};

struct plane_problem { /* borrows all that it points to */
    const struct view *view;
    struct vec3 down; /* in the view's axes */
    const struct plane_families *families;
    const struct furniture_planes *furniture; /* that are offered to the whole view; may be NULL */
    const struct plane_prior *prior;          /* what segments are expected to lie on; NULL: nothing is known */
    const struct matcher *m;
    const struct point_evidence *points;
    const struct cross_view *cross;  /* NULL in the first round */
    const struct given_depth *given; /* NULL if no depth is given */
    const struct plane *ground;      /* of the scene, as gravity.h finds it; NULL: unknown */
    struct scene_planes *scene;      /* filled by expand_planes(); NULL: none are looked for */
    const float *weights;            /* of each border, as smooth_border_weights() */
    const struct segment_params *params;
    double slant;                              /* problem_slant(), per pixel of a border */
    double min_inverse_z, max_inverse_z, step; /* range and step of the sweep */
    const float *cost; /* `planes` matching costs per segment, at the sweep's depths; NULL after the first round */
    int planes;
    const float *min_match; /* after the first round: lower bound of each match cost, approximate; or NULL */
    bool rough;             /* match every fourth pixel only */
};

static inline double problem_slant(const struct segment_params *params)
{
    return params->slant / (2 * sqrt(params->segment_pixels));
}

static inline int problem_passes(const struct plane_problem *p) { return depth_passes(p->params, !p->cross); }

/* Whether a plane stays in the range of depths over a segment. */
static inline bool problem_allows(const struct plane_problem *p, const struct segment *g, struct plane plane)
{
    const double reach = scene_planes_reach(p->scene, plane);
    return plane_within(plane, g, p->min_inverse_z / reach, p->max_inverse_z * reach);
}

/* The plane that straight edges, or the model, let a segment expect; NULL: nothing is known. */
static inline const struct plane *problem_expects(const struct plane_problem *p, int segment)
{
    const int k = p->prior ? p->prior->expected[segment] : -1;
    return k >= 0 && k < p->scene->known ? &p->scene->planes[k] : NULL;
}

#define PLANE_FORBIDDEN 1e4f /* unary cost of a plane outside the depth range */

/* Unary term. Also PLANE_FORBIDDEN if it exceeds max_cost, as far as the terms without matching and its lower bound
 * show. */
float problem_unary_cost(const struct plane_problem *p, int segment, struct plane plane, float max_cost);

/* Pairwise term of the segment with plane `own` and its neighbour across `border` with plane `other`. */
double problem_pairwise_cost(const struct plane_problem *p, int segment, int border, struct plane own,
                             struct plane other);

/* The largest problem_pairwise_cost() across `border`, whatever the planes. */
double problem_pairwise_bound(const struct plane_problem *p, int border);

#endif
