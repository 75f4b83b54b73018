/* crop_move.h - a camera move as pan and zoom over one photograph [Colburn 2014, 3.8].
 *
 * The photograph may be stored on its side; it is rotated by quarter turns to the film's orientation. Crops and points
 * are in px of the rotated picture unless noted. Scene units. */
#ifndef REMODEL_CROP_MOVE_H
#define REMODEL_CROP_MOVE_H

#include "common/capture/camera_path.h"
#include "common/image/image.h"
#include "common/layers/layered_depth.h"
#include "stages/pan_scan/crop_fit.h"

struct photo_point { /* a point of the scene seen by the view */
    double x, y;
    struct vec3 world;
};

struct crop_move {
    const struct camera_path *path;
    struct view view;           /* rotated; its name is owned by the set */
    int quarters;               /* clockwise quarter turns from the stored picture to the rotated one */
    struct photo_point *points; /* owned */
    size_t point_count;
    double tolerance;  /* frame px */
    double *fractions; /* owned; one per frame: the part of the move that is done, 0 to 1 */
    struct crop_result ends[2];
    double misfits[2]; /* crop_misfit at the ends, frame px */
};

/* Index of the view nearest to the middle camera of the path among those that face about the same way; of several at
 * the same position, the one that faces most nearly that way. */
int crop_move_choose_view(const struct camera_set *set, const struct camera_path *path);

/* Fits the first and the last crop to what the path's first and last camera see of the view's points; the crops between
 * are interpolated as the path advances. The points come from the depth map; if it is NULL, they are the sparse points
 * that the view observes. tolerance: fraction of the frame's longer side. m refers to path. ST_DATA: too few points, or
 * a depth map of another size. */
enum status crop_move_init(struct crop_move *m, const struct camera_set *set, int view_idx,
                           const struct layered_depth *depth, const struct camera_path *path, double tolerance,
                           struct err *err);
void crop_move_release(struct crop_move *m);

/* The crop of a frame, and its crop_misfit. */
struct crop crop_move_crop(const struct crop_move *m, int frame);
enum status crop_move_misfit(double *misfit, const struct crop_move *m, int frame, struct err *err);

/* A crop in pixels of the picture as it is stored. */
struct crop crop_move_stored(const struct crop_move *m, struct crop crop);

/* Rotates the view's stored picture to the orientation of m->view. */
enum status crop_move_turn(struct image *picture, const struct crop_move *m, struct err *err);

#endif
