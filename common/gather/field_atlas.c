/* field_atlas.c - see field_atlas.h.
 *
 * Memory. A gather meets texels in no order, so that most look-ups miss the caches; a texel is one 8-byte load, that is
 * one line of 64 bytes, where three floats and a source would be two loads from two arrays. All pages are kept: 8 MiB
 * for a page of 1024 x 1024. The nearest texel stands for its square. A gather integrates, and the integral of texels
 * is that of their bilinear interpolation but for the border of a face. The fourth 16-bit number of a texel has its
 * enum light_source in 3 bits, one bit that says that it is marked, and 12 bits for the mark or, without one, for 1 +
 * the index of the view that the texel comes from, 0 where that is unknown.
 *
 * Lamps. A photograph shows a lamp as a bright spot on the ceiling. Where lights.txt declares it, a gather sees the
 * lamp's radiance, and the spot must not light the room once more. Photographs place the spot to a few texels only, and
 * optics blur it, so that a bright rim remains around the lamp. A lamp of 10 cm is a thousand times as bright as the
 * ceiling: a rim of one texel would add a tenth of its light. So texels up to GUARD times the lamp's radius, and at
 * least GUARD_TEXELS, around it take the colour of those in a ring around that, in which the median leaves out other
 * lamps. A lamp that hangs below the ceiling appears there shifted, a view at an angle t from the normal by tan(t) of
 * the distance: the guard grows by PARALLAX times that distance. */
#include "common/gather/field_atlas.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/math/lanes.h"
#include "common/math/numbers.h"

enum { GUARD_TEXELS = 4 };
static const double GUARD = 0.5, PARALLAX = 2;
static const double ALIKE = 0.7; /* cosine between the normals of a lamp and of a face that it may hang from */

enum { SOURCE = 7, MARKED = 8, NUMBER = 4 }; /* bits of texel.what; the number begins at bit NUMBER */

struct texel {
    uint16_t rgb[3], what;
};
_Static_assert(sizeof(struct texel) == sizeof(uint64_t), "a texel is one load");
_Static_assert(LIGHT_SOURCES <= SOURCE + 1 && FIELD_ATLAS_MARKS << NUMBER == 1 << 16, "what fits in 16 bits");

static struct texel unpack(uint64_t bits)
{
    struct texel t;
    memcpy(&t, &bits, sizeof t);
    return t;
}

static uint64_t pack(struct texel t)
{
    uint64_t bits;
    memcpy(&bits, &t, sizeof bits);
    return bits;
}

static enum light_source source_of(uint64_t bits) { return (enum light_source)(unpack(bits).what & SOURCE); }

static struct rgb radiance_of(uint64_t bits)
{
    uint16_t half[4];
    memcpy(half, &bits, sizeof half);
    const f32x4 v = f32x4_from_half(half);
    return rgb_make((double)v[0], (double)v[1], (double)v[2]);
}

/* ---------------------------------------------------------------------------------------------------------- reading */

static uint64_t pack_texel(const float rgb[3], uint32_t source)
{
    struct texel t = {{0, 0, 0}, LIGHT_NONE};
    if (source == ATLAS_NONE) return pack(t);
    uint16_t half[4];
    f32x4_to_half(half, (f32x4){rgb[0], rgb[1], rgb[2]});
    memcpy(&t, half, sizeof t);
    t.what = source < ATLAS_VIEWS ? LIGHT_SYNTHESISED : LIGHT_TEXTURE;
    const uint32_t number = source < ATLAS_VIEWS ? 0 : 1 + source - ATLAS_VIEWS;
    if (number < FIELD_ATLAS_MARKS) t.what = (uint16_t)(t.what | number << NUMBER);
    return pack(t);
}

static enum status pack_page(struct field_atlas *a, int page, const struct atlas_page *p, struct err *err)
{
    const size_t texels = (size_t)p->width * (size_t)p->height;
    a->pages[page] = malloc((texels + 1) * sizeof **a->pages);
    if (!a->pages[page]) return err_nomem(err, "a page of texels", texels * sizeof **a->pages);
    for (size_t i = 0; i < texels; i++) a->pages[page][i] = pack_texel(p->rgb + 3 * i, p->source[i]);
    return ST_OK;
}

