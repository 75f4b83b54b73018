/* page_cache.c - pages of atlases in memory, as many as the limit allows.
 *
 * The atlases of a scene are larger than memory, and a film goes from one to the next. A page is read when a picture
 * first needs it, and its tiles are copied apart: each with a border of one empty texel, in rows of its own stride,
 * so that a bilinear look-up needs no test at the tile's edge. Colours on disk are halves and stay halves, so
 * nothing is rounded; with one byte for their origin that is 9 bytes a texel.
 *
 * What goes when memory is short: the page or the list of an atlas that was not used for the longest time, counted
 * in pictures; of equals, what is found first. A list is used whenever one of its pages is, so pages go before their
 * list. What the present picture uses never goes, so a picture that needs more than the limit gets it.
 *
 * A file goes into the provenance of every picture that uses it, whether it is read for it or was in memory: the
 * record must not depend on what was drawn before. */
#include "stages/render_model/page_cache.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/math/lanes.h"
#include "common/product/product.h"
#include "common/texture/model_picture.h"

struct page_cache {
    char *vdta, *vita;
    size_t room; /* bytes */
    struct provenance *prov;
    struct texture_set **sets; /* in the order in which they were read; owned */
    int count;
    uint64_t picture;
    struct page_cache_stats stats;
};

enum { TEXEL = 4 * sizeof(uint16_t) + 1 }; /* bytes */

/* --------------------------------------------------------------------------------------------------------- memory */

static void drop_page(struct page_cache *c, struct texture_page *p)
{
    if (p->texels) c->stats.bytes -= p->size * TEXEL;
    free(p->texels);
    free(p->made);
    p->texels = NULL;
    p->made = NULL;
}

static size_t set_bytes(const struct texture_set *s)
{
    const struct atlas *a = &s->atlas;
    size_t bytes = sizeof *s + (size_t)a->tile_count * (sizeof *a->tiles + sizeof *s->first) +
                   (size_t)a->page_count * (sizeof *s->pages + sizeof *a->page_sizes);
    for (int i = 0; i < a->source_count; i++) bytes += strlen(a->sources[i]) + 1 + sizeof *a->sources;
    return bytes;
}

/* Releases a set without pages in memory, which need not be complete. */
static void set_free(struct texture_set *s)
{
    for (int i = 0; s->pages && i < s->atlas.page_count; i++) provenance_release(&s->pages[i].inputs);
    provenance_release(&s->inputs);
    free(s->photo);
    free(s->folder);
    free(s->first);
    free(s->pages);
    atlas_release(&s->atlas);
    free(s);
}

static void drop_set(struct page_cache *c, int at)
{
    struct texture_set *s = c->sets[at];
    for (int i = 0; i < s->atlas.page_count; i++) drop_page(c, &s->pages[i]);
    c->stats.bytes -= set_bytes(s);
    memmove(&c->sets[at], &c->sets[at + 1], (size_t)(c->count - at - 1) * sizeof *c->sets);
    c->count--;
    set_free(s);
}

/* Drops the set or the page that was not used longest; false: this picture uses all of them. A set is used whenever one
 * of its pages is, so pages go before their set. */
static bool drop_oldest(struct page_cache *c)
{
    uint64_t oldest = c->picture;
    int set = -1;
    struct texture_page *page = NULL;
    for (int i = 0; i < c->count; i++) {
        struct texture_set *s = c->sets[i];
        for (int k = 0; k < s->atlas.page_count; k++) {
            if (!s->pages[k].texels || s->pages[k].used >= oldest) continue;
            oldest = s->pages[k].used;
            page = &s->pages[k];
        }
        if (s->used >= oldest) continue;
        oldest = s->used;
        page = NULL;
        set = i;
    }
    if (page)
        drop_page(c, page);
    else if (set >= 0)
        drop_set(c, set);
    return page || set >= 0;
}

/* Counts bytes that will be in memory, and makes room for them. */
static void take_bytes(struct page_cache *c, size_t bytes)
{
    while (c->stats.bytes + bytes > c->room && drop_oldest(c)) {
    }
    c->stats.bytes += bytes;
    if (c->stats.bytes > c->stats.most) c->stats.most = c->stats.bytes;
}

