/* crop_fit.c - tests that an exact crop is recovered, and the best one within the photograph otherwise. */
#include "stages/pan_scan/crop_fit.h"

#include "tests/unit/scratch.h"

#include <math.h>

#include "common/base/rng.h"

enum { POINTS = 60, W = 320, H = 200, PHOTO_W = 800, PHOTO_H = 600 };

static double random_fraction(uint64_t index)
{
    const struct rng rng = rng_make(1, "test", "points");
    return rng_uniform(&rng, 0, index);
}

struct fixture {
    struct crop_pair pairs[POINTS];
    struct crop_task task;
    struct crop_result r;
};

/* Points all over the photograph, paired with their pixels in a frame that shows `crop`. */
static void make_task(struct fixture *f, const struct crop *crop)
{
    f->task = (struct crop_task){PHOTO_W, PHOTO_H, W, H, crop->width / W, crop->height / H, 3, f->pairs, POINTS};
    for (int i = 0; i < POINTS; i++) {
        struct crop_pair *p = &f->pairs[i];
        p->x = PHOTO_W * random_fraction(2 * (uint64_t)i), p->y = PHOTO_H * random_fraction(2 * (uint64_t)i + 1);
        crop_apply(&f->task, crop, p->x, p->y, &p->u, &p->v);
    }
}

static void fit(struct fixture *f)
{
    struct err err = ERR_INIT;
    assert_ok(crop_fit(&f->r, &f->task, &err), err);
}

static double misfit(const struct fixture *f)
{
    struct err err = ERR_INIT;
    double value;
    assert_ok(crop_misfit(&value, &f->task, &f->r.crop, &err), err);
    return value;
}

static void assert_refused(struct fixture *f, const char *words)
{
    struct err err = ERR_INIT;
    assert_int_equal(crop_fit(&f->r, &f->task, &err), ST_DATA);
    assert_err(err, ST_DATA, words);
}

static void assert_crop(const struct crop *a, const struct crop *b, double off)
{
    double worst =
        fmax(fmax(fabs(a->x - b->x), fabs(a->y - b->y)), fmax(fabs(a->width - b->width), fabs(a->height - b->height)));
    if (!(worst <= off))
        fail_msg("found %g %g %g %g, wanted %g %g %g %g", a->x, a->y, a->width, a->height, b->x, b->y, b->width,
                 b->height);
}

static void an_exact_crop_is_found(void **state)
{
    static const struct crop crops[] = {
        {100, 50, 480, 300}, {0, 0, 640, 400}, {333.3, 222.2, 32, 20}, {0, 0, 800, 500}, {10, 20, 400, 260}};
    (void)state;
    for (size_t i = 0; i < sizeof crops / sizeof *crops; i++) {
        struct fixture f;
        make_task(&f, &crops[i]);
        f.task.step_x *= 1.7, f.task.step_y *= 1.7; /* only their ratio matters */
        fit(&f);
        assert_crop(&f.r.crop, &crops[i], 1e-9);
        assert_true(f.r.beyond < 1e-9);
        assert_true(misfit(&f) < 1e-9);
    }
}

static void a_third_of_outliers_moves_the_crop_little(void **state)
{
    const struct crop crop = {100, 50, 480, 300};
    struct fixture f;
    (void)state;
    make_task(&f, &crop);
    for (int i = 0; i < POINTS; i += 3)
        f.pairs[i].u += 80; /* a foreground: plain least squares would follow it by 27 */
    fit(&f);
    assert_true(misfit(&f) < 2.5);
}

/* Huber's loss of a crop. */
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

static void a_crop_at_the_border_is_the_best_within_the_photograph(void **state)
{
    static const struct crop wanted[] = {{-60, 100, 480, 300},
                                         {500, 450, 480, 300},
                                         {-100, -80, 1120, 700},
                                         {-5, 20, 810, 506.25},
                                         {300, -200, 320, 200}};
    (void)state;
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        struct fixture f;
        make_task(&f, &wanted[i]);
        for (int k = 0; k < POINTS; k++) f.pairs[k].u += 8 * random_fraction(1000 + (uint64_t)k);
        fit(&f);
        const struct crop *c = &f.r.crop;
        assert_true(c->x >= 0 && c->y >= 0 && c->x + c->width <= PHOTO_W + 1e-9 && c->y + c->height <= PHOTO_H + 1e-9);
        assert_true(fabs(c->width / c->height - 1.6) < 1e-12);
        assert_true(f.r.beyond > 1);
        /* no crop on a fine grid of sizes and positions within the photograph is better */
        const double best = loss(&f.task, c);
        for (int size = 1; size <= 160; size++)
            for (int x = 0; x <= 40; x++)
                for (int y = 0; y <= 40; y++) {
                    struct crop other = {0, 0, 5.0 * size, 3.125 * size};
                    other.x = (PHOTO_W - other.width) * x / 40;
                    other.y = (PHOTO_H - other.height) * y / 40;
                    if (loss(&f.task, &other) < best * (1 - 1e-9))
                        fail_msg("%zu: %g %g %g x %g is better: %g < %g", i, other.x, other.y, other.width,
                                 other.height, loss(&f.task, &other), best);
                }
    }
}

static void mirrored_points_still_give_a_crop(void **state)
{
    const struct crop crop = {100, 50, 480, 300};
    struct fixture f;
    (void)state;
    make_task(&f, &crop);
    for (int i = 0; i < POINTS; i++) f.pairs[i].u = W - f.pairs[i].u, f.pairs[i].v = H - f.pairs[i].v;
    fit(&f);
    assert_true(isfinite(f.r.crop.x) && isfinite(f.r.crop.y) && f.r.crop.width > 0 && f.r.crop.x >= 0 &&
                f.r.crop.y >= 0);
}

static void too_few_points_are_an_error(void **state)
{
    const struct crop crop = {100, 50, 480, 300};
    struct fixture f;
    (void)state;
    make_task(&f, &crop);
    f.task.count = 3;
    assert_refused(&f, "3 points");
    f.task.count = POINTS;
    for (int i = 0; i < POINTS; i++) f.pairs[i] = f.pairs[0];
    assert_refused(&f, "all at the same position");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_exact_crop_is_found),
        cmocka_unit_test(a_third_of_outliers_moves_the_crop_little),
        cmocka_unit_test(a_crop_at_the_border_is_the_best_within_the_photograph),
        cmocka_unit_test(mirrored_points_still_give_a_crop),
        cmocka_unit_test(too_few_points_are_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
