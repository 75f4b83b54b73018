/* marked_pose.h - the pose of a lighting reference image from corners of the model that a user marked in it. */
#ifndef REMODEL_MARKED_POSE_H
#define REMODEL_MARKED_POSE_H

#include "stages/hdr_merge/reference_marks.h"
#include "stages/hdr_merge/reference_pose.h"
#include "stages/hdr_merge/resection.h"

/* How the pose was found. Poses are in the model's frame. */
struct marked_pose {
    int marks;             /* 0: the image was not placed by marks */
    bool in_window, level; /* it was placed in an opening, held level; its pose is found.poses[0] */
    char opening[64];      /* that opening, cut to fit */
    int opening_idx;       /* in the plan */
    bool stated;           /* somebody stated where in the opening */
    struct resection found;
    int chosen;         /* of found.poses */
    int worst_line;     /* of the mark that fits worst */
    bool by_hand;       /* a line "near" chose it */
    bool metric;        /* the model's unit is the metre */
    char wall[64];      /* the wall of the first marked corner, cut to fit; "": no corner is marked */
    double before_wall; /* distance of the camera from its inner face; < 0: behind it */
};

/* Finds lens and pose of an image, in the scene's frame, from frame->marks, plan and axes. model: a folder with
 * cameras.txt, for the lens of images that the marks give none; may be NULL. *known: the file has marks of the image.
 * ST_DATA: too few marks, marks beside a line "in", one off the image, no lens, a lens of another size, a bad fit,
 * three marks that several poses explain; what window_pose_find() refuses. */
enum status marked_pose_find(struct marked_pose *m, struct camera *lens, struct pose *cam_from_world, bool *known,
                             const struct photo_record *image, const char *model, const struct reference_frame *frame,
                             const struct merge_params *params, struct provenance *prov, struct err *err);

/* Moves the chosen pose to the scene's frame: *cam_from_world. */
enum status marked_pose_to_scene(struct marked_pose *m, struct pose *cam_from_world,
                                 const struct reference_frame *frame, const struct merge_params *params,
                                 struct provenance *prov, struct err *err);

#endif
