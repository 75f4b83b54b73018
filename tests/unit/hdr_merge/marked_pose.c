/* marked_pose.c - lri.txt: marked corners place an image in the scene; marks that cannot be used are refused. */
#include "stages/hdr_merge/marked_pose.h"

#include <math.h>

#include "common/model/model_axes.h"
#include "tests/unit/scratch.h"

/* A room of 8.8 x 4.2 m, with a window in its south wall and one in its east wall; an oblique wall with a window. */
static const char plan_text[] =
    "remodel-plan 2\n"
    "wall south normal 0 1 at 0.15 thickness 0.3 from 0 to 8.8 foot 0 top 2.7 start free end free\n"
    "wall east normal -1 0 at -8.65 thickness 0.3 from 0 to 4.2 foot 0 top 2.7 start free end free\n"
    "wall oblique normal 0.6 0.8 at -3 thickness 0.3 from 0 to 4.2 foot 0 top 2.7 start free end free\n"
    "window sunny on south from 1.4 0.75 to 3.4 2.25 closed\n"
    "window north-light on east from 1.5 0.95 to 2.4 2.15 closed\n"
    "window slanted on oblique from 1.5 0.95 to 2.4 2.15 closed\n";

#define DOME "lens * EQUISOLID 480 480 169.705627\n"

static char file_name[] = "sky_e0.jpg", sky[] = "sky";
static struct bracket exposures[2] = {{.file = file_name}, {.file = sky}};
static const struct photo_record image = {
    .id = sky, .file = sky, .info = {.width = 480, .height = 480}, .brackets = exposures, .bracket_count = 2};

/* model from scene */
static const struct model_axes axes = {
    .rotation = {0.5, 0.5, -0.5, 0.5}, .translation = {1, -2, 0.5}, .scale = 1.6, .metric = true};

static enum status find(struct marked_pose *m, struct pose *p, bool *known, const char *marks, const char *model,
                        struct err *err)
{
    const struct merge_params params = MERGE_PARAMS_DEFAULT;
    struct err written = ERR_INIT;
    struct provenance prov = {0};
    struct camera lens;
    assert_ok(model_axes_write(&axes, scratch_path("axes.txt"), NULL, &written), written);
    const struct reference_frame frame = {.axes = scratch_path("axes.txt"),
                                          .marks = scratch_write("lri.txt", marks),
                                          .plan = scratch_write("plan.txt", plan_text)};
    *err = (struct err)ERR_INIT;
    const enum status st = marked_pose_find(m, &lens, p, known, &image, model, &frame, &params, &prov, err);
    provenance_release(&prov);
    return st;
}

/* A camera of the loft's lighting reference images, horizontal, aimed along (x, y), in the model's frame. */
static struct pose dome_at(struct vec3 at, double x, double y)
{
    const struct mat3 turn = {{{y, -x, 0}, {0, 0, -1}, {x, y, 0}}};
    return (struct pose){quat_from_mat3(turn), vec3_scale(mat3_apply(turn, at), -1)};
}

/* Adds lines for the corners of an opening from (x0, y0) to (x1, y1), left to right as seen from the inside; pixels are
 * whole numbers. */
static void mark_window(FILE *to, const struct pose *pose, const char *name, double x0, double y0, double x1, double y1,
                        double low, double high, const char *ending)
{
    const struct camera lens = camera_equisolid(480, 480, 169.705627, 240, 240);
    for (int i = 0; i < 4; i++) {
        const bool right = i & 1, top = i & 2;
        const struct vec3 corner = {right ? x1 : x0, right ? y1 : y0, top ? high : low};
        double u, v;
        assert_true(camera_project(&lens, pose_apply(pose, corner), &u, &v));
        fprintf(to, "corner sky %s %s %s %.0f %.0f%s\n", name, right ? "right" : "left", top ? "top" : "bottom",
                round(u), round(v), ending);
    }
}

static struct vec3 scene_center(const struct pose *p) { return model_from_world_point(&axes, pose_center(p)); }

