/* marks.c - the user's marks: files, positions in the room, corrections, scale. */
#include "stages/find_axes/marks.h"

#include "common/math/rotation_fit.h"
#include "stages/find_axes/correct.h"
#include "tests/unit/find_axes/synthetic_room.h"
#include "tests/unit/scratch.h"

static const struct axes_params PARAMS = AXES_PARAMS_DEFAULT;

static void assert_refused(enum mark_file file, const char *text, const char *words)
{
    struct mark_list list;
    struct err err = ERR_INIT;
    const char *path = scratch_write("marks.txt", text);
    assert_int_equal(mark_list_read(&list, path, file, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, words);
    assert_contains(err.text, "marks.txt");
    assert_null(list.marks);
}

static void errors_in_files_name_the_line(void **state)
{
    (void)state;
    assert_refused(MARKS_SCALE, "mark p a 1 2\nmark p b 1 2\nmark q a 1 2 floor\nmeter p q 1\n",
                   ":4: found \"meter\", wanted \"mark\", \"length\" or \"height\"");
    assert_refused(MARKS_SCALE, "corner p a 1 2\n", ":1: found \"corner\"");
    assert_refused(MARKS_SCALE, "mark p a 1\n", ":1:");
    assert_refused(MARKS_SCALE, "mark p a 1 2 wall\n", "found \"wall\", wanted \"floor\", \"surface\"");
    assert_refused(MARKS_SCALE, "# nothing\n", "no length is given");
    assert_refused(MARKS_SCALE, "mark p a 1 2 floor\nlength p q 2\n", ":2: q is used, but no line marks it");
    assert_refused(MARKS_SCALE, "mark p a 1 2 floor\nlength p p 2\n", ":2: found p twice");
    assert_refused(MARKS_SCALE, "mark p a 1 2 floor\nmark q a 1 2 floor\nlength p q 0\n",
                   ":3: found \"0\", wanted a length above 0");
    assert_refused(MARKS_SCALE, "mark p a 1 2\nmark q a 1 2 floor\nlength p q 1\n",
                   ":1: p is marked in one view alone");
    assert_refused(MARKS_SCALE, "mark p a 1 2\nmark p a 1 3\nmark q a 1 2 floor\nlength p q 1\n",
                   ":1: p is marked twice in a");
    assert_refused(MARKS_SCALE, "mark p a 1 2 floor\nmark p b 1 2\nlength p p 1\n", "p is marked in 2 views");
    assert_refused(MARKS_SCALE, "height door 2\n", ":1: door is used, but no line marks it");
    assert_refused(MARKS_SCALE, "height ceiling -2.5\n", ":1: found \"-2.5\", wanted a length above 0");
    assert_refused(MARKS_SCALE, "height ceiling 2.5 3\n", ":1: found \"3\"");
    assert_refused(MARKS_SCALE, "mark p a 1 2 above q\nheight p 2\n", ":1: q is used, but no line marks it");
    assert_refused(MARKS_SCALE, "mark p a 1 2 above p\nheight p 2\n", ":1: p is above p, which is above another mark");
    assert_refused(MARKS_SCALE, "mark p a 1 2 above\nheight p 2\n", ":1: found the end of the line");
    assert_refused(MARKS_FIX, "height ceiling 2\n", ":1: found \"height\", wanted \"corner\"");
    assert_refused(MARKS_FIX, "length p q 1\n", ":1: found \"length\", wanted \"corner\"");
    assert_refused(MARKS_FIX, "corner p a 1 2\n", ":1: the corner p corrects nothing yet");
    assert_refused(MARKS_FIX, "corner p a 1 2\nedge p b 3 4\n", ":2: the corner p of this edge is not marked in b");
    assert_refused(MARKS_FIX, "corner p a 1 nan\n", ":1: found \"nan\"");
    assert_refused(MARKS_FIX, "mark p a 1 2 floor\nmark q a 3 4 floor\nthickness p q\nthickness q p\n",
                   ":4: found a second thickness");
}

static void read_marks(struct mark_list *list, const char *text, enum mark_file file)
{
    struct err err = ERR_INIT;
    assert_ok(mark_list_read(list, scratch_write("marks.txt", text), file, NULL, &err), err);
}

static void an_empty_file_of_corrections_is_valid(void **state)
{
    (void)state;
    struct mark_list list;
    read_marks(&list, "# nothing yet\n", MARKS_FIX);
    assert_int_equal(list.count, 0);
    mark_list_release(&list);
    mark_list_release(&list);
}

/* Appends a line for a room's point in a view. */
static void put(char *text, size_t size, const struct synthetic_room *r, const char *what, int view, struct vec3 p,
                const char *on)
{
    double u, v;
    const size_t used = strlen(text);
    room_pixel(r, view, p, &u, &v);
    assert_true(u > 0 && v > 0 && u < 800 && v < 600);
    snprintf(text + used, size - used, "%s %s %.17g %.17g %s\n", what, r->views[view].name, u, v, on);
}

static struct room_spec turned_room(void)
{
    const struct vec3 w = vec3_scale(vec3_normalize(vec3_make(1, 2, -1)), 0.7);
    return (struct room_spec){
        .ceiling = 1, .world_from_room = rotation_turn(ROOM_IDENTITY, w), .scale = 0.37, .origin = vec3_make(1, 2, 3)};
}

static struct mark_scene make_turned_room(struct synthetic_room *r)
{
    const struct room_spec m = turned_room();
    synthetic_room_make(r, &m);
    const struct vec3 up = mat3_apply(m.world_from_room, vec3_make(0, 0, 1));
    return (struct mark_scene){&r->set, &r->list, &r->cloud, up, vec3_dot(up, m.origin)};
}

static struct vec3 position_of(const char *name, const struct mark_list *list, const struct mark_scene *scene)
{
    struct vec3 at;
    struct err err = ERR_INIT;
    assert_ok(mark_locate(&at, MARK_POINT, name, list, scene, &err), err);
    return at;
}

/* These marks give no position of p. */
static void assert_nowhere(const char *text, const struct mark_scene *scene, const char *words)
{
    struct mark_list list;
    struct vec3 at;
    struct err err = ERR_INIT;
    read_marks(&list, text, MARKS_FIX);
    assert_int_equal(mark_locate(&at, MARK_POINT, "p", &list, scene, &err), ST_DATA);
    assert_err(err, ST_DATA, words);
    mark_list_release(&list);
}

static void marks_have_the_right_positions(void **state)
{
    (void)state;
    struct synthetic_room r;
    const struct mark_scene scene = make_turned_room(&r);
    struct mark_list list;
    char text[2048] = "";
    const struct vec3 p = {3.4, 2.2, 0.7}, q = {4.2, 2.5, 0}, s = {5, 3, 1.2}, h = {4.2, 2.5, 1.1};
    put(text, sizeof text, &r, "mark h", 0, h, "above q");
    put(text, sizeof text, &r, "mark p", 0, p, "");
    put(text, sizeof text, &r, "mark p", 1, p, "");
    put(text, sizeof text, &r, "mark q", 0, q, "floor");
    put(text, sizeof text, &r, "mark s", 0, s, "surface");
    strcat(text, "length p q 1\n");
    read_marks(&list, text, MARKS_SCALE);
    assert_true(vec3_length(vec3_sub(position_of("p", &list, &scene), room_world(&r.spec, p))) < 1e-9);
    assert_true(vec3_length(vec3_sub(position_of("q", &list, &scene), room_world(&r.spec, q))) < 1e-9);
    assert_true(vec3_length(vec3_sub(position_of("h", &list, &scene), room_world(&r.spec, h))) < 1e-9);
    /* the points are 3 cm apart */
    assert_true(vec3_length(vec3_sub(position_of("s", &list, &scene), room_world(&r.spec, s))) < 0.02 * r.spec.scale);
    mark_list_release(&list);
    synthetic_room_release(&r);
}

static void marks_without_a_position_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"mark p a 1 2\nmark p e 1 2\n", ":2: found \"e\", wanted a photo's id or a view's name"},
        {"mark p a 1 2\nmark p b 1000 2\n", ":2: the pixel 1000 2 is outside the picture of b, which has 800 x 600"},
        {"mark p a 400 20 floor\n", ":1: the floor is not visible at the pixel 400 20 of a"},
        {"mark p a 400 300\nmark p b 30 300\n", "the rays of p diverge in front of"},
    };
    struct synthetic_room r;
    struct mark_scene scene = make_turned_room(&r);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) assert_nowhere(cases[i].text, &scene, cases[i].words);
    /* no surface: an empty cloud; parallel rays: two views at the same position */
    const struct point_cloud none = {0};
    scene.cloud = &none;
    assert_nowhere("mark p a 400 300 surface\n", &scene, "there are no points at the pixel 400 300 of a");
    r.views[1].cam_from_world = r.views[0].cam_from_world;
    r.views[1].translation = r.views[0].translation;
    r.views[1].center = r.views[0].center;
    scene.cloud = &r.cloud;
    assert_nowhere("mark p a 400 300\nmark p b 401 300\n", &scene, "the rays of p are nearly parallel");
    synthetic_room_release(&r);
}

