/* writers.h - a textured model in the formats of other programs. */
#ifndef REMODEL_EXPORT_WRITERS_H
#define REMODEL_EXPORT_WRITERS_H

#include "common/model/model_plan.h"
#include "stages/export_model/export_faces.h"

struct export_scene {
    const char *name; /* of the scene and the edit, for titles */
    const struct solid_mesh *mesh;
    const struct export_faces *faces;
    const struct model_plan *plan;
    const int (*page_sizes)[2];
    int page_count;
    double exposure; /* of the pages */
    bool metric;     /* lengths are metres */
    const char *out; /* folder, which has the pages */
    const struct provenance *prov;
};

/* OUT/model.obj and model.mtl: an object for each body, a group for each face name; z is up. */
enum status write_obj(const struct export_scene *s, struct err *err);

/* OUT/model.glb: glTF 2.0 with the pages inside, y up; a node for each body, a primitive for each page or colour. The
 * pictures hold light, so materials are unlit; primitives name their faces in `extras`. */
enum status write_gltf(const struct export_scene *s, struct err *err);

/* OUT/model.ifc: IFC4. Walls, openings, doors, windows, slabs and spaces as solids; the photographic texture on a
 * covering for each face, as IfcIndexedTriangleTextureMap of the pages. */
enum status write_ifc(const struct export_scene *s, struct err *err);

/* The 22 characters of a GUID, the same for the same text in each run. */
void ifc_guid(char guid[23], const char *text);
/* A STEP string in quotes: ' is doubled, what is not ASCII is written as \X2\...\X0\. */
void ifc_text(FILE *to, const char *text);

#endif
