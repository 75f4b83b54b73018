/* Glossy materials in a field of light: where they are, and what a ray sees of them, against closed forms.
 */
#include <math.h>

#include "common/base/parallel.h"
#include "common/math/numbers.h"
#include "tests/unit/common/gather/glossy_field.h"

/* A wall in the room, on the floor, behind which v0 does not see the floor. */
static const struct box divided[] = {
    ROOM_OUTSIDE, ROOM_INSIDE, {"screen", "screen", {0.5, -2, -2}, {0.6, 2, -1}, false}};
static const double mirror = 5001 / (2 * PI); /* k_s for which Phong's lobe with n = 5000 reflects all */

/* What a viewer sees of a point of the floor. */
static struct light_look see(const struct model_field *f, struct vec3 viewer, struct vec3 at)
{
    return look_one(f, viewer, vec3_make(0, 0, 1), vec3_sub(at, viewer));
}

static void assert_colour(struct rgb got, double r, double g, double b, double within)
{
    if (!(fabs(got.r - r) <= within && fabs(got.g - g) <= within && fabs(got.b - b) <= within))
        fail_msg("%.9g %.9g %.9g, expected %.9g %.9g %.9g", got.r, got.g, got.b, r, g, b);
}

/* ----------------------------------------------------------------------------------------------------- what is seen */

/* From v0 the point shows the wall -x (1 0 0), from the other viewer the wall +x (0 1 0). */
static void a_mirror_shows_what_it_mirrors_in_place_of_what_the_photo_saw(void **state)
{
    struct built b;
    const struct model_field *f = glossy_floor(&b, coloured, phong(mirror, 5000));
    const struct vec3 at = {-1.5, 0.25, -2};
    (void)state;
    const struct light_look seen = see(f, vec3_make(-1.9, 0.25, -1.5), vec3_make(1.8, 0.25, -2));
    assert_int_equal(seen.source, LIGHT_MATERIAL);
    /* v0 sees in (1.8, 0.25) the wall +x too: nothing changes */
    assert_colour(seen.radiance, 3, 3, 3, 0.01);
    const struct light_look other = see(f, vec3_make(-1.95, 0.25, -1.9), at);
    assert_colour(other.radiance, 3 - 1, 3 + 1, 3, 0.01);
    assert_near(other.distance, hypot(0.45, 0.1), 1e-3);
    model_field_release(&b.field);
}

static void a_mirror_in_uniform_light_looks_as_photographed(void **state)
{
    struct built b;
    const struct model_field *f = glossy_floor(&b, grey, phong(mirror, 5000));
    (void)state;
    for (int i = 0; i < 50; i++) {
        const struct light_look seen =
            see(f, vec3_make(1, 1, -1 + 0.02 * i), vec3_make(-1.9 + 0.07 * i, 0.3 - 0.02 * i, -2));
        assert_colour(seen.radiance, 1, 1, 1, 1e-3);
        assert_int_equal(seen.source, LIGHT_MATERIAL);
    }
    model_field_release(&b.field);
}

/* In uniform light the lobe with n = 1 reflects pi (1 + cos t) / 2 to a viewer at an angle t from the normal. */
static void the_widest_lobe_in_uniform_light_is_its_closed_form(void **state)
{
    enum { COUNT = 400 };
    struct built b;
    const double ks = 0.2;
    const struct model_field *f = glossy_floor(&b, grey, phong(ks, 1));
    double got = 0, wanted = 0;
    (void)state;
    for (int i = 0; i < COUNT; i++) {
        const struct vec3 viewer = {1.5, -1, -1.5}, at = {-1 + 0.002 * i, 0.25 + 0.001 * i, -2};
        const struct vec3 to = vec3_normalize(vec3_sub(viewer, at)), back = vec3_normalize(vec3_sub(eye0, at));
        got += see(f, viewer, at).radiance.g - 1;
        wanted += ks * PI / 2 * (to.z - back.z);
    }
    assert_true(wanted < -0.1 * COUNT);
    assert_near(got, wanted, 0.01);
    model_field_release(&b.field);
}

