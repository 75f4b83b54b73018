/* thing_mesh.c - triangles where the distance of a thing's volume is 0; see thing_mesh.h.
 *
 * A cell lies between eight voxels' centres. A cell in which the distance changes its sign has one vertex, the mean of
 * the places on its edges where the distance is 0; each such edge of the grid has a quadrangle of the four cells around
 * it [Gibson 1998]. That gives well-shaped triangles, and fewer than one table of cases would. */
#include "common/model/thing_mesh.h"

#include <stdlib.h>

#include "common/base/array.h"

struct extractor {
    struct thing_mesh *m;
    const struct thing_volume *v;
    uint32_t id;
    int low[3], high[3]; /* cells */
    int *vertex;         /* of each cell of the box; -1: none */
    size_t row, slice;   /* voxels */
};

static size_t cell_at(const struct extractor *e, int x, int y, int z)
{
    const size_t width = (size_t)(e->high[0] - e->low[0] + 1), height = (size_t)(e->high[1] - e->low[1] + 1);
    return ((size_t)(z - e->low[2]) * height + (size_t)(y - e->low[1])) * width + (size_t)(x - e->low[0]);
}

static size_t voxel_at(const struct extractor *e, int x, int y, int z)
{
    return (size_t)z * e->slice + (size_t)y * e->row + (size_t)x;
}

/* The box of cells that touch the thing; false: it has no voxels. */
static bool find_box(struct extractor *e)
{
    const struct voxel_grid *g = &e->v->grid;
    for (int k = 0; k < 3; k++) e->low[k] = g->size[k], e->high[k] = -1;
    for (size_t i = 0; i < voxel_count(g); i++) {
        if (e->v->id[i] != e->id) continue;
        const int p[3] = {(int)(i % e->row), (int)(i / e->row % (size_t)g->size[1]), (int)(i / e->slice)};
        for (int k = 0; k < 3; k++) {
            if (p[k] < e->low[k]) e->low[k] = p[k];
            if (p[k] - 1 > e->high[k]) e->high[k] = p[k] - 1; /* a cell reaches to the next voxel */
        }
    }
    return e->low[0] <= e->high[0] && e->low[1] <= e->high[1] && e->low[2] <= e->high[2];
}

/* The distances at a cell's corners; false: one of them is unknown. */
static bool corners_of(float corner[8], const struct extractor *e, int x, int y, int z)
{
    for (int c = 0; c < 8; c++) {
        const size_t i = voxel_at(e, x + (c & 1), y + (c >> 1 & 1), z + (c >> 2));
        corner[c] = e->v->distance[i];
        if (e->v->id[i] != e->id || corner[c] == THING_UNSEEN) return false;
    }
    return true;
}

static enum status add_vertex(struct extractor *e, int x, int y, int z, const float corner[8], struct err *err)
{
    double sum[3] = {0};
    int count = 0;
    for (int a = 0; a < 8; a++)
        for (int k = 0; k < 3; k++) {
            const int b = a | 1 << k;
            if (b == a || (corner[a] > 0) == (corner[b] > 0)) continue;
            const double t = (double)corner[a] / (double)(corner[a] - corner[b]);
            for (int i = 0; i < 3; i++) sum[i] += (a >> i & 1) + (i == k ? t : 0);
            count++;
        }
    struct thing_mesh *m = e->m;
    if (!count) return ST_OK;
    if (array_append(&m->vertices, (size_t)m->vertex_count, sizeof *m->vertices, "vertices", err)) return err->status;
    const struct vec3 first = thing_voxel_centre(&e->v->grid, (int64_t)voxel_at(e, x, y, z));
    e->vertex[cell_at(e, x, y, z)] = m->vertex_count;
    m->vertices[m->vertex_count++] =
        vec3_add(first, vec3_scale(vec3_make(sum[0] / count, sum[1] / count, sum[2] / count), e->v->grid.voxel));
    return ST_OK;
}

