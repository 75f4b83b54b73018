/* ifc.h - what the files that write IFC4 share: lines of the STEP file, shapes, elements. */
#ifndef REMODEL_EXPORT_IFC_H
#define REMODEL_EXPORT_IFC_H

#include "stages/export_model/writers.h"

struct ifc_ids {
    int *list; /* owned */
    int count;
};

struct ifc {
    FILE *to;
    const struct export_scene *s;
    int last;                             /* the last number that was given */
    int context, storey, placement, axes; /* of what all elements share */
    int *styles;                          /* surface style of each page */
    int *maps;                            /* picture of each page */
    struct ifc_ids contained, spaces;
    struct err *err; /* of the first failure: functions that return a number go on after it */
};

/* ifc_lines.c */

int ifc_next(struct ifc *f); /* the next number */
/* An IfcCartesianPointList3D; returns its number. */
int ifc_points(struct ifc *f, const struct vec3 *points, int count);
/* Writes "#N=" and the formatted text; returns N. */
int ifc_put(struct ifc *f, const char *fmt, ...) PRINTF_LIKE(2, 3);
/* Begins "#N=KIND('guid',$,'name'": the GUID is that of the kind and the name. */
int ifc_begin(struct ifc *f, const char *kind, const char *name);
int ifc_begin_of(struct ifc *f, const char *kind, const char *key, const char *name); /* the GUID is that of the key */
enum status ifc_keep(struct ifc *f, struct ifc_ids *ids, int id);
void ifc_put_ids(struct ifc *f, const struct ifc_ids *ids); /* "(#1,#2)" */
const char *ifc_real(char text[40], double value);          /* a number as STEP wants it: with a point */
int ifc_point(struct ifc *f, struct vec3 p);
int ifc_direction(struct ifc *f, struct vec3 d);
/* An element of the storey: "kind name ... , placement, shape, tag, rest". shape 0: it has none. */
int ifc_element(struct ifc *f, const char *kind, const char *name, int shape, const char *rest);
/* The same with a GUID of the kind and a key. */
int ifc_element_of(struct ifc *f, const char *kind, const char *key, const char *name, int shape, const char *rest);
/* An IfcOpeningElement in an element, and the relation between them. */
int ifc_opening(struct ifc *f, const char *name, int element, int shape);
/* A door or window in an opening, of the size that the lines need; shape 0: it has none. opening 0: it is in none. */
enum status ifc_filling(struct ifc *f, const char *kind, const char *name, int opening, int shape, const double size[2],
                        const char *type);

/* ifc_shapes.c: each returns the number of an IfcProductDefinitionShape; 0: there is nothing, or no memory */

struct ifc_outline {
    double (*corners)[2]; /* counter-clockwise, in the plane of the profile */
    int count;
    struct vec3 origin, x, axis; /* of that plane */
    struct vec3 along;           /* unit direction of the extrusion, in the model */
    double depth;
};
int ifc_extrusion(struct ifc *f, const struct ifc_outline *o);
/* A box with edges along x and y of its own frame, x level. */
int ifc_box(struct ifc *f, struct vec3 origin, struct vec3 x, double width, double depth, double height);
/* An upright prism over a polygon of the ground; its lower end is in the plane z = plane[0] + plane[1] x + plane[2]
 * y. */
int ifc_prism(struct ifc *f, const double (*corners)[2], int count, const double plane[3], double height);
/* Plane polygons, counter-clockwise seen from outside, that close a volume. ends[i]: of polygon i in corners. */
int ifc_polyhedron(struct ifc *f, const struct vec3 *corners, const int *ends, int count);
/* All triangles of the faces KIND/NAME and KIND/NAME/PART. */
int ifc_faces_of(struct ifc *f, const char *kind, const char *name);
/* An IfcShapeRepresentation; identifier: Body, Lighting. */
int ifc_representation(struct ifc *f, const char *identifier, const char *type, const struct ifc_ids *items);
/* A shape of IfcTriangulatedFaceSets. */
int ifc_tessellation(struct ifc *f, const struct ifc_ids *sets);
/* Triangles first .. end - 1 as an IfcTriangulatedFaceSet; of a page, with its texture map. */
int ifc_triangles(struct ifc *f, int first, int end, int page);

/* ifc_fillings.c */

/* What is in an opening: its glass, or its leaf between two faces of the model; 0: nothing. kind: its word in names of
 * faces. */
int ifc_filling_shape(struct ifc *f, const char *kind, const char *name);
/* An IfcOpeningElement that voids an element. */
int ifc_opening(struct ifc *f, const char *name, int element, int shape);
/* A door or window of a width and height; opening: that it fills, 0: none. shape 0: it has no body. */
enum status ifc_filling(struct ifc *f, const char *kind, const char *name, int opening, int shape, const double size[2],
                        const char *type);

/* ifc_quantities.c: a set of quantities of an element, such as Qto_WallBaseQuantities; key: of the element, for the
 * GUID */

struct ifc_quantity {
    enum ifc_measure { IFC_LENGTH, IFC_AREA, IFC_VOLUME } measure;
    const char *name;
    double value; /* in model units */
};
void ifc_quantities(struct ifc *f, int element, const char *set, const char *key, const struct ifc_quantity *list,
                    int count);

/* ifc_walls.c, ifc_rooms.c */
enum status ifc_walls(struct ifc *f); /* with their openings, doors and windows */
enum status ifc_rooms(struct ifc *f); /* slabs with their openings, and spaces */
enum status ifc_boxes(struct ifc *f);

/* ifc_objects.c */

/* An IfcSurfaceStyle of one colour. */
int ifc_style(struct ifc *f, const char *name, const double colour[3]);
/* An IfcTriangulatedFaceSet. corners NULL: each three points are a triangle. */
int ifc_triangle_set(struct ifc *f, const struct vec3 *points, int point_count, const int (*corners)[3], int count);
enum status ifc_objects(struct ifc *f); /* synthetic objects, then furniture */

/* ifc_lamps.c: an IfcLightFixture for each lamp that an edit adds */

/* Numbers of the units that they need. */
enum status ifc_lamp_units(struct ifc *f, struct ifc_ids *units);
enum status ifc_lamps(struct ifc *f);

#endif
