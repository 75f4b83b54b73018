/* field_atlas.c - see field_atlas.h.
 *
 * Memory. A gather meets texels in no order, so that most look-ups miss the caches; a texel is one 8-byte load, that is
 * one line of 64 bytes, where three floats and a source would be two loads from two arrays. All pages are kept: 8 MiB for
 * a page of 1024 x 1024. The nearest texel stands for its square. A gather integrates, and the integral of texels is that
 * of their bilinear interpolation but for the border of a face.
 *
 * Lamps. A photograph shows a lamp as a bright spot on the ceiling. Where lights.txt declares it, a gather sees the lamp's
 * radiance, and the spot must not light the room once more. Photographs place the spot to a few texels only, and optics
 * blur it, so that a bright rim remains around the lamp. A lamp of 10 cm is a thousand times as bright as the ceiling: a
 * rim of one texel would add a tenth of its light. So texels up to GUARD times the lamp's radius, and at least
 * GUARD_TEXELS, around it take the colour of those in a ring around that, in which the median leaves out other lamps.
 * A lamp that hangs below the ceiling appears there shifted, a view at an angle t from the normal by tan(t) of the
 * distance: the guard grows by PARALLAX times that distance. */
#include "common/gather/field_atlas.h"

#include <immintrin.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"

enum { GUARD_TEXELS = 4 };
static const double GUARD = 0.5, PARALLAX = 2;
static const double ALIKE = 0.7; /* cosine between the normals of a lamp and of a face that it may hang from */

struct texel {
    uint16_t rgb[3], source;
};
_Static_assert(sizeof(struct texel) == sizeof(uint64_t), "a texel is one load");

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

static struct rgb radiance_of(uint64_t bits)
{
    float v[4];
    _mm_storeu_ps(v, _mm_cvtph_ps(_mm_cvtsi64_si128((long long)bits)));
    return rgb_make((double)v[0], (double)v[1], (double)v[2]);
}

/* ----------------------------------------------------------------------------------------------------------- reading */

static uint64_t pack_texel(const float rgb[3], uint32_t source)
{
    struct texel t = {{0, 0, 0}, LIGHT_NONE};
    if (source == ATLAS_NONE) return pack(t);
    const __m128i halves = _mm_cvtps_ph(_mm_setr_ps(rgb[0], rgb[1], rgb[2], 0), _MM_FROUND_TO_NEAREST_INT);
    t = unpack((uint64_t)_mm_cvtsi128_si64(halves));
    t.source = source < ATLAS_VIEWS ? LIGHT_SYNTHESISED : LIGHT_TEXTURE;
    return pack(t);
}

static enum status read_page(struct field_atlas *a, int page, const char *folder, struct err *err)
{
    struct atlas_page p = {0};
    enum status st = atlas_page_read(&p, &a->atlas, page, folder, err);
    const size_t texels = st ? 0 : (size_t)p.width * (size_t)p.height;
    if (!st && !(a->pages[page] = malloc((texels + 1) * sizeof **a->pages)))
        st = err_nomem(err, "a page of texels", texels * sizeof **a->pages);
    for (size_t i = 0; !st && i < texels; i++) a->pages[page][i] = pack_texel(p.rgb + 3 * i, p.source[i]);
    atlas_page_release(&p);
    return st;
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
    a->first = malloc(((size_t)ids + 1) * sizeof *a->first);
    if (!a->first) return err_nomem(err, "faces", (size_t)ids * sizeof *a->first);
    for (int id = 0; id <= ids; id++) a->first[id] = atlas_first_tile(&a->atlas, id);
    return ST_OK;
}

