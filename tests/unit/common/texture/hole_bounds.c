/* hole_bounds.c - where a filled hole leaves the colours around it, on walls whose every texel is known. */
#include "common/texture/hole_bounds.h"

#include <string.h>

#include "tests/unit/scratch.h"

/* The left half of a wall is seen, and the right half was filled. */
enum { WIDTH = 64, HEIGHT = 32, TEXELS = WIDTH * HEIGHT, SEEN = 32, REACH = 8 };
#define WALL 0.5f

struct wall {
    float value[TEXELS * 3], limit[TEXELS * 3];
    uint8_t unseen[TEXELS], clean[TEXELS], beyond[TEXELS];
    int32_t nearest[TEXELS];
};

static void set(struct wall *w, int x, int y, float colour)
{
    for (int k = 0; k < 3; k++) w->value[3 * (y * WIDTH + x) + k] = colour;
}

static void make_wall(struct wall *w)
{
    memset(w, 0, sizeof *w);
    for (int i = 0; i < TEXELS; i++) {
        const int x = i % WIDTH, y = i / WIDTH;
        set(w, x, y, WALL);
        w->unseen[i] = x >= SEEN;
        w->clean[i] = x < SEEN;
        w->nearest[i] = x < SEEN ? i : y * WIDTH + SEEN - 1;
    }
}

static bool find(struct wall *w)
{
    const struct synthesis_picture picture = {WIDTH, HEIGHT, w->value, w->unseen, w->clean};
    struct err err = ERR_INIT;
    bool any;
    memset(w->beyond, 7, TEXELS);
    assert_ok(hole_bounds_find(w->limit, w->beyond, &any, &picture, w->nearest, REACH, &err), err);
    return any;
}

static void what_is_like_the_wall_stays(void **state)
{
    static struct wall w;
    (void)state;
    make_wall(&w);
    assert_false(find(&w));
    for (int i = 0; i < TEXELS; i++) assert_int_equal(w.beyond[i], 0);
}

/* A slope that adds up to black: what is more than 0.03 darker than the wall, a bin and what is spared, lies beyond. */
static void a_slope_to_black_ends_at_the_wall(void **state)
{
    static struct wall w;
    (void)state;
    make_wall(&w);
    for (int i = 0; i < TEXELS; i++)
        if (i % WIDTH >= SEEN) set(&w, i % WIDTH, i / WIDTH, WALL - 0.015f * (float)(i % WIDTH - SEEN));
    assert_true(find(&w));
    for (int i = 0; i < TEXELS; i++) {
        const int x = i % WIDTH;
        if (x < SEEN + 2) assert_int_equal(w.beyond[i], 0);
        if (x > SEEN + 2) assert_int_equal(w.beyond[i], 1);
        for (int k = 0; x > SEEN + 2 && k < 3; k++) assert_float_equal(w.limit[3 * i + k], WALL - 0.02, 0.01);
    }
}

/* Boards of both shades are at hand, so a fill of both is right. */
static void colours_that_are_around_the_hole_stay(void **state)
{
    static struct wall w;
    (void)state;
    make_wall(&w);
    for (int i = 0; i < TEXELS; i++) set(&w, i % WIDTH, i / WIDTH, i % WIDTH / 4 % 2 ? 0.3f : 0.6f);
    assert_false(find(&w));
}

/* A black spot of 2 texels of 17 x 9 or more around is rare: no hole beside it is bound to become black. */
static void a_rare_colour_is_no_bound(void **state)
{
    static struct wall w;
    (void)state;
    make_wall(&w);
    set(&w, SEEN - 2, 16, 0), set(&w, SEEN - 1, 16, 0);
    set(&w, SEEN + 4, 16, 0);
    assert_true(find(&w));
    for (int i = 0; i < TEXELS; i++) assert_int_equal(w.beyond[i], i == 16 * WIDTH + SEEN + 4);
}

static void without_a_clean_place_nothing_is_bound(void **state)
{
    static struct wall w;
    (void)state;
    make_wall(&w);
    for (int i = 0; i < TEXELS; i++) {
        w.clean[i] = 0, w.nearest[i] = -1;
        if (i % WIDTH >= SEEN) set(&w, i % WIDTH, i / WIDTH, -3);
    }
    assert_false(find(&w));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_like_the_wall_stays),
        cmocka_unit_test(a_slope_to_black_ends_at_the_wall),
        cmocka_unit_test(colours_that_are_around_the_hole_stay),
        cmocka_unit_test(a_rare_colour_is_no_bound),
        cmocka_unit_test(without_a_clean_place_nothing_is_bound),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
