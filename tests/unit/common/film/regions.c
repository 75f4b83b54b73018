/* regions.c - drawn rectangles, mapped through lenses. */
#include "common/film/regions.h"

#include "tests/unit/scratch.h"

static char photo_a[] = "a", view_a[] = "a", photo_b[] = "b", view_left[] = "b@1", view_right[] = "b@2",
            photo_gone[] = "gone";

/* Photo a keeps its camera; b has a strong lens and two views, rotated by 30 degrees to either side; gone has no
 * view. */
static struct lens lenses[] = {
    {view_a, photo_a, {CAMERA_PINHOLE, 200, 100, {100, 100, 100, 50}}, {1, 0, 0, 0}},
    {view_left,
     photo_b,
     {CAMERA_SIMPLE_RADIAL, 400, 200, {100, 200, 100, 0.1}},
     {0.96592582628906831, 0, 0.25881904510252074, 0}},
    {view_right,
     photo_b,
     {CAMERA_SIMPLE_RADIAL, 400, 200, {100, 200, 100, 0.1}},
     {0.96592582628906831, 0, -0.25881904510252074, 0}},
    {photo_gone, photo_gone, {CAMERA_PINHOLE, 200, 100, {100, 100, 100, 50}}, {1, 0, 0, 0}},
};
static const struct lens_list list = {lenses, 4};
static struct view views[] = {{.name = "a", .width = 200, .height = 100, .fx = 100, .fy = 100, .cx = 100, .cy = 50},
                              {.name = "b@1", .width = 200, .height = 200, .fx = 100, .fy = 100, .cx = 100, .cy = 100},
                              {.name = "b@2", .width = 200, .height = 200, .fx = 100, .fy = 100, .cx = 100, .cy = 100}};
static const struct camera_set set = {.views = views, .view_count = 3};

static double part; /* of the last region, inside its view */

static enum status place(struct subject *s, int *at, const char *view, double x0, double y0, double x1, double y1,
                         struct err *err)
{
    const struct region r = {(char *)view, 7, x0, y0, x1, y1};
    *s = (struct subject){0};
    *err = (struct err)ERR_INIT;
    return region_in_view(s, at, &part, &r, "subjects.txt", &set, &list, err);
}

static void a_pinhole_photo_keeps_its_rectangle(void **state)
{
    (void)state;
    struct subject s;
    struct err err;
    int at = -1;
    assert_int_equal(place(&s, &at, "a", 20, 30, 60.5, 80, &err), ST_OK);
    assert_true(at == 0 && !strcmp(s.view, "a") && s.source == SUBJECT_USER);
    assert_true(part == 1);
    assert_true(fabs(s.x0 - 20) < 1e-9 && fabs(s.y0 - 30) < 1e-9 && fabs(s.x1 - 60.5) < 1e-9 && fabs(s.y1 - 80) < 1e-9);
    subject_release(&s);
    assert_int_equal(place(&s, &at, "a", -20, 30, 60, 180, &err), ST_OK); /* clipped at the border */
    assert_true(fabs(part - 60.0 / 80 * 70 / 150) < 1e-9);
    assert_true(fabs(s.x0) < 1e-9 && fabs(s.y0 - 30) < 1e-9 && fabs(s.x1 - 60) < 1e-9 && fabs(s.y1 - 100) < 1e-9);
    subject_release(&s);
}

/* The rectangle around a point's image by camera_project() contains the point's projection in the view. */
static void a_rectangle_is_mapped_through_the_lens(void **state)
{
    (void)state;
    for (int right = 0; right < 2; right++) {
        const struct lens *lens = &lenses[1 + right];
        struct subject s;
        struct err err;
        int at = -1;
        double u, v;
        const struct mat3 photo_from_view = mat3_transpose(mat3_from_quat(lens->view_from_photo));
        assert_true(camera_project(&lens->camera, mat3_apply(photo_from_view, vec3_make(0.2, -0.3, 1)), &u, &v));
        assert_int_equal(place(&s, &at, "b", u - 2, v - 2, u + 2, v + 2, &err), ST_OK);
        assert_int_equal(at, 1 + right); /* the view that holds most of it */
        assert_true(s.x0 < 120 && s.x1 > 120 && s.y0 < 70 && s.y1 > 70);
        assert_true(s.x1 - s.x0 < 8 && s.y1 - s.y0 < 8);
        subject_release(&s);
        assert_int_equal(place(&s, &at, lens->view, u - 2, v - 2, u + 2, v + 2, &err), ST_OK);
        assert_int_equal(at, 1 + right);
        subject_release(&s);
    }
}

