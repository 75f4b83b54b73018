/* subject_list.c - tests of subjects on disk and in space. */
#include "common/film/subject_list.h"

#include "tests/unit/scratch.h"

#define IDENTITY                              \
    {                                         \
        {                                     \
            {1, 0, 0}, {0, 1, 0}, { 0, 0, 1 } \
        }                                     \
    }

static const struct view straight = {
    .name = "v", .width = 200, .height = 100, .fx = 100, .fy = 100, .cx = 100, .cy = 50, .cam_from_world = IDENTITY};

static struct subject example(void)
{
    return (struct subject){
        .x0 = 100, .y0 = 30, .x1 = 140, .y1 = 90, .depth = 5, .score = 1.0 / 3, .asked = 4, .confirmed = 3};
}

static void assert_point(struct vec3 p, double x, double y, double z)
{
    assert_true(fabs(p.x - x) < 1e-12 && fabs(p.y - y) < 1e-12 && fabs(p.z - z) < 1e-12);
}

static void corners_are_at_the_depth_of_the_rectangle(void **state)
{
    (void)state;
    struct subject s = example();
    subject_set_corners(&s, &straight, NULL);
    assert_point(s.corner[0], 0, -1, 5);
    assert_point(s.corner[1], 2, -1, 5);
    assert_point(s.corner[2], 2, 2, 5);
    assert_point(s.corner[3], 0, 2, 5);
    assert_point(subject_center(&s), 1, 0.5, 5);
    assert_point(subject_lower_center(&s), 1, 1.25, 5);
    assert_float_equal(subject_size_in(&s, &straight), 60, 1e-12);
}

/* For a picture stored rotated, the first corner is the upper left one of the upright picture, and so is the height. */
static void corners_follow_the_upright_picture(void **state)
{
    (void)state;
    static const struct vec3 ups[] = {{0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}};
    static const double first[4][2] = {{0, -1}, {2, -1}, {2, 2}, {0, 2}};
    for (int i = 0; i < 4; i++) {
        struct subject s = example();
        subject_set_corners(&s, &straight, &ups[i]);
        assert_point(s.corner[0], first[i][0], first[i][1], 5);
        const struct vec3 up = vec3_normalize(vec3_sub(s.corner[0], s.corner[3]));
        const struct vec3 right = vec3_normalize(vec3_sub(s.corner[1], s.corner[0]));
        assert_point(up, ups[i].x, ups[i].y, 0);
        assert_point(vec3_cross(right, vec3_scale(up, -1)), 0, 0, 1); /* not mirrored */
        assert_float_equal(subject_size_in(&s, &straight), (i % 2 ? 40.0 : 60.0), 1e-12);
        assert_point(subject_center(&s), 1, 0.5, 5);
    }
}

static void a_subject_behind_the_camera_has_no_size(void **state)
{
    (void)state;
    struct subject s = example();
    struct view beyond = straight;
    subject_set_corners(&s, &straight, NULL);
    beyond.translation = vec3_make(0, 0, -6);
    assert_true(subject_size_in(&s, &beyond) == 0);
    beyond.translation = vec3_make(0, 0, -5); /* in its plane */
    assert_true(subject_size_in(&s, &beyond) == 0);
    beyond.translation = vec3_make(0, 0, -2.5);
    assert_float_equal(subject_size_in(&s, &beyond), 120, 1e-9);
}

