/* Pictures of rooms under the light that edits make: what does not change, energy, and hard cases. */
#include "tests/unit/relight/relit_room.h"

#include "common/base/parallel.h"

static const char ceiling_lamp[] = "quad lamp 0.5 0 1.99 0.5 0 0 0 -0.5 0 20 20 20 90 0\n";

/* -------------------------------------------------------------------------------------------------------- unchanged */

static void an_edit_without_statements_gives_the_photo_back_bit_for_bit(void **state)
{
    struct edit e = edit_of_closed_room(coloured);
    struct relit_room r;
    (void)state;
    e.lights = ceiling_lamp;
    relight_room(&r, &e, vec3_make(0.1, 0.2, -1), to_floor);
    assert_memory_equal(r.picture.rgb, r.was, sizeof r.was);
    for (int i = 0; i < PIXELS; i++) {
        for (int c = 0; c < 3; c++) assert_true(r.relit.quotient[i][c] == 1);
        assert_int_equal(r.picture.made[i], MADE_PHOTO);
        assert_memory_equal(&r.relit.before[i], &r.relit.after[i], sizeof *r.relit.before);
    }
    relit_room_release(&r);
}

static void an_edit_without_statements_leaves_a_room_with_a_window_alone(void **state)
{
    struct edit e = {.before = window_room,
                     .after = window_room,
                     .before_count = COUNT(window_room),
                     .after_count = COUNT(window_room),
                     .colours = coloured,
                     .sky = 5};
    struct relit_room r;
    (void)state;
    e.lights = ceiling_lamp;
    relight_room(&r, &e, vec3_make(0.1, 0.2, -1), to_ceiling);
    assert_memory_equal(r.picture.rgb, r.was, sizeof r.was);
    relit_room_release(&r);
}

/* ----------------------------------------------------------------------------------------------------------- energy */

static void with_windows_walled_up_and_lamps_off_a_room_becomes_black(void **state)
{
    struct texture_lamp lamp = {(char *)"lamp", {0, 0, 0}};
    struct texture_rule paint = rule_colour(0.5f);
    struct texture_face infill = {.id = room_id("infill/2"),
                                  .name = (char *)"infill/2",
                                  .normal = {0, -1, 0},
                                  .offset = -2,
                                  .rules = &paint,
                                  .rule_count = 1};
    struct edit e = {.before = window_room,
                     .after = walled_room,
                     .before_count = COUNT(window_room),
                     .after_count = COUNT(walled_room),
                     .colours = plain,
                     .sky = 5};
    struct relit_room r;
    (void)state;
    e.lights = ceiling_lamp;
    e.map = (struct texture_map){.lamps = &lamp, .lamp_count = 1, .faces = &infill, .face_count = 1};
    for (int k = 0; k < 2; k++) {
        relight_room(&r, &e, vec3_make(0.1, 0.2, 0), k ? to_ceiling : to_floor);
        for (int i = 0; i < 3 * PIXELS; i++)
            if (!(r.picture.rgb[i] <= 1e-4f * 0.3f && r.picture.rgb[i] >= 0))
                fail_msg("pixel (%d, %d) is %g, of kind %d", i / 3 % WIDTH, i / 3 / WIDTH, (double)r.picture.rgb[i],
                         r.pixels.kind[i / 3]);
        relit_room_release(&r);
    }
}

static void twice_the_lamps_give_twice_the_radiance(void **state)
{
    struct texture_lamp lamps[2] = {{(char *)"lamp", {2, 2, 2}}, {(char *)"spot", {2, 2, 2}}};
    struct edit e = edit_of_closed_room(lit);
    struct relit_room r;
    (void)state;
    e.lights = "quad lamp 0.5 0 1.99 0.5 0 0 0 -0.5 0 60 60 60 90 0\ndisk spot -1 -1 1.99 0 0 -1 0.1 90 90 90 40 2\n";
    e.map = (struct texture_map){.lamps = lamps, .lamp_count = 2};
    for (int k = 0; k < 2; k++) {
        relight_room(&r, &e, vec3_make(0.1, 0.2, 0), k ? to_ceiling : to_floor);
        for (int i = 0; i < 3 * PIXELS; i++) assert_near((double)r.picture.rgb[i], 2 * (double)r.was[i], 0.01);
        assert_no_fireflies(&r, NULL);
        relit_room_release(&r);
    }
}

/* ----------------------------------------------------------------------------------------------------- dark, ratios */

/* A lamp of 1e4 times the light where it was all but dark: no quotient but a bounded one lights a wall that seems
 * white. */
