/* filled_atlas.c - see filled_atlas.h. */
#include "common/texture/filled_atlas.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/base/sort.h"

enum { MOST = 16 };                              /* pages that stay in memory from one viewpoint to the next */
enum { MIN_COMPARED = 64, MAX_COMPARED = 8192 }; /* texels that tell how far a viewpoint is above the atlas */

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

/* What the atlas has at a place of the tile's raster, in display units; false: nothing. */
static bool sample(float display[3], const struct guide_job *j, double tile_x, double tile_y)
{
    struct vec3 p;
    double x, y;
    float rgb[3];
    uint32_t source = ATLAS_NONE;
    if (!bake_tile_point(&p, j->tile, tile_x, tile_y)) return false;
    const struct atlas_tile *from = atlas_find(&j->a->atlas, j->face, p, &x, &y);
    if (!from || !atlas_sample(rgb, &source, &j->a->pages[from->page].texels, from, x, y)) return false;
    if (source == ATLAS_DEFAULT || source == ATLAS_NONE) return false;
    for (int k = 0; k < 3; k++) display[k] = bake_display(rgb[k], j->white);
    return true;
}

static void guide_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct guide_job *j = ctx;
    const size_t width = (size_t)j->tile->raster.width;
    (void)thread;
    for (size_t i = begin * width; i < end * width; i++) {
        float *to = j->guide + 3 * i;
        if (!sample(to, j, (double)(i % width) + 0.5, (double)(i / width) + 0.5)) to[0] = to[1] = to[2] = NAN;
    }
}

static enum status load_face(struct filled_atlas *a, int face, struct err *err)
{
    const int first = atlas_first_tile(&a->atlas, face);
    for (int i = first; i < a->atlas.tile_count && a->atlas.tiles[i].face == face; i++)
        if (load(a, a->atlas.tiles[i].page, err)) break;
    return err->status;
}

float *filled_atlas_tile(struct filled_atlas *a, const struct bake *b, const struct bake_tile *t, struct err *err)
{
    const int face = b->surfaces->list[t->surface].id;
    const size_t texels = (size_t)t->raster.width * (size_t)t->raster.height;
    if (load_face(a, face, err)) return NULL;
    struct guide_job job = {a, t, face, b->white, malloc((3 * texels + 1) * sizeof *job.guide)};
    if (job.guide)
        parallel_for((size_t)t->raster.height, 8, guide_rows, &job);
    else
        err_nomem(err, "the texture of a tile", 3 * texels * sizeof *job.guide);
    return job.guide;
}

/* Appends what every `step`-th original texel of a tile has above the atlas to the lists of the colours. */
static enum status compare_tile(double *above[3], size_t *count, size_t *met, struct filled_atlas *a,
                                const struct bake *b, const struct bake_tile *t, size_t step, struct err *err)
{
    const struct guide_job job = {a, t, b->surfaces->list[t->surface].id, b->white, NULL};
    const size_t width = (size_t)t->raster.width, texels = width * (size_t)t->raster.height;
    if (load_face(a, job.face, err)) return err->status;
    for (size_t i = 0; i < texels; i++) {
        const size_t texel = t->first + i;
        float there[3];
        if (b->role[texel] != TEXEL_ORIGINAL || (*met)++ % step) continue;
        if (!sample(there, &job, (double)(i % width) + 0.5, (double)(i / width) + 0.5)) continue;
        for (size_t k = 0; k < 3; k++)
            above[k][*count] = (double)(bake_display(b->rgb[3 * texel + k], b->white) - there[k]);
        ++*count;
    }
    return ST_OK;
}

enum status filled_atlas_level(float level[3], bool *known, struct filled_atlas *a, const struct bake *b,
                               struct err *err)
{
    size_t original = 0, count = 0, met = 0;
    for (size_t i = 0; i < b->texel_count; i++) original += b->role[i] == TEXEL_ORIGINAL;
    const size_t step = original / MAX_COMPARED + 1, most = original / step + 1;
    double *values = malloc(3 * most * sizeof *values), *above[3] = {values, values + most, values + 2 * most};
    if (!values) return err_nomem(err, "the level of a viewpoint", 3 * most * sizeof *values);
    for (int i = 0; !err->status && i < b->tile_count; i++)
        compare_tile(above, &count, &met, a, b, &b->tiles[i], step, err);
    *known = !err->status && count >= MIN_COMPARED;
    for (int k = 0; k < 3; k++) level[k] = *known ? (float)sort_median(above[k], count) : 0;
    free(values);
    return err->status;
}
