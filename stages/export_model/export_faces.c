/* export_faces.c - cuts faces by the tiles that texture them; see export_faces.h.
 *
 * A triangle of the model is a convex polygon that the rules of its face take pieces from, in order (texture_map.h).
 * The part of a piece that lies in a tile, half a texel from its rectangle's border, gets the tile's pixels as texture
 * coordinates; these are affine in a view-independent atlas. A piece beyond all tiles repeats the border of the nearest
 * one: it is cut along the four lines of the rectangle, so that in each part the clamped coordinates are affine, too.
 * What no rule covers is of one colour. */
#include "stages/export_model/export_faces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"

enum { MAX_CORNERS = 24, MAX_PIECES = 4096 };

static const double inset = 0.5; /* texels: bilinear reading stays inside the tile */
static const double tiny = 1e-9; /* model units, and texels: nearer is on the line */
static const float no_texture[3] = {0.75F, 0.75F, 0.75F};

struct piece { /* a convex polygon */
    struct vec3 p[MAX_CORNERS];
    int count;
};

struct pieces {
    struct piece *list; /* owned */
    int count;
};

struct work {
    struct export_faces *out;
    const struct solid_mesh *mesh;
    const struct atlas *vita;
    int face;
    struct err *err;
};

void export_faces_release(struct export_faces *faces)
{
    free(faces->triangles);
    free(faces->first);
    *faces = (struct export_faces){0};
}

/* --------------------------------------------------------------------------------------------------------- pieces */

static enum status add_piece(struct pieces *to, const struct piece *piece, struct err *err)
{
    if (piece->count < 3) return ST_OK;
    if (to->count == MAX_PIECES) return err_set(err, ST_DATA, "a face is cut into more than %d pieces.", MAX_PIECES);
    if (array_append(&to->list, (size_t)to->count, sizeof *to->list, "pieces of faces", err)) return err->status;
    to->list[to->count++] = *piece;
    return ST_OK;
}

/* A value that is affine over the plane: it is 0 on a line. */
struct cut {
    struct vec3 n;
    double c;
};

static double above(const struct cut *cut, struct vec3 p) { return vec3_dot(cut->n, p) - cut->c; }

/* Splits a piece into the part where the cut's value is at least 0, and the rest. */
static void split(struct piece *in, struct piece *out, const struct piece *piece, const struct cut *cut)
{
    in->count = out->count = 0;
    const double scale = fmax(vec3_length(cut->n), 1e-300);
    for (int i = 0; i < piece->count; i++) {
        const struct vec3 a = piece->p[i], b = piece->p[(i + 1) % piece->count];
        double da = above(cut, a) / scale, db = above(cut, b) / scale;
        if (fabs(da) <= tiny) da = 0;
        if (fabs(db) <= tiny) db = 0;
        if (da >= 0 && in->count < MAX_CORNERS) in->p[in->count++] = a;
        if (da <= 0 && out->count < MAX_CORNERS) out->p[out->count++] = a;
        if (da * db >= 0) continue;
        const struct vec3 cross = vec3_add(a, vec3_scale(vec3_sub(b, a), da / (da - db)));
        if (in->count < MAX_CORNERS) in->p[in->count++] = cross;
        if (out->count < MAX_CORNERS) out->p[out->count++] = cross;
    }
    bool inside = false, outside = false;
    for (int i = 0; i < piece->count; i++) {
        inside |= above(cut, piece->p[i]) > tiny * scale;
        outside |= above(cut, piece->p[i]) < -tiny * scale;
    }
    if (!inside) in->count = 0;
    if (!outside) out->count = 0;
    if (!inside && !outside) *in = *piece;
}

/* The part of a piece within all cuts; what is outside goes to `rest`. */
static enum status cut_out(struct piece *inside, struct pieces *rest, const struct piece *piece, const struct cut *cuts,
                           int count, struct err *err)
{
    *inside = *piece;
    for (int i = 0; !err->status && i < count && inside->count; i++) {
        struct piece in, out;
        split(&in, &out, inside, &cuts[i]);
        add_piece(rest, &out, err);
        *inside = in;
    }
    return err->status;
}

