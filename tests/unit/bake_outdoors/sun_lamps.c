/* sun_lamps.c - lamps that no texture shows, from the light that they throw on known surfaces. */
#include "stages/bake_outdoors/sun_lamps.h"

#include "common/base/parallel.h"
#include "tests/unit/sun_room.h"

enum { SCALE = 10 }; /* texels a metre */

static void shade(const void *ctx, float rgb[3], int tile, int x, int y, struct vec3 p)
{
    const struct room_lamp *l = ctx;
    const double sky = sky_light_at(tile, p);
    const double noise = 1 + 0.3 * (((x * 7 + y * 13 + tile) % 11) / 10.0 - 0.5);
    for (int c = 0; c < 3; c++)
        rgb[c] = (float)(reflects[tile] * noise * (sky + (c == 2 ? 0.5 : 1) * room_lamp_at(l, p, normals[tile])));
}

static void fit_room(struct sun_lamps *l, double intensity)
{
    struct field_atlas atlas = {0};
    struct outdoors o = {0};
    struct atlas_squares edges = {0};
    struct err err = ERR_INIT;
    uniform_outdoors(&o, 1);
    const struct room_lamp light = {{1.7, 2.4, 2.6}, intensity};
    make_atlas(&atlas, SCALE, shade, &light);
    const struct atlas_scene scene = {&model, &atlas, planes};
    const struct sun_indoors in = {.scene = &scene, .outdoors = &o};
    assert_ok(sun_lamps_fit(l, &in, &edges, vec3_make(0, 1, 0), 1, &err), err);
    outdoors_release(&o);
    field_atlas_release(&atlas);
}

static const struct vec3 places[] = {{1.7, 2.4, 0}, {3, 1, 0}, {4.5, 3.5, 0}, {0.5, 0.5, 0}, {2.5, 0.3, 0}};
enum { PLACES = sizeof places / sizeof *places };

static void a_lamp_is_found_by_its_light(void **state)
{
    (void)state;
    struct sun_lamps l = {0};
    const struct room_lamp truth = {{1.7, 2.4, 2.6}, 6};
    fit_room(&l, truth.intensity);
    for (int i = 0; i < PLACES; i++) {
        const struct rgb found = sun_lamps_irradiance(&l, &model, places[i], vec3_make(0, 0, 1));
        const double wanted = room_lamp_at(&truth, places[i], vec3_make(0, 0, 1));
        assert_true(fabs(found.g / wanted - 1) < 0.3);
        assert_true(fabs(found.b / (0.5 * wanted) - 1) < 0.3);
    }
    sun_lamps_release(&l);
}

static void without_a_lamp_hardly_any_light_is_missing(void **state)
{
    (void)state;
    struct sun_lamps l = {0};
    fit_room(&l, 0);
    for (int i = 0; i < PLACES; i++) {
        const struct rgb found = sun_lamps_irradiance(&l, &model, places[i], vec3_make(0, 0, 1));
        assert_true(found.g < 0.02);
    }
    sun_lamps_release(&l);
}

static void the_same_lamps_for_any_number_of_threads(void **state)
{
    (void)state;
    struct sun_lamps l[2] = {{0}, {0}};
    for (int k = 0; k < 2; k++) {
        parallel_set_threads(1 + 2 * k);
        fit_room(&l[k], 3);
    }
    parallel_set_threads(0);
    assert_int_equal(l[0].count, l[1].count);
    assert_memory_equal(l[0].intensity, l[1].intensity, (size_t)l[0].count * sizeof *l[0].intensity);
    for (int k = 0; k < 2; k++) sun_lamps_release(&l[k]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lamp_is_found_by_its_light),
        cmocka_unit_test(without_a_lamp_hardly_any_light_is_missing),
        cmocka_unit_test(the_same_lamps_for_any_number_of_threads),
    };
    return cmocka_run_group_tests(tests, make_room, release_room);
}
