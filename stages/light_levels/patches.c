/* patches.c - see patches.h.
 *
 * Overview. Faces that look outdoors are left out: light that they reflect never comes back. What is left is divided
 * into cells whose side makes as many of them as are wanted. In each cell SAMPLES x SAMPLES places are tried; those on
 * the face are the patch's, and its area is its share of the face's places. So cells that a face covers in part need no
 * clipping, and areas of a face sum to its own. A face too narrow for a place has one patch, at a corner.
 *
 * Further triangles are grouped by their owner, the cube of that side in which their middle is, and the axis that they
 * face most. Places of a patch are taken by area. */
#include "stages/light_levels/patches.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/parallel.h"
#include "common/gather/strategy.h"
#include "common/light/frame.h"
#include "common/light/sobol.h"

enum { SAMPLES = 4, GLANCES = 64, OUTER_PLACES = 8 };
static const double OUTSIDE = 0.9; /* of the rays of a face that looks outdoors leave the model */

/* --------------------------------------------------------------------------------------------------- a face's plane */

/* Edges of a face as (x0, y0, x1, y1) in its own coordinates. */
struct outline {
    double (*edges)[4]; /* owned */
    int count;
};

static void put_edge(struct outline *o, const struct patch_cells *c, struct vec3 a, struct vec3 b)
{
    double *e = o->edges[o->count++];
    e[0] = vec3_dot(c->u, a);
    e[1] = vec3_dot(c->v, a);
    e[2] = vec3_dot(c->u, b);
    e[3] = vec3_dot(c->v, b);
}

static int count_edges(const struct solid_mesh *m, int face)
{
    int count = 0;
    for (int l = m->faces[face].loop; l < m->faces[face].loop + m->faces[face].loops; l++)
        for (int h = m->loops[l].half_edge, first = h, begun = 0; !begun || h != first; h = m->half_edges[h].next)
            begun = 1, count++;
    return count;
}

static enum status outline_make(struct outline *o, const struct solid_mesh *m, int face, const struct patch_cells *c,
                                struct err *err)
{
    const size_t most = (size_t)count_edges(m, face);
    *o = (struct outline){malloc(most * sizeof *o->edges), 0};
    if (!o->edges) return err_nomem(err, "edges of a face", most * sizeof *o->edges);
    for (int l = m->faces[face].loop; l < m->faces[face].loop + m->faces[face].loops; l++) {
        const int first = m->loops[l].half_edge;
        int h = first;
        do {
            const int next = m->half_edges[h].next;
            put_edge(o, c, m->vertices[m->half_edges[h].origin].p, m->vertices[m->half_edges[next].origin].p);
            h = next;
        } while (h != first);
    }
    return ST_OK;
}

static bool outline_holds(const struct outline *o, double x, double y)
{
    bool in = false;
    for (int i = 0; i < o->count; i++) {
        const double *e = o->edges[i];
        if ((e[1] > y) != (e[3] > y) && x < e[0] + (e[2] - e[0]) * (y - e[1]) / (e[3] - e[1])) in = !in;
    }
    return in;
}

static struct vec3 on_plane(const struct solid_face *f, const struct patch_cells *c, double x, double y)
{
    return vec3_add(vec3_scale(f->normal, f->offset), vec3_add(vec3_scale(c->u, x), vec3_scale(c->v, y)));
}

static void set_frame(struct patch_cells *c, const struct solid_mesh *m, int face, double high[2])
{
    const struct solid_face *f = &m->faces[face];
    const struct vec3 up = fabs(f->normal.z) > 0.9 ? vec3_make(0, 1, 0) : vec3_make(0, 0, 1);
    c->u = vec3_normalize(vec3_cross(up, f->normal));
    c->v = vec3_cross(f->normal, c->u);
    solid_face_box(m, face, c->u, c->v, c->low, high);
}

/* A place on a face that is too narrow for a lattice. */
static struct vec3 some_place(const struct solid_mesh *m, int face)
{
    const int h = m->loops[m->faces[face].loop].half_edge;
    const struct vec3 sum = vec3_add(m->vertices[m->half_edges[h].origin].p,
                                     vec3_add(m->vertices[m->half_edges[m->half_edges[h].next].origin].p,
                                              m->vertices[m->half_edges[m->half_edges[h].prev].origin].p));
    return vec3_scale(sum, 1.0 / 3);
}