static enum status add_triangles(const struct work *w, const struct piece *piece, int material, const double (*uv)[2],
                                 const float *albedo)
{
    struct export_faces *to = w->out;
    for (int i = 1; i + 1 < piece->count; i++) {
        const int corner[3] = {0, i, i + 1};
        struct export_triangle t = {.material = material, .face = w->face};
        for (int k = 0; k < 3; k++) {
            t.p[k] = piece->p[corner[k]];
            if (uv) memcpy(t.uv[k], uv[corner[k]], sizeof t.uv[k]);
        }
        if (albedo) memcpy(t.albedo, albedo, sizeof t.albedo);
        if (vec3_length(vec3_cross(vec3_sub(t.p[1], t.p[0]), vec3_sub(t.p[2], t.p[0]))) < 1e-14) continue;
        if (array_append(&to->triangles, (size_t)to->count, sizeof *to->triangles, "triangles", w->err))
            return w->err->status;
        to->triangles[to->count++] = t;
    }
    return ST_OK;
}

/* ---------------------------------------------------------------------------------------------------------- tiles */

/* Page pixels of a tile as affine functions of a point of the edited model: (x, y) = rows . (p, 1). */
struct page_map {
    double rows[2][4];
};

static struct page_map page_map_of(const struct atlas_tile *tile, const struct texture_rule *rule)
{
    struct page_map m;
    const double w = tile->matrix[2][3]; /* of an orthogonal tile, whose third row is 0 0 0 w */
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < 4; k++) {
            m.rows[i][k] = k == 3 ? tile->matrix[i][3] / w : 0;
            for (int j = 0; j < 3; j++) m.rows[i][k] += tile->matrix[i][j] / w * rule->matrix[j][k];
        }
    }
    return m;
}

static double page_pixel(const struct page_map *m, int axis, struct vec3 p)
{
    const double *r = m->rows[axis];
    return r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3];
}

/* sign * pixel >= sign * at */
static struct cut pixel_cut(const struct page_map *m, int axis, double at, double sign)
{
    const double *r = m->rows[axis];
    return (struct cut){vec3_make(sign * r[0], sign * r[1], sign * r[2]), sign * (at - r[3])};
}

static void tile_range(double range[2], const struct atlas_tile *tile, int axis)
{
    const int first = axis ? tile->y : tile->x, size = axis ? tile->height : tile->width;
    const double in = fmin(inset, size / 2.0);
    range[0] = first + in;
    range[1] = first + size - in;
}

static enum status add_textured(const struct work *w, const struct piece *piece, const struct atlas_tile *tile,
                                const struct page_map *m)
{
    const int *size = w->vita->page_sizes[tile->page];
    double uv[MAX_CORNERS][2];
    for (int i = 0; i < piece->count; i++)
        for (int axis = 0; axis < 2; axis++) {
            double range[2];
            tile_range(range, tile, axis);
            uv[i][axis] = fmin(fmax(page_pixel(m, axis, piece->p[i]), range[0]), range[1]) / size[axis];
        }
    return add_triangles(w, piece, tile->page, (const double(*)[2])uv, NULL);
}

static void tile_cuts(struct cut cuts[4], const struct atlas_tile *tile, const struct page_map *m)
{
    for (int axis = 0; axis < 2; axis++) {
        double range[2];
        tile_range(range, tile, axis);
        cuts[2 * axis] = pixel_cut(m, axis, range[0], 1);
        cuts[2 * axis + 1] = pixel_cut(m, axis, range[1], -1);
    }
}

