/* view_tiles.c - the texels of a viewpoint's own views, as tiles.
 *
 * A tile is a rectangle of the view's own pixels, so that an original texel is a pixel and is copied bit for bit. A
 * texel is original if the view shows the face there: the id buffer says so, the model's depth has no jump nearby,
 * and nothing stands in front. It is doubted where something may stand in front; then other views are asked. Other
 * texels are wanted only.
 *
 * Which texels. A surface gets what the view shows of it and what edits would reveal behind, with a margin of 8;
 * with [bake_vdta] reveal = all, all of it that lies in the view's frame. In both cases only inside the surface and
 * one texel around it, for look-ups at its edge (distance transform). Several surfaces may share an id; a pixel's
 * depth says which one it shows.
 *
 * Geometry. The ray of texel (x, y) from the centre c is d = R' K^-1 (x, y, 1). It meets the plane n . p = o at c +
 * k / (n . d) d with k = o - n . c, so the point, times -(n . d), is linear in (x, y, 1): a 4 x 3 matrix per tile.
 * The way back is the camera's own matrix, shifted to the tile's corner. Surfaces seen from behind get no tile.
 *
 * What is larger than a page is cut into tiles that share a row or a column of texels. */
#include "stages/bake_vdta/view_tiles.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/distance.h"

enum { MARGIN = 8 };                  /* texels around what is seen or revealed */
enum { GUTTER = 1 };                  /* texels around a face, for look-ups at its edge */
static const double OFF_PLANE = 1e-3; /* of the depth: a pixel's point belongs to the surface that it is nearest to */

struct rectangle {
    int x0, y0, x1, y1; /* the last ones not included */
};

struct builder {
    struct bake *b;
    const struct own_view *v;
    int view;
    bool all;
};

/* The surface that a pixel's id and depth mean; -1: none. */
static int surface_at(const struct builder *w, uint32_t id, float z, int x, int y)
{
    if (!id || !(z > 0)) return -1;
    const int first = surfaces_find(w->b->surfaces, (int)id);
    if (first < 0 || first + 1 >= w->b->surfaces->count || w->b->surfaces->list[first + 1].id != (int)id) return first;
    const struct vec3 p = view_unproject(&w->v->view.camera, x + 0.5, y + 0.5, z);
    return surfaces_find_at(w->b->surfaces, (int)id, p, OFF_PLANE * z);
}

/* Calls visit for the surfaces of each pixel in a rectangle: layer -1 is what the view shows, then what is revealed. */
static void for_pixels(const struct builder *w, struct rectangle r, void (*visit)(void *ctx, int surface, int x, int y),
                       void *ctx)
{
    const int width = w->v->view.camera.width;
    for (int layer = -1; layer < w->v->reveal.layers; layer++) {
        const uint32_t *id = layer < 0 ? w->v->view.id : w->v->reveal.id[layer];
        const float *z = layer < 0 ? w->v->ids.z : w->v->reveal.z[layer];
        for (int y = r.y0; y < r.y1; y++)
            for (int x = r.x0; x < r.x1; x++) {
                const size_t at = (size_t)y * (size_t)width + (size_t)x;
                const int surface = surface_at(w, id[at], z[at], x, y);
                if (surface >= 0) visit(ctx, surface, x, y);
            }
    }
}

static void grow(void *ctx, int surface, int x, int y)
{
    struct rectangle *r = (struct rectangle *)ctx + surface;
    if (x < r->x0) r->x0 = x;
    if (y < r->y0) r->y0 = y;
    if (x >= r->x1) r->x1 = x + 1;
    if (y >= r->y1) r->y1 = y + 1;
}

struct marks {
    uint8_t *inside;
    struct rectangle r;
    int surface;
};

static void mark(void *ctx, int surface, int x, int y)
{
    const struct marks *m = ctx;
    if (surface == m->surface)
        m->inside[(size_t)(y - m->r.y0) * (size_t)(m->r.x1 - m->r.x0) + (size_t)(x - m->r.x0)] = 1;
}

/* Grows what is marked by `margin` pixels. */
static enum status dilate(uint8_t *inside, int width, int height, int margin, struct err *err)
{
    const size_t pixels = (size_t)width * (size_t)height;
    float *squared = malloc(pixels * sizeof *squared);
    if (!squared) return err_nomem(err, "distances", pixels * sizeof *squared);
    for (size_t i = 0; i < pixels; i++) inside[i] = !inside[i];
    distance_squared(squared, inside, width, height, err);
    for (size_t i = 0; !err->status && i < pixels; i++) inside[i] = squared[i] <= (float)(margin * margin);
    free(squared);
    return err->status;
}

