/* mesh_file.h - the triangles of a Wavefront OBJ file. */
#ifndef REMODEL_SIMULATE_MESH_FILE_H
#define REMODEL_SIMULATE_MESH_FILE_H

#include "common/base/err.h"
#include "common/math/vec.h"

/* Lines v and f; polygons become fans of triangles, indices may be negative and carry /texture/normal; what else OBJ
 * knows (normals, groups, materials) is passed over. *triangles is malloc'ed. ST_DATA with file and line; a file without
 * a face is one. */
enum status mesh_file_read(struct vec3 (**triangles)[3], int *count, const char *path, struct err *err);

#endif
