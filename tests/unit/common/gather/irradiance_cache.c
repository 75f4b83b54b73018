/* The cache of irradiance: gradients against closed forms, error of a picture, the same bits for any number of
 * threads. */
#include "tests/unit/common/light/near.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/gather/cache_record.h"
#include "common/gather/irradiance_cache.h"
#include "tests/unit/common/gather/fields.h"

enum { WIDTH = 160, HEIGHT = 120 };

static double box_irradiance(const struct patch_field *f, struct gather_point p)
{
    double sum = 0;
    for (int i = 0; i < 6; i++) sum += PI * f->patches[i].radiance.g * patch_factor(&f->patches[i], p);
    return sum;
}

static void gradients_are_those_of_a_box_in_closed_form(void **state)
{
    static const struct rgb sides[6] = {{1, 1, 1}, {1, 2, 1}, {1, 0.5, 1}, {1, 0.1, 1}, {1, 9, 1}, {1, 4, 1}};
    const struct gather_point p = {{0.2, -0.3, 0.4}, {0, 0, 1}};
    const double d = 1e-4;
    struct patch_field f;
    struct vec3 move = {0, 0, 0}, turn = {0, 0, 0};
    double error = 0;
    (void)state;
    field_start(&f, rgb_grey(0));
    field_add_box(&f, vec3_make(-1, -2, 0), vec3_make(2, 1, 1.5), sides, true);
    for (uint64_t k = 0; k < 16; k++) {
        struct cache_record r;
        cache_record_gather(&r, &f.field, p, 0, 0, 1024, k);
        move = vec3_add(move, vec3_scale(r.move[1], 1.0 / 16));
        turn = vec3_add(turn, vec3_scale(r.turn[1], 1.0 / 16));
        error = fmax(error, fabs(r.value.g / box_irradiance(&f, p) - 1));
        assert_true(r.error > 0);
    }
    assert_true(error < 0.003);
    for (int axis = 0; axis < 2; axis++) {
        const struct vec3 by = axis ? vec3_make(0, d, 0) : vec3_make(d, 0, 0);
        const struct gather_point ahead = {vec3_add(p.at, by), p.normal}, behind = {vec3_sub(p.at, by), p.normal};
        const struct gather_point leans = {p.at, vec3_normalize(vec3_add(p.normal, by))};
        const struct gather_point leans_back = {p.at, vec3_normalize(vec3_sub(p.normal, by))};
        const double moved = (box_irradiance(&f, ahead) - box_irradiance(&f, behind)) / (2 * d);
        const double turned = (box_irradiance(&f, leans) - box_irradiance(&f, leans_back)) / (2 * d);
        print_message("move %g, true %g; turn %g, true %g\n", axis ? move.y : move.x, moved,
                      vec3_dot(turn, vec3_cross(p.normal, by)) / d, turned);
        assert_near(axis ? move.y : move.x, moved, 0.03);
        assert_near(vec3_dot(turn, vec3_cross(p.normal, by)) / d, turned, 0.03);
    }
}

static void fill(struct irradiance *results, const struct gather_point *points, const struct patch_field *f,
                 double target, struct irradiance_cache_stats *stats)
{
    struct err err = ERR_INIT;
    const struct irradiance_cache_job job = {.field = &f->field,
                                             .points = points,
                                             .width = WIDTH,
                                             .height = HEIGHT,
                                             .target = target,
                                             .rays = 4096,
                                             .key = 9};
    assert_ok(irradiance_cache_fill(results, &job, stats, &err), err);
}

static void a_picture_of_a_room_is_within_its_target(void **state)
{
    static const double targets[] = {0.02, 0.01};
    static struct gather_point points[WIDTH * HEIGHT];
    static struct irradiance results[WIDTH * HEIGHT];
    static struct patch_field f;
    (void)state;
    field_make_room(&f);
    field_see_room(points, WIDTH, HEIGHT, &f);
    for (int t = 0; t < 2; t++) {
        struct irradiance_cache_stats stats;
        double squares = 0, stated = 0;
        int count = 0;
        fill(results, points, &f, targets[t], &stats);
        for (int i = 3; i < WIDTH * HEIGHT; i += 37) {
            struct irradiance e;
            if (!(vec3_length(points[i].normal) > 0)) continue;
            ray_irradiance_to(&e, &f.field, points[i], 0.002, 1 << 18, 77);
            const double truth = rgb_luminance(e.value);
            squares += pow(rgb_luminance(results[i].value) / truth - 1, 2);
            stated += pow(rgb_luminance(results[i].error) / truth, 2);
            count++;
        }
        print_message(
            "target %g: RMS error %.2g %%, stated %.2g %%, %zu records of %.0f rays, %.0f direct rays a point\n",
            targets[t], 100 * sqrt(squares / count), 100 * sqrt(stated / count), stats.records,
            stats.record_rays / (double)stats.records, stats.direct_rays / (WIDTH * HEIGHT));
        assert_true(sqrt(squares / count) < targets[t]);
        assert_true(stats.records < WIDTH * HEIGHT / 4);
    }
}

