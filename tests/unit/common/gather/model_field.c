/* The field of light of a textured model: texels, lamps, panes, the outdoors, and what an estimator makes of them. */
#include <math.h>

#include "common/capture/view_image.h"
#include "common/image/exr.h"
#include "common/math/numbers.h"
#include "tests/unit/common/gather/box_field.h"
#include "tests/unit/common/light/near.h"

/* A slab under the open sky. */
static const struct box slab[] = {{"walls", "slab", {-9, -9, -1}, {9, 9, 0}, false}};
/* A room that is open to +y, with a pane there. */
static const struct box open_room[] = {{"walls", "floor", {-2, -2, -1}, {2, 2, 0}, false},
                                       {"walls", "back", {-2, -3, -1}, {2, -2, 4}, false},
                                       {"glass/big", "pane", {-2, 2, 0}, {2, 2.01, 4}, false}};

/* Outdoors of one colour, with a sun at an elevation of 50 degrees and azimuth 180, where columns wrap around. */
static const char *write_outdoors(float colour, float sun, double radius)
{
    struct outdoors o;
    struct err err = ERR_INIT;
    const struct vec3 to_sun = {-cos(50 * DEGREE), 0, sin(50 * DEGREE)};
    const char *path = scratch_path("outdoors.exr");
    assert_ok(outdoors_init(&o, 512, &err), err);
    for (int y = 0; y < o.height; y++)
        for (int x = 0; x < o.width; x++) {
            const size_t at = (size_t)y * (size_t)o.width + (size_t)x;
            const bool lit = vec3_dot(outdoors_direction(&o, x + 0.5, y + 0.5), to_sun) > cos(radius);
            for (int c = 0; c < 3; c++) o.rgb[3 * at + (size_t)c] = lit ? sun : colour;
            o.source[at] = OUTDOORS_REFERENCE;
        }
    struct provenance prov = {0};
    assert_ok(outdoors_write(&o, path, &prov, &err), err);
    outdoors_release(&o);
    return path;
}

static struct irradiance gather(const struct model_field *f, int n, struct vec3 at, struct vec3 normal)
{
    struct hemicube *h;
    struct irradiance e;
    struct err err = ERR_INIT;
    assert_ok(hemicube_make(&h, n, &err), err);
    hemicube_irradiance(&e, h, &f->field, (struct gather_point){at, normal});
    hemicube_free(h);
    return e;
}

static void a_closed_room_of_one_radiance_gives_pi_times_it(void **state)
{
    struct built b = {.files = {.model = write_boxes(room, 2), .vita = write_vita(grey, 6, 0)}};
    const struct model_field *f = read_field(&b);
    const struct irradiance e = gather(f, 32, vec3_make(0.3, -1, -2), up);
    (void)state;
    assert_near(e.value.g, PI, 1e-9);
    assert_near(e.from[LIGHT_TEXTURE] + e.from[LIGHT_SYNTHESISED], 1, 1e-12);
    assert_true(e.from[LIGHT_SYNTHESISED] > 0.05 && e.from[LIGHT_SYNTHESISED] < 0.3);
    assert_int_equal(f->field.emitter_count, 0);
    model_field_release(&b.field);
}

static void each_face_shows_its_own_texels(void **state)
{
    struct built b = {.files = {.model = write_boxes(room, 2), .vita = write_vita(coloured, 6, 0)}};
    const struct model_field *f = read_field(&b);
    static const struct vec3 to[6] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
    (void)state;
    for (int i = 0; i < 6; i++) {
        const struct light_look seen = look_one(f, vec3_make(0.1, 0.2, -0.3), vec3_make(0, 0, 1), to[i]);
        assert_near(seen.radiance.r, (double)coloured[i][0], 1e-3);
        assert_near(seen.radiance.g, (double)coloured[i][1], 1e-3);
        assert_near(seen.radiance.b, (double)coloured[i][2], 1e-3);
        assert_int_equal(seen.source, i == 0 ? LIGHT_SYNTHESISED : LIGHT_TEXTURE);
    }
    assert_near(look_one(f, vec3_make(0.1, 0.2, -2), up, up).distance, 4, 1e-5);
    model_field_release(&b.field);
}

