/* What pixels show: textures of moved and new places, colours, lamps, furniture, objects by their share of a pixel;
 * many emitters. */
#include "tests/unit/ball_thing.h"
#include "tests/unit/relight/relit_room.h"

static void find(struct relit_room *r, struct edit *e, struct vec3 from, struct quat turn)
{
    struct err err = ERR_INIT;
    *r = (struct relit_room){.params = RELIGHT_PARAMS_DEFAULT};
    edit_read(&r->change, e);
    draw_picture(r, from, turn, e->colours);
    assert_ok(pixels_find(&r->pixels, &r->change, &r->picture, NULL, NULL, &err), err);
}

static void pixels_of_an_unchanged_room_are_gathered_where_they_are(void **state)
{
    struct edit e = edit_of_closed_room(coloured);
    struct relit_room r;
    (void)state;
    find(&r, &e, vec3_make(0.1, 0.2, 0.3), to_floor);
    for (int i = 0; i < PIXELS; i++) {
        assert_int_equal(r.pixels.kind[i], PIXEL_TEXTURE);
        assert_int_equal(r.pixels.from[i], r.picture.id[i]);
        assert_memory_equal(&r.pixels.before[i], &r.pixels.after[i], sizeof *r.pixels.before);
    }
    assert_int_equal(r.pixels.object_count, 0);
    relit_room_release(&r);
}

static void a_moved_wall_is_gathered_at_its_old_place_and_a_colour_has_its_albedo(void **state)
{
    struct texture_rule wall = rule_shifted(TEXTURE_PLACE, EAST, -0.5), floor = rule_colour(0.25f);
    struct texture_face faces[2] = {
        {.id = EAST, .name = (char *)"east/0", .normal = {-1, 0, 0}, .offset = -2.5, .rules = &wall, .rule_count = 1},
        {.id = FLOOR, .name = (char *)"floor/5", .normal = {0, 0, 1}, .offset = -2, .rules = &floor, .rule_count = 1}};
    struct edit e = {.before = closed_room,
                     .after = wide_room,
                     .before_count = COUNT(closed_room),
                     .after_count = COUNT(wide_room),
                     .colours = coloured};
    struct relit_room r;
    int moved = 0, painted = 0;
    (void)state;
    e.map = (struct texture_map){.faces = faces, .face_count = 2};
    find(&r, &e, vec3_make(0.1, 0.2, 0.3), to_floor);
    for (int i = 0; i < PIXELS; i++) {
        const struct gather_point *p = &r.pixels.before[i], *q = &r.pixels.after[i];
        if (r.picture.id[i] == EAST) {
            moved++;
            assert_int_equal(r.pixels.kind[i], PIXEL_TEXTURE);
            assert_near(q->at.x, 2.5, 1e-5);
            assert_near(p->at.x, 2, 1e-5);
            assert_near(p->at.z, q->at.z, 1e-12);
        } else if (r.picture.id[i] == FLOOR) {
            painted++;
            assert_int_equal(r.pixels.kind[i], PIXEL_COLOUR);
            assert_near((double)r.pixels.albedo[i][2], 0.25, 0);
        }
    }
    assert_true(moved > 10 && painted > 100);
    relit_room_release(&r);
}

/* Nothing is kept, sky is kept, and a lamp that the edit does not name is kept. */
static void pixels_without_a_surface_keep_their_light(void **state)
{
    struct edit e = edit_of_closed_room(plain);
    struct relit_room r = {.params = RELIGHT_PARAMS_DEFAULT};
    struct err err = ERR_INIT;
    int lamps = 0;
    (void)state;
    e.lights = "quad lamp 0 0 1.99 0.6 0 0 0 -0.6 0 20 20 20 90 0\n";
    edit_read(&r.change, &e);
    draw_picture(&r, vec3_make(0.03, 0.05, 0), to_ceiling, plain);
    r.picture.made[3] = MADE_OUTDOORS;
    r.picture.made[4] = MADE_NOTHING;
    assert_ok(pixels_find(&r.pixels, &r.change, &r.picture, NULL, NULL, &err), err);
    assert_int_equal(r.pixels.kind[3], PIXEL_KEPT);
    assert_int_equal(r.pixels.kind[4], PIXEL_KEPT);
    for (int i = 0; i < PIXELS; i++) {
        const bool kept = r.pixels.kind[i] == PIXEL_KEPT;
        lamps += kept;
        assert_true(kept == !(vec3_length(r.pixels.after[i].normal) > 0));
    }
    assert_true(lamps > 10 && lamps < PIXELS / 2);
    relit_room_release(&r);
}

