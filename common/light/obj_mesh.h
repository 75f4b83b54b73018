/* obj_mesh.h - the triangles of a Wavefront OBJ file. */
#ifndef REMODEL_OBJ_MESH_H
#define REMODEL_OBJ_MESH_H

#include "common/base/err.h"
#include "common/math/vec.h"

#define OBJ_MAX_COORDINATE 1e5 /* either sign, in the file's unit */
#define OBJ_CREASE         40  /* degrees between triangles from which an edge is sharp */

/* {0} is the empty state. */
struct obj_mesh {
    struct vec3 (*triangles)[3]; /* corners counter-clockwise around the outward normal, as the file has them; owned */
    struct vec3 (*normals)[3];   /* of the surface at the corners, unit length; owned */
    int count;
    int dropped; /* triangles without area that were left out */
};

/* Reads lines v, vn and f. Polygons may be concave; indices may be negative and may carry /texture/normal; all other
 * lines (groups, materials) are ignored. A corner without a normal gets that of its triangle, or, in a file without vn,
 * the mean of the triangles around its vertex that lean by less than OBJ_CREASE (obj_normals.c). Triangles without area
 * are left out, with a note in the log, which also names polygons that cross themselves. The caller releases the mesh;
 * it is empty after a failure. ST_IO: the file cannot be read. ST_DATA with file and line: an index without its vertex
 * or normal, a number that is not finite or beyond OBJ_MAX_COORDINATE, fewer than three corners; no face has an
 * area. */
enum status obj_mesh_read(struct obj_mesh *mesh, const char *path, struct err *err);
void obj_mesh_release(struct obj_mesh *mesh);

/* Takes each corner p to m (p, 1), and normals with the surface. */
void obj_mesh_move(struct obj_mesh *mesh, const double m[3][4]);

#endif
