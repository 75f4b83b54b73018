/* parallax.h - amount of parallax between two cameras [Colburn 2014, 3.4.2].
 *
 * The fraction of each picture that is occluded in the other one, summed over both: 0 to 2. */
#ifndef REMODEL_PARALLAX_H
#define REMODEL_PARALLAX_H

#include "common/layers/layer_render.h"

struct depth_picture {
    struct view camera; /* with the picture's size */
    float *z;           /* owned; 0: unknown */
    float *farthest;    /* of the four depths around each pixel's lower right corner; INFINITY if one is unknown */
};

/* Copies the depths z, of the size of d->camera, which is set on entry. */
enum status parallax_picture_init(struct depth_picture *d, const float *z, struct err *err);

/* Renders the scene with the longer side reduced to `side` px. */
enum status parallax_picture_make(struct depth_picture *d, const struct layer_scene *scene, const struct view *camera,
                                  int side, struct err *err);
void parallax_picture_release(struct depth_picture *d);

/* tolerance: relative difference in depth from which a surface occludes another. */
double parallax_between(const struct depth_picture *a, const struct depth_picture *b, double tolerance);

#define MIN_PARALLAX_TOLERANCE 0.01
#define MAX_PARALLAX_TOLERANCE 0.05 /* else a draft's move would show less parallax than the same move of good depth */
double parallax_tolerance(const struct layer_scene *scene); /* from the uncertainty of the depths */

#endif
