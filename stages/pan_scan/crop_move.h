/* crop_move.h - a camera move as a pan and zoom over one photograph (thesis 3.8: what 3D pan & scan is compared with).
 *
 * The photograph may be stored on its side: it is turned by quarters until it stands as the film does, and crops are of
 * the turned picture. Scene units; px of the turned picture, or of the frames, where a name says so. */
#ifndef REMODEL_CROP_MOVE_H
#define REMODEL_CROP_MOVE_H

#include "common/capture/camera_path.h"
#include "common/image/image.h"
#include "common/layers/layered_depth.h"
#include "stages/pan_scan/crop_fit.h"

struct photo_point { /* as the view shows it */
    double x, y;    /* in its picture */
    struct vec3 world;
};

struct crop_move {
    const struct camera_path *path;
    struct view view;          /* turned; its name is the set's */
    int quarters;              /* by which it was turned, clockwise */
    struct photo_point *points; /* owned; places in the turned picture */
    size_t point_count;
    double tolerance; /* frame px */
    double *parts;    /* owned; a frame: how far along the move it is, 0 .. 1 */
    struct crop_result ends[2];
    double misfits[2]; /* at the ends */
};

/* The view nearest to the middle camera of the path that looks about its way; of several at one place the one that does
 * most. */
int crop_move_choose_view(const struct camera_set *set, const struct camera_path *path);

/* The move: ends fitted to what the path's first and last cameras see of the view's points, the frames between as far
 * along as the path's are. The points are those of the depth map, or, if it is NULL, the sparse points that the view
 * sees. tolerance: as a part of the frame's longer side. ST_DATA: too few points. */
enum status crop_move_init(struct crop_move *m, const struct camera_set *set, int view_idx,
                           const struct layered_depth *depth, const struct camera_path *path, double tolerance,
                           struct err *err);
void crop_move_release(struct crop_move *m);

/* What frame i shows, and by how many frame px it misses the points (their median). */
struct crop crop_move_crop(const struct crop_move *m, int frame);
enum status crop_move_misfit(double *misfit, const struct crop_move *m, int frame, struct err *err);

/* The crop in the pixels of the view as it is stored. */
struct crop crop_move_stored(const struct crop_move *m, struct crop crop);

/* Turns the view's picture as the move's view is turned. */
enum status crop_move_turn(struct image *picture, const struct crop_move *m, struct err *err);

#endif