static void a_written_list_reads_back_the_same(void **state)
{
    (void)state;
    struct subject_list list = {0}, again;
    struct err err = ERR_INIT;
    const char *path = scratch_path("list.txt");
    for (int i = 0; i < 3; i++) {
        struct subject s = example();
        s.view = strdup(i ? "IMG 1@2" : "a");
        s.source = i == 2 ? SUBJECT_USER : SUBJECT_FACE;
        s.x0 += i / 7.0;
        subject_set_corners(&s, &straight, NULL);
        assert_int_equal(subject_list_add(&list, &s, &err), ST_OK);
        assert_null(s.view);
    }
    if (subject_list_write(&list, path, NULL, &err) || subject_list_read(&again, path, NULL, &err))
        fail_msg("%s", err.text);
    assert_int_equal(again.count, 3);
    for (int i = 0; i < 3; i++) {
        struct subject a = list.subjects[i], b = again.subjects[i];
        assert_string_equal(a.view, b.view);
        assert_true(a.source == b.source && a.x0 == b.x0 && a.y1 == b.y1 && a.depth == b.depth && a.score == b.score);
        assert_true(a.confirmed == b.confirmed && a.asked == b.asked && !memcmp(a.corner, b.corner, sizeof a.corner));
    }
    subject_list_release(&again);
    subject_list_release(&list);
    if (subject_list_write(&list, path, NULL, &err) || subject_list_read(&again, path, NULL, &err))
        fail_msg("%s", err.text);
    assert_true(again.count == 0); /* an empty list is valid */
    subject_list_release(&again);
    subject_list_release(&again);
    subject_list_release(NULL);
}

#define SUBJECT "subject v face 1 2 3 4 5 6 1 2\n"
#define CORNERS "corner 0 0 1\ncorner 1 0 1\ncorner 1 1 1\ncorner 0 1 1\n"

static void bad_lists_are_refused_with_file_and_line(void **state)
{
    (void)state;
    static const struct {
        const char *text, *line, *word;
    } cases[] = {
        {"", "an empty file", "remodel-subjects"},
        {"remodel-path 1\n", ":1:", "remodel-subjects"},
        {"remodel-subjects 2\n", ":1:", "version"},
        {"remodel-subjects 1\nsubjects -1\n", ":2:", "number of subjects"},
        {"remodel-subjects 1\nsubjects 1\n", ":2:", "subject ..."},
        {"remodel-subjects 1\nsubjects 1\nsubject v cat 1 2 3 4 5 6 1 2\n" CORNERS, ":3:", "\"face\" or \"user\""},
        {"remodel-subjects 1\nsubjects 1\nsubject v face 3 2 3 4 5 6 1 2\n" CORNERS, ":3:", "above x0"},
        {"remodel-subjects 1\nsubjects 1\nsubject v face 1 4 3 4 5 6 1 2\n" CORNERS, ":3:", "above y0"},
        {"remodel-subjects 1\nsubjects 1\nsubject v face 1 2 3 4 0 6 1 2\n" CORNERS, ":3:", "depth above 0"},
        {"remodel-subjects 1\nsubjects 1\nsubject v face 1 2 3 4 nan 6 1 2\n" CORNERS, ":3:", "nan"},
        {"remodel-subjects 1\nsubjects 1\nsubject v face 1 2 3 4 5 -1 1 2\n" CORNERS, ":3:", "score"},
        {"remodel-subjects 1\nsubjects 1\nsubject v face 1 2 3 4 5 6 3 2\n" CORNERS, ":3:", "searched"},
        {"remodel-subjects 1\nsubjects 1\n" SUBJECT "corner 0 0 1\n", ":4:", "corner"},
        {"remodel-subjects 1\nsubjects 1\n" SUBJECT "corner 0 0 1\ncorner 0 0 1\ncorner 0 0 1\ncorner 0 0 1\n",
         ":7:", "span an area"},
        {"remodel-subjects 1\nsubjects 1\n" SUBJECT CORNERS "more\n", ":8:", "end of the file"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct subject_list list;
        struct err err = ERR_INIT;
        const char *path = scratch_write("list.txt", cases[i].text);
        assert_int_equal(subject_list_read(&list, path, NULL, &err), ST_DATA);
        if (!strstr(err.text, path) || !strstr(err.text, cases[i].word) || !strstr(err.text, cases[i].line))
            fail_msg("case %zu: %s", i, err.text);
        assert_true(!list.count && !list.subjects);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(corners_are_at_the_depth_of_the_rectangle),
        cmocka_unit_test(corners_follow_the_upright_picture),
        cmocka_unit_test(a_subject_behind_the_camera_has_no_size),
        cmocka_unit_test(a_written_list_reads_back_the_same),
        cmocka_unit_test(bad_lists_are_refused_with_file_and_line),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
