/* depth_rounds.c - how much a view's depth changed, the record of it, and which views a round carries over. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "stages/segment_depth/depth_rounds.h"

enum { W = 40, H = 10 };

/* The left `left` columns are segment 1, the others segment 2; depths z[0] and z[1], constant. */
static struct layered_depth two_halves(int left, const double z[2])
{
    struct layered_depth d;
    struct err err = ERR_INIT;
    assert_ok(layered_depth_init(&d, W, H, &err), err);
    d.segments = calloc(3, sizeof *d.segments);
    assert_non_null(d.segments);
    d.segment_count = 2;
    for (uint32_t k = 0; k < 2; k++)
        d.segments[k] = (struct depth_segment){.id = k + 1, .plane = {0, 0, 1 / z[k]}, .sigma = 0.01, .confidence = 1};
    for (int i = 0; i < W * H; i++) d.interior.id[i] = i % W < left ? 1 : 2;
    return d;
}

static double change_of(const double now[2], const double before[2])
{
    struct layered_depth a = two_halves(10, now), b = two_halves(10, before);
    const double changed = round_change(&a, &b);
    layered_depth_release(&a);
    layered_depth_release(&b);
    return changed;
}

static void the_change_is_the_share_of_pixels_whose_depth_moved_by_over_one_percent(void **state)
{
    static const double five[2] = {5, 5};
    (void)state;
    assert_true(fabs(change_of(five, five)) <= 0);
    assert_true(fabs(change_of((double[2]){5.2, 5}, five) - 0.25) < 1e-12);
    assert_true(fabs(change_of((double[2]){5, 4.9}, five) - 0.75) < 1e-12);
    assert_true(fabs(change_of((double[2]){4, 6}, five) - 1) < 1e-12);
    assert_true(fabs(change_of((double[2]){5.049, 4.951}, five)) <= 0);
    assert_true(fabs(change_of((double[2]){5.051, 4.949}, five) - 1) < 1e-12);
}

/* A plane that tips about its middle column moves most at the sides: |a (u - 20)| / (1 / 5) > 1 % beyond 2 pixels. */
static void a_plane_that_tips_changes_where_it_moved(void **state)
{
    static const double five[2] = {5, 5};
    struct layered_depth a = two_halves(W, five), b = two_halves(W, five);
    (void)state;
    a.segments[0].plane[0] = 0.001;
    a.segments[0].plane[2] = 0.2 - 0.001 * 20;
    assert_true(fabs(round_change(&a, &b) - 36.0 / 40) < 1e-12);
    layered_depth_release(&a);
    layered_depth_release(&b);
}

static void pixels_without_depth_do_not_count(void **state)
{
    static const double five[2] = {5, 5}, six[2] = {6, 5};
    struct layered_depth a = two_halves(10, six), b = two_halves(10, five);
    (void)state;
    for (int i = 0; i < W * H; i++)
        if (i % W >= 20) a.interior.id[i] = 0;
    assert_true(fabs(round_change(&a, &b) - 0.5) < 1e-12);
    memset(a.interior.id, 0, W * H * sizeof *a.interior.id);
    assert_true(fabs(round_change(&a, &b)) <= 0);
    layered_depth_release(&a);
    layered_depth_release(&b);
}

static void a_record_round_trips(void **state)
{
    static const struct round_record records[] = {{1, true}, {0, false}, {0.03125, true}, {0, true}};
    (void)state;
    for (size_t i = 0; i < sizeof records / sizeof *records; i++) {
        struct provenance prov = {.stage = "segment_depth", .version = "1.2.3"};
        struct round_record back;
        struct err err = ERR_INIT;
        const char *path = scratch_path("made/v.round");
        assert_ok(round_record_write(&records[i], path, i % 2 ? &prov : NULL, &err), err);
        assert_ok(round_record_read(&back, path, NULL, &err), err);
        assert_true(fabs(back.changed - records[i].changed) <= 0 && back.estimated == records[i].estimated);
    }
    char *text = scratch_read(scratch_path("made/v.round"));
    assert_string_equal(text, "# remodel segment_depth 1.2.3\nremodel-round 1\nchanged 0\nestimated yes\n");
    free(text);
}