static void a_face_without_tiles_gives_no_light(void **state)
{
    struct built b = {.files = {.model = write_boxes(room, 2), .vita = write_vita(grey, 5, 0)}};
    const struct light_look seen = look_one(read_field(&b), vec3_make(0, 0, 0), up, up);
    (void)state;
    assert_int_equal(seen.source, LIGHT_NONE);
    assert_near(rgb_max(seen.radiance), 0, 0);
    model_field_release(&b.field);
}

static void a_ray_inside_a_solid_sees_nothing(void **state)
{
    struct built b = {.files = {.model = write_boxes(room, 2), .vita = write_vita(grey, 6, 0)}};
    const struct light_look seen = look_one(read_field(&b), vec3_make(0, 0, -2.5), up, up);
    (void)state;
    assert_int_equal(seen.source, LIGHT_NONE);
    assert_near(seen.distance, 0.5, 1e-4);
    model_field_release(&b.field);
}

static void a_point_just_below_a_surface_is_moved_to_it(void **state)
{
    struct built b = {.files = {.model = write_boxes(room, 2), .vita = write_vita(grey, 6, 0)}};
    const struct model_field *f = read_field(&b);
    struct gather_point p = {{0.5, 0.5, -2.1}, {0, 0, 1}}, deep = {{0.5, 0.5, -2.5}, {0, 0, 1}},
                        free = {{0, 0, 0}, {0, 0, 1}};
    (void)state;
    assert_true(model_field_lift(f, &p, 0.2));
    assert_near(p.at.z, -2, 1e-4);
    assert_near(gather(f, 16, p.at, p.normal).value.g, PI, 1e-9);
    assert_false(model_field_lift(f, &deep, 0.2));
    assert_false(model_field_lift(f, &free, 100));
    model_field_release(&b.field);
}

/* ------------------------------------------------------------------------------------------------------------ lamps */

static void a_lamp_shines_within_its_cone_alone(void **state)
{
    struct built b = {.files = {.model = write_boxes(room, 2), .vita = write_vita(grey, 6, 0)}};
    b.files.lights = write_lights("disk spot 0 0 1.995 0 0 -1 0.1 200 100 50 45 1\n");
    const struct model_field *f = read_field(&b);
    (void)state;
    const struct light_look under = look_one(f, vec3_make(0.05, 0, -2), up, up);
    assert_int_equal(under.source, LIGHT_LAMP);
    assert_near(under.radiance.r, 200, 1e-12);
    assert_near(under.distance, 3.995, 1e-4);
    const struct light_look aside = look_one(f, vec3_make(1, 0, 0.795), up, vec3_make(-1, 0, 1.2));
    assert_near(aside.radiance.g, 100 * 1.2 / hypot(1, 1.2), 1e-6);
    const struct light_look beyond = look_one(f, vec3_make(1, 0, 1.195), up, vec3_make(-1, 0, 0.8));
    assert_int_equal(beyond.source, LIGHT_LAMP);
    assert_near(beyond.radiance.g, 0, 0);
    assert_int_equal(look_one(f, vec3_make(0.11, 0, -2), up, up).source, LIGHT_SYNTHESISED);
    assert_int_equal(look_one(f, vec3_make(0.6, 0, -2), up, up).source, LIGHT_TEXTURE);
    assert_int_equal(f->field.emitter_count, 1);
    assert_int_equal(f->field.emitters[0].kind, EMITTER_DISK);
    assert_near(f->field.emitters[0].beta, PI / 4, 1e-12);
    model_field_release(&b.field);
}