enum status page_cache_open(struct page_cache **cache, const char *vdta, const char *vita, int memory, struct err *err)
{
    struct page_cache *c = calloc(1, sizeof *c);
    *cache = c;
    if (!c) return err_nomem(err, "textures", sizeof *c);
    c->room = (size_t)memory << 20;
    if (vdta) c->vdta = strdup(vdta);
    if (vita) c->vita = strdup(vita);
    if (!c->vdta == !vdta && !c->vita == !vita) return ST_OK;
    page_cache_close(c);
    *cache = NULL;
    return err_nomem(err, "names of folders", FILE_PATH);
}

void page_cache_close(struct page_cache *c)
{
    if (!c) return;
    while (c->count) drop_set(c, c->count - 1);
    free(c->sets);
    free(c->vdta);
    free(c->vita);
    free(c);
}

struct page_cache_stats page_cache_stats(const struct page_cache *c) { return c->stats; }

void page_cache_next(struct page_cache *c, struct provenance *prov)
{
    c->picture++;
    c->prov = prov;
    for (int i = 0; i < c->count; i++)
        for (int k = 0; k < c->sets[i]->atlas.page_count; k++) c->sets[i]->pages[k].recorded = false;
}

/* ---------------------------------------------------------------------------------------------------------- atlases */

/* Sets the folder; ST_DATA if it has no atlas. */
static enum status find_folder(struct texture_set *s, const struct page_cache *c, struct err *err)
{
    char folder[FILE_PATH] = "", list[FILE_PATH];
    if (s->photo && !c->vdta)
        return err_set(err, ST_DATA, "viewpoint %s was asked for, but no folder of atlases was given.", s->photo);
    if (s->photo && file_path(folder, c->vdta, s->photo, "", err)) return err->status;
    if (!s->photo) snprintf(folder, sizeof folder, "%s", c->vita);
    if (product_path_in(list, folder, PRODUCT_ATLAS, NULL, err)) return err->status;
    if (!path_is_file(list) && s->photo)
        return err_set(err, ST_DATA, "viewpoint %s has no atlas: there is no %s. Make it with 'make vdta'.", s->photo,
                       list);
    if (!path_is_file(list))
        return err_set(err, ST_DATA, "there is no view-independent atlas %s. Make it with 'make vita'.", list);
    s->folder = strdup(folder);
    return s->folder ? ST_OK : err_nomem(err, "a folder's name", strlen(folder) + 1);
}

/* Gives each tile its place in the arrays of its page. */
static enum status place_tiles(struct texture_set *s, struct err *err)
{
    const struct atlas *a = &s->atlas;
    s->first = calloc((size_t)a->tile_count + 1, sizeof *s->first);
    s->pages = calloc((size_t)a->page_count + 1, sizeof *s->pages);
    if (!s->first || !s->pages) return err_nomem(err, "tiles", (size_t)a->tile_count * sizeof *s->first);
    for (int i = 0; i < a->tile_count; i++) {
        const struct atlas_tile *t = &a->tiles[i];
        s->first[i] = s->pages[t->page].size;
        s->pages[t->page].size += (size_t)texture_stride(t) * (size_t)(t->height + 2);
    }
    return ST_OK;
}

static enum status read_set(struct page_cache *c, const char *photo, struct texture_set **set, struct err *err)
{
    struct texture_set *s = *set = calloc(1, sizeof *s);
    if (!s) return err_nomem(err, "an atlas", sizeof *s);
    if (photo && !(s->photo = strdup(photo))) return err_nomem(err, "a photo's id", strlen(photo) + 1);
    if (find_folder(s, c, err) || atlas_read(&s->atlas, s->folder, &s->inputs, err)) return err->status;
    if (photo ? !s->atlas.viewpoint || strcmp(s->atlas.viewpoint, photo) : s->atlas.viewpoint != NULL)
        return err_set(err, ST_DATA, "%s/atlas.txt is the atlas of %s, wanted that of %s.", s->folder,
                       s->atlas.viewpoint ? s->atlas.viewpoint : "no viewpoint", photo ? photo : "no viewpoint");
    if (place_tiles(s, err) || array_append(&c->sets, (size_t)c->count, sizeof *c->sets, "atlases", err))
        return err->status;
    s->used = c->picture;
    take_bytes(c, set_bytes(s));
    c->stats.atlases_read++;
    c->sets[c->count++] = s;
    return ST_OK;
}

