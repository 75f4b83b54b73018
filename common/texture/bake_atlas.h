/* bake_atlas.h - a bake as pages of an atlas on disk. */
#ifndef REMODEL_BAKE_ATLAS_H
#define REMODEL_BAKE_ATLAS_H

#include "common/texture/bake.h"

/* Packs the bake's tiles on pages of their own behind those that the atlas has, writes these pages to the folder, and
 * adds tiles and pages to the atlas. source_of[i]: place of the bake's source i among the atlas's sources; NULL: i.
 * texels: of the pages are added to it. Call atlas_write_list() after the last bake. */
enum status bake_write_pages(struct atlas *a, const struct bake *b, const int *source_of, const char *folder,
                             const struct provenance *prov, size_t *texels, struct err *err);

#endif