static void a_lamp_a_little_behind_the_ceiling_is_seen(void **state)
{
    struct built b = {.files = {.model = write_boxes(room, 2), .vita = write_vita(grey, 6, 0)}};
    b.files.lights = write_lights("quad near 0 0 2.01 0.2 0 0 0 -0.3 0 7 7 7 90 0\n"
                                  "quad far 1 1 2.5 0.2 0 0 0 -0.3 0 7 7 7 90 0\n");
    const struct model_field *f = read_field(&b);
    (void)state;
    assert_int_equal(look_one(f, vec3_make(0.19, 0.29, -2), up, up).source, LIGHT_LAMP);
    assert_int_equal(look_one(f, vec3_make(0.21, 0.29, -2), up, up).source, LIGHT_SYNTHESISED);
    assert_true(look_one(f, vec3_make(1, 1, -2), up, up).source != LIGHT_LAMP);
    model_field_release(&b.field);
}

/* The wall ends at the ceiling, 2 cm below the lamp's plane on these rays. */
static void a_thin_wall_under_a_lamp_hides_the_part_beyond_it(void **state)
{
    static const struct box divided[] = {
        ROOM_OUTSIDE, ROOM_INSIDE, {"across", "across", {-0.001, -2, -2}, {0.001, 2, 2}, false}};
    struct built b = {.files = {.model = write_boxes(divided, 3), .vita = write_vita(grey, 6, 0)}};
    b.files.lights = write_lights("quad lamp 0 0 2.01 0.2 0 0 0 -0.3 0 7 7 7 90 0\n");
    const struct model_field *f = read_field(&b);
    const struct vec3 east = {0.5, 0, 1}, west = {-0.5, 0, 1};
    (void)state;
    assert_near(f->reach, 0.03, 1e-9);
    for (int side = 0; side < 2; side++) {
        const struct vec3 from = side ? east : west, own = {side ? 0.01 : -0.01, 0, 2.01}, other = {-own.x, 0, 2.01};
        assert_int_equal(look_one(f, from, up, vec3_sub(own, from)).source, LIGHT_LAMP);
        assert_true(look_one(f, from, up, vec3_sub(other, from)).source != LIGHT_LAMP);
    }
    model_field_release(&b.field);
}

static void a_lamp_that_hangs_is_not_seen_from_behind(void **state)
{
    struct built b = {.files = {.model = write_boxes(room, 2), .vita = write_vita(grey, 6, 0)}};
    b.files.lights = write_lights("disk hanging 0 0 0 0 0 -1 0.5 9 9 9 90 0\n");
    const struct model_field *f = read_field(&b);
    (void)state;
    assert_int_equal(look_one(f, vec3_make(0, 0, -2), up, up).source, LIGHT_LAMP);
    assert_int_equal(look_one(f, vec3_make(0, 0, 2), below, below).source, LIGHT_TEXTURE);
    model_field_release(&b.field);
}

/* The photographs' bright spot is two texels wider than the lamp on each side. */
static void texels_under_a_lamp_and_around_it_do_not_light_the_room_again(void **state)
{
    struct built b = {.files = {.model = write_boxes(room, 2), .vita = write_vita(grey, 6, 5)}};
    b.files.lights = write_lights("quad lamp 0 0 2 0.2 0 0 0 -0.2 0 100 100 100 90 0\n");
    struct model_field *f = read_field(&b);
    (void)state;
    assert_true(f->covered_texels > 100);
    const struct light_look rim = look_one(f, vec3_make(0.3, 0, -2), up, up);
    assert_near(rim.radiance.g, 1, 1e-3);
    assert_int_equal(rim.source, LIGHT_SYNTHESISED);
    model_field_switch_lamp(f, 0, false);
    assert_int_equal(f->field.emitter_count, 0);
    assert_near(look_one(f, vec3_make(0, 0, -2), up, up).radiance.g, 1, 1e-3);
    assert_near(gather(f, 64, vec3_make(0.1, 0.1, -2), up).value.g, PI, 1e-3);
    model_field_switch_lamp(f, -1, true);
    assert_int_equal(look_one(f, vec3_make(0, 0, -2), up, up).source, LIGHT_LAMP);
    model_field_release(&b.field);
}