/* The parts of the pieces that the rule's tiles hold; the others stay in `pieces`. */
static enum status take_place(const struct work *w, struct pieces *pieces, const struct texture_rule *rule)
{
    for (int t = atlas_first_tile(w->vita, rule->from); !w->err->status && t < w->vita->tile_count; t++) {
        const struct atlas_tile *tile = &w->vita->tiles[t];
        if (tile->face != rule->from) break;
        const struct page_map m = page_map_of(tile, rule);
        struct pieces rest = {0};
        struct cut cuts[4];
        tile_cuts(cuts, tile, &m);
        for (int i = 0; !w->err->status && i < pieces->count; i++) {
            struct piece inside;
            if (!cut_out(&inside, &rest, &pieces->list[i], cuts, 4, w->err)) add_textured(w, &inside, tile, &m);
        }
        free(pieces->list);
        *pieces = rest;
    }
    return w->err->status;
}

/* How far a piece's middle lies outside of a tile, texels. */
static double outside_by(const struct piece *piece, const struct atlas_tile *tile, const struct page_map *m)
{
    struct vec3 middle = {0, 0, 0};
    double square = 0;
    for (int i = 0; i < piece->count; i++) middle = vec3_add(middle, vec3_scale(piece->p[i], 1.0 / piece->count));
    for (int axis = 0; axis < 2; axis++) {
        double range[2];
        tile_range(range, tile, axis);
        const double x = page_pixel(m, axis, middle), off = fmax(0, fmax(range[0] - x, x - range[1]));
        square += off * off;
    }
    return square;
}

static enum status add_clamped(const struct work *w, const struct piece *piece, const struct atlas_tile *tile,
                               const struct page_map *m)
{
    struct pieces parts = {0};
    struct cut cuts[4];
    add_piece(&parts, piece, w->err);
    tile_cuts(cuts, tile, m);
    for (int c = 0; !w->err->status && c < 4; c++) {
        struct pieces next = {0};
        for (int i = 0; !w->err->status && i < parts.count; i++) {
            struct piece in, out;
            split(&in, &out, &parts.list[i], &cuts[c]);
            if (!add_piece(&next, &in, w->err)) add_piece(&next, &out, w->err);
        }
        free(parts.list);
        parts = next;
    }
    for (int i = 0; !w->err->status && i < parts.count; i++) add_textured(w, &parts.list[i], tile, m);
    free(parts.list);
    return w->err->status;
}

/* All pieces, from the border of the nearest tile; they stay if the face has no tile. */
static enum status take_edge(const struct work *w, struct pieces *pieces, const struct texture_rule *rule)
{
    const int first = atlas_first_tile(w->vita, rule->from);
    if (first == w->vita->tile_count || w->vita->tiles[first].face != rule->from) return ST_OK;
    for (int i = 0; !w->err->status && i < pieces->count; i++) {
        const struct atlas_tile *best = NULL;
        struct page_map best_map = {{{0}}};
        double least = INFINITY;
        for (int t = first; t < w->vita->tile_count && w->vita->tiles[t].face == rule->from; t++) {
            const struct page_map m = page_map_of(&w->vita->tiles[t], rule);
            const double off = outside_by(&pieces->list[i], &w->vita->tiles[t], &m);
            if (off >= least) continue;
            least = off;
            best = &w->vita->tiles[t];
            best_map = m;
        }
        if (best) add_clamped(w, &pieces->list[i], best, &best_map);
    }
    pieces->count = 0;
    return w->err->status;
}

static enum status take_plain(const struct work *w, struct pieces *pieces, int material, const float *albedo)
{
    for (int i = 0; !w->err->status && i < pieces->count; i++)
        add_triangles(w, &pieces->list[i], material, NULL, albedo);
    pieces->count = 0;
    return w->err->status;
}

/* ---------------------------------------------------------------------------------------------------------- rules */

static enum status take(const struct work *w, struct pieces *pieces, const struct texture_rule *rule)
{
    switch (rule->kind) {
    case TEXTURE_PLACE:
        return take_place(w, pieces, rule);
    case TEXTURE_EDGE:
        return take_edge(w, pieces, rule);
    case TEXTURE_OUTDOORS:
        return take_plain(w, pieces, MATERIAL_GLASS, NULL);
    default:
        return take_plain(w, pieces, MATERIAL_COLOUR, rule->albedo);
    }
}