static double degrees_from(const struct pose *in_scene, const struct pose *in_model)
{
    const struct mat3 a = mat3_multiply(mat3_from_quat(in_model->rotation), mat3_from_quat(axes.rotation)),
                      t = mat3_multiply(mat3_from_quat(in_scene->rotation), mat3_transpose(a));
    const double sine = vec3_length(vec3_make(t.m[2][1] - t.m[1][2], t.m[0][2] - t.m[2][0], t.m[1][0] - t.m[0][1]));
    return atan2(sine, t.m[0][0] + t.m[1][1] + t.m[2][2] - 1) * 180 / M_PI;
}

/* Marks rounded to pixels give the pose to `max_metres` and `max_degrees`; the interval contains it. */
static void assert_placed(const struct pose *truth, const char *text, int marks, double max_metres, double max_degrees)
{
    struct marked_pose m;
    struct pose found;
    struct err err;
    bool known = false;
    assert_ok(find(&m, &found, &known, text, NULL, &err), err);
    const struct vec3 off = vec3_sub(scene_center(&found), pose_center(truth)), e = m.found.poses[m.chosen].error;
    assert_true(known && m.metric);
    assert_int_equal(m.marks, marks);
    assert_true(vec3_length(off) < max_metres);
    assert_true(degrees_from(&found, truth) < max_degrees);
    assert_true(fabs(off.x) < e.x && fabs(off.y) < e.y && fabs(off.z) < e.z);
    assert_true(m.found.poses[m.chosen].rms < 1);
}

static char text[4096];

static FILE *begin(const char *first)
{
    FILE *to = fmemopen(text, sizeof text, "w");
    assert_non_null(to);
    fputs(first, to);
    return to;
}

static void corners_of_a_window_place_an_image_indoors(void **state)
{
    const struct pose truth = dome_at(vec3_make(2.2, 0.75, 1.45), 0, -1);
    FILE *to = begin(DOME);
    (void)state;
    mark_window(to, &truth, "sunny", 3.4, 0.15, 1.4, 0.15, 0.75, 2.25, "");
    fclose(to);
    assert_placed(&truth, text, 4, 0.015, 0.5);
}

static void corners_of_two_windows_place_an_image_better(void **state)
{
    const struct pose truth = dome_at(vec3_make(6, 3, 1.45), 0, -1);
    FILE *to = begin(DOME);
    (void)state;
    mark_window(to, &truth, "sunny", 3.4, 0.15, 1.4, 0.15, 0.75, 2.25, "");
    mark_window(to, &truth, "north-light", 8.65, 2.4, 8.65, 1.5, 0.95, 2.15, "");
    fclose(to);
    assert_placed(&truth, text, 8, 0.02, 0.3);
}

/* The loft's images are 5 cm outside the windows, whose corners are 92 to 95 degrees off the axis. */
static void corners_behind_the_camera_place_an_image_outdoors(void **state)
{
    const struct pose south = dome_at(vec3_make(2.4, -0.2, 1.5), 0, -1), east = dome_at(vec3_make(9, 1.95, 1.55), 1, 0);
    FILE *to = begin(DOME);
    (void)state;
    mark_window(to, &south, "sunny", 3.4, -0.15, 1.4, -0.15, 0.75, 2.25, " outer");
    fclose(to);
    assert_placed(&south, text, 4, 0.015, 0.5);
    to = begin(DOME);
    mark_window(to, &east, "north-light", 8.95, 2.4, 8.95, 1.5, 0.95, 2.15, " outer");
    fclose(to);
    assert_placed(&east, text, 4, 0.015, 0.6);
}

/* A window is the same from both sides but for left and right. */
static void left_and_right_exchanged_move_the_camera_through_the_wall(void **state)
{
    const struct pose truth = dome_at(vec3_make(2.2, 0.75, 1.45), 0, -1);
    struct marked_pose m;
    struct pose found;
    struct err err;
    bool known;
    (void)state;
    for (int exchanged = 0; exchanged < 2; exchanged++) {
        FILE *to = begin(DOME);
        mark_window(to, &truth, "sunny", exchanged ? 1.4 : 3.4, 0.15, exchanged ? 3.4 : 1.4, 0.15, 0.75, 2.25, "");
        fclose(to);
        assert_ok(find(&m, &found, &known, text, NULL, &err), err);
        assert_string_equal(m.wall, "south");
        assert_float_equal(m.before_wall, exchanged ? -0.6 : 0.6, 0.01);
    }
}

