/* Rounds of light over rows that are known: closed forms of rooms that reflect evenly, the end of the rounds, black. */
#include "stages/update_vita/light_rounds.h"
#include "common/base/parallel.h"
#include "common/math/numbers.h"
#include "tests/unit/common/light/near.h"

enum { N = 64 };

/* A room of N samples that all see each other alike, as on the inside of a sphere. Sample i gets fixed[i] from
 * elsewhere. */
struct sphere {
    struct transport t;
    struct transport_sample samples[N];
    struct transport_row rows[N];
    struct transport_entry entries[N][N];
};

static void make_sphere(struct sphere *s, enum light_place_kind kind, double colour, const double fixed[N])
{
    *s = (struct sphere){.t = {.samples = s->samples, .rows = s->rows, .count = N}};
    for (int i = 0; i < N; i++) {
        s->samples[i].place = (struct light_place){.kind = kind, .colour = rgb_grey(colour)};
        s->rows[i] = (struct transport_row){.fixed = rgb_grey(fixed[i]), .entries = s->entries[i], .count = N};
        for (int k = 0; k < N; k++) {
            const bool is_colour = kind == LIGHT_PLACE_COLOUR;
            const float share = (float)(colour * (is_colour ? 1 : PI) / N); /* PI: radiance becomes irradiance */
            s->entries[i][k] = (struct transport_entry){2 * k + is_colour, {share, share, share}};
        }
    }
}

static void run(struct rounds *r, const struct sphere *s, int most)
{
    struct err err = ERR_INIT;
    assert_ok(rounds_run(r, &s->t, 1, most, 0.01, &err), err);
}

/* With emission e, radiance is e / (1 - a) everywhere [a: the albedo]. */
static void a_white_room_converges_to_the_closed_form(void **state)
{
    static const double albedos[] = {0, 0.5, 0.8, 0.95};
    static struct sphere s;
    const double e = 0.3;
    double fixed[N];
    (void)state;
    for (int i = 0; i < N; i++) fixed[i] = PI * e;
    for (int k = 0; k < 4; k++) {
        struct rounds r;
        const double a = albedos[k];
        make_sphere(&s, LIGHT_PLACE_COLOUR, a, fixed);
        run(&r, &s, 1000);
        assert_true(r.settled);
        for (int i = 0; i < N; i++) {
            const double radiance = e + a * r.values[2 * i + 1].g / PI;
            assert_near(radiance, e / (1 - a), 0.01);
            assert_true(radiance <= e / (1 - a) * (1 + 1e-6));
        }
        print_message("albedo %g: %d rounds\n", a, r.count);
        rounds_release(&r);
        rounds_release(&r);
    }
}

/* The lamp lights one sample in 64. The first reflection changes far less than the lamp did, but 19 times as much
 * follows. */
static void a_white_room_that_a_spot_lights_converges_too(void **state)
{
    static struct sphere s;
    const double a = 0.95;
    double fixed[N] = {100};
    struct rounds r;
    (void)state;
    make_sphere(&s, LIGHT_PLACE_COLOUR, a, fixed);
    run(&r, &s, 1000);
    assert_true(r.settled);
    const double mean = fixed[0] / N / (1 - a);
    for (int i = 0; i < N; i++) assert_near(r.values[2 * i + 1].g, fixed[i] + a * mean, 0.01);
    rounds_release(&r);
}

/* The same room photographed under its spot, which then becomes twice as bright. */
static void a_white_room_whose_only_spot_is_doubled_becomes_twice_as_bright(void **state)
{
    static struct sphere s;
    const double a = 0.95, fixed[N] = {200}, mean = 100.0 / N / (1 - a);
    struct rounds r;
    (void)state;
    make_sphere(&s, LIGHT_PLACE_TEXTURE, 1, fixed);
    for (int i = 0; i < N; i++) {
        const double before = (i ? 0 : 100) + a * mean;
        s.rows[i].before = rgb_grey(before);
        s.samples[i].place.colour = rgb_grey(0.9999 * a * before / PI); /* 0.95 is not above 0.95 */
        for (int k = 0; k < N; k++) {
            const float share = (float)(a * before / N);
            s.entries[k][i] = (struct transport_entry){2 * i, {share, share, share}};
        }
    }
    run(&r, &s, 1000);
    assert_true(r.settled);
    for (int i = 0; i < N; i++) assert_near(r.values[2 * i].g, 2, 0.01);
    rounds_release(&r);
}

