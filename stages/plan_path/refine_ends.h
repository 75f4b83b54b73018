/* refine_ends.h - continuous refinement of a move's ends for more parallax. */
#ifndef REMODEL_REFINE_ENDS_H
#define REMODEL_REFINE_ENDS_H

#include "common/film/validity.h"

/* Moves the ends `at` to a local optimum of a smooth surrogate of the parallax. The caller checks that the result is
 * valid and has more parallax. max_angle: between the ends at the scene's centroid, degrees. */
enum status refine_ends(struct vec3 at[2], const struct layer_scene *scene, const struct validity *v, double max_angle,
                        struct err *err);

#endif