static void a_lamp_that_becomes_ten_thousand_times_as_bright_gives_that_quotient(void **state)
{
    static const float dim[6][3] = {{1e-6f, 1e-6f, 1e-6f}, {1e-6f, 1e-6f, 1e-6f}, {1e-6f, 1e-6f, 1e-6f},
                                    {1e-6f, 1e-6f, 1e-6f}, {1e-6f, 1e-6f, 1e-6f}, {1e-6f, 1e-6f, 1e-6f}};
    struct texture_lamp lamp = {(char *)"lamp", {1e4, 1e4, 1e4}};
    struct edit e = edit_of_closed_room(dim);
    struct relit_room r;
    (void)state;
    e.lights = "quad lamp 0.5 0 1.99 0.5 0 0 0 -0.5 0 1e-3 1e-3 1e-3 90 0\n";
    e.map = (struct texture_map){.lamps = &lamp, .lamp_count = 1};
    relight_room(&r, &e, vec3_make(0.1, 0.2, 0), to_floor);
    for (int i = 0; i < PIXELS; i++) {
        assert_near((double)r.relit.quotient[i][1], 1e4, 0.02);
        assert_true(r.relit.quotient[i][3] == RELIT_SURE);
    }
    assert_no_fireflies(&r, NULL);
    relit_room_release(&r);
}

/* Behind furniture that the model knows as a wall, no light was found before; then the wall goes. */
static void without_light_before_pixels_are_bounded_and_marked(void **state)
{
    static const struct box hidden[] = {SLAB_WEST,
                                        SLAB_EAST,
                                        SLAB_SOUTH,
                                        SLAB_NORTH,
                                        SLAB_FLOOR,
                                        SLAB_TOP,
                                        {"walls", "crate", {0.5, -1, -2}, {1.5, 1, -1}, false}};
    struct edit e = {.before = hidden,
                     .after = closed_room,
                     .before_count = COUNT(hidden),
                     .after_count = COUNT(closed_room),
                     .colours = plain};
    struct relit_room r;
    int marked = 0;
    (void)state;
    e.lights = ceiling_lamp;
    relight_room(&r, &e, vec3_make(0, 0, 1), to_floor);
    for (int i = 0; i < PIXELS; i++) {
        const struct vec3 p = r.pixels.after[i].at;
        if (!(p.z < -1.99 && p.x > 0.55 && p.x < 1.45 && fabs(p.y) < 0.95)) continue;
        assert_near(r.relit.before[i].value.g, 0, 1e-9);
        assert_true(r.relit.quotient[i][3] == RELIT_BOUNDED);
        const double most = (double)r.was[3 * i + 1] + 0.95 * r.relit.after[i].value.g / PI;
        assert_near((double)r.picture.rgb[3 * i + 1], most, 1e-5);
        marked++;
    }
    assert_true(marked > 10);
    assert_no_fireflies(&r, NULL);
    relit_room_release(&r);
}

/* ---------------------------------------------------------------------------------------------------------- objects */

/* It is all but black. */
static void an_object_that_touches_the_walls_and_the_floor_casts_shadows_alone(void **state)
{
    struct edit e = edit_of_closed_room(lit);
    struct relit_room r;
    int drawn = 0;
    (void)state;
    e.lights = bright_lamp;
    e.objects = "object block mesh.obj %s 1 0 0 1 0 1 0 1 0 0 1 -2 matt 0.02 0.02 0.02\n";
    e.mesh = cube;
    relight_room(&r, &e, vec3_make(0, 0, 1), to_floor);
    for (int i = 0; i < PIXELS; i++) {
        drawn += r.picture.made[i] == MADE_COLOUR;
        for (int c = 0; c < 3; c++)
            if (r.picture.made[i] == MADE_PHOTO) assert_true(r.relit.quotient[i][c] < 1.02f);
    }
    assert_true(drawn > 10);
    assert_no_fireflies(&r, NULL);
    relit_room_release(&r);
}

/* All is object: its inside, which a lamp within lights. */
static void an_object_around_the_camera_and_the_lamp_is_seen_from_inside(void **state)
{
    struct edit e = edit_of_closed_room(plain);
    struct relit_room r;
    (void)state;
    e.lights = "disk lamp 0 0 0.9 0 0 -1 0.2 20 20 20 90 0\n";
    e.objects = "object block mesh.obj %s 2 0 0 -1 0 2 0 -1 0 0 2 -1 matt 0.5 0.5 0.5\n";
    e.mesh = cube;
    relight_room(&r, &e, vec3_make(0, 0, 0.5), to_floor);
    /* power = area (1 - albedo) E + front E, as in a painted room */
    const double power = PI * 20 * PI * 0.04, mean = power / (24 * 0.5 + PI * 0.04);
    double sum = 0;
    for (int i = 0; i < PIXELS; i++) {
        assert_int_equal(r.picture.made[i], MADE_COLOUR);
        assert_true(r.picture.rgb[3 * i + 1] > 0);
        sum += (double)r.picture.rgb[3 * i + 1] / PIXELS;
    }
    print_message("mean radiance %g, of the whole inside %g\n", sum, 0.5 * mean / PI);
    assert_true(sum > 0.5 * 0.5 * mean / PI && sum < 2 * 0.5 * mean / PI);
    assert_no_fireflies(&r, NULL);
    relit_room_release(&r);
}

