/* transforms_model.h - cameras in transforms.json, as nerfstudio, instant-ngp and apps that scan with a phone write
 * them. */
#ifndef REMODEL_TRANSFORMS_MODEL_H
#define REMODEL_TRANSFORMS_MODEL_H

#include <stdbool.h>

#include "common/base/provenance.h"
#include "common/capture/photo_list.h"
#include "common/capture/sfm_model.h"

/* Reads folder/transforms.json or transforms_train.json. *found: whether there is one; if not, *m is empty. The file is
 * recorded in prov, which may be NULL. ST_DATA names the file, and the line or the frame. */
enum status transforms_model_read(struct sfm_model *m, bool *found, const char *folder, const struct photo_list *photos,
                                  struct provenance *prov, struct err *err);

/* Makes the folder `to` of the depth maps that the frames name: ID.EXT for a photo's, a link, and depth.txt with their
 * scale. *count: how many there are; with none, and if the folder holds no such file, `to` is removed. */
enum status transforms_link_depth(int *count, const char *to, const char *folder, const struct photo_list *photos,
                                  struct err *err);

#endif
