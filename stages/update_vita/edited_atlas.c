/* edited_atlas.c - see edited_atlas.h.
 *
 * Which tiles stay. Tiles are orthogonal, so a face that keeps its texels in place, or carries them along its normal,
 * is still shown by its old tile: then texels keep their bits. The other faces of the edited model get new tiles, with
 * texels of the atlas's usual size; faces of one colour get larger ones. A face that keeps its old tile, but reaches
 * beyond what was baked, has a new one behind it, in which only the texels beyond hold something. */
#include "stages/update_vita/edited_atlas.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/parallel.h"
#include "common/base/sort.h"
#include "common/math/numbers.h"
#include "common/texture/ortho.h"

enum { GUTTER = 1, PLAIN = 8 }; /* texels around a face; times the usual side, of texels of one colour */
static const double SAME = 1e-9;

/* ------------------------------------------------------------------------------------------------------ which tiles */

static double side_of(const struct atlas_tile *t)
{
    return 1 / vec3_length(vec3_make(t->matrix[0][0], t->matrix[0][1], t->matrix[0][2]));
}

/* The usual side of a texel: the median over tiles. */
static enum status usual_side(double *side, const struct atlas *a, struct err *err)
{
    double *sides = malloc(((size_t)a->tile_count + 1) * sizeof *sides);
    if (!sides) return err_nomem(err, "tiles", (size_t)a->tile_count * sizeof *sides);
    for (int i = 0; i < a->tile_count; i++) sides[i] = side_of(&a->tiles[i]);
    sort_doubles(sides, (size_t)a->tile_count);
    *side = a->tile_count ? sides[a->tile_count / 2] : 1;
    free(sides);
    return ST_OK;
}

/* Whether a tile shows the point M p where it shows p, on a face of the edited model. */
static bool tile_stays(const struct atlas_tile *t, const struct texture_rule *rule, const struct solid_face *f)
{
    const double(*m)[4] = rule->matrix;
    const double normal[3] = {f->normal.x, f->normal.y, f->normal.z};
    for (int i = 0; i < 2; i++) {
        double row[4], across = 0;
        for (int k = 0; k < 4; k++) {
            row[k] = t->matrix[i][0] * m[0][k] + t->matrix[i][1] * m[1][k] + t->matrix[i][2] * m[2][k];
            row[k] += (k == 3 ? t->matrix[i][3] : 0) - t->matrix[i][k];
        }
        for (int k = 0; k < 3; k++) across += row[k] * normal[k];
        row[3] += across * f->offset; /* what changes along the normal is constant on the face */
        for (int k = 0; k < 3; k++)
            if (fabs(row[k] - across * normal[k]) * side_of(t) > SAME) return false;
        if (fabs(row[3]) > 1e-3) return false;
    }
    return true;
}

/* Whether the old tiles of a face's id show it first of all. */
static bool face_stays(const struct light_change *c, int face)
{
    const struct solid_face *f = &c->after.model.mesh.faces[face];
    const int id = solid_face_id(&c->after.model.mesh, face);
    const struct texture_face *listed = texture_map_find(&c->map, id, vec3_scale(f->normal, f->offset));
    const struct field_atlas *a = &c->before.atlas;
    if (id >= a->ids || a->first[id] == a->first[id + 1]) return false;
    if (!listed) return true;
    if (!listed->rule_count) return false;
    const struct texture_rule *rule = &listed->rules[0];
    if (rule->kind != TEXTURE_PLACE || rule->from != id || rule->limited) return false;
    for (int i = a->first[id]; i < a->first[id + 1]; i++)
        if (!tile_stays(&a->atlas.tiles[i], rule, f)) return false;
    return true;
}

/* Sets dropped[id] where a face of the id does not stay. */
static void find_dropped(bool *dropped, const struct light_change *c)
{
    for (int i = 0; i < c->after.model.mesh.face_count; i++)
        if (!face_stays(c, i)) dropped[solid_face_id(&c->after.model.mesh, i)] = true;
}

