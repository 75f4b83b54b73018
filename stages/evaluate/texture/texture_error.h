/* texture_error.h - errors of the texels of atlases, by face, and what their sources show. docs/evaluation.md defines
 * the metrics (texture.*). */
#ifndef REMODEL_TEXTURE_ERROR_H
#define REMODEL_TEXTURE_ERROR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "common/base/err.h"

#define MIN_FACE_TEXELS 1000 /* measured texels of a face that has an error of its own */
#define TEXTURE_DIFFERS 0.2  /* relative difference of luminance that counts as another colour */

/* What is known of a texel. */
enum texel_flag {
    TEXEL_EXISTS = 1 << 0,
    TEXEL_WARPED = 1 << 1,          /* from another view than the viewpoint's own */
    TEXEL_FILLED = 1 << 2,          /* synthesised, or the default colour: no view shows it clean */
    TEXEL_COMPARED = 1 << 3,        /* its true radiance is known: `square` counts */
    TEXEL_DIFFERS = 1 << 4,         /* from the truth, by more than TEXTURE_DIFFERS */
    TEXEL_SOURCE_KNOWN = 1 << 5,    /* the truth says what stands in front of it in its source's photo */
    TEXEL_SOURCE_CLUTTER = 1 << 6,  /* that is clutter */
    TEXEL_SOURCE_CLEAN = 1 << 7,    /* nothing does, and the source sees the point */
    TEXEL_OWN_CLUTTER = 1 << 8,     /* the viewpoint's own photo shows clutter of another colour there */
    TEXEL_CLEAN_SOMEWHERE = 1 << 9, /* some photo shows it clean and unclipped */
};

struct texel_facts {
    float square; /* sum over R, G, B of the squared difference from the truth, in 8-bit sRGB */
    uint32_t flags;
};

enum texture_part { TEXTURE_ORIGINAL, TEXTURE_WARPED, TEXTURE_SEEN, TEXTURE_SYNTHESISED, TEXTURE_PARTS };

struct texture_sum {
    double square;
    uint64_t texels;
};

struct texture_error {
    struct texture_sum (*faces)[TEXTURE_PARTS]; /* by face id; owned */
    int face_count;
    uint64_t texels, compared;
    uint64_t clutter, avoided;     /* texels whose own photo shows clutter; of them, those that do not */
    uint64_t from_views, baked;    /* compared texels of known sources; of them, those that show clutter */
    uint64_t clean, clean_unknown; /* texels that some photo shows clean; of them, those that were filled */
};

/* Faces have ids below face_count. The caller releases e. */
enum status texture_error_init(struct texture_error *e, int face_count, struct err *err);
void texture_error_release(struct texture_error *e);
/* Adds texels of a face, in their order. */
void texture_error_add(struct texture_error *e, int face, const struct texel_facts *facts, size_t count);

/* The error of two radiances with `white` as white, as texel_facts.square wants it, and whether their luminance differs
 * by more than TEXTURE_DIFFERS of the second's. */
float texture_texel_square(const float found[3], const float truth[3], double white);
bool texture_texel_differs(const float found[3], const float truth[3]);

/* dB, at most 99, of a face with at least MIN_FACE_TEXELS texels in a part; false: it has fewer. */
bool texture_face_psnr(const struct texture_error *e, int face, enum texture_part part, double *db);
/* The median of these over the faces; false: none has one. ST_NOMEM. */
enum status texture_median_psnr(const struct texture_error *e, enum texture_part part, double *db, bool *found,
                                struct err *err);

#endif
