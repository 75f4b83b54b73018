/* texture_planes.h - axes in the planes of faces, and rectangles in them; used by texture_rules.c and
 * texture_wishes.c. */
#ifndef REMODEL_BUILD_MODEL_TEXTURE_PLANES_H
#define REMODEL_BUILD_MODEL_TEXTURE_PLANES_H

#include <stdbool.h>

#include "common/model/solid_mesh.h"

#define SAME_PLANE 2e-5 /* model units; the solids' lattice is 1e-6 */

/* Both normals are equal, but for rounding. */
bool texture_faces_are_parallel(const struct solid_face *a, const struct solid_face *b);
bool texture_faces_are_coplanar(const struct solid_face *a, const struct solid_face *b);

/* A plane with axes: u x v = n; seen from outside u points to the right, and v up if the plane is upright. */
struct plane_axes {
    struct vec3 u, v, n;
    double offset;
};

struct plane_rect { /* in the axes of a plane, ascending */
    double u[2], v[2];
};

struct plane_axes plane_axes_of(const struct solid_face *f);
struct vec3 plane_axes_point(const struct plane_axes *axes, double u, double v);
struct plane_rect plane_rect_of(const struct plane_axes *axes, struct vec3 a, struct vec3 b);

/* The bounding rectangle of a face and of the others with its id in its plane. axes: of the face. */
struct plane_rect plane_rect_of_surface(const struct solid_mesh *mesh, int face, const struct plane_axes *axes);

#endif
