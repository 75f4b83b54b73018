/* field_materials.h - fitted materials on the surfaces of a field of light: where they are, and what they reflect.
 *
 * A texel of the VITA has a material if a region of materials.txt holds its middle and the model hides it from the
 * region's camera nowhere. Materials are on the unedited model. */
#ifndef REMODEL_GATHER_FIELD_MATERIALS_H
#define REMODEL_GATHER_FIELD_MATERIALS_H

#include "common/base/provenance.h"
#include "common/gather/light_field.h"
#include "common/gather/materials.h"
#include "common/model/model_axes.h"

struct model_field;

/* A texel's material, and the place from which it was photographed. */
struct field_mark {
    int material; /* index into the list */
    struct vec3 viewpoint;
};

/* {0} is the empty state: no materials. Everything is owned. */
struct field_materials {
    struct material_list list;
    struct brdf *brdfs;       /* of the list's materials */
    size_t *texels;           /* of each material: how many texels have it */
    struct field_mark *marks; /* the mark of a texel is an index into these */
    int mark_count;
};

/* Reads materials.txt and finds its regions on the model; VIEWS has cameras.txt, images.txt, lenses.txt. Once for a
 * field, after model_field_read(). From then on a ray that meets a texel of a glossy material sees it as its own origin
 * would (field_materials.c), with the source LIGHT_MATERIAL. Same bits for any number of threads. ST_DATA also: a
 * region in a view that lenses.txt does not have, more than FIELD_ATLAS_MARKS pairs of a material and a view that its
 * texels come from. */
enum status model_field_read_materials(struct model_field *f, const char *path, const char *views,
                                       const struct model_axes *axes, struct provenance *prov, struct err *err);
void field_materials_release(struct model_field *f);

/* The material at a point of a face, an index into materials.list; -1: none, or no texel. Model frame. */
int field_material_at(const struct model_field *f, int face_id, struct vec3 p);
/* From where the texel at a point of a face was photographed, as far as its mark knows; *viewpoint is unchanged where
 * it has none. */
void field_material_viewpoint(const struct model_field *f, int face_id, struct vec3 p, struct vec3 *viewpoint);
/* The reflectance of a material of the list, with its fitted k_s. */
const struct brdf *field_material_brdf(const struct model_field *f, int material);

struct surface_seen {
    struct vec3 at, normal; /* unit, of the side that is seen */
    struct vec3 to_viewer;  /* unit */
};

/* The radiance of a marked texel towards a viewer, from its radiance in the atlas. False: its material has no gloss,
 * and *radiance is unchanged. */
bool field_material_reflect(struct rgb *radiance, const struct model_field *f, int mark,
                            const struct surface_seen *surface);

#endif
