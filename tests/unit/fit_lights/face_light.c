/* face_light.c - lamps from the light that they throw on all photographed faces, whose truth is given. */
#include "stages/fit_lights/face_light.h"

#include "tests/unit/atlas_room.h"

enum { SCALE = 20, SQUARES = 1200, LAMPS = 2 }; /* SCALE: texels a metre */

static struct room_lamp truth[LAMPS];
static double texture;    /* of reflectances, to both sides */
static bool has_prints;   /* dark prints where the lamps shine most on walls, boards, and a patch of sun */
static double bent;       /* the known light is too bright by so much at one end of each face, too dark at the other */
static bool is_floor_lit; /* by the second lamp alone, and nothing else */

static double known_at(int tile, struct vec3 p) { return 0.3 + 0.05 * tile + 0.08 * p.x - 0.05 * p.y - 0.04 * p.z; }

static double factor_at(int lamp, int tile, struct vec3 p)
{
    const struct room_lamp one = {truth[lamp].at, 1};
    return lamp && is_floor_lit && tile ? 0 : room_lamp_at(&one, p, normals[tile]);
}

static double print_at(int tile, struct vec3 p)
{
    const bool on_wall = tile >= 2 && tile <= 4 && p.z > 1.1 && p.z < 1.8;
    const double along = tile == 4 ? p.x : p.y;
    if (on_wall && fabs(along - 1.5) < 0.5) return 0.3;
    if (!tile && fabs(p.x - 4.3) < 0.5 && fabs(p.y - 0.8) < 0.5) return 3;
    return tile || fmod(p.x, 0.4) < 0.2 ? 1 : 0.8;
}

static void shade(const void *ctx, float rgb[3], int tile, int x, int y, struct vec3 p)
{
    const double noise = 1 + 2 * texture * (((x / 4 * 7 + y / 4 * 13 + tile) % 11) / 10.0 - 0.5);
    double e = known_at(tile, p);
    (void)ctx;
    for (int k = 0; k < LAMPS; k++) e += truth[k].intensity * factor_at(k, tile, p);
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)(100 * reflects[tile] * (has_prints ? print_at(tile, p) : 1) * noise * e);
}

static int tile_of(const struct field_atlas *a, int tile)
{
    int k = 0;
    while (face_id(insides[k].face) != a->atlas.tiles[tile].face) k++;
    return k;
}

static void fit(struct face_lamp lamps[LAMPS])
{
    struct field_atlas atlas = {0};
    struct atlas_squares squares = {0};
    struct err err = ERR_INIT;
    make_atlas(&atlas, SCALE, shade, NULL);
    const struct atlas_scene scene = {&model, &atlas, planes};
    assert_ok(atlas_squares_list(&squares, &scene, atlas_squares_side(&scene, SQUARES), 1, NULL, &err), err);
    const size_t count = (size_t)squares.count;
    double(*known)[3] = calloc(count, sizeof *known), *factors = calloc(LAMPS * count, sizeof *factors);
    for (size_t i = 0; i < count; i++) {
        const struct atlas_square *s = &squares.list[i];
        const int tile = tile_of(&atlas, s->tile);
        const double wrong = 1 + bent * (tile % 2 ? 1 : -1) * (s->at.x / 5 + s->at.y / 4 - 1);
        for (int c = 0; c < 3; c++) known[i][c] = known_at(tile, s->at) * wrong;
        for (size_t k = 0; k < LAMPS; k++) factors[k * count + i] = factor_at((int)k, tile, s->at);
    }
    const struct face_light light = {&squares, (const double(*)[3])known, factors, LAMPS};
    assert_ok(face_light_fit(lamps, &light, &err), err);
    free(known);
    free(factors);
    atlas_squares_release(&squares);
    field_atlas_release(&atlas);
}

static void set(double first, double second, double noise, bool prints)
{
    truth[0] = (struct room_lamp){{1.4, 1.2, 2.6}, first};
    truth[1] = (struct room_lamp){{3.6, 2.9, 2.6}, second};
    texture = noise;
    has_prints = prints;
    bent = 0;
    is_floor_lit = false;
}

static void check(const struct face_lamp lamps[LAMPS], double most)
{
    for (int k = 0; k < LAMPS; k++) {
        assert_true(lamps[k].is_known);
        for (int c = 0; c < 3; c++) {
            const double off = log(lamps[k].radiance[c] / truth[k].intensity);
            assert_true(fabs(off) < most);
            assert_true(fabs(off) < 2 * lamps[k].error[c]);
        }
    }
}

/* Squares are means over 16 cm, in which the light of a lamp bends. */
static void plain_faces_tell_of_two_lamps_within_one_percent(void **state)
{
    struct face_lamp lamps[LAMPS];
    (void)state;
    set(2, 1, 0, false);
    fit(lamps);
    check(lamps, 0.01);
    set(0.5, 8, 0, false);
    fit(lamps);
    check(lamps, 0.02);
}

static void prints_boards_texture_and_sun_count_little(void **state)
{
    struct face_lamp lamps[LAMPS];
    (void)state;
    set(2, 1, 0.1, true);
    fit(lamps);
    check(lamps, 0.04);
}

static void errors_of_known_light_widen_the_error(void **state)
{
    struct face_lamp lamps[LAMPS], right[LAMPS];
    (void)state;
    set(2, 1, 0.05, false);
    fit(right);
    bent = 0.1;
    fit(lamps);
    check(lamps, 0.2);
    for (int k = 0; k < LAMPS; k++) assert_true(lamps[k].error[1] > 1.5 * right[k].error[1]);
}

static void a_lamp_that_one_face_tells_of_is_not_known(void **state)
{
    struct face_lamp lamps[LAMPS];
    (void)state;
    set(2, 1, 0, false);
    is_floor_lit = true;
    fit(lamps);
    assert_true(lamps[0].is_known);
    assert_true(fabs(log(lamps[0].radiance[1] / 2)) < 0.01);
    assert_false(lamps[1].is_known);
}

static void a_lamp_that_lights_nothing_is_not_known(void **state)
{
    struct face_lamp lamps[LAMPS];
    (void)state;
    set(2, 1, 0, false);
    truth[1].at.z = 0; /* below all that it could light */
    fit(lamps);
    assert_true(lamps[0].is_known);
    assert_false(lamps[1].is_known);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(plain_faces_tell_of_two_lamps_within_one_percent),
        cmocka_unit_test(prints_boards_texture_and_sun_count_little),
        cmocka_unit_test(errors_of_known_light_widen_the_error),
        cmocka_unit_test(a_lamp_that_one_face_tells_of_is_not_known),
        cmocka_unit_test(a_lamp_that_lights_nothing_is_not_known),
    };
    return cmocka_run_group_tests(tests, make_walls, release_room);
}
