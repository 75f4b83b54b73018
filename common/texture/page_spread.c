/* page_spread.c - see page_spread.h.
 *
 * The nearest texel is found by two sweeps over the tile, forth and back, that pass on where the nearest texel of a
 * neighbour is (Danielsson): exact but for rare ties, which do not matter here. */
#include "common/texture/page_spread.h"

#include <stdlib.h>
#include <string.h>

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

enum status page_spread(struct atlas_page *page, const struct atlas_tile *t, struct err *err)
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
