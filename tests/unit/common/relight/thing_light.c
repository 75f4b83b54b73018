/* thing_light.c - what furniture sends out, in fields of light in which that is known in closed form. */
#include "common/relight/thing_light.h"

#include <math.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/math/numbers.h"
#include "tests/unit/scratch.h"

enum { BOX_TRIANGLES = 12, PLATE_SIDE = 8, PLATE_TRIANGLES = 2 * PLATE_SIDE * PLATE_SIDE, MOST = 256 };
static const double CUBE = 0.5;

struct furniture {
    struct vec3 triangles[MOST][3];
    struct rgb radiance[MOST][2];
    int thing[MOST];
    struct thing_surfaces s;
};

static void clear(struct furniture *f)
{
    memset(f, 0, sizeof *f);
    f->s = (struct thing_surfaces){f->triangles, f->radiance, f->thing, 0};
}

static void add(struct furniture *f, int thing, double radiance, struct vec3 a, struct vec3 b, struct vec3 c)
{
    const int i = f->s.count++;
    f->triangles[i][0] = a, f->triangles[i][1] = b, f->triangles[i][2] = c;
    f->radiance[i][0] = f->radiance[i][1] = rgb_grey(radiance);
    f->thing[i] = thing;
}

/* A box of 1 x 1 x 1 with its low corner at the origin; radiance: of its sides, +x, -x, +y, -y, +z, -z. */
static void add_box(struct furniture *f, int thing, const double radiance[6])
{
    const struct vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int k = 0; k < 6; k++) {
        const struct vec3 u = axes[(k / 2 + 1) % 3], v = axes[(k / 2 + 2) % 3];
        const struct vec3 o = k % 2 ? vec3_make(0, 0, 0) : axes[k / 2], p = vec3_add(o, u), q = vec3_add(o, v);
        const struct vec3 r = vec3_add(p, v);
        if (k % 2) {
            add(f, thing, radiance[k], o, r, p);
            add(f, thing, radiance[k], o, q, r);
        } else {
            add(f, thing, radiance[k], o, p, r);
            add(f, thing, radiance[k], o, r, q);
        }
    }
}

/* A table top of 4 x 4 at z = 0, which faces up. */
static void add_plate(struct furniture *f, int thing, double radiance)
{
    for (int i = 0; i < PLATE_SIDE * PLATE_SIDE; i++) {
        const double x = 0.5 * (i % PLATE_SIDE) - 2, y = 0.5 * (double)(i / PLATE_SIDE) - 2;
        const struct vec3 p = {x, y, 0}, q = {x + 0.5, y + 0.5, 0};
        add(f, thing, radiance, p, vec3_make(q.x, p.y, 0), q);
        add(f, thing, radiance, p, q, vec3_make(p.x, q.y, 0));
    }
}

/* Light from above and from below, which grows along x from where it is looked at. */
struct sky {
    double above, below, slope;
};

static void sky_look(const void *ctx, const struct vec3 from[RAY_PACKET], struct vec3 normal,
                     const struct vec3 direction[RAY_PACKET], unsigned active, struct light_look seen[RAY_PACKET])
{
    const struct sky *s = ctx;
    (void)normal;
    for (int k = 0; k < RAY_PACKET; k++)
        if (active >> k & 1)
            seen[k] = (struct light_look){
                .radiance = rgb_grey((direction[k].z > 0 ? s->above : s->below) * (1 + s->slope * from[k].x)),
                .source = LIGHT_SKY,
                .distance = INFINITY,
                .face = -1};
}

static void light(struct furniture *before, const struct sky *was, struct furniture *after, int first,
                  const struct sky *is)
{
    const struct light_field old = {.ctx = was, .look = sky_look}, new = {.ctx = is, .look = sky_look};
    struct err err = ERR_INIT;
    assert_ok(thing_light_find(&before->s, &old, &after->s, first, &new, CUBE, &err), err);
}

