/* bundler_model.h - a model in the format of Bundler, with the list of its images. */
#ifndef REMODEL_BUNDLER_MODEL_H
#define REMODEL_BUNDLER_MODEL_H

#include <stdbool.h>

#include "common/base/provenance.h"
#include "common/capture/photo_list.h"
#include "common/capture/sfm_model.h"

/* Reads the Bundler file in `folder` or in folder/bundle. *found: whether there is one; if not, *m is empty. The files
 * are recorded in prov, which may be NULL. ST_DATA: the file has no list of its images, or none of these is a photo. */
enum status bundler_model_read(struct sfm_model *m, bool *found, const char *folder, const struct photo_list *photos,
                               struct provenance *prov, struct err *err);

#endif