/* Standard deviation of the height of corner c for random errors of a pixel in its two marks. */
static double random_height_error(const struct synthetic_room *r, struct mark_list *fix)
{
    enum { TRIES = 2000 };
    const struct rng rng = rng_make(1, "test", "clicks");
    const struct vec3 up = mat3_apply(r->spec.world_from_room, vec3_make(0, 0, 1));
    const struct mark_scene scene = {.set = &r->set, .lenses = &r->list};
    double sum = 0, square = 0;
    for (uint64_t i = 0; i < TRIES; i++) {
        struct err err = ERR_INIT;
        struct vec3 at;
        const struct mark before[2] = {fix->marks[0], fix->marks[1]};
        for (uint64_t k = 0; k < 2; k++) {
            fix->marks[k].x += room_gauss(&rng, i, 4 * k);
            fix->marks[k].y += room_gauss(&rng, i, 4 * k + 2);
        }
        assert_ok(mark_locate(&at, MARK_CORNER, "c", fix, &scene, &err), err);
        const double height = vec3_dot(vec3_sub(at, r->spec.origin), up);
        sum += height / TRIES;
        square += height * height / TRIES;
        fix->marks[0] = before[0];
        fix->marks[1] = before[1];
    }
    return sqrt(square - sum * sum);
}

