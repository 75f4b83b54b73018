/* refine.h - moves the ends of a camera move off the grid, to more parallax (stages/plan_path/ends.h). */
#ifndef REMODEL_REFINE_H
#define REMODEL_REFINE_H

#include "common/film/validity.h"

/* at: the ends on entry, a local optimum of the surrogate on return. Whether the viewpoints are valid, and whether
 * there is more parallax, is the caller's to see. */
enum status refine_ends(struct vec3 at[2], const struct layer_scene *scene, const struct validity *v, double max_angle,
                        struct err *err);

#endif
