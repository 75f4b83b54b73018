/* edit_lamps.c - lamps that an edit adds, in relit pictures, against closed forms: I cos / d^2 over a bare floor, on
 * texture and on paint; shadows; the highlight of a glossy floor; the luminous opening; no lamp without a scale. */
#include "tests/unit/relight/relit_room.h"

#include "common/daylight/lux_scale.h"

static const double SCALE = 250; /* lx of the photographs' unit */

/* 500 cd down, 100 cd at 60 degrees and 0 at 90, linear between; horizontally alike. */
#define SPOT "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 12\n0 60 90\n0\n500 100 0\n"
/* The same from a square of 0.8 m. */
#define PANEL "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0.8 0.8 0\n1 1 12\n0 60 90\n0\n500 100 0\n"

static const float dark[6][3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {.4f, .4f, .4f}, {0, 0, 0}};

static const char *write_scale(double lx)
{
    const struct lux_scale scale = {.is = {lx, 0.9 * lx, 1.1 * lx}, .from = lx > 0 ? LUX_EXPOSURE : LUX_UNKNOWN};
    const char *path = keep_path("scale.txt");
    struct err err = ERR_INIT;
    assert_ok(lux_scale_write(&scale, path, NULL, &err), err);
    return path;
}

static double candela(double degrees)
{
    return degrees < 60 ? 500 - 400 * degrees / 60 : 100 - 100 * (degrees - 60) / 30;
}

/* I cos / d^2 of the spot at `lamp`, pointing down, at a point of the floor, in the photographs' unit. */
static double spot_light(struct vec3 lamp, struct vec3 at)
{
    const struct vec3 to = vec3_sub(lamp, at);
    const double d = vec3_length(to), cosine = to.z / d;
    return candela(acos(cosine) / DEGREE) * cosine / (d * d) / SCALE;
}

static struct texture_planned lamp_at(double x, double y, double z, const char *file)
{
    return (struct texture_planned){.name = (char *)"new",
                                    .file = (char *)file,
                                    .at = {x, y, z},
                                    .aim = {0, 0, -1},
                                    .colour = {1, 1, 1},
                                    .scale = {1, 1, 1}};
}

static struct edit edit_with(struct texture_planned *lamp)
{
    struct edit e = edit_of_closed_room(dark);
    e.lights = bright_lamp;
    e.map = (struct texture_map){.planned = lamp, .planned_count = 1};
    e.lux_scale = write_scale(SCALE);
    scratch_write("spot.ies", SPOT);
    scratch_write("panel.ies", PANEL);
    return e;
}

/* The lamp of lights.txt alone. */
static double old_light(const struct relit_room *r, struct vec3 at)
{
    return lamp_irradiance(&r->change.before.lights.lamps[0], at, vec3_make(0, 0, 1)).g;
}

static bool is_floor(const struct relit_room *r, int i)
{
    return r->pixels.after[i].normal.z > 0.5 && r->pixels.after[i].at.z < -1.99;
}

/* ------------------------------------------------------------------------------------------------------------------ */

/* All walls are black, so that nothing but lamps lights the floor. The old lamp's light is gathered by rays. */
static void texture_under_a_new_lamp_has_the_inverse_square(void **state)
{
    struct texture_planned lamp = lamp_at(-0.7, 0.4, 0, "spot.ies");
    struct edit e = edit_with(&lamp);
    struct relit_room r;
    int count = 0;
    double most = 0;
    (void)state;
    relight_room(&r, &e, vec3_make(0.1, 0.2, 1), to_floor);
    for (int i = 0; i < PIXELS; i++) {
        if (!is_floor(&r, i)) continue;
        const struct vec3 at = r.pixels.after[i].at;
        if (fmax(fabs(at.x), fabs(at.y)) > 1.7) continue; /* beside walls, light is interpolated across the corner */
        const double was = old_light(&r, at), added = spot_light(vec3_make(-0.7, 0.4, 0), at);
        assert_near(r.relit.after[i].value.g - r.relit.before[i].value.g, added, 1e-3);
        assert_near((double)r.picture.rgb[3 * i + 1] / (double)r.was[3 * i + 1], 1 + added / was, 0.01);
        most = fmax(most, added / was);
        count++;
    }
    assert_true(count > 200 && most > 0.1);
    relit_room_release(&r);
}

