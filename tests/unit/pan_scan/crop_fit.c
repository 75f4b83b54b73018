/* crop_fit.c - a crop that shows points exactly is found; where that leaves the photograph, the best within it. */
#include "stages/pan_scan/crop_fit.h"

#include "tests/unit/scratch.h"

#include <math.h>

#include "common/rng.h"

enum { POINTS = 60, W = 320, H = 200, PHOTO_W = 800, PHOTO_H = 600 };

static double random_part(uint64_t index)
{
    const struct rng rng = rng_make(1, "test", "points");
    return rng_uniform(&rng, 0, index);
}

/* Points all over the photograph, where a frame that shows `crop` has them. */
static void make_task(struct crop_task *task, struct crop_pair *pairs, const struct crop *crop)
{
    *task = (struct crop_task){PHOTO_W, PHOTO_H, W, H, crop->width / W, crop->height / H, 3, pairs, POINTS};
    for (int i = 0; i < POINTS; i++) {
        struct crop_pair *p = &pairs[i];
        p->x = PHOTO_W * random_part(2 * (uint64_t)i), p->y = PHOTO_H * random_part(2 * (uint64_t)i + 1);
        crop_apply(task, crop, p->x, p->y, &p->u, &p->v);
    }
}

static void assert_crop(const struct crop *a, const struct crop *b, double off)
{
    double worst =
        fmax(fmax(fabs(a->x - b->x), fabs(a->y - b->y)), fmax(fabs(a->width - b->width), fabs(a->height - b->height)));
    if (!(worst <= off))
        fail_msg("%g %g %g %g in place of %g %g %g %g", a->x, a->y, a->width, a->height, b->x, b->y, b->width,
                 b->height);
}

static void an_exact_crop_is_found(void **state)
{
    static const struct crop crops[] = {
        {100, 50, 480, 300}, {0, 0, 640, 400}, {333.3, 222.2, 32, 20}, {0, 0, 800, 500}, {10, 20, 400, 260}};
    (void)state;
    for (size_t i = 0; i < sizeof crops / sizeof *crops; i++) {
        struct crop_pair pairs[POINTS];
        struct crop_task task;
        struct crop_result r;
        struct err err = ERR_INIT;
        double misfit;
        make_task(&task, pairs, &crops[i]);
        task.step_x *= 1.7, task.step_y *= 1.7; /* only their ratio is given */
        assert_ok(crop_fit(&r, &task, &err), err);
        assert_crop(&r.crop, &crops[i], 1e-9);
        assert_true(r.beyond < 1e-9);
        assert_ok(crop_misfit(&misfit, &task, &r.crop, &err), err);
        assert_true(misfit < 1e-9);
    }
}

static void a_third_that_goes_elsewhere_moves_it_little(void **state)
{
    const struct crop crop = {100, 50, 480, 300};
    struct crop_pair pairs[POINTS];
    struct crop_task task;
    struct crop_result r;
    struct err err = ERR_INIT;
    double misfit;
    (void)state;
    make_task(&task, pairs, &crop);
    for (int i = 0; i < POINTS; i += 3) pairs[i].u += 80; /* a foreground: least squares alone would follow it by 27 */
    assert_ok(crop_fit(&r, &task, &err), err);
    assert_ok(crop_misfit(&misfit, &task, &r.crop, &err), err);
    assert_true(misfit < 2.5);
}

/* The loss that the header names, of a crop. */
static double loss(const struct crop_task *task, const struct crop *c)
{
    double sum = 0;
    for (size_t i = 0; i < task->count; i++) {
        double u, v;
        crop_apply(task, c, task->pairs[i].x, task->pairs[i].y, &u, &v);
        double off = hypot(u - task->pairs[i].u, v - task->pairs[i].v), t = task->tolerance;
        sum += off <= t ? off * off / 2 : t * (off - t / 2);
    }
    return sum;
}

static void at_the_border_it_is_the_best_of_those_within(void **state)
{
    static const struct crop wanted[] = {{-60, 100, 480, 300},
                                         {500, 450, 480, 300},
                                         {-100, -80, 1120, 700},
                                         {-5, 20, 810, 506.25},
                                         {300, -200, 320, 200}};
    (void)state;
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        struct crop_pair pairs[POINTS];
        struct crop_task task;
        struct crop_result r;
        struct err err = ERR_INIT;
        make_task(&task, pairs, &wanted[i]);
        for (int k = 0; k < POINTS; k++) pairs[k].u += 8 * random_part(1000 + (uint64_t)k);
        assert_ok(crop_fit(&r, &task, &err), err);
        const struct crop *c = &r.crop;
        assert_true(c->x >= 0 && c->y >= 0 && c->x + c->width <= PHOTO_W + 1e-9 && c->y + c->height <= PHOTO_H + 1e-9);
        assert_true(fabs(c->width / c->height - 1.6) < 1e-12);
        assert_true(r.beyond > 1);
        /* none on a fine grid of sizes and places within the photograph is better */
        const double least = loss(&task, c);
        for (int size = 1; size <= 160; size++)
            for (int x = 0; x <= 40; x++)
                for (int y = 0; y <= 40; y++) {
                    struct crop other = {0, 0, 5.0 * size, 3.125 * size};
                    other.x = (PHOTO_W - other.width) * x / 40;
                    other.y = (PHOTO_H - other.height) * y / 40;
                    if (loss(&task, &other) < least * (1 - 1e-9))
                        fail_msg("%zu: %g %g %g x %g is better: %g < %g", i, other.x, other.y, other.width,
                                 other.height, loss(&task, &other), least);
                }
    }
}

static void points_that_swap_places_still_give_a_crop(void **state)
{
    const struct crop crop = {100, 50, 480, 300};
    struct crop_pair pairs[POINTS];
    struct crop_task task;
    struct crop_result r;
    struct err err = ERR_INIT;
    (void)state;
    make_task(&task, pairs, &crop);
    for (int i = 0; i < POINTS; i++) pairs[i].u = W - pairs[i].u, pairs[i].v = H - pairs[i].v;
    assert_ok(crop_fit(&r, &task, &err), err);
    assert_true(isfinite(r.crop.x) && isfinite(r.crop.y) && r.crop.width > 0 && r.crop.x >= 0 && r.crop.y >= 0);
}

static void too_few_points_are_told(void **state)
{
    const struct crop crop = {100, 50, 480, 300};
    struct crop_pair pairs[POINTS];
    struct crop_task task;
    struct crop_result r;
    struct err err = ERR_INIT;
    (void)state;
    make_task(&task, pairs, &crop);
    task.count = 3;
    assert_int_equal(crop_fit(&r, &task, &err), ST_DATA);
    assert_err(err, ST_DATA, "3 points");
    task.count = POINTS;
    for (int i = 0; i < POINTS; i++) pairs[i] = pairs[0];
    err = (struct err)ERR_INIT;
    assert_int_equal(crop_fit(&r, &task, &err), ST_DATA);
    assert_err(err, ST_DATA, "all at one place");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_exact_crop_is_found),
        cmocka_unit_test(a_third_that_goes_elsewhere_moves_it_little),
        cmocka_unit_test(at_the_border_it_is_the_best_of_those_within),
        cmocka_unit_test(points_that_swap_places_still_give_a_crop),
        cmocka_unit_test(too_few_points_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