static void a_lamp_inside_an_object_lights_nothing_else(void **state)
{
    struct edit e = edit_of_closed_room(plain);
    struct relit_room r;
    (void)state;
    e.lights = "disk lamp 1 1 -1.2 0 0 -1 0.2 20 20 20 90 0\nquad other -1 0 1.99 0.3 0 0 0 -0.3 0 9 9 9 90 0\n";
    e.objects = "object block mesh.obj %s 1 0 0 0.5 0 1 0 0.5 0 0 1 -1.99 matt 0.5 0.5 0.5\n";
    e.mesh = cube;
    relight_room(&r, &e, vec3_make(0, 0, 1), to_floor);
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3; c++) {
            if (r.picture.made[i] == MADE_PHOTO) assert_true(r.relit.quotient[i][c] < 1.02f);
            assert_true(r.picture.rgb[3 * i + c] < 1.2f);
        }
    assert_no_fireflies(&r, NULL);
    relit_room_release(&r);
}

/* From above, it shows the ceiling times the reflectance of its lobe. */
static void an_object_like_a_mirror_shows_the_room_without_noise(void **state)
{
    struct edit e = edit_of_closed_room(lit);
    struct relit_room r;
    int drawn = 0;
    (void)state;
    e.lights = "quad lamp 1.5 0 1.99 0.4 0 0 0 -0.5 0 80 80 80 90 0\n";
    e.objects = "object block mesh.obj %s 1 0 0 -1 0 1 0 -0.5 0 0 1 -2 phong 0 0 0 700 5000\n";
    e.mesh = cube;
    relight_room(&r, &e, vec3_make(-0.5, 0, 1), to_floor);
    for (int k = 0; k < r.pixels.object_count; k++) {
        const struct object_pixel *o = &r.pixels.objects[k];
        if (o->cover < 1 || o->point.normal.z < 0.5) continue;
        const struct vec3 d = vec3_make(-o->to_viewer.x, -o->to_viewer.y, o->to_viewer.z);
        const struct vec3 seen = vec3_add(o->point.at, vec3_scale(d, (2 - o->point.at.z) / d.z));
        const double ceiling = field_atlas_look(&r.change.after.atlas, CEILING, seen).radiance.g;
        assert_near((double)r.picture.rgb[3 * o->pixel + 1], ceiling * 2 * PI * 700 / 5001, 0.03);
        drawn++;
    }
    assert_true(drawn > 5);
    assert_no_fireflies(&r, NULL);
    relit_room_release(&r);
}

static void an_object_before_an_empty_pixel_is_drawn(void **state)
{
    struct edit e = edit_of_closed_room(plain);
    struct relit_room r = {.params = RELIGHT_PARAMS_DEFAULT};
    int drawn = 0;
    (void)state;
    e.objects = "object block mesh.obj %s 1 0 0 -0.5 0 1 0 -0.5 0 0 1 -2 matt 0.5 0.5 0.5\n";
    e.mesh = cube;
    edit_read(&r.change, &e);
    draw_picture(&r, vec3_make(0.013, 0.007, 1), to_floor, plain);
    memset(r.picture.made, MADE_NOTHING, PIXELS);
    memset(r.picture.rgb, 0, sizeof r.was);
    relight_picture(&r);
    for (int k = 0; k < r.pixels.object_count; k++) {
        const int i = r.pixels.objects[k].pixel;
        drawn++;
        assert_int_equal(r.picture.made[i], MADE_COLOUR);
        assert_true(r.picture.rgb[3 * i] > 0);
    }
    for (int i = 0; i < PIXELS; i++)
        if (r.picture.made[i] == MADE_NOTHING)
            assert_true(r.picture.rgb[3 * i] == 0 && r.relit.quotient[i][3] == RELIT_NONE);
    assert_true(drawn > 10);
    relit_room_release(&r);
}

/* ------------------------------------------------------------------------------------------------------------ lamps */

