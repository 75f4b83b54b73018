/* loaded_atlas.c - see loaded_atlas.h. */
#include "stages/evaluate/texture/loaded_atlas.h"

#include <stdlib.h>

enum status loaded_atlas_read(struct loaded_atlas *a, struct evaluation *e, const char *name, struct err *err)
{
    char folder[FILE_PATH];
    *a = (struct loaded_atlas){0};
    if (!textures_read(&a->atlas, e, name, err)) textures_folder(folder, e, name, err);
    if (!err->status && !(a->pages = calloc((size_t)a->atlas.page_count + 1, sizeof *a->pages)))
        err_nomem(err, "pages", (size_t)a->atlas.page_count * sizeof *a->pages);
    for (int i = 0; !err->status && i < a->atlas.page_count; i++)
        atlas_page_read(&a->pages[i], &a->atlas, i, folder, NULL, err);
    return err->status;
}

void loaded_atlas_release(struct loaded_atlas *a)
{
    for (int i = 0; a->pages && i < a->atlas.page_count; i++) atlas_page_release(&a->pages[i]);
    free(a->pages);
    atlas_release(&a->atlas);
    *a = (struct loaded_atlas){0};
}

bool loaded_atlas_look_up(float rgb[3], const struct loaded_atlas *a, int face, struct vec3 p)
{
    for (int i = atlas_first_tile(&a->atlas, face); i < a->atlas.tile_count && a->atlas.tiles[i].face == face; i++) {
        const struct atlas_tile *t = &a->atlas.tiles[i];
        double x, y;
        if (!atlas_tile_project(t, p, &x, &y)) continue;
        if (atlas_sample(rgb, NULL, &a->pages[t->page], t, x, y)) return true;
    }
    return false;
}