/* The cube's top, 1 x 1 at a depth of 2, has 14 / 2 px on each side. */
static void an_object_covers_as_many_pixels_as_its_area(void **state)
{
    struct edit e = edit_of_closed_room(plain);
    struct relit_room r;
    double area = 0;
    (void)state;
    e.objects = "object block mesh.obj %s 1 0 0 -0.48 0 1 0 -0.53 0 0 1 -2 matt 0.5 0.5 0.5\n";
    e.mesh = cube;
    find(&r, &e, vec3_make(0, 0, 1), to_floor);
    for (int k = 0; k < r.pixels.object_count; k++) {
        const struct object_pixel *o = &r.pixels.objects[k];
        area += (double)o->cover;
        assert_int_equal(o->object, 0);
        assert_true(o->cover > 0 && o->cover <= 1);
        assert_near(vec3_length(o->to_viewer), 1, 1e-9);
        assert_true(vec3_dot(o->point.normal, o->to_viewer) > 0);
    }
    assert_near(area, 49, 0.07);
    relit_room_release(&r);
}

/* More emitters than rays are shared among: an unchanged room keeps its pixels, and twice the light is twice the
 * light. */
static void of_fifty_lamps_all_count(void **state)
{
    static char lines[8192];
    struct texture_lamp lamps[50];
    static char names[50][16];
    struct edit e = edit_of_closed_room(lit);
    struct relit_room r;
    struct err err = ERR_INIT;
    size_t at = 0;
    (void)state;
    for (int i = 0; i < 50; i++) {
        snprintf(names[i], sizeof names[i], "l%d", i);
        lamps[i] = (struct texture_lamp){names[i], {2, 2, 2}};
        at += (size_t)snprintf(lines + at, sizeof lines - at, "disk l%d %g %g 1.99 0 0 -1 0.1 40 40 40 90 0\n", i,
                               -1.8 + 0.4 * (i % 10), -1.6 + 0.8 * (i / 10));
    }
    e.lights = lines;
    for (int twice = 0; twice < 2; twice++) {
        double sums[2] = {0, 0};
        r = (struct relit_room){.params = {.target_error = 0.02, .rays = 1024}};
        e.map = (struct texture_map){.lamps = lamps, .lamp_count = twice ? 50 : 0};
        edit_write(&e);
        assert_ok(light_change_read(&r.change, &e.files, NULL, &err), err);
        draw_picture(&r, vec3_make(0, 0, 1), to_floor, lit);
        relight_picture(&r);
        assert_int_equal(r.relit.records, 0);
        for (int i = 0; i < PIXELS; i++) {
            if (!twice) assert_true(r.picture.rgb[3 * i] == r.was[3 * i]);
            sums[0] += r.relit.before[i].value.g;
            sums[1] += r.relit.after[i].value.g;
        }
        assert_true(twice ? sums[1] > 1.5 * sums[0] : sums[1] == sums[0]);
        relit_room_release(&r);
    }
}

/* -------------------------------------------------------------------------------------------------------- furniture */

#define RADIUS 0.5

static const struct vec3 ball_was = {-0.8, 0.2, -0.5};

/* A picture of the room from above, with the ball of one edit. shown: what its pixels are made of where the field has
 * the ball. */
static void find_ball(struct relit_room *r, struct edit *e, struct texture_thing *thing, enum picture_made shown)
{
    const struct vec3 from = vec3_make(0.1, 0.2, 1.5);
    struct err err = ERR_INIT;
    *e = edit_of_closed_room(coloured);
    e->map = (struct texture_map){.things = thing, .thing_count = 1};
    *r = (struct relit_room){.params = RELIGHT_PARAMS_DEFAULT};
    edit_write(e);
    e->files.things = write_ball(ball_was, RADIUS, 0.25);
    assert_ok(light_change_read(&r->change, &e->files, NULL, &err), err);
    assert_true(r->change.things.changes);
    draw_picture(r, from, to_floor, coloured);
    for (int i = 0; i < PIXELS; i++) /* draw_picture() leaves out what is no face */
        if (r->picture.made[i] == MADE_NOTHING) r->picture.made[i] = (uint8_t)shown;
    assert_ok(pixels_find(&r->pixels, &r->change, &r->picture, NULL, NULL, &err), err);
}

/* The number of pixels that show furniture, which is the ball about `is`. Each is lit there after the edit, and
 * before it on the ball where it was, at the place that is turned by `turn` (degrees, about the vertical) since. */
static int count_ball(const struct relit_room *r, struct vec3 is, double turn)
{
    const double c = cos(turn * PI / 180), s = sin(turn * PI / 180);
    int count = 0;
    for (int i = 0; i < PIXELS; i++) {
        if (r->pixels.kind[i] != PIXEL_CLUTTER) continue;
        const struct gather_point *p = &r->pixels.before[i], *q = &r->pixels.after[i];
        const struct vec3 old = vec3_sub(p->at, ball_was), new = vec3_sub(q->at, is);
        assert_near(vec3_length(new), RADIUS, 0.05);
        assert_near(c * old.x - s * old.y, new.x, 1e-6);
        assert_near(s * old.x + c * old.y, new.y, 1e-6);
        assert_near(old.z, new.z, 1e-6);
        assert_near(c * p->normal.x - s * p->normal.y, q->normal.x, 1e-6);
        assert_near(s * p->normal.x + c * p->normal.y, q->normal.y, 1e-6);
        assert_near(p->normal.z, q->normal.z, 1e-6);
        assert_true(vec3_dot(q->normal, new) > 0.8 * RADIUS); /* outwards */
        count++;
    }
    return count;
}

