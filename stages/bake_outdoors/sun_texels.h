/* sun_texels.h - points spread over the textured faces of a model, in which patches of sun are looked for. */
#ifndef REMODEL_SUN_TEXELS_H
#define REMODEL_SUN_TEXELS_H

#include "common/gather/field_atlas.h"
#include "common/light/model_rays.h"

/* The model without panes, its textures, and the planes of its faces by id. */
struct sun_scene {
    const struct model_rays *model;
    const struct field_atlas *atlas;
    const struct face_plane *planes;
};

/* The mean of the photographed texels of a square. */
struct sun_texel {
    struct vec3 at, normal; /* model frame */
    float level[3];         /* logarithms of the radiance */
    int tile;               /* of the atlas */
    int column, row;        /* of the square among those of the tile */
};

/* Neighbours on a face. */
struct sun_pair {
    int a, b;
};

/* {0} is the empty state; everything is owned. */
struct sun_texels {
    struct sun_texel *list; /* in order of tile, row and column */
    struct sun_pair *pairs;
    int count, pair_count;
    double side; /* of a square, about; model units */
};

/* Which squares are kept, by the middle of one on a tile; NULL: all. */
struct sun_filter {
    bool (*keep)(const void *ctx, int tile, struct vec3 at);
    const void *ctx;
};

/* The side of squares of which about `wanted` cover all photographed texels; 0: there are none. */
double sun_texels_side(const struct sun_scene *scene, int wanted);

/* Lists squares of this side, and pairs of them that are `gap` squares apart. ST_NOMEM. */
enum status sun_texels_list(struct sun_texels *s, const struct sun_scene *scene, double side, int gap,
                            const struct sun_filter *filter, struct err *err);
void sun_texels_release(struct sun_texels *s);

/* Where squares are, by tile, to ask what is near them. {0} is the empty state; everything is owned. */
struct sun_places {
    struct vec3 *at;
    int *first; /* of each tile: its first place; one more for the end */
};

/* The squares that are marked; marked: of each, NULL: all. tiles: of the atlas. ST_NOMEM. */
enum status sun_places_list(struct sun_places *p, const struct sun_texels *squares, const bool *marked, int tiles,
                            struct err *err);
/* Whether a place of the tile is closer than `reach` along each axis. */
bool sun_places_near(const struct sun_places *p, int tile, struct vec3 at, double reach);
void sun_places_release(struct sun_places *p);

#endif
