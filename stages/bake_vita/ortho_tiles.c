/* ortho_tiles.c - see ortho_tiles.h. */
#include "stages/bake_vita/ortho_tiles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/texture/ortho.h"

enum { GUTTER = 1 }; /* texels around the area */

struct ortho { /* a surface's raster: texel (x, y) is at right (left + side (x + 0.5)) + down (top + side (y + 0.5)) */
    struct vec3 right, down;
    double left, top;
    int width, height;
};

static struct ortho make_ortho(const struct surfaces *s, int surface, double side)
{
    const struct surface *of = &s->list[surface];
    struct ortho o = {.left = INFINITY, .top = INFINITY};
    double end = -INFINITY, bottom = -INFINITY;
    ortho_axes(&o.right, &o.down, of->normal);
    for (int i = of->first; i < of->first + of->triangles; i++)
        for (int k = 0; k < 3; k++) {
            const double x = vec3_dot(o.right, s->triangles[i][k]), y = vec3_dot(o.down, s->triangles[i][k]);
            o.left = fmin(o.left, x), end = fmax(end, x);
            o.top = fmin(o.top, y), bottom = fmax(bottom, y);
        }
    o.left -= GUTTER * side;
    o.top -= GUTTER * side;
    o.width = (int)ceil((end - o.left) / side) + GUTTER;
    o.height = (int)ceil((bottom - o.top) / side) + GUTTER;
    return o;
}

size_t ortho_texels(const struct surfaces *s, int surface, double side)
{
    const struct ortho o = make_ortho(s, surface, side);
    return (size_t)o.width * (size_t)o.height;
}

static struct bake_tile make_tile(const struct ortho *o, const struct surface *s, int surface, double side, int x,
                                  int y, int width, int height)
{
    struct bake_tile t = {.surface = surface, .view = -1, .x = x, .y = y, .side = side};
    const double left = o->left + side * x, top = o->top + side * y;
    const double right[3] = {o->right.x, o->right.y, o->right.z}, down[3] = {o->down.x, o->down.y, o->down.z};
    const double normal[3] = {s->normal.x, s->normal.y, s->normal.z};
    t.raster.width = width, t.raster.height = height;
    for (int j = 0; j < 3; j++) {
        t.raster.point[j][0] = side * right[j];
        t.raster.point[j][1] = side * down[j];
        t.raster.point[j][2] = left * right[j] + top * down[j] + s->offset * normal[j];
    }
    t.raster.point[3][2] = 1;
    ortho_matrix(t.matrix, o->right, o->down, side, left, top);
    return t;
}

/* Marks the area and its gutter as wanted. */
static enum status want_area(struct bake *b, const struct bake_tile *t, struct err *err)
{
    const int width = t->raster.width, height = t->raster.height;
    uint8_t *area = calloc((size_t)width, (size_t)height);
    if (!area) return err_nomem(err, "a tile", (size_t)width * (size_t)height);
    surface_fill(area, b->surfaces, t->surface, &t->raster);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            if (!area[(size_t)y * (size_t)width + (size_t)x]) continue;
            for (int dy = -GUTTER; dy <= GUTTER; dy++)
                for (int dx = -GUTTER; dx <= GUTTER; dx++)
                    if (x + dx >= 0 && y + dy >= 0 && x + dx < width && y + dy < height)
                        b->role[t->first + (size_t)(y + dy) * (size_t)width + (size_t)(x + dx)] = TEXEL_WANTED;
        }
    free(area);
    return ST_OK;
}

enum status ortho_tiles_add(struct bake *b, int surface, double side, struct err *err)
{
    const struct ortho o = make_ortho(b->surfaces, surface, side);
    const int step = ATLAS_PAGE - 1;
    for (int y = 0; !err->status && (y == 0 || y + 1 < o.height); y += step)
        for (int x = 0; !err->status && (x == 0 || x + 1 < o.width); x += step) {
            const int width = o.width - x < ATLAS_PAGE ? o.width - x : ATLAS_PAGE;
            const int height = o.height - y < ATLAS_PAGE ? o.height - y : ATLAS_PAGE;
            if (!bake_add_tile(b, make_tile(&o, &b->surfaces->list[surface], surface, side, x, y, width, height), err))
                want_area(b, &b->tiles[b->tile_count - 1], err);
        }
    return err->status;
}
