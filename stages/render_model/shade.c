/* shade.c - see shade.h: projective look-ups of texels [Colburn 2014, 4.6].
 *
 * A pixel (u, v) of a camera at c shows the point p = c + z d of a face, d = R^T ((u - cx) / fx, (v - cy) / fy, 1). A
 * tile of an atlas, with the 3 x 4 matrix T, shows it at (X / W, Y / W), (X, Y, W) = T (M (p, 1)); M is the identity,
 * or takes the point to where the unedited model has it. The face's plane gives 1 / z as a linear function of the pixel
 * (visible.c). So
 *   (X, Y, W) / z = A d + (A c + b) (1 / z),   T M = (A | b),
 * is linear in the pixel too: three linear functions are found per face and tile of an atlas, moved to the first pixel
 * of a tile of the picture in double precision, and evaluated in single precision for eight pixels at a time. That
 * leaves one division for each coordinate.
 *
 * The thesis draws the scene three times, with the atlases of the source, the destination and the VITA, and blends the
 * pictures. Here a visible pixel is shaded once: pixels that both viewpoints show are blended, and the VITA is read for
 * those that neither shows, in a later pass. Both bounds tests of the thesis, inside the viewpoint's picture and inside
 * the tile, are the one inside the tile's rectangle, as a tile is a part of its view. */
#include "stages/render_model/shade.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/math/lanes.h"
#include "stages/render_model/shade_tiles.h"

enum { SLOTS = 32 }; /* faces of a tile of the picture that are kept ready */

/* --------------------------------------------------------------------------------------------------------- places */

