/* field_atlas.h - the VITA of a model in memory, for gathers of light: the texel that a ray meets, at 8 bytes a texel. */
#ifndef REMODEL_GATHER_FIELD_ATLAS_H
#define REMODEL_GATHER_FIELD_ATLAS_H

#include "common/gather/light_field.h"
#include "common/gather/lights.h"
#include "common/texture/atlas.h"

/* {0} is the empty state; everything is owned. */
struct field_atlas {
    struct atlas atlas;
    uint64_t **pages; /* four 16-bit numbers a texel: R, G, B as halves, and an enum light_source */
    int *first;       /* of each face id: its first tile; the tiles of id are first[id] .. first[id + 1] - 1 */
    int ids;
};

/* Reads atlas.txt and all pages. ids: faces of the model have ids below. ST_DATA also: a tile that is not orthogonal, as
 * in a VDTA. The caller releases it, also after a failure. */
enum status field_atlas_read(struct field_atlas *a, const char *folder, int ids, struct provenance *prov,
                             struct err *err);
void field_atlas_release(struct field_atlas *a);

/* The radiance of the texel at a point of a face, model frame. LIGHT_NONE: the atlas has none there, *radiance is 0. */
enum light_source field_atlas_look(struct rgb *radiance, const struct field_atlas *a, int face, struct vec3 p);

/* A face's plane, normal . p = offset. */
struct face_plane {
    struct vec3 normal; /* unit */
    double offset;
};

/* Replaces texels of a face under a lamp, and close around it, by the median colour of those a little further off, and
 * marks them LIGHT_SYNTHESISED. Adds their number to *covered. Nothing happens to a face that looks elsewhere than the
 * lamp, or lies more than `reach` from it. */
enum status field_atlas_cover_lamp(struct field_atlas *a, int *covered, int face, struct face_plane plane,
                                   const struct lamp *lamp, double reach, struct err *err);

#endif
