/* sun_search.c - the sun from the patch that it throws on a floor, of which everything is known. */
#include "stages/bake_outdoors/sun_search.h"

#include "common/base/parallel.h"
#include "stages/bake_outdoors/sun_light.h"
#include "tests/unit/sun_room.h"

enum { SCALE = 50, SKY = 5 }; /* texels a metre; radiance of the sky */

struct shine {
    struct vec3 to_sun;
    double radius; /* degrees */
    double light;  /* irradiance of what faces the sun; 0: there is none */
    bool carpet;   /* a bright carpet with a red border in the middle of the floor */
    double lamp;   /* intensity of a lamp that no texture shows */
    bool table;    /* most of the sun falls on a table */
};

static const struct box table = {"things", "table", {1.2, 1.1, 0.4}, {3.2, 2.1, 0.75}, false};

static double noise_at(int tile, int x, int y)
{
    uint32_t h = (uint32_t)(tile * 7919 + (y / 3) * 104729 + (x / 20) * 1299709);
    h ^= h >> 15;
    h *= 2246822519u;
    h ^= h >> 13;
    return (h & 0xffff) / 65535.0;
}

static bool meets_table(struct vec3 p, struct vec3 d)
{
    double near = 0, far = INFINITY;
    for (int axis = 0; axis < 3; axis++) {
        const double from = vec3_axis(p, axis), along = vec3_axis(d, axis);
        const double a = (vec3_axis(table.low, axis) - from) / along, b = (vec3_axis(table.high, axis) - from) / along;
        near = fmax(near, fmin(a, b));
        far = fmin(far, fmax(a, b));
    }
    return near < far;
}

/* Whether a ray from a point passes the window: through its rectangle on both faces of the wall. */
static bool passes(struct vec3 p, struct vec3 d)
{
    if (!(d.y < 0)) return false;
    for (int k = 0; k < 2; k++) {
        const double t = ((k ? window_low.y : window_high.y) - p.y) / d.y;
        const struct vec3 q = vec3_add(p, vec3_scale(d, t));
        if (q.x < window_low.x || q.x > window_high.x || q.z < window_low.z || q.z > window_high.z) return false;
    }
    return true;
}

/* The part of the sun that a point sees: a grid of directions over its disk. */
static double share_of(struct vec3 p, const struct shine *s)
{
    enum { SIDE = 16 };
    const struct vec3 side = vec3_normalize(vec3_make(-s->to_sun.y, s->to_sun.x, 0)), up = vec3_cross(s->to_sun, side);
    const double r = tan(s->radius * DEGREE);
    int inside = 0, seen = 0;
    for (int k = 0; k < SIDE * SIDE; k++) {
        const double u = 2 * (k % SIDE + 0.5) / SIDE - 1, v = 2 * (k / SIDE + 0.5) / SIDE - 1;
        if (u * u + v * v > 1) continue;
        inside++;
        const struct vec3 d = vec3_add(s->to_sun, vec3_add(vec3_scale(side, r * u), vec3_scale(up, r * v)));
        seen += passes(p, d) && !(s->table && meets_table(p, d));
    }
    return (double)seen / inside;
}

/* Sky and sun shine through the window; albedo varies. */
static void shade(const void *ctx, float rgb[3], int tile, int x, int y, struct vec3 p)
{
    const struct shine *s = ctx;
    const double cosine = fmax(0, vec3_dot(normals[tile], s->to_sun));
    const double sun = s->light > 0 && cosine > 0 ? s->light * cosine * share_of(p, s) : 0;
    const struct room_lamp lamp = {{2.1, 2.6, 2.6}, s->lamp};
    const double lit = SKY * sky_light_at(tile, p) + room_lamp_at(&lamp, p, normals[tile]) + sun;
    const double paint = reflects[tile] * (tile == 0 ? 0.6 + 0.8 * noise_at(tile, x, y) : 1);
    for (int c = 0; c < 3; c++) rgb[c] = (float)(paint * lit);
    if (!s->carpet || tile || p.x < 1.6 || p.x > 3.6 || p.y < 1.2 || p.y > 2.8) return;
    const bool border = p.x < 1.7 || p.x > 3.5 || p.y < 1.3 || p.y > 2.7;
    const double colour[3] = {2.2, border ? 0.4 : 2.2, border ? 0.3 : 2.1};
    for (int c = 0; c < 3; c++) rgb[c] = (float)(reflects[tile] * colour[c] * lit);
}

static struct vec3 from_angles(double azimuth, double elevation)
{
    const double a = azimuth * DEGREE, e = elevation * DEGREE;
    return vec3_make(cos(e) * cos(a), cos(e) * sin(a), sin(e));
}