/* Floor and ceiling are mirrors. In the floor, the ceiling is as photographed: a second reflection would add to it. */
static void a_nested_gather_is_never_deeper_than_one(void **state)
{
    struct built b = {.files = {.model = write_boxes(room, 2), .vita = write_vita(coloured, 6, 0)}};
    char text[512];
    snprintf(text, sizeof text, "material shiny phong 0 0 0 %.17g 5000\nregion shiny v0 " ALL "region shiny v1 " ALL,
             mirror);
    const struct model_field *f = read_with(&b, text);
    const struct vec3 viewer = {0, -0.3, -0.3}, at = {-0.5, -0.3, -2}, up_at = {-1.2, -0.3, 2};
    (void)state;
    assert_int_equal(model_field_material(f, CEILING, up_at), 0);
    /* the ceiling shows the wall -x; v0 sees the floor in it */
    const struct vec3 low = {0.5, -0.3, 1};
    const struct light_look ceiling = look_one(f, low, up, vec3_sub(up_at, low));
    assert_int_equal(ceiling.source, LIGHT_MATERIAL);
    assert_colour(ceiling.radiance, 4 + 1 - 3, 0, 4 - 3, 0.01);
    /* the mirrored ray reaches the ceiling, 4 0 4 as photographed, and v0's too */
    assert_int_equal(see(f, viewer, at).source, LIGHT_MATERIAL);
    assert_colour(see(f, viewer, at).radiance, 3, 3, 3, 0.01);
    /* v0 sees the wall -x in the floor here */
    const struct vec3 aside = {-1.8, 0.25, -2};
    assert_colour(see(f, vec3_make(-1.5, 0.25, -0.8), aside).radiance, 3, 3, 3, 0.01);
    assert_colour(see(f, vec3_make(-1.8, 0.25, -0.8), aside).radiance, 3 + 4 - 1, 3, 3 + 4, 0.01);
    model_field_release(&b.field);
}

static void towards_the_texels_own_viewpoint_nothing_changes(void **state)
{
    struct built b;
    const struct model_field *f = glossy_floor(&b, coloured, phong(0.3, 20));
    (void)state;
    for (int i = 0; i < 20; i++)
        assert_colour(see(f, eye0, vec3_make(-1.9 + 0.19 * i, 0.1 * i - 1, -2)).radiance, 3, 3, 3, 1e-5);
    model_field_release(&b.field);
}

static void without_light_left_radiance_is_0_and_not_below(void **state)
{
    static const float dark_floor[6][3] = {{5, 5, 5}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0.25f, 0.25f, 0.25f},
                                           {0, 0, 0}};
    struct built b;
    const struct model_field *f = glossy_floor(&b, dark_floor, phong(mirror, 5000));
    (void)state;
    const struct light_look seen = see(f, vec3_make(-1.95, 0.25, -1.9), vec3_make(-1.8, 0.25, -2));
    assert_int_equal(seen.source, LIGHT_MATERIAL);
    assert_colour(seen.radiance, 0, 0, 0, 0);
    model_field_release(&b.field);
}

/* ------------------------------------------------------------------------------------------------------- hard cases */

static void k_s_of_0_and_lambert_keep_the_texels(void **state)
{
    static const char *const lines[] = {"phong 1 1 1 0 20", "ward 1 1 1 0 0.1", "lambert 1 1 1 0 0"};
    (void)state;
    for (int i = 0; i < 3; i++) {
        struct built b;
        const struct model_field *f = glossy_floor(&b, coloured, lines[i]);
        const struct light_look seen = see(f, vec3_make(-1.95, 0.25, -1.9), vec3_make(-1.5, 0.25, -2));
        assert_colour(seen.radiance, 3, 3, 3, 0);
        assert_int_equal(seen.source, LIGHT_TEXTURE);
        assert_int_equal(model_field_material(f, FLOOR, vec3_make(-1.5, 0.25, -2)), 0);
        assert_near(f->materials.brdfs[0].ks, 0, 0);
        model_field_release(&b.field);
    }
}

static void grazing_rays_give_finite_light_with_n_1_and_5000_and_ward(void **state)
{
    static const char *const lines[] = {"phong 0 0 0 0.3 1", "phong 0 0 0 800 5000", "ward 0 0 0 0.3 0.02",
                                        "ward 0 0 0 0.3 1"};
    (void)state;
    for (int i = 0; i < 4; i++) {
        struct built b;
        const struct model_field *f = glossy_floor(&b, coloured, lines[i]);
        for (int k = 1; k <= 14; k++) {
            const double height = pow(10, -0.5 * k);
            const struct light_look seen = see(f, vec3_make(1.9, 0, height - 2), vec3_make(-1.2, 0.1, -2));
            assert_true(isfinite(seen.radiance.r) && isfinite(seen.radiance.g) && isfinite(seen.radiance.b));
            assert_true(seen.radiance.r >= 0 && seen.radiance.g >= 0 && seen.radiance.b >= 0);
            /* n = 5000 may mirror what is brighter; no lobe may shine many times as bright as all there is */
            assert_true(rgb_max(seen.radiance) < 20);
        }
        model_field_release(&b.field);
    }
}

/* ----------------------------------------------------------------------------------------------------------- places */

