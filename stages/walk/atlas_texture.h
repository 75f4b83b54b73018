/* atlas_texture.h - pages of atlases as pictures of a walk. */
#ifndef REMODEL_ATLAS_TEXTURE_H
#define REMODEL_ATLAS_TEXTURE_H

#include <stdio.h>

#include "common/image/image.h"
#include "common/texture/atlas.h"
#include "stages/walk/walk_params.h"

/* What alpha says of a texel; docs/formats/textures.md. */
enum { ALPHA_NONE = 0, ALPHA_DEFAULT = 64, ALPHA_SYNTHESISED = 128, ALPHA_WARPED = 192, ALPHA_ORIGINAL = 255 };

/* Writes the page as a text in base64: sRGB of radiance times exposure, the colours of missing texels spread from the
 * nearest ones of their tile. The page changes. a: whose page it is; index: its number. */
enum status atlas_texture_write(FILE *to, const struct atlas *a, struct atlas_page *page, int index, double exposure,
                                const struct walk_params *params, struct err *err);

/* 8-bit sRGB of linear colours, with an alpha of its own for each pixel: 4 bytes a pixel, which the caller frees. */
enum status atlas_texture_bytes(unsigned char **rgba, const struct image *linear, const unsigned char *alpha,
                                struct err *err);
/* Encodes and writes them. */
enum status atlas_texture_encode(FILE *to, const unsigned char *rgba, int width, int height, int quality, int effort,
                                 struct err *err);

#endif
