/* triangulate.h - points for a model that has only cameras. */
#ifndef REMODEL_TRIANGULATE_H
#define REMODEL_TRIANGULATE_H

#include "stages/sfm/colmap_job.h"

/* Replaces *m by a model with triangulated points; poses and lenses stay. Images that are not photos of the scene are
 * dropped. If no points can be found the model stays as it is and a warning is logged. ST_DATA: fewer than two images
 * are readable photos. */
enum status triangulate(struct sfm_model *m, const struct sfm_folder *f, const struct sfm_input *in, struct err *err);

#endif
