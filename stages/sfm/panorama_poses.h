/* panorama_poses.h - given poses of panoramas become those of the views that are cut out of them. */
#ifndef REMODEL_PANORAMA_POSES_H
#define REMODEL_PANORAMA_POSES_H

#include "common/capture/photo_list.h"
#include "common/capture/sfm_model.h"

/* Replaces each image that is named like a panorama, some of whose views are photos, by these views: pinhole cameras
 * that are turned from the image's pose, whose z axis points to the panorama's middle. The image's lens does not count.
 * If any image is replaced, the model's points go: pixels of a panorama are none of its views. *replaced: how many
 * were.
 * ST_NOMEM. */
enum status panorama_poses_expand(int *replaced, struct sfm_model *m, const struct photo_list *photos, struct err *err);

#endif
