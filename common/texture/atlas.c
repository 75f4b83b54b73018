/* atlas.c - see atlas.h: tiles on pages, and look-ups.
 *
 * Packing [Colburn 2014, 4.5.1] is first-fit decreasing: tiles in order of falling height go to the first page, and
 * there to the uppermost, then leftmost place in which they fit. The thesis asks for an empty block and leaves open how
 * it is found. Here a page keeps its maximal free rectangles: those that no larger free rectangle contains [Jylanki
 * 2010]. A place from which a tile can move neither up nor left is the upper left corner of one of them, so the first
 * place is found exactly without a search of the page's area. A tile replaces each rectangle that it overlaps by the up
 * to four rectangles beside it; those inside another one are dropped. */
#include "common/texture/atlas.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/sort.h"

void atlas_release(struct atlas *a)
{
    if (!a) return;
    for (int i = 0; i < a->view_count; i++) free(a->views[i]);
    for (int i = 0; i < a->source_count; i++) free(a->sources[i]);
    free(a->viewpoint);
    free(a->views);
    free(a->sources);
    free(a->tiles);
    free(a->page_sizes);
    *a = (struct atlas){0};
}

enum status atlas_page_init(struct atlas_page *p, int width, int height, struct err *err)
{
    const size_t texels = (size_t)width * (size_t)height;
    *p = (struct atlas_page){width, height, calloc(texels, 3 * sizeof *p->rgb), calloc(texels, sizeof *p->source)};
    if (p->rgb && p->source) return ST_OK;
    atlas_page_release(p);
    return err_nomem(err, "a page", texels * (3 * sizeof *p->rgb + sizeof *p->source));
}

void atlas_page_release(struct atlas_page *p)
{
    if (!p) return;
    free(p->rgb);
    free(p->source);
    *p = (struct atlas_page){0};
}

/* ---------------------------------------------------------------------------------------------------------- packing */

struct block { /* free columns x0 <= x < x1 and rows y0 <= y < y1 of a page */
    int x0, y0, x1, y1;
};

struct blocks { /* the maximal ones of a page */
    struct block *list;
    int count;
    size_t room;
};

static bool holds(const struct block *a, const struct block *b)
{
    return a->x0 <= b->x0 && a->y0 <= b->y0 && a->x1 >= b->x1 && a->y1 >= b->y1;
}

static enum status add_block(struct blocks *s, struct block b, struct err *err)
{
    if (b.x0 >= b.x1 || b.y0 >= b.y1) return ST_OK;
    if (array_reserve(&s->list, &s->room, (size_t)s->count + 1, sizeof *s->list, "free blocks", err))
        return err->status;
    s->list[s->count++] = b;
    return ST_OK;
}

/* Removes blocks from `first` on that another block holds. */
static void drop_held(struct blocks *s, int first)
{
    for (int i = first; i < s->count;) {
        bool held = false;
        for (int k = 0; !held && k < s->count; k++) held = k != i && holds(&s->list[k], &s->list[i]);
        if (held)
            s->list[i] = s->list[--s->count];
        else
            i++;
    }
}

/* Takes a rectangle out of the free blocks. */
static enum status take(struct blocks *s, struct block t, struct err *err)
{
    const int before = s->count;
    int kept = 0;
    for (int i = 0; i < before; i++) {
        const struct block b = s->list[i];
        if (b.x0 < t.x1 && b.x1 > t.x0 && b.y0 < t.y1 && b.y1 > t.y0) continue;
        s->list[i] = s->list[kept];
        s->list[kept++] = b;
    }
    for (int i = kept; i < before; i++) { /* those that overlap */
        const struct block b = s->list[i];
        if (add_block(s, (struct block){b.x0, b.y0, b.x1, t.y0}, err) ||
            add_block(s, (struct block){b.x0, b.y0, t.x0, b.y1}, err) ||
            add_block(s, (struct block){t.x1, b.y0, b.x1, b.y1}, err) ||
            add_block(s, (struct block){b.x0, t.y1, b.x1, b.y1}, err))
            return err->status;
    }
    memmove(&s->list[kept], &s->list[before], (size_t)(s->count - before) * sizeof *s->list);
    s->count -= before - kept;
    drop_held(s, kept);
    return ST_OK;
}

/* Finds the tile's place; false: there is none. */
static bool find_place(const struct blocks *s, struct atlas_tile *t)
{
    const struct block *best = NULL;
    for (int i = 0; i < s->count; i++) {
        const struct block *b = &s->list[i];
        if (b->x1 - b->x0 < t->width || b->y1 - b->y0 < t->height) continue;
        if (!best || b->y0 < best->y0 || (b->y0 == best->y0 && b->x0 < best->x0)) best = b;
    }
    if (!best) return false;
    t->x = best->x0;
    t->y = best->y0;
    return true;
}

struct order {
    int height, width, tile;
};

static int compare_order(const void *a, const void *b)
{
    const struct order *p = a, *q = b;
    if (p->height != q->height) return q->height - p->height;
    if (p->width != q->width) return q->width - p->width;
    return p->tile - q->tile;
}

