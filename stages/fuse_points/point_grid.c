/* point_grid.c - merging of points in a sparse grid.
 *
 * The cells are entries of a hash table with open addressing and linear probing; a cell with points of two normals has
 * two entries. Positions are summed relative to the cell's corner, which keeps their precision far from the origin. */
#include "stages/fuse_points/point_grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/image/image.h"

#define MIN_COSINE 0.5 /* between a sample's normal and its point's */
#define MIN_WEIGHT 1e-6
#define MAX_CELL   4503599627370496.0

struct grid_cell {
    int64_t at[3];
    double weight;
    double position[3]; /* weighted sums; positions from the cell's corner */
    double normal[3];
    float color[3], confidence;
    int views; /* maximum over the samples */
};

enum { FIRST_SLOTS = 1 << 12 };

enum status point_grid_init(struct point_grid *g, double edge, struct err *err)
{
    *g = (struct point_grid){.edge = edge, .slot_count = FIRST_SLOTS};
    g->slots = calloc(g->slot_count, sizeof *g->slots);
    return g->slots ? ST_OK : err_nomem(err, "a grid of points", g->slot_count * sizeof *g->slots);
}

static size_t first_slot(const struct point_grid *g, const int64_t at[3])
{
    uint64_t h = 0;
    for (int k = 0; k < 3; k++) {
        h = (h ^ (uint64_t)at[k]) * UINT64_C(0x9E3779B97F4A7C15);
        h ^= h >> 29;
    }
    return (size_t)(h & (g->slot_count - 1));
}

static enum status grow(struct point_grid *g, struct err *err)
{
    if (g->count == g->capacity) {
        const size_t capacity = g->capacity ? g->capacity + g->capacity / 2 : FIRST_SLOTS / 2;
        struct grid_cell *cells = capacity < UINT32_MAX ? realloc(g->cells, capacity * sizeof *cells) : NULL;
        if (!cells) return err_nomem(err, "merged points", capacity * sizeof *cells);
        g->cells = cells;
        g->capacity = capacity;
    }
    if (2 * g->count < g->slot_count) return ST_OK;
    uint32_t *slots = calloc(2 * g->slot_count, sizeof *slots);
    if (!slots) return err_nomem(err, "a grid of points", 2 * g->slot_count * sizeof *slots);
    free(g->slots);
    g->slots = slots;
    g->slot_count *= 2;
    /* in the cells' order, so that of two entries of one cell the older one is still found first */
    for (size_t i = 0; i < g->count; i++) {
        size_t s = first_slot(g, g->cells[i].at);
        while (slots[s]) s = (s + 1) & (g->slot_count - 1);
        slots[s] = (uint32_t)i + 1;
    }
    return ST_OK;
}

static bool takes(const struct grid_cell *c, const int64_t at[3], struct vec3 normal)
{
    if (memcmp(c->at, at, sizeof c->at)) return false;
    const struct vec3 n = {c->normal[0], c->normal[1], c->normal[2]};
    return vec3_dot(n, normal) > MIN_COSINE * vec3_length(n);
}

enum status point_grid_add(struct point_grid *g, const struct fused_sample *s, struct err *err)
{
    const double p[3] = {s->position.x / g->edge, s->position.y / g->edge, s->position.z / g->edge};
    const double normal[3] = {s->normal.x, s->normal.y, s->normal.z};
    int64_t at[3];
    for (int k = 0; k < 3; k++) {
        if (!(fabs(p[k]) < MAX_CELL)) return ST_OK;
        at[k] = (int64_t)floor(p[k]);
    }
    if (grow(g, err)) return err->status;
    size_t slot = first_slot(g, at);
    while (g->slots[slot] && !takes(&g->cells[g->slots[slot] - 1], at, s->normal))
        slot = (slot + 1) & (g->slot_count - 1);
    if (!g->slots[slot]) {
        g->cells[g->count] = (struct grid_cell){.at = {at[0], at[1], at[2]}};
        g->slots[slot] = (uint32_t)++g->count;
    }
    struct grid_cell *c = &g->cells[g->slots[slot] - 1];
    const double w = fmax((double)s->confidence, MIN_WEIGHT);
    c->weight += w;
    for (int k = 0; k < 3; k++) {
        c->position[k] += w * (p[k] - (double)at[k]);
        c->normal[k] += w * normal[k];
        c->color[k] += (float)w * s->color[k];
    }
    c->confidence += (float)w * s->confidence;
    if (s->views > c->views) c->views = s->views;
    return ST_OK;
}

enum status point_grid_points(struct point_cloud *cloud, const struct point_grid *g, struct err *err)
{
    cloud->points = malloc((g->count + 1) * sizeof *cloud->points);
    if (!cloud->points) return err_nomem(err, "points", g->count * sizeof *cloud->points);
    cloud->count = g->count;
    cloud->cell = g->edge;
    for (size_t i = 0; i < g->count; i++) {
        const struct grid_cell *c = &g->cells[i];
        struct cloud_point *p = &cloud->points[i];
        double at[3];
        for (int k = 0; k < 3; k++) {
            at[k] = g->edge * ((double)c->at[k] + c->position[k] / c->weight);
            p->color[k] = (uint8_t)lrintf(255 * srgb_from_linear(c->color[k] / (float)c->weight));
        }
        p->position = vec3_make(at[0], at[1], at[2]);
        /* never 0: each summand is within 60 degrees of the sum before it */
        const struct vec3 n = vec3_normalize(vec3_make(c->normal[0], c->normal[1], c->normal[2]));
        p->normal[0] = (float)n.x;
        p->normal[1] = (float)n.y;
        p->normal[2] = (float)n.z;
        p->views = (uint16_t)(c->views < UINT16_MAX ? c->views : UINT16_MAX);
        p->confidence = fminf(c->confidence / (float)c->weight, 1);
    }
    return ST_OK;
}

void point_grid_release(struct point_grid *g)
{
    if (!g) return;
    free(g->cells);
    free(g->slots);
    *g = (struct point_grid){0};
}
