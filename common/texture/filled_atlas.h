/* filled_atlas.h - the view-independent atlas as the texture of what a viewpoint's photos do not show. */
#ifndef REMODEL_FILLED_ATLAS_H
#define REMODEL_FILLED_ATLAS_H

#include "common/texture/bake.h"

struct filled_page {
    struct atlas_page texels; /* empty until it is needed */
    struct provenance inputs; /* its file, once it was read */
};

/* {0} is the empty state; everything is owned. */
struct filled_atlas {
    char *folder;
    struct atlas atlas;
    struct filled_page *pages;
    int held;                /* pages in memory */
    struct provenance *prov; /* of the product that is made; pages are added as they are used; not owned */
};

/* Reads atlas.txt. The caller releases a in each case. */
enum status filled_atlas_open(struct filled_atlas *a, const char *folder, struct provenance *prov, struct err *err);
void filled_atlas_release(struct filled_atlas *a);
/* Frees pages, if many are in memory. */
void filled_atlas_spare(struct filled_atlas *a);

/* 3 numbers a texel of the tile, in display units of the bake: what the atlas has there; NAN: nothing, or the default
 * colour. The caller frees it. NULL: err says why. */
float *filled_atlas_tile(struct filled_atlas *a, const struct bake *b, const struct bake_tile *t, struct err *err);

/* How far a viewpoint's own texels are above the atlas, the median of each colour, in display units: its photos have an
 * exposure and a daylight of their own. *known: false: too few texels tell. */
enum status filled_atlas_level(float level[3], bool *known, struct filled_atlas *a, const struct bake *b,
                               struct err *err);

#endif
