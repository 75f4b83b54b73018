/* painted_room.h - shared by the tests of render_model: atlases of solids made of boxes, painted by a formula. */
#ifndef REMODEL_TESTS_PAINTED_ROOM_H
#define REMODEL_TESTS_PAINTED_ROOM_H

#include "tests/unit/box_solids.h"

#include "common/base/rng.h"
#include "common/math/lanes.h"
#include "common/texture/atlas.h"
#include "common/texture/outdoors.h"
#include "common/texture/texture_map.h"

enum { W = 96, H = 72 };

enum paint {
    FLAT,   /* one value */
    SMOOTH, /* a formula of the place */
    NOISE,  /* of the texel, as a photo's pixels */
};

static inline float half_of(double value) { return float_from_half(half_from_float((float)value)); }

static inline double smooth_value(struct vec3 p, int channel)
{
    return 2 + sin(1.3 * p.x + channel) + 0.5 * cos(1.7 * p.y - 0.4 * channel) * sin(p.z);
}

static inline float noise_value(const char *photo, int x, int y, int channel)
{
    const struct rng rng = rng_make(3, "photo", photo);
    return half_of(100 * pow(rng_uniform(&rng, (uint64_t)(y * W + x), (uint64_t)channel), 6));
}

/* The box around a face's corners. */
static inline void face_box(const struct solid_mesh *m, int face, double low[3], double high[3])
{
    const int first = m->loops[m->faces[face].loop].half_edge;
    int at = first;
    for (int k = 0; k < 3; k++) low[k] = INFINITY, high[k] = -INFINITY;
    do {
        const struct vec3 p = m->vertices[m->half_edges[at].origin].p;
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], vec3_axis(p, k));
            high[k] = fmax(high[k], vec3_axis(p, k));
        }
        at = m->half_edges[at].next;
    } while (at != first);
}

/* Where a pixel's ray meets the plane of a face, if that is in front of the camera and on the face. */
static inline bool meet_face(const struct solid_mesh *m, int face, const struct view *v, double x, double y,
                             struct vec3 *at)
{
    const struct solid_face *f = &m->faces[face];
    const struct vec3 d = vec3_sub(view_unproject(v, x, y, 1), v->center);
    const double t = (f->offset - vec3_dot(f->normal, v->center)) / vec3_dot(f->normal, d);
    double low[3], high[3];
    if (!(t > 0) || !isfinite(t)) return false;
    *at = vec3_add(v->center, vec3_scale(d, t));
    face_box(m, face, low, high);
    for (int k = 0; k < 3; k++)
        if (vec3_axis(*at, k) < low[k] - 1e-9 || vec3_axis(*at, k) > high[k] + 1e-9) return false;
    return true;
}

/* pinhole view -> the 3 x 4 matrix of a tile at (x, y) of a page that holds its pixels */
static inline void tile_matrix(double m[3][4], const struct view *v, int x, int y)
{
    for (int k = 0; k < 4; k++) {
        double row[3];
        for (int i = 0; i < 3; i++) row[i] = k < 3 ? v->cam_from_world.m[i][k] : vec3_axis(v->translation, i);
        m[0][k] = v->fx * row[0] + (v->cx + x) * row[2];
        m[1][k] = v->fy * row[1] + (v->cy + y) * row[2];
        m[2][k] = row[2];
    }
}

static inline char *copy_text(const char *text)
{
    char *copy = strdup(text);
    assert_non_null(copy);
    return copy;
}

static inline void set_texel(struct atlas_page *page, int x, int y, const float rgb[3], uint32_t source)
{
    const size_t at = (size_t)y * (size_t)page->width + (size_t)x;
    for (int c = 0; c < 3; c++) page->rgb[3 * at + (size_t)c] = half_of(rgb[c]);
    page->source[at] = source;
}

static inline void paint_at(float rgb[3], enum paint paint, double value, const char *photo, struct vec3 p, int x,
                            int y)
{
    for (int c = 0; c < 3; c++)
        rgb[c] = paint == FLAT     ? (float)value
                 : paint == SMOOTH ? (float)smooth_value(p, c)
                                   : noise_value(photo, x, y, c);
}

/* Packs an atlas whose tiles have sizes, lets `fill` set each tile's texels, writes it to the scratch folder `folder`,
 * and releases it. */
static inline void write_atlas(struct atlas *a, const char *folder,
                               void (*fill)(void *ctx, struct atlas_tile *t, struct atlas_page *page), void *ctx)
{
    const struct provenance prov = {.stage = "test", .version = "1"};
    struct err err = ERR_INIT;
    assert_ok(atlas_pack(a, &err), err);
    struct atlas_page *pages = calloc((size_t)a->page_count, sizeof *pages);
    assert_non_null(pages);
    for (int i = 0; i < a->page_count; i++)
        assert_ok(atlas_page_init(&pages[i], a->page_sizes[i][0], a->page_sizes[i][1], &err), err);
    for (int i = 0; i < a->tile_count; i++) fill(ctx, &a->tiles[i], &pages[a->tiles[i].page]);
    mkdir(folder, 0777);
    assert_ok(atlas_write(a, pages, folder, &prov, &err), err);
    for (int i = 0; i < a->page_count; i++) atlas_page_release(&pages[i]);
    free(pages);
    atlas_release(a);
}