/* Axes that are off by 1 to 2 degrees about all three axes, and a wrong floor, are corrected by a corner with its three
 * edges in one view, and the corner in a second view. */
static void corners_and_edges_correct_axes_and_floor(void **state)
{
    (void)state;
    struct synthetic_room r;
    const struct mark_scene scene = make_turned_room(&r);
    struct mark_list fix;
    struct err err = ERR_INIT;
    char text[2048] = "";
    const struct vec3 corner = {5, 4, 0};
    put(text, sizeof text, &r, "corner c", 0, corner, "");
    put(text, sizeof text, &r, "corner c", 1, corner, "");
    put(text, sizeof text, &r, "edge c", 0, vec3_make(4, 4, 0), "");
    put(text, sizeof text, &r, "edge c", 0, vec3_make(5, 3, 0), "");
    put(text, sizeof text, &r, "edge c", 0, vec3_make(5, 4, 1.5), "");
    read_marks(&fix, text, MARKS_FIX);
    const struct mat3 room_from_world = mat3_transpose(r.spec.world_from_room);
    struct mat3 axes = rotation_turn(room_from_world, vec3_make(0.03, -0.02, 0.04));
    struct vec3 errors = {1, 1, 1};
    struct correction c;
    assert_ok(correct_axes(&axes, &errors, &c, &fix, &scene, 1, &err), err);
    const struct mat3 left = mat3_multiply(axes, r.spec.world_from_room);
    for (int i = 0; i < 9; i++) assert_true(fabs(left.m[i / 3][i % 3] - (i % 4 == 0)) < 1e-4);
    assert_true(fabs(c.turn - sqrt(0.03 * 0.03 + 0.02 * 0.02 + 0.04 * 0.04)) < 1e-3);
    assert_true(errors.x < 0.02 && errors.y < 0.02 && errors.z < 0.02 && errors.x > 1e-4);

    /* room_find(): points 5 cm too high agree with these marks within their errors, points 25 cm too high do not */
    for (int k = 0; k < 2; k++) {
        const double up = k ? 0.25 : 0.05, moved = k ? 0.2 : 0.05;
        for (size_t i = 0; i < r.cloud.count; i++) {
            struct vec3 *p = &r.cloud.points[i].position;
            *p = vec3_add(*p, mat3_apply(r.spec.world_from_room, vec3_make(0, 0, moved * r.spec.scale)));
        }
        struct room_inputs in = room_inputs(&r);
        struct room room;
        in.fix = &fix;
        assert_ok(room_find(&room, &in, &PARAMS, &err), err);
        assert_true(room.fix.edges == 3 && room.fix.turn == 0); /* the axes are right */
        assert_true(room.corner_height < 0);
        assert_true(room.floor_marked == (k == 1));
        assert_true(fabs(room_floor(&r, &room.axes) - (k ? 0 : up)) < 1e-6);
        assert_true(fabs(room.axes.ceiling - (k ? 2.6 + up : 2.6) * r.spec.scale) < 1e-5);
        if (k) assert_float_equal(room.axes.floor_error / random_height_error(&r, &fix), 1, 0.15);
    }
    mark_list_release(&fix);
    synthetic_room_release(&r);
}

