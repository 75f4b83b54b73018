/* Light before an edit at places that the edit made: that of the rim around them, smooth, and right where it is linear.
 */
#include "stages/relight/rim_light.h"
#include "tests/unit/edit_room.h"

#include "common/base/parallel.h"
#include "common/math/numbers.h"

enum { SIDE = 21, PLACES = SIDE * SIDE };
static const double SLOPE = 0.2; /* of the light, along x and z, a unit */

/* The north wall has a hole from -1 to 1, then it has none. */
static const struct box holed_room[] = {SLAB_WEST,
                                        SLAB_EAST,
                                        SLAB_SOUTH,
                                        SLAB_FLOOR,
                                        SLAB_TOP,
                                        {"walls", "north", {-2, 2, -2}, {-1, 3, 2}, false},
                                        {"walls", "north", {1, 2, -2}, {2, 3, 2}, false},
                                        {"walls", "north", {-1, 2, -2}, {1, 3, -1}, false},
                                        {"walls", "north", {-1, 2, 1}, {1, 3, 2}, false}};

/* Radiance is equal from all sides, and changes with the place: then the irradiance is pi times it. */
static double radiance_at(struct vec3 p) { return 1 + SLOPE * p.x - 2 * SLOPE * p.z; }

static void linear_look(const void *ctx, const struct vec3 from[RAY_PACKET], struct vec3 normal,
                        const struct vec3 direction[RAY_PACKET], unsigned active, struct light_look seen[RAY_PACKET])
{
    (void)ctx, (void)normal, (void)direction, (void)active;
    for (int k = 0; k < RAY_PACKET; k++)
        seen[k] = (struct light_look){
            .radiance = rgb_grey(radiance_at(from[k])), .source = LIGHT_TEXTURE, .distance = 1, .face = -1};
}

struct filled {
    struct light_change change;
    struct pixels p;
    struct irradiance before[PLACES], after[PLACES];
    float error[PLACES];
};

static struct vec3 place(int i) { return vec3_make(-1 + 0.1 * (i % SIDE), 2, -1 + 0.1 * (i / SIDE)); }

/* Places all over the hole, its rim included, of which the last one is said to be old. */
static void fill_hole(struct filled *f)
{
    static uint8_t kind[PLACES];
    static bool is_new[PLACES];
    static int from[PLACES];
    static float texel[PLACES][3];
    struct edit e = {.before = holed_room,
                     .after = closed_room,
                     .before_count = COUNT(holed_room),
                     .after_count = COUNT(closed_room),
                     .colours = plain};
    struct relight_params params = RELIGHT_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    *f = (struct filled){.p = {.width = SIDE, .height = SIDE, .kind = kind, .is_new = is_new, .from = from}};
    f->p.texel = texel;
    for (int i = 0; i < PLACES; i++) {
        const double at[3] = {place(i).x, place(i).y, place(i).z};
        for (int k = 0; k < 3; k++) texel[i][k] = (float)at[k];
        kind[i] = PIXEL_TEXTURE;
        is_new[i] = i < PLACES - 1;
        from[i] = NORTH;
        f->before[i].value = f->after[i].value = rgb_grey(7);
        f->error[i] = 7;
    }
    edit_read(&f->change, &e);
    f->change.before.plain.look = linear_look;
    f->change.before.plain.emitter_count = 0;
    assert_ok(rim_light_fill(f->before, f->error, f->after, &f->p, &f->change, &params, &err), err);
}

static void light_that_is_linear_around_a_hole_is_linear_in_it(void **state)
{
    static struct filled f;
    (void)state;
    fill_hole(&f);
    /* it is gathered a little inside the old wall, at most the inset away in x and z each */
    const double off = PI * 3 * SLOPE * f.change.inset;
    for (int i = 0; i < PLACES - 1; i++) {
        if (fabs(f.before[i].value.g - PI * radiance_at(place(i))) > off)
            fail_msg("the light at (%g, %g) is %g, not %g", place(i).x, place(i).z, f.before[i].value.g,
                     PI * radiance_at(place(i)));
        assert_true(f.error[i] < 0.02f);
    }
    light_change_release(&f.change);
}

/* Along the diagonals, on which two sides are equally near. */
static void light_does_not_jump_where_two_sides_of_the_rim_are_equally_near(void **state)
{
    static struct filled f;
    (void)state;
    fill_hole(&f);
    for (int y = 1; y + 1 < SIDE; y++)
        for (int x = 1; x + 1 < SIDE; x++) {
            const double here = f.before[y * SIDE + x].value.g;
            const double bend = f.before[y * SIDE + x - 1].value.g + f.before[y * SIDE + x + 1].value.g - 2 * here;
            if (y * SIDE + x + 1 < PLACES - 1) assert_true(fabs(bend) < 0.05 * PI * SLOPE);
        }
    light_change_release(&f.change);
}

static void a_place_of_the_old_model_keeps_its_light(void **state)
{
    static struct filled f;
    (void)state;
    fill_hole(&f);
    assert_true(f.before[PLACES - 1].value.g == 7 && f.error[PLACES - 1] == 7);
    for (int i = 0; i < PLACES; i++) assert_true(f.after[i].value.g == 7);
    light_change_release(&f.change);
}

static void threads_do_not_change_a_bit(void **state)
{
    static struct filled one, two;
    (void)state;
    parallel_set_threads(1);
    fill_hole(&one);
    parallel_set_threads(2);
    fill_hole(&two);
    parallel_set_threads(0);
    assert_memory_equal(one.before, two.before, sizeof one.before);
    assert_memory_equal(one.error, two.error, sizeof one.error);
    light_change_release(&one.change);
    light_change_release(&two.change);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_that_is_linear_around_a_hole_is_linear_in_it),
        cmocka_unit_test(light_does_not_jump_where_two_sides_of_the_rim_are_equally_near),
        cmocka_unit_test(a_place_of_the_old_model_keeps_its_light),
        cmocka_unit_test(threads_do_not_change_a_bit),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