static void a_gather_finds_a_lamps_irradiance(void **state)
{
    struct built b = {.files = {.model = write_boxes(room, 2), .vita = write_vita(grey, 6, 0)}};
    b.files.lights = write_lights("disk lamp 0.5 0.4 2 0 0 -1 0.4 20 20 20 60 2\n");
    struct model_field *f = read_field(&b);
    const struct vec3 at = {-0.5, -0.7, -2};
    (void)state;
    const double direct = lamp_irradiance(&f->lights.lamps[0], at, up).g;
    const struct irradiance with = gather(f, 512, at, up);
    model_field_switch_lamp(f, 0, false);
    const struct irradiance without = gather(f, 512, at, up);
    /* the lamp hides ceiling of radiance 1, which shines with neither cone nor exponent */
    struct lamp hidden = f->lights.lamps[0];
    hidden.radiance = rgb_grey(1);
    hidden.beta = PI / 2;
    hidden.exponent = 0;
    assert_near(with.value.g - without.value.g, direct - lamp_irradiance(&hidden, at, up).g, 5e-3);
    assert_near(with.from[LIGHT_LAMP], direct / with.value.g, 5e-3);
    model_field_release(&b.field);
}

/* --------------------------------------------------------------------------------------------------------- outdoors */

static void an_open_sky_gives_pi_times_its_radiance(void **state)
{
    struct built b = {.files = {.model = write_boxes(slab, 1), .vita = write_vita(grey, 6, 0)}};
    b.files.outdoors = write_outdoors(0.5f, 0.5f, 0);
    const struct model_field *f = read_field(&b);
    const struct irradiance e = gather(f, 32, vec3_make(1, 1, 0), up);
    (void)state;
    assert_near(e.value.g, 0.5 * PI, 1e-6);
    assert_near(e.from[LIGHT_SKY], 1, 1e-12);
    assert_true(isinf(e.nearest));
    assert_near(e.mean_inverse, 0, 0);
    assert_int_equal(f->field.emitter_count, 0);
    model_field_release(&b.field);
}

static void without_outdoors_it_is_dark_outside(void **state)
{
    struct built b = {.files = {.model = write_boxes(slab, 1), .vita = write_vita(grey, 6, 0)}};
    const struct light_look seen = look_one(read_field(&b), vec3_make(0, 0, 0), up, up);
    (void)state;
    assert_int_equal(seen.source, LIGHT_NONE);
    assert_near(rgb_max(seen.radiance), 0, 0);
    model_field_release(&b.field);
}

static void a_sun_is_found_with_its_energy_where_columns_wrap_around(void **state)
{
    struct built b = {.files = {.model = write_boxes(slab, 1), .vita = write_vita(grey, 6, 0)}};
    const double radius = 2 * DEGREE;
    b.files.outdoors = write_outdoors(0.5f, 1000, radius);
    const struct model_field *f = read_field(&b);
    (void)state;
    assert_int_equal(f->field.emitter_count, 1);
    const struct emitter *sun = &f->field.emitters[0];
    assert_int_equal(sun->kind, EMITTER_SUN);
    assert_near(sun->normal.z, sin(50 * DEGREE), 1e-3);
    assert_near(sun->normal.x, -cos(50 * DEGREE), 1e-3);
    assert_true(acos(sun->cone) > radius && acos(sun->cone) < radius + 1.5 * DEGREE);
    const double light = PI * sin(radius) * sin(radius) * 1000;
    assert_near(sun->luminance * 2 * PI * (1 - sun->cone), light, 0.02);
    const struct irradiance e = gather(f, 1024, vec3_make(1, 1, 0), up);
    assert_near(e.value.g, 0.5 * PI + light * sin(50 * DEGREE), 0.02);
    model_field_release(&b.field);
}

