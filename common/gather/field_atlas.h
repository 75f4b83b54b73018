/* field_atlas.h - the VITA of a model in memory, for gathers of light: the texel that a ray meets, at 8 bytes a
 * texel. */
#ifndef REMODEL_GATHER_FIELD_ATLAS_H
#define REMODEL_GATHER_FIELD_ATLAS_H

#include "common/gather/light_field.h"
#include "common/gather/light_list.h"
#include "common/texture/atlas.h"

/* {0} is the empty state; everything is owned. */
struct field_atlas {
    struct atlas atlas;
    uint64_t **pages; /* four 16-bit numbers a texel: R, G, B as halves, and what field_atlas.c packs with them */
    int *first;       /* of each face id: its first tile; the tiles of id are first[id] .. first[id + 1] - 1 */
    int ids;
};

/* Reads atlas.txt and all pages. ids: faces of the model have ids below. ST_DATA also: a tile that is not orthogonal,
 * as in a VDTA. The caller releases it, also after a failure. */
enum status field_atlas_read(struct field_atlas *a, const char *folder, int ids, struct provenance *prov,
                             struct err *err);
void field_atlas_release(struct field_atlas *a);

/* Leaves out the tiles of the faces for which dropped[id] is set, and adds tiles, packed on pages of their own, whose
 * faces have ids below a->ids. Pages keep their places; the new ones follow. ST_NOMEM. */
enum status field_atlas_replace(struct field_atlas *a, const bool *dropped, const struct atlas *extra,
                                const struct atlas_page *pages, struct err *err);

/* Where the texel at a point of a face is: its page, and its place there; false: the atlas has none. */
bool field_atlas_find(const struct field_atlas *a, int face, struct vec3 p, int *page, size_t *texel);

/* What the atlas has at a point. */
struct field_texel {
    struct rgb radiance;      /* 0 without a texel */
    enum light_source source; /* LIGHT_NONE: no texel */
    int mark;                 /* of field_atlas_mark(); -1: none */
};

/* The texel at a point of a face, model frame. */
struct field_texel field_atlas_look(const struct field_atlas *a, int face, struct vec3 p);

/* Lets the processor begin to load the texel that field_atlas_look() will probably need, while the caller works on
 * other rays. Optional: it changes no result. */
void field_atlas_prefetch(const struct field_atlas *a, int face, struct vec3 p);

/* The middle of the texel of a face that is nearest to a point, in the plane of its tile; false: the face has none. */
bool field_atlas_nearest(const struct field_atlas *a, int face, struct vec3 p, struct vec3 *nearest);

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

/* Texel (x, y) of a tile, counted from the tile's first. */
bool field_atlas_has(const struct field_atlas *a, const struct atlas_tile *t, int x, int y);
/* The middle of it on the face's plane. */
struct vec3 field_atlas_place(const struct atlas_tile *t, struct face_plane plane, int x, int y);
/* The view that it comes from, an index into atlas.sources; -1: unknown, or no view. A texel with a mark no longer has
 * it. */
int field_atlas_view(const struct field_atlas *a, const struct atlas_tile *t, int x, int y);

/* Gives it a number that field_atlas_look() returns, 0 .. FIELD_ATLAS_MARKS - 1. */
enum { FIELD_ATLAS_MARKS = 4096 };
void field_atlas_mark(struct field_atlas *a, const struct atlas_tile *t, int x, int y, int mark);

#endif