/* with: what throws shadows */
static void search_with(struct sun_search *found, struct sun_light *light, const struct shine *s,
                        const struct model_rays *with)
{
    struct field_atlas atlas = {0};
    struct outdoors o = {0};
    struct err err = ERR_INIT;
    make_atlas(&atlas, SCALE, shade, s);
    const struct atlas_scene scene = {with, &atlas, planes};
    *found = (struct sun_search){0};
    assert_ok(sun_search(found, &scene, &err), err);
    uniform_outdoors(&o, SKY);
    const struct sun_indoors in = {.scene = &scene, .outdoors = &o};
    if (light)
        assert_ok(sun_light_measure(light, &in, &found->edges, found->fit.direction, found->fit.radius, &err), err);
    outdoors_release(&o);
    field_atlas_release(&atlas);
}

static void search_under(struct sun_search *found, struct sun_light *light, const struct shine *s)
{
    search_with(found, light, s, &model);
}

static double degrees_between(struct vec3 a, struct vec3 b)
{
    return atan2(vec3_length(vec3_cross(a, b)), vec3_dot(a, b)) / DEGREE;
}

static void a_patch_on_the_floor_tells_direction_size_and_light(void **state)
{
    (void)state;
    static const double suns[3][3] = {{-100, 40, 1}, {-60, 30, 1.5}, {-120, 52, 0.5}};
    double mean = 0;
    for (int k = 0; k < 3; k++) {
        const struct shine s = {from_angles(suns[k][0], suns[k][1]), suns[k][2], 8, false, 0, false};
        struct sun_search found;
        struct sun_light light;
        search_under(&found, &light, &s);
        assert_true(found.found);
        assert_true(degrees_between(found.fit.direction, s.to_sun) < 0.3);
        assert_true(found.fit.error < 0.5);
        assert_true(fabs(found.fit.radius - suns[k][2]) < 0.3);
        /* paint differs by a factor of two from plank to plank */
        assert_true(fabs(light.irradiance.g / 8 - 1) < 0.2);
        mean += light.irradiance.g / 3;
        sun_search_release(&found);
    }
    assert_true(fabs(mean / 8 - 1) < 0.05);
}

static void a_lamp_that_no_texture_shows_leaves_the_suns_light(void **state)
{
    (void)state;
    const struct shine s = {from_angles(-100, 40), 1, 8, false, 15, false};
    struct sun_search found;
    struct sun_light light;
    search_under(&found, &light, &s);
    assert_true(found.found);
    assert_true(light.lamps > 0.3); /* many places get more light from it than from the sky */
    assert_true(fabs(light.irradiance.g / 8 - 1) < 0.3);
    assert_true(fabs(light.irradiance.g / 8 - 1) < light.error);
    sun_search_release(&found);
}

static void a_room_without_sun_has_none(void **state)
{
    (void)state;
    struct sun_search found;
    search_under(&found, NULL, &(struct shine){from_angles(-100, 40), 1, 0, false, 0, false});
    assert_false(found.found);
    sun_search_release(&found);
}

static void a_carpet_is_no_sun_and_hides_none(void **state)
{
    (void)state;
    struct sun_search found;
    const struct shine none = {from_angles(-100, 40), 1, 0, true, 0, false},
                       sun = {from_angles(-100, 40), 1, 8, true, 0, false};
    search_under(&found, NULL, &none);
    assert_false(found.found);
    sun_search_release(&found);
    search_under(&found, NULL, &sun);
    assert_true(found.found);
    assert_true(degrees_between(found.fit.direction, sun.to_sun) < 0.3);
    sun_search_release(&found);
}

/* What is left of the patch on the floor is the table's outline, from under which no window is seen. */
static void a_table_in_the_sun_throws_a_shadow(void **state)
{
    (void)state;
    const struct shine s = {from_angles(-100, 40), 1, 8, false, 0, true};
    struct box with_table[BOXES + 1];
    struct sun_search found;
    memcpy(with_table, boxes, sizeof boxes);
    with_table[BOXES] = table;
    struct model_rays furnished = make_rays(with_table, BOXES + 1);
    search_with(&found, NULL, &s, &furnished);
    assert_true(found.found);
    assert_true(degrees_between(found.fit.direction, s.to_sun) < 0.3);
    assert_true(found.fit.gain > 0.6); /* 0.3 without the table in the model */
    sun_search_release(&found);
    model_rays_release(&furnished);
}

static void the_same_sun_for_any_number_of_threads(void **state)
{
    (void)state;
    struct sun_search found[2];
    const struct shine s = {from_angles(-80, 35), 1, 3, false, 0, false};
    for (int k = 0; k < 2; k++) {
        parallel_set_threads(1 + 2 * k);
        search_under(&found[k], NULL, &s);
        sun_search_release(&found[k]);
    }
    parallel_set_threads(0);
    assert_memory_equal(&found[0].fit, &found[1].fit, sizeof found[0].fit);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_patch_on_the_floor_tells_direction_size_and_light),
        cmocka_unit_test(a_lamp_that_no_texture_shows_leaves_the_suns_light),
        cmocka_unit_test(a_room_without_sun_has_none),
        cmocka_unit_test(a_carpet_is_no_sun_and_hides_none),
        cmocka_unit_test(a_table_in_the_sun_throws_a_shadow),
        cmocka_unit_test(the_same_sun_for_any_number_of_threads),
    };
    return cmocka_run_group_tests(tests, make_room, release_room);
}
