/* export_objects.h - the synthetic objects of an edited model, as triangles of one colour each. */
#ifndef REMODEL_EXPORT_OBJECTS_H
#define REMODEL_EXPORT_OBJECTS_H

#include "common/light/object_list.h"

/* {0} is the empty state; everything is owned. */
struct export_objects {
    struct object_list list;
    struct obj_mesh *meshes; /* of each object, in the model's frame; counter-clockwise seen from outside */
};

/* path: objects.txt of the edit, NULL: no objects. scene: the folder of the meshes. The caller releases the objects in
 * each case. ST_DATA also if a mesh has changed since the model was made. */
enum status export_objects_read(struct export_objects *o, const char *path, const char *scene, struct provenance *prov,
                                struct err *err);
void export_objects_release(struct export_objects *o);

/* The outward unit normal of a triangle. */
struct vec3 export_objects_normal(const struct vec3 triangle[3]);

#endif
