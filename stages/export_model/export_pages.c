/* export_pages.c - see export_pages.h.
 *
 * The nearest texel is found by two sweeps over the tile, forth and back, that pass on where the nearest texel of a
 * neighbour is (Danielsson): exact but for rare ties, which do not matter here. */
#include "stages/export_model/export_pages.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/sort.h"
#include "common/image/image.h"
#include "common/image/photo.h"
#include "common/product/product.h"

static const double saturated = 0.01;

enum status export_exposure(double *exposure, const struct atlas *a, const char *folder, struct err *err)
{
    float *values = NULL;
    size_t count = 0, room = 1;
    for (int i = 0; i < a->page_count; i++) room += (size_t)a->page_sizes[i][0] * (size_t)a->page_sizes[i][1];
    values = malloc(room * sizeof *values);
    if (!values) err_nomem(err, "texels", room * sizeof *values);
    for (int i = 0; !err->status && i < a->page_count; i++) {
        struct atlas_page page = {0};
        atlas_page_read(&page, a, i, folder, NULL, err);
        for (size_t k = 0; !err->status && k < (size_t)page.width * (size_t)page.height; k++) {
            const float *rgb = page.rgb + 3 * k, most = fmaxf(rgb[0], fmaxf(rgb[1], rgb[2]));
            if (page.source[k] != ATLAS_NONE && most > 0) values[count++] = most;
        }
        atlas_page_release(&page);
    }
    if (!err->status && count) sort_floats(values, count);
    *exposure = !err->status && count ? 1 / (double)values[(size_t)((1 - saturated) * (double)(count - 1))] : 1;
    free(values);
    return err->status;
}

struct nearest { /* of each texel of a tile: where its nearest texel is; -1: not known yet */
    int16_t *x, *y;
    int width, height;
};

static void take_from(struct nearest *n, int x, int y, int from_x, int from_y)
{
    if (from_x < 0 || from_y < 0 || from_x >= n->width || from_y >= n->height) return;
    const size_t to = (size_t)y * (size_t)n->width + (size_t)x;
    const size_t from = (size_t)from_y * (size_t)n->width + (size_t)from_x;
    if (n->x[from] < 0) return;
    const int dx = n->x[from] - x, dy = n->y[from] - y, old_x = n->x[to] - x, old_y = n->y[to] - y;
    if (n->x[to] >= 0 && old_x * old_x + old_y * old_y <= dx * dx + dy * dy) return;
    n->x[to] = n->x[from];
    n->y[to] = n->y[from];
}

static void sweep(struct nearest *n)
{
    for (int y = 0; y < n->height; y++) {
        for (int x = 0; x < n->width; x++) {
            for (int k = -1; k <= 1; k++) take_from(n, x, y, x + k, y - 1);
            take_from(n, x, y, x - 1, y);
        }
        for (int x = n->width - 1; x >= 0; x--) take_from(n, x, y, x + 1, y);
    }
    for (int y = n->height - 1; y >= 0; y--) {
        for (int x = n->width - 1; x >= 0; x--) {
            for (int k = -1; k <= 1; k++) take_from(n, x, y, x + k, y + 1);
            take_from(n, x, y, x + 1, y);
        }
        for (int x = 0; x < n->width; x++) take_from(n, x, y, x - 1, y);
    }
}

static enum status fill_tile(struct atlas_page *page, const struct atlas_tile *t, struct err *err)
{
    const size_t texels = (size_t)t->width * (size_t)t->height;
    struct nearest n = {malloc(texels * sizeof *n.x), malloc(texels * sizeof *n.y), t->width, t->height};
    if (!n.x || !n.y) err_nomem(err, "texels of a tile", texels * sizeof *n.x);
    for (int y = 0; !err->status && y < t->height; y++)
        for (int x = 0; x < t->width; x++) {
            const size_t i = (size_t)y * (size_t)t->width + (size_t)x;
            const bool texel =
                page->source[(size_t)(t->y + y) * (size_t)page->width + (size_t)(t->x + x)] != ATLAS_NONE;
            n.x[i] = texel ? (int16_t)x : -1;
            n.y[i] = texel ? (int16_t)y : -1;
        }
    if (!err->status) sweep(&n);
    for (int y = 0; !err->status && y < t->height; y++)
        for (int x = 0; x < t->width; x++) {
            const size_t i = (size_t)y * (size_t)t->width + (size_t)x;
            if (n.x[i] < 0) continue;
            const size_t to = (size_t)(t->y + y) * (size_t)page->width + (size_t)(t->x + x);
            const size_t from = (size_t)(t->y + n.y[i]) * (size_t)page->width + (size_t)(t->x + n.x[i]);
            if (to != from) memcpy(page->rgb + 3 * to, page->rgb + 3 * from, 3 * sizeof *page->rgb);
        }
    free(n.x);
    free(n.y);
    return err->status;
}

static enum status write_page(const struct atlas_page *page, double exposure, const char *path, struct err *err)
{
    const size_t texels = (size_t)page->width * (size_t)page->height;
    struct image im = {0};
    unsigned char *bytes = malloc(3 * texels);
    if (bytes)
        image_init(&im, page->width, page->height, 3, err);
    else
        err_nomem(err, "a page", 3 * texels);
    for (size_t i = 0; !err->status && i < 3 * texels; i++) im.data[i] = (float)(exposure * (double)page->rgb[i]);
    if (!err->status) {
        image_to_srgb8(&im, bytes);
        png_write(path, bytes, page->width, page->height, 3, err);
    }
    image_release(&im);
    free(bytes);
    return err->status;
}

enum status export_pages_write(const struct atlas *a, const char *folder, double exposure, const char *out,
                               struct provenance *prov, struct err *err)
{
    for (int i = 0; !err->status && i < a->page_count; i++) {
        struct atlas_page page = {0};
        char path[FILE_PATH];
        atlas_page_read(&page, a, i, folder, prov, err);
        for (int t = 0; !err->status && t < a->tile_count; t++)
            if (a->tiles[t].page == i) fill_tile(&page, &a->tiles[t], err);
        if (!err->status && !product_path_in(path, out, PRODUCT_EXPORT_PAGE, &(struct product_key){.page = i}, err))
            write_page(&page, exposure, path, err);
        atlas_page_release(&page);
    }
    return err->status;
}
