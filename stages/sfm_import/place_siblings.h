/* place_siblings.h - photos without a pose get one from other pictures of the same photo. */
#ifndef REMODEL_PLACE_SIBLINGS_H
#define REMODEL_PLACE_SIBLINGS_H

#include "common/capture/photo_list.h"
#include "common/capture/sfm_model.h"
#include "common/capture/split_name.h"

/* Adds the photos that the model lacks, and that other images of it tell the pose of: views of a panorama
 * (panorama_name.h) of which another is placed; if `split` has a size, pictures of a multi-lens camera whose lenses
 * keep their poses in its body (rig.h), of lenses that are placed beside the same lens in another capture. They come
 * last in the model, without observations, and share the lens of the view or of the other capture. Logs their names.
 * ST_NOMEM. */
enum status place_siblings(struct sfm_model *m, const struct photo_list *photos, struct split_size split,
                           struct err *err);

#endif
