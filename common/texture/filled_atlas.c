/* filled_atlas.c - see filled_atlas.h. */
#include "common/texture/filled_atlas.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"

enum { MOST = 16 }; /* pages that stay in memory from one viewpoint to the next */

enum status filled_atlas_open(struct filled_atlas *a, const char *folder, struct provenance *prov, struct err *err)
{
    *a = (struct filled_atlas){.prov = prov};
    if (!(a->folder = strdup(folder))) return err_nomem(err, "a file name", strlen(folder));
    if (atlas_read(&a->atlas, folder, prov, err)) return err->status;
    a->pages = calloc((size_t)a->atlas.page_count + 1, sizeof *a->pages);
    return a->pages ? ST_OK : err_nomem(err, "pages", (size_t)a->atlas.page_count * sizeof *a->pages);
}

static void drop_pages(struct filled_atlas *a)
{
    for (int i = 0; a->pages && i < a->atlas.page_count; i++) {
        atlas_page_release(&a->pages[i].texels);
        provenance_release(&a->pages[i].inputs);
        a->pages[i] = (struct filled_page){0};
    }
    a->held = 0;
}

void filled_atlas_release(struct filled_atlas *a)
{
    drop_pages(a);
    free(a->pages);
    free(a->folder);
    atlas_release(&a->atlas);
    *a = (struct filled_atlas){0};
}

void filled_atlas_spare(struct filled_atlas *a)
{
    if (a->held > MOST) drop_pages(a);
}

static enum status load(struct filled_atlas *a, int page, struct err *err)
{
    struct filled_page *p = &a->pages[page];
    if (!p->texels.rgb && !atlas_page_read(&p->texels, &a->atlas, page, a->folder, &p->inputs, err)) a->held++;
    return err->status ? err->status : provenance_add_all(a->prov, &p->inputs, err);
}

struct guide_job {
    const struct filled_atlas *a;
    const struct bake_tile *tile;
    int face;
    double white;
    float *guide;
};

static void guide_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct guide_job *j = ctx;
    const size_t width = (size_t)j->tile->raster.width;
    (void)thread;
    for (size_t i = begin * width; i < end * width; i++) {
        float *to = j->guide + 3 * i, rgb[3];
        struct vec3 p;
        double x, y;
        uint32_t source = ATLAS_NONE;
        to[0] = to[1] = to[2] = NAN;
        if (!bake_tile_point(&p, j->tile, (double)(i % width) + 0.5, (double)(i / width) + 0.5)) continue;
        const struct atlas_tile *from = atlas_find(&j->a->atlas, j->face, p, &x, &y);
        if (!from || !atlas_sample(rgb, &source, &j->a->pages[from->page].texels, from, x, y)) continue;
        if (source == ATLAS_DEFAULT || source == ATLAS_NONE) continue;
        for (int k = 0; k < 3; k++) to[k] = bake_display(rgb[k], j->white);
    }
}

float *filled_atlas_tile(struct filled_atlas *a, const struct bake *b, const struct bake_tile *t, struct err *err)
{
    const int face = b->surfaces->list[t->surface].id;
    const size_t texels = (size_t)t->raster.width * (size_t)t->raster.height;
    for (int i = atlas_first_tile(&a->atlas, face); i < a->atlas.tile_count && a->atlas.tiles[i].face == face; i++)
        if (load(a, a->atlas.tiles[i].page, err)) return NULL;
    struct guide_job job = {a, t, face, b->white, malloc((3 * texels + 1) * sizeof *job.guide)};
    if (job.guide)
        parallel_for((size_t)t->raster.height, 8, guide_rows, &job);
    else
        err_nomem(err, "the texture of a tile", 3 * texels * sizeof *job.guide);
    return job.guide;
}
