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

struct obj_facet {
    struct vec3 corners[3], normals[3]; /* of the surface at the corners */
};

/* {0} is the empty state; everything is owned. */
struct light_objects {
    struct object_list list;
    struct vec3 (*triangles)[3];
    int *object, count; /* of each triangle */
    int *facet;         /* of each triangle: the triangle of the mesh that it was cut from */
    struct obj_facet *facets;
    int facet_count;
    int (*element)[2]; /* of each triangle: of its front, its back */
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

/* The point of a round surface near a point of one of its triangles, to gather light at: its normal is interpolated
 * from the corners, on the side of `facing`, and it lies where the corners' tangent planes let it, so that the flat
 * triangles cast no shadow on it [Hanika 2021]. A flat triangle gives `at`, but for rounding. */
struct gather_point light_objects_point(const struct light_objects *o, int triangle, struct vec3 at,
                                        struct vec3 facing);

/* Sets the radiance of all triangles from the irradiance of their elements. */
void light_objects_set_radiance(struct light_objects *o);

/* The elements' irradiance, O/relight/E/objects.txt: "remodel-object-light 1", then "element R G B" each. */
enum status light_objects_write_light(const struct light_objects *o, const char *path, const struct provenance *prov,
                                      struct err *err);
/* Reads it and sets the radiance. ST_DATA: another number of elements than the objects have. */
enum status light_objects_read_light(struct light_objects *o, const char *path, struct provenance *prov,
                                     struct err *err);

#endif
