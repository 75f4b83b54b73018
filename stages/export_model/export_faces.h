/* export_faces.h - a model's faces as textured triangles: each triangle has one picture, or one colour. */
#ifndef REMODEL_EXPORT_FACES_H
#define REMODEL_EXPORT_FACES_H

#include "common/model/solid_mesh.h"
#include "common/texture/atlas.h"
#include "common/texture/texture_map.h"

enum { MATERIAL_GLASS = -1, MATERIAL_COLOUR = -2 }; /* else the number of a page */

struct export_triangle {
    struct vec3 p[3]; /* model frame, counter-clockwise seen from outside */
    double uv[3][2];  /* of a page: in [0, 1], u to the right, v downwards from the top */
    int material;     /* a page, or one of the above */
    float albedo[3];  /* MATERIAL_COLOUR */
    int face;         /* of the mesh */
};

struct export_faces {
    struct export_triangle *triangles; /* in order of face; owned */
    int count;
    int *first; /* face f has triangles first[f] .. first[f + 1] - 1; owned */
};

/* vita: whose pages the triangles show. map: of an edited model, NULL: every face shows itself. The triangles of a face
 * cover it exactly. The caller releases `faces` in each case. */
enum status export_faces_make(struct export_faces *faces, const struct solid_mesh *mesh, const struct texture_map *map,
                              const struct atlas *vita, struct err *err);
void export_faces_release(struct export_faces *faces);

#endif