static void points_of_the_model_count_like_corners(void **state)
{
    const struct pose truth = dome_at(vec3_make(2.2, 0.75, 1.45), 0, -1);
    const struct camera lens = camera_equisolid(480, 480, 169.705627, 240, 240);
    FILE *to = begin(DOME);
    (void)state;
    for (int i = 0; i < 5; i++) {
        const struct vec3 p = {1 + 0.7 * i, i % 2 ? 0.15 : -0.4, 0.5 + (i % 3) * 0.8};
        double u, v;
        assert_true(camera_project(&lens, pose_apply(&truth, p), &u, &v));
        fprintf(to, "point sky_e0.jpg %.1f %.1f %.17g %.17g %.17g\n", u, v, p.x, p.y, p.z);
    }
    fclose(to);
    assert_placed(&truth, text, 5, 0.01, 0.3);
}

static void three_marks_need_a_place_near_the_camera(void **state)
{
    const struct pose truth = dome_at(vec3_make(2.7, 2.5, 1.7), 0, -1);
    struct marked_pose m;
    struct pose found;
    struct err err;
    bool known;
    FILE *to = begin(DOME);
    (void)state;
    mark_window(to, &truth, "sunny", 3.4, 0.15, 1.4, 0.15, 0.75, 2.25, "");
    fclose(to);
    *strrchr(text, 'c') = '\0'; /* the fourth corner */
    assert_int_equal(find(&m, &found, &known, text, NULL, &err), ST_DATA);
    assert_contains(err.text, "three marks of image sky leave");
    assert_err(err, ST_DATA, "add a line \"near sky X Y Z\"");
    strcat(text, "near sky 2.6 2.4 1.6\n");
    assert_placed(&truth, text, 3, 0.15, 4);
}

static void an_image_without_marks_is_unknown(void **state)
{
    struct marked_pose m;
    struct pose found;
    struct err err;
    bool known = true;
    (void)state;
    assert_ok(find(&m, &found, &known, "corner other sunny left top 1 2\n", NULL, &err), err);
    assert_false(known);
    assert_int_equal(m.marks, 0);
}

/* The text of the window's marks, with some of it replaced. */
static const char *changed(const char *from, const char *to)
{
    static char result[4096];
    const char *at = strstr(text, from);
    assert_non_null(at);
    snprintf(result, sizeof result, "%.*s%s%s", (int)(at - text), text, to, at + strlen(from));
    return result;
}

static void assert_refused(const char *marks, const char *model, const char *words)
{
    struct marked_pose m;
    struct pose found;
    struct err err;
    bool known;
    assert_int_equal(find(&m, &found, &known, marks, model, &err), ST_DATA);
    assert_err(err, ST_DATA, words);
}

