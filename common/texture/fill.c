/* fill.c - texture for the texels that no view shows; see fill.h.
 *
 * The gradient solver joins what is copied (bake_composite.c), so a copy is a difference between neighbours. Where two
 * neighbours are copies from different places, each side has its own difference, and the mean counts.
 *
 * A view-independent atlas copies from its own faces, of which it has each whole. Atlases of viewpoints see parts of
 * faces, so they take their texture from that atlas: a hole then has the same texture from everywhere, and nothing
 * changes as one walks. */
#include "common/texture/fill.h"

#include <math.h>
#include <stdlib.h>

static const float OTHER = 0.25f;    /* display units: a seen texel this far from the guide shows something else */
static const float MAX_STEP = 0.15f; /* display units: between a seen texel and the copy of its place */

static void set_picture(struct texture_fill *f, const struct synthesis_picture *p)
{
    *f = (struct texture_fill){p->width, p->height, p->value, p->unseen, p->clean, NULL, NULL, NULL};
}

enum status texture_fill_find(struct texture_fill *f, const struct synthesis_picture *picture, struct err *err)
{
    const size_t texels = (size_t)picture->width * (size_t)picture->height;
    set_picture(f, picture);
    f->source = malloc((texels + 1) * sizeof *f->source);
    f->loose = calloc(texels + 1, 1);
    if (!f->source || !f->loose) return err_nomem(err, "the holes of a tile", texels * sizeof *f->source);
    return synthesis_find(f->source, f->loose, picture, err);
}

enum status texture_fill_guide(struct texture_fill *f, const struct synthesis_picture *picture, float *guide,
                               struct err *err)
{
    const size_t texels = (size_t)picture->width * (size_t)picture->height;
    set_picture(f, picture);
    f->guide = guide;
    if (!(f->loose = calloc(texels + 1, 1))) return err_nomem(err, "the holes of a tile", texels);
    for (size_t i = 0; i < texels; i++)
        for (size_t k = 0; k < 3 && !f->unseen[i] && !isnan(guide[3 * i]); k++)
            f->loose[i] |= fabsf(f->value[3 * i + k] - guide[3 * i + k]) > OTHER;
    return ST_OK;
}

bool texture_fill_copy(float copy[3], const struct texture_fill *f, size_t at, size_t of)
{
    const float *from;
    if (f->guide) {
        from = f->guide + 3 * of;
        if (isnan(from[0])) return false;
    } else {
        const int width = f->width;
        if (f->source[at] < 0) return false;
        const int x = f->source[at] % width + (int)(of % (size_t)width) - (int)(at % (size_t)width);
        const int y = f->source[at] / width + (int)(of / (size_t)width) - (int)(at / (size_t)width);
        if (x < 0 || y < 0 || x >= width || y >= f->height) return false;
        const size_t there = (size_t)y * (size_t)width + (size_t)x;
        if (!f->clean[there]) return false;
        from = f->value + 3 * there;
    }
    for (int k = 0; k < 3; k++) copy[k] = from[k];
    return true;
}

/* Whether the copy beside a seen texel is like it: otherwise an edge of the copy would show there. */
static bool joins(const struct texture_fill *f, size_t at, const float copy[3])
{
    if (f->unseen[at] || f->guide) return true;
    for (size_t k = 0; k < 3; k++)
        if (fabsf(copy[k] - f->value[3 * at + k]) > MAX_STEP) return false;
    return true;
}

bool texture_fill_difference(float difference[3], const struct texture_fill *f, size_t at, size_t next)
{
    float here[3], there[3];
    if (!f->unseen[at] || (!f->guide && f->unseen[next] && f->source[next] < 0)) return false;
    if (!texture_fill_copy(here, f, at, at) || !texture_fill_copy(there, f, at, next)) return false;
    if (!joins(f, next, there)) return false;
    for (int k = 0; k < 3; k++) difference[k] = there[k] - here[k];
    return true;
}

void texture_fill_release(struct texture_fill *f)
{
    free(f->source);
    free(f->loose);
    free(f->guide);
    *f = (struct texture_fill){0};
}