static void a_pane_lets_the_sky_in_and_is_an_emitter_unless_it_is_listed(void **state)
{
    struct built b = {.files = {.model = write_boxes(open_room, 3), .vita = write_vita(grey, 6, 0)}};
    b.files.outdoors = write_outdoors(0.5f, 0.5f, 0);
    const struct model_field *f = read_field(&b);
    (void)state;
    assert_int_equal(look_one(f, vec3_make(0, 0, 0), up, vec3_make(0, 1, 0.5)).source, LIGHT_SKY);
    assert_int_equal(f->field.emitter_count, 1);
    assert_int_equal(f->field.emitters[0].kind, EMITTER_QUAD);
    assert_near(f->field.emitters[0].normal.y, -1, 1e-12);
    assert_near(f->field.emitters[0].luminance, 0.5, 1e-2);
    assert_near(vec3_length(f->field.emitters[0].x) * vec3_length(f->field.emitters[0].y), 4, 1e-9);
    model_field_release(&b.field);
    b.files.lights = write_lights("opening big 0 2 2 1 0 0 0 0 1\n");
    f = read_field(&b);
    assert_int_equal(f->field.emitter_count, 1);
    assert_near(f->field.emitters[0].centre.z, 2, 1e-12);
    assert_near(vec3_length(f->field.emitters[0].x), 1, 1e-12);
    model_field_release(&b.field);
}

/* A pinhole picture of 7.5, 90 degrees wide, from (0, 1.9, 2) of the model towards +y. */
static const char *write_reference(bool with_pose)
{
    static const char *const names[] = {"R", "G", "B", "clipped", "variance"};
    static const struct mat3 towards_y = {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}};
    struct view v = {.cam_from_world = towards_y, .center = {0, 1.9, 2}};
    struct exr_image im = {0};
    struct exr_plane *plane;
    struct err err = ERR_INIT;
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, v.center), -1);
    assert_ok(exr_image_init(&im, 64, 64, &err), err);
    for (int k = 0; k < 5; k++) {
        assert_ok(exr_add_plane(&im, names[k], k == 3 ? EXR_UINT : EXR_FLOAT, &plane, &err), err);
        for (int i = 0; i < 64 * 64 && k != 3; i++) plane->f[i] = k < 3 ? 7.5f : 1e-6f;
    }
    if (with_pose) view_image_set_camera(&im, &v);
    assert_ok(exr_set_attribute(&im, "remodel:lens", "PINHOLE 64 64 32 32 32 32", &err), err);
    assert_ok(exr_write(&im, scratch_path("sky.exr"), NULL, &err), err);
    exr_image_release(&im);
    return scratch;
}

/* lights.txt describes the window as it was. Where the edit widens it, light also comes in beside that. */
static void a_listed_pane_that_an_edit_widens_is_an_emitter_of_its_own(void **state)
{
    struct box wide_room[3];
    struct built was = {.files = {.model = write_boxes(open_room, 3), .vita = write_vita(grey, 6, 0)}}, is;
    (void)state;
    was.files.outdoors = write_outdoors(0.5f, 0.5f, 0);
    was.files.lights = write_lights("opening big 0 2 2 2 0 0 0 0 2\n");
    const struct model_field *old = read_field(&was);
    is = (struct built){.files = was.files};
    read_field(&is);
    model_field_add_changed_panes(&is.field, old);
    assert_int_equal(is.field.field.emitter_count, 1);
    model_field_release(&is.field);
    memcpy(wide_room, open_room, sizeof wide_room);
    wide_room[2].high.x = 3;
    is = (struct built){.files = was.files};
    is.files.model = write_boxes(wide_room, 3);
    read_field(&is);
    model_field_add_changed_panes(&is.field, old);
    assert_int_equal(is.field.field.emitter_count, 2);
    assert_int_equal(is.field.plain.emitter_count, 2);
    assert_near(is.field.emitters[1].centre.x, 0.5, 1e-9);
    assert_near(vec3_length(is.field.emitters[1].x), 2.5, 1e-9);
    model_field_release(&is.field);
    model_field_release(&was.field);
}