static void a_rectangle_in_no_view_is_an_error_with_its_line(void **state)
{
    (void)state;
    struct subject s;
    struct err err;
    int at = -1;
    assert_int_equal(place(&s, &at, "a", 300, 10, 400, 20, &err), ST_DATA);
    assert_true(strstr(err.text, "subjects.txt:7: ") && strstr(err.text, "outside") && strstr(err.text, "200 x 100"));
    assert_int_equal(place(&s, &at, "b@3", 10, 10, 40, 20, &err), ST_DATA);
    assert_true(strstr(err.text, "subjects.txt:7: found \"b@3\"") && strstr(err.text, "did you mean b@1?"));
    assert_int_equal(place(&s, &at, "gone", 10, 10, 40, 20, &err),
                     ST_DATA); /* a lens without a camera: held out of the set */
    assert_true(strstr(err.text, "subjects.txt:7: found \"gone\""));
    assert_null(s.view);
}

static enum status read_text(struct region_list *l, const char *text, struct err *err)
{
    *err = (struct err)ERR_INIT;
    return region_list_read(l, scratch_write("subjects.txt", text), NULL, err);
}

static void lines_are_read_in_order(void **state)
{
    (void)state;
    struct region_list l;
    struct err err;
    assert_int_equal(read_text(&l, "# the two of them\nsubject a 1 2 3 4.5\n\n subject \"b 1\" 0 0 9 9\n", &err),
                     ST_OK);
    assert_true(l.count == 2 && !strcmp(l.regions[0].view, "a") && !strcmp(l.regions[1].view, "b 1"));
    assert_true(l.regions[0].y1 == 4.5 && l.regions[0].line == 2 && l.regions[1].line == 4);
    region_list_release(&l);
    assert_int_equal(read_text(&l, "# nobody\n", &err), ST_OK);
    assert_int_equal(l.count, 0);
    region_list_release(&l);
    region_list_release(NULL);
}

static void malformed_lines_are_errors_with_their_position(void **state)
{
    (void)state;
    static const struct {
        const char *text, *word;
    } cases[] = {{"face a 1 2 3 4\n", "\"subject\""},
                 {"subject a 1 2 3\n", "y1"},
                 {"subject a 1 2 3 4 5\n", "5"},
                 {"subject a 3 2 1 4\n", "X1 above X0 (3)"},
                 {"subject a 1 2 3 2\n", "Y1 above Y0 (2)"},
                 {"subject a 1 2 nan 2\n", "nan"},
                 {"subject\n", "a photo or view"},
                 {"remodel-subjects 1\n", "\"subject\""}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct region_list l;
        struct err err;
        assert_int_equal(read_text(&l, cases[i].text, &err), ST_DATA);
        if (!strstr(err.text, "subjects.txt:1: ") || !strstr(err.text, cases[i].word))
            fail_msg("case %zu: %s", i, err.text);
        assert_true(!l.regions && !l.count);
    }
}

static void a_rectangle_at_the_border_is_clipped(void **state)
{
    (void)state;
    struct subject s = {.x0 = -5, .y0 = 10, .x1 = 12, .y1 = 300};
    assert_true(region_clip(&s, 40, 30));
    assert_true(s.x0 == 0 && s.y0 == 10 && s.x1 == 12 && s.y1 == 30);
    s = (struct subject){.x0 = -5, .y0 = 10, .x1 = 0, .y1 = 20};
    assert_false(region_clip(&s, 40, 30));
    s = (struct subject){.x0 = 3, .y0 = 31, .x1 = 9, .y1 = 40};
    assert_false(region_clip(&s, 40, 30));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_pinhole_photo_keeps_its_rectangle),
        cmocka_unit_test(a_rectangle_is_mapped_through_the_lens),
        cmocka_unit_test(a_rectangle_in_no_view_is_an_error_with_its_line),
        cmocka_unit_test(lines_are_read_in_order),
        cmocka_unit_test(malformed_lines_are_errors_with_their_position),
        cmocka_unit_test(a_rectangle_at_the_border_is_clipped),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
