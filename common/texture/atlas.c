/* atlas.c - see atlas.h: tiles on pages, and look-ups.
 *
 * Packing is first-fit decreasing: tiles in order of falling height go to the first page, and there to the uppermost,
 * then leftmost place in which they fit. A page keeps its skyline, the lower outline of what was placed; a tile's top
 * rests on the skyline's lowest point below its width, so a row of steps is searched and not the page's area. */
#include "common/texture/atlas.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"

void atlas_release(struct atlas *a)
{
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
    free(p->rgb);
    free(p->source);
    *p = (struct atlas_page){0};
}

/* ---------------------------------------------------------------------------------------------------------- packing */

struct step { /* of a skyline: columns from x to the next step's x are free from y down */
    int x, y;
};

struct skyline {
    struct step steps[ATLAS_PAGE + 1]; /* the last one ends the page */
    int count;                         /* without the last */
};

static void skyline_init(struct skyline *s)
{
    s->steps[0] = (struct step){0, 0};
    s->steps[1] = (struct step){ATLAS_PAGE, 0};
    s->count = 1;
}

/* The first row at which a tile of this width fits below step i; ATLAS_PAGE: it does not. */
static int top_at(const struct skyline *s, int i, int width)
{
    const int end = s->steps[i].x + width;
    int top = 0;
    if (end > ATLAS_PAGE) return ATLAS_PAGE;
    for (; i < s->count && s->steps[i].x < end; i++)
        if (s->steps[i].y > top) top = s->steps[i].y;
    return top;
}

/* Puts a tile at step i: columns of its width are free from `bottom` on. */
static void raise(struct skyline *s, int i, int width, int bottom)
{
    const int begin = s->steps[i].x, end = begin + width;
    int last = i; /* the step in which the tile ends */
    while (s->steps[last + 1].x < end) last++;
    const struct step rest = {end, s->steps[last].y};
    const bool remains = s->steps[last + 1].x > end;
    const int keep = last + 1, added = 1 + remains;
    memmove(&s->steps[i + added], &s->steps[keep], (size_t)(s->count + 1 - keep) * sizeof *s->steps);
    s->steps[i] = (struct step){begin, bottom};
    if (remains) s->steps[i + 1] = rest;
    s->count += added - (keep - i);
}

static bool place(struct skyline *s, struct atlas_tile *t)
{
    int best = -1, least = ATLAS_PAGE;
    for (int i = 0; i < s->count; i++) {
        const int top = top_at(s, i, t->width);
        if (top + t->height <= ATLAS_PAGE && top < least) best = i, least = top;
    }
    if (best < 0) return false;
    t->x = s->steps[best].x;
    t->y = least;
    raise(s, best, t->width, least + t->height);
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

static enum status add_page(struct atlas *a, struct skyline **lines, struct err *err)
{
    if (array_append(&a->page_sizes, (size_t)a->page_count, sizeof *a->page_sizes, "pages", err)) return err->status;
    if (array_append(lines, (size_t)a->page_count, sizeof **lines, "pages", err)) return err->status;
    skyline_init(&(*lines)[a->page_count]);
    a->page_sizes[a->page_count][0] = a->page_sizes[a->page_count][1] = 0;
    a->page_count++;
    return ST_OK;
}

static enum status place_tile(struct atlas *a, struct skyline **lines, struct atlas_tile *t, struct err *err)
{
    int page = 0;
    while (page < a->page_count && !place(&(*lines)[page], t)) page++;
    if (page == a->page_count) {
        if (add_page(a, lines, err)) return err->status;
        place(&(*lines)[page], t);
    }
    t->page = page;
    int *size = a->page_sizes[page];
    if (t->x + t->width > size[0]) size[0] = t->x + t->width;
    if (t->y + t->height > size[1]) size[1] = t->y + t->height;
    return ST_OK;
}

enum status atlas_pack(struct atlas *a, struct err *err)
{
    struct order *order = malloc(((size_t)a->tile_count + 1) * sizeof *order);
    struct skyline *lines = NULL;
    enum status st = order ? ST_OK : err_nomem(err, "tiles", (size_t)a->tile_count * sizeof *order);
    free(a->page_sizes);
    a->page_sizes = NULL;
    a->page_count = 0;
    for (int i = 0; !st && i < a->tile_count; i++) {
        const struct atlas_tile *t = &a->tiles[i];
        if (t->width < 1 || t->height < 1 || t->width > ATLAS_PAGE || t->height > ATLAS_PAGE)
            st = err_set(err, ST_DATA, "tile %d of face %d has %d x %d texels, wanted 1 to %d on each side.", i,
                         t->face, t->width, t->height, ATLAS_PAGE);
        order[i] = (struct order){t->height, t->width, i};
    }
    if (!st && a->tile_count) qsort(order, (size_t)a->tile_count, sizeof *order, compare_order);
    for (int i = 0; !st && i < a->tile_count; i++) st = place_tile(a, &lines, &a->tiles[order[i].tile], err);
    free(order);
    free(lines);
    return st;
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