/* Texels of radiance 1 under a light that is doubled: all light doubles. */
static void twice_the_lamps_give_twice_the_light(void **state)
{
    static struct sphere s;
    double fixed[N];
    struct rounds r;
    (void)state;
    for (int i = 0; i < N; i++) fixed[i] = 2.0 * (i % 5 + 1);
    make_sphere(&s, LIGHT_PLACE_TEXTURE, 1, fixed);
    for (int i = 0; i < N; i++) s.rows[i].before = rgb_grey(PI + fixed[i] / 2);
    run(&r, &s, 1000);
    assert_true(r.settled);
    for (int i = 0; i < N; i++) {
        assert_near(r.values[2 * i].g, 2, 0.01);
        assert_near(r.values[2 * i + 1].g, 2 * s.rows[i].before.g, 0.01);
    }
    assert_int_equal(r.bounded, 0);
    rounds_release(&r);
}

/* Texels of albedo 0.8 from which all light is taken. */
static void make_dark_sphere(struct sphere *s)
{
    const double fixed[N] = {0};
    make_sphere(s, LIGHT_PLACE_TEXTURE, 1, fixed);
    for (int i = 0; i < N; i++) s->rows[i].before = rgb_grey(PI / 0.8);
}

static void where_all_lights_go_out_it_becomes_black(void **state)
{
    static struct sphere s;
    struct rounds r;
    (void)state;
    make_dark_sphere(&s);
    run(&r, &s, 1000);
    assert_true(r.settled);
    for (int i = 0; i < N; i++) assert_true(r.values[2 * i].g < 1e-4 && r.values[2 * i].g >= 0);
    rounds_release(&r);
}

/* A colour has no light before. Its own, reflected to and fro, becomes less and less, but never 0. */
static void a_painted_sample_among_texels_becomes_black_too(void **state)
{
    static struct sphere s;
    struct rounds r;
    (void)state;
    make_dark_sphere(&s);
    s.samples[3].place = (struct light_place){.kind = LIGHT_PLACE_COLOUR, .colour = rgb_grey(0.5)};
    s.rows[3].before = rgb_grey(0);
    for (int i = 0; i < N; i++) s.entries[i][3] = (struct transport_entry){7, {0.5f / N, 0.5f / N, 0.5f / N}};
    run(&r, &s, 1000);
    assert_true(r.settled && r.values[7].g < 1e-4);
    rounds_release(&r);
}

/* Texels brighter than white under the light that was found would send out more and more. */
static void texels_that_seem_brighter_than_white_gain_no_energy(void **state)
{
    static struct sphere s;
    double fixed[N];
    struct rounds r;
    (void)state;
    for (int i = 0; i < N; i++) fixed[i] = 1;
    make_sphere(&s, LIGHT_PLACE_TEXTURE, 1, fixed);
    for (int i = 0; i < N; i++) s.rows[i].before = rgb_grey(0.2 * PI); /* an albedo of 5 */
    run(&r, &s, 2000);
    assert_true(r.settled);
    assert_int_equal(r.bounded, N);
    /* E = fixed + pi q, pi q = pi + 0.95 (E - before) */
    for (int i = 0; i < N; i++) assert_near(r.values[2 * i + 1].g, (1 + PI - 0.95 * 0.2 * PI) / 0.05, 0.01);
    rounds_release(&r);
}

/* No lamp is known, and the edit takes 3 % of what each sample gets: all light would go. With f = 0.8 of it reflected,
 * E = 0.97 E_0 (f E / E_0 + 1 - f). */