/* An edge leaves two rotations undetermined. A mark that is off by less than its error corrects nothing; otherwise the
 * axes are rotated only about the determined axis. */
static void axes_are_rotated_only_where_marks_determine_them(void **state)
{
    (void)state;
    struct synthetic_room r;
    const struct mark_scene scene = make_turned_room(&r);
    struct mark_list fix;
    struct err err = ERR_INIT;
    char text[1024] = "";
    put(text, sizeof text, &r, "corner c", 0, vec3_make(5, 4, 0), "");
    put(text, sizeof text, &r, "edge c", 0, vec3_make(5, 3, 0), "");
    read_marks(&fix, text, MARKS_FIX);
    const struct mat3 right = mat3_transpose(r.spec.world_from_room);
    struct mat3 axes = right;
    struct vec3 errors = {0.001, 0.001, 0.001};
    struct correction c;
    assert_ok(correct_axes(&axes, &errors, &c, &fix, &scene, 1, &err), err);
    assert_true(c.turn == 0 && c.edges == 1); /* nothing to correct */
    assert_true(errors.x == 0.001 && errors.y == 0.001 && errors.z == 0.001);
    fix.marks[1].y += 1.5; /* px; the error of a mark is 1 px */
    assert_ok(correct_axes(&axes, &errors, &c, &fix, &scene, 1, &err), err);
    assert_true(c.turn == 0);
    fix.marks[1].y += 30;
    assert_ok(correct_axes(&axes, &errors, &c, &fix, &scene, 1, &err), err);
    assert_true(c.turn > 0.02 && c.turn < 0.5);
    const struct mat3 off = mat3_multiply(axes, mat3_transpose(right)); /* about one axis alone */
    assert_float_equal(acos((off.m[0][0] + off.m[1][1] + off.m[2][2] - 1) / 2), c.turn, 1e-3);
    mark_list_release(&fix);
    synthetic_room_release(&r);
}

