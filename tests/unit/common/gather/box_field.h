/* box_field.h - shared by tests of gathers: a room of box_solids.h with a VITA of one colour per face. */
#ifndef REMODEL_TESTS_BOX_FIELD_H
#define REMODEL_TESTS_BOX_FIELD_H

#include "common/gather/model_field.h"
#include "tests/unit/box_solids.h"
#include "tests/unit/common/light/near.h"

enum { TEXELS = 64 }; /* a side of a tile */

/* The room of box_solids.h: faces of its inside have the ids 7 to 12, -x +x -y +y -z +z. */
enum { FIRST = 7, FLOOR = 11, CEILING = 12 };
static const struct box room[] = {ROOM_OUTSIDE, ROOM_INSIDE};

struct built {
    struct model_field field;
    struct model_field_files files;
};

/* A VITA of tiles of one colour each, for the faces FIRST .. FIRST + count - 1 of the room. A texel at the middle of
 * the ceiling, and its neighbours up to `spot` away, are 100 times as bright. */
static inline const char *write_vita(const float colours[][3], int count, int spot)
{
    static const struct vec3 right[6] = {{0, 1, 0}, {0, 1, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}};
    static const struct vec3 down[6] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 1, 0}, {0, 1, 0}};
    struct atlas a = {0};
    struct atlas_tile tiles[6] = {0};
    struct atlas_page page = {0};
    struct err err = ERR_INIT;
    char view[] = "v0", *sources[] = {view};
    a.tiles = tiles;
    a.tile_count = count;
    a.sources = sources;
    a.source_count = 1;
    for (int i = 0; i < count; i++) {
        const double s = (TEXELS - 2) / 4.0; /* texels a unit; one more all around */
        const struct vec3 axes[2] = {right[i], down[i]};
        tiles[i] = (struct atlas_tile){.face = FIRST + i, .view = -1, .width = TEXELS, .height = TEXELS};
        for (int k = 0; k < 2; k++) {
            tiles[i].matrix[k][0] = axes[k].x * s;
            tiles[i].matrix[k][1] = axes[k].y * s;
            tiles[i].matrix[k][2] = axes[k].z * s;
            tiles[i].matrix[k][3] = TEXELS / 2.0;
        }
        tiles[i].matrix[2][3] = 1;
    }
    assert_ok(atlas_pack(&a, &err), err);
    assert_int_equal(a.page_count, 1);
    assert_ok(atlas_page_init(&page, a.page_sizes[0][0], a.page_sizes[0][1], &err), err);
    for (int i = 0; i < count; i++) {
        tiles[i].matrix[0][3] += tiles[i].x;
        tiles[i].matrix[1][3] += tiles[i].y;
        for (int y = 0; y < TEXELS; y++)
            for (int x = 0; x < TEXELS; x++) {
                const size_t at = (size_t)(tiles[i].y + y) * (size_t)page.width + (size_t)(tiles[i].x + x);
                const bool bright = i == 5 && spot && abs(x - TEXELS / 2) <= spot && abs(y - TEXELS / 2) <= spot;
                for (int c = 0; c < 3; c++) page.rgb[3 * at + (size_t)c] = colours[i][c] * (bright ? 100 : 1);
                page.source[at] = i == 0 ? ATLAS_SYNTHESISED : ATLAS_VIEWS;
            }
    }
    const char *folder = scratch_path("vita");
    struct provenance prov = {0};
    assert_ok(atlas_write(&a, &page, folder, &prov, &err), err);
    atlas_page_release(&page);
    free(a.page_sizes);
    return folder;
}

static inline const char *write_boxes(const struct box *boxes, int count)
{
    struct solid_mesh mesh = make_boxes(boxes, count);
    struct err err = ERR_INIT;
    const char *path = scratch_path("model.txt");
    assert_ok(solid_mesh_write(&mesh, path, NULL, &err), err);
    solid_mesh_release(&mesh);
    return path;
}

static inline struct model_field *read_field(struct built *b)
{
    struct err err = ERR_INIT;
    assert_ok(model_field_read(&b->field, &b->files, NULL, &err), err);
    return &b->field;
}

static inline struct light_look look_one(const struct model_field *f, struct vec3 from, struct vec3 normal,
                                         struct vec3 to)
{
    struct vec3 origin[RAY_PACKET], direction[RAY_PACKET];
    struct light_look seen[RAY_PACKET] = {0};
    origin[3] = from;
    direction[3] = vec3_normalize(to);
    f->field.look(f->field.ctx, origin, normal, direction, 1u << 3, seen);
    assert_near(seen[2].distance, 0, 0);
    return seen[3];
}

static inline const char *write_lights(const char *lines)
{
    char text[8192];
    snprintf(text, sizeof text, "remodel-lights 1\n%s", lines);
    return scratch_write("lights.txt", text);
}

static const struct vec3 up = {0, 0, 1}, below = {0, 0, -1};
static const float grey[6][3] = {{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
static const float coloured[6][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 2, 2}, {3, 3, 3}, {4, 0, 4}};

#endif