static void assert_sends(const struct furniture *f, int triangle, double front, double back)
{
    assert_float_equal(f->radiance[triangle][0].r, front, 1e-12 + 1e-9 * front);
    assert_float_equal(f->radiance[triangle][0].b, front, 1e-12 + 1e-9 * front);
    assert_float_equal(f->radiance[triangle][1].g, back, 1e-12 + 1e-9 * back);
}

static const double shades[6] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6};

/* In a furnace light is equal from everywhere: a side sends out its albedo times that, from its back too. */
static void a_box_in_a_furnace_sends_out_its_albedo(void **state)
{
    static struct furniture before, after;
    (void)state;
    clear(&before), clear(&after);
    add_box(&before, 3, shades);
    add_box(&after, 3, shades);
    light(&before, &(struct sky){1, 1, 0}, &after, 0, &(struct sky){2, 2, 0});
    for (int i = 0; i < BOX_TRIANGLES; i++) {
        assert_sends(&before, i, shades[i / 2], shades[i / 2]);
        assert_sends(&after, i, 2 * shades[i / 2], 2 * shades[i / 2]);
    }
}

/* The albedo is 0.5, by what the top sends out. So the back sends out half of the little that comes from below. */
static void the_back_of_a_table_top_is_lit_from_below(void **state)
{
    static struct furniture before, after;
    (void)state;
    clear(&before), clear(&after);
    add_plate(&before, 1, 0.5);
    light(&before, &(struct sky){1, 0.25, 0}, &after, 0, &(struct sky){1, 1, 0});
    for (int i = 0; i < PLATE_TRIANGLES; i++) assert_sends(&before, i, 0.5, 0.125);
}

/* Photos show the mean of a top that is brighter at one end: parts differ as the light does, and keep the mean. */
static void parts_send_out_by_their_own_light(void **state)
{
    static struct furniture before, after;
    double sum = 0, left = 0, right = 0;
    (void)state;
    clear(&before), clear(&after);
    add_plate(&before, 1, 0.5);
    light(&before, &(struct sky){1, 0.25, 0.3}, &after, 0, &(struct sky){1, 1, 0});
    for (int i = 0; i < PLATE_TRIANGLES; i++) {
        const double x = before.triangles[i][0].x, sent = before.radiance[i][0].r;
        sum += sent / PLATE_TRIANGLES;
        if (x < -1.25) left += sent / (PLATE_TRIANGLES / 4.0);
        if (x > 0.75) right += sent / (PLATE_TRIANGLES / 4.0);
    }
    assert_float_equal(sum, 0.5, 1e-9);
    assert_float_equal(left, 0.5 * (1 - 0.3 * 1.5), 0.5 * 0.3 * CUBE / 4); /* a part is lit as at some place of it */
    assert_float_equal(right, 0.5 * (1 + 0.3 * 1.5), 0.5 * 0.3 * CUBE / 4);
}

/* Brighter than white in the light that was found: the albedo ends at 0.95. */
static void no_side_sends_out_more_than_white(void **state)
{
    static struct furniture before, after;
    (void)state;
    clear(&before), clear(&after);
    add_plate(&before, 1, 3);
    light(&before, &(struct sky){1, 1, 0}, &after, 0, &(struct sky){1, 1, 0});
    for (int i = 0; i < PLATE_TRIANGLES; i++) assert_sends(&before, i, 0.95, 0.95);
}

/* Photos that hardly see the sides and the bottom of a box give them the radiance of its top, 0.5. In units of pi light
 * is 1, 0.55 and 0.1 on top, four sides and bottom: the thing has the albedo 0.5 3.3 / 2.22 = 0.74, and its light is
 * 2.22 / 3.3. The bottom, which faces down, keeps an albedo of its own, 0.95. */