/* ------------------------------------------------------------------------------------------------------ outer faces */

/* The share of rays from a point that leave the model. */
static double glance(const struct model_field *f, struct vec3 at, struct vec3 normal, int key)
{
    const struct vec3 from = vec3_add(at, vec3_scale(normal, f->model.rays.epsilon));
    const struct rng rng = rng_make((uint64_t)key, "light_levels", "glance");
    struct sobol points = sobol_make(&rng, 0, GLANCES);
    struct strategy s;
    struct ray_hit hit;
    int away = 0, count = 0;
    strategy_cosine(&s, (struct gather_point){at, normal});
    for (int i = 0; i < GLANCES; i++) {
        struct vec3 direction;
        double u[4];
        points.sample = (uint32_t)i;
        sobol_group(&points, 0, u);
        if (!strategy_sample(&s, u, &direction)) continue;
        count++;
        away += !ray_scene_hit(&f->model.rays, from, direction, &hit);
    }
    return count ? (double)away / count : 1;
}

static enum status face_looks_outdoors(bool *outdoors, const struct model_field *f, int face, struct err *err)
{
    const struct solid_mesh *m = &f->model.mesh;
    struct patch_cells c = {0};
    struct outline o;
    double high[2], least = 1;
    int tried = 0;
    set_frame(&c, m, face, high);
    if (outline_make(&o, m, face, &c, err)) return err->status;
    for (int i = 0; i < OUTER_PLACES * OUTER_PLACES; i++) {
        const double x = c.low[0] + (high[0] - c.low[0]) * (i % OUTER_PLACES + 0.5) / OUTER_PLACES;
        const double y = c.low[1] + (high[1] - c.low[1]) * ((i / OUTER_PLACES) + 0.5) / OUTER_PLACES;
        if (!outline_holds(&o, x, y)) continue;
        least = fmin(least, glance(f, on_plane(&m->faces[face], &c, x, y), m->faces[face].normal, face));
        tried++;
    }
    if (!tried) least = glance(f, some_place(m, face), m->faces[face].normal, face);
    *outdoors = least > OUTSIDE;
    free(o.edges);
    return ST_OK;
}

struct glancing {
    const struct model_field *field;
    bool *wanted;
    struct err *errors; /* of each face */
};

static void glance_some(void *ctx, size_t begin, size_t end, int thread)
{
    const struct glancing *g = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        bool outdoors = true;
        if (!solid_face_is_pane(&g->field->model.mesh, (int)i))
            face_looks_outdoors(&outdoors, g->field, (int)i, &g->errors[i]);
        g->wanted[i] = !outdoors;
    }
}