struct painting {
    const struct solid_mesh *mesh;
    const struct view *view; /* of a viewpoint */
    const char *photo;
    enum paint paint;
    double value, texel; /* texel: side, of a VITA */
    uint32_t source;
};

static inline int face_of_id(const struct solid_mesh *m, int id)
{
    for (int i = 0; i < m->face_count; i++)
        if (solid_face_id(m, i) == id) return i;
    fail_msg("no face has id %d", id);
    return 0;
}

static inline void fill_view(void *ctx, struct atlas_tile *t, struct atlas_page *page)
{
    const struct painting *g = ctx;
    const int face = face_of_id(g->mesh, t->face);
    tile_matrix(t->matrix, g->view, t->x, t->y);
    for (int y = 0; y < t->height; y++)
        for (int x = 0; x < t->width; x++) {
            struct vec3 p;
            float rgb[3];
            if (!meet_face(g->mesh, face, g->view, x + 0.5, y + 0.5, &p)) continue;
            paint_at(rgb, g->paint, g->value, g->photo, p, x, y);
            set_texel(page, t->x + x, t->y + y, rgb, g->source);
        }
}

/* The atlas of viewpoint `photo`, of one view: SCRATCH/vdta/PHOTO. Every face is shown, hidden or not. */
static inline void paint_viewpoint(const struct solid_mesh *mesh, const struct view *view, const char *photo,
                                   enum paint paint, double value)
{
    char folder[512];
    struct painting g = {mesh, view, photo, paint, value, 0, ATLAS_VIEWS};
    struct atlas a = {.viewpoint = copy_text(photo), .centre = view->center};
    a.views = calloc(1, sizeof *a.views);
    a.sources = calloc(1, sizeof *a.sources);
    a.tiles = calloc((size_t)mesh->face_count, sizeof *a.tiles);
    assert_true(a.views && a.sources && a.tiles);
    a.views[a.view_count++] = copy_text(photo);
    a.sources[a.source_count++] = copy_text(photo);
    for (int i = 0; i < mesh->face_count; i++)
        a.tiles[a.tile_count++] =
            (struct atlas_tile){.face = solid_face_id(mesh, i), .width = view->width, .height = view->height};
    mkdir(scratch_path("vdta"), 0777);
    snprintf(folder, sizeof folder, "%s/%s", scratch_path("vdta"), photo);
    write_atlas(&a, folder, fill_view, &g);
}

static inline void fill_face(void *ctx, struct atlas_tile *t, struct atlas_page *page)
{
    const struct painting *g = ctx;
    const int face = face_of_id(g->mesh, t->face);
    const struct vec3 n = g->mesh->faces[face].normal;
    const int axis = fabs(n.x) > 0.5 ? 0 : fabs(n.y) > 0.5 ? 1 : 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    double low[3], high[3];
    face_box(g->mesh, face, low, high);
    memset(t->matrix, 0, sizeof t->matrix);
    t->matrix[0][u] = 1 / g->texel, t->matrix[0][3] = t->x + 1 - low[u] / g->texel;
    t->matrix[1][v] = 1 / g->texel, t->matrix[1][3] = t->y + 1 - low[v] / g->texel;
    t->matrix[2][3] = 1;
    for (int y = 0; y < t->height; y++)
        for (int x = 0; x < t->width; x++) {
            double at[3];
            float rgb[3];
            at[axis] = low[axis];
            at[u] = low[u] + (x - 0.5) * g->texel;
            at[v] = low[v] + (y - 0.5) * g->texel;
            paint_at(rgb, g->paint, g->value, "vita", vec3_make(at[0], at[1], at[2]), x, y);
            set_texel(page, t->x + x, t->y + y, rgb, g->source);
        }
}

/* SCRATCH/vita; every face has a margin of one texel. */
static inline void paint_vita(const struct solid_mesh *mesh, enum paint paint, double value, double texel)
{
    struct painting g = {mesh, NULL, NULL, paint, value, texel, ATLAS_VIEWS};
    struct atlas a = {.tiles = calloc((size_t)mesh->face_count, sizeof *a.tiles)};
    a.sources = calloc(1, sizeof *a.sources);
    assert_true(a.tiles && a.sources);
    a.sources[a.source_count++] = copy_text("some view");
    for (int i = 0; i < mesh->face_count; i++) {
        const struct vec3 n = mesh->faces[i].normal;
        const int axis = fabs(n.x) > 0.5 ? 0 : fabs(n.y) > 0.5 ? 1 : 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        double low[3], high[3];
        face_box(mesh, i, low, high);
        a.tiles[a.tile_count++] = (struct atlas_tile){.face = solid_face_id(mesh, i),
                                                      .view = -1,
                                                      .width = (int)ceil((high[u] - low[u]) / texel) + 2,
                                                      .height = (int)ceil((high[v] - low[v]) / texel) + 2};
    }
    write_atlas(&a, scratch_path("vita"), fill_face, &g);
}

#endif
