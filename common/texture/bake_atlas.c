/* bake_atlas.c - see bake_atlas.h. */
#include "common/texture/bake_atlas.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"

/* The tile's matrix, moved to its place on the page. */
static void move_matrix(struct atlas_tile *place, const struct bake_tile *t)
{
    for (int i = 0; i < 4; i++) {
        place->matrix[0][i] = t->matrix[0][i] + place->x * t->matrix[2][i];
        place->matrix[1][i] = t->matrix[1][i] + place->y * t->matrix[2][i];
        place->matrix[2][i] = t->matrix[2][i];
    }
}

static void copy_tile(struct atlas_page *page, const struct bake *b, const struct bake_tile *t,
                      const struct atlas_tile *place, const int *source_of)
{
    for (int y = 0; y < place->height; y++)
        for (int x = 0; x < place->width; x++) {
            const size_t from = t->first + (size_t)y * (size_t)place->width + (size_t)x;
            const size_t to = (size_t)(place->y + y) * (size_t)page->width + (size_t)(place->x + x);
            if (b->role[from] == TEXEL_NONE) continue;
            const uint32_t made = b->made[from];
            page->source[to] = made < ATLAS_VIEWS || !source_of
                                   ? made
                                   : (uint32_t)ATLAS_VIEWS + (uint32_t)source_of[made - ATLAS_VIEWS];
            memcpy(page->rgb + 3 * to, b->rgb + 3 * from, 3 * sizeof *page->rgb);
        }
}

/* The bake's tiles, packed. */
static enum status pack(struct atlas *part, const struct bake *b, struct err *err)
{
    part->tiles = calloc((size_t)b->tile_count + 1, sizeof *part->tiles);
    if (!part->tiles) return err_nomem(err, "tiles", (size_t)b->tile_count * sizeof *part->tiles);
    part->tile_count = b->tile_count;
    for (int i = 0; i < b->tile_count; i++) {
        const struct bake_tile *t = &b->tiles[i];
        part->tiles[i] = (struct atlas_tile){.face = b->surfaces->list[t->surface].id,
                                             .view = t->view,
                                             .width = t->raster.width,
                                             .height = t->raster.height};
    }
    return atlas_pack(part, err);
}

static enum status write_page(const struct atlas *part, int page, int number, const struct bake *b,
                              const int *source_of, const char *folder, const struct provenance *prov, struct err *err)
{
    struct atlas_page pixels = {0};
    atlas_page_init(&pixels, part->page_sizes[page][0], part->page_sizes[page][1], err);
    for (int i = 0; !err->status && i < part->tile_count; i++)
        if (part->tiles[i].page == page) copy_tile(&pixels, b, &b->tiles[i], &part->tiles[i], source_of);
    if (!err->status) atlas_write_page(&pixels, folder, number, prov, err);
    atlas_page_release(&pixels);
    return err->status;
}

/* Adds the part's tiles and pages to the atlas. */
static enum status append(struct atlas *a, const struct atlas *part, const struct bake *b, struct err *err)
{
    const int before = a->page_count;
    for (int i = 0; i < part->page_count; i++) {
        if (array_append(&a->page_sizes, (size_t)a->page_count, sizeof *a->page_sizes, "pages", err))
            return err->status;
        memcpy(a->page_sizes[a->page_count++], part->page_sizes[i], sizeof *a->page_sizes);
    }
    for (int i = 0; i < part->tile_count; i++) {
        if (array_append(&a->tiles, (size_t)a->tile_count, sizeof *a->tiles, "tiles", err)) return err->status;
        struct atlas_tile *t = &a->tiles[a->tile_count++];
        *t = part->tiles[i];
        t->page += before;
        move_matrix(t, &b->tiles[i]);
    }
    return ST_OK;
}

enum status bake_write_pages(struct atlas *a, const struct bake *b, const int *source_of, const char *folder,
                             const struct provenance *prov, size_t *texels, struct err *err)
{
    struct atlas part = {0};
    pack(&part, b, err);
    for (int i = 0; !err->status && i < part.page_count; i++) {
        write_page(&part, i, a->page_count + i, b, source_of, folder, prov, err);
        *texels += (size_t)part.page_sizes[i][0] * (size_t)part.page_sizes[i][1];
    }
    if (!err->status) append(a, &part, b, err);
    atlas_release(&part);
    return err->status;
}
