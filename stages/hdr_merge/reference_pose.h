/* reference_pose.h - the pose of a lighting reference image in the scene's frame. */
#ifndef REMODEL_REFERENCE_POSE_H
#define REMODEL_REFERENCE_POSE_H

#include "common/base/provenance.h"
#include "common/capture/photo_alignment.h"
#include "stages/hdr_merge/merge_params.h"

/* Where the frame of the image's pose comes from; all NULL: the pose is in the scene's frame already. */
struct reference_frame {
    const char *views, *records; /* the scene's views and the records of its photos: some are in the model, too */
    const char *axes;            /* axes.txt: the pose is in the frame of the room's model */
    const char *marks, *plan;    /* lri.txt and plan.txt, with axes: marks in the image give the pose (marked_pose.h) */
    const char *outdoors;        /* with these: views that turn an image in an opening (outdoors_turn.h); may be NULL */
};

/* Moves *cam_from_world, a camera of `model` (of the folder `folder`), to the scene's frame. ST_DATA: too few common
 * photographs, all in one place, or they disagree. */
enum status reference_pose_find(struct pose *cam_from_world, struct frame_agreement *agreement,
                                const struct sfm_model *model, const char *folder, const struct reference_frame *frame,
                                const struct merge_params *params, struct provenance *prov, struct err *err);

#endif