static enum status add_page(struct atlas *a, struct blocks **pages, struct err *err)
{
    const size_t n = (size_t)a->page_count;
    if (array_append(&a->page_sizes, n, sizeof *a->page_sizes, "pages", err) ||
        array_append(pages, n, sizeof **pages, "pages", err))
        return err->status;
    (*pages)[n] = (struct blocks){NULL, 0, 0};
    a->page_sizes[n][0] = a->page_sizes[n][1] = 0;
    a->page_count++;
    return add_block(&(*pages)[n], (struct block){0, 0, ATLAS_PAGE, ATLAS_PAGE}, err);
}

static enum status place_tile(struct atlas *a, struct blocks **pages, struct atlas_tile *t, struct err *err)
{
    int page = 0;
    while (page < a->page_count && !find_place(&(*pages)[page], t)) page++;
    if (page == a->page_count) {
        if (add_page(a, pages, err)) return err->status;
        find_place(&(*pages)[page], t);
    }
    t->page = page;
    int *size = a->page_sizes[page];
    if (t->x + t->width > size[0]) size[0] = t->x + t->width;
    if (t->y + t->height > size[1]) size[1] = t->y + t->height;
    return take(&(*pages)[page], (struct block){t->x, t->y, t->x + t->width, t->y + t->height}, err);
}

enum status atlas_pack(struct atlas *a, struct err *err)
{
    struct order *order = malloc(((size_t)a->tile_count + 1) * sizeof *order);
    struct blocks *pages = NULL;
    if (!order) err_nomem(err, "tiles", (size_t)a->tile_count * sizeof *order);
    free(a->page_sizes);
    a->page_sizes = NULL;
    a->page_count = 0;
    for (int i = 0; !err->status && i < a->tile_count; i++) {
        const struct atlas_tile *t = &a->tiles[i];
        if (t->width < 1 || t->height < 1 || t->width > ATLAS_PAGE || t->height > ATLAS_PAGE)
            err_set(err, ST_DATA, "tile %d of face %d has %d x %d texels, wanted 1 to %d on each side.", i, t->face,
                    t->width, t->height, ATLAS_PAGE);
        order[i] = (struct order){t->height, t->width, i};
    }
    if (!err->status && a->tile_count) qsort(order, (size_t)a->tile_count, sizeof *order, compare_order);
    for (int i = 0; !err->status && i < a->tile_count; i++) place_tile(a, &pages, &a->tiles[order[i].tile], err);
    free(order);
    for (int i = 0; pages && i < a->page_count; i++) free(pages[i].list);
    free(pages);
    return err->status;
}

/* --------------------------------------------------------------------------------------------------------- look-ups */

bool atlas_tile_project(const struct atlas_tile *t, struct vec3 p, double *x, double *y)
{
    double h[3];
    for (int i = 0; i < 3; i++)
        h[i] = t->matrix[i][0] * p.x + t->matrix[i][1] * p.y + t->matrix[i][2] * p.z + t->matrix[i][3];
    if (!(h[2] > 0)) return false;
    *x = h[0] / h[2];
    *y = h[1] / h[2];
    return *x >= t->x && *y >= t->y && *x <= t->x + t->width && *y <= t->y + t->height;
}

static bool tile_is_below(const void *tile, const void *face)
{
    return ((const struct atlas_tile *)tile)->face < *(const int *)face;
}

int atlas_first_tile(const struct atlas *a, int face)
{
    return (int)sort_place(a->tiles, (size_t)a->tile_count, sizeof *a->tiles, tile_is_below, &face);
}

const struct atlas_tile *atlas_find(const struct atlas *a, int face, struct vec3 p, double *x, double *y)
{
    const struct atlas_tile *found = NULL;
    double deepest = -1;
    for (int i = atlas_first_tile(a, face); i < a->tile_count && a->tiles[i].face == face; i++) {
        const struct atlas_tile *t = &a->tiles[i];
        double px, py;
        if (!atlas_tile_project(t, p, &px, &py)) continue;
        const double depth = fmin(fmin(px - t->x, t->x + t->width - px), fmin(py - t->y, t->y + t->height - py));
        if (!(depth > deepest)) continue;
        found = t, deepest = depth, *x = px, *y = py;
    }
    return found;
}

bool atlas_sample(float rgb[3], uint32_t *nearest, const struct atlas_page *p, const struct atlas_tile *t, double x,
                  double y)
{
    const int x0 = (int)floor(x - 0.5), y0 = (int)floor(y - 0.5);
    const float fx = (float)(x - 0.5 - x0), fy = (float)(y - 0.5 - y0);
    float sum[3] = {0}, total = 0, most = -1;
    for (int k = 0; k < 4; k++) {
        const int px = x0 + (k & 1), py = y0 + (k >> 1);
        if (px < t->x || py < t->y || px >= t->x + t->width || py >= t->y + t->height) continue;
        const size_t at = (size_t)py * (size_t)p->width + (size_t)px;
        if (p->source[at] == ATLAS_NONE) continue;
        const float weight = (k & 1 ? fx : 1 - fx) * (k >> 1 ? fy : 1 - fy);
        for (int c = 0; c < 3; c++) sum[c] += weight * p->rgb[3 * at + (size_t)c];
        total += weight;
        if (weight > most) {
            most = weight;
            if (nearest) *nearest = p->source[at];
        }
    }
    if (!(total > 0)) return false;
    for (int c = 0; c < 3; c++) rgb[c] = sum[c] / total;
    return true;
}
