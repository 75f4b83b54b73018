/* film_lens.c - tests of a film's size, focal length and upright direction. */
#include "common/film/film_lens.h"

#include "tests/unit/scratch.h"

/* Two views along z, and one that is stored on its side. */
static struct view views[] = {
    {.name = "a", .width = 320, .height = 240, .fx = 300, .fy = 300, .cx = 160, .cy = 120},
    {.name = "b", .width = 320, .height = 240, .fx = 330, .fy = 330, .cx = 160, .cy = 120},
    {.name = "side", .width = 240, .height = 320, .fx = 310, .fy = 310, .cx = 120, .cy = 160},
};
static const struct vec3 ups[] = {{0, -1, 0}, {0, -1, 0}, {-1, 0, 0}};
static const struct mat3 straight = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, turned = {{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}},
                         upside_down = {{{-1, 0, 0}, {0, -1, 0}, {0, 0, 1}}};
static struct camera_set set = {.views = views, .view_count = 3};

static int set_up(void **state)
{
    (void)state;
    views[0].cam_from_world = views[1].cam_from_world = straight;
    views[2].cam_from_world = turned;
    set.view_count = 3;
    return 0;
}

static void assert_near(double a, double b) { assert_true(fabs(a - b) < 1e-12 * (1 + fabs(b))); }

static void the_focal_length_is_the_views_mean(void **state)
{
    (void)state;
    struct film_size size = {.max_side = 1280};
    struct view lens;
    struct vec3 up;
    film_lens(&lens, &up, &set, 0, ups, &size);
    assert_near(up.y, -1);
    assert_true(lens.width == 320 && lens.height == 240 && lens.cx == 160 && lens.cy == 120);
    assert_string_equal(lens.name, "film");
    assert_near(lens.fx, (300 + 330 + 310) / 3.0);
    assert_near(lens.fy, lens.fx);
    size.width = 640;
    size.height = 101; /* wider than the photos: filled by their width */
    film_lens(&lens, &up, &set, 0, ups, &size);
    assert_true(lens.width == 640 && lens.height == 102);
    assert_near(lens.fx, 2 * (300 + 330 + 310) / 3.0);
}

static void sizes_are_even_and_the_frame_is_filled(void **state)
{
    (void)state;
    static const struct {
        int width, height, max_side, want_width, want_height;
        double focal; /* for views of 320 x 240 with focal length 320 */
    } cases[] = {
        {0, 0, 1280, 320, 240, 320},
        {0, 0, 160, 160, 120, 160},
        {0, 0, 202, 202, 152, 152 * 320 / 240.0},
        {641, 0, 16, 642, 480, 642},
        {0, 180, 16, 240, 180, 240},
        {640, 360, 16, 640, 360, 640},
        {180, 320, 16, 180, 320, 320 * 320 / 240.0},
        {0, 0, 16, 16, 12, 16},
    };
    views[0].fx = views[0].fy = 320;
    set.view_count = 1;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const struct film_size size = {cases[i].width, cases[i].height, cases[i].max_side};
        struct view lens;
        struct vec3 up;
        film_lens(&lens, &up, &set, 0, NULL, &size);
        assert_int_equal(lens.width, cases[i].want_width);
        assert_int_equal(lens.height, cases[i].want_height);
        assert_near(lens.fx, cases[i].focal);
        assert_true(lens.cx == 0.5 * lens.width && lens.cy == 0.5 * lens.height);
    }
    views[0].fx = views[0].fy = 300;
}

static void the_orientation_of_the_middle_view_sets_that_of_the_film(void **state)
{
    (void)state;
    const struct film_size size = {.max_side = 1280};
    struct view lens;
    struct vec3 up;
    film_lens(&lens, &up, &set, 2, ups, &size); /* stored 240 x 320, shown 320 x 240 */
    assert_true(lens.width == 320 && lens.height == 240);
    assert_near(up.y, -1);
    film_lens(&lens, &up, &set, 2, NULL, &size); /* as it is stored */
    assert_true(lens.width == 240 && lens.height == 320);
    assert_near(lens.fx, (300 + 330 + 310) / 3.0);
}

static void contradictory_ups_leave_the_middle_views(void **state)
{
    (void)state;
    const struct film_size size = {.max_side = 1280};
    struct view lens;
    struct vec3 up;
    views[1].cam_from_world = upside_down;
    set.view_count = 2;
    film_lens(&lens, &up, &set, 0, NULL, &size);
    assert_near(up.y, -1);
    film_lens(&lens, &up, &set, 1, NULL, &size);
    assert_near(up.y, 1);
    assert_near(vec3_length(up), 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(the_focal_length_is_the_views_mean, set_up),
        cmocka_unit_test_setup(sizes_are_even_and_the_frame_is_filled, set_up),
        cmocka_unit_test_setup(the_orientation_of_the_middle_view_sets_that_of_the_film, set_up),
        cmocka_unit_test_setup(contradictory_ups_leave_the_middle_views, set_up),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