static enum status read_page(struct field_atlas *a, int page, const char *folder, struct provenance *prov,
                             struct err *err)
{
    struct atlas_page p = {0};
    if (!atlas_page_read(&p, &a->atlas, page, folder, prov, err)) pack_page(a, page, &p, err);
    atlas_page_release(&p);
    return err->status;
}

/* VITA tiles only scale: the third row of their matrices is 0 0 0 1. */
static enum status check_tiles(const struct field_atlas *a, const char *folder, struct err *err)
{
    for (int i = 0; i < a->atlas.tile_count; i++) {
        const double *w = a->atlas.tiles[i].matrix[2];
        if (w[0] == 0 && w[1] == 0 && w[2] == 0 && w[3] == 1) continue;
        return err_set(err, ST_DATA,
                       "%s/atlas.txt: tile %d of face %d is a view's, wanted an atlas of orthogonal tiles; give the "
                       "folder of the VITA.",
                       folder, i + 1, a->atlas.tiles[i].face);
    }
    return ST_OK;
}

static enum status index_faces(struct field_atlas *a, int ids, struct err *err)
{
    a->ids = ids;
    free(a->first);
    a->first = malloc(((size_t)ids + 1) * sizeof *a->first);
    if (!a->first) return err_nomem(err, "faces", (size_t)ids * sizeof *a->first);
    for (int id = 0; id <= ids; id++) a->first[id] = atlas_first_tile(&a->atlas, id);
    return ST_OK;
}

enum status field_atlas_read(struct field_atlas *a, const char *folder, int ids, struct provenance *prov,
                             struct err *err)
{
    *a = (struct field_atlas){0};
    if (atlas_read(&a->atlas, folder, prov, err) || check_tiles(a, folder, err) || index_faces(a, ids, err))
        return err->status;
    a->pages = calloc((size_t)a->atlas.page_count + 1, sizeof *a->pages);
    if (!a->pages) return err_nomem(err, "pages", (size_t)a->atlas.page_count * sizeof *a->pages);
    for (int i = 0; i < a->atlas.page_count; i++)
        if (read_page(a, i, folder, prov, err)) return err->status;
    return ST_OK;
}

void field_atlas_release(struct field_atlas *a)
{
    if (!a) return;
    for (int i = 0; a->pages && i < a->atlas.page_count; i++) free(a->pages[i]);
    free(a->pages);
    free(a->first);
    atlas_release(&a->atlas);
    *a = (struct field_atlas){0};
}

/* -------------------------------------------------------------------------------------------------------- replacing */

static int by_face(const void *a, const void *b)
{
    const struct atlas_tile *s = a, *t = b;
    if (s->face != t->face) return s->face < t->face ? -1 : 1;
    if (s->page != t->page) return s->page < t->page ? -1 : 1;
    if (s->y != t->y) return s->y < t->y ? -1 : 1;
    return s->x < t->x ? -1 : s->x > t->x;
}

