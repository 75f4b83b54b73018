/* By how much the depth of views disagrees with a wall 2 in front of the camera. */
#include "stages/trace_ids/face_offsets.h"

#include "tests/unit/trace_ids/room.h"
#include "tests/unit/whole_room.h"

enum { W = 60, H = 40 };

/* What a view says of the wall when its depth is z, with a confidence. */
static struct seen_face seen_at(double z, double confidence)
{
    const struct trace_params params = TRACE_PARAMS_DEFAULT;
    const struct view v = view_at(vec3_make(0, 0, 0), 0, 0, W, H, 100);
    struct seen s = see(&model, &v, z);
    struct view_record r;
    struct err err = ERR_INIT;
    s.depth.segments[0].confidence = confidence;
    assert_ok(view_record_make(&r, &s.ids, &s.trace, &s.depth, &params, &err), err);
    assert_int_equal(r.count, 1);
    const struct seen_face f = r.faces[0];
    view_record_release(&r);
    see_release(&s);
    return f;
}

static void sure_depth_says_how_far_off_a_face_is(void **state)
{
    (void)state;
    assert_true(fabs(seen_at(2.03, 1).offset - 0.03) < 1e-4);
    assert_true(fabs(seen_at(1.98, 1).offset + 0.02) < 1e-4);
    assert_true(seen_at(2.03, 1).sure > W * H / 2);
}

static void furniture_and_unsure_depth_say_nothing(void **state)
{
    (void)state;
    assert_int_equal(seen_at(1.5, 1).sure, 0);
    assert_int_equal(seen_at(2.03, 0.3).sure, 0);
    assert_true(seen_at(1.5, 1).offset >= 0 && seen_at(1.5, 1).offset <= 0);
}

/* Adds what a view says of two faces. */
static void add(struct face_offsets *o, double first, double second)
{
    struct seen_face faces[] = {{1, 900, 0, 2, 1, 500, first}, {2, 900, 0, 2, 1, 500, second}, {3, 9, 0, 2, 1, 9, 1}};
    const struct view_record r = {faces, 3};
    struct err err = ERR_INIT;
    assert_ok(face_offsets_add(o, &r, &err), err);
}

static void the_median_of_views_is_written_largest_first(void **state)
{
    (void)state;
    const char *path = scratch_path("offsets.txt");
    struct face_offsets o = {0};
    struct err err = ERR_INIT;
    add(&o, 0.010, -0.05);
    add(&o, 0.012, -0.06);
    add(&o, 0.900, -0.04); /* one view errs */
    add(&o, 0.008, -0.05);
    add(&o, 0.009, -0.05);
    assert_ok(face_offsets_write(&o, &model, &same_frame, path, NULL, &err), err);
    face_offsets_release(&o);
    char line[200], name[100];
    int views, count = 0;
    double offset, spread, wanted[] = {-0.05, 0.010}, wanted_spread[] = {0, 0.002};
    FILE *f = fopen(path, "re");
    assert_non_null(f);
    while (fgets(line, sizeof line, f))
        if (sscanf(line, "face %99s %d %lf %lf", name, &views, &offset, &spread) == 4) {
            assert_true(count < 2);
            assert_int_equal(views, 5);
            assert_true(fabs(offset - wanted[count]) < 1e-9);
            assert_true(fabs(spread - wanted_spread[count++]) < 1e-9);
        }
    fclose(f);
    assert_int_equal(count, 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sure_depth_says_how_far_off_a_face_is),
        cmocka_unit_test(furniture_and_unsure_depth_say_nothing),
        cmocka_unit_test(the_median_of_views_is_written_largest_first),
    };
    return cmocka_run_group_tests(tests, make_model, release_model);
}
