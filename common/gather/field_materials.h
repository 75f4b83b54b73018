/* field_materials.h - fitted materials on the surfaces of a field of light: where they are, and what they reflect.
 *
 * A texel of the VITA has a material if a region of materials.txt holds its middle and the model hides it from the
 * region's camera nowhere. Materials are on the unedited model. */
#ifndef REMODEL_GATHER_FIELD_MATERIALS_H
#define REMODEL_GATHER_FIELD_MATERIALS_H

#include "common/base/provenance.h"
#include "common/gather/field_atlas.h"
#include "common/gather/light_field.h"
#include "common/gather/materials.h"
#include "common/light/model_rays.h"
#include "common/model/model_axes.h"

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

/* The surfaces on which materials are. */
struct field_surface {
    struct field_atlas *atlas; /* its texels get marks */
    const struct model_rays *model;
    const struct face_plane *planes; /* of each face id */
};

/* Reads materials.txt and finds its regions on the model, once for an atlas; VIEWS has cameras.txt, images.txt,
 * lenses.txt. Same bits for any number of threads. The caller releases m, also after a failure. ST_DATA also: a region
 * in a view that lenses.txt does not have, more than FIELD_ATLAS_MARKS pairs of a material and a view that its texels
 * come from. */
enum status field_materials_read(struct field_materials *m, const struct field_surface *on, const char *path,
                                 const char *views, const struct model_axes *axes, struct provenance *prov,
                                 struct err *err);
void field_materials_release(struct field_materials *m);

struct surface_seen {
    struct vec3 at, normal; /* unit, of the side that is seen */
    struct vec3 to_viewer;  /* unit */
};

/* The radiance of a marked texel towards a viewer, from its radiance in the atlas. plain: the light around it, without
 * materials. False: its material has no gloss, and *radiance is unchanged. */
bool field_materials_reflect(struct rgb *radiance, const struct field_materials *m, const struct light_field *plain,
                             int mark, const struct surface_seen *surface);

#endif
