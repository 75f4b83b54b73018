/* user_model.h - a structure-from-motion model that the user already has. */
#ifndef REMODEL_USER_MODEL_H
#define REMODEL_USER_MODEL_H

#include "stages/sfm/colmap_job.h"

/* Adds the models in `from`: COLMAP's text (cameras.txt, images.txt, points3D.txt) or binary format, in `from` itself,
 * in its subfolders 0, 1, ..., or in these of its folder sparse; or a Bundler model (a .out file in `from` or
 * from/bundle, and a list of its images). For cameras without points that serve the photos (given_points.h) the points
 * are triangulated from the photos. `from` is not modified. */
enum status user_model_add(struct sfm_folder *f, const char *from, const struct sfm_input *in, struct provenance *prov,
                           struct err *err);

/* Whether all models in `from` have points that serve the photos; only then the photos need not be matched. */
enum status user_model_judge(bool *suffice, const char *from, const struct photo_list *photos, struct err *err);

#endif
