/* view.h - a rectified view: a pinhole camera at a place in the world.
 *
 * Camera axes and pixels are those of camera.h. */
#ifndef REMODEL_VIEW_H
#define REMODEL_VIEW_H

#include "common/math/vec.h"

struct view {
    const char *name; /* without .exr; owned by the camera_set */
    int width, height;
    double fx, fy, cx, cy;
    struct mat3 cam_from_world;
    struct vec3 translation; /* p_cam = cam_from_world p_world + translation */
    struct vec3 center;
};

/* Returns the depth of a world point along the camera's z axis, and its pixel if the depth is > 0. */
double view_project(const struct view *view, struct vec3 world, double *u, double *v);
/* World point of a pixel at depth z (along the axis, not along the ray). */
struct vec3 view_unproject(const struct view *view, double u, double v, double z);

/* The camera moved to a point (a, b) of the lens, an offset of its centre along its x and y axes in scene units. The
 * principal point is shifted so that points at the depth `focus` keep their pixels. */
struct view view_from_lens_point(const struct view *view, double a, double b, double focus);
/* The same picture with another number of pixels. */
void view_resize(struct view *view, int width, int height);

#endif
