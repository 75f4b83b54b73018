/* components.c - connected surfaces of a volume; see components.h.
 *
 * All walks go through the voxels in the order of their index, so ids do not depend on threads. */
#include "stages/find_things/components.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NONE 0u
#define FREE UINT32_MAX /* a surface that no walk has reached yet */

/* A list of voxels to go on from; it holds each voxel of the grid at most once. */
struct walk {
    int64_t *at; /* owned */
    size_t begin, end;
};

static enum status walk_init(struct walk *w, const struct voxel_grid *g, struct err *err)
{
    *w = (struct walk){.at = malloc(voxel_count(g) * sizeof *w->at)};
    return w->at ? ST_OK : err_nomem(err, "a walk through voxels", voxel_count(g) * sizeof *w->at);
}

/* Gives the neighbours of a voxel that are `from` the id `to`, and adds them to the walk. diagonal: of all 26, else of
 * the 6 that share a side. */
static void step(struct walk *w, uint32_t *id, const struct voxel_grid *g, int64_t at, uint32_t from, uint32_t to,
                 bool diagonal)
{
    const int x = (int)(at % g->size[0]), y = (int)(at / g->size[0] % g->size[1]),
              z = (int)(at / g->size[0] / g->size[1]);
    for (int dz = -1; dz <= 1; dz++)
        for (int dy = -1; dy <= 1; dy++)
            for (int dx = -1; dx <= 1; dx++) {
                const int a = x + dx, b = y + dy, c = z + dz;
                if (a < 0 || b < 0 || c < 0 || a >= g->size[0] || b >= g->size[1] || c >= g->size[2]) continue;
                if (!diagonal && abs(dx) + abs(dy) + abs(dz) != 1) continue;
                const int64_t next = ((int64_t)c * g->size[1] + b) * g->size[0] + a;
                if (id[next] != from) continue;
                id[next] = to;
                w->at[w->end++] = next;
            }
}

/* ------------------------------------------------------------------------------------------------ the largest first */

struct component {
    int64_t voxels;
    int low[3], high[3];
    uint32_t id;
};

static void measure(struct component *list, int count, const uint32_t *id, const struct voxel_grid *g)
{
    for (int k = 0; k < count; k++) {
        list[k] = (struct component){.id = (uint32_t)k + 1};
        memcpy(list[k].low, g->size, sizeof list[k].low);
    }
    for (int64_t i = 0; i < (int64_t)voxel_count(g); i++) {
        if (!id[i]) continue;
        struct component *c = &list[id[i] - 1];
        const int p[3] = {(int)(i % g->size[0]), (int)(i / g->size[0] % g->size[1]),
                          (int)(i / g->size[0] / g->size[1])};
        c->voxels++;
        for (int k = 0; k < 3; k++) {
            if (p[k] < c->low[k]) c->low[k] = p[k];
            if (p[k] > c->high[k]) c->high[k] = p[k];
        }
    }
}

static double length_of(const struct component *c)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += (double)(c->high[k] - c->low[k] + 1) * (c->high[k] - c->low[k] + 1);
    return c->voxels ? sqrt(sum) : 0;
}

static int larger_first(const void *a, const void *b)
{
    const struct component *p = a, *q = b;
    if (p->voxels != q->voxels) return p->voxels > q->voxels ? -1 : 1;
    return p->id < q->id ? -1 : p->id > q->id;
}

/* Counts ids anew, largest first, and leaves out those shorter than min_length voxels, or with fewer than min_voxels.
 * named (may be NULL): ids that are renamed alike. */
static enum status count_anew(uint32_t *id, int *count, const struct voxel_grid *g, double min_length, int min_voxels,
                              uint32_t *named, int names, struct err *err)
{
    struct component *list = malloc(((size_t)*count + 1) * sizeof *list);
    uint32_t *now = calloc((size_t)*count + 1, sizeof *now);
    int kept = 0;
    if (!list || !now) err_nomem(err, "surfaces", (size_t)*count * sizeof *list);
    if (!err->status) {
        measure(list, *count, id, g);
        qsort(list, (size_t)*count, sizeof *list, larger_first);
        for (int k = 0; k < *count; k++)
            if (list[k].voxels >= min_voxels && length_of(&list[k]) >= min_length) now[list[k].id] = (uint32_t)++kept;
        for (size_t i = 0; i < voxel_count(g); i++) id[i] = now[id[i]];
        for (int k = 0; k < names; k++) named[k] = now[named[k]];
        *count = kept;
    }
    free(list);
    free(now);
    return err->status;
}

