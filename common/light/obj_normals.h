/* obj_normals.h - normals of a mesh whose file has none. */
#ifndef REMODEL_OBJ_NORMALS_H
#define REMODEL_OBJ_NORMALS_H

#include "common/light/obj_mesh.h"

/* The direction of v at unit length, also where squares of its components would underflow; 0 stays 0. */
struct vec3 obj_unit(struct vec3 v);

/* Gives each corner the mean normal of the triangles at its vertex, by their angle there, that lean against its own
 * triangle by less than OBJ_CREASE: round things look round, edges of boxes stay sharp. ST_NOMEM. */
enum status obj_normals_smooth(struct obj_mesh *mesh, struct err *err);

#endif