enum status field_atlas_replace(struct field_atlas *a, const bool *dropped, const struct atlas *extra,
                                const struct atlas_page *pages, struct err *err)
{
    struct atlas *to = &a->atlas;
    const int page_count = to->page_count + extra->page_count;
    const size_t tiles = (size_t)to->tile_count + (size_t)extra->tile_count + 1;
    struct atlas_tile *list = malloc(tiles * sizeof *list);
    int(*sizes)[2] = calloc((size_t)page_count + 1, sizeof *sizes), count = 0;
    uint64_t **all = calloc((size_t)page_count + 1, sizeof *all);
    if (!list || !sizes || !all) err_nomem(err, "tiles", tiles * sizeof *list);
    for (int i = 0; !err->status && i < to->tile_count; i++)
        if (!dropped[to->tiles[i].face]) list[count++] = to->tiles[i];
    for (int i = 0; !err->status && i < extra->tile_count; i++) {
        list[count] = extra->tiles[i];
        list[count++].page += to->page_count;
    }
    for (int i = 0; !err->status && i < page_count; i++) {
        const int *size = i < to->page_count ? to->page_sizes[i] : extra->page_sizes[i - to->page_count];
        sizes[i][0] = size[0], sizes[i][1] = size[1];
        if (i < to->page_count) all[i] = a->pages[i];
    }
    if (err->status) {
        free(list);
        free(sizes);
        free(all);
        return err->status;
    }
    const int first = to->page_count;
    free(to->tiles);
    free(to->page_sizes);
    free(a->pages);
    qsort(list, (size_t)count, sizeof *list, by_face);
    to->tiles = list, to->tile_count = count;
    to->page_sizes = sizes, to->page_count = page_count;
    a->pages = all;
    for (int i = 0; !err->status && i < extra->page_count; i++) pack_page(a, first + i, &pages[i], err);
    if (!err->status) index_faces(a, a->ids, err);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- look-up */

static double along(const double row[4], struct vec3 p) { return row[0] * p.x + row[1] * p.y + row[2] * p.z + row[3]; }

static uint64_t *texel_at(const struct field_atlas *a, const struct atlas_tile *t, int x, int y)
{
    return a->pages[t->page] + (size_t)y * (size_t)a->atlas.page_sizes[t->page][0] + (size_t)x;
}

bool field_atlas_find(const struct field_atlas *a, int face, struct vec3 p, int *page, size_t *texel)
{
    if (face < 0 || face >= a->ids) return false;
    for (int i = a->first[face]; i < a->first[face + 1]; i++) {
        const struct atlas_tile *t = &a->atlas.tiles[i];
        const double x = along(t->matrix[0], p) - t->x, y = along(t->matrix[1], p) - t->y;
        if (!(x >= 0 && y >= 0 && x < t->width && y < t->height)) continue;
        const uint64_t *at = texel_at(a, t, t->x + (int)x, t->y + (int)y);
        if (source_of(*at) == LIGHT_NONE) continue;
        *page = t->page;
        *texel = (size_t)(at - a->pages[t->page]);
        return true;
    }
    return false;
}

struct field_texel field_atlas_look(const struct field_atlas *a, int face, struct vec3 p)
{
    int page;
    size_t texel;
    if (!field_atlas_find(a, face, p, &page, &texel)) return (struct field_texel){{0, 0, 0}, LIGHT_NONE, -1};
    const uint64_t bits = a->pages[page][texel];
    const unsigned what = unpack(bits).what;
    return (struct field_texel){radiance_of(bits), source_of(bits), what & MARKED ? (int)(what >> NUMBER) : -1};
}

void field_atlas_prefetch(const struct field_atlas *a, int face, struct vec3 p)
{
    if (face < 0 || face >= a->ids || a->first[face] == a->first[face + 1]) return;
    const struct atlas_tile *t = &a->atlas.tiles[a->first[face]];
    const double x = along(t->matrix[0], p) - t->x, y = along(t->matrix[1], p) - t->y;
    if (x >= 0 && y >= 0 && x < t->width && y < t->height)
        __builtin_prefetch(texel_at(a, t, t->x + (int)x, t->y + (int)y));
}

/* The existing texel of a tile nearest to (x, y), pixels of the tile; the square of the distance, INFINITY: there is
 * none. Rings of growing size about the nearest pixel of the tile are searched until none can hold a nearer one. */
static double nearest_texel(const struct field_atlas *a, const struct atlas_tile *t, double x, double y, int found[2])
{
    const int cx = clamp_int((int)floor(x), 0, t->width - 1), cy = clamp_int((int)floor(y), 0, t->height - 1);
    const int most = t->width > t->height ? t->width : t->height;
    double least = INFINITY;
    for (int ring = 0; ring < most && !(least <= (ring - 1.0) * (ring - 1.0)); ring++)
        for (int v = cy - ring; v <= cy + ring; v++) {
            const int step = v == cy - ring || v == cy + ring || !ring ? 1 : 2 * ring;
            for (int u = cx - ring; u <= cx + ring; u += step) {
                if (u < 0 || v < 0 || u >= t->width || v >= t->height) continue;
                if (source_of(*texel_at(a, t, t->x + u, t->y + v)) == LIGHT_NONE) continue;
                const double d = (u + 0.5 - x) * (u + 0.5 - x) + (v + 0.5 - y) * (v + 0.5 - y);
                if (!(d < least)) continue;
                least = d;
                found[0] = u, found[1] = v;
            }
        }
    return least;
}

bool field_atlas_nearest(const struct field_atlas *a, int face, struct vec3 p, struct vec3 *nearest)
{
    double least = INFINITY;
    const struct vec3 from = p;
    if (face < 0 || face >= a->ids) return false;
    for (int i = a->first[face]; i < a->first[face + 1]; i++) {
        const struct atlas_tile *t = &a->atlas.tiles[i];
        const struct vec3 u = vec3_make(t->matrix[0][0], t->matrix[0][1], t->matrix[0][2]);
        const struct vec3 v = vec3_make(t->matrix[1][0], t->matrix[1][1], t->matrix[1][2]);
        const double x = along(t->matrix[0], from) - t->x, y = along(t->matrix[1], from) - t->y;
        const double uu = vec3_dot(u, u), vv = vec3_dot(v, v);
        int found[2] = {0, 0};
        const double d = nearest_texel(a, t, x, y, found) / uu;
        if (!(d < least)) continue;
        least = d;
        *nearest = vec3_add(
            from, vec3_add(vec3_scale(u, (found[0] + 0.5 - x) / uu), vec3_scale(v, (found[1] + 0.5 - y) / vv)));
    }
    return isfinite(least);
}

/* ------------------------------------------------------------------------------------------------------------ marks */

bool field_atlas_has(const struct field_atlas *a, const struct atlas_tile *t, int x, int y)
{
    return source_of(*texel_at(a, t, t->x + x, t->y + y)) != LIGHT_NONE;
}

struct vec3 field_atlas_place(const struct atlas_tile *t, struct face_plane plane, int x, int y)
{
    const struct vec3 u = vec3_make(t->matrix[0][0], t->matrix[0][1], t->matrix[0][2]);
    const struct vec3 v = vec3_make(t->matrix[1][0], t->matrix[1][1], t->matrix[1][2]);
    const double a = (t->x + x + 0.5 - t->matrix[0][3]) / vec3_dot(u, u);
    const double b = (t->y + y + 0.5 - t->matrix[1][3]) / vec3_dot(v, v);
    return vec3_add(vec3_add(vec3_scale(u, a), vec3_scale(v, b)), vec3_scale(plane.normal, plane.offset));
}

int field_atlas_view(const struct field_atlas *a, const struct atlas_tile *t, int x, int y)
{
    const unsigned what = unpack(*texel_at(a, t, t->x + x, t->y + y)).what;
    return what & MARKED ? -1 : (int)(what >> NUMBER) - 1;
}

void field_atlas_mark(struct field_atlas *a, const struct atlas_tile *t, int x, int y, int mark)
{
    uint64_t *bits = texel_at(a, t, t->x + x, t->y + y);
    struct texel texel = unpack(*bits);
    texel.what = (uint16_t)((texel.what & SOURCE) | MARKED | (unsigned)mark << NUMBER);
    *bits = pack(texel);
}

/* ------------------------------------------------------------------------------------------------------------ lamps */

/* A lamp seen in a tile: a texel (x, y) of the page lies q = right (x - left) + down (y - top) from its centre. */
struct lamp_place {
    struct vec3 right, down;
    double left, top; /* the centre */
    double reach;     /* texels from it to the end of the ring, at least */
    double guard, ring;
};

/* How far q, in the lamp's plane, is from the lamp; 0 within. */
static double distance_from(const struct lamp *l, struct vec3 q)
{
    if (l->shape == LAMP_DISK) return fmax(vec3_length(q) - l->radius, 0);
    const struct vec3 n = vec3_cross(l->x, l->y);
    const double nn = vec3_dot(n, n);
    const double a = fabs(vec3_dot(n, vec3_cross(q, l->y))) / nn, b = fabs(vec3_dot(n, vec3_cross(l->x, q))) / nn;
    return hypot(fmax(a - 1, 0) * vec3_length(l->x), fmax(b - 1, 0) * vec3_length(l->y));
}

static struct lamp_place place_lamp(const struct atlas_tile *t, const struct lamp *l, double off)
{
    const struct vec3 u = vec3_make(t->matrix[0][0], t->matrix[0][1], t->matrix[0][2]);
    const struct vec3 v = vec3_make(t->matrix[1][0], t->matrix[1][1], t->matrix[1][2]);
    const double side = 1 / vec3_length(u);
    const double radius = fmin(vec3_length(l->x), vec3_length(l->y));
    struct lamp_place p = {.right = vec3_scale(u, side * side), .down = vec3_scale(v, side * side)};
    p.left = along(t->matrix[0], l->centre), p.top = along(t->matrix[1], l->centre);
    p.guard = fmax(GUARD_TEXELS * side, GUARD * radius) + PARALLAX * off;
    p.ring = 2 * p.guard;
    p.reach = (vec3_length(l->x) + vec3_length(l->y) + p.ring) / side;
    return p;
}

struct ring_texel {
    double luminance;
    uint64_t bits; /* without the view: it must not decide between texels of one luminance */
};

static uint64_t without_view(uint64_t bits)
{
    struct texel t = unpack(bits);
    t.what &= SOURCE;
    return pack(t);
}

static int by_luminance(const void *a, const void *b)
{
    const struct ring_texel *p = a, *q = b;
    if (p->luminance != q->luminance) return p->luminance < q->luminance ? -1 : 1;
    return (p->bits > q->bits) - (p->bits < q->bits);
}

/* Either collects the ring's texels (with == NULL) or replaces those nearer. Returns how many. */
static int visit(const struct field_atlas *a, const struct atlas_tile *t, const struct lamp *l, double off,
                 struct ring_texel *ring, int most, const struct texel *with)
{
    const struct lamp_place p = place_lamp(t, l, off);
    const int x0 = (int)fmax(t->x, p.left - p.reach), x1 = (int)fmin(t->x + t->width, p.left + p.reach + 1);
    const int y0 = (int)fmax(t->y, p.top - p.reach), y1 = (int)fmin(t->y + t->height, p.top + p.reach + 1);
    int count = 0;
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++) {
            uint64_t *texel = texel_at(a, t, x, y);
            if (source_of(*texel) == LIGHT_NONE) continue;
            const double d =
                distance_from(l, vec3_add(vec3_scale(p.right, x + 0.5 - p.left), vec3_scale(p.down, y + 0.5 - p.top)));
            if (with && d <= p.guard) {
                *texel = pack(*with);
                count++;
            } else if (!with && d > p.guard && d <= p.ring && count < most) {
                ring[count++] = (struct ring_texel){rgb_luminance(radiance_of(*texel)), without_view(*texel)};
            }
        }
    return count;
}

