/* bake_atlas.c - see bake_atlas.h. */
#include "common/texture/bake_atlas.h"

#include <stdlib.h>
#include <string.h>

/* The tile's matrix, moved to its place on the page. */
static void move_matrix(double out[3][4], const struct bake_tile *t, const struct atlas_tile *place)
{
    for (int i = 0; i < 4; i++) {
        out[0][i] = t->matrix[0][i] + place->x * t->matrix[2][i];
        out[1][i] = t->matrix[1][i] + place->y * t->matrix[2][i];
        out[2][i] = t->matrix[2][i];
    }
}

static void copy_tile(struct atlas_page *page, const struct bake *b, const struct bake_tile *t,
                      const struct atlas_tile *place)
{
    for (int y = 0; y < place->height; y++)
        for (int x = 0; x < place->width; x++) {
            const size_t from = t->first + (size_t)y * (size_t)place->width + (size_t)x;
            const size_t to = (size_t)(place->y + y) * (size_t)page->width + (size_t)(place->x + x);
            if (b->role[from] == TEXEL_NONE) continue;
            page->source[to] = b->made[from];
            memcpy(page->rgb + 3 * to, b->rgb + 3 * from, 3 * sizeof *page->rgb);
        }
}

static enum status copy_names(char ***names, int *copied, char *const *from, int count, struct err *err)
{
    *names = calloc((size_t)count + 1, sizeof **names);
    if (!*names) return err_nomem(err, "names", (size_t)count * sizeof **names);
    for (*copied = 0; *copied < count; (*copied)++)
        if (!((*names)[*copied] = strdup(from[*copied]))) return err_nomem(err, "a name", strlen(from[*copied]));
    return ST_OK;
}

static enum status describe(struct atlas *a, const struct bake *b, const char *viewpoint, char *const *views,
                            int view_count, struct err *err)
{
    char **sources = calloc((size_t)b->source_count + 1, sizeof *sources);
    a->tiles = calloc((size_t)b->tile_count + 1, sizeof *a->tiles);
    if (!sources || !a->tiles) {
        free(sources);
        return err_nomem(err, "tiles", (size_t)b->tile_count * sizeof *a->tiles);
    }
    for (int i = 0; i < b->source_count; i++) sources[i] = b->sources[i].name;
    enum status st = copy_names(&a->sources, &a->source_count, sources, b->source_count, err);
    if (!st && viewpoint) st = copy_names(&a->views, &a->view_count, views, view_count, err);
    if (!st && viewpoint && !(a->viewpoint = strdup(viewpoint))) st = err_nomem(err, "a name", strlen(viewpoint));
    a->centre = b->centre;
    a->tile_count = b->tile_count;
    for (int i = 0; i < b->tile_count; i++) {
        const struct bake_tile *t = &b->tiles[i];
        a->tiles[i] = (struct atlas_tile){.face = b->surfaces->list[t->surface].id,
                                          .view = t->view,
                                          .width = t->raster.width,
                                          .height = t->raster.height};
    }
    free(sources);
    return st;
}

enum status bake_write_atlas(const struct bake *b, const char *viewpoint, char *const *views, int view_count,
                             const char *folder, const struct provenance *prov, size_t *texels, struct err *err)
{
    struct atlas a = {0};
    struct atlas_page *pages = NULL;
    enum status st = describe(&a, b, viewpoint, views, view_count, err);
    *texels = 0;
    if (!st) st = atlas_pack(&a, err);
    if (!st && !(pages = calloc((size_t)a.page_count + 1, sizeof *pages)))
        st = err_nomem(err, "pages", (size_t)a.page_count * sizeof *pages);
    for (int i = 0; !st && i < a.page_count; i++) {
        st = atlas_page_init(&pages[i], a.page_sizes[i][0], a.page_sizes[i][1], err);
        *texels += (size_t)a.page_sizes[i][0] * (size_t)a.page_sizes[i][1];
    }
    for (int i = 0; !st && i < a.tile_count; i++) {
        move_matrix(a.tiles[i].matrix, &b->tiles[i], &a.tiles[i]);
        copy_tile(&pages[a.tiles[i].page], b, &b->tiles[i], &a.tiles[i]);
    }
    if (!st) st = atlas_write(&a, pages, folder, prov, err);
    for (int i = 0; pages && i < a.page_count; i++) atlas_page_release(&pages[i]);
    free(pages);
    atlas_release(&a);
    return st;
}
