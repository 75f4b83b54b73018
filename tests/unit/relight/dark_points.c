/* Quotients of furniture whose point lies in the dark come from beside it. */
#include "stages/relight/dark_points.h"
#include "stages/relight/quotients.h"
#include "tests/unit/scratch.h"

enum { WIDTH = 12, HEIGHT = 9, PIXELS = WIDTH * HEIGHT };

struct dark {
    float quotient[PIXELS][4];
    struct irradiance before[PIXELS], after[PIXELS];
    uint8_t kind[PIXELS];
    struct pixels p;
};

/* A wall whose light falls to `q`, and furniture before its middle, of 4 x 3 pixels. */
static void make(struct dark *d, float q)
{
    *d = (struct dark){.p = {.width = WIDTH, .height = HEIGHT}};
    d->p.kind = d->kind;
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % WIDTH, y = i / WIDTH;
        d->kind[i] = x >= 4 && x < 8 && y >= 3 && y < 6 ? PIXEL_CLUTTER : PIXEL_TEXTURE;
        for (int k = 0; k < 3; k++) d->quotient[i][k] = q;
        d->quotient[i][3] = RELIT_SURE;
        d->before[i].value = rgb_grey(2);
        d->after[i].value = rgb_grey(2 * (double)q);
    }
}

static bool is_furniture(const struct dark *d, int i) { return d->kind[i] == PIXEL_CLUTTER; }

static void fill(struct dark *d)
{
    struct err err = ERR_INIT;
    assert_ok(dark_points_fill(d->quotient, d->before, d->after, &d->p, false, &err), err);
}

/* Without light before and after, the quotient is 1: a bright spot where all else becomes darker. */
static void furniture_behind_a_wall_takes_the_quotient_beside_it(void **state)
{
    static struct dark d;
    (void)state;
    make(&d, 0.25f);
    for (int i = 0; i < PIXELS; i++) {
        if (!is_furniture(&d, i)) continue;
        for (int k = 0; k < 3; k++) d.quotient[i][k] = 1;
        d.before[i].value = d.after[i].value = rgb_grey(0);
    }
    fill(&d);
    for (int i = 0; i < PIXELS; i++)
        for (int k = 0; k < 4; k++)
            assert_true(d.quotient[i][k] == (k < 3 ? 0.25f : is_furniture(&d, i) ? RELIT_BOUNDED : RELIT_SURE));
}

/* In a wall that the edit adds, there is no light after it: a black spot. */
static void furniture_in_a_new_wall_takes_the_quotient_beside_it(void **state)
{
    static struct dark d;
    (void)state;
    make(&d, 0.5f);
    for (int i = 0; i < PIXELS; i++) {
        if (!is_furniture(&d, i) || i % WIDTH >= 6) continue;
        for (int k = 0; k < 3; k++) d.quotient[i][k] = 0;
        d.after[i].value = rgb_grey(0);
    }
    fill(&d);
    for (int i = 0; i < PIXELS; i++) assert_true(d.quotient[i][0] == 0.5f);
}

static void furniture_in_the_light_and_walls_in_the_dark_keep_their_quotients(void **state)
{
    static struct dark d;
    (void)state;
    make(&d, 0.5f);
    for (int i = 0; i < PIXELS; i++)
        if (is_furniture(&d, i)) d.quotient[i][0] = 0.75f;
    d.quotient[0][0] = 1;
    d.before[0].value = d.after[0].value = rgb_grey(0);
    fill(&d);
    for (int i = 1; i < PIXELS; i++) assert_true(d.quotient[i][0] == (is_furniture(&d, i) ? 0.75f : 0.5f));
    assert_true(d.quotient[0][0] == 1 && d.quotient[0][3] == RELIT_SURE);
}

static void where_all_lights_go_out_furniture_becomes_black(void **state)
{
    static struct dark d;
    (void)state;
    make(&d, 0);
    for (int i = 0; i < PIXELS; i++)
        if (is_furniture(&d, i)) d.before[i].value = rgb_grey(0), d.quotient[i][0] = 1;
    fill(&d);
    for (int i = 0; i < PIXELS; i++) assert_true(d.quotient[i][0] == 0);
}

static void where_no_pixel_has_a_quotient_all_stay(void **state)
{
    static struct dark d;
    (void)state;
    make(&d, 1);
    for (int i = 0; i < PIXELS; i++) {
        d.kind[i] = PIXEL_CLUTTER;
        d.before[i].value = d.after[i].value = rgb_grey(0);
    }
    fill(&d);
    for (int i = 0; i < PIXELS; i++) assert_true(d.quotient[i][0] == 1 && d.quotient[i][3] == RELIT_SURE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(furniture_behind_a_wall_takes_the_quotient_beside_it),
        cmocka_unit_test(furniture_in_a_new_wall_takes_the_quotient_beside_it),
        cmocka_unit_test(furniture_in_the_light_and_walls_in_the_dark_keep_their_quotients),
        cmocka_unit_test(where_all_lights_go_out_furniture_becomes_black),
        cmocka_unit_test(where_no_pixel_has_a_quotient_all_stay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
