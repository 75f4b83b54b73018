/* page_cache.h - texture atlases in memory, page by page, as the shell's renderer reads them.
 *
 * A texel is four halves, R G B A, A being 1 where there is a texel and all four 0 elsewhere, with a byte beside it
 * that says what it comes from. Each tile stands for itself, inside a frame of one empty texel, so that a bilinear
 * look-up at any place of the tile reads no texel of another one. */
#ifndef REMODEL_RENDER_PAGE_CACHE_H
#define REMODEL_RENDER_PAGE_CACHE_H

#include "common/texture/atlas.h"

struct texture_page {
    uint16_t *texels;         /* 4 halves each; NULL: the page is not in memory */
    uint8_t *made;            /* enum picture_made of each texel */
    size_t size;              /* texels, frames included */
    uint64_t used;            /* the picture that used it last */
    bool recorded;            /* among the inputs of this picture */
    struct provenance inputs; /* its file, once it was read */
};

/* The atlas of a viewpoint, or the VITA. */
struct texture_set {
    char *photo; /* NULL: the VITA */
    char *folder;
    struct atlas atlas;
    size_t *first;              /* of each tile: its frame's upper left texel in the arrays of its page */
    struct texture_page *pages; /* of the atlas */
    struct provenance inputs;   /* atlas.txt */
    uint64_t used;
};

static inline int texture_stride(const struct atlas_tile *t) { return t->width + 2; } /* texels, frame included */

struct page_cache;

/* Atlases of viewpoints are VDTA/PHOTO; vita: folder of the VITA, NULL: there is none. memory: MiB; beyond them,
 * atlases and pages that the present picture does not use are dropped, those first that were not used longest. Strings
 * are copied. */
enum status page_cache_open(struct page_cache **cache, const char *vdta, const char *vita, int memory, struct err *err);
void page_cache_close(struct page_cache *cache); /* NULL is allowed */

/* A new picture begins: what follows stays in memory until the next call. The files used are added to prov (may be
 * NULL), whether they are read now or were before. */
void page_cache_next(struct page_cache *cache, struct provenance *prov);

/* The atlas of a viewpoint; photo NULL: the VITA, *set NULL if there is none. Valid until the next picture. ST_DATA:
 * the viewpoint has no atlas. */
enum status page_cache_find(struct page_cache *cache, const char *photo, struct texture_set **set, struct err *err);
/* Has a page of it in memory for this picture. */
enum status page_cache_load(struct page_cache *cache, struct texture_set *set, int page, struct err *err);

struct page_cache_stats {
    size_t bytes, most; /* in memory now, and at most until now */
    int pages_read, atlases_read;
};
struct page_cache_stats page_cache_stats(const struct page_cache *cache);

#endif