/* T M of a tile, counted from its upper left corner. */
static void compose(double to[3][4], const struct atlas_tile *t, const double place[3][4])
{
    static const double same[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
    const double(*m)[4] = place ? place : same;
    for (int i = 0; i < 3; i++) {
        const double off = i == 0 ? t->x : i == 1 ? t->y : 0;
        double row[4];
        for (int k = 0; k < 4; k++) row[k] = t->matrix[i][k] - off * t->matrix[2][k];
        for (int k = 0; k < 4; k++)
            to[i][k] = row[0] * m[0][k] + row[1] * m[1][k] + row[2] * m[2][k] + (k == 3 ? row[3] : 0);
    }
}

/* (A d + (A c + b) / z) for one row (A | b). */
struct linear shade_linear(const double row[4], const struct linear *inverse_z, const struct view *camera)
{
    const struct vec3 a = {row[0], row[1], row[2]};
    const struct vec3 turned = mat3_apply(camera->cam_from_world, a); /* A R^T */
    const double at_camera = vec3_dot(a, camera->center) + row[3];
    const double x = turned.x / camera->fx, y = turned.y / camera->fy;
    return (struct linear){x + at_camera * inverse_z->x, y + at_camera * inverse_z->y,
                           turned.z + x * (0.5 - camera->cx) + y * (0.5 - camera->cy) + at_camera * inverse_z->origin};
}

/* Whether the tile is the picture itself, shifted. */
static bool is_own(const struct shade_tile *s, const struct view *camera)
{
    const double most = 1e-3, w = s->w.origin; /* px over the whole picture */
    const double side = fmax(camera->width, camera->height);
    return w > 0 && fabs(s->w.x) * side * side < most * w && fabs(s->w.y) * side * side < most * w &&
           fabs(s->x.x / w - 1) * side < most && fabs(s->x.y / w) * side < most && fabs(s->y.x / w) * side < most &&
           fabs(s->y.y / w - 1) * side < most;
}

void shade_tile_place(struct shade_tile *s, const struct atlas_tile *t, const double place[3][4],
                      const struct linear *inverse_z, const struct view *camera)
{
    double m[3][4];
    compose(m, t, place);
    *s = (struct shade_tile){.x = shade_linear(m[0], inverse_z, camera),
                             .y = shade_linear(m[1], inverse_z, camera),
                             .w = shade_linear(m[2], inverse_z, camera),
                             .width = t->width,
                             .height = t->height,
                             .stride = texture_stride(t)};
    s->own = is_own(s, camera);
}

/* ---------------------------------------------------------------------------------------------------------- shading */

/* A face's step in a tile of the picture. */
struct ready {
    uint32_t face;
    const struct shade_step *step;
    struct tile_lanes *a, *b;
    int a_count, b_count;
    struct lanes limits[4];
};

struct worker { /* of a thread */
    struct ready slots[SLOTS];
    int count, next;
    struct tile_lanes *tiles; /* of the slots; owned */
};

/* Where a tile of the picture is: its first pixel, and the columns and rows that are in the picture. */
struct area {
    int x, y, width, height;
};

static struct area area_of(const struct visible *v, size_t tile)
{
    const int x = (int)tile % v->columns * VISIBLE_TILE, y = (int)tile / v->columns * VISIBLE_TILE;
    const int width = v->width - x, height = v->height - y;
    return (struct area){x, y, width < VISIBLE_TILE ? width : VISIBLE_TILE,
                         height < VISIBLE_TILE ? height : VISIBLE_TILE};
}

static const struct ready *make_ready(struct worker *w, const struct shade_pass *pass, uint32_t face, struct area area)
{
    for (int i = 0; i < w->count; i++)
        if (w->slots[i].face == face) return &w->slots[i];
    const int at = w->next++ % SLOTS;
    if (w->count < SLOTS) w->count++;
    struct ready *r = &w->slots[at];
    const struct shade_step *step = &pass->steps[face];
    struct tile_lanes *room = w->tiles + (size_t)at * (size_t)pass->max_tiles;
    r->face = face;
    r->step = step;
    r->a = room;
    if (step->kind == SHADE_EDGE) { /* any tile may be the nearest */
        for (int i = 0; i < step->a_count; i++) {
            const struct shade_tile *s = &pass->tiles[step->a + i];
            room[i] = (struct tile_lanes){lanes_from(&s->x, area.x, area.y), lanes_from(&s->y, area.x, area.y),
                                          lanes_from(&s->w, area.x, area.y), s, false};
        }
        r->a_count = step->a_count;
    } else
        r->a_count = tile_lanes_make(r->a, pass->tiles + step->a, step->a_count, area.x, area.y, VISIBLE_TILE);
    r->b = room + r->a_count;
    r->b_count = tile_lanes_make(r->b, pass->tiles + step->b, step->b_count, area.x, area.y, VISIBLE_TILE);
    for (int k = 0; step->limited && k < 4; k++) r->limits[k] = lanes_from(&step->limits[k], area.x, area.y);
    return r;
}

/* Eight pixels of a row, the first one `down` rows and `right` columns from the tile's first one. */
struct octet {
    float *rgb;
    uint8_t *made;
    int x, y; /* of the first one in the picture */
    float down, right;
};

static inline void put(const struct octet *o, int k, f32x4 rgb, enum picture_made made)
{
    memcpy(o->rgb + 3 * k, &rgb, 3 * sizeof *o->rgb);
    o->made[k] = (uint8_t)made;
}

static void put_from(const struct octet *o, const struct texels *t, const struct tile_lanes *list, unsigned lanes)
{
    for (; lanes; lanes &= lanes - 1) {
        const int k = __builtin_ctz(lanes);
        put(o, k, t->rgba[k], texels_made(t, list, k));
    }
}

/* Returns the lanes that got a colour. */
static unsigned shade_tiles(const struct octet *o, const struct ready *r, float share, unsigned lanes)
{
    struct texels a, b;
    const unsigned in_a = tile_texels_find(&a, r->a, r->a_count, lanes, o->down, o->right);
    const unsigned wanted = share > 0 ? lanes : lanes & ~in_a;
    const unsigned in_b = wanted ? tile_texels_find(&b, r->b, r->b_count, wanted, o->down, o->right) : 0;
    const f32x4 of_a = f32x4_all(1 - share), of_b = f32x4_all(share);
    for (unsigned both = in_a & in_b; both; both &= both - 1) {
        const int k = __builtin_ctz(both);
        const enum picture_made made = share > 0.5f ? texels_made(&b, r->b, k) : texels_made(&a, r->a, k);
        put(o, k, of_a * a.rgba[k] + of_b * b.rgba[k], made);
    }
    put_from(o, &a, r->a, in_a & ~in_b);
    put_from(o, &b, r->b, in_b & ~in_a);
    return in_a | in_b;
}

static unsigned shade_edge(const struct octet *o, const struct ready *r, unsigned lanes)
{
    unsigned found = 0;
    for (unsigned rest = lanes; rest; rest &= rest - 1) {
        const int k = __builtin_ctz(rest);
        float rgb[3];
        if (!tile_texel_nearest(rgb, r->a, r->a_count, k, o->down, o->right)) continue;
        put(o, k, (f32x4){rgb[0], rgb[1], rgb[2], 1}, MADE_SYNTHESISED);
        found |= 1u << k;
    }
    return found;
}

static void shade_colour(const struct octet *o, const float rgb[3], unsigned lanes)
{
    for (; lanes; lanes &= lanes - 1) put(o, __builtin_ctz(lanes), (f32x4){rgb[0], rgb[1], rgb[2], 1}, MADE_COLOUR);
}

static void shade_outdoors(const struct octet *o, const struct shade_pass *pass, unsigned lanes)
{
    const struct view *v = pass->camera;
    const struct mat3 world_from_cam = mat3_transpose(v->cam_from_world);
    for (; lanes; lanes &= lanes - 1) {
        const int k = __builtin_ctz(lanes);
        const struct vec3 d = {(o->x + k + 0.5 - v->cx) / v->fx, (o->y + 0.5 - v->cy) / v->fy, 1};
        float rgb[3] = {0};
        outdoors_sample(rgb, pass->outdoors, mat3_apply(world_from_cam, d));
        put(o, k, (f32x4){rgb[0], rgb[1], rgb[2], 1}, MADE_OUTDOORS);
    }
}

static unsigned limit(const struct ready *r, const struct octet *o, unsigned lanes)
{
    i32x8 in = i32x8_all(-1);
    const f32x8 down = f32x8_all(o->down), right = f32x8_all(o->right);
    for (int k = 0; k < 4; k++) in &= lanes_value(&r->limits[k], down, right) >= (f32x8){0};
    return lanes & i32x8_signs(in);
}

/* Shades pixels of one face. Returns the lanes that got a colour. */
static inline unsigned shade_face(const struct octet *o, const struct shade_pass *pass, const struct ready *r,
                                  unsigned lanes)
{
    if (r->step->limited) lanes = limit(r, o, lanes);
    switch (r->step->kind) {
    case SHADE_TILES:
        return shade_tiles(o, r, pass->t, lanes);
    case SHADE_EDGE:
        return shade_edge(o, r, lanes);
    case SHADE_COLOUR:
        shade_colour(o, r->step->colour, lanes);
        return lanes;
    case SHADE_OUTDOORS:
        shade_outdoors(o, pass, lanes);
        return lanes;
    default:
        return 0;
    }
}

static unsigned lanes_of_face(const uint32_t *faces, uint32_t face)
{
    const i32x8 equal = i32x8_load(faces) == (int)face;
    return i32x8_signs(equal);
}

/* Lanes without a colour, of the first `count`. */
static unsigned open_lanes(const uint8_t *made, int count)
{
    unsigned open = 0;
    for (int k = 0; k < count; k++) open |= (unsigned)(made[k] == MADE_NOTHING) << k;
    return open;
}

/* Returns whether pixels are left that another pass may give a colour. */
static bool shade_row(struct worker *w, const struct shade_pass *pass, const uint32_t *faces, struct area area, int row)
{
    bool left = false;
    for (int x = 0; x < area.width; x += LANES) {
        const size_t at = (size_t)(area.y + row) * (size_t)pass->out->width + (size_t)(area.x + x);
        const struct octet o = {
            pass->out->rgb + 3 * at, pass->out->made + at, area.x + x, area.y + row, (float)row, (float)x};
        unsigned todo = open_lanes(o.made, area.width - x < LANES ? area.width - x : LANES);
        while (todo) {
            const uint32_t face = faces[x + __builtin_ctz(todo)];
            const unsigned lanes = lanes_of_face(faces + x, face) & todo;
            todo &= ~lanes;
            if (pass->steps[face].kind == SHADE_NOTHING) continue;
            if (shade_face(&o, pass, make_ready(w, pass, face, area), lanes) == lanes) continue;
            atomic_store_explicit(&pass->open[face], 1, memory_order_relaxed);
            left = true;
        }
    }
    return left;
}

/* z and id of eight pixels. Where there is no face, 1 / z is 0. */
static void begin_eight(float *z, uint32_t *id, const struct shade_pass *pass, size_t from)
{
    const f32x8 inverse = f32x8_load(pass->seen->inverse_z + from);
    const i32x8 there = inverse > (f32x8){0};
    const i32x8 face = i32x8_load(pass->seen->face + from);
    f32x8_store(z, f32x8_where(there, 1 / inverse));
    i32x8_store(id, i32x8_gather((const int *)pass->ids, face));
}

static void begin_row(const struct shade_pass *pass, size_t from, struct area area, int row)
{
    const size_t to = (size_t)(area.y + row) * (size_t)pass->out->width + (size_t)area.x;
    const size_t count = (size_t)area.width;
    struct model_picture *out = pass->out;
    float z[VISIBLE_TILE];
    uint32_t id[VISIBLE_TILE];
    for (int x = 0; x < VISIBLE_TILE; x += LANES) begin_eight(z + x, id + x, pass, from + (size_t)x);
    memcpy(out->z + to, z, count * sizeof *z);
    memcpy(out->id + to, id, count * sizeof *id);
    memset(out->rgb + 3 * to, 0, 3 * count * sizeof *out->rgb);
    memset(out->made + to, MADE_NOTHING, count);
}

struct shade_job {
    const struct shade_pass *pass;
    struct worker *workers;
};

static void shade_some(void *ctx, size_t begin, size_t end, int thread)
{
    const struct shade_job *job = ctx;
    const struct shade_pass *pass = job->pass;
    struct worker *w = &job->workers[thread];
    for (size_t tile = begin; tile < end; tile++) {
        const struct area area = area_of(pass->seen, tile);
        bool left = false;
        if (!pass->first && pass->done[tile]) continue;
        w->count = w->next = 0;
        for (int row = 0; row < area.height; row++) {
            const size_t from = tile * VISIBLE_PIXELS + (size_t)(row * VISIBLE_TILE);
            if (pass->first) begin_row(pass, from, area, row);
            left |= shade_row(w, pass, pass->seen->face + from, area, row);
        }
        pass->done[tile] = !left;
    }
}

static size_t tile_count(const struct visible *v) { return (size_t)v->columns * (size_t)v->rows; }

enum status shade_pixels(const struct shade_pass *pass, struct err *err)
{
    const int threads = parallel_threads();
    const size_t room = (size_t)SLOTS * (size_t)pass->max_tiles;
    struct worker *workers = aligned_alloc(_Alignof(struct worker), (size_t)threads * sizeof *workers);
    if (!workers) err_nomem(err, "threads", (size_t)threads * sizeof *workers);
    for (int i = 0; workers && i < threads; i++) workers[i].tiles = NULL;
    for (int i = 0; !err->status && i < threads; i++)
        if (posix_memalign((void **)&workers[i].tiles, 32, (room + 1) * sizeof *workers[i].tiles)) {
            workers[i].tiles = NULL;
            err_nomem(err, "tiles", room * sizeof *workers[i].tiles);
        }
    struct shade_job job = {.pass = pass, .workers = workers};
    if (!err->status) parallel_for(tile_count(pass->seen), 1, shade_some, &job);
    for (int i = 0; workers && i < threads; i++) free(workers[i].tiles);
    free(workers);
    return err->status;
}

static void mark_some(void *ctx, size_t begin, size_t end, int thread)
{
    const struct shade_pass *pass = ctx;
    (void)thread;
    for (size_t tile = begin; tile < end; tile++) {
        const struct area area = area_of(pass->seen, tile);
        for (int row = 0; row < area.height; row++) {
            const uint32_t *faces = pass->seen->face + tile * VISIBLE_PIXELS + row * VISIBLE_TILE;
            for (int x = 0; x < area.width; x++)
                if (!x || faces[x] != faces[x - 1])
                    atomic_store_explicit(&pass->open[faces[x]], 1, memory_order_relaxed);
        }
    }
}

void shade_mark_seen(struct shade_pass *pass) { parallel_for(tile_count(pass->seen), 1, mark_some, pass); }