static void marks_that_cannot_be_used_are_refused(void **state)
{
    const struct pose truth = dome_at(vec3_make(2.2, 0.75, 1.45), 0, -1);
    FILE *to = begin(DOME);
    (void)state;
    mark_window(to, &truth, "sunny", 3.4, 0.15, 1.4, 0.15, 0.75, 2.25, "");
    fclose(to);
    assert_refused(
        changed("sunny", "suny"), NULL,
        "lri.txt:2: found the opening \"suny\", wanted a door, passage or window of the model; did you mean sunny;");
    assert_refused(changed("sunny", "slanted"), NULL,
                   "lri.txt:2: the opening slanted is in the wall oblique, which is along no axis");
    assert_refused(changed("left bottom", "right top"), NULL,
                   "lri.txt:5: found what line 2 says of sky; delete one of the lines.");
    assert_refused(changed("left bottom", "lower left"), NULL,
                   "lri.txt:2: found \"lower\", wanted \"left\" or \"right\"");
    assert_refused(changed("left bottom", "left lower"), NULL, "wanted \"bottom\" or \"top\"");
    assert_refused(changed("corner sky", "corner *"), NULL, "lri.txt:2: found \"*\", wanted an image");
    assert_refused(
        changed("corner", "edge"), NULL,
        "lri.txt:2: found \"edge\", wanted \"corner\", \"point\", \"lens\", \"near\", \"in\" or \"horizon\"");
    assert_refused(changed("left bottom ", "left bottom 99"), NULL, "off image sky of 480 x 480 pixels.");
    assert_refused(changed("left bottom ", "left bottom nan "), NULL, "lri.txt:2: found");
    assert_refused(changed("480 480", "480 479"), NULL,
                   "lri.txt:1: found a lens of 480 x 479 pixels, but image sky has 480 x 480");
    assert_refused(changed("480 169.7", "480 -169.7"), NULL, "lri.txt:1: ");
    assert_refused(changed("EQUISOLID", "FISHBOWL"), NULL, "lri.txt:1: found \"FISHBOWL\"");
    assert_refused(changed("EQUISOLID 480 480 169.705627", "RADIAL 480 480 100 240 240 -0.3 0"), NULL,
                   "where its lens has no ray.");
    assert_refused("corner sky sunny left top 1 2\ncorner sky sunny right top 9 2\n", NULL,
                   "lri.txt has 2 marks of image sky, wanted at least 3");
    /* left and right exchanged at the bottom */
    strcpy(text, changed("left bottom", "right bottom x"));
    strcpy(text, changed("right bottom 3", "left bottom 3"));
    strcpy(text, changed("right bottom x", "right bottom"));
    assert_refused(text, NULL, "Check that left and right are as seen from the wall's inside");
}

static void the_lens_may_come_from_a_model(void **state)
{
    const struct pose truth = dome_at(vec3_make(2.2, 0.75, 1.45), 0, -1);
    struct marked_pose m;
    struct pose found;
    struct err err;
    bool known;
    FILE *to = begin("");
    (void)state;
    mark_window(to, &truth, "sunny", 3.4, 0.15, 1.4, 0.15, 0.75, 2.25, "");
    fclose(to);
    assert_refused(text, NULL, "lri.txt does not give the lens of image sky");
    scratch_write("cameras.txt", "1 PINHOLE 960 640 500 500 480 320\n"
                                 "2 OPENCV_FISHEYE 480 480 169.705627 169.705627 240 240 -0.0416666667 0.00052083333 "
                                 "-3.1001984e-06 1.0764578e-08\n");
    assert_ok(find(&m, &found, &known, text, scratch, &err), err);
    assert_true(vec3_length(vec3_sub(scene_center(&found), pose_center(&truth))) < 0.015);
    scratch_write("cameras.txt", "1 PINHOLE 480 480 500 500 240 240\n2 PINHOLE 480 480 501 501 240 240\n");
    assert_refused(text, scratch,
                   "has 2 cameras of 480 x 480 pixels, the size of image sky, wanted one; add a line \"lens sky");
}

/* A camera of the dome that is turned about its own axes: up by pitch, then to the right by roll; radians. */
static struct pose tilted(const struct pose *level, double pitch, double roll)
{
    const double cp = cos(pitch), sp = sin(pitch), cr = cos(roll), sr = sin(roll);
    const struct mat3 up = {{{1, 0, 0}, {0, cp, sp}, {0, -sp, cp}}}, over = {{{cr, sr, 0}, {-sr, cr, 0}, {0, 0, 1}}};
    const struct mat3 turn = mat3_multiply(over, mat3_multiply(up, mat3_from_quat(level->rotation)));
    return (struct pose){quat_from_mat3(turn), vec3_scale(mat3_apply(turn, pose_center(level)), -1)};
}

static void assert_in_window(const struct pose *truth, const char *marks, bool level)
{
    struct marked_pose m;
    struct pose found;
    struct err err;
    bool known = false;
    assert_ok(find(&m, &found, &known, marks, NULL, &err), err);
    assert_true(known && m.in_window && m.level == level);
    assert_int_equal(m.marks, 0);
    assert_true(vec3_length(vec3_sub(scene_center(&found), pose_center(truth))) < 1e-9);
    assert_true(degrees_from(&found, truth) < 1e-6);
}

