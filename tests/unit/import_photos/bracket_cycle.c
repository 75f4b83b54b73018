/* bracket_cycle.c - brackets by equal exposures and by equal steps; photos with automatic exposure are none. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/rng.h"
#include "stages/import_photos/bracket_cycle.h"

enum { MAX_SHOTS = 120 };

struct sequence {
    struct bracket_shot shots[MAX_SHOTS];
    int count;
};

static void add(struct sequence *s, double exposure, double taken)
{
    assert_true(s->count < MAX_SHOTS);
    s->shots[s->count++] = (struct bracket_shot){exposure, exposure, taken};
}

/* The exposure time that a camera with steps of a third of a stop displays: 1/60 for 2^-6. */
static double displayed(double stops)
{
    static const double times[] = {
        30,         25,         20,         15,         13,         10,         8,         6,         5,
        4,          3.2,        2.5,        2,          1.6,        1.3,        1,         0.8,       0.6,
        0.5,        0.4,        0.3,        1.0 / 4,    1.0 / 5,    1.0 / 6,    1.0 / 8,   1.0 / 10,  1.0 / 13,
        1.0 / 15,   1.0 / 20,   1.0 / 25,   1.0 / 30,   1.0 / 40,   1.0 / 50,   1.0 / 60,  1.0 / 80,  1.0 / 100,
        1.0 / 125,  1.0 / 160,  1.0 / 200,  1.0 / 250,  1.0 / 320,  1.0 / 400,  1.0 / 500, 1.0 / 640, 1.0 / 800,
        1.0 / 1000, 1.0 / 1250, 1.0 / 1600, 1.0 / 2000, 1.0 / 2500, 1.0 / 3200, 1.0 / 4000};
    const int at = (int)round(15 - 3 * stops), last = (int)(sizeof times / sizeof *times) - 1; /* times[15] is 2^5/32 */
    return times[at < 0 ? 0 : at > last ? last : at];
}

static enum bracket_verdict find(struct bracket_cycle *c, const struct sequence *s)
{
    return bracket_cycle_find(c, s->shots, s->count, BRACKETS_MAY_BE);
}

/* Views of the same exposures, in stops; the base of each view differs. */
static struct sequence bracketed(const double *stops, int length, const double *bases, int views)
{
    struct sequence s = {0};
    for (int v = 0; v < views; v++)
        for (int k = 0; k < length; k++) add(&s, displayed(bases[v] + stops[k]), 0);
    return s;
}

static void equal_exposures_are_a_cycle(void **state)
{
    static const double stops[] = {0, -2, 2}, bases[] = {-6, -6, -6, -6};
    struct bracket_cycle c;
    (void)state;
    for (int views = 2; views <= 4; views++) {
        const struct sequence s = bracketed(stops, 3, bases, views);
        assert_int_equal(find(&c, &s), BRACKETS_ALL);
        assert_true(c.begin == 0 && c.length == 3 && c.count == views && !c.steps);
    }
}

/* In aperture priority the base follows the light; the times are rounded as cameras do. */
static void equal_steps_are_a_cycle(void **state)
{
    static const double bases[] = {-6, -5, -7, -19.0 / 3, -16.0 / 3, -6, -13.0 / 3, -8};
    static const struct {
        double stops[7];
        int length, min_views; /* without times */
    } cases[] = {{{0, -2, 2}, 3, 4},
                 {{-2, 0, 2}, 3, 4},
                 {{0, -1, 1}, 3, 4},
                 {{0, -2.0 / 3, 2.0 / 3, -4.0 / 3, 4.0 / 3}, 5, 3},
                 {{-3, -2, -1, 0, 1, 2, 3}, 7, 2},
                 {{-2, 0, 0, 2}, 4, 3}};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (int views = 2; views <= 8; views++) {
            const struct sequence s = bracketed(cases[i].stops, cases[i].length, bases, views);
            struct bracket_cycle c;
            const enum bracket_verdict verdict = find(&c, &s);
            if (views < cases[i].min_views) {
                assert_int_not_equal(verdict, BRACKETS_ALL);
                continue;
            }
            assert_int_equal(verdict, BRACKETS_ALL);
            assert_true(c.begin == 0 && c.length == cases[i].length && c.count == views && c.steps);
        }
}

/* Bases that are equal two by two are not views of six exposures; 1/240 1/60 1/60 1/15 are not two views. */
static void views_are_neither_joined_nor_parted(void **state)
{
    static const double stops[] = {0, -2, 2}, bases[] = {-6, -6, -4, -4, -7, -7};
    static const double four[] = {1 / 240.0, 1 / 60.0, 1 / 60.0, 1 / 15.0};
    const struct sequence twice = bracketed(stops, 3, bases, 6);
    struct sequence repeated = {0};
    struct bracket_cycle c;
    (void)state;
    assert_int_equal(find(&c, &twice), BRACKETS_ALL);
    assert_true(c.length == 3 && c.count == 6);
    for (int i = 0; i < 16; i++) add(&repeated, four[i % 4], 0);
    assert_int_equal(find(&c, &repeated), BRACKETS_ALL);
    assert_true(c.length == 4 && c.count == 4);
}