static enum status add_triangle(struct thing_mesh *m, int a, int b, int c, struct err *err)
{
    if (array_append(&m->triangles, (size_t)m->triangle_count, sizeof *m->triangles, "triangles", err))
        return err->status;
    int *t = m->triangles[m->triangle_count++];
    t[0] = a, t[1] = b, t[2] = c;
    return ST_OK;
}

/* The quadrangle across the edge from voxel (x, y, z) along axis k, of the four cells around it. */
static enum status add_quadrangle(struct extractor *e, int x, int y, int z, int k, struct err *err)
{
    const int at[3] = {x, y, z}, u = (k + 1) % 3, v = (k + 2) % 3;
    int cell[4];
    for (int i = 0; i < 4; i++) { /* around the axis, counter-clockwise */
        int p[3] = {x, y, z};
        p[u] -= i == 1 || i == 2;
        p[v] -= i == 2 || i == 3;
        for (int c = 0; c < 3; c++)
            if (p[c] < e->low[c] || p[c] > e->high[c]) return ST_OK;
        if ((cell[i] = e->vertex[cell_at(e, p[0], p[1], p[2])]) < 0) return ST_OK;
    }
    int next[3] = {at[0], at[1], at[2]};
    next[k]++;
    const bool out = e->v->distance[voxel_at(e, next[0], next[1], next[2])] > 0; /* outside lies along the axis */
    if (out)
        return add_triangle(e->m, cell[0], cell[1], cell[2], err) || add_triangle(e->m, cell[0], cell[2], cell[3], err)
                   ? err->status
                   : ST_OK;
    return add_triangle(e->m, cell[0], cell[2], cell[1], err) || add_triangle(e->m, cell[0], cell[3], cell[2], err)
               ? err->status
               : ST_OK;
}

static enum status add_faces(struct extractor *e, struct err *err)
{
    for (int z = e->low[2]; z <= e->high[2]; z++)
        for (int y = e->low[1]; y <= e->high[1]; y++)
            for (int x = e->low[0]; x <= e->high[0]; x++) {
                if (e->vertex[cell_at(e, x, y, z)] < 0) continue;
                for (int k = 0; k < 3; k++) {
                    const size_t a = voxel_at(e, x, y, z), b = voxel_at(e, x + (k == 0), y + (k == 1), z + (k == 2));
                    if ((e->v->distance[a] > 0) != (e->v->distance[b] > 0) && add_quadrangle(e, x, y, z, k, err))
                        return err->status;
                }
            }
    return ST_OK;
}

enum status thing_mesh_make(struct thing_mesh *m, const struct thing_volume *v, uint32_t id, struct err *err)
{
    struct extractor e = {.m = m, .v = v, .id = id, .row = (size_t)v->grid.size[0]};
    e.slice = e.row * (size_t)v->grid.size[1];
    *m = (struct thing_mesh){0};
    if (!find_box(&e)) return ST_OK;
    const size_t cells = cell_at(&e, e.high[0], e.high[1], e.high[2]) + 1;
    if (!(e.vertex = malloc(cells * sizeof *e.vertex))) return err_nomem(err, "cells", cells * sizeof *e.vertex);
    for (size_t i = 0; i < cells; i++) e.vertex[i] = -1;
    for (int z = e.low[2]; !err->status && z <= e.high[2]; z++)
        for (int y = e.low[1]; !err->status && y <= e.high[1]; y++)
            for (int x = e.low[0]; !err->status && x <= e.high[0]; x++) {
                float corner[8];
                if (corners_of(corner, &e, x, y, z)) add_vertex(&e, x, y, z, corner, err);
            }
    if (!err->status) add_faces(&e, err);
    free(e.vertex);
    return err->status;
}

void thing_mesh_release(struct thing_mesh *m)
{
    free(m->vertices);
    free(m->triangles);
    *m = (struct thing_mesh){0};
}