static enum status choose_faces(bool *wanted, const struct model_field *f, struct err *err)
{
    const size_t count = (size_t)f->model.mesh.face_count;
    struct glancing g = {f, wanted, calloc(count + 1, sizeof *g.errors)};
    if (!g.errors) return err_nomem(err, "faces", count * sizeof *g.errors);
    parallel_for(count, 4, glance_some, &g);
    for (size_t i = 0; !err->status && i < count; i++)
        if (g.errors[i].status) *err = g.errors[i];
    free(g.errors);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------ patches of a face */

static enum status add_patch(struct light_patches *p, struct light_patch patch, struct err *err)
{
    if (array_append(&p->list, (size_t)p->count, sizeof *p->list, "patches", err)) return err->status;
    p->list[p->count++] = patch;
    return ST_OK;
}

static enum status add_sample(struct light_patches *p, struct vec3 at, struct err *err)
{
    if (array_append(&p->samples, (size_t)p->sample_count, sizeof *p->samples, "places", err)) return err->status;
    p->samples[p->sample_count++] = at;
    return ST_OK;
}

/* Sets what follows from the places of a patch of a face. */
static void finish_patch(struct light_patches *p, struct light_patch *patch)
{
    const struct solid_mesh *m = &p->field->model.mesh;
    const int n = patch->sample_count, id = solid_face_id(m, patch->face);
    const int origins = n < PATCH_ORIGINS ? n : PATCH_ORIGINS;
    int known = 0, shown = 0;
    for (int i = 0; i < origins; i++)
        patch->origins[i] = (struct gather_point){p->samples[patch->sample + (2 * i + 1) * n / (2 * origins)],
                                                  m->faces[patch->face].normal};
    patch->origin_count = origins;
    for (int i = 0; i < n; i++) {
        const struct field_texel t = field_atlas_look(&p->field->atlas, id, p->samples[patch->sample + i]);
        if (t.source == LIGHT_NONE) continue;
        patch->radiance = rgb_add(patch->radiance, t.radiance);
        known++;
        shown += t.source == LIGHT_TEXTURE;
    }
    if (known) patch->radiance = rgb_scale(patch->radiance, 1.0 / known);
    patch->photographed = n ? (double)shown / n : 0;
}

/* The patch of a cell; its area is the number of its places until those of the face are known. */
static enum status cut_cell(struct light_patches *p, int face, const struct outline *o, int column, int row,
                            struct err *err)
{
    struct patch_cells *c = &p->cells[face];
    struct light_patch patch = {.face = face, .owner = -1, .sample = p->sample_count};
    for (int k = 0; !err->status && k < SAMPLES * SAMPLES; k++) {
        const double x = c->low[0] + c->step[0] * (column + (k % SAMPLES + 0.5) / SAMPLES);
        const double y = c->low[1] + c->step[1] * (row + ((k / SAMPLES) + 0.5) / SAMPLES);
        if (outline_holds(o, x, y)) add_sample(p, on_plane(&p->field->model.mesh.faces[face], c, x, y), err);
    }
    patch.sample_count = p->sample_count - patch.sample;
    if (err->status || !patch.sample_count) return err->status;
    patch.area = patch.sample_count;
    finish_patch(p, &patch);
    c->patch[row * c->columns + column] = p->count;
    return add_patch(p, patch, err);
}

/* Cells without a patch take that of the nearest cell. */
static void fill_cells(struct patch_cells *c)
{
    for (bool changed = true; changed;) {
        changed = false;
        for (int i = 0; i < c->columns * c->rows; i++) {
            const int x = i % c->columns, y = i / c->columns;
            if (c->patch[i] >= 0) continue;
            int found = -1;
            if (x > 0) found = c->patch[i - 1];
            if (found < 0 && x + 1 < c->columns) found = c->patch[i + 1];
            if (found < 0 && y > 0) found = c->patch[i - c->columns];
            if (found < 0 && y + 1 < c->rows) found = c->patch[i + c->columns];
            if (found < 0) continue;
            c->patch[i] = found;
            changed = true;
        }
    }
}

static enum status add_narrow(struct light_patches *p, int face, struct err *err)
{
    const struct vec3 at = some_place(&p->field->model.mesh, face);
    struct light_patch patch = {.face = face, .owner = -1, .area = 1, .sample = p->sample_count, .sample_count = 1};
    p->cells[face].patch[0] = p->count;
    if (add_sample(p, at, err)) return err->status;
    finish_patch(p, &patch);
    return add_patch(p, patch, err);
}

static enum status cut_face(struct light_patches *p, int face, struct err *err)
{
    const struct solid_mesh *m = &p->field->model.mesh;
    struct patch_cells *c = &p->cells[face];
    struct outline o;
    double high[2], places = 0;
    const int before = p->count;
    set_frame(c, m, face, high);
    c->columns = (int)fmax(1, round((high[0] - c->low[0]) / p->side));
    c->rows = (int)fmax(1, round((high[1] - c->low[1]) / p->side));
    c->step[0] = (high[0] - c->low[0]) / c->columns;
    c->step[1] = (high[1] - c->low[1]) / c->rows;
    const size_t cells = (size_t)c->columns * (size_t)c->rows;
    c->patch = malloc(cells * sizeof *c->patch);
    if (!c->patch) return err_nomem(err, "cells of a face", cells * sizeof *c->patch);
    for (size_t i = 0; i < cells; i++) c->patch[i] = -1;
    if (outline_make(&o, m, face, c, err)) return err->status;
    for (int row = 0; !err->status && row < c->rows; row++)
        for (int column = 0; !err->status && column < c->columns; column++) cut_cell(p, face, &o, column, row, err);
    if (!err->status && p->count == before) add_narrow(p, face, err);
    for (int i = before; i < p->count; i++) places += p->list[i].area;
    for (int i = before; i < p->count; i++) p->list[i].area *= solid_mesh_area(m, face) / places;
    if (!err->status) fill_cells(c);
    free(o.edges);
    return err->status;
}

/* ------------------------------------------------------------------------------------- patches of further surfaces */

struct surface_key {
    int owner, cell[3], facing; /* facing: 0 to 5, the axis and its sign */
    int triangle, side;
};

static int compare_places(const struct surface_key *a, const struct surface_key *b)
{
    if (a->owner != b->owner) return a->owner < b->owner ? -1 : 1;
    for (int k = 0; k < 3; k++)
        if (a->cell[k] != b->cell[k]) return a->cell[k] < b->cell[k] ? -1 : 1;
    return (a->facing > b->facing) - (a->facing < b->facing);
}

static int compare_keys(const void *x, const void *y)
{
    const struct surface_key *a = x, *b = y;
    const int places = compare_places(a, b);
    return places ? places : (a->triangle > b->triangle) - (a->triangle < b->triangle);
}

static struct vec3 triangle_cross(const struct vec3 t[3])
{
    return vec3_cross(vec3_sub(t[1], t[0]), vec3_sub(t[2], t[0]));
}

static struct surface_key key_of(const struct light_patches *p, int triangle, int side, int owner)
{
    const struct vec3 *t = p->field->surfaces->triangles.triangles[triangle];
    const struct vec3 middle = vec3_scale(vec3_add(t[0], vec3_add(t[1], t[2])), 1.0 / 3);
    const struct vec3 n = vec3_scale(triangle_cross(t), side ? -1 : 1);
    const double at[3] = {middle.x, middle.y, middle.z}, way[3] = {n.x, n.y, n.z};
    struct surface_key key = {.owner = owner, .triangle = triangle, .side = side};
    int axis = 0;
    for (int k = 0; k < 3; k++) {
        key.cell[k] = (int)floor(at[k] / p->side);
        if (fabs(way[k]) > fabs(way[axis])) axis = k;
    }
    key.facing = 2 * axis + (way[axis] < 0);
    return key;
}

static void set_origin(const struct light_patches *p, struct light_patch *patch, const struct surface_key *key)
{
    const struct vec3 *t = p->field->surfaces->triangles.triangles[key->triangle];
    const struct vec3 n = vec3_normalize(triangle_cross(t));
    patch->origins[patch->origin_count++] = (struct gather_point){
        vec3_scale(vec3_add(t[0], vec3_add(t[1], t[2])), 1.0 / 3), key->side ? vec3_scale(n, -1) : n};
}

/* Triangles keys[0 .. count - 1] are a patch; some of them, evenly by area, have its places. */
static enum status group_triangles(struct light_patches *p, const struct surface_key *keys, int count, struct err *err)
{
    const struct field_surfaces *s = p->field->surfaces;
    struct light_patch patch = {.face = -1, .owner = keys[0].owner, .photographed = 1};
    double sum = 0;
    for (int i = 0; i < count; i++) {
        const double area = 0.5 * vec3_length(triangle_cross(s->triangles.triangles[keys[i].triangle]));
        patch.radiance = rgb_add(patch.radiance, rgb_scale(s->radiance[keys[i].triangle][keys[i].side], area));
        patch.area += area;
        p->of_surface[keys[i].triangle][keys[i].side] = p->count;
    }
    if (!(patch.area > 0)) {
        for (int i = 0; i < count; i++) p->of_surface[keys[i].triangle][keys[i].side] = -1;
        return ST_OK;
    }
    patch.radiance = rgb_scale(patch.radiance, 1 / patch.area);
    const int origins = count < PATCH_ORIGINS ? count : PATCH_ORIGINS;
    for (int i = 0; i < count && patch.origin_count < origins; i++) {
        sum += 0.5 * vec3_length(triangle_cross(s->triangles.triangles[keys[i].triangle]));
        if (sum * origins > patch.area * (patch.origin_count + 0.5)) set_origin(p, &patch, &keys[i]);
    }
    return add_patch(p, patch, err);
}

static enum status cut_surfaces(struct light_patches *p, patch_owner_fn *owner, const void *ctx, struct err *err)
{
    const int triangles = p->field->surfaces->triangles.count;
    struct surface_key *keys = malloc((2 * (size_t)triangles + 1) * sizeof *keys);
    int count = 0;
    p->of_surface = malloc(((size_t)triangles + 1) * sizeof *p->of_surface);
    if (!keys || !p->of_surface) err_nomem(err, "triangles", (size_t)triangles * sizeof *keys);
    for (int i = 0; !err->status && i < triangles; i++) {
        const struct patch_owner o = owner(ctx, i);
        p->of_surface[i][0] = p->of_surface[i][1] = -1;
        keys[count++] = key_of(p, i, 0, o.owner);
        if (o.two_sided) keys[count++] = key_of(p, i, 1, o.owner);
    }
    if (!err->status && count) qsort(keys, (size_t)count, sizeof *keys, compare_keys);
    for (int i = 0, next; !err->status && i < count; i = next) {
        for (next = i + 1; next < count && !compare_places(&keys[i], &keys[next]);) next++;
        group_triangles(p, keys + i, next - i, err);
    }
    free(keys);
    return err->status;
}

/* -------------------------------------------------------------------------------------------------------------- all */

static double surface_area(const struct model_field *f)
{
    double area = 0;
    for (int i = 0; f->surfaces && i < f->surfaces->triangles.count; i++)
        area += 0.5 * vec3_length(triangle_cross(f->surfaces->triangles.triangles[i]));
    return area;
}

enum status patches_make(struct light_patches *p, const struct model_field *field, int wanted, patch_owner_fn *owner,
                         const void *ctx, struct err *err)
{
    const struct solid_mesh *m = &field->model.mesh;
    bool *chosen = calloc((size_t)m->face_count + 1, sizeof *chosen);
    double area = surface_area(field);
    *p = (struct light_patches){.field = field, .cells = calloc((size_t)m->face_count + 1, sizeof *p->cells)};
    if (!chosen || !p->cells) err_nomem(err, "faces", (size_t)m->face_count * sizeof *p->cells);
    if (!err->status) choose_faces(chosen, field, err);
    for (int i = 0; !err->status && i < m->face_count; i++)
        if (chosen[i]) area += solid_mesh_area(m, i);
    p->side = area > 0 ? sqrt(area / wanted) : 1;
    for (int i = 0; !err->status && i < m->face_count; i++)
        if (chosen[i]) cut_face(p, i, err);
    p->face_patches = p->count;
    if (!err->status && field->surfaces) cut_surfaces(p, owner, ctx, err);
    free(chosen);
    return err->status;
}

void patches_release(struct light_patches *p)
{
    for (int i = 0; p->cells && i < p->field->model.mesh.face_count; i++) free(p->cells[i].patch);
    free(p->cells);
    free(p->of_surface);
    free(p->list);
    free(p->samples);
    *p = (struct light_patches){0};
}

int patches_at(const struct light_patches *p, int face, struct vec3 at)
{
    const struct patch_cells *c = &p->cells[face];
    if (!c->patch) return -1;
    int x = 0, y = 0;
    if (c->step[0] > 0) x = (int)fmin(fmax((vec3_dot(c->u, at) - c->low[0]) / c->step[0], 0), c->columns - 1);
    if (c->step[1] > 0) y = (int)fmin(fmax((vec3_dot(c->v, at) - c->low[1]) / c->step[1], 0), c->rows - 1);
    return c->patch[y * c->columns + x];
}

int patches_hit(const struct light_patches *p, const struct ray_hit *hit)
{
    const int faces = p->field->model.mesh.face_count;
    if ((int)hit->id >= faces) return p->of_surface[(int)hit->id - faces][!hit->front];
    return hit->front ? patches_at(p, (int)hit->id, hit->point) : -1;
}