/* Whether a face needs a new tile, and how large its texels are. */
static bool wants_tile(double *side, const struct light_change *c, int face, const bool *dropped, double usual)
{
    const struct solid_mesh *mesh = &c->after.model.mesh;
    const struct solid_face *f = &mesh->faces[face];
    const int id = solid_face_id(mesh, face);
    const struct texture_face *listed = texture_map_find(&c->map, id, vec3_scale(f->normal, f->offset));
    *side = PLAIN * usual;
    if (solid_face_is_pane(mesh, face)) return false;
    if (!listed) {
        *side = usual;
        return dropped[id];
    }
    for (int i = 0; i < listed->rule_count; i++)
        if (listed->rules[i].kind != TEXTURE_COLOUR || listed->rules[i].limited) *side = usual;
    return dropped[id] || listed->rule_count > 1;
}

/* ----------------------------------------------------------------------------------------------------------- layout */

/* Adds the tiles of a face: several where a page is too small. Texel (x, y) of a tile has its middle at right (left +
 * side (x + 0.5)) + down (top + side (y + 0.5)). */
static enum status add_tiles(struct atlas *to, const struct solid_mesh *mesh, int face, double side, struct err *err)
{
    struct vec3 right, down;
    ortho_axes(&right, &down, mesh->faces[face].normal);
    double low[2], high[2];
    solid_face_box(mesh, face, right, down, low, high);
    const double left = low[0] - GUTTER * side, top = low[1] - GUTTER * side;
    const int width = (int)ceil((high[0] - left) / side) + GUTTER, height = (int)ceil((high[1] - top) / side) + GUTTER;
    for (int y = 0; y < height; y += ATLAS_PAGE)
        for (int x = 0; x < width; x += ATLAS_PAGE) {
            struct atlas_tile t = {.face = solid_face_id(mesh, face), .view = -1};
            t.width = width - x < ATLAS_PAGE ? width - x : ATLAS_PAGE;
            t.height = height - y < ATLAS_PAGE ? height - y : ATLAS_PAGE;
            ortho_matrix(t.matrix, right, down, side, left + side * x, top + side * y);
            if (array_append(&to->tiles, (size_t)to->tile_count, sizeof *to->tiles, "tiles", err)) return err->status;
            to->tiles[to->tile_count++] = t;
        }
    return ST_OK;
}

/* A tile's matrix takes points to pixels of the page. */
static void place_tiles(struct atlas *a)
{
    for (int i = 0; i < a->tile_count; i++) {
        a->tiles[i].matrix[0][3] += a->tiles[i].x;
        a->tiles[i].matrix[1][3] += a->tiles[i].y;
    }
}

/* ----------------------------------------------------------------------------------------------------------- texels */

struct fill_job {
    const struct light_change *c;
    const struct atlas *atlas;
    const struct edited_atlas *to;
    const int *face_of_tile;
    const struct face_areas *areas; /* of the edited model */
    uint32_t *const *sources;       /* of the unedited VITA, by page */
};

static void set_texel(const struct fill_job *j, struct atlas_page *page, bool *coloured, size_t at,
                      const struct light_place *place)
{
    int from_page;
    size_t texel;
    const double rgb[3] = {place->colour.r, place->colour.g, place->colour.b};
    for (int k = 0; k < 3; k++) page->rgb[3 * at + (size_t)k] = (float)rgb[k];
    *coloured = place->kind == LIGHT_PLACE_COLOUR;
    page->source[at] = ATLAS_DEFAULT;
    if (!*coloured && field_atlas_find(&j->c->before.atlas, place->face, place->texel, &from_page, &texel))
        page->source[at] = j->sources[from_page][texel];
}

