/* neighbours.h - the views that a view is matched with, its depth range, and the sparse points that it observed. */
#ifndef REMODEL_NEIGHBOURS_H
#define REMODEL_NEIGHBOURS_H

#include "common/capture/camera_set.h"

#define MAX_NEIGHBOURS 16

/* A sparse point that the view observed. */
struct observed_point {
    int point_idx;    /* into set->model.points */
    double u, v;      /* its projection */
    double inverse_z; /* 1 / depth in the view */
};

struct observed_points {
    struct observed_point *points; /* owned */
    int count;
};

/* The points that the view observed with a reprojection error of at most 2 px. ST_NOMEM. */
enum status neighbours_find_points(struct observed_points *seen, const struct camera_set *set, int view_idx,
                                   struct err *err);
void neighbours_release_points(struct observed_points *seen);

/* Chooses up to max_count neighbours by points, triangulation angles and scale (neighbours.c), best first; then those
 * that, as far as cameras tell, show what too few of them show. ST_DATA if
 * no other view can be matched; ST_NOMEM. */
enum status neighbours_choose(int neighbours[MAX_NEIGHBOURS], int *count, const struct camera_set *set, int view_idx,
                              const struct observed_points *seen, int max_count, struct err *err);

/* The range of inverse depths to sweep, 0 < min < max: robust percentiles, with margins, of all points of the scene
 * that project into the view and that it observes, or others from the same side. *guessed: there are too few points;
 * the range is then what the neighbours' baselines resolve, from far away to a disparity of a quarter of the picture.
 * */
enum status neighbours_depth_range(double *min_inverse_z, double *max_inverse_z, bool *guessed,
                                   const struct camera_set *set, int view_idx, const int *neighbours, int count,
                                   struct err *err);

#endif
