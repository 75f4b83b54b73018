/* single_photo.h - the camera of a scene of one photo, whose depth is given: nothing is there to match. */
#ifndef REMODEL_SINGLE_PHOTO_H
#define REMODEL_SINGLE_PHOTO_H

#include "stages/sfm/sfm_folder.h"
#include "stages/sfm/sfm_params.h"

/* Adds a model of one camera at the origin, without points. Its lens is camera_params, or a pinhole with the focal
 * length that EXIF states for 35 mm film, or with an ordinary angle of view; a note says which. */
enum status single_photo_add(struct sfm_folder *folder, const struct photo_list *photos,
                             const struct sfm_params *params, const struct provenance *prov, struct err *err);

#endif
