/* light_objects.h - synthetic objects of an edit as surfaces that light meets.
 *
 * Their triangles are grouped into elements, patches of one object that face one way, some centimetres wide. An element
 * has one irradiance, on each side that can be seen; its radiance is that of its albedo. */
#ifndef REMODEL_LIGHT_OBJECTS_H
#define REMODEL_LIGHT_OBJECTS_H

#include "common/gather/model_field.h"
#include "common/light/object_list.h"

struct object_element {
    int object;                /* index into the list */
    struct gather_point point; /* where its light is gathered */
    struct rgb irradiance;     /* as update_vita found it; 0 before */
};

/* {0} is the empty state; everything is owned. */
struct light_objects {
    struct object_list list;
    struct vec3 (*triangles)[3];
    int *object, count; /* of each triangle */
    int (*element)[2];  /* of each triangle: of its front, its back */
    struct object_element *elements;
    int element_count;
    struct rgb (*radiance)[2]; /* of each triangle: of its front, its back; what a field of light shows */
};

/* Reads objects.txt and the meshes in FOLDER, scenes/SCENE; triangles longer than `side` are cut. path NULL: no
 * objects. The caller releases the objects in each case. ST_DATA: a damaged file, a mesh that has changed, too many
 * triangles. */
enum status light_objects_read(struct light_objects *o, const char *path, const char *folder, double side,
                               struct provenance *prov, struct err *err);
void light_objects_release(struct light_objects *o);

/* Sets the radiance of all triangles from the irradiance of their elements. */
void light_objects_set_radiance(struct light_objects *o);

/* The elements' irradiance, O/relight/E/objects.txt: "remodel-object-light 1", then "element R G B" each. */
enum status light_objects_write_light(const struct light_objects *o, const char *path, const struct provenance *prov,
                                      struct err *err);
/* Reads it and sets the radiance. ST_DATA: another number of elements than the objects have. */
enum status light_objects_read_light(struct light_objects *o, const char *path, struct provenance *prov,
                                     struct err *err);

#endif