static void fill_row(const struct fill_job *j, int tile, int y)
{
    const struct atlas_tile *t = &j->atlas->tiles[tile];
    const int face = j->face_of_tile[tile], id = t->face;
    const struct solid_face *f = &j->c->after.model.mesh.faces[face];
    struct atlas_page *page = &j->to->pages[t->page];
    const double side = side_of(t);
    for (int x = 0; x < t->width; x++) {
        const size_t at = (size_t)(t->y + y) * (size_t)page->width + (size_t)(t->x + x);
        const struct vec3 p = ortho_point(t->matrix, t->x + x + 0.5, t->y + y + 0.5, f->normal, f->offset);
        struct vec3 nearest;
        struct light_place place;
        int found;
        bool on;
        if (page->source[at] != ATLAS_NONE) continue;
        if (!face_areas_nearest(j->areas, id, p, &nearest, &found, &on)) continue;
        if (!on && vec3_length(vec3_sub(p, nearest)) > 1.5 * GUTTER * side) continue;
        light_change_place(&place, j->c, face, on ? p : nearest);
        if (place.kind != LIGHT_PLACE_NONE)
            set_texel(j, page, &j->to->coloured[j->to->first[t->page] + at], at, &place);
    }
}

static void fill_tiles(void *ctx, size_t begin, size_t end, int thread)
{
    const struct fill_job *j = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++)
        for (int y = 0; y < j->atlas->tiles[i].height; y++) fill_row(j, (int)i, y);
}

/* Where texels came from: the channel `source` of all pages of the unedited VITA. */
static enum status read_sources(uint32_t **sources, const struct atlas *a, const char *folder, struct err *err)
{
    for (int i = 0; !err->status && i < a->page_count; i++) {
        struct atlas_page page = {0};
        atlas_page_read(&page, a, i, folder, NULL, err);
        sources[i] = page.source;
        page.source = NULL;
        atlas_page_release(&page);
    }
    return err->status;
}

static enum status make_pages(struct edited_atlas *a, const struct atlas *tiles, struct err *err)
{
    size_t texels = 0;
    a->page_count = tiles->page_count;
    a->pages = calloc((size_t)a->page_count + 1, sizeof *a->pages);
    a->first = calloc((size_t)a->page_count + 1, sizeof *a->first);
    if (!a->pages || !a->first) return err_nomem(err, "pages", (size_t)a->page_count * sizeof *a->pages);
    for (int i = 0; i < a->page_count; i++) {
        const int *size = tiles->page_sizes[i];
        if (atlas_page_init(&a->pages[i], size[0], size[1], err)) return err->status;
        a->first[i] = texels;
        texels += (size_t)size[0] * (size_t)size[1];
    }
    a->coloured = calloc(texels + 1, sizeof *a->coloured);
    return a->coloured ? ST_OK : err_nomem(err, "texels", texels);
}

/* Adds the tiles of all faces that need them; face_of_tile[i] is the face of tile i. */
static enum status lay_out(struct atlas *tiles, int **face_of_tile, const struct light_change *c, const bool *dropped,
                           double usual, struct err *err)
{
    const struct solid_mesh *mesh = &c->after.model.mesh;
    for (int i = 0; i < mesh->face_count; i++) {
        const int first = tiles->tile_count;
        double side;
        if (!wants_tile(&side, c, i, dropped, usual)) continue;
        if (add_tiles(tiles, mesh, i, side, err)) return err->status;
        for (int k = first; k < tiles->tile_count; k++) {
            if (array_append(face_of_tile, (size_t)k, sizeof **face_of_tile, "tiles", err)) return err->status;
            (*face_of_tile)[k] = i;
        }
    }
    if (atlas_pack(tiles, err)) return err->status;
    place_tiles(tiles);
    return ST_OK;
}

