/* object_list.h - synthetic objects that an edit puts into a model: out/SCENE/remodel/E/objects.txt, written by
 * build_model from the statements `object` (docs/model-script.md).
 *
 *   remodel-objects 1
 *   object NAME FILE HASH M matt R G B | phong R G B KS N | ward R G B KS ALPHA
 *
 * FILE is the path of an OBJ mesh in scenes/SCENE, HASH the hash of its content (hash_file()). M is twelve numbers, a
 * 3 x 4 matrix by rows, that takes a point of the mesh to the model's frame; its determinant is above 0. The material's
 * words are those of gloss.h. */
#ifndef REMODEL_OBJECT_LIST_H
#define REMODEL_OBJECT_LIST_H

#include "common/base/provenance.h"
#include "common/light/brdf.h"
#include "common/light/obj_mesh.h"

struct object {
    char *name;           /* owned */
    char *file;           /* owned */
    char hash[HASH_TEXT]; /* of the mesh when the object was written */
    double matrix[3][4];  /* model_from_mesh */
    struct brdf brdf;
};

/* {0} is the empty state; everything is owned. */
struct object_list {
    struct object *items; /* in the order of the file; names are unique */
    int count;
};

/* Whether a path may name an object's mesh: relative, of letters, digits, `_`, `-`, `.` and `/`, no part of it
 * beginning with a dot, its end ".obj", at most 255 characters. */
bool object_file_is_valid(const char *file);

/* ST_DATA with file and line: a damaged line, a name twice, a path that object_file_is_valid() refuses, a matrix that
 * mirrors or flattens, a material out of range. A failure leaves the list empty. */
enum status object_list_read(struct object_list *l, const char *path, struct provenance *prov, struct err *err);
enum status object_list_write(const struct object_list *l, const char *path, const struct provenance *prov,
                              struct err *err);
void object_list_release(struct object_list *l);

/* The triangles of an object in the model's frame, from FOLDER/FILE; folder: scenes/SCENE. The caller releases the
 * mesh, which is empty after a failure. ST_DATA also if the mesh has changed since the list was written. */
enum status object_mesh_read(struct obj_mesh *mesh, const struct object *o, const char *folder, struct err *err);

#endif