enum status field_atlas_read(struct field_atlas *a, const char *folder, int ids, struct provenance *prov,
                             struct err *err)
{
    char path[FILE_PATH], name[32];
    *a = (struct field_atlas){0};
    if (provenance_add_in(prov, "vita", folder, "atlas", ".txt", NULL, err) || atlas_read(&a->atlas, folder, err) ||
        check_tiles(a, folder, err) || index_faces(a, ids, err))
        return err->status;
    a->pages = calloc((size_t)a->atlas.page_count + 1, sizeof *a->pages);
    if (!a->pages) return err_nomem(err, "pages", (size_t)a->atlas.page_count * sizeof *a->pages);
    for (int i = 0; i < a->atlas.page_count; i++) {
        snprintf(name, sizeof name, "vita/page%d.exr", i);
        if (atlas_page_path(path, folder, i, err) || provenance_add_file(prov, name, path, err) ||
            read_page(a, i, folder, err))
            return err->status;
    }
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

/* ------------------------------------------------------------------------------------------------------------ look-up */

static double along(const double row[4], struct vec3 p) { return row[0] * p.x + row[1] * p.y + row[2] * p.z + row[3]; }

static uint64_t *texel_at(const struct field_atlas *a, const struct atlas_tile *t, int x, int y)
{
    return a->pages[t->page] + (size_t)y * (size_t)a->atlas.page_sizes[t->page][0] + (size_t)x;
}

enum light_source field_atlas_look(struct rgb *radiance, const struct field_atlas *a, int face, struct vec3 p)
{
    *radiance = rgb_make(0, 0, 0);
    if (face < 0 || face >= a->ids) return LIGHT_NONE;
    for (int i = a->first[face]; i < a->first[face + 1]; i++) {
        const struct atlas_tile *t = &a->atlas.tiles[i];
        const double x = along(t->matrix[0], p) - t->x, y = along(t->matrix[1], p) - t->y;
        if (!(x >= 0 && y >= 0 && x < t->width && y < t->height)) continue;
        const uint64_t bits = *texel_at(a, t, t->x + (int)x, t->y + (int)y);
        const enum light_source source = unpack(bits).source;
        if (source == LIGHT_NONE) continue;
        *radiance = radiance_of(bits);
        return source;
    }
    return LIGHT_NONE;
}

/* ------------------------------------------------------------------------------------------------------------- lamps */

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
    uint64_t bits;
};

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
            if (unpack(*texel).source == LIGHT_NONE) continue;
            const double d =
                distance_from(l, vec3_add(vec3_scale(p.right, x + 0.5 - p.left), vec3_scale(p.down, y + 0.5 - p.top)));
            if (with && d <= p.guard) {
                *texel = pack(*with);
                count++;
            } else if (!with && d > p.guard && d <= p.ring && count < most) {
                ring[count++] = (struct ring_texel){rgb_luminance(radiance_of(*texel)), *texel};
            }
        }
    return count;
}

enum status field_atlas_cover_lamp(struct field_atlas *a, int *covered, int face, struct face_plane plane,
                                   const struct lamp *lamp, double reach, struct err *err)
{
    enum { MOST = 1 << 16 };
    const double off = fabs(vec3_dot(plane.normal, lamp->centre) - plane.offset);
    int count = 0;
    if (face < 0 || face >= a->ids || !(vec3_dot(plane.normal, lamp->normal) > ALIKE) || off > reach) return ST_OK;
    struct ring_texel *ring = malloc(MOST * sizeof *ring);
    if (!ring) return err_nomem(err, "texels around a lamp", MOST * sizeof *ring);
    for (int i = a->first[face]; i < a->first[face + 1]; i++)
        count += visit(a, &a->atlas.tiles[i], lamp, off, ring + count, MOST - count, NULL);
    qsort(ring, (size_t)count, sizeof *ring, by_luminance);
    struct texel with = count ? unpack(ring[count / 2].bits) : (struct texel){{0, 0, 0}, LIGHT_SYNTHESISED};
    with.source = LIGHT_SYNTHESISED;
    for (int i = a->first[face]; i < a->first[face + 1]; i++)
        *covered += visit(a, &a->atlas.tiles[i], lamp, off, NULL, 0, &with);
    free(ring);
    return ST_OK;
}
