/* mesh_file.h - the triangles of a Wavefront OBJ file. */
#ifndef REMODEL_SIMULATE_MESH_FILE_H
#define REMODEL_SIMULATE_MESH_FILE_H

#include "common/base/err.h"
#include "common/math/vec.h"

/* Reads lines v and f. Polygons become fans of triangles; indices may be negative and may carry /texture/normal; all
 * other lines (normals, groups, materials) are ignored, as are triangles without area. The caller frees *triangles; it
 * is NULL on failure. ST_DATA names file and line; a file without faces is an error. */
enum status mesh_file_read(struct vec3 (**triangles)[3], int *count, const char *path, struct err *err);

#endif
