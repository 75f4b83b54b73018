/* user_model.h - a structure-from-motion model that the user already has. */
#ifndef REMODEL_USER_MODEL_H
#define REMODEL_USER_MODEL_H

#include "stages/sfm/run_colmap.h"

/* Adds the models in `from`: COLMAP's text (cameras.txt, images.txt, points3D.txt) or binary format, in `from` itself
 * or in its folders 0, 1, ...; or Bundler's (a .out file in `from` or from/bundle, and a list of its images). For
 * cameras without points (an empty points3D.txt or none) the points are triangulated from the photos. Nothing in
 * `from` is changed. */
enum status user_model_add(struct sfm_folder *f, const char *from, const struct sfm_input *in, struct provenance *prov,
                           struct err *err);

#endif
