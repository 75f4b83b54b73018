/* atlas_squares.h - points spread over the textured faces of a model, with the brightness that photographs show. */
#ifndef REMODEL_ATLAS_SQUARES_H
#define REMODEL_ATLAS_SQUARES_H

#include "common/gather/field_atlas.h"
#include "common/light/model_rays.h"

/* The model without panes, its textures, and the planes of its faces by id. */
struct atlas_scene {
    const struct model_rays *model;
    const struct field_atlas *atlas;
    const struct face_plane *planes;
};

/* The mean of the photographed texels of a square. */
struct atlas_square {
    struct vec3 at, normal; /* model frame */
    float level[3];         /* logarithms of the radiance */
    int tile;               /* of the atlas */
    int column, row;        /* of the square among those of the tile */
};

/* Neighbours on a face. */
struct atlas_pair {
    int a, b;
};

/* {0} is the empty state; everything is owned. */
struct atlas_squares {
    struct atlas_square *list; /* in order of tile, row and column */
    struct atlas_pair *pairs;
    int count, pair_count;
    double side; /* of a square, about; model units */
};

/* Which squares are kept, by the middle of one on a tile; NULL: all. */
struct atlas_filter {
    bool (*keep)(const void *ctx, int tile, struct vec3 at);
    const void *ctx;
};

/* The side of squares of which about `wanted` cover all photographed texels; 0: there are none. */
double atlas_squares_side(const struct atlas_scene *scene, int wanted);

/* Lists squares of this side, and pairs of them that are `gap` squares apart. ST_NOMEM. */
enum status atlas_squares_list(struct atlas_squares *s, const struct atlas_scene *scene, double side, int gap,
                               const struct atlas_filter *filter, struct err *err);
void atlas_squares_release(struct atlas_squares *s);

/* Where squares are, by tile, to ask what is near them. {0} is the empty state; everything is owned. */
struct atlas_places {
    struct vec3 *at;
    int *first; /* of each tile: its first place; one more for the end */
};

/* The squares that are marked; marked: of each, NULL: all. tiles: of the atlas. ST_NOMEM. */
enum status atlas_places_list(struct atlas_places *p, const struct atlas_squares *squares, const bool *marked,
                              int tiles, struct err *err);
/* Whether a place of the tile is closer than `reach` along each axis. */
bool atlas_places_near(const struct atlas_places *p, int tile, struct vec3 at, double reach);
void atlas_places_release(struct atlas_places *p);

#endif
