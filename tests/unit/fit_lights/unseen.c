/* unseen_fit.c - lamps that nobody marked, from the light that they throw on faces that photographs show. */
#include "stages/fit_lights/unseen_fit.h"

#include "common/base/parallel.h"
#include "tests/unit/atlas_room.h"

enum { SCALE = 10, SQUARES = 1500 }; /* SCALE: texels a metre */

static struct room_lamp truth; /* intensity 0: none */
static bool is_standing;       /* it shines evenly to all sides */
static bool is_sunny;          /* a patch on the floor, twice as bright */
static bool is_hidden;         /* photographs show the ceiling, and no lamp there */

static bool in_patch(int tile, struct vec3 p)
{
    return is_sunny && !tile && fabs(p.x - 3) < 0.8 && fabs(p.y - 1) < 0.6;
}

/* Irradiance from the window and from other surfaces, smooth on each face. */
static double known_at(int tile, struct vec3 p) { return 0.3 + 0.05 * tile + 0.08 * p.x - 0.05 * p.y - 0.04 * p.z; }

static double light_at(int tile, struct vec3 p)
{
    const struct vec3 d = vec3_sub(truth.at, p);
    const double round = truth.intensity * fmax(0, vec3_dot(d, normals[tile])) / pow(vec3_length(d), 3);
    return known_at(tile, p) * (in_patch(tile, p) ? 2 : 1) +
           (is_standing ? round : room_lamp_at(&truth, p, normals[tile]));
}

static void shade(const void *ctx, float rgb[3], int tile, int x, int y, struct vec3 p)
{
    const double noise = 1 + 0.2 * (((x * 7 + y * 13 + tile) % 11) / 10.0 - 0.5);
    (void)ctx;
    for (int c = 0; c < 3; c++) rgb[c] = (float)(reflects[tile] * noise * light_at(tile, p));
}

static bool may_be(const void *ctx, struct vec3 at)
{
    (void)ctx;
    return !is_hidden && at.x > 0 && at.x < 5 && at.y > 0 && at.y < 4;
}

static int inside_of(const struct field_atlas *a, int tile)
{
    int k = 0;
    while (face_id(insides[k].face) != a->atlas.tiles[tile].face) k++;
    return k;
}

/* Fits, when all but the lamp is known. standing, stands: of one that stands; NULL: it is not looked for. */
static int fit_both(struct unseen_lamp lamps[MAX_UNSEEN], const struct bright_place *bright,
                    struct unseen_lamp *standing, bool *stands)
{
    struct field_atlas atlas = {0};
    struct atlas_squares squares = {0};
    struct err err = ERR_INIT;
    int count = -1;
    make_atlas(&atlas, SCALE, shade, NULL);
    const struct atlas_scene scene = {&model, &atlas, planes};
    assert_ok(atlas_squares_list(&squares, &scene, atlas_squares_side(&scene, SQUARES), 1, NULL, &err), err);
    struct unseen_light light = {.squares = &squares,
                                 .known = calloc((size_t)squares.count, sizeof *light.known),
                                 .rays = &model,
                                 .shadows = &model,
                                 .may_be = may_be,
                                 .bright = bright,
                                 .bright_count = bright ? 1 : 0};
    for (int i = 0; i < squares.count; i++)
        for (int c = 0; c < 3; c++)
            light.known[i][c] = known_at(inside_of(&atlas, squares.list[i].tile), squares.list[i].at);
    assert_ok(unseen_fit(lamps, &count, &light, &err), err);
    if (standing) assert_ok(unseen_fit_standing(standing, stands, &light, &err), err);
    free(light.known);
    atlas_squares_release(&squares);
    field_atlas_release(&atlas);
    return count;
}

static int fit(struct unseen_lamp lamps[MAX_UNSEEN], const struct bright_place *bright)
{
    return fit_both(lamps, bright, NULL, NULL);
}

static void set(double x, double y, double intensity, bool sunny, bool hidden)
{
    truth = (struct room_lamp){{x, y, 2.67}, intensity};
    is_sunny = sunny;
    is_hidden = hidden;
}

static void check_intensity(const struct unseen_lamp *l, double most)
{
    for (int c = 0; c < 3; c++) {
        const double off = log(l->intensity[c] / truth.intensity);
        assert_true(fabs(off) < most);
        assert_true(fabs(off) < 3 * l->error[c] + 0.02);
        assert_true(l->error[c] < 0.2);
    }
}

