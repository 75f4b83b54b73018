/* fill.h - the texture of texels that no view shows: copied from elsewhere on the same face, or from an atlas in which
 * that was done before. See fill.c. */
#ifndef REMODEL_TEXTURE_FILL_H
#define REMODEL_TEXTURE_FILL_H

#include <stdbool.h>

#include "common/texture/synthesis.h"

/* {0} is the empty state. */
struct texture_fill {
    int width, height;
    const float *value;    /* 3 a texel; read where `clean`; not owned */
    const uint8_t *unseen; /* not owned */
    const uint8_t *clean;  /* 1: some view shows the texel, and nothing unseen is near; not owned */
    uint8_t *loose;        /* 1: the seen texel does not hold the colours of the hole beside it; NULL: all do; owned */
    int32_t *source;       /* per texel: the clean one that is copied there; -1: none; owned */
    float *guide;          /* 3 a texel: the filled atlas there; NAN: it has none; owned. If NULL, `source` counts */
};

/* Takes texture from the picture itself (synthesis.h). */
enum status texture_fill_find(struct texture_fill *f, const struct synthesis_picture *picture, struct err *err);
/* Takes texture from a guide, which becomes the fill's own. Seen texels that are unlike the guide do not hold the
 * colours of holes beside them: the view's rim shows furniture there. ST_NOMEM. */
enum status texture_fill_guide(struct texture_fill *f, const struct synthesis_picture *picture, float *guide,
                               struct err *err);
/* The texture that belongs at texel `of`, an unseen one or another near it, by what is copied to the unseen texel `at`;
 * false: none. */
bool texture_fill_copy(float copy[3], const struct texture_fill *f, size_t at, size_t of);
/* The difference from texel `at` to `next` of the texture that is copied to `at`; false: none is. */
bool texture_fill_difference(float difference[3], const struct texture_fill *f, size_t at, size_t next);
void texture_fill_release(struct texture_fill *f);

#endif
