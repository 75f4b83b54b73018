/* synthesis.h - texture for texels that no view shows, from like places of the same picture. See synthesis.c. */
#ifndef REMODEL_SYNTHESIS_H
#define REMODEL_SYNTHESIS_H

#include <stdint.h>

#include "common/base/err.h"

/* A texture, seen straight on. All arrays are of width * height texels. */
struct synthesis_picture {
    int width, height;
    const float *value;    /* 3 a texel, in display units (bake.h); read where `clean` */
    const uint8_t *unseen; /* 1: texture is wanted */
    const uint8_t *clean;  /* 1: a view shows the texel, and nothing unseen is near */
};

/* Sets source[texel], for unseen ones, to the clean texel whose surroundings belong there; -1: there is none, the place
 * is to be smooth. Seen texels get -1. Sets loose[texel] to 1 for seen ones whose colours must not spread into the hole
 * beside them, else to 0. Same bits for any number of threads. ST_NOMEM. */
enum status synthesis_find(int32_t *source, uint8_t *loose, const struct synthesis_picture *picture, struct err *err);

#endif
