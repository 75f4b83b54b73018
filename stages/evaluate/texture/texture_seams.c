/* texture_seams.c - see texture_seams.h. */
#include "stages/evaluate/texture/texture_seams.h"

#include "common/image/image.h"

struct seam_tile {
    const struct atlas_page *page;
    const struct atlas_tile *tile;
    double white;
};

static uint32_t source_at(const struct seam_tile *t, int x, int y)
{
    if (x < 0 || y < 0 || x >= t->tile->width || y >= t->tile->height) return ATLAS_NONE;
    return t->page->source[(size_t)(t->tile->y + y) * (size_t)t->page->width + (size_t)(t->tile->x + x)];
}

static double energy(const struct seam_tile *t, int x, int y, int dx, int dy)
{
    const size_t a = (size_t)(t->tile->y + y) * (size_t)t->page->width + (size_t)(t->tile->x + x);
    const size_t b = (size_t)(t->tile->y + y + dy) * (size_t)t->page->width + (size_t)(t->tile->x + x + dx);
    double sum = 0;
    for (size_t c = 0; c < 3; c++) {
        const double d = srgb_from_linear((float)(t->page->rgb[3 * a + c] / t->white)) -
                         srgb_from_linear((float)(t->page->rgb[3 * b + c] / t->white));
        sum += d * d;
    }
    return sum;
}

/* The pair (x, y), (x + dx, y + dy), if its texels come from different views. */
static void add_pair(struct texture_seams *s, const struct seam_tile *t, int x, int y, int dx, int dy)
{
    const uint32_t a = source_at(t, x, y), b = source_at(t, x + dx, y + dy);
    double beside = 0;
    int pairs = 0;
    if (a < ATLAS_VIEWS || b < ATLAS_VIEWS || a == b) return;
    for (int k = -SEAM_REACH; k <= SEAM_REACH; k++) {
        const int u = x + k * dx, v = y + k * dy;
        const uint32_t c = source_at(t, u, v);
        if (c < ATLAS_VIEWS || c != source_at(t, u + dx, v + dy)) continue;
        beside += energy(t, u, v, dx, dy);
        pairs++;
    }
    if (!pairs) return;
    s->across += energy(t, x, y, dx, dy);
    s->across_pairs++;
    s->beside += beside;
    s->beside_pairs += (uint64_t)pairs;
}

void texture_seams_add(struct texture_seams *s, const struct atlas_page *page, const struct atlas_tile *tile,
                       double white)
{
    const struct seam_tile t = {page, tile, white};
    for (int y = 0; y < tile->height; y++)
        for (int x = 0; x < tile->width; x++) {
            add_pair(s, &t, x, y, 1, 0);
            add_pair(s, &t, x, y, 0, 1);
        }
}

bool texture_seams_ratio(const struct texture_seams *s, double *ratio)
{
    if (!s->across_pairs || !(s->beside > 0)) return false;
    *ratio = s->across / (double)s->across_pairs / (s->beside / (double)s->beside_pairs);
    return true;
}