/* A tile of the view's raster over a surface; false: the camera sees the surface from behind, or along it. */
static bool make_tile(struct bake_tile *t, const struct builder *w, int surface, struct rectangle r)
{
    const struct view *c = &w->v->view.camera;
    const struct surface *s = &w->b->surfaces->list[surface];
    const double k = s->offset - vec3_dot(s->normal, c->center); /* below 0: the camera is in front */
    if (!(k < 0)) return false;
    *t = (struct bake_tile){.surface = surface, .view = w->view, .x = r.x0, .y = r.y0, .side = 1 / c->fx};
    t->raster.width = r.x1 - r.x0, t->raster.height = r.y1 - r.y0;
    /* the ray of texel (x, y) is d = ray (x, y, 1); it meets the plane at centre + k / (n . d) d */
    const struct mat3 turn = mat3_transpose(c->cam_from_world);
    const double u[3] = {1 / c->fx, 0, (r.x0 - c->cx) / c->fx}, v[3] = {0, 1 / c->fy, (r.y0 - c->cy) / c->fy};
    const double centre[3] = {c->center.x, c->center.y, c->center.z};
    const double normal[3] = {s->normal.x, s->normal.y, s->normal.z};
    for (int i = 0; i < 3; i++) {
        double ray[3], along = 0;
        for (int j = 0; j < 3; j++) {
            ray[j] = turn.m[j][0] * u[i] + turn.m[j][1] * v[i] + (i == 2 ? turn.m[j][2] : 0);
            along += normal[j] * ray[j];
        }
        for (int j = 0; j < 3; j++) t->raster.point[j][i] = -(centre[j] * along + k * ray[j]);
        t->raster.point[3][i] = -along;
    }
    for (int i = 0; i < 4; i++) {
        t->matrix[0][i] = w->v->view.project[0][i] - r.x0 * w->v->view.project[2][i];
        t->matrix[1][i] = w->v->view.project[1][i] - r.y0 * w->v->view.project[2][i];
        t->matrix[2][i] = w->v->view.project[2][i];
    }
    return true;
}

/* What a texel that is wanted is before other views are asked. */
static void set_role(struct bake *b, const struct builder *w, size_t texel, size_t pixel, int id, bool visible)
{
    b->role[texel] = TEXEL_WANTED;
    if (!visible || w->v->view.id[pixel] != (uint32_t)id || w->v->view.own[pixel] <= SOURCE_HIDDEN) return;
    b->role[texel] = w->v->view.own[pixel] >= SOURCE_LIKELY ? TEXEL_ORIGINAL : TEXEL_DOUBTED;
    memcpy(b->rgb + 3 * texel, w->v->view.levels[0].rgba + 4 * pixel, 3 * sizeof *b->rgb);
    b->made[texel] = (uint32_t)ATLAS_VIEWS + (uint32_t)w->view;
}

/* Adds the part of a surface inside r, whose texels `wanted` covers (rows of `stride`). */
static enum status add_part(const struct builder *w, int surface, struct rectangle r, const uint8_t *wanted, int stride,
                            struct err *err)
{
    struct bake *b = w->b;
    struct bake_tile t;
    if (!make_tile(&t, w, surface, r)) return ST_OK;
    if (bake_add_tile(b, t, err)) return err->status;
    const struct bake_tile *added = &b->tiles[b->tile_count - 1];
    const int id = b->surfaces->list[surface].id, width = w->v->view.camera.width;
    for (int y = 0; y < t.raster.height; y++)
        for (int x = 0; x < t.raster.width; x++) {
            const size_t pixel = (size_t)(r.y0 + y) * (size_t)width + (size_t)(r.x0 + x);
            if (!wanted[(size_t)y * (size_t)stride + (size_t)x]) continue;
            const bool visible = surface_at(w, w->v->view.id[pixel], w->v->ids.z[pixel], r.x0 + x, r.y0 + y) == surface;
            set_role(b, w, added->first + (size_t)y * (size_t)t.raster.width + (size_t)x, pixel, id, visible);
        }
    return ST_OK;
}

