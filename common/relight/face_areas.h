/* face_areas.h - the areas of a model's faces: the nearest point on a face of an id. */
#ifndef REMODEL_FACE_AREAS_H
#define REMODEL_FACE_AREAS_H

#include "common/model/solid_mesh.h"

/* {0} is the empty state. Refers to the mesh, which must outlive it. */
struct face_areas {
    const struct solid_mesh *mesh;
    struct solid_triangles triangles;
    int *first, *faces; /* the faces of id are faces[first[id]] .. faces[first[id + 1] - 1]; owned */
    int ids;            /* largest id + 1 */
    double tolerance;   /* within which a point lies on a face, model units */
};

/* The caller releases the areas in each case. ST_NOMEM. */
enum status face_areas_make(struct face_areas *a, const struct solid_mesh *mesh, struct err *err);
void face_areas_release(struct face_areas *a);

/* The point nearest to p on the faces of an id, among those whose plane is nearest to p. Sets *face to its index.
 * Returns false if no face has the id. *on is whether p lies on the face; then *nearest is p, bit for bit. */
bool face_areas_nearest(const struct face_areas *a, int id, struct vec3 p, struct vec3 *nearest, int *face, bool *on);

/* The distance of a point of a face's plane from the face itself; 0 within. */
double face_areas_distance(const struct face_areas *a, int face, struct vec3 p, struct vec3 *nearest);

#endif
