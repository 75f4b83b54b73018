/* triangulate.h - points for a model that has only cameras. */
#ifndef REMODEL_TRIANGULATE_H
#define REMODEL_TRIANGULATE_H

#include "stages/sfm/colmap_job.h"

/* *found: the model m with triangulated points, at the size of the photos; poses and lenses stay. Images that are not
 * photos of the scene are left out. If no points can be found *found is empty, and a warning is logged. The caller
 * releases it. */
enum status triangulate(struct sfm_model *found, const struct sfm_model *m, const struct sfm_folder *f,
                        const struct sfm_input *in, struct err *err);

#endif
