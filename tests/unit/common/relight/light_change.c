/* What each point of an edited model is in the unedited one, and the light before and after. */
#include "common/relight/light_change.h"
#include "tests/unit/edit_room.h"

static struct light_place place_at(const struct light_change *c, const char *face, struct vec3 p)
{
    struct light_place place;
    light_change_place(&place, c, face_named(&c->after.model.mesh, face), p);
    return place;
}

static bool same_place(struct vec3 a, struct vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

static void without_statements_each_point_is_itself(void **state)
{
    struct edit e = edit_of_closed_room(coloured);
    struct light_change c;
    const struct vec3 p = {0.3, -1.1, -2}, q = {2, 0.7, 0.1};
    (void)state;
    edit_read(&c, &e);
    const struct light_place floor = place_at(&c, "floor/5", p), east = place_at(&c, "east/0", q);
    assert_int_equal(floor.kind, LIGHT_PLACE_TEXTURE);
    assert_int_equal(floor.face, FLOOR);
    assert_true(same_place(floor.texel, p) && same_place(floor.before.at, p));
    assert_true(same_place(floor.before.normal, up));
    assert_false(floor.is_new);
    assert_near(floor.colour.g, (double)coloured[4][1], 1e-3);
    assert_int_equal(east.face, EAST);
    assert_near(east.colour.g, 1, 1e-3);
    assert_int_equal(place_at(&c, "floor/4", vec3_make(0, 0, -3)).kind, LIGHT_PLACE_NONE);
    light_change_release(&c);
    light_change_release(&c);
}

/* Its texture and its light come from where the wall was. */
static void a_wall_that_is_moved_takes_its_old_place_and_new_floor_the_light_beside_it(void **state)
{
    struct texture_rule wall = rule_shifted(TEXTURE_PLACE, EAST, -0.5);
    struct texture_rule floor[2] = {rule_shifted(TEXTURE_PLACE, FLOOR, 0), rule_shifted(TEXTURE_EDGE, FLOOR, 0)};
    struct texture_face faces[2] = {
        {.id = EAST, .name = (char *)"east/0", .normal = {-1, 0, 0}, .offset = -2.5, .rules = &wall, .rule_count = 1},
        {.id = FLOOR, .name = (char *)"floor/5", .normal = {0, 0, 1}, .offset = -2, .rules = floor, .rule_count = 2}};
    struct edit e = {.before = closed_room,
                     .after = wide_room,
                     .before_count = COUNT(closed_room),
                     .after_count = COUNT(wide_room),
                     .colours = coloured};
    struct light_change c;
    (void)state;
    e.map = (struct texture_map){.faces = faces, .face_count = 2};
    edit_read(&c, &e);
    const struct light_place moved = place_at(&c, "east/0", vec3_make(2.5, 1, 0.5));
    assert_int_equal(moved.kind, LIGHT_PLACE_TEXTURE);
    assert_true(same_place(moved.before.at, vec3_make(2, 1, 0.5)));
    assert_true(same_place(moved.before.normal, vec3_make(-1, 0, 0)));
    assert_false(moved.is_new);
    const struct light_place old = place_at(&c, "floor/5", vec3_make(1, 1, -2));
    assert_true(same_place(old.before.at, vec3_make(1, 1, -2)));
    const struct light_place added = place_at(&c, "floor/5", vec3_make(2.4, 1, -2));
    assert_int_equal(added.kind, LIGHT_PLACE_TEXTURE);
    assert_near(added.colour.g, 3, 1e-3);
    assert_true(added.texel.x > 1.9 && added.texel.x < 2.1);
    assert_true(added.before.at.x > 1.9 && added.before.at.x <= 2);
    light_change_release(&c);
}

static void a_colour_has_an_albedo_within_its_limits(void **state)
{
    struct texture_rule rules[2] = {rule_colour(0.25f), rule_shifted(TEXTURE_PLACE, FLOOR, 0)};
    struct texture_face face = {
        .id = FLOOR, .name = (char *)"floor/5", .normal = {0, 0, 1}, .offset = -2, .rules = rules, .rule_count = 2};
    struct edit e = edit_of_closed_room(coloured);
    struct light_change c;
    (void)state;
    rules[0].limited = true;
    const struct vec3 within[4] = {{0, -2, -2}, {2, -2, -2}, {2, 2, -2}, {0, 2, -2}};
    memcpy(rules[0].within, within, sizeof within);
    e.map = (struct texture_map){.faces = &face, .face_count = 1};
    edit_read(&c, &e);
    const struct light_place painted = place_at(&c, "floor/5", vec3_make(1, 1, -2));
    assert_int_equal(painted.kind, LIGHT_PLACE_COLOUR);
    assert_near(painted.colour.b, 0.25, 0);
    assert_int_equal(place_at(&c, "floor/5", vec3_make(-1, 1, -2)).kind, LIGHT_PLACE_TEXTURE);
    light_change_release(&c);
}

/* Floor that appears under a wall is lit as the floor beside it, a little away from where the wall shadowed it. */
static void new_floor_under_a_removed_wall_takes_the_light_of_the_nearest_old_floor(void **state)
{
    struct edit e = {.before = split_room,
                     .after = closed_room,
                     .before_count = COUNT(split_room),
                     .after_count = COUNT(closed_room),
                     .colours = plain};
    struct light_change c;
    (void)state;
    edit_read(&c, &e);
    assert_near(c.inset, 0.005 * 6, 1e-12);
    for (double x = -0.19; x < 0.2; x += 0.0475) {
        const struct light_place p = place_at(&c, "floor/5", vec3_make(x, 0.5, -2));
        assert_int_equal(p.kind, LIGHT_PLACE_TEXTURE);
        assert_true(p.is_new);
        assert_true(same_place(p.texel, vec3_make(x, 0.5, -2)));
        if (fabs(x) > 1e-6) assert_near(p.before.at.x, x < 0 ? -0.2 - c.inset : 0.2 + c.inset, 1e-9);
        assert_near(p.before.at.y, 0.5, 1e-12);
        assert_near(p.before.at.z, -2, 1e-12);
    }
    assert_false(place_at(&c, "floor/5", vec3_make(0.3, 0.5, -2)).is_new);
    light_change_release(&c);
}

static struct irradiance gather_at(const struct light_field *f, struct vec3 at, struct vec3 normal)
{
    struct irradiance e;
    ray_irradiance(&e, f, (struct gather_point){at, normal}, 512, 3);
    return e;
}

static void both_fields_have_all_emitters_and_what_is_unchanged_has_equal_bits(void **state)
{
    struct texture_lamp lamps[1] = {{(char *)"a", {0, 0, 0}}};
    struct edit e = {.before = split_room,
                     .after = split_room,
                     .before_count = COUNT(split_room),
                     .after_count = COUNT(split_room),
                     .colours = plain};
    struct light_change c;
    const struct vec3 east = {1, 0.2, -2}, west = {-1, 0.2, -2};
    (void)state;
    e.lights = "disk a 1 0 1.99 0 0 -1 0.2 50 50 50 90 0\ndisk b -1 0 1.99 0 0 -1 0.2 50 50 50 90 0\n";
    e.map = (struct texture_map){.lamps = lamps, .lamp_count = 1};
    edit_read(&c, &e);
    assert_int_equal(c.before.field.emitter_count, 2);
    assert_int_equal(c.after.field.emitter_count, 2);
    assert_ptr_equal(c.before.plain.emitters, c.after.plain.emitters);
    assert_int_equal(c.after.plain.emitter_count, 2);
    const struct irradiance same = gather_at(&c.before.field, west, up), also = gather_at(&c.after.field, west, up);
    assert_memory_equal(&same, &also, sizeof same);
    const struct irradiance bright = gather_at(&c.before.field, east, up), dark = gather_at(&c.after.field, east, up);
    assert_true(bright.from[LIGHT_LAMP] > 0.3 && dark.from[LIGHT_LAMP] == 0);
    assert_true(dark.value.g < bright.value.g);
    light_change_release(&c);
}

static bool is_input(const struct provenance *prov, const char *name)
{
    for (int i = 0; i < prov->count; i++)
        if (!strcmp(prov->inputs[i].name, name)) return true;
    return false;
}

static void the_files_of_both_models_are_inputs(void **state)
{
    struct edit e = edit_of_closed_room(plain);
    struct light_change c;
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    (void)state;
    edit_write(&e);
    e.files.edited_vita = e.files.vita;
    assert_ok(light_change_read(&c, &e.files, &prov, &err), err);
    static const char *const names[] = {"base.txt",    "axes.txt",       "edited.txt",
                                        "texture.txt", "vita/atlas.txt", "vita/page0.exr"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (!is_input(&prov, names[i])) fail_msg("%s is not an input", names[i]);
    provenance_release(&prov);
    light_change_release(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_statements_each_point_is_itself),
        cmocka_unit_test(a_wall_that_is_moved_takes_its_old_place_and_new_floor_the_light_beside_it),
        cmocka_unit_test(a_colour_has_an_albedo_within_its_limits),
        cmocka_unit_test(new_floor_under_a_removed_wall_takes_the_light_of_the_nearest_old_floor),
        cmocka_unit_test(both_fields_have_all_emitters_and_what_is_unchanged_has_equal_bits),
        cmocka_unit_test(the_files_of_both_models_are_inputs),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
