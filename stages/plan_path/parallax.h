/* parallax.h - how much parallax two cameras show between them (thesis 3.4.2, "Maximizing parallax").
 *
 * The part of either picture that the other camera does not see because something stands before it, summed over both:
 * 0 to 2. A pixel is hidden if its point lies within the other camera's frame and farther than all four depths around
 * its place there. What lies outside the other frame is not counted: it tells of turning and zooming, not of
 * parallax. */
#ifndef REMODEL_PARALLAX_H
#define REMODEL_PARALLAX_H

#include "common/layers/layer_render.h"

struct depth_picture {
    struct view camera; /* of its size */
    float *z;           /* owned; 0 unknown */
    float *farthest;    /* of the four depths around each pixel's lower right corner; INFINITY if one is not known */
};

/* Of known depths: the camera is set, z has its size. */
enum status depth_picture_take(struct depth_picture *d, const float *z, struct err *err);

/* side: of the longer side. */
enum status depth_picture_make(struct depth_picture *d, const struct layer_scene *scene, const struct view *camera,
                               int side, struct err *err);
void depth_picture_release(struct depth_picture *d);

/* tolerance: relative depth from which one thing stands before another. */
double parallax_between(const struct depth_picture *a, const struct depth_picture *b, double tolerance);

#define PARALLAX_LEAST_TOLERANCE 0.01
double parallax_tolerance(const struct layer_scene *scene); /* by the depths' uncertainty */

#endif