/* Three views of three exposures with steps only: 4 steps agree, which the times must support. */
static void times_decide_where_few_steps_agree(void **state)
{
    static const double stops[] = {0, -2, 2}, bases[] = {-6, -5, -7};
    struct bracket_cycle c;
    (void)state;
    for (int pause = 0; pause < 3; pause++) {
        static const double pauses[] = {30, 1, 0.4}; /* between views; 1 s between exposures */
        struct sequence s = bracketed(stops, 3, bases, 3);
        double clock = 1e9;
        for (int i = 0; i < s.count; i++) {
            s.shots[i].taken = clock;
            clock += s.shots[i].seconds + (i % 3 == 2 ? pauses[pause] : 1);
        }
        assert_int_equal(find(&c, &s) == BRACKETS_ALL, pause == 0);
    }
    /* enough steps, but the photos of a view are farther apart than the views */
    static const double many[] = {-6, -5, -7, -6, -4, -8, -5};
    struct sequence s = bracketed(stops, 3, many, 7);
    assert_int_equal(find(&c, &s), BRACKETS_ALL);
    for (int i = 0; i < s.count; i++) s.shots[i].taken = 1e9 + 10 * i - (i % 3 == 0 ? 5 : 0);
    assert_int_equal(find(&c, &s), BRACKETS_JUMPS);
}

static void missing_exposures_are_noticed(void **state)
{
    static const double stops[] = {0, -2, 2}, bases[] = {-6, -5, -7, -19.0 / 3, -16.0 / 3, -6, -13.0 / 3, -8};
    struct bracket_cycle c;
    (void)state;
    for (int gone = 0; gone < 24; gone++) {
        struct sequence s = bracketed(stops, 3, bases, 8);
        memmove(s.shots + gone, s.shots + gone + 1, sizeof *s.shots * (size_t)(s.count-- - gone - 1));
        assert_int_equal(find(&c, &s), BRACKETS_SOME);
        assert_true(c.length == 3 && c.count == 7);
    }
}

/* A normal number from two uniform ones [Box and Muller]. */
static double normal(const struct rng *rng, uint64_t set, uint64_t *draws)
{
    const double u = rng_uniform(rng, set, (*draws)++), v = rng_uniform(rng, set, (*draws)++);
    return sqrt(-2 * log(1 - u)) * cos(6.283185307179586 * v);
}

/* Single photos of a walk with automatic exposure: the light changes in steps of `spread` stops from photo to photo
 * (drift), or is drawn anew for each (else). Cameras round to thirds of a stop, phones do not; where it is dark both
 * stay at a longest time. */
static struct sequence walk(const struct rng *rng, uint64_t set, double spread, bool drift, bool thirds, bool dark)
{
    struct sequence s = {0};
    uint64_t draws = 0;
    const int count = 4 + (int)(rng_uniform(rng, set, draws++) * 44);
    double stops = -6;
    for (int i = 0; i < count; i++) {
        stops = drift ? stops + spread * normal(rng, set, &draws) : -6 + spread * normal(rng, set, &draws);
        stops = fmin(fmax(stops, -12), dark ? -5.5 : -2);
        add(&s, thirds ? displayed(stops) : exp2(stops), 0);
    }
    return s;
}

/* None has the steps of brackets; fewer than one in 5000 has exposures that repeat as those of brackets do, which needs
 * only 6 photos. */
static void photos_with_automatic_exposure_stay_single(void **state)
{
    static const double spreads[] = {0.1, 0.3, 0.5, 0.7, 1, 1.5};
    const int sets = 700;
    int by_steps = 0, by_equal = 0, some_steps = 0, some_equal = 0, jumping = 0, calm = 0;
    const struct rng rng = rng_make(7, "bracket_cycle", "walks");
    uint64_t set = 0;
    (void)state;
    for (size_t i = 0; i < sizeof spreads / sizeof *spreads; i++)
        for (int kind = 0; kind < 8; kind++)
            for (int k = 0; k < sets; k++) {
                const struct sequence s = walk(&rng, set++, spreads[i], kind & 1, kind & 2, kind & 4);
                struct bracket_cycle c;
                const enum bracket_verdict verdict = find(&c, &s);
                by_steps += verdict == BRACKETS_ALL && c.steps;
                by_equal += verdict == BRACKETS_ALL && !c.steps;
                some_steps += verdict == BRACKETS_SOME && c.steps;
                some_equal += verdict == BRACKETS_SOME && !c.steps;
                jumping += verdict == BRACKETS_JUMPS && spreads[i] <= 1 && kind & 1;
                calm += spreads[i] <= 1 && kind & 1;
            }
    print_message(
        "of %d walks, brackets by steps: %d, by equal exposures: %d, incomplete: %d and %d; of %d that drift by up "
        "to a stop, said to jump: %d\n",
        (int)set, by_steps, by_equal, some_steps, some_equal, calm, jumping);
    assert_int_equal(by_steps + some_steps, 0);
    assert_true(5000 * (by_equal + some_equal) <= (int)set);
    assert_true(jumping <= calm / 50);
}

static void jumps_without_a_cycle_are_noticed(void **state)
{
    static const double exposures[] = {1, 8, 0.5, 3, 1, 16, 2, 7, 1};
    struct sequence s = {0};
    struct bracket_cycle c;
    (void)state;
    for (int i = 0; i < 9; i++) add(&s, exposures[i], 0);
    assert_int_equal(find(&c, &s), BRACKETS_JUMPS);
    assert_int_equal(c.length, 0);
    s.shots[4].exposure = 0; /* unknown */
    assert_int_equal(find(&c, &s), BRACKETS_NONE);
    s.count = 0;
    assert_int_equal(find(&c, &s), BRACKETS_NONE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_exposures_are_a_cycle),
        cmocka_unit_test(equal_steps_are_a_cycle),
        cmocka_unit_test(views_are_neither_joined_nor_parted),
        cmocka_unit_test(times_decide_where_few_steps_agree),
        cmocka_unit_test(missing_exposures_are_noticed),
        cmocka_unit_test(photos_with_automatic_exposure_stay_single),
        cmocka_unit_test(jumps_without_a_cycle_are_noticed),
    };
    return cmocka_run_group_tests_name("bracket_cycle", tests, NULL, NULL);
}