/* Shrinks r to the texels that are wanted; false: there are none. */
static bool shrink(struct rectangle *r, const uint8_t *wanted)
{
    const int width = r->x1 - r->x0, height = r->y1 - r->y0;
    struct rectangle s = {width, height, 0, 0};
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            if (wanted[(size_t)y * (size_t)width + (size_t)x]) grow(&s, 0, x, y);
    if (s.x0 >= s.x1) return false;
    *r = (struct rectangle){r->x0 + s.x0, r->y0 + s.y0, r->x0 + s.x1, r->y0 + s.y1};
    return true;
}

/* Cuts what is wanted into tiles that fit on a page. full: the rectangle that `wanted` covers. */
static enum status add_parts(const struct builder *w, int surface, struct rectangle full, const uint8_t *wanted,
                             struct err *err)
{
    struct rectangle r = full;
    const int stride = full.x1 - full.x0, step = ATLAS_PAGE - 1;
    if (!shrink(&r, wanted)) return ST_OK;
    for (int y = r.y0; !err->status && (y == r.y0 || y + 1 < r.y1); y += step)
        for (int x = r.x0; !err->status && (x == r.x0 || x + 1 < r.x1); x += step) {
            const struct rectangle part = {x, y, x + ATLAS_PAGE < r.x1 ? x + ATLAS_PAGE : r.x1,
                                           y + ATLAS_PAGE < r.y1 ? y + ATLAS_PAGE : r.y1};
            add_part(w, surface, part, wanted + (size_t)(y - full.y0) * (size_t)stride + (size_t)(x - full.x0), stride,
                     err);
        }
    return err->status;
}

/* seen: the rectangle of what is seen or revealed. */
static enum status add_surface(const struct builder *w, int surface, struct rectangle seen, struct err *err)
{
    const struct view *c = &w->v->view.camera;
    const struct rectangle frame = {0, 0, c->width, c->height};
    struct rectangle r = frame;
    if (!w->all) {
        r.x0 = seen.x0 > MARGIN ? seen.x0 - MARGIN : 0, r.y0 = seen.y0 > MARGIN ? seen.y0 - MARGIN : 0;
        r.x1 = seen.x1 + MARGIN < c->width ? seen.x1 + MARGIN : c->width;
        r.y1 = seen.y1 + MARGIN < c->height ? seen.y1 + MARGIN : c->height;
    }
    const int width = r.x1 - r.x0, height = r.y1 - r.y0;
    const size_t pixels = (size_t)width * (size_t)height;
    struct bake_tile t;
    if (!make_tile(&t, w, surface, r)) return ST_OK;
    struct marks m = {calloc(3, pixels), r, surface};
    if (!m.inside) return err_nomem(err, "a tile", 3 * pixels);
    uint8_t *area = m.inside + pixels, *wanted = area + pixels;
    for_pixels(w, seen, mark, &m);
    memcpy(wanted, m.inside, pixels);
    surface_fill(area, w->b->surfaces, surface, &t.raster);
    /* an edit's part of the face is known by its seen texels alone */
    for (size_t i = 0; i < pixels; i++) area[i] |= m.inside[i];
    dilate(area, width, height, GUTTER, err);
    if (!err->status && !w->all) dilate(wanted, width, height, MARGIN, err);
    for (size_t i = 0; !err->status && i < pixels; i++) wanted[i] = area[i] && (w->all || wanted[i]);
    if (!err->status) add_parts(w, surface, r, wanted, err);
    free(m.inside);
    return err->status;
}

enum status view_tiles_add(struct bake *b, const struct own_view *v, int view, bool all, struct err *err)
{
    const struct builder w = {b, v, view, all};
    const struct rectangle frame = {0, 0, v->view.camera.width, v->view.camera.height};
    struct rectangle *seen = malloc(((size_t)b->surfaces->count + 1) * sizeof *seen);
    if (!seen) return err_nomem(err, "faces", (size_t)b->surfaces->count * sizeof *seen);
    for (int i = 0; i < b->surfaces->count; i++) seen[i] = (struct rectangle){frame.x1, frame.y1, 0, 0};
    for_pixels(&w, frame, grow, seen);
    for (int i = 0; !err->status && i < b->surfaces->count; i++)
        if (all || seen[i].x0 < seen[i].x1) add_surface(&w, i, seen[i], err);
    free(seen);
    return err->status;
}
