/* indirect.c - irradiance at annotated points: nodes, interpolation along lines, files. */
#include "stages/fit_lights/indirect.h"

#include <math.h>

#include "tests/unit/scratch.h"

enum { POINTS = 43 };

static struct lit_point points[POINTS];
static const struct lit_scene scene = {.points = points, .point_count = POINTS};
static const struct model_axes axes = {.rotation = {0.6, 0, 0, 0.8}, .translation = {1, 2, 3}, .scale = 0.5};

/* Two points, and a line of 41 points. */
static int make_points(void **state)
{
    for (int i = 0; i < POINTS; i++)
        points[i] = (struct lit_point){.at = {i < 2 ? i : 0.05 * (i - 2), 1, 0},
                                       .normal = {0, 0, 1},
                                       .kind = i < 2 ? NOTE_LIT : NOTE_LINE,
                                       .along = i < 2 ? 0 : (i - 2) / 40.0};
    return scratch_make(state);
}

static void lines_have_few_nodes_and_the_rest_is_interpolated(void **state)
{
    (void)state;
    struct indirect in;
    struct err err = ERR_INIT;
    assert_ok(indirect_init(&in, &scene, &err), err);
    assert_int_equal(in.count, 5);
    for (int k = 0; k < 5; k++) indirect_set(&in, k, rgb_make(k, 10 * k, k * k));
    indirect_spread(&in, &scene);
    assert_true(in.at[1][1] == 10 && in.at[2][0] == 2 && in.at[42][0] == 4);
    assert_true(fabs(in.at[12][0] - 2.5) < 1e-12 && fabs(in.at[37][1] - 37.5) < 1e-12);
    indirect_release(&in);
    assert_null(in.nodes);
}

static void what_is_listed_is_read_back(void **state)
{
    (void)state;
    struct indirect in;
    struct err err = ERR_INIT;
    char line[400], *text = calloc(1, 4000);
    assert_non_null(text);
    assert_ok(indirect_init(&in, &scene, &err), err);
    assert_ok(indirect_list(&in, &scene, &axes, scratch_path("points.txt"), NULL, &err), err);
    FILE *f = fopen(scratch_path("points.txt"), "r");
    assert_non_null(f);
    for (int k = 0; fgets(line, sizeof line, f); k++) {
        line[strcspn(line, "\n")] = '\0';
        sprintf(text + strlen(text), "%s %d 1 2\n", line, k);
    }
    fclose(f);
    assert_ok(indirect_read(&in, &scene, &axes, scratch_write("given.txt", text), NULL, &err), err);
    assert_true(in.at[1][0] == 1 && in.at[22][0] == 3 && fabs(in.at[32][0] - 3.5) < 1e-12 && in.at[30][2] == 2);
    indirect_release(&in);
    free(text);
}

static void assert_refused(const char *text, const char *why)
{
    const struct model_axes same = {.rotation = {1, 0, 0, 0}, .scale = 1};
    struct indirect in;
    struct err err = ERR_INIT;
    const char *path = scratch_write("bad.txt", text);
    assert_ok(indirect_init(&in, &scene, &err), err);
    assert_int_equal(indirect_read(&in, &scene, &same, path, NULL, &err), ST_DATA);
    assert_non_null(strstr(err.text, path));
    if (!strstr(err.text, why)) fail_msg("the error says: %s", err.text);
    indirect_release(&in);
}

static void other_points_are_refused(void **state)
{
    (void)state;
    assert_refused("0 1 0 0 0 1 1 1 1\n", "5 points");
    assert_refused("0 1.1 0 0 0 1 1 1 1\n", "list the points again");
    assert_refused("0 1 0 0 0 1 1 -1 1\n", "green irradiance, a number from 0");
    assert_refused("0 1 0 0 0 1 1 1\n", "blue");
    assert_refused("0 1 0 0 0 1 1 1 1 1\n", "end of the line");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_have_few_nodes_and_the_rest_is_interpolated),
        cmocka_unit_test(what_is_listed_is_read_back),
        cmocka_unit_test(other_points_are_refused),
    };
    return cmocka_run_group_tests(tests, make_points, scratch_remove);
}
