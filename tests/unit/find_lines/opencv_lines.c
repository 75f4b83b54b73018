/* opencv_lines.c - straight edges of drawn pictures. */
#include "stages/find_lines/opencv_lines.h"

#include <math.h>

#include "common/base/rng.h"
#include "tests/unit/scratch.h"

enum { W = 240, H = 200 };

/* Grey on one side of the line u + v / 4 = 130, brighter by `step` on the other, with noise. */
static void draw(unsigned char *grey, int step, double noise)
{
    const struct rng rng = rng_make(4, "test", "lines");
    for (int i = 0; i < W * H; i++) {
        const double beyond = i % W + 0.5 + (i / W + 0.5) / 4 - 130, part = fmin(fmax(beyond + 0.5, 0), 1),
                     off = noise * (2 * rng_uniform(&rng, (uint64_t)i, 0) - 1);
        grey[i] = (unsigned char)lrint(120 + step * part + off);
    }
}

static int count_on_edge(const struct picture_line *lines, int count)
{
    int on = 0;
    for (int i = 0; i < count; i++)
        on += fabs(lines[i].u0 + lines[i].v0 / 4 - 130) < 1.5 && fabs(lines[i].u1 + lines[i].v1 / 4 - 130) < 1.5;
    return on;
}

static void an_edge_is_found_where_it_is_however_faint(void **state)
{
    (void)state;
    static unsigned char grey[W * H];
    for (int step = 6; step <= 96; step *= 4) {
        struct picture_line *lines;
        struct err err = ERR_INIT;
        int count;
        double longest = 0;
        draw(grey, step, 0.5);
        assert_ok(lines_detect(&lines, &count, grey, W, H, 20, 4, &err), err);
        assert_true(count_on_edge(lines, count) >= 1);
        for (int i = 0; i < count; i++) longest = fmax(longest, fabs(lines[i].v1 - lines[i].v0));
        assert_true(longest > 100);
        free(lines);
    }
}

static void a_blank_picture_has_no_edges(void **state)
{
    (void)state;
    static unsigned char grey[W * H];
    struct picture_line *lines;
    struct err err = ERR_INIT;
    int count;
    draw(grey, 0, 0);
    assert_ok(lines_detect(&lines, &count, grey, W, H, 20, 4, &err), err);
    assert_int_equal(count, 0);
    free(lines);
    assert_ok(lines_detect(&lines, &count, grey, 1, 1, 20, 4, &err), err);
    assert_int_equal(count, 0);
    free(lines);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_edge_is_found_where_it_is_however_faint),
        cmocka_unit_test(a_blank_picture_has_no_edges),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