static enum status fill(struct edited_atlas *a, const struct light_change *c, const struct atlas *tiles,
                        const int *face_of_tile, const char *folder, struct err *err)
{
    const int pages = c->before.atlas.atlas.page_count;
    uint32_t **sources = calloc((size_t)pages + 1, sizeof *sources);
    struct face_areas areas = {0};
    if (!sources) err_nomem(err, "pages", (size_t)pages * sizeof *sources);
    if (!err->status && tiles->tile_count) read_sources(sources, &c->before.atlas.atlas, folder, err);
    if (!err->status) face_areas_make(&areas, &c->after.model.mesh, err);
    struct fill_job job = {c, tiles, a, face_of_tile, &areas, sources};
    if (!err->status) parallel_for((size_t)tiles->tile_count, 1, fill_tiles, &job);
    for (int i = 0; sources && i < pages; i++) free(sources[i]);
    free(sources);
    face_areas_release(&areas);
    return err->status;
}

/* More than the id of any face: the atlas may also hold faces that only other edits have. */
static size_t id_count(const struct light_change *c)
{
    const struct atlas *a = &c->before.atlas.atlas;
    int ids = c->after.model.ids > c->before.model.ids ? c->after.model.ids : c->before.model.ids;
    for (int i = 0; i < a->tile_count; i++)
        if (a->tiles[i].face >= ids) ids = a->tiles[i].face + 1;
    return (size_t)ids;
}

enum status edited_atlas_make(struct edited_atlas *a, struct light_change *c, const char *folder, struct err *err)
{
    struct atlas tiles = {0};
    int *face_of_tile = NULL;
    double usual = 1;
    const size_t ids = id_count(c);
    bool *dropped = calloc(ids + 1, sizeof *dropped);
    *a = (struct edited_atlas){.first_page = c->before.atlas.atlas.page_count};
    if (dropped)
        usual_side(&usual, &c->before.atlas.atlas, err);
    else
        err_nomem(err, "faces", ids);
    if (!err->status) find_dropped(dropped, c);
    if (!err->status && !lay_out(&tiles, &face_of_tile, c, dropped, usual, err) && !make_pages(a, &tiles, err) &&
        !fill(a, c, &tiles, face_of_tile, folder, err))
        field_atlas_replace(&c->after.atlas, dropped, &tiles, a->pages, err);
    atlas_release(&tiles);
    free(face_of_tile);
    free(dropped);
    return err->status;
}

void edited_atlas_release(struct edited_atlas *a)
{
    if (!a) return;
    for (int i = 0; a->pages && i < a->page_count; i++) atlas_page_release(&a->pages[i]);
    free(a->pages);
    free(a->coloured);
    free(a->first);
    *a = (struct edited_atlas){0};
}

/* ---------------------------------------------------------------------------------------------------------- writing */

struct light_job {
    const struct edited_atlas *a;
    const struct light_change *c;
    const struct face_nets *nets;
    const struct rgb *values;
    const struct face_areas *areas;
    struct atlas_page *page;
    int number;
};

static double times(double texel, double value) { return fmin(texel * value, 65504); }

static void light_texel(const struct light_job *j, const struct atlas_tile *t, int x, int y, bool is_colour)
{
    const struct solid_mesh *mesh = &j->c->after.model.mesh;
    const size_t at = (size_t)y * (size_t)j->page->width + (size_t)x;
    struct rgb v = {0, 0, 0};
    struct vec3 nearest, p = {0, 0, 0};
    struct net_weights w;
    double least = INFINITY;
    int face = -1;
    /* the face of the id that the texel shows: the one whose area is nearest, seen along the tile's direction */
    for (int i = j->areas->first[t->face]; i < j->areas->first[t->face + 1]; i++) {
        const int f = j->areas->faces[i];
        const struct vec3 q = ortho_point(t->matrix, x + 0.5, y + 0.5, mesh->faces[f].normal, mesh->faces[f].offset);
        if (!ortho_sees(t->matrix, mesh->faces[f].normal)) continue;
        if (j->areas->first[t->face + 1] - j->areas->first[t->face] > 1) {
            const double d = face_areas_distance(j->areas, f, q, &nearest);
            if (!(d < least)) continue;
            least = d;
        }
        face = f;
        p = q;
    }
    if (face < 0 || !face_nets_find(j->nets, face, p, &w)) return;
    for (int k = 0; k < 3; k++) {
        const struct rgb value = j->values[2 * w.sample[k] + is_colour];
        v = rgb_add(v, rgb_scale(value, is_colour ? w.weight[k] / PI : w.weight[k]));
    }
    float *rgb = j->page->rgb + 3 * at;
    rgb[0] = (float)times((double)rgb[0], v.r);
    rgb[1] = (float)times((double)rgb[1], v.g);
    rgb[2] = (float)times((double)rgb[2], v.b);
}

