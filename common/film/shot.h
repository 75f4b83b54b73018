/* shot.h - cameras of a move: the reference frame and lens that they share, and the rules by which they point and zoom
 * [Colburn 2014, 3.4.2].
 *
 * A move has two ends. Each end has a target to point at, and either a focal length or a quadrilateral that keeps its
 * size in the picture. Target and focal length are interpolated linearly between the ends. If both ends keep the size
 * of the same quadrilateral, every camera between them does too (the dolly zoom). */
#ifndef REMODEL_SHOT_H
#define REMODEL_SHOT_H

#include "common/capture/camera_set.h"
#include "common/film/subject_list.h"
#include "common/film/taxonomy.h"

#define CLOSE_FOCAL      1.5 /* focal length of a close end, in units of f */
#define MAX_SUBJECT_PART 0.5 /* largest subject that zooming in may make, in frame heights */
#define MAX_SUBJECT_GAIN 1.3 /* largest gain in a subject's size by moving closer than the origin */

struct shot_setup {
    struct view lens;   /* frame size, principal point and focal length f; the pose is unused */
    struct vec3 up;     /* unit, in the world */
    struct vec3 origin; /* centre of the centremost view */
    struct vec3 axis_x, axis_y,
        axis_z;             /* right-handed; z: normal of the plane of the views' centres, towards the scene */
    double low[2], high[2]; /* bounding box of the views' centres in x and y; never empty */
    struct vec3 centroid;   /* of the scene */
    double near_limit;      /* smallest depth that the scene may have in a frame */
    double median_depth;    /* of the scene as seen from the origin */
};

struct shot_end { /* how the camera points and zooms at one end */
    struct vec3 target;
    double focal;          /* px; 0: chosen so that the quadrilateral is `size` px high */
    double size;           /* if focal > 0: the largest height of the quadrilateral, px; 0: no limit */
    struct vec3 corner[4]; /* quadrilateral: upper left, upper right, lower right, lower left */
};

struct shot_move {
    enum camera_move move;
    bool on_axis; /* both ends lie on the z axis of the reference frame */
    struct shot_end end[2];
};

/* Sets the rules of a move. subjects may be NULL if the move needs none. ST_DATA: too few subjects, or a subject is
 * behind the camera at the origin. */
enum status shot_move_make(struct shot_move *m, const struct shot_setup *shot, enum camera_move move,
                           const struct subject_list *subjects, struct err *err);

/* Coordinates in the reference frame to the world, and back. */
struct vec3 world_from_shot(const struct shot_setup *shot, double x, double y, double z);
struct vec3 shot_from_world(const struct shot_setup *shot, struct vec3 world);
/* An upright camera at `at` that points at a target. Always defined: looks along z if the target is at `at`, and uses
 * the frame's x axis as right if it looks straight up or down. */
struct view shot_aim(const struct shot_setup *shot, struct vec3 at, struct vec3 target, double focal);
/* The camera of an end placed at `at`. Its fx is 0 if the rule cannot be met: the quadrilateral is not in front of the
 * camera or would be too large. */
struct view shot_end_camera(const struct shot_setup *shot, const struct shot_end *end, struct vec3 at);
/* The camera at t between the two ends at[0] and at[1], 0 <= t <= 1. */
struct view shot_camera(const struct shot_setup *shot, const struct shot_move *m, const struct vec3 at[2], double t);

#endif