static void a_moved_thing_is_lit_at_its_new_place_and_was_at_its_old_one(void **state)
{
    struct texture_thing move = edit_ball(TEXTURE_THING_MOVE, 1.5, 0.25, 60);
    struct relit_room r;
    struct edit e;
    (void)state;
    find_ball(&r, &e, &move, MADE_CLUTTER);
    assert_true(count_ball(&r, vec3_add(ball_was, vec3_make(1.5, 0.25, 0)), 60) > 20);
    relit_room_release(&r);
}

/* A copy in a corner of the ceiling, which the camera does not see, leaves the ball where it is. */
static void a_thing_that_stays_is_lit_where_it_is(void **state)
{
    struct texture_thing copy = edit_ball(TEXTURE_THING_MOVE, -0.65, -1.6, 90);
    struct relit_room r;
    struct edit e;
    (void)state;
    copy.name = (char *)"twin";
    copy.by[2] = 1.9; /* its top is at the ceiling */
    find_ball(&r, &e, &copy, MADE_CLUTTER);
    assert_true(count_ball(&r, ball_was, 0) > 20);
    for (int i = 0; i < PIXELS; i++)
        if (r.pixels.kind[i] == PIXEL_CLUTTER)
            assert_memory_equal(&r.pixels.before[i], &r.pixels.after[i], sizeof *r.pixels.before);
    relit_room_release(&r);
}

/* A texel behind the ball, which the picture shows instead, is a face. */
static void what_the_picture_does_not_show_as_furniture_is_a_face(void **state)
{
    struct texture_thing move = edit_ball(TEXTURE_THING_MOVE, 1.5, 0.25, 0),
                         clear = edit_ball(TEXTURE_THING_CLEAR, 0, 0, 0);
    struct relit_room r;
    struct edit e;
    (void)state;
    find_ball(&r, &e, &move, MADE_WARPED);
    for (int i = 0; i < PIXELS; i++) assert_int_equal(r.pixels.kind[i], PIXEL_TEXTURE);
    relit_room_release(&r);
    find_ball(&r, &e, &clear, MADE_CLUTTER); /* the field of the edited room has it no more */
    for (int i = 0; i < PIXELS; i++) assert_int_equal(r.pixels.kind[i], PIXEL_TEXTURE);
    relit_room_release(&r);
}

/* A view that looks away from the photo: nothing of it is gathered. */
static void of_a_black_picture_nothing_is_relit(void **state)
{
    struct edit e = edit_of_closed_room(coloured);
    struct relit_room r;
    struct err err = ERR_INIT;
    (void)state;
    find(&r, &e, vec3_make(0.1, 0.2, 0.3), to_floor);
    assert_false(r.pixels.is_black);
    pixels_release(&r.pixels);
    for (int i = 0; i < PIXELS - PIXELS / 200; i++) r.picture.made[i] = MADE_NOTHING;
    memcpy(r.was, r.picture.rgb, sizeof r.was);
    assert_ok(pixels_find(&r.pixels, &r.change, &r.picture, NULL, NULL, &err), err);
    assert_true(r.pixels.is_black);
    for (int i = 0; i < PIXELS; i++) assert_true(r.pixels.kind[i] == PIXEL_KEPT && r.pixels.face[i] == -1);
    assert_ok(relit_make(&r.relit, &r.picture, &r.pixels, &r.change, &r.params, &err), err);
    assert_memory_equal(r.picture.rgb, r.was, sizeof r.was);
    assert_int_equal(r.relit.records, 0);
    relit_room_release(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(of_a_black_picture_nothing_is_relit),
        cmocka_unit_test(pixels_of_an_unchanged_room_are_gathered_where_they_are),
        cmocka_unit_test(a_moved_wall_is_gathered_at_its_old_place_and_a_colour_has_its_albedo),
        cmocka_unit_test(pixels_without_a_surface_keep_their_light),
        cmocka_unit_test(an_object_covers_as_many_pixels_as_its_area),
        cmocka_unit_test(a_moved_thing_is_lit_at_its_new_place_and_was_at_its_old_one),
        cmocka_unit_test(a_thing_that_stays_is_lit_where_it_is),
        cmocka_unit_test(what_the_picture_does_not_show_as_furniture_is_a_face),
        cmocka_unit_test(of_fifty_lamps_all_count),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