enum status components_find(uint32_t *id, int *count, const struct fused_volume *f, const struct things_params *params,
                            double height, int views, struct err *err)
{
    const struct voxel_grid *g = &f->grid;
    const int needed = params->min_views < views ? params->min_views : views;
    struct walk w;
    *count = 0;
    if (walk_init(&w, g, err)) return err->status;
    for (size_t i = 0; i < voxel_count(g); i++)
        id[i] = f->views[i] >= needed && f->sum[i] < 0 && (double)f->weight[i] >= params->min_weight ? FREE : NONE;
    for (int64_t i = 0; i < (int64_t)voxel_count(g); i++) {
        if (id[i] != FREE) continue;
        const uint32_t own = (uint32_t)++ * count;
        id[i] = own;
        w.at[w.end++] = i;
        while (w.begin < w.end) step(&w, id, g, w.at[w.begin++], FREE, own, true);
    }
    free(w.at);
    return count_anew(id, count, g, params->min_size * height / g->voxel, params->min_voxels, NULL, 0, err);
}

/* ------------------------------------------------------------------------------------------------------------ marks */

/* Grows the seeds of names through the surfaces that they are on, all at the same pace. of_name[k]: the id of name k.
 * */
static void split(struct walk *w, uint32_t *id, const struct voxel_grid *g, const struct thing_seed *seeds, int count,
                  const uint32_t *of_name, const bool *marked)
{
    for (size_t i = 0; i < voxel_count(g); i++)
        if (id[i] && marked[id[i]]) id[i] = FREE;
    for (int k = 0; k < count; k++)
        if (seeds[k].at >= 0 && id[seeds[k].at] == FREE) {
            id[seeds[k].at] = of_name[seeds[k].name];
            w->at[w->end++] = seeds[k].at;
        }
    while (w->begin < w->end) {
        const int64_t at = w->at[w->begin++];
        step(w, id, g, at, FREE, id[at], true);
    }
}

enum status components_mark(uint32_t *id, int *count, const struct voxel_grid *g, const struct thing_seed *seeds,
                            int seed_count, uint32_t *named, int names, struct err *err)
{
    const int before = *count;
    bool *marked = calloc((size_t)before + 1, sizeof *marked);
    struct walk w = {0};
    if (!marked) err_nomem(err, "surfaces", (size_t)before);
    if (!err->status) walk_init(&w, g, err);
    for (int k = 0; k < names; k++) named[k] = 0;
    for (int k = 0; !err->status && k < seed_count; k++) {
        if (seeds[k].at < 0 || !id[seeds[k].at]) continue;
        marked[id[seeds[k].at]] = true;
        if (!named[seeds[k].name]) named[seeds[k].name] = (uint32_t)++ * count;
    }
    if (!err->status) {
        split(&w, id, g, seeds, seed_count, named, marked);
        count_anew(id, count, g, 0, 1, named, names, err);
    }
    free(w.at);
    free(marked);
    return err->status;
}

enum status components_grow(uint32_t *id, const struct voxel_grid *g, int steps, struct err *err)
{
    struct walk w;
    if (walk_init(&w, g, err)) return err->status;
    for (int64_t i = 0; i < (int64_t)voxel_count(g); i++)
        if (id[i]) w.at[w.end++] = i;
    for (int k = 0; k < steps; k++)
        for (const size_t end = w.end; w.begin < end; w.begin++)
            step(&w, id, g, w.at[w.begin], NONE, id[w.at[w.begin]], false);
    free(w.at);
    return ST_OK;
}

void components_stand(uint32_t *id, const struct voxel_grid *g, const int *lowest)
{
    const size_t slice = (size_t)g->size[0] * (size_t)g->size[1];
    for (int z = g->size[2] - 2; z >= 0; z--)
        for (size_t i = 0; i < slice; i++) {
            const uint32_t above = id[((size_t)z + 1) * slice + i];
            if (above && !id[(size_t)z * slice + i] && lowest[above] >= 0 && z >= lowest[above])
                id[(size_t)z * slice + i] = above;
        }
}