static void edges_along_no_axis_are_refused(void **state)
{
    (void)state;
    struct synthetic_room r;
    const struct mark_scene scene = make_turned_room(&r);
    struct mark_list fix;
    struct err err = ERR_INIT;
    char text[1024] = "";
    struct mat3 axes = mat3_transpose(r.spec.world_from_room);
    struct vec3 errors = {0};
    struct correction c;
    int refused = 0;
    for (int i = 0; i < 36; i++) { /* from one pixel in all directions */
        snprintf(text, sizeof text, "corner c a 500 450\nedge c a %.9g %.9g\n", 500 + 99 * cos(M_PI * i / 18),
                 450 + 99 * sin(M_PI * i / 18));
        read_marks(&fix, text, MARKS_FIX);
        struct mat3 now = axes;
        struct err why = ERR_INIT;
        if (correct_axes(&now, &errors, &c, &fix, &scene, 1, &why)) {
            assert_err(why, ST_DATA, "marks.txt:2: the edge follows none of the axes: in a it is ");
            refused++;
        } else {
            assert_true(c.turn < 1);
        }
        mark_list_release(&fix);
    }
    assert_in_range(refused, 1, 35);
    read_marks(&fix, "corner c a 100 100\nedge c a 101 101\n", MARKS_FIX);
    assert_int_equal(correct_axes(&axes, &errors, &c, &fix, &scene, 1, &err), ST_DATA);
    assert_err(err, ST_DATA, "marks.txt:2: the point on the edge is only 1.41 px from its corner");
    mark_list_release(&fix);
    synthetic_room_release(&r);
}

static void lengths_give_the_scale_and_marks_the_thickness(void **state)
{
    (void)state;
    struct synthetic_room r;
    make_turned_room(&r);
    struct mark_list scale, fix;
    struct err err = ERR_INIT;
    char text[2048] = "", walls[1024] = "";
    const struct vec3 p = {4.2, 2.5, 0}, q = {5, 3.1, 0}, t = {3.4, 2.2, 0.7};
    put(text, sizeof text, &r, "mark p", 0, p, "floor");
    put(text, sizeof text, &r, "mark q", 0, q, "floor");
    put(text, sizeof text, &r, "mark t", 0, t, "");
    put(text, sizeof text, &r, "mark t", 1, t, "");
    strcat(text, "length p q 1\nlength q t 1.9748417658131499\n"); /* sqrt(0.64 + 0.36); sqrt(3.86) is 1.9647 */
    read_marks(&scale, text, MARKS_SCALE);
    put(walls, sizeof walls, &r, "mark one", 0, vec3_make(4.4, 2.5, 0), "floor");
    put(walls, sizeof walls, &r, "mark two", 0, vec3_make(4.41, 2.65, 0), "floor");
    strcat(walls, "thickness one two\n");
    read_marks(&fix, walls, MARKS_FIX);
    struct room_inputs in = room_inputs(&r);
    struct room room;
    in.scale = &scale;
    in.fix = &fix;
    assert_ok(room_find(&room, &in, &PARAMS, &err), err);
    assert_true(room.axes.metric);
    /* by least squares: the second length is 0.5 % too long */
    const double wanted = (1 + sqrt(3.86) * 1.9748417658131499) / (1 + 3.86);
    assert_true(fabs(room.axes.scale * r.spec.scale - wanted) < 1e-5);
    assert_true(room.axes.scale_error > 0.001 && room.axes.scale_error < 0.05);
    assert_true(fabs(room.axes.thickness - 0.15 * wanted) < 1e-5);
    assert_true(fabs(room.axes.ceiling - 2.6 * wanted) < 1e-4);
    mark_list_release(&fix);
    mark_list_release(&scale);
    synthetic_room_release(&r);
}

/* The room is 2.6 high. */
static void heights_give_the_scale(void **state)
{
    const struct vec3 foot = {5, 2.4, 0}, head = {5, 2.4, 2.03};
    (void)state;
    for (int way = 0; way < 3; way++) { /* by the ceiling, by a door, by both */
        struct synthetic_room r;
        make_turned_room(&r);
        struct mark_list scale;
        struct err err = ERR_INIT;
        char text[2048] = "";
        if (way) put(text, sizeof text, &r, "mark foot", 0, foot, "floor");
        if (way) put(text, sizeof text, &r, "mark door", 0, head, "above foot");
        if (way) strcat(text, "height door 2.03\n");
        if (way != 1) strcat(text, "height ceiling 2.626\n"); /* 1 % too high */
        read_marks(&scale, text, MARKS_SCALE);
        struct room_inputs in = room_inputs(&r);
        struct room room;
        in.scale = &scale;
        assert_ok(room_find(&room, &in, &PARAMS, &err), err);
        const double wanted = way == 0 ? 1.01 : way == 1 ? 1 : (2.03 * 2.03 + 2.6 * 2.626) / (2.03 * 2.03 + 2.6 * 2.6);
        assert_true(room.axes.metric);
        assert_true(fabs(room.axes.scale * r.spec.scale - wanted) < 1e-4);
        assert_true(fabs(room.axes.ceiling - 2.6 * wanted) < 1e-3);
        assert_true(room.axes.scale_error < 0.02 && (way == 0 || room.axes.scale_error > 1e-4));
        mark_list_release(&scale);
        synthetic_room_release(&r);
    }
}