static void a_window_places_an_image_that_looks_out(void **state)
{
    const struct pose middle = dome_at(vec3_make(2.4, -0.15, 1.5), 0, -1);
    const struct pose east = dome_at(vec3_make(8.95, 1.5 + 0.75 * 0.9, 0.95 + 0.25 * 1.2), 1, 0);
    (void)state;
    assert_in_window(&middle, DOME "in sky sunny looking out\n", true);
    /* left, seen from inside, is the larger y */
    assert_in_window(&east, DOME "in sky north-light at 0.25 0.25 looking out\n", true);
}

static void a_horizon_tells_pitch_and_roll(void **state)
{
    const struct camera lens = camera_equisolid(480, 480, 169.705627, 240, 240);
    const struct pose level = dome_at(vec3_make(2.4, -0.15, 1.5), 0, -1);
    (void)state;
    for (int k = 0; k < 4; k++) {
        const struct pose truth = tilted(&level, k & 1 ? 0.2 : -0.35, k & 2 ? 0.15 : -0.4);
        double u[2], v[2];
        for (int i = 0; i < 2; i++) {
            const struct vec3 far = {i ? 0.8 : -0.6, i ? -0.6 : -0.8, 0};
            assert_true(camera_project(&lens, mat3_apply(mat3_from_quat(truth.rotation), far), &u[i], &v[i]));
        }
        snprintf(text, sizeof text, DOME "in sky sunny looking out\nhorizon sky %.17g %.17g %.17g %.17g\n", u[k >> 1],
                 v[k >> 1], u[!(k >> 1)], v[!(k >> 1)]);
        assert_in_window(&truth, text, false);
    }
}

static void windows_that_cannot_be_used_are_refused(void **state)
{
    (void)state;
    assert_refused(DOME "in sky suny looking out\n", NULL, "lri.txt:2: found the opening \"suny\"");
    assert_refused(DOME "in sky sunny\n", NULL, "wanted \"looking\" or \"at\"");
    assert_refused(DOME "in sky sunny looking in\n", NULL, "lri.txt:2: found \"in\", wanted \"out\"");
    assert_refused(DOME "in sky sunny at 0.5 1.5 looking out\n", NULL,
                   "lri.txt:2: found \"1.5\", wanted a share of the opening's height, from 0 to 1");
    assert_refused(DOME "horizon sky 100 240 300 240\n", NULL,
                   "lri.txt:2: found a horizon of image sky, which has no line \"in\"");
    assert_refused(DOME "in sky sunny looking out\nhorizon sky 239 240 241 240\n", NULL,
                   "lri.txt:3: the two pixels of the horizon are less than 5 degrees apart");
    assert_refused(DOME "in sky sunny looking out\nhorizon sky 200 460 280 460\n", NULL,
                   "lri.txt:3: the image looks up or down by more than 80 degrees");
    assert_refused(DOME "in sky sunny looking out\npoint sky 1 1 1 1 1\n", NULL,
                   "lri.txt:2: found a window for image sky, which also has marks (line 3)");
    assert_refused("in sky sunny looking out\n", NULL, "lri.txt does not give the lens of image sky");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(corners_of_a_window_place_an_image_indoors),
        cmocka_unit_test(corners_of_two_windows_place_an_image_better),
        cmocka_unit_test(corners_behind_the_camera_place_an_image_outdoors),
        cmocka_unit_test(left_and_right_exchanged_move_the_camera_through_the_wall),
        cmocka_unit_test(points_of_the_model_count_like_corners),
        cmocka_unit_test(three_marks_need_a_place_near_the_camera),
        cmocka_unit_test(an_image_without_marks_is_unknown),
        cmocka_unit_test(marks_that_cannot_be_used_are_refused),
        cmocka_unit_test(the_lens_may_come_from_a_model),
        cmocka_unit_test(a_window_places_an_image_that_looks_out),
        cmocka_unit_test(a_horizon_tells_pitch_and_roll),
        cmocka_unit_test(windows_that_cannot_be_used_are_refused),
    };
    return cmocka_run_group_tests_name("marked_pose", tests, scratch_make, scratch_remove);
}