static void a_lamp_that_is_off_shows_the_light_that_falls_on_it(void **state)
{
    struct texture_lamp lamp = {(char *)"lamp", {0, 0, 0}};
    struct edit e = edit_of_closed_room(plain);
    struct relit_room r;
    int lamps = 0;
    (void)state;
    e.lights = "quad lamp 0 0 1.99 0.6 0 0 0 -0.6 0 20 20 20 90 0\nquad other 0 0 -1.99 0.6 0 0 0 0.6 0 5 5 5 90 0\n";
    e.map = (struct texture_map){.lamps = &lamp, .lamp_count = 1};
    relight_room(&r, &e, vec3_make(0, 0, 0), to_ceiling);
    for (int i = 0; i < PIXELS; i++) {
        if (r.pixels.kind[i] != PIXEL_LAMP) continue;
        lamps++;
        assert_true(r.relit.after[i].value.g > 0);
        assert_near((double)r.picture.rgb[3 * i + 1], 0.5 * r.relit.after[i].value.g / PI, 1e-5);
    }
    assert_true(lamps > 10);
    assert_no_fireflies(&r, NULL);
    relit_room_release(&r);
}

static void a_lamp_of_another_colour_is_that_many_times_as_bright(void **state)
{
    struct texture_lamp lamp = {(char *)"lamp", {0.5, 1, 2}};
    struct edit e = edit_of_closed_room(lit);
    struct relit_room r;
    int lamps = 0;
    (void)state;
    e.lights = "quad lamp 0 0 1.99 0.6 0 0 0 -0.6 0 60 60 60 90 0\n";
    e.map = (struct texture_map){.lamps = &lamp, .lamp_count = 1};
    relight_room(&r, &e, vec3_make(0.03, 0.05, 0), to_ceiling);
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3; c++) {
            const double q = (double)r.picture.rgb[3 * i + c] / (double)r.was[3 * i + c];
            assert_near(q, lamp.scale[c], 0.01);
            lamps += r.pixels.kind[i] == PIXEL_LAMP;
        }
    assert_true(lamps > 10);
    relit_room_release(&r);
}

/* ---------------------------------------------------------------------------------------------------------- threads */

static void threads_do_not_change_a_bit(void **state)
{
    struct texture_lamp lamp = {(char *)"lamp", {2, 1, 0.5}};
    struct edit e = edit_of_closed_room(coloured);
    struct relit_room one, two;
    (void)state;
    e.lights = ceiling_lamp;
    e.map = (struct texture_map){.lamps = &lamp, .lamp_count = 1};
    e.objects = "object block mesh.obj %s 1 0 0 -0.5 0 1 0 -0.5 0 0 1 -2 ward 0.3 0.3 0.3 0.2 0.1\n";
    e.mesh = cube;
    parallel_set_threads(1);
    relight_room(&one, &e, vec3_make(0, 0, 1), to_floor);
    parallel_set_threads(2);
    relight_room(&two, &e, vec3_make(0, 0, 1), to_floor);
    parallel_set_threads(0);
    assert_memory_equal(one.picture.rgb, two.picture.rgb, sizeof one.was);
    assert_memory_equal(one.relit.quotient, two.relit.quotient, PIXELS * sizeof *one.relit.quotient);
    assert_memory_equal(one.relit.after, two.relit.after, PIXELS * sizeof *one.relit.after);
    relit_room_release(&one);
    relit_room_release(&two);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_edit_without_statements_gives_the_photo_back_bit_for_bit),
        cmocka_unit_test(an_edit_without_statements_leaves_a_room_with_a_window_alone),
        cmocka_unit_test(with_windows_walled_up_and_lamps_off_a_room_becomes_black),
        cmocka_unit_test(twice_the_lamps_give_twice_the_radiance),
        cmocka_unit_test(a_lamp_that_becomes_ten_thousand_times_as_bright_gives_that_quotient),
        cmocka_unit_test(without_light_before_pixels_are_bounded_and_marked),
        cmocka_unit_test(an_object_that_touches_the_walls_and_the_floor_casts_shadows_alone),
        cmocka_unit_test(an_object_around_the_camera_and_the_lamp_is_seen_from_inside),
        cmocka_unit_test(a_lamp_inside_an_object_lights_nothing_else),
        cmocka_unit_test(an_object_like_a_mirror_shows_the_room_without_noise),
        cmocka_unit_test(an_object_before_an_empty_pixel_is_drawn),
        cmocka_unit_test(a_lamp_that_is_off_shows_the_light_that_falls_on_it),
        cmocka_unit_test(a_lamp_of_another_colour_is_that_many_times_as_bright),
        cmocka_unit_test(threads_do_not_change_a_bit),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