static void paint_under_a_new_lamp_has_its_albedo_of_both_lights_also_in_films(void **state)
{
    struct texture_planned lamp = lamp_at(-0.7, 0.4, 0, "spot.ies");
    struct texture_rule paint = rule_colour(0.5f);
    struct texture_face floor = {.id = room_id("floor/5"),
                                 .name = (char *)"floor/5",
                                 .normal = {0, 0, 1},
                                 .offset = -2,
                                 .rules = &paint,
                                 .rule_count = 1};
    struct edit e = edit_with(&lamp);
    struct relit_room r;
    (void)state;
    e.map.faces = &floor;
    e.map.face_count = 1;
    double film = 0, wanted = 0;
    relight_room(&r, &e, vec3_make(0.1, 0.2, 1), to_floor);
    for (int i = 0; i < PIXELS; i++) {
        if (!is_floor(&r, i)) continue;
        const struct vec3 at = r.pixels.after[i].at;
        const double light = old_light(&r, at) + spot_light(vec3_make(-0.7, 0.4, 0), at);
        assert_near((double)r.picture.rgb[3 * i + 1], 0.5 / PI * light, 0.03);
        if (fmax(fabs(at.x), fabs(at.y)) > 1.7) continue;
        const int id = solid_face_id(&r.change.after.model.mesh, r.pixels.face[i]);
        film += field_atlas_look(&r.change.after.atlas, id, at).radiance.g;
        wanted += 0.5 / PI * light;
    }
    assert_near(film, wanted, 0.01);
    relit_room_release(&r);
}

/* The wall of the split room hides the lamp from the floor behind it. */
static void walls_throw_shadows_in_the_light_of_a_new_lamp(void **state)
{
    struct texture_planned lamp = lamp_at(-1, 0, 1, "spot.ies");
    struct edit e = edit_with(&lamp);
    struct light_change c;
    (void)state;
    e.after = split_room;
    e.after_count = COUNT(split_room);
    edit_read(&c, &e);
    for (int k = -3; k <= 3; k++) {
        const struct gather_point p = {{0.5 * k, 0.3, -2}, {0, 0, 1}};
        const double found = edit_lamps_light(&c.lamps, -1, &c.after, p, 1).g;
        if (k) assert_near(found, k < 0 ? spot_light(vec3_make(-1, 0, 1), p.at) : 0, 1e-5);
    }
    light_change_release(&c);
}

/* Rays begin a little above a surface, where a lamp that lies in it, or a little above it, is seen along it. */
static void a_lamp_along_a_glossy_floor_gives_a_finite_highlight(void **state)
{
    static const double heights[] = {0, 0.5, 0.999, 1, 1.000001, 1.001, 1.1};
    const struct brdf gloss = {BRDF_PHONG, {0, 0, 0}, 1, 10, 1};
    (void)state;
    for (size_t i = 0; i < sizeof heights / sizeof *heights; i++) {
        struct texture_planned lamp = lamp_at(-1, 0, -2, "ball.ies");
        struct edit e = edit_with(&lamp);
        struct light_change c;
        scratch_write("ball.ies", "IESNA91\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 0\n0 180\n0\n100 100\n");
        edit_read(&c, &e);
        const double epsilon = c.after.model.rays.epsilon;
        struct planned_lamp *l = &c.lamps.planned.list[0];
        const struct gather_point p = {{0, 0, -2}, {0, 0, 1}};
        const struct vec3 view = vec3_normalize(vec3_make(1, 0, 0.01));
        l->at.z = -2 + heights[i] * epsilon;
        const double light = edit_lamps_light(&c.lamps, -1, &c.after, p, 1).g;
        const double shown = edit_lamps_gloss(&c.lamps, &c.after, p, &gloss, view, 1).g;
        assert_true(light >= 0 && light <= 1.2 * 100 / SCALE * epsilon);
        assert_true(shown >= 0 && shown <= 1.01 * gloss.ks * 100 / SCALE);
        light_change_release(&c);
    }
}