static void threads_do_not_change_a_bit(void **state)
{
    static struct gather_point points[WIDTH * HEIGHT];
    static struct irradiance one[WIDTH * HEIGHT], three[WIDTH * HEIGHT];
    static struct patch_field f;
    (void)state;
    field_make_room(&f);
    field_see_room(points, WIDTH, HEIGHT, &f);
    parallel_set_threads(1);
    fill(one, points, &f, 0.05, NULL);
    parallel_set_threads(3);
    fill(three, points, &f, 0.05, NULL);
    parallel_set_threads(0);
    assert_memory_equal(one, three, sizeof one);
}

static void points_without_a_normal_are_left_dark(void **state)
{
    static struct gather_point points[WIDTH * HEIGHT];
    static struct irradiance results[WIDTH * HEIGHT];
    static struct patch_field f;
    struct irradiance_cache_stats stats;
    (void)state;
    field_make_room(&f);
    fill(results, points, &f, 0.05, &stats);
    assert_int_equal(stats.records, 0);
    points[WIDTH + 3] = (struct gather_point){{2, 1, 0}, {0, 0, 1}};
    fill(results, points, &f, 0.05, &stats);
    assert_int_equal(stats.records, 1);
    assert_near(results[0].value.g, 0, 0);
    assert_true(results[WIDTH + 3].value.g > 0);
}

static void darkness_stays_dark(void **state)
{
    static struct gather_point points[WIDTH * HEIGHT];
    static struct irradiance results[WIDTH * HEIGHT];
    static struct patch_field f, dark;
    (void)state;
    field_make_room(&f);
    field_see_room(points, WIDTH, HEIGHT, &f);
    field_start(&dark, rgb_grey(0));
    fill(results, points, &dark, 0.05, NULL);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        assert_true(results[i].value.g == 0 && results[i].error.g == 0);
        for (int s = 0; s < LIGHT_SOURCES; s++) assert_true(results[i].from[s] == 0);
    }
}

/* Fills both results from two fields with the same points. */
static void fill_both(struct irradiance *results, struct irradiance *others, const struct gather_point *points,
                      const struct patch_field *f, const struct patch_field *other)
{
    struct err err = ERR_INIT;
    const struct irradiance_cache_job job = {.field = &f->field,
                                             .points = points,
                                             .other = {&other->field, points, others, .step = 4},
                                             .width = WIDTH,
                                             .height = HEIGHT,
                                             .target = 0.05,
                                             .rays = 1024,
                                             .key = 9};
    assert_ok(irradiance_cache_fill(results, &job, NULL, &err), err);
}

static void two_equal_fields_get_equal_bits(void **state)
{
    static struct gather_point points[WIDTH * HEIGHT];
    static struct irradiance one[WIDTH * HEIGHT], two[WIDTH * HEIGHT];
    static struct patch_field f, same;
    (void)state;
    field_make_room(&f);
    field_make_room(&same);
    field_see_room(points, WIDTH, HEIGHT, &f);
    fill_both(one, two, points, &f, &same);
    assert_memory_equal(one, two, sizeof one);
}

/* All that shines is twice as bright: the quotient is exactly 2, whatever the noise. */
static void twice_the_field_gives_a_quotient_of_two(void **state)
{
    static struct gather_point points[WIDTH * HEIGHT];
    static struct irradiance one[WIDTH * HEIGHT], two[WIDTH * HEIGHT];
    static struct patch_field f, twice;
    (void)state;
    field_make_room(&f);
    field_make_room(&twice);
    for (int i = 0; i < twice.count; i++) twice.patches[i].radiance = rgb_scale(twice.patches[i].radiance, 2);
    field_see_room(points, WIDTH, HEIGHT, &f);
    fill_both(one, two, points, &f, &twice);
    for (int i = 0; i < WIDTH * HEIGHT; i++) assert_near(two[i].value.g, 2 * one[i].value.g, 1e-12);
}