static void a_material_is_where_a_region_holds_what_its_view_sees(void **state)
{
    struct built b = {.files = {.model = write_boxes(divided, 3), .vita = write_vita(coloured, 6, 0)}};
    /* columns 200 to 400 are x > -1 */
    const struct model_field *f = read_with(&b, "material none lambert 1 1 1 0 0\nmaterial shiny phong 0 0 0 0.3 20\n"
                                                "region shiny v0 200 0 400 0 400 400 200 400\n");
    (void)state;
    assert_int_equal(model_field_material(f, FLOOR, vec3_make(-0.9, 0.3, -2)), 1);
    assert_int_equal(model_field_material(f, FLOOR, vec3_make(-1.1, 0.3, -2)), -1);
    assert_int_equal(model_field_material(f, FLOOR, vec3_make(0.3, -1.5, -2)), 1);
    /* hidden from v0 until 2 x 1.6 - 1 = 2.2, behind a screen of 1 with its eye at 2 */
    assert_int_equal(model_field_material(f, FLOOR, vec3_make(1.5, 0.3, -2)), -1);
    assert_int_equal(model_field_material(f, CEILING, vec3_make(0, 0, 2)), -1);
    assert_int_equal(model_field_material(f, 99, vec3_make(0, 0, 2)), -1);
    assert_int_equal(see(f, vec3_make(0, 0, 1), vec3_make(-1.1, 0.3, -2)).source, LIGHT_TEXTURE);
    assert_int_equal(see(f, vec3_make(0, 0, 1), vec3_make(-0.9, 0.3, -2)).source, LIGHT_MATERIAL);
    assert_int_equal(f->materials.texels[0], 0);
    assert_true(f->materials.texels[1] > 500);
    model_field_release(&b.field);
}

static void of_two_materials_the_first_counts(void **state)
{
    struct built b = {.files = {.model = write_boxes(room, 2), .vita = write_vita(coloured, 6, 0)}};
    const struct model_field *f =
        read_with(&b, "material a lambert 1 1 1 0 0\nmaterial b phong 0 0 0 0.3 20\nregion b v0 " ALL
                      "region a v0 200 0 400 0 400 400 200 400\n");
    (void)state;
    assert_int_equal(model_field_material(f, FLOOR, vec3_make(0.5, 0.3, -2)), 0);
    assert_int_equal(model_field_material(f, FLOOR, vec3_make(-1.5, 0.3, -2)), 1);
    model_field_release(&b.field);
}

static const struct field_mark *mark_at(const struct model_field *f, int face, struct vec3 p)
{
    const int mark = field_atlas_look(&f->atlas, face, p).mark;
    assert_true(mark >= 0 && mark < f->materials.mark_count);
    return &f->materials.marks[mark];
}

/* The wall -x is synthesised; the ceiling comes from v0, and its region is in v1. */
static void a_texel_has_the_viewpoint_of_its_view_or_of_the_region(void **state)
{
    struct built b = {.files = {.model = write_boxes(room, 2), .vita = write_vita(coloured, 6, 0)}};
    const struct model_field *f = read_with(&b, "material m phong 0 0 0 0.3 20\nregion m v1 " ALL);
    const struct vec3 synthesised = mark_at(f, FIRST, vec3_make(-2, 0, 1.8))->viewpoint;
    const struct vec3 seen = mark_at(f, CEILING, vec3_make(0.1, 0.1, 2))->viewpoint;
    (void)state;
    assert_true(vec3_length(vec3_sub(synthesised, eye1)) < 1e-9);
    assert_true(vec3_length(vec3_sub(seen, eye0)) < 1e-9);
    model_field_release(&b.field);
}

static void what_is_wrong_is_named_with_file_and_line(void **state)
{
    struct built b = {.files = {.model = write_boxes(room, 2), .vita = write_vita(coloured, 6, 0)}};
    struct model_field *f = read_field(&b);
    struct err err = ERR_INIT;
    const char *path = scratch_write("materials.txt", "remodel-materials 1\nmaterial m phong 0 0 0 1 20\n"
                                                      "region m v7 0 0 9 0 9 9\n");
    (void)state;
    assert_int_equal(model_field_read_materials(f, path, write_views(), &axes, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "materials.txt:3: found \"v7\"");
    model_field_release(&b.field);
}

/* ---------------------------------------------------------------------------------------------------------- gathers */

enum { POINTS = 24 };

struct gathers {
    const struct model_field *field;
    struct irradiance e[POINTS];
};

static void gather_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct gathers *g = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        const struct gather_point p = {{-1.5 + 0.1 * (double)i, 0.2, 2}, {0, 0, -1}};
        ray_irradiance(&g->e[i], &g->field->field, p, 512, i);
    }
}