/* The parts of the pieces within a limited rule; the others wait for the next rule. */
static enum status take_limited(const struct work *w, struct pieces *pieces, const struct texture_rule *rule)
{
    const struct vec3 n = w->mesh->faces[w->face].normal, *q = rule->within;
    const double turn = vec3_dot(vec3_cross(vec3_sub(q[1], q[0]), vec3_sub(q[2], q[0])), n) < 0 ? -1 : 1;
    struct pieces inside = {0}, rest = {0};
    struct cut cuts[4];
    for (int i = 0; i < 4; i++) {
        const struct vec3 side = vec3_scale(vec3_cross(n, vec3_sub(q[(i + 1) % 4], q[i])), turn);
        cuts[i] = (struct cut){side, vec3_dot(side, q[i])};
    }
    for (int i = 0; !w->err->status && i < pieces->count; i++) {
        struct piece in;
        if (!cut_out(&in, &rest, &pieces->list[i], cuts, 4, w->err)) add_piece(&inside, &in, w->err);
    }
    if (!w->err->status) take(w, &inside, rule);
    for (int i = 0; !w->err->status && i < inside.count; i++) add_piece(&rest, &inside.list[i], w->err);
    free(inside.list);
    free(pieces->list);
    *pieces = rest;
    return w->err->status;
}

static enum status add_face(const struct work *w, const struct solid_triangles *triangles,
                            const struct texture_map *map)
{
    const int id = solid_face_id(w->mesh, w->face);
    const struct vec3 at = w->mesh->vertices[triangles->triangles[triangles->first[w->face]].v[0]].p;
    const bool pane = solid_face_is_pane(w->mesh, w->face);
    const struct texture_rule self[2] = {
        {.kind = pane ? TEXTURE_OUTDOORS : TEXTURE_PLACE,
         .from = id,
         .matrix = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}},
        {.kind = TEXTURE_EDGE, .from = id, .matrix = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}};
    const struct texture_face *of = map ? texture_map_find(map, id, at) : NULL;
    const struct texture_rule *rules = of ? of->rules : self;
    struct pieces pieces = {0};
    for (int i = triangles->first[w->face]; !w->err->status && i < triangles->first[w->face + 1]; i++) {
        struct piece piece = {.count = 3};
        for (int k = 0; k < 3; k++) piece.p[k] = w->mesh->vertices[triangles->triangles[i].v[k]].p;
        add_piece(&pieces, &piece, w->err);
    }
    for (int r = 0; !w->err->status && pieces.count && r < (of ? of->rule_count : 2); r++) {
        if (rules[r].limited)
            take_limited(w, &pieces, &rules[r]);
        else
            take(w, &pieces, &rules[r]);
    }
    if (!w->err->status) take_plain(w, &pieces, MATERIAL_COLOUR, no_texture);
    free(pieces.list);
    return w->err->status;
}

enum status export_faces_make(struct export_faces *faces, const struct solid_mesh *mesh, const struct texture_map *map,
                              const struct atlas *vita, struct err *err)
{
    struct solid_triangles triangles = {0};
    struct work w = {faces, mesh, vita, 0, err};
    *faces = (struct export_faces){0};
    faces->first = calloc((size_t)mesh->face_count + 1, sizeof *faces->first);
    if (faces->first)
        solid_mesh_triangulate(&triangles, mesh, err);
    else
        err_nomem(err, "faces", (size_t)mesh->face_count * sizeof *faces->first);
    for (w.face = 0; !err->status && w.face < mesh->face_count; w.face++) {
        add_face(&w, &triangles, map);
        faces->first[w.face + 1] = faces->count;
    }
    solid_triangles_release(&triangles);
    return err->status;
}
