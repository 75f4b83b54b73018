/* depth_estimate.c - the estimate of time and memory: sums over views and rounds, cores, and monotonicity. */
#include "stages/segment_depth/depth_estimate.h"
#include "tests/unit/scratch.h"
#include "tests/unit/segment_depth/scene.h"

#include "common/base/parallel.h"

static struct scene scene;
static const struct segment_params params = SEGMENT_PARAMS_DEFAULT;

/* Three views of a wall; the last one is wider. */
static void place_cameras(void)
{
    memset(&scene, 0, sizeof scene);
    scene_wall(&scene, 0, 0, 5, 9, 9, 0);
    scene_view(&scene, 1000, 500, 1000, 0, 0, 0, 0);
    scene_view(&scene, 1000, 500, 1000, 0.4, 0, 0, 0);
    scene_view(&scene, 2000, 500, 1000, -0.4, 0, 0, 0);
}

/* The text printed for a list; the caller frees it. */
static char *printed_estimate(const char *list, int jobs, enum status wanted, struct err *err)
{
    char *text = NULL;
    size_t size;
    FILE *to = open_memstream(&text, &size);
    assert_non_null(to);
    assert_int_equal(estimate_print(to, scratch_write("list", list), &scene.set, jobs, &params, err), wanted);
    fclose(to);
    return text;
}

static void more_pixels_neighbours_and_passes_take_more(void **state)
{
    (void)state;
    const struct depth_work one = depth_work(1e6, 4, true, &params);
    struct segment_params other = params;
    assert_near(depth_work(2e6, 4, true, &params).core_seconds, 2 * one.core_seconds, 1e-9);
    assert_true(depth_work(2e6, 4, true, &params).mib > one.mib);
    assert_true(depth_work(1e6, 8, true, &params).core_seconds > 1.1 * one.core_seconds);
    other.best_neighbours = 8;
    assert_true(depth_work(1e6, 8, true, &other).core_seconds > 1.5 * one.core_seconds);
    other = params;
    assert_true(depth_work(1e6, 8, true, &params).mib > one.mib);
    other.passes = 0;
    assert_true(depth_work(1e6, 4, true, &other).core_seconds < 0.3 * one.core_seconds);
    other = params;
    other.segment_pixels = 256;
    assert_true(depth_work(1e6, 4, true, &other).core_seconds < 0.8 * one.core_seconds);
}

static void a_first_round_in_half_the_size_takes_less(void **state)
{
    (void)state;
    struct segment_params half = params;
    half.half_from = 0.5;
    half.half_pixels = 64;
    const double full = depth_work(1e6, 8, true, &params).core_seconds;
    assert_true(depth_work(1e6, 8, true, &half).core_seconds < 0.5 * full);
    assert_true(depth_work(1e6, 8, true, &half).core_seconds > 0.2 * full);
    /* not of views below the size, nor in later rounds */
    assert_near(depth_work(0.4e6, 8, true, &half).core_seconds, 0.4 * full, 1e-9);
    assert_near(depth_work(1e6, 8, false, &half).core_seconds, depth_work(1e6, 8, false, &params).core_seconds, 1e-9);
}

/* The last line is the sum over views of these sizes, each matched with two neighbours, in the first round or a later
 * one. */
static void assert_line_of_work(const char *text, const double pixels[], const bool first[], int count)
{
    double seconds = 0, mib = 0, bytes = 0, longest = 0, got[4];
    int items;
    for (int i = 0; i < count; i++) {
        const struct depth_work one = depth_work(pixels[i], 2, first[i], &params);
        seconds += one.core_seconds;
        bytes += one.bytes;
        mib = fmax(mib, one.mib);
        longest = fmax(longest, one.core_seconds);
    }
    const char *line = strstr(text, "\nestimate ");
    assert_non_null(line);
    assert_int_equal(sscanf(line, "\nestimate %d %lf %lf %lf %lf\n", &items, got, got + 1, got + 2, got + 3), 5);
    assert_int_equal(items, count);
    assert_near(got[0], seconds, 2e-3);
    assert_near(got[1], mib, 1);
    assert_near(got[2], bytes, 1);
    assert_near(got[3], longest, 2e-3);
}