static void gathers_have_the_same_bits_for_any_number_of_threads(void **state)
{
    static struct gathers g[2];
    struct built b[2];
    (void)state;
    for (int k = 0; k < 2; k++) {
        parallel_set_threads(k ? 4 : 1);
        g[k].field = glossy_floor(&b[k], coloured, phong(0.3, 20));
        parallel_for(POINTS, 1, gather_some, &g[k]);
    }
    parallel_set_threads(0);
    for (int i = 0; i < POINTS; i++) {
        assert_memory_equal(&g[0].e[i].value, &g[1].e[i].value, sizeof g[0].e[i].value);
        assert_memory_equal(&g[0].e[i].from, &g[1].e[i].from, sizeof g[0].e[i].from);
        assert_true(g[0].e[i].from[LIGHT_MATERIAL] > 0.1);
    }
    for (int k = 0; k < 2; k++) model_field_release(&b[k].field);
}

/* A floor that mirrors the ceiling above it: points of the ceiling get the light that the closed form gives. */
static void a_gather_by_a_glossy_floor_agrees_with_looks_at_it(void **state)
{
    struct built b;
    const struct model_field *f = glossy_floor(&b, grey, phong(0.2, 1));
    const struct gather_point p = {{0.3, -0.4, 2}, {0, 0, -1}};
    struct irradiance e;
    double floor = 0, off = 0;
    enum { GRID = 64 };
    (void)state;
    /* pi, but for what the floor's points gain or lose by the closed form of the widest lobe */
    for (int i = 0; i < GRID * GRID; i++) {
        const double side = 4.0 / GRID;
        const struct vec3 at = {-2 + (i % GRID + 0.5) * side, -2 + ((double)(i / GRID) + 0.5) * side, -2};
        const struct vec3 to = vec3_sub(p.at, at), back = vec3_normalize(vec3_sub(eye0, at));
        const double distance = vec3_length(to), cosine = to.z / distance;
        const double factor = cosine * cosine * side * side / (distance * distance);
        floor += factor;
        off += factor * 0.2 * PI / 2 * (cosine - back.z);
    }
    ray_irradiance(&e, &f->field, p, 1 << 16, 1);
    assert_near(e.from[LIGHT_MATERIAL] * e.value.g, floor + off, 0.01);
    assert_near(e.value.g - PI, off, 0.02);
    model_field_release(&b.field);
}

static void a_lamp_that_is_switched_is_off_in_reflections(void **state)
{
    struct built b = {.files = {.model = write_boxes(room, 2), .vita = write_vita(grey, 6, 0)}};
    b.files.lights = write_lights("quad lamp 0.5 0.5 2 0.3 0 0 0 -0.3 0 50 50 50 90 0\n");
    char text[256];
    snprintf(text, sizeof text, "material m phong 0 0 0 %.17g 5000\nregion m v0 " ALL, mirror);
    struct model_field *f = read_with(&b, text);
    const struct vec3 viewer = {0.5, 0.5, 0}, at = {0.5, 0.5, -2};
    (void)state;
    assert_colour(see(f, viewer, at).radiance, 50, 50, 50, 2.5);
    assert_int_equal(f->plain.emitter_count, 1);
    model_field_switch_lamp(f, -1, false);
    assert_int_equal(f->plain.emitter_count, 0);
    assert_colour(see(f, viewer, at).radiance, 1, 1, 1, 0.01);
    model_field_release(&b.field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mirror_shows_what_it_mirrors_in_place_of_what_the_photo_saw),
        cmocka_unit_test(a_mirror_in_uniform_light_looks_as_photographed),
        cmocka_unit_test(the_widest_lobe_in_uniform_light_is_its_closed_form),
        cmocka_unit_test(a_nested_gather_is_never_deeper_than_one),
        cmocka_unit_test(towards_the_texels_own_viewpoint_nothing_changes),
        cmocka_unit_test(without_light_left_radiance_is_0_and_not_below),
        cmocka_unit_test(k_s_of_0_and_lambert_keep_the_texels),
        cmocka_unit_test(grazing_rays_give_finite_light_with_n_1_and_5000_and_ward),
        cmocka_unit_test(a_material_is_where_a_region_holds_what_its_view_sees),
        cmocka_unit_test(of_two_materials_the_first_counts),
        cmocka_unit_test(a_texel_has_the_viewpoint_of_its_view_or_of_the_region),
        cmocka_unit_test(what_is_wrong_is_named_with_file_and_line),
        cmocka_unit_test(gathers_have_the_same_bits_for_any_number_of_threads),
        cmocka_unit_test(a_gather_by_a_glossy_floor_agrees_with_looks_at_it),
        cmocka_unit_test(a_lamp_that_is_switched_is_off_in_reflections),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