static void a_side_in_the_dark_has_the_albedo_of_its_thing(void **state)
{
    static struct furniture before, after;
    static const double same[6] = {0.5, 0.5, 0.5, 0.5, 0.5, 0.5};
    const double whole = 0.5 * 3.3 / 2.22, bright = 2.22 / 3.3;
    const double side = whole + 0.55 * 0.55 / bright / bright * (0.5 / 0.55 - whole);
    (void)state;
    clear(&before), clear(&after);
    add_box(&before, 1, same);
    light(&before, &(struct sky){1, 0.1, 0}, &after, 0, &(struct sky){1, 1, 0});
    for (int i = 0; i < BOX_TRIANGLES; i++) {
        const double right = i / 2 == 4 ? 0.5 : i / 2 == 5 ? 0.1 * 0.95 : 0.55 * side;
        assert_float_equal(before.radiance[i][0].g, right, 0.03 * right); /* of a wall's light by few rays */
    }
}

/* An edit keeps the box, puts it to a second place with a quarter of a turn about z, and leaves another thing out. An
 * object stands first in the list, and keeps what it sends out. */
static void a_turned_copy_keeps_its_sides(void **state)
{
    static struct furniture before, after;
    static const double dark[6] = {0.01, 0.02, 0.03, 0.04, 0.05, 0.06};
    (void)state;
    clear(&before), clear(&after);
    add_box(&before, 1, dark);
    add_box(&before, 2, shades);
    add(&after, 0, 7, vec3_make(0, 0, 0), vec3_make(1, 0, 0), vec3_make(0, 1, 0));
    add_box(&after, 2, shades);
    add_box(&after, 2, shades);
    for (int i = 1 + BOX_TRIANGLES; i < after.s.count; i++)
        for (int k = 0; k < 3; k++) {
            const struct vec3 p = after.triangles[i][k];
            after.triangles[i][k] = vec3_make(5 - p.y, p.x, p.z);
        }
    light(&before, &(struct sky){1, 1, 0}, &after, 1, &(struct sky){1, 1, 0});
    assert_sends(&after, 0, 7, 7);
    for (int i = 0; i < BOX_TRIANGLES; i++) {
        assert_sends(&before, i, dark[i / 2], dark[i / 2]);
        assert_sends(&after, 1 + i, shades[i / 2], shades[i / 2]);
        assert_sends(&after, 1 + BOX_TRIANGLES + i, shades[i / 2], shades[i / 2]);
    }
}

/* What stays where it was, in light that stays, sends out the very same bits: nothing is relit for noise alone. */
static void in_light_that_stays_nothing_changes(void **state)
{
    static struct furniture before, after, serial;
    const struct sky sky = {1, 0.3, 0.2};
    (void)state;
    for (int threads = 1; threads <= 2; threads++) {
        parallel_set_threads(threads);
        clear(&before), clear(&after);
        add_box(&before, 1, shades);
        add_plate(&before, 2, 0.4);
        add_plate(&after, 2, 0.4);
        light(&before, &sky, &after, 0, &sky);
        assert_memory_equal(after.radiance, before.radiance[BOX_TRIANGLES], PLATE_TRIANGLES * sizeof *after.radiance);
        if (threads == 1) serial = before;
    }
    parallel_set_threads(0);
    assert_memory_equal(before.radiance, serial.radiance, sizeof serial.radiance);
}

static void a_room_without_things_is_left_alone(void **state)
{
    static struct furniture before, after;
    (void)state;
    clear(&before), clear(&after);
    light(&before, &(struct sky){1, 1, 0}, &after, 0, &(struct sky){1, 1, 0});
    assert_int_equal(after.s.count, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_in_a_furnace_sends_out_its_albedo),
        cmocka_unit_test(the_back_of_a_table_top_is_lit_from_below),
        cmocka_unit_test(parts_send_out_by_their_own_light),
        cmocka_unit_test(no_side_sends_out_more_than_white),
        cmocka_unit_test(a_side_in_the_dark_has_the_albedo_of_its_thing),
        cmocka_unit_test(a_turned_copy_keeps_its_sides),
        cmocka_unit_test(in_light_that_stays_nothing_changes),
        cmocka_unit_test(a_room_without_things_is_left_alone),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
