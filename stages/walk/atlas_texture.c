/* atlas_texture.c - see atlas_texture.h. */
#include "stages/walk/atlas_texture.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/base64.h"
#include "common/texture/page_spread.h"
#include "stages/walk/webp_picture.h"

enum status atlas_texture_bytes(unsigned char **rgba, const struct image *linear, const unsigned char *alpha,
                                struct err *err)
{
    const size_t pixels = (size_t)linear->width * (size_t)linear->height;
    unsigned char *rgb = malloc(3 * pixels + 1);
    *rgba = malloc(4 * pixels + 1);
    if (!rgb || !*rgba) {
        free(rgb);
        return err_nomem(err, "a picture", 7 * pixels);
    }
    image_to_srgb8(linear, rgb);
    for (size_t i = 0; i < pixels; i++) {
        memcpy(*rgba + 4 * i, rgb + 3 * i, 3);
        (*rgba)[4 * i + 3] = alpha[i];
    }
    free(rgb);
    return ST_OK;
}

enum status atlas_texture_encode(FILE *to, const unsigned char *rgba, int width, int height, int quality, int effort,
                                 struct err *err)
{
    unsigned char *bytes = NULL;
    size_t size = 0;
    putc('"', to);
    if (!webp_picture_encode(&bytes, &size, rgba, width, height, quality, effort, err)) base64_write(to, bytes, size);
    putc('"', to);
    free(bytes);
    return err->status;
}

static bool is_own(const struct atlas *a, const char *view)
{
    for (int i = 0; i < a->view_count; i++)
        if (!strcmp(a->views[i], view)) return true;
    return false;
}

static unsigned char alpha_of(const struct atlas *a, uint32_t source)
{
    switch (source) {
    case ATLAS_NONE:
        return ALPHA_NONE;
    case ATLAS_SYNTHESISED:
        return ALPHA_SYNTHESISED;
    case ATLAS_DEFAULT:
        return ALPHA_DEFAULT;
    default:
        return is_own(a, a->sources[source - ATLAS_VIEWS]) ? ALPHA_ORIGINAL : ALPHA_WARPED;
    }
}

enum status atlas_texture_write(FILE *to, const struct atlas *a, struct atlas_page *page, int index, double exposure,
                                const struct walk_params *params, struct err *err)
{
    const size_t texels = (size_t)page->width * (size_t)page->height;
    struct image im = {0};
    unsigned char *alpha = malloc(texels + 1), *rgba = NULL;
    if (!alpha) err_nomem(err, "a page", texels);
    for (int t = 0; !err->status && t < a->tile_count; t++)
        if (a->tiles[t].page == index) page_spread(page, &a->tiles[t], err);
    if (!err->status) image_init(&im, page->width, page->height, 3, err);
    for (size_t i = 0; !err->status && i < texels; i++) {
        alpha[i] = alpha_of(a, page->source[i]);
        for (size_t c = 0; c < 3; c++) im.data[3 * i + c] = (float)(exposure * (double)page->rgb[3 * i + c]);
    }
    if (!err->status && !atlas_texture_bytes(&rgba, &im, alpha, err))
        atlas_texture_encode(to, rgba, page->width, page->height, params->texture_quality, params->effort, err);
    image_release(&im);
    free(alpha);
    free(rgba);
    return err->status;
}
