/* atlas_room.h - a room with a window, of which the whole atlas is known. */
#ifndef REMODEL_TEST_ATLAS_ROOM_H
#define REMODEL_TEST_ATLAS_ROOM_H

#include "common/gather/atlas_squares.h"
#include "common/math/numbers.h"
#include "common/texture/atlas.h"
#include "tests/unit/box_solids.h"

/* A room of 5 x 4 x 2.7 m with a window of 2 x 1.4 m in the wall y = 0, which is 0.3 m thick. */
static const struct vec3 window_low = {1.5, -0.3, 0.8}, window_high = {3.5, 0, 2.2};
static const struct box boxes[] = {
    {"walls", "floor", {-0.3, -0.3, -0.3}, {5.3, 4.3, 0}, false},
    {"walls", "ceiling", {-0.3, -0.3, 2.7}, {5.3, 4.3, 3}, false},
    {"walls", "west", {-0.3, -0.3, 0}, {0, 4.3, 2.7}, false},
    {"walls", "east", {5, -0.3, 0}, {5.3, 4.3, 2.7}, false},
    {"walls", "north", {0, 4, 0}, {5, 4.3, 2.7}, false},
    {"walls", "below", {0, -0.3, 0}, {5, 0, 0.8}, false},
    {"walls", "above", {0, -0.3, 2.2}, {5, 0, 2.7}, false},
    {"walls", "left", {0, -0.3, 0.8}, {1.5, 0, 2.2}, false},
    {"walls", "right", {3.5, -0.3, 0.8}, {5, 0, 2.2}, false},
};
enum { BOXES = sizeof boxes / sizeof *boxes, TILES = 6 };

/* The faces indoors: corner, side along x, side along y of the tile, metres. */
static const struct inside {
    const char *face;
    struct vec3 corner, right, down;
} insides[TILES] = {
    {"floor/5", {0, 0, 0}, {5, 0, 0}, {0, 4, 0}},   {"ceiling/4", {0, 0, 2.7}, {5, 0, 0}, {0, 4, 0}},
    {"west/1", {0, 0, 0}, {0, 4, 0}, {0, 0, 2.7}},  {"east/0", {5, 0, 0}, {0, 4, 0}, {0, 0, 2.7}},
    {"north/2", {0, 4, 0}, {5, 0, 0}, {0, 0, 2.7}}, {"below/3", {0, 0, 0}, {5, 0, 0}, {0, 0, 0.8}},
};

static struct model_rays model;
static struct face_plane *planes;

static int make_walls(void **state)
{
    model = make_rays(boxes, BOXES);
    planes = calloc((size_t)model.ids + 256, sizeof *planes);
    for (int i = 0; i < model.mesh.face_count; i++)
        planes[solid_face_id(&model.mesh, i)] =
            (struct face_plane){model.mesh.faces[i].normal, model.mesh.faces[i].offset};
    return scratch_make(state);
}

static int release_room(void **state)
{
    model_rays_release(&model);
    free(planes);
    return scratch_remove(state);
}

static int face_id(const char *name)
{
    for (int i = 0; i < model.mesh.face_count; i++)
        if (!strcmp(solid_face_name(&model.mesh, i), name)) return solid_face_id(&model.mesh, i);
    fail_msg("no face %s", name);
    return 0;
}

static int by_face(const void *a, const void *b)
{
    return ((const struct atlas_tile *)a)->face - ((const struct atlas_tile *)b)->face;
}

/* The radiance of texel (x, y) of a tile, which is at p. */
typedef void shade_fn(const void *ctx, float rgb[3], int tile, int x, int y, struct vec3 p);

/* Writes the atlas of the room with a number of texels a metre, and reads it as gathers do. */
static void make_atlas(struct field_atlas *to, double scale, shade_fn *shade, const void *ctx)
{
    struct atlas a = {0};
    struct atlas_tile tiles[TILES] = {0};
    struct atlas_page page = {0};
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    char view[] = "v0", *sources[] = {view};
    a.tiles = tiles;
    a.tile_count = TILES;
    a.sources = sources;
    a.source_count = 1;
    for (int i = 0; i < TILES; i++) {
        const struct vec3 axes[2] = {vec3_normalize(insides[i].right), vec3_normalize(insides[i].down)};
        tiles[i].face = face_id(insides[i].face);
        tiles[i].view = -1;
        tiles[i].width = (int)lround(scale * vec3_length(insides[i].right));
        tiles[i].height = (int)lround(scale * vec3_length(insides[i].down));
        for (int k = 0; k < 2; k++) {
            tiles[i].matrix[k][0] = axes[k].x * scale;
            tiles[i].matrix[k][1] = axes[k].y * scale;
            tiles[i].matrix[k][2] = axes[k].z * scale;
        }
        tiles[i].matrix[2][3] = 1;
    }
    qsort(tiles, TILES, sizeof *tiles, by_face);
    assert_ok(atlas_pack(&a, &err), err);
    assert_int_equal(a.page_count, 1);
    assert_ok(atlas_page_init(&page, a.page_sizes[0][0], a.page_sizes[0][1], &err), err);
    for (int i = 0; i < TILES; i++) {
        int k = 0;
        while (face_id(insides[k].face) != tiles[i].face) k++;
        tiles[i].matrix[0][3] += tiles[i].x;
        tiles[i].matrix[1][3] += tiles[i].y;
        for (int y = 0; y < tiles[i].height; y++)
            for (int x = 0; x < tiles[i].width; x++) {
                const size_t at = (size_t)(tiles[i].y + y) * (size_t)page.width + (size_t)(tiles[i].x + x);
                const struct vec3 p =
                    vec3_add(insides[k].corner, vec3_add(vec3_scale(insides[k].right, (x + 0.5) / tiles[i].width),
                                                         vec3_scale(insides[k].down, (y + 0.5) / tiles[i].height)));
                shade(ctx, page.rgb + 3 * at, k, x, y, p);
                page.source[at] = ATLAS_VIEWS;
            }
    }
    const char *folder = scratch_path("vita");
    assert_ok(atlas_write(&a, &page, folder, &prov, &err), err);
    atlas_page_release(&page);
    free(a.page_sizes);
    assert_ok(field_atlas_read(to, folder, model.ids, &prov, &err), err);
    provenance_release(&prov);
}

/* Surfaces reflect so little that nothing but what shines on them lights them. */
static const double reflects[TILES] = {0.003, 0.008, 0.005, 0.006, 0.004, 0.005};
static const struct vec3 normals[TILES] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 1, 0}};

/* A small lamp that shines down; its intensity falls with the cosine. */
struct room_lamp {
    struct vec3 at;
    double intensity; /* straight down */
};

static inline double room_lamp_at(const struct room_lamp *l, struct vec3 p, struct vec3 normal)
{
    const struct vec3 d = vec3_sub(l->at, p);
    const double r2 = vec3_dot(d, d);
    return l->intensity * fmax(0, vec3_dot(d, normal)) * fmax(0, d.z) / (r2 * r2);
}

#endif