static void a_ceiling_that_was_not_found_has_its_given_height(void **state)
{
    (void)state;
    for (int way = 0; way < 2; way++) {
        struct synthetic_room r;
        make_turned_room(&r);
        size_t kept = 0; /* the points below the ceiling */
        for (size_t i = 0; i < r.cloud.count; i++) {
            const struct vec3 off = vec3_sub(r.cloud.points[i].position, r.spec.origin);
            const struct vec3 at = mat3_apply(mat3_transpose(r.spec.world_from_room), off);
            if (at.z < 2.5 * r.spec.scale) r.cloud.points[kept++] = r.cloud.points[i];
        }
        r.cloud.count = kept;
        struct mark_list scale;
        struct err err = ERR_INIT;
        char text[2048] = "height ceiling 2.5\n";
        if (way) put(text, sizeof text, &r, "mark p", 0, vec3_make(4.2, 2.5, 0), "floor");
        if (way) put(text, sizeof text, &r, "mark q", 0, vec3_make(5, 3.1, 0), "floor");
        if (way) strcat(text, "length p q 1\n");
        read_marks(&scale, text, MARKS_SCALE);
        struct room_inputs in = room_inputs(&r);
        struct room room;
        in.scale = &scale;
        const enum status st = room_find(&room, &in, &PARAMS, &err);
        if (way) {
            assert_ok(st, err);
            assert_true(room.axes.ceiling == 2.5 && fabs(room.axes.scale * r.spec.scale - 1) < 1e-5);
        } else {
            assert_err(err, ST_DATA, "the height of the ceiling is given, but no ceiling was found");
        }
        mark_list_release(&scale);
        synthetic_room_release(&r);
    }
}

/* A value that depends on a mark's pixel, and does not exist right of the photo. */
static bool sum_of_marks(void *ctx, double *value)
{
    const struct mark_list *list = ctx;
    *value = 3 * list->marks[0].x + 4 * list->marks[0].y;
    return list->marks[0].x < 10.5; /* right of the photo */
}

static void errors_of_marks_add_up(void **state)
{
    (void)state;
    struct mark_list list;
    read_marks(&list, "mark p a 10 20 floor\n", MARKS_FIX);
    assert_float_equal(mark_error(&list, 1, sum_of_marks, &list), 5, 1e-12);
    assert_true(list.marks[0].x == 10 && list.marks[0].y == 20);
    mark_list_release(&list);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(errors_in_files_name_the_line),
        cmocka_unit_test(an_empty_file_of_corrections_is_valid),
        cmocka_unit_test(marks_have_the_right_positions),
        cmocka_unit_test(marks_without_a_position_are_refused),
        cmocka_unit_test(corners_and_edges_correct_axes_and_floor),
        cmocka_unit_test(axes_are_rotated_only_where_marks_determine_them),
        cmocka_unit_test(edges_along_no_axis_are_refused),
        cmocka_unit_test(lengths_give_the_scale_and_marks_the_thickness),
        cmocka_unit_test(heights_give_the_scale),
        cmocka_unit_test(a_ceiling_that_was_not_found_has_its_given_height),
        cmocka_unit_test(errors_of_marks_add_up),
    };
    return cmocka_run_group_tests_name("marks", tests, scratch_make, scratch_remove);
}