static void the_work_of_a_list_is_summed_and_divided_among_cores(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    place_cameras();
    parallel_set_threads(1);
    char *text = printed_estimate("# of two rounds\na 0\nb 0\na 1\n", 2, ST_OK, &err);
    assert_non_null(strstr(text, "depth: 2 views of 1000 x 500, 2 neighbours, 2 rounds: about "));
    assert_non_null(strstr(text, " s on 2 cores, "));
    assert_non_null(strstr(text, " MiB at a time\n"));
    assert_line_of_work(text, (const double[3]){0.5e6, 0.5e6, 0.5e6}, (const bool[3]){true, true, false}, 3);
    free(text);
    text = printed_estimate("a 0\nc 0\n", 1, ST_OK, &err);
    assert_non_null(strstr(text, "depth: 2 views of up to 2000 x 500, 2 neighbours, 1 round: about "));
    assert_non_null(strstr(text, " on 1 core, "));
    assert_line_of_work(text, (const double[2]){0.5e6, 1e6}, (const bool[2]){true, true}, 2);
    free(text);
    text = printed_estimate("c 3\n", 0, ST_OK, &err);
    assert_non_null(strstr(text, "depth: 1 view of 2000 x 500, 2 neighbours, 1 round: about "));
    assert_non_null(strstr(text, "of one core in all, up to "));
    free(text);
}

static void an_empty_list_prints_nothing(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    place_cameras();
    char *text = printed_estimate("", 2, ST_OK, &err);
    assert_string_equal(text, "");
    free(text);
}

static void a_faulty_list_is_an_error(void **state)
{
    static const char *const lists[][2] = {{"a\n", "list:1"},
                                           {"a 0\nz 0\n", "list:2: found \"z\", wanted a view of the scene"},
                                           {"a 12\n", "round"},
                                           {"a 0 0\n", "list:1"}};
    (void)state;
    place_cameras();
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        struct err err = ERR_INIT;
        free(printed_estimate(lists[i][0], 1, ST_DATA, &err));
        assert_contains(err.text, lists[i][1]);
    }
}

/* More memory than any machine has is a warning that says what to change, not an error. */
static void too_little_memory_is_a_warning(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    place_cameras();
    scene.views[0].width = scene.views[0].height = 1 << 20;
    char *text = printed_estimate("a 0\n", 1, ST_OK, &err);
    assert_non_null(strstr(text, "\ndepth: warning: this machine has "));
    assert_non_null(strstr(text, "[sfm_import] max_megapixels"));
    free(text);
}

/* Two sizes: each of three views has two neighbours at most, so that low and high differ by the later round alone. */
static void what_is_foreseen_is_the_sum_of_all_views(void **state)
{
    struct segment_params few = SEGMENT_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    double low = 0, high = 0, mib = 0, bytes = 0, wanted[2] = {0};
    const double pixels[3] = {1e6, 1e6, 2e6};
    char text[200] = "";
    (void)state;
    FILE *fp = fmemopen(text, sizeof text, "w");
    assert_non_null(fp);
    assert_ok(estimate_foresee(fp, scratch_write("sizes", "1000 1000\n1000 1000\n2000 1000\n"), &few, &err), err);
    fclose(fp);
    assert_int_equal(sscanf(text, "foresee %lf %lf %lf %lf\n", &low, &high, &mib, &bytes), 4);
    for (int i = 0; i < 3; i++)
        for (int round = 0; round <= few.rounds; round++) {
            const double seconds = depth_work(pixels[i], 2, !round, &few).core_seconds;
            wanted[0] += round ? 0 : seconds;
            wanted[1] += seconds;
        }
    assert_true(fabs(low - wanted[0]) <= 0.5 && fabs(high - wanted[1]) <= 0.5 && low < high);
    assert_true(fabs(mib - depth_work(2e6, 2, true, &few).mib) <= 1);
    assert_true(fabs(bytes - 16.0 * 4e6 * (1 + few.rounds)) <= 1);
    assert_int_equal(estimate_foresee(stdout, scratch_write("sizes", "1000\n"), &few, &err), ST_DATA);
    assert_contains(err.text, "sizes:1");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(more_pixels_neighbours_and_passes_take_more),
        cmocka_unit_test(a_first_round_in_half_the_size_takes_less),
        cmocka_unit_test(the_work_of_a_list_is_summed_and_divided_among_cores),
        cmocka_unit_test(an_empty_list_prints_nothing),
        cmocka_unit_test(a_faulty_list_is_an_error),
        cmocka_unit_test(too_little_memory_is_a_warning),
        cmocka_unit_test(what_is_foreseen_is_the_sum_of_all_views),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