static void light_tiles(void *ctx, size_t begin, size_t end, int thread)
{
    const struct light_job *j = ctx;
    const struct edited_atlas *a = j->a;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        const struct atlas_tile *t = &j->c->after.atlas.atlas.tiles[i];
        if (t->page != j->number || t->face >= j->areas->ids) continue;
        for (int y = t->y; y < t->y + t->height; y++)
            for (int x = t->x; x < t->x + t->width; x++) {
                const size_t at = (size_t)y * (size_t)j->page->width + (size_t)x;
                if (j->page->source[at] == ATLAS_NONE) continue;
                light_texel(j, t, x, y,
                            j->number >= a->first_page && a->coloured[a->first[j->number - a->first_page] + at]);
            }
    }
}

/* The page as it was before the edit. */
static enum status base_page(struct atlas_page *page, const struct edited_atlas *a, const struct light_change *c,
                             int number, const char *folder, struct err *err)
{
    if (number < a->first_page) return atlas_page_read(page, &c->before.atlas.atlas, number, folder, NULL, err);
    const struct atlas_page *from = &a->pages[number - a->first_page];
    const size_t texels = (size_t)from->width * (size_t)from->height;
    if (atlas_page_init(page, from->width, from->height, err)) return err->status;
    memcpy(page->rgb, from->rgb, 3 * texels * sizeof *page->rgb);
    memcpy(page->source, from->source, texels * sizeof *page->source);
    return ST_OK;
}

/* Texels of tiles that were dropped are none. */
static void keep_tiles(struct atlas_page *page, const struct atlas *a, int number)
{
    const size_t texels = (size_t)page->width * (size_t)page->height;
    bool *kept = calloc(texels + 1, sizeof *kept);
    if (!kept) return; /* what is left over is harmless */
    for (int i = 0; i < a->tile_count; i++) {
        const struct atlas_tile *t = &a->tiles[i];
        for (int y = t->y; t->page == number && y < t->y + t->height; y++)
            memset(kept + (size_t)y * (size_t)page->width + (size_t)t->x, 1, (size_t)t->width);
    }
    for (size_t i = 0; i < texels; i++) {
        if (kept[i]) continue;
        page->source[i] = ATLAS_NONE;
        page->rgb[3 * i] = page->rgb[3 * i + 1] = page->rgb[3 * i + 2] = 0;
    }
    free(kept);
}

enum status edited_atlas_write(const struct edited_atlas *a, const struct light_change *c, const struct face_nets *nets,
                               const struct rgb *values, const char *folder, const char *out,
                               const struct provenance *prov, struct err *err)
{
    const struct atlas *atlas = &c->after.atlas.atlas;
    struct face_areas areas = {0};
    face_areas_make(&areas, &c->after.model.mesh, err);
    for (int i = 0; !err->status && i < atlas->page_count; i++) {
        struct atlas_page page = {0};
        struct light_job job = {a, c, nets, values, &areas, &page, i};
        if (!base_page(&page, a, c, i, folder, err)) {
            keep_tiles(&page, atlas, i);
            parallel_for((size_t)atlas->tile_count, 1, light_tiles, &job);
            atlas_write_page(&page, out, i, prov, err);
        }
        atlas_page_release(&page);
    }
    if (!err->status) atlas_write_list(atlas, out, prov, err);
    face_areas_release(&areas);
    return err->status;
}
