/* rig.h - the captures and lenses of a multi-lens camera among the images of a model. */
#ifndef REMODEL_RIG_H
#define REMODEL_RIG_H

#include "common/capture/sfm_model.h"
#include "common/capture/split_name.h"
#include "stages/sfm_import/ceres_bundle.h"

struct rig {
    int *capture, *lens;           /* owned; of each image, from 0; -1: the image is not part of the rig */
    int capture_count, lens_count; /* without a rig, both are 0; the other lenses are placed relative to lens 0 */
};

/* Finds a rig by the names of the model's images, pictures of photos that were split in this way. Images whose rotation
 * or place the model's bundle holds are not part of it. ST_NOMEM. */
enum status rig_find(struct rig *rig, const struct sfm_model *m, const struct bundle *b, struct split_size split,
                     struct err *err);

/* Makes the images of a bundle of this model part of the rig, with frames of captures and mounts from their poses as
 * they are. *angle: median angle between the poses of lenses in a capture and their mounts, radians. The images are not
 * tied yet: see bundle_trust_rig(). ST_NOMEM. */
enum status rig_apply(double *angle, struct bundle *b, const struct rig *rig, struct err *err);

void rig_release(struct rig *rig);

#endif