/* The second time a patch of sun lies on the floor. */
static void a_lamp_is_found_within_fifteen_centimetres_and_five_percent(void **state)
{
    static const double places[][2] = {{1.7, 2.4}, {3.9, 1.2}};
    struct unseen_lamp lamps[MAX_UNSEEN];
    (void)state;
    for (int k = 0; k < 2; k++) {
        set(places[k][0], places[k][1], 4, k == 1, false);
        assert_int_equal(fit(lamps, NULL), 1);
        assert_true(hypot(lamps[0].place.at.x - truth.at.x, lamps[0].place.at.y - truth.at.y) < 0.15);
        check_intensity(&lamps[0], k ? 0.15 : 0.05);
        assert_true(lamps[0].brightest.z < 2.7 && lamps[0].excess > 0.5);
    }
}

static void a_bright_place_of_the_ceiling_gets_its_radiance(void **state)
{
    const struct bright_place place = {.at = {1.7, 2.4, 2.7}, .x = 0.1, .y = 0.1};
    struct unseen_lamp lamps[MAX_UNSEEN];
    (void)state;
    set(1.7, 2.4, 1, true, true);
    assert_int_equal(fit(lamps, &place), 1);
    assert_true(lamps[0].place.x == place.x && lamps[0].place.at.x == place.at.x);
    check_intensity(&lamps[0], 0.07);
}

static void what_no_lamp_explains_is_no_lamp(void **state)
{
    const struct bright_place place = {.at = {1.7, 2.4, 2.7}, .x = 0.1, .y = 0.1};
    struct unseen_lamp lamps[MAX_UNSEEN];
    (void)state;
    set(0, 0, 0, false, false);
    assert_int_equal(fit(lamps, NULL), 0);
    assert_int_equal(fit(lamps, &place), 0); /* a bright place that throws no light */
    set(0, 0, 0, true, false);
    assert_int_equal(fit(lamps, NULL), 0); /* a patch of sun lies on one face */
}

static void no_lamp_is_put_where_photographs_show_the_ceiling(void **state)
{
    struct unseen_lamp lamps[MAX_UNSEEN];
    (void)state;
    set(1.7, 2.4, 4, false, true);
    assert_int_equal(fit(lamps, NULL), 0);
}

static void a_lamp_on_a_stand_is_said_with_its_place(void **state)
{
    struct unseen_lamp lamps[MAX_UNSEEN], standing;
    bool stands;
    (void)state;
    set(1.3, 2.9, 1, false, true);
    truth.at.z = 1.3;
    is_standing = true;
    assert_int_equal(fit_both(lamps, NULL, &standing, &stands), 0);
    assert_true(stands);
    assert_true(vec3_length(vec3_sub(standing.place.at, truth.at)) < 0.6);
    assert_true(fabs(log(standing.intensity[1])) < 0.4);
    assert_true(standing.gain > 0.3 && standing.excess > 0.5);
    is_standing = false;
    set(1.7, 2.4, 4, false, false); /* a lamp below the ceiling explains all */
    assert_int_equal(fit_both(lamps, NULL, &standing, &stands), 1);
    assert_false(stands);
    set(0, 0, 0, true, false); /* a patch of sun lies on one face */
    assert_int_equal(fit_both(lamps, NULL, &standing, &stands), 0);
    assert_false(stands);
}

static void the_same_lamp_for_any_number_of_threads(void **state)
{
    struct unseen_lamp lamps[2][MAX_UNSEEN];
    (void)state;
    memset(lamps, 0, sizeof lamps);
    set(1.7, 2.4, 4, false, false);
    for (int k = 0; k < 2; k++) {
        parallel_set_threads(1 + 2 * k);
        assert_int_equal(fit(lamps[k], NULL), 1);
    }
    parallel_set_threads(0);
    assert_memory_equal(&lamps[0][0], &lamps[1][0], sizeof lamps[0][0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lamp_is_found_within_fifteen_centimetres_and_five_percent),
        cmocka_unit_test(a_bright_place_of_the_ceiling_gets_its_radiance),
        cmocka_unit_test(what_no_lamp_explains_is_no_lamp),
        cmocka_unit_test(no_lamp_is_put_where_photographs_show_the_ceiling),
        cmocka_unit_test(a_lamp_on_a_stand_is_said_with_its_place),
        cmocka_unit_test(the_same_lamp_for_any_number_of_threads),
    };
    return cmocka_run_group_tests(tests, make_walls, release_room);
}
