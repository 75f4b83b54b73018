/* flicker.c - the steadiness of relit films, on frames of a wall whose light is known. */
#include "stages/evaluate/light/flicker.h"

#include <math.h>

#include "tests/unit/scratch.h"

enum { WIDTH = 80, HEIGHT = 60 };

enum part { WALL, LEFT_IS_FURNITURE, LEFT_IS_AN_OBJECT };

/* A camera before a wall at z = 2, moved by x; light of the wall is changed by `scale` times 1 + 0.3 of its x, or not
 * at all if `scale` is 0. */
static void make_frame(struct film_frame *f, double x, double scale, enum part part)
{
    const double exposure = 0.7;
    const struct camera lens = {CAMERA_SIMPLE_PINHOLE, WIDTH, HEIGHT, {60, WIDTH / 2.0, HEIGHT / 2.0}};
    const struct pose pose = {{1, 0, 0, 0}, {-x, 0, 0}};
    struct exr_image relit = {0};
    struct err err = ERR_INIT;
    assert_ok(exr_image_init(&relit, WIDTH, HEIGHT, &err), err);
    for (int c = 0; c < 4; c++)
        assert_ok(exr_add_plane(&relit, ((const char *[]){"R", "G", "B", "made"})[c], c < 3 ? EXR_HALF : EXR_UINT, NULL,
                                &err),
                  err);
    assert_ok(exr_set_number(&relit, "remodel:exposure", exposure, &err), err);
    assert_ok(model_picture_resize(&f->unlit, WIDTH, HEIGHT, &err), err);
    model_picture_set_camera(&f->unlit, &lens, &pose);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const double at = x + (i % WIDTH + 0.5 - WIDTH / 2.0) / 30;
        const double light = 0.5 + 0.1 * sin(9 * at); /* the wall's texture */
        const enum part here = i % WIDTH < WIDTH / 2 ? part : WALL;
        for (int c = 0; c < 3; c++) {
            f->unlit.rgb[3 * i + c] = (float)light;
            relit.planes[c].f[i] = (float)(exposure * light * (scale > 0 ? scale * (1 + 0.3 * at) : 1));
        }
        f->unlit.z[i] = 2;
        f->unlit.id[i] = 1;
        f->unlit.made[i] = here == LEFT_IS_FURNITURE ? MADE_CLUTTER : MADE_WARPED;
        relit.planes[3].u[i] = here == LEFT_IS_AN_OBJECT ? MADE_COLOUR : f->unlit.made[i];
    }
    assert_ok(flicker_frame_set_quotients(f, &relit, "frame.exr", &err), err);
    exr_image_release(&relit);
}

static struct film {
    struct film_frame first, second;
    struct quantiles differences;
} film;

static int setup(void **state)
{
    struct err err = ERR_INIT;
    (void)state;
    film = (struct film){0};
    assert_ok(quantiles_init(&film.differences, &err), err);
    make_frame(&film.first, 0, 2, WALL);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    flicker_frame_release(&film.first);
    flicker_frame_release(&film.second);
    quantiles_release(&film.differences);
    return 0;
}

static uint64_t measure(void) { return flicker_add(&film.differences, &film.first, &film.second); }

static void light_that_belongs_to_places_is_steady(void **state)
{
    (void)state;
    make_frame(&film.second, 0.11, 2, WALL);
    assert_true(measure() > WIDTH * HEIGHT * 3 / 4);
    assert_true(quantiles_get(&film.differences, 0.95) < 1e-3);
}

static void a_frame_that_is_brighter_than_the_last_is_found(void **state)
{
    (void)state;
    make_frame(&film.second, 0.11, 2.2, WALL);
    assert_true(measure() > 0);
    assert_true(fabs(quantiles_get(&film.differences, 0.5) - 0.1) < 2e-3);
}

static void furniture_and_objects_do_not_count(void **state)
{
    (void)state;
    for (int part = LEFT_IS_FURNITURE; part <= LEFT_IS_AN_OBJECT; part++) {
        make_frame(&film.second, 0, 2, (enum part)part);
        assert_int_equal(measure(), (WIDTH / 2 - 1) * (HEIGHT - 1)); /* but the last column and row */
    }
}

static void places_whose_light_stays_do_not_count(void **state)
{
    (void)state;
    make_frame(&film.first, 0, 0, WALL);
    make_frame(&film.second, 0.11, 0, WALL);
    assert_int_equal(measure(), 0);
}

static void a_frame_of_another_size_is_refused(void **state)
{
    (void)state;
    struct exr_image small = {0};
    struct err err = ERR_INIT;
    assert_ok(exr_image_init(&small, 2, 2, &err), err);
    assert_int_equal(flicker_frame_set_quotients(&film.first, &small, "small.exr", &err), ST_DATA);
    assert_non_null(strstr(err.text, "small.exr has no channel R"));
    exr_image_release(&small);
}

#define FILM_TEST(f) cmocka_unit_test_setup_teardown(f, setup, teardown)
int main(void)
{
    const struct CMUnitTest tests[] = {
        FILM_TEST(light_that_belongs_to_places_is_steady), FILM_TEST(a_frame_that_is_brighter_than_the_last_is_found),
        FILM_TEST(furniture_and_objects_do_not_count),     FILM_TEST(places_whose_light_stays_do_not_count),
        FILM_TEST(a_frame_of_another_size_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