static void an_opening_shows_its_reference_image_and_the_outdoors_beyond_its_field(void **state)
{
    static const struct model_axes axes = {.rotation = {1, 0, 0, 0}, .scale = 1};
    struct built b = {.files = {.model = write_boxes(open_room, 3), .vita = write_vita(grey, 6, 0)}};
    struct err err = ERR_INIT;
    (void)state;
    b.files.outdoors = write_outdoors(0.5f, 0.5f, 0);
    b.files.lights = write_lights("opening big 0 2 2 2 0 0 0 0 2 reference sky\nopening plain 9 2 2 0 0 2 2 0 0\n");
    struct model_field *f = read_field(&b);
    assert_near(look_one(f, vec3_make(0, 0, 1), up, vec3_make(0, 1, 0.5)).radiance.g, 0.5, 1e-3);
    assert_ok(model_field_read_references(f, write_reference(true), &axes, NULL, &err), err);
    const struct light_look inside = look_one(f, vec3_make(0, 0, 1), up, vec3_make(0, 1, 0.5));
    assert_near(inside.radiance.g, 7.5, 1e-3);
    assert_int_equal(inside.source, LIGHT_SKY);
    assert_true(isinf(inside.distance));
    /* beyond its field of 45 degrees; beside the opening; from outside */
    assert_near(look_one(f, vec3_make(0, 1.5, 1), up, vec3_make(1.2, 1, 0)).radiance.g, 0.5, 1e-3);
    assert_near(look_one(f, vec3_make(1.5, 1, 1), up, vec3_make(0.9, 1, 0)).radiance.g, 0.5, 1e-3);
    assert_near(look_one(f, vec3_make(0, 3, 1), up, vec3_make(0, 1, 0.5)).radiance.g, 0.5, 1e-3);
    assert_int_equal(model_field_read_references(f, write_reference(false), &axes, NULL, &err), ST_DATA);
    assert_non_null(strstr(err.text, "has no pose"));
    model_field_release(&b.field);
}

static void an_atlas_of_a_view_is_refused(void **state)
{
    struct built b = {.files = {.model = write_boxes(room, 2), .vita = write_vita(grey, 6, 0)}};
    struct err err = ERR_INIT;
    char path[PATH_MAX], text[16384];
    (void)state;
    snprintf(path, sizeof path, "%s/atlas.txt", b.files.vita);
    FILE *fp = fopen(path, "r");
    const size_t size = fread(text, 1, sizeof text - 1, fp);
    fclose(fp);
    text[size] = 0;
    char *last = strstr(text, " 0 0 0 1\n");
    assert_non_null(last);
    memcpy(last, " 0 0 1 1\n", 9);
    fp = fopen(path, "w");
    assert_int_equal(fwrite(text, 1, size, fp), size);
    fclose(fp);
    assert_int_equal(model_field_read(&b.field, &b.files, NULL, &err), ST_DATA);
    assert_non_null(strstr(err.text, "orthogonal"));
    model_field_release(&b.field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_closed_room_of_one_radiance_gives_pi_times_it),
        cmocka_unit_test(each_face_shows_its_own_texels),
        cmocka_unit_test(a_face_without_tiles_gives_no_light),
        cmocka_unit_test(a_ray_inside_a_solid_sees_nothing),
        cmocka_unit_test(a_point_just_below_a_surface_is_moved_to_it),
        cmocka_unit_test(a_lamp_shines_within_its_cone_alone),
        cmocka_unit_test(a_lamp_a_little_behind_the_ceiling_is_seen),
        cmocka_unit_test(a_thin_wall_under_a_lamp_hides_the_part_beyond_it),
        cmocka_unit_test(a_lamp_that_hangs_is_not_seen_from_behind),
        cmocka_unit_test(texels_under_a_lamp_and_around_it_do_not_light_the_room_again),
        cmocka_unit_test(a_gather_finds_a_lamps_irradiance),
        cmocka_unit_test(an_open_sky_gives_pi_times_its_radiance),
        cmocka_unit_test(without_outdoors_it_is_dark_outside),
        cmocka_unit_test(a_sun_is_found_with_its_energy_where_columns_wrap_around),
        cmocka_unit_test(a_pane_lets_the_sky_in_and_is_an_emitter_unless_it_is_listed),
        cmocka_unit_test(a_listed_pane_that_an_edit_widens_is_an_emitter_of_its_own),
        cmocka_unit_test(an_opening_shows_its_reference_image_and_the_outdoors_beyond_its_field),
        cmocka_unit_test(an_atlas_of_a_view_is_refused),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
