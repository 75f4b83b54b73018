/* outdoors_turn.h - turns a lighting reference image that was taken in an opening by what photos show through it. */
#ifndef REMODEL_OUTDOORS_TURN_H
#define REMODEL_OUTDOORS_TURN_H

#include "common/base/provenance.h"
#include "common/capture/camera.h"
#include "common/image/image.h"
#include "stages/hdr_merge/merge_params.h"
#include "stages/hdr_merge/outdoors_rotation.h"
#include "stages/hdr_merge/reference_pose.h"

struct outdoors_image {
    const char *id;
    const struct image *radiance;
    const struct camera *lens;
    int opening; /* of the plan, in which it was taken */
    bool stated; /* somebody stated where in the opening */
};

struct outdoors_turn {
    bool tried;
    int views; /* that show something through the opening */
    struct outdoors_rotation found;
};

/* Turns the camera about its place, if enough matches agree; otherwise cam_from_model stays. Reads frame->outdoors,
 * axes and plan. */
enum status outdoors_turn_find(struct outdoors_turn *t, struct pose *cam_from_model, const struct outdoors_image *image,
                               const struct reference_frame *frame, const struct merge_params *params,
                               struct provenance *prov, struct err *err);

#endif
