/* neighbours.h - which views a view is matched with, what depths to look at, and the sparse points it saw. */
#ifndef REMODEL_NEIGHBOURS_H
#define REMODEL_NEIGHBOURS_H

#include "common/capture/camera_set.h"

#define MAX_NEIGHBOURS 16

/* A sparse point that the view observed. */
struct seen_point {
    int point_idx;    /* into set->model.points */
    double u, v;      /* where it projects */
    double inverse_z; /* 1 / depth in the view */
};

struct seen_points {
    struct seen_point *points; /* owned */
    int count;
};

/* Points of the view's observations that lie in front of it and project within 2 px of where they were observed. */
enum status seen_points_find(struct seen_points *seen, const struct camera_set *set, int view_idx, struct err *err);
void seen_points_release(struct seen_points *seen);

/* Picks up to `most` neighbours, best first, into neighbours[]; *count is how many.
 *
 * A candidate's score sums over the points that both saw: how well the triangle (view, point, candidate) measures depth -
 * full between 5 and 20 degrees, little at 0 and beyond 45 -, how alike the two scales are, and whether it adds a
 * direction to those already chosen (Goesele et al. 2007). The view is cut into tiles that count alike, however many points
 * they hold, and the less, the more of the chosen views already see them: a wall with few points needs a neighbour
 * too. In a tile where the view saw no point, those of other views that project there speak, more softly. Where points are too few, nearness and viewing
 * direction decide. ST_DATA: no other view can be matched; the sentence says why. */
enum status neighbours_choose(int neighbours[MAX_NEIGHBOURS], int *count, const struct camera_set *set, int view_idx,
                              const struct seen_points *seen, int most, struct err *err);

/* Inverse depths to sweep, least < most, both > 0: robust percentiles, with margins, of all points of the scene that lie in
 * the view's frame, seen by it or not; or, without points, what the neighbours' baselines can tell from infinity up to a
 * shift of a quarter of the picture; *guessed: whether it is that. */
enum status depth_range(double *least, double *most, bool *guessed, const struct camera_set *set, int view_idx,
                        const int *neighbours, int count, struct err *err);

#endif
