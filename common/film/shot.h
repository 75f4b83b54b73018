/* shot.h - the cameras of a film: one frame of reference and lens for all, and by what rules they point and zoom
 * (thesis 3.4.2, "Constraints on the path").
 *
 * A move runs between two ends. Each end has a target that the camera points at and either a focal length or a
 * quadrilateral whose picture keeps its size; between the ends target and focal length go linearly. Where both ends
 * keep the size of the same quadrilateral, so does every camera between them (the dolly zoom).
 *
 * Of two subjects the thesis gives the second end's focal length by the ratio of the subjects' sizes. Here both ends
 * keep the size that the first subject has at the frame's origin at 1.5 f (or less, if it is large): the second subject
 * then ends at exactly the size at which the first began, and what is valid at one end does not depend on where the
 * other one is. The dolly zoom keeps its subject's size at the origin at f, likewise. */
#ifndef REMODEL_SHOT_H
#define REMODEL_SHOT_H

#include "common/capture/camera_set.h"
#include "common/film/subject_list.h"
#include "common/film/taxonomy.h"

#define CLOSE_FOCAL  1.5 /* of f: where a move starts or ends close */
#define SUBJECT_PART 0.5 /* of the frame's height: zooming in makes a subject no larger */
#define SUBJECT_MOST 1.3 /* of its size from the origin: nor does going closer make it more than this */

struct shot {
    struct view lens; /* size, principal point and focal length f; its pose is not used */
    struct vec3 up;
    struct vec3 origin;                 /* the centremost view's centre */
    struct vec3 axis_x, axis_y, axis_z; /* right-handed; z the normal of the plane of the centres, towards the scene */
    double low[2], high[2];             /* the box of the centres in x and y; never empty */
    struct vec3 centroid;               /* of the scene */
    double near_limit;                  /* nothing of the scene may come nearer */
    double median_depth;                /* of what is seen from the origin */
};

struct shot_end {
    struct vec3 target;
    double focal;          /* px; 0: the quadrilateral's picture is `size` px high */
    double size;           /* with a focal length: the picture of the quadrilateral is no higher; 0: there is none */
    struct vec3 corner[4]; /* of the quadrilateral: upper left, upper right, lower right, lower left */
};

struct shot_move {
    enum move move;
    bool on_axis; /* the ends lie on the frame's z axis */
    struct shot_end end[2];
};

/* The rules of a move; subjects may be NULL if it needs none. ST_DATA: a subject cannot be seen from the origin. */
enum status shot_move_make(struct shot_move *m, const struct shot *shot, enum move move,
                           const struct subject_list *subjects, struct err *err);

struct vec3 shot_place(const struct shot *shot, double x, double y, double z); /* world, of the frame's coordinates */
struct vec3 shot_coordinates(const struct shot *shot, struct vec3 world);
/* Upright, at a place, pointing at a target. Never fails: where there is no such direction, it looks along z. */
struct view shot_aim(const struct shot *shot, struct vec3 at, struct vec3 target, double focal);
/* An end's camera. Its fx is 0 where the rule cannot be kept: the quadrilateral is not in front, or it would be too
 * large. */
struct view shot_end_camera(const struct shot *shot, const struct shot_end *end, struct vec3 at);
/* A camera on the way from one end to the other, 0 <= t <= 1. */
struct view shot_camera(const struct shot *shot, const struct shot_move *m, const struct vec3 at[2], double t);

#endif