static bool is_of(const struct texture_set *s, const char *photo)
{
    return photo ? s->photo && !strcmp(s->photo, photo) : !s->photo;
}

enum status page_cache_find(struct page_cache *c, const char *photo, struct texture_set **set, struct err *err)
{
    *set = NULL;
    if (!photo && !c->vita) return ST_OK;
    for (int i = 0; i < c->count; i++)
        if (is_of(c->sets[i], photo)) *set = c->sets[i];
    if (!*set && read_set(c, photo, set, err)) {
        if (*set) set_free(*set);
        *set = NULL;
        return err->status;
    }
    (*set)->used = c->picture;
    return c->prov ? provenance_add_all(c->prov, &(*set)->inputs, err) : ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------ pages */

static enum picture_made made_of(uint32_t source, const bool *original)
{
    switch (source) {
    case ATLAS_NONE:
        return MADE_NOTHING;
    case ATLAS_SYNTHESISED:
        return MADE_SYNTHESISED;
    case ATLAS_DEFAULT:
        return MADE_COLOUR;
    default:
        return original[source - ATLAS_VIEWS] ? MADE_ORIGINAL : MADE_WARPED;
    }
}

static void copy_texel(uint16_t *to, const float *rgb) { f32x4_to_half(to, (f32x4){rgb[0], rgb[1], rgb[2], 1}); }

static void copy_tile(struct texture_page *to, size_t first, const struct atlas_tile *t, const struct atlas_page *from,
                      const bool *original)
{
    const size_t stride = (size_t)texture_stride(t);
    for (int y = 0; y < t->height; y++) {
        const size_t row = (size_t)(t->y + y) * (size_t)from->width + (size_t)t->x;
        const size_t out = first + (size_t)(y + 1) * stride + 1;
        for (size_t x = 0; x < (size_t)t->width; x++) {
            const uint32_t source = from->source[row + x];
            if (source == ATLAS_NONE) continue;
            copy_texel(to->texels + 4 * (out + x), from->rgb + 3 * (row + x));
            to->made[out + x] = (uint8_t)made_of(source, original);
        }
    }
}

/* original[k]: whether the k-th source of the atlas is one of the viewpoint's own views. Both lists are in order. */
static bool *find_original(const struct atlas *a)
{
    bool *original = calloc((size_t)a->source_count + 1, sizeof *original);
    for (int i = 0, k = 0; original && i < a->view_count; i++) {
        while (k < a->source_count && strcmp(a->sources[k], a->views[i]) < 0) k++;
        if (k < a->source_count && !strcmp(a->sources[k], a->views[i])) original[k] = true;
    }
    return original;
}

static enum status read_page(struct page_cache *c, struct texture_set *s, int page, struct err *err)
{
    struct texture_page *p = &s->pages[page];
    const struct atlas *a = &s->atlas;
    struct atlas_page from = {0};
    if (atlas_page_read(&from, a, page, s->folder, &p->inputs, err)) return err->status;
    take_bytes(c, p->size * TEXEL);
    bool *original = find_original(a);
    p->texels = calloc(p->size + 1, 4 * sizeof *p->texels);
    p->made = calloc(p->size + 1, 1);
    if (original && p->texels && p->made) {
        for (int i = 0; i < a->tile_count; i++)
            if (a->tiles[i].page == page) copy_tile(p, s->first[i], &a->tiles[i], &from, original);
        c->stats.pages_read++;
    } else {
        err_nomem(err, "a page of texels", p->size * TEXEL);
        if (!p->texels) c->stats.bytes -= p->size * TEXEL;
        drop_page(c, p);
    }
    free(original);
    atlas_page_release(&from);
    return err->status;
}

enum status page_cache_load(struct page_cache *c, struct texture_set *s, int page, struct err *err)
{
    struct texture_page *p = &s->pages[page];
    p->used = s->used = c->picture;
    if (!p->texels && read_page(c, s, page, err)) return err->status;
    if (p->recorded) return ST_OK;
    p->recorded = true;
    return c->prov ? provenance_add_all(c->prov, &p->inputs, err) : ST_OK;
}
