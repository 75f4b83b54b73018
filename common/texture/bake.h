/* bake.h - textures of a model from photographs: the texels that an atlas wants, the views that show each of them, the
 * choice among these, and the composite [Colburn 2014, 4.5.2, 4.5.3].
 *
 * The steps, in order:
 *   bake_add_tile() for each tile; the caller marks its texels
 *   bake_list_texels()        which texels need candidates
 *   bake_add_view()           for each view: its colour for each texel that it shows, if it may be used
 *   bake_find_gains()         one gain a view and colour, so that views agree where they show the same
 *   bake_choose()             the best candidate of each texel, or none
 *   bake_composite()          joins them in the gradient domain and fills what no view shows
 * Each gives the same bits for any number of threads. */
#ifndef REMODEL_BAKE_H
#define REMODEL_BAKE_H

#include "common/texture/atlas.h"
#include "common/texture/source_view.h"
#include "common/texture/surfaces.h"

enum { CANDIDATES = 6 }; /* of a texel: the best by penalty are kept */
enum { PROBE = 4 };      /* every PROBE-th original texel in x and y has candidates too, for the gains */

enum texel_role {
    TEXEL_NONE,     /* not wanted */
    TEXEL_WANTED,   /* to be warped or synthesised */
    TEXEL_ORIGINAL, /* the viewpoint's own pixel shows it: copied */
    TEXEL_DOUBTED,  /* the viewpoint's own pixel may show it: other views decide */
};

struct bake_tile {
    int surface;
    int view;                     /* index into the viewpoint's views; -1: an orthogonal tile */
    int x, y;                     /* of its first texel in the raster of its view, or of its surface */
    double side;                  /* of a texel: orthogonal, in model units; else at distance 1, seen head on */
    struct surface_raster raster; /* of its texels */
    double matrix[3][4];          /* model frame -> pixels of that raster: (x w, y w, w) */
    size_t first;                 /* its first texel */
};

struct candidate {
    float rgb[3], penalty;
    float around[3]; /* the colour of a wider area, which noise and small errors of the cameras move less: for votes */
    uint16_t source;
    uint8_t state; /* SOURCE_POOR and above */
};

/* A view that colours come from. */
struct bake_source {
    char *name;    /* owned */
    int group;     /* views with one centre, those of a photo, have one number */
    float gain[3]; /* its colours are multiplied by it */
    bool own;      /* of the viewpoint that is baked */
};

/* What a texel became; indices into a tile's texels are y * width + x from its `first`. Everything is owned but
 * surfaces and params. */
struct bake {
    const struct surfaces *surfaces;
    const struct texture_params *params;
    struct bake_source *sources; /* in order of name */
    int source_count;
    bool has_centre; /* textures of a viewpoint */
    struct vec3 centre;
    int own_group; /* the viewpoint's group of sources */
    double white;  /* radiance that counts as white: the unit of display */
    struct bake_tile *tiles;
    int tile_count;
    size_t texel_count, texel_room;
    uint8_t *role;  /* enum texel_role */
    float *rgb;     /* 3 a texel: given for ORIGINAL and DOUBTED; the result for all */
    uint32_t *made; /* enum atlas_source, or ATLAS_VIEWS + source; the result */
    int32_t *list;  /* -1: no candidates */
    struct candidate (*lists)[CANDIDATES];
    uint8_t *counts;
    uint8_t *hidden; /* views in which something stands in front of the texel */
    uint8_t *surely; /* 1: in one of them that is not the view's word alone (SOURCE_HIDDEN) */
    size_t list_count;
    struct filled_atlas *filled; /* where unseen texels take their texture from; NULL: from their own face */
};

struct bake_totals {
    size_t texels, original, warped, synthesised, by_default; /* wanted; how they were made */
    double residual;                                          /* largest of all solves */
};

void bake_release(struct bake *b);
/* Room for a tile whose texels are TEXEL_NONE; tile->first is set. Pointers into the arrays change. */
enum status bake_add_tile(struct bake *b, struct bake_tile tile, struct err *err);
/* Sources, in order of name, with their groups; gains are 1. names are copied. */
enum status bake_set_sources(struct bake *b, const char *const *names, const int *groups, const bool *own, int count,
                             struct err *err);
enum status bake_list_texels(struct bake *b, struct err *err);
void bake_add_view(struct bake *b, const struct source_view *view, int source);
enum status bake_find_gains(struct bake *b, struct err *err);
void bake_choose(struct bake *b);
enum status bake_composite(struct bake *b, struct bake_totals *totals, struct err *err);

/* Display units: D(r) = log(1 + r / (0.05 white)) / log(21), 0 at black and 1 at white, near a logarithm between and
 * beyond. A gain of light is nearly a shift there, and no radiance becomes negative on the way back. */
float bake_display(float radiance, double white);
float bake_radiance(float display, double white);

/* The texel's point in the model's frame, at (x, y) of the tile's raster; false: behind the camera. */
bool bake_tile_point(struct vec3 *p, const struct bake_tile *t, double x, double y);

#endif