/* A change in one place alone: points that do not see it keep equal bits. */
static void what_does_not_see_a_change_has_equal_bits(void **state)
{
    enum { COLUMNS = 32, ROWS = 32 };
    static struct gather_point points[COLUMNS * ROWS];
    static struct irradiance one[COLUMNS * ROWS], two[COLUMNS * ROWS];
    static struct patch_field f, g;
    struct err err = ERR_INIT;
    (void)state;
    field_make_room(&f);
    field_make_room(&g);
    g.patches[5].radiance = rgb_make(3, 2, 1); /* the ceiling */
    for (int i = 0; i < COLUMNS * ROWS; i++) { /* the ceiling itself does not see it; the floor does */
        const double x = 0.1 + 3.8 * (i % COLUMNS) / COLUMNS, y = 0.1 + 2.8 * (i / COLUMNS) / ROWS;
        points[i] = i / COLUMNS < ROWS / 2 ? (struct gather_point){{x, y, 2.5}, {0, 0, -1}}
                                           : (struct gather_point){{x, y, 0}, {0, 0, 1}};
    }
    const struct irradiance_cache_job job = {.field = &f.field,
                                             .points = points,
                                             .other = {.field = &g.field, .points = points, .results = two, .step = 1},
                                             .width = COLUMNS,
                                             .height = ROWS,
                                             .target = 0.05,
                                             .rays = 1024};
    assert_ok(irradiance_cache_fill(one, &job, NULL, &err), err);
    assert_memory_equal(one, two, COLUMNS * ROWS / 2 * sizeof *one);
    for (int i = COLUMNS * ROWS / 2; i < COLUMNS * ROWS; i++) assert_true(two[i].value.r > one[i].value.r);
}

static void two_fields_have_the_same_bits_for_any_number_of_threads(void **state)
{
    static struct gather_point points[WIDTH * HEIGHT];
    static struct irradiance one[2][WIDTH * HEIGHT], two[2][WIDTH * HEIGHT];
    static struct patch_field f, g;
    (void)state;
    field_make_room(&f);
    field_make_room(&g);
    g.patches[3].radiance = rgb_make(0.1, 0.9, 0.1);
    field_see_room(points, WIDTH, HEIGHT, &f);
    parallel_set_threads(1);
    fill_both(one[0], one[1], points, &f, &g);
    parallel_set_threads(2);
    fill_both(two[0], two[1], points, &f, &g);
    parallel_set_threads(0);
    assert_memory_equal(one, two, sizeof one);
}

/* Both fields at the corners of cells, against each point; where light is the same, equal bits as well. */
static void cells_find_the_quotient_of_each_point(void **state)
{
    enum { COLUMNS = 96, ROWS = 64 };
    static struct gather_point points[COLUMNS * ROWS];
    static struct irradiance one[2][COLUMNS * ROWS], two[2][COLUMNS * ROWS];
    static float errors[2][COLUMNS * ROWS];
    static struct patch_field f, g;
    struct irradiance_cache_stats stats[2];
    struct err err = ERR_INIT;
    double squares = 0, stated = 0;
    (void)state;
    field_make_room(&f);
    field_make_room(&g);
    g.patches[5].radiance = rgb_make(3, 2, 1); /* the ceiling */
    for (int i = 0; i < COLUMNS * ROWS; i++) {
        const double x = 0.1 + 3.8 * (i % COLUMNS) / COLUMNS, y = 0.1 + 2.8 * (i / COLUMNS) / ROWS;
        points[i] = i / COLUMNS < ROWS / 2 ? (struct gather_point){{x, y, 2.5}, {0, 0, -1}}
                                           : (struct gather_point){{x, y, 0}, {0, 0, 1}};
    }
    for (int k = 0; k < 2; k++) {
        const struct irradiance_cache_job job = {
            .field = &f.field,
            .points = points,
            .other = {.field = &g.field, .points = points, .results = two[k], .errors = errors[k], .step = k ? 8 : 1},
            .width = COLUMNS,
            .height = ROWS,
            .target = 0.02,
            .rays = 1024};
        assert_ok(irradiance_cache_fill(one[k], &job, &stats[k], &err), err);
    }
    assert_memory_equal(one[1], two[1], COLUMNS * ROWS / 2 * sizeof *one[1]);
    for (int i = 0; i < COLUMNS * ROWS / 2; i++) assert_true(errors[1][i] == 0);
    for (int i = COLUMNS * ROWS / 2; i < COLUMNS * ROWS; i++) {
        const double q[2] = {two[0][i].value.g / one[0][i].value.g, two[1][i].value.g / one[1][i].value.g};
        squares += (q[1] / q[0] - 1) * (q[1] / q[0] - 1) / (COLUMNS * ROWS / 2);
        stated += (double)errors[1][i] / (COLUMNS * ROWS / 2);
    }
    print_message("cells: RMS difference %.2g %%, stated %.2g %%, direct rays %.3g instead of %.3g\n",
                  100 * sqrt(squares), 100 * stated, stats[1].direct_rays, stats[0].direct_rays);
    assert_true(sqrt(squares) < 0.02);
    assert_true(stated > 0 && stated < 0.02);
    assert_true(stats[1].direct_rays < stats[0].direct_rays / 4);
}

