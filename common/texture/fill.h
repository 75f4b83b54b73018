/* fill.h - where the texture of texels that no view shows is taken from: elsewhere on the same face. See fill.c. */
#ifndef REMODEL_TEXTURE_FILL_H
#define REMODEL_TEXTURE_FILL_H

#include "common/texture/bake.h"

enum { FILL_SHIFTS = 6 }; /* of a hole */

struct fill_hole {
    struct vec3 shift[FILL_SHIFTS]; /* on the face, in model units */
    int shifts;
};

struct texture_fill {
    const struct bake_tile *tile;
    const float *value;   /* 3 a texel; read where `clean` */
    const uint8_t *clean; /* 1: some view shows the texel, and nothing unseen is near */
    int32_t *hole;        /* per texel; -1: seen */
    uint8_t *choice;      /* index of the hole's shift; FILL_SHIFTS: none */
    struct fill_hole *holes;
    int hole_count;
};

/* Finds the shifts. Unseen texels are those of GRADIENT_FREE in `role` that are not `seen`. normal: of the face. All
 * arrays are of the tile's texels. Same bits for any number of threads. */
enum status texture_fill_find(struct texture_fill *f, const struct bake_tile *tile, struct vec3 normal,
                              const uint8_t *unseen, const uint8_t *clean, const float *value, struct err *err);
/* The texture that belongs at texel `of`, a hole's or another one, by the shift of the hole texel `at`; false: none. */
bool texture_fill_copy(float copy[3], const struct texture_fill *f, size_t at, size_t of);
/* The difference from texel `at` to `next` of the texture that is copied to `at`; false: none is. */
bool texture_fill_difference(float difference[3], const struct texture_fill *f, size_t at, size_t next);
void texture_fill_release(struct texture_fill *f);

#endif