enum status field_atlas_cover_lamp(struct field_atlas *a, int *covered, int face, struct face_plane plane,
                                   const struct lamp *lamp, double reach, struct err *err)
{
    enum { MAX_TEXELS = 1 << 16 };
    const double off = fabs(vec3_dot(plane.normal, lamp->centre) - plane.offset);
    int count = 0;
    if (face < 0 || face >= a->ids || !(vec3_dot(plane.normal, lamp->normal) > ALIKE) || off > reach) return ST_OK;
    struct ring_texel *ring = malloc(MAX_TEXELS * sizeof *ring);
    if (!ring) return err_nomem(err, "texels around a lamp", MAX_TEXELS * sizeof *ring);
    for (int i = a->first[face]; i < a->first[face + 1]; i++)
        count += visit(a, &a->atlas.tiles[i], lamp, off, ring + count, MAX_TEXELS - count, NULL);
    qsort(ring, (size_t)count, sizeof *ring, by_luminance);
    struct texel with = count ? unpack(ring[count / 2].bits) : (struct texel){{0, 0, 0}, LIGHT_SYNTHESISED};
    with.what = LIGHT_SYNTHESISED;
    for (int i = a->first[face]; i < a->first[face + 1]; i++)
        *covered += visit(a, &a->atlas.tiles[i], lamp, off, NULL, 0, &with);
    free(ring);
    return ST_OK;
}
