/* visible.c - see visible.h: triangles to pixels, with a depth buffer.
 *
 * Triangles are not projected. A camera at the origin sees the triangle of corners a, b, c along the ray d exactly if d
 * is on the inner side of the three planes through the origin and an edge [Olano 1997]. With d = ((u - cx) / fx, (v -
 * cy) / fy, 1) each of the three tests, such as (b x a) . d > 0 for a triangle whose front is seen, is linear in the
 * pixel. They hold for corners behind the camera too, so that nothing is clipped; only the rectangle of tiles that a
 * triangle may touch comes from its part in front of the near plane.
 *
 * Two triangles that share an edge get the same numbers with opposite signs for it, as (b x a) = -(a x b) in floating
 * point too, and so do all later steps. A pixel on the edge itself belongs to the triangle to its right or, where the
 * edge is horizontal, below (the top-left rule). So a closed surface has neither gaps nor pixels drawn twice.
 *
 * 1 / z is linear in the pixel as well. It comes from the plane of the face, not from the corners, so that it does not
 * depend on how the face is cut into triangles. The largest 1 / z wins; of equal ones, the first face in the model.
 *
 * All coefficients are in double precision, moved to the first pixel of a tile, and then rounded to single precision.
 * In a tile that an edge crosses, its values are at most a tile's side times its slope; hence it is off by less than
 * 1e-5 px. Eight pixels are tested at a time.
 *
 * Against [Colburn 2014, 4.6], where a graphics card draws the faces of one texture buffer after the other, visibility
 * is found once, and textures are looked up in visible pixels alone. */
#include "stages/render_model/visible.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/parallel.h"
#include "common/light/model_rays.h"
#include "common/math/lanes.h"
#include "stages/render_model/visible_lanes.h"

static const double NEAR = 1e-6;     /* of the model's size: nothing nearer to the camera is seen */
static const double EDGE_ON = 1e-10; /* of the model's size: a camera nearer to a face's plane does not see the face */
static const double SLACK = 0.01;    /* px around a triangle's corners, for rounding */

struct visible_triangle {
    struct linear edges[3], inverse_z;
    bool owns_edge[3];              /* pixels on the edge belong to the triangle */
    float left, right, top, bottom; /* px: all its pixels are within */
    uint32_t face;                  /* 1 + index */
};

/* ------------------------------------------------------------------------------------------------------- the model */

enum status visible_model_make(struct visible_model *m, const struct solid_mesh *mesh, const bool *drawn,
                               struct err *err)
{
    struct solid_triangles all = {0};
    *m = (struct visible_model){.mesh = mesh};
    if (solid_mesh_triangulate(&all, mesh, err)) return err->status;
    m->triangles = all.triangles; /* those that are drawn move to the front */
    for (int i = 0; i < all.count; i++)
        if (!drawn || drawn[all.triangles[i].face]) m->triangles[m->count++] = all.triangles[i];
    all.triangles = NULL;
    solid_triangles_release(&all);
    m->size = model_rays_size(&(struct model_rays){.mesh = *mesh});
    return ST_OK;
}

void visible_model_release(struct visible_model *m)
{
    if (!m) return;
    free(m->triangles);
    *m = (struct visible_model){0};
}

void visible_release(struct visible *v)
{
    if (!v) return;
    free(v->face);
    free(v->inverse_z);
    free(v->list);
    free(v->first);
    free(v->bins);
    *v = (struct visible){0};
}

/* ---------------------------------------------------------------------------------------------------- the triangles */

static void widen(struct visible_triangle *t, const struct view *camera, struct vec3 p)
{
    const float u = (float)(camera->fx * p.x / p.z + camera->cx), v = (float)(camera->fy * p.y / p.z + camera->cy);
    t->left = fminf(t->left, u);
    t->right = fmaxf(t->right, u);
    t->top = fminf(t->top, v);
    t->bottom = fmaxf(t->bottom, v);
}

/* Sets the rectangle of the triangle's part beyond the near plane; false: it does not touch the picture. */
static bool find_rectangle(struct visible_triangle *t, const struct view *camera, const struct vec3 corner[3],
                           double nearest)
{
    t->left = t->top = INFINITY;
    t->right = t->bottom = -INFINITY;
    for (int k = 0; k < 3; k++) {
        const struct vec3 p = corner[k], q = corner[(k + 1) % 3];
        if (p.z >= nearest) widen(t, camera, p);
        if ((p.z < nearest) == (q.z < nearest)) continue;
        struct vec3 cut = vec3_add(p, vec3_scale(vec3_sub(q, p), (nearest - p.z) / (q.z - p.z)));
        cut.z = nearest;
        widen(t, camera, cut);
    }
    const float slack = (float)SLACK;
    t->left -= slack, t->top -= slack, t->right += slack, t->bottom += slack;
    return t->right >= 0 && t->bottom >= 0 && t->left <= (float)camera->width && t->top <= (float)camera->height;
}

