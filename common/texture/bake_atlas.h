/* bake_atlas.h - a bake as an atlas on disk. */
#ifndef REMODEL_BAKE_ATLAS_H
#define REMODEL_BAKE_ATLAS_H

#include "common/texture/bake.h"

/* Packs the tiles and writes atlas.txt and the pages to the folder (common/texture/atlas.h). viewpoint NULL: an atlas
 * without a viewpoint, views is then ignored. views: names, which tiles' `view` are indices into. *texels: of all pages. */
enum status bake_write_atlas(const struct bake *b, const char *viewpoint, char *const *views, int view_count,
                             const char *folder, const struct provenance *prov, size_t *texels, struct err *err);

#endif
