/* texture_error.c - see texture_error.h. Sums are in the order of the texels. */
#include "stages/evaluate/texture/texture_error.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/sort.h"
#include "common/image/image.h"
#include "common/image/luminance.h"

#define MAX_DB 99.0 /* the value of equal pictures */

enum status texture_error_init(struct texture_error *e, int face_count, struct err *err)
{
    *e = (struct texture_error){.face_count = face_count};
    e->faces = calloc((size_t)face_count + 1, sizeof *e->faces);
    return e->faces ? ST_OK : err_nomem(err, "errors of faces", (size_t)face_count * sizeof *e->faces);
}

void texture_error_release(struct texture_error *e)
{
    free(e->faces);
    *e = (struct texture_error){0};
}

static void add_square(struct texture_sum *s, float square)
{
    s->square += square;
    s->texels++;
}

/* The parts of PSNR to which a compared texel belongs. */
static void add_compared(struct texture_sum *face, const struct texel_facts *t)
{
    if (t->flags & TEXEL_FILLED) {
        add_square(&face[TEXTURE_SYNTHESISED], t->square);
        return;
    }
    const bool seen = t->flags & TEXEL_SOURCE_KNOWN && !(t->flags & TEXEL_SOURCE_CLUTTER);
    if (t->flags & TEXEL_WARPED) add_square(&face[TEXTURE_WARPED], t->square);
    if (seen) add_square(&face[TEXTURE_SEEN], t->square);
    if (seen && !(t->flags & TEXEL_WARPED)) add_square(&face[TEXTURE_ORIGINAL], t->square);
}

void texture_error_add(struct texture_error *e, int face, const struct texel_facts *facts, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const uint32_t f = facts[i].flags;
        if (!(f & TEXEL_EXISTS)) continue;
        e->texels++;
        if (f & TEXEL_COMPARED) {
            e->compared++;
            add_compared(e->faces[face], &facts[i]);
        }
        if (f & TEXEL_COMPARED && f & TEXEL_SOURCE_KNOWN) {
            e->from_views++;
            e->baked += f & TEXEL_SOURCE_CLUTTER && f & TEXEL_DIFFERS;
        }
        if (f & TEXEL_OWN_CLUTTER) {
            e->clutter++;
            e->avoided += f & (TEXEL_FILLED | TEXEL_SOURCE_CLEAN) ? 1 : 0;
        }
        if (f & TEXEL_CLEAN_SOMEWHERE) {
            e->clean++;
            e->clean_unknown += f & TEXEL_FILLED ? 1 : 0;
        }
    }
}

static double encoded(double radiance, double white)
{
    return nearbyint(255 * srgb_from_linear((float)(radiance / white)));
}

float texture_texel_square(const float found[3], const float truth[3], double white)
{
    double sum = 0;
    for (int c = 0; c < 3; c++) {
        const double d = encoded(found[c], white) - encoded(truth[c], white);
        sum += d * d;
    }
    return (float)sum;
}

bool texture_texel_differs(const float found[3], const float truth[3])
{
    const double y = luminance_precise(truth);
    return fabs(luminance_precise(found) - y) > TEXTURE_DIFFERS * y;
}

bool texture_face_psnr(const struct texture_error *e, int face, enum texture_part part, double *db)
{
    const struct texture_sum *s = &e->faces[face][part];
    if (s->texels < MIN_FACE_TEXELS) return false;
    const double mean = s->square / (3 * (double)s->texels);
    *db = mean > 0 ? fmin(10 * log10(255.0 * 255.0 / mean), MAX_DB) : MAX_DB;
    return true;
}

enum status texture_median_psnr(const struct texture_error *e, enum texture_part part, double *db, bool *found,
                                struct err *err)
{
    double *values = malloc(((size_t)e->face_count + 1) * sizeof *values);
    int count = 0;
    if (!values) return err_nomem(err, "errors of faces", (size_t)e->face_count * sizeof *values);
    for (int i = 0; i < e->face_count; i++) count += texture_face_psnr(e, i, part, &values[count]);
    *found = count > 0;
    if (count) *db = sort_median(values, (size_t)count);
    free(values);
    return ST_OK;
}