/* The test of the edge from a to b: n . d, n = b x a, as a function of the pixel's column and row. */
static struct linear edge_test(struct vec3 a, struct vec3 b, const struct view *camera, bool *owned)
{
    const struct vec3 n = vec3_cross(b, a);
    struct linear e = {n.x / camera->fx, n.y / camera->fy, 0};
    e.origin = n.z + (e.x * (0.5 - camera->cx) + e.y * (0.5 - camera->cy));
    *owned = e.x > 0 || (e.x == 0 && (e.y > 0 || (e.y == 0 && e.origin > 0)));
    return e;
}

static bool set_triangle(struct visible_triangle *t, const struct visible_model *m, const struct solid_triangle *from,
                         const struct view *camera, const struct vec3 *corners)
{
    const struct solid_face *face = &m->mesh->faces[from->face];
    double plane[3];
    if (!(vec3_dot(face->normal, camera->center) - face->offset > EDGE_ON * m->size)) return false;
    const struct vec3 corner[3] = {corners[from->v[0]], corners[from->v[1]], corners[from->v[2]]};
    if (!find_rectangle(t, camera, corner, NEAR * m->size)) return false;
    for (int k = 0; k < 3; k++) t->edges[k] = edge_test(corner[k], corner[(k + 1) % 3], camera, &t->owns_edge[k]);
    model_face_inverse_depth(plane, face, camera);
    t->inverse_z = (struct linear){plane[0], plane[1], plane[2] + 0.5 * (plane[0] + plane[1])};
    t->face = (uint32_t)from->face + 1;
    return true;
}

static enum status list_triangles(struct visible *v, const struct visible_model *m, const struct view *camera,
                                  int *count, struct err *err)
{
    const size_t vertices = (size_t)m->mesh->vertex_count;
    *count = 0;
    if (array_reserve(&v->list, &v->list_room, (size_t)m->count, sizeof *v->list, "triangles", err)) return err->status;
    struct vec3 *corners = malloc((vertices + 1) * sizeof *corners);
    if (!corners) return err_nomem(err, "vertices", vertices * sizeof *corners);
    for (size_t i = 0; i < vertices; i++)
        corners[i] = mat3_apply(camera->cam_from_world, vec3_sub(m->mesh->vertices[i].p, camera->center));
    for (int i = 0; i < m->count; i++) *count += set_triangle(&v->list[*count], m, &m->triangles[i], camera, corners);
    free(corners);
    return ST_OK;
}

/* -------------------------------------------------------------------------------------------------------- the tiles */

struct span {
    int first, last;
};

static struct span tiles_between(float low, float high, int count)
{
    const float most = (float)(count * VISIBLE_TILE - 1);
    return (struct span){(int)fmaxf(low, 0) / VISIBLE_TILE, (int)fminf(high, most) / VISIBLE_TILE};
}

static double largest_in_tile(const struct linear *e, int x, int y)
{
    const double side = VISIBLE_TILE - 1;
    return linear_at(e, x, y) + fmax(0, side * e->x) + fmax(0, side * e->y);
}

/* Whether a triangle may show in the tile whose first pixel is (x, y). */
static bool touches(const struct visible_triangle *t, int x, int y)
{
    bool may = largest_in_tile(&t->inverse_z, x, y) > 0;
    for (int k = 0; k < 3; k++) may &= largest_in_tile(&t->edges[k], x, y) >= 0;
    return may;
}

/* Calls visit for the tiles that a triangle touches. */
static void for_tiles(const struct visible *v, int triangle, void (*visit)(const struct visible *v, int tile, int t))
{
    const struct visible_triangle *t = &v->list[triangle];
    const struct span x = tiles_between(t->left, t->right, v->columns), y = tiles_between(t->top, t->bottom, v->rows);
    for (int row = y.first; row <= y.last; row++)
        for (int column = x.first; column <= x.last; column++)
            if (touches(t, column * VISIBLE_TILE, row * VISIBLE_TILE)) visit(v, row * v->columns + column, triangle);
}

static void count_tile(const struct visible *v, int tile, int triangle)
{
    (void)triangle;
    v->first[tile + 1]++;
}

static void fill_tile(const struct visible *v, int tile, int triangle) { v->bins[v->first[tile]++] = triangle; }

/* Sorts triangles by tile; in each tile they stay in order. */
static enum status bin_triangles(struct visible *v, int count, struct err *err)
{
    const int tiles = v->columns * v->rows;
    memset(v->first, 0, ((size_t)tiles + 1) * sizeof *v->first);
    for (int i = 0; i < count; i++) for_tiles(v, i, count_tile);
    for (int i = 0; i < tiles; i++) v->first[i + 1] += v->first[i];
    if (array_reserve(&v->bins, &v->bin_room, (size_t)v->first[tiles], sizeof *v->bins, "triangles of tiles", err))
        return err->status;
    for (int i = 0; i < count; i++) for_tiles(v, i, fill_tile);
    memmove(v->first + 1, v->first, (size_t)tiles * sizeof *v->first); /* filling moved each to the next one's place */
    v->first[0] = 0;
    return ST_OK;
}