/* Where the light after an edit counts by itself, as on a wall that the edit adds, it is known to the target although
 * the quotient is 1 without any noise. A black room with a lamp of 1 x 1, against its closed form. */
static void light_that_counts_by_itself_is_known_to_the_target(void **state)
{
    enum { COLUMNS = 40, ROWS = 40 };
    static const struct rgb black[6];
    static struct gather_point points[COLUMNS * ROWS];
    static struct irradiance one[COLUMNS * ROWS], two[2][COLUMNS * ROWS];
    static float errors[COLUMNS * ROWS];
    static unsigned char whole[COLUMNS * ROWS];
    static struct patch_field f;
    struct irradiance_cache_stats stats[2];
    struct err err = ERR_INIT;
    double off[2] = {0}, stated = 0;
    (void)state;
    field_start(&f, rgb_grey(0));
    field_add_box(&f, vec3_make(0, 0, 0), vec3_make(4, 3, 2.5), black, true);
    struct patch *lamp = field_add(&f, EMITTER_QUAD, vec3_make(1.7, 1.3, 1.2), vec3_make(0.5, 0, 0),
                                   vec3_make(0, 0.5, 0), vec3_make(0, 0, -1), rgb_grey(9));
    field_name(&f, lamp);
    for (int i = 0; i < COLUMNS * ROWS; i++)
        points[i] = (struct gather_point){{0.1 + 3.8 * (i % COLUMNS) / COLUMNS, 0.1 + 2.8 * (i / COLUMNS) / ROWS, 0},
                                          {0, 0, 1}};
    for (int k = 0; k < 2; k++) {
        memset(whole, k, sizeof whole);
        const struct irradiance_cache_job job = {.field = &f.field,
                                                 .points = points,
                                                 .other = {&f.field, points, two[k], errors, whole, 8},
                                                 .width = COLUMNS,
                                                 .height = ROWS,
                                                 .target = 0.002,
                                                 .rays = 65536};
        assert_ok(irradiance_cache_fill(one, &job, &stats[k], &err), err);
        for (int i = 0; i < COLUMNS * ROWS; i++) {
            const double truth = PI * 9 * patch_factor(lamp, points[i]), error = two[k][i].value.g / truth - 1;
            off[k] += error * error / (COLUMNS * ROWS);
            if (k) stated = fmax(stated, two[k][i].error.g / two[k][i].value.g);
        }
    }
    print_message(
        "by itself: RMS error %.2g %%, by the quotient %.2g %%; stated at most %.2g %%; direct rays %.3g and %.3g\n",
        100 * sqrt(off[1]), 100 * sqrt(off[0]), 100 * stated, stats[1].direct_rays, stats[0].direct_rays);
    assert_true(stated <= 0.002);
    assert_true(sqrt(off[1]) < 0.002);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gradients_are_those_of_a_box_in_closed_form),
        cmocka_unit_test(a_picture_of_a_room_is_within_its_target),
        cmocka_unit_test(threads_do_not_change_a_bit),
        cmocka_unit_test(points_without_a_normal_are_left_dark),
        cmocka_unit_test(darkness_stays_dark),
        cmocka_unit_test(two_equal_fields_get_equal_bits),
        cmocka_unit_test(twice_the_field_gives_a_quotient_of_two),
        cmocka_unit_test(what_does_not_see_a_change_has_equal_bits),
        cmocka_unit_test(two_fields_have_the_same_bits_for_any_number_of_threads),
        cmocka_unit_test(cells_find_the_quotient_of_each_point),
        cmocka_unit_test(light_that_counts_by_itself_is_known_to_the_target),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