#define HEAD "remodel-round 1\n"

static void errors_of_a_record_name_the_line(void **state)
{
    static const struct {
        const char *text, *words;
    } bad[] = {
        {"", "v.round: found an empty file, wanted a line \"remodel-round ...\""},
        {"remodel-segments 1\n", "v.round:1: found \"remodel-segments\", wanted"},
        {"remodel-round 2\n", "v.round:1: found \"2\", wanted the version"},
        {HEAD, "v.round:1: found the end of the file, wanted a line \"changed ...\""},
        {HEAD "changed\n", "v.round:2: found the end of the line, wanted share of pixels"},
        {HEAD "changed nan\n", "v.round:2: found \"nan\", wanted share of pixels"},
        {HEAD "changed 1.5\n", "v.round:2: found \"1.5\", wanted share of pixels, a number from 0 to 1"},
        {HEAD "changed -0.5\n", "v.round:2: found \"-0.5\", wanted share of pixels, a number from 0 to 1"},
        {HEAD "changed 0 0\n", "v.round:2: found \"0\", wanted the end of the line"},
        {HEAD "changed 0\n", "v.round:2: found the end of the file, wanted a line \"estimated ...\""},
        {HEAD "changed 0\nestimated maybe\n", "v.round:3: found \"maybe\", wanted yes or no"},
        {HEAD "changed 0\nestimated no\nmore\n", "v.round:4: found \"more\", wanted the end of the file"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct round_record r = {0.5, true};
        struct err err = ERR_INIT;
        assert_int_equal(round_record_read(&r, scratch_write("v.round", bad[i].text), NULL, &err), ST_DATA);
        assert_err(err, ST_DATA, bad[i].words);
        assert_true(!r.estimated && fabs(r.changed) <= 0);
    }
    struct round_record r;
    struct err err = ERR_INIT;
    assert_int_equal(round_record_read(&r, scratch_path("none.round"), NULL, &err), ST_IO);
    assert_err(err, ST_IO, "none.round");
}

/* Records of three views that changed by this much. */
static void write_records(const double changed[3], struct view views[3])
{
    for (int i = 0; i < 3; i++) {
        const struct round_record r = {changed[i], true};
        struct err err = ERR_INIT;
        char name[32];
        views[i] = (struct view){.name = (const char *[]){"a", "b", "c"}[i]};
        snprintf(name, sizeof name, "depth/round0/%s.round", views[i].name);
        assert_ok(round_record_write(&r, scratch_path(name), NULL, &err), err);
    }
}

static bool is_settled(const double changed[3], const int *views, int count, double min_change)
{
    struct view of[3];
    struct camera_set set = {.views = of, .view_count = 3};
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    bool settled;
    write_records(changed, of);
    assert_ok(round_is_settled(&settled, scratch_path("depth/round0"), &set, views, count, min_change, &prov, &err),
              err);
    assert_int_equal(prov.count, count);
    assert_int_equal(strncmp(prov.inputs[0].name, "depth/", 6), 0);
    provenance_release(&prov);
    return settled;
}

static void a_view_is_settled_when_it_and_its_neighbours_mean_changed_less_than_the_minimum(void **state)
{
    static const int all[] = {1, 0, 2}, two[] = {1, 2};
    (void)state;
    assert_true(is_settled((double[3]){0.01, 0.02, 0.04}, all, 3, 0.05));
    assert_false(is_settled((double[3]){0.01, 0.06, 0.04}, all, 3, 0.05)); /* itself */
    assert_true(is_settled((double[3]){0.01, 0.02, 0.08}, all, 3, 0.05));  /* the neighbours' mean is 0.045 */
    assert_false(is_settled((double[3]){0.01, 0.02, 0.1}, all, 3, 0.05));
    assert_false(is_settled((double[3]){0.125, 0.02, 0.125}, all, 3, 0.125)); /* by just as much */
    assert_true(is_settled((double[3]){0.9, 0.02, 0.04}, two, 2, 0.05));      /* a view that is no neighbour */
    assert_true(is_settled((double[3]){0.9, 0.02, 0.9}, two, 1, 0.05));       /* no neighbour */
    assert_false(is_settled((double[3]){0, 0, 0}, all, 3, 0));
    assert_false(is_settled((double[3]){1, 1, 1}, all, 3, 1)); /* the first round */
}

static void a_lost_record_is_an_error(void **state)
{
    struct view of[3];
    struct camera_set set = {.views = of, .view_count = 3};
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    bool settled;
    (void)state;
    write_records((double[3]){0, 0, 0}, of);
    remove(scratch_path("depth/round0/b.round"));
    assert_int_equal(
        round_is_settled(&settled, scratch_path("depth/round0"), &set, (int[]){0, 1}, 2, 0.05, &prov, &err), ST_IO);
    assert_err(err, ST_IO, "depth/round0/b.round");
    provenance_release(&prov);
}

static void assert_same_bytes(const char *a, const char *b)
{
    static char bytes[2][1 << 20];
    size_t size[2];
    for (int k = 0; k < 2; k++) {
        FILE *fp = fopen(scratch_path(k ? b : a), "rb");
        assert_non_null(fp);
        size[k] = fread(bytes[k], 1, sizeof *bytes, fp);
        fclose(fp);
    }
    assert_true(size[0] > 0 && size[0] < sizeof *bytes);
    assert_int_equal(size[0], size[1]);
    assert_memory_equal(bytes[0], bytes[1], size[0]);
}

static void depth_that_is_carried_over_keeps_every_byte(void **state)
{
    static const double z[2] = {3, 4};
    struct layered_depth d = two_halves(10, z), back;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(layered_depth_write(&d, NULL, scratch_path("before/v.exr"), NULL, &err), err);
    assert_ok(round_carry_over(scratch_path("before"), "v", scratch_path("after/v.exr"), &err), err);
    assert_same_bytes("before/v.exr", "after/v.exr");
    assert_same_bytes("before/v.txt", "after/v.txt");
    assert_ok(layered_depth_read(&back, scratch_path("after/v.exr"), NULL, &err), err);
    layered_depth_release(&back);
    layered_depth_release(&d);

    err = (struct err)ERR_INIT;
    assert_int_equal(round_carry_over(scratch_path("before"), "none", scratch_path("after/none.exr"), &err), ST_IO);
    assert_err(err, ST_IO, "before/none.txt");
    err = (struct err)ERR_INIT;
    assert_int_equal(round_carry_over(scratch_path("before"), "v", scratch_path("after/v.png"), &err), ST_USAGE);
    assert_err(err, ST_USAGE, "must end in .exr");
    /* no half-made product: the EXR comes last */
    remove(scratch_path("before/v.exr"));
    err = (struct err)ERR_INIT;
    assert_int_equal(round_carry_over(scratch_path("before"), "v", scratch_path("later/v.exr"), &err), ST_IO);
    assert_err(err, ST_IO, "before/v.exr");
    assert_int_equal(access(scratch_path("later/v.exr"), F_OK), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_change_is_the_share_of_pixels_whose_depth_moved_by_over_one_percent),
        cmocka_unit_test(a_plane_that_tips_changes_where_it_moved),
        cmocka_unit_test(pixels_without_depth_do_not_count),
        cmocka_unit_test(a_record_round_trips),
        cmocka_unit_test(errors_of_a_record_name_the_line),
        cmocka_unit_test(a_view_is_settled_when_it_and_its_neighbours_mean_changed_less_than_the_minimum),
        cmocka_unit_test(a_lost_record_is_an_error),
        cmocka_unit_test(depth_that_is_carried_over_keeps_every_byte),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