struct rectangle { /* of a tile: rows, and groups of eight pixels */
    int top, bottom, left, right;
};

static struct rectangle part_of_tile(const struct visible_triangle *t, int x, int y)
{
    const float last = VISIBLE_TILE - 1;
    const int left = (int)fminf(fmaxf(t->left - (float)x - 0.5f, 0), last);
    const int right = (int)fminf(fmaxf(t->right - (float)x + 0.5f, 0), last);
    const int top = (int)fminf(fmaxf(t->top - (float)y - 0.5f, 0), last);
    const int bottom = (int)fminf(fmaxf(t->bottom - (float)y + 0.5f, 0), last);
    return (struct rectangle){top, bottom, left / LANES, right / LANES};
}

/* Draws a triangle into the tile whose first pixel is (x, y). */
static void draw_triangle(uint32_t *face, float *inverse_z, const struct visible_triangle *t, int x, int y,
                          float largest)
{
    const struct rectangle part = part_of_tile(t, x, y);
    const struct lanes e0 = lanes_from(&t->edges[0], x, y), e1 = lanes_from(&t->edges[1], x, y);
    const struct lanes e2 = lanes_from(&t->edges[2], x, y), depth = lanes_from(&t->inverse_z, x, y);
    /* a value of 0 passes if the triangle owns the edge */
    const f32x8 zero0 = f32x8_all(t->owns_edge[0] ? -1e-45f : 0);
    const f32x8 zero1 = f32x8_all(t->owns_edge[1] ? -1e-45f : 0);
    const f32x8 zero2 = f32x8_all(t->owns_edge[2] ? -1e-45f : 0);
    const f32x8 most = f32x8_all(largest);
    const i32x8 name = i32x8_all((int)t->face);
    for (int j = part.top; j <= part.bottom; j++) {
        const f32x8 down = f32x8_all((float)j);
        for (int i = part.left; i <= part.right; i++) {
            const f32x8 right = f32x8_all((float)(LANES * i));
            const int at = j * VISIBLE_TILE + LANES * i;
            const f32x8 z = lanes_value(&depth, down, right), before = f32x8_load(inverse_z + at);
            i32x8 shown = (z > before) & (z <= most);
            shown &= lanes_value(&e0, down, right) > zero0;
            shown &= lanes_value(&e1, down, right) > zero1;
            shown &= lanes_value(&e2, down, right) > zero2;
            if (!i32x8_any(shown)) continue;
            const i32x8 old = i32x8_load(face + at);
            f32x8_store(inverse_z + at, f32x8_if(shown, z, before));
            i32x8_store(face + at, i32x8_if(shown, name, old));
        }
    }
}

struct draw_job {
    const struct visible *v;
    float largest; /* inverse depth */
};

static void draw_tiles(void *ctx, size_t begin, size_t end, int thread)
{
    const struct draw_job *job = ctx;
    const struct visible *v = job->v;
    (void)thread;
    for (size_t tile = begin; tile < end; tile++) {
        uint32_t *face = v->face + tile * VISIBLE_PIXELS;
        float *inverse_z = v->inverse_z + tile * VISIBLE_PIXELS;
        const int x = (int)tile % v->columns * VISIBLE_TILE, y = (int)tile / v->columns * VISIBLE_TILE;
        memset(face, 0, VISIBLE_PIXELS * sizeof *face);
        memset(inverse_z, 0, VISIBLE_PIXELS * sizeof *inverse_z);
        for (int i = v->first[tile]; i < v->first[tile + 1]; i++)
            draw_triangle(face, inverse_z, &v->list[v->bins[i]], x, y, job->largest);
    }
}

static enum status resize(struct visible *v, const struct view *camera, struct err *err)
{
    v->width = camera->width;
    v->height = camera->height;
    v->columns = (v->width + VISIBLE_TILE - 1) / VISIBLE_TILE;
    v->rows = (v->height + VISIBLE_TILE - 1) / VISIBLE_TILE;
    const size_t tiles = (size_t)v->columns * (size_t)v->rows, pixels = tiles * VISIBLE_PIXELS;
    size_t room = v->pixel_room;
    if (array_reserve(&v->face, &room, pixels, sizeof *v->face, "pixels", err) ||
        array_reserve(&v->inverse_z, &v->pixel_room, pixels, sizeof *v->inverse_z, "pixels", err) ||
        array_reserve(&v->first, &v->first_room, tiles + 1, sizeof *v->first, "tiles", err))
        return err->status;
    return ST_OK;
}

enum status visible_draw(struct visible *v, const struct visible_model *m, const struct view *camera, struct err *err)
{
    int count = 0;
    if (resize(v, camera, err) || list_triangles(v, m, camera, &count, err) || bin_triangles(v, count, err))
        return err->status;
    struct draw_job job = {v, (float)(1 / (NEAR * m->size))};
    parallel_for((size_t)v->columns * (size_t)v->rows, 1, draw_tiles, &job);
    return ST_OK;
}