static void a_room_without_known_lamps_keeps_its_light(void **state)
{
    static struct sphere s;
    const double fixed[N] = {0}, f = 0.8, kept = 0.97;
    struct err err = ERR_INIT;
    struct rounds r;
    (void)state;
    make_sphere(&s, LIGHT_PLACE_TEXTURE, kept, fixed);
    for (int i = 0; i < N; i++) s.rows[i].before = rgb_grey(PI);
    assert_ok(rounds_run(&r, &s.t, f, 400, 0.01, &err), err);
    assert_true(r.settled);
    const double quotient = kept * (1 - f) / (1 - f * kept);
    for (int i = 0; i < N; i++) {
        assert_near(r.values[2 * i + 1].g / PI, quotient, 0.01);
        assert_near(r.values[2 * i].g, 1 - f + f * quotient, 0.01);
    }
    rounds_release(&r);
    run(&r, &s, 400);
    assert_true(r.values[1].g < 0.01 * PI);
    rounds_release(&r);
}

static void nothing_changed_ends_after_one_round_with_quotients_of_one(void **state)
{
    static struct sphere s;
    const double fixed[N] = {0};
    struct rounds r;
    (void)state;
    make_sphere(&s, LIGHT_PLACE_TEXTURE, 1, fixed);
    for (int i = 0; i < N; i++) {
        struct rgb ones[2 * N];
        for (int k = 0; k < 2 * N; k++) ones[k] = rgb_grey(1);
        s.rows[i].before = transport_gather(&s.rows[i], ones);
    }
    run(&r, &s, 50);
    assert_int_equal(r.count, 1);
    assert_true(r.settled && r.list[0].change == 0 && r.list[0].left == 0);
    for (int i = 0; i < N; i++) assert_true(r.values[2 * i].r == 1 && r.values[2 * i].g == 1 && r.values[2 * i].b == 1);
    rounds_release(&r);
}

static void rounds_that_do_not_settle_say_so(void **state)
{
    static struct sphere s;
    double fixed[N];
    struct rounds r;
    (void)state;
    for (int i = 0; i < N; i++) fixed[i] = 1;
    make_sphere(&s, LIGHT_PLACE_COLOUR, 0.95, fixed);
    run(&r, &s, 5);
    assert_false(r.settled);
    assert_int_equal(r.count, 5);
    assert_true(isinf(r.list[0].left) && r.list[4].left > 0.01);
    rounds_release(&r);
}

static void threads_do_not_change_a_bit(void **state)
{
    static struct sphere s;
    double fixed[N];
    struct rounds one, two;
    (void)state;
    for (int i = 0; i < N; i++) fixed[i] = i % 7;
    make_sphere(&s, LIGHT_PLACE_COLOUR, 0.7, fixed);
    parallel_set_threads(1);
    run(&one, &s, 100);
    parallel_set_threads(2);
    run(&two, &s, 100);
    parallel_set_threads(0);
    assert_memory_equal(one.values, two.values, 2 * N * sizeof *one.values);
    rounds_release(&one);
    rounds_release(&two);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_white_room_converges_to_the_closed_form),
        cmocka_unit_test(a_white_room_that_a_spot_lights_converges_too),
        cmocka_unit_test(a_white_room_whose_only_spot_is_doubled_becomes_twice_as_bright),
        cmocka_unit_test(twice_the_lamps_give_twice_the_light),
        cmocka_unit_test(where_all_lights_go_out_it_becomes_black),
        cmocka_unit_test(a_painted_sample_among_texels_becomes_black_too),
        cmocka_unit_test(texels_that_seem_brighter_than_white_gain_no_energy),
        cmocka_unit_test(a_room_without_known_lamps_keeps_its_light),
        cmocka_unit_test(nothing_changed_ends_after_one_round_with_quotients_of_one),
        cmocka_unit_test(rounds_that_do_not_settle_say_so),
        cmocka_unit_test(threads_do_not_change_a_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