/* Phong's lobe in the mirror's direction: k_s times the light over the cosine. */
static void a_glossy_floor_reflects_the_lamp(void **state)
{
    struct texture_planned lamp = lamp_at(-1, 0, 0, "spot.ies");
    struct edit e = edit_with(&lamp);
    struct light_change c;
    const struct brdf phong = {
        .kind = BRDF_PHONG, .ks = 0.3, .shape = 20, .gloss = brdf_gloss_albedo(BRDF_PHONG, 0.3, 20)};
    const struct gather_point p = {{0, 0, -2}, {0, 0, 1}};
    const struct vec3 to = vec3_normalize(vec3_make(-1, 0, 2));
    (void)state;
    edit_read(&c, &e);
    for (int k = 0; k < 3; k++) { /* degrees off the mirror's direction */
        const double off = 10 * k * DEGREE, angle = atan(0.5) + off;
        const struct vec3 view = vec3_make(sin(angle), 0, cos(angle));
        const double wanted = 0.3 * pow(cos(off), 20) * spot_light(vec3_make(-1, 0, 0), p.at) / to.z;
        assert_near(edit_lamps_gloss(&c.lamps, &c.after, p, &phong, view, 1).g, wanted, 1e-3 * wanted);
    }
    light_change_release(&c);
}

/* Its luminance is I / (A cos); what is behind it is hidden, whatever it is. */
static void a_luminous_opening_is_seen(void **state)
{
    struct texture_planned lamp = lamp_at(0, 0, 1.5, "panel.ies");
    struct edit e = edit_with(&lamp);
    struct relit_room r;
    int inside = 0, partly = 0;
    (void)state;
    relight_room(&r, &e, vec3_make(0.1, 0.2, -1), to_ceiling);
    for (int k = 0; k < r.pixels.opening_count; k++) {
        const struct opening_pixel *o = &r.pixels.openings[k];
        const double u = (o->pixel % WIDTH + 0.5 - WIDTH / 2.0) / 14, v = (o->pixel / WIDTH + 0.5 - HEIGHT / 2.0) / 14;
        const double cosine = 1 / sqrt(1 + u * u + v * v);
        if (o->cover < 0.999f) {
            partly++;
            continue;
        }
        inside++;
        assert_near((double)r.picture.rgb[3 * o->pixel + 1], candela(acos(cosine) / DEGREE) / (0.64 * cosine) / SCALE,
                    0.01);
        assert_int_equal(r.picture.made[o->pixel], MADE_COLOUR);
    }
    assert_true(inside >= 4 && partly >= 4);
    relit_room_release(&r);
}

static void lamps_of_an_unknown_scale_do_not_shine(void **state)
{
    struct texture_planned lamp = lamp_at(-0.7, 0.4, 0, "spot.ies");
    struct edit e = edit_with(&lamp);
    struct relit_room r;
    (void)state;
    e.lux_scale = write_scale(0);
    relight_room(&r, &e, vec3_make(0.1, 0.2, 1), to_floor);
    assert_memory_equal(r.picture.rgb, r.was, sizeof r.was);
    relit_room_release(&r);
}

static void a_damaged_file_is_named(void **state)
{
    struct texture_planned lamp = lamp_at(-0.7, 0.4, 0, "spot.ies");
    struct edit e = edit_with(&lamp);
    struct light_change c;
    struct err err = ERR_INIT;
    (void)state;
    scratch_write("spot.ies", "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 2 2 0 0 0\n");
    edit_write(&e);
    assert_int_equal(light_change_read(&c, &e.files, NULL, &err), ST_DATA);
    assert_non_null(strstr(err.text, "spot.ies"));
    assert_non_null(strstr(err.text, "the edit's lamp new"));
    light_change_release(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texture_under_a_new_lamp_has_the_inverse_square),
        cmocka_unit_test(paint_under_a_new_lamp_has_its_albedo_of_both_lights_also_in_films),
        cmocka_unit_test(walls_throw_shadows_in_the_light_of_a_new_lamp),
        cmocka_unit_test(a_glossy_floor_reflects_the_lamp),
        cmocka_unit_test(a_lamp_along_a_glossy_floor_gives_a_finite_highlight),
        cmocka_unit_test(a_luminous_opening_is_seen),
        cmocka_unit_test(lamps_of_an_unknown_scale_do_not_shine),
        cmocka_unit_test(a_damaged_file_is_named),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
