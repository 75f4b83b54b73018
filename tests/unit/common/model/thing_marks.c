/* thing_marks.c - marks of things on photos: rays in the world, names and their lines; what is wrong is named. */
#include "common/model/thing_marks.h"

#include <math.h>

#include "tests/unit/scratch.h"

#define HEAD "remodel-marked-things 1\n"
#define LONG "a23456789-123456789_123456789_123456789_123456789_123456789_1234" /* 64 letters */

/* Photo a is one view; photo b, turned by 90 degrees about z, is two of which the set has the second. */
static char a[] = "a", b[] = "b", b0[] = "b@0", b1[] = "b@1";
static struct lens lenses[] = {
    {a, a, {CAMERA_SIMPLE_RADIAL, 40, 30, {30, 20, 15, 0}}, {1, 0, 0, 0}},
    {b0, b, {CAMERA_SIMPLE_RADIAL, 60, 40, {30, 30, 20, 0}}, {1, 0, 0, 0}},
    {b1, b, {CAMERA_SIMPLE_RADIAL, 60, 40, {30, 30, 20, 0}}, {1, 0, 0, 0}},
};
static const struct lens_list lens_list = {lenses, 3};
static struct view views[] = {
    {.name = a,
     .cam_from_world = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
     .translation = {-1, -2, -3},
     .center = {1, 2, 3}},
    {.name = b1, .cam_from_world = {{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}}},
};
static const struct camera_set set = {.views = views, .view_count = 2};

static const char marked[] = HEAD "# furniture\nthing sofa in a 20 15 in b 30 20\n\nthing lamp in b@1 60 20\n"
                                  "thing sofa in a 35 15\nthing 2nd_floor-lamp in a 0 0\n";

static void same_names(const struct thing_marks *m)
{
    assert_int_equal(m->name_count, 3);
    assert_string_equal(m->names[0], "sofa");
    assert_string_equal(m->names[1], "lamp");
    assert_string_equal(m->names[2], "2nd_floor-lamp");
    assert_true(m->lines[0] == 3 && m->lines[1] == 5 && m->lines[2] == 7);
}

static void is_empty(const struct thing_marks *m)
{
    assert_null(m->names);
    assert_null(m->lines);
    assert_null(m->marks);
    assert_int_equal(m->name_count + m->mark_count, 0);
}

static void is_ray(const struct thing_mark *m, struct vec3 origin, struct vec3 along)
{
    assert_true(vec3_length(vec3_sub(m->origin, origin)) == 0);
    assert_true(vec3_length(vec3_sub(m->direction, vec3_normalize(along))) < 1e-12);
}

static void marks_are_rays_in_the_world(void **state)
{
    (void)state;
    struct thing_marks m;
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    assert_ok(thing_marks_read(&m, scratch_write("things.txt", marked), &set, &lens_list, &prov, &err), err);
    same_names(&m);
    assert_int_equal(m.mark_count, 5);
    for (int i = 0; i < 5; i++) {
        assert_int_equal(m.marks[i].name, ((int[]){0, 0, 1, 0, 2})[i]);
        assert_int_equal(m.marks[i].line, ((int[]){3, 3, 5, 6, 7})[i]);
        assert_string_equal(m.marks[i].view, ((const char *[]){"a", "b", "b@1", "a", "a"})[i]);
    }
    assert_true(m.marks[2].u == 60 && m.marks[2].v == 20);
    is_ray(&m.marks[0], vec3_make(1, 2, 3), vec3_make(0, 0, 1));
    is_ray(&m.marks[1], vec3_make(0, 0, 0), vec3_make(0, 0, 1));
    is_ray(&m.marks[2], vec3_make(0, 0, 0), vec3_make(0, 1, 1)); /* the photo's right is the world's y */
    is_ray(&m.marks[3], vec3_make(1, 2, 3), vec3_make(0.5, 0, 1));
    is_ray(&m.marks[4], vec3_make(1, 2, 3), vec3_make(-20, -15, 30));
    assert_int_equal(prov.count, 1);
    assert_string_equal(prov.inputs[0].name, "things.txt");
    provenance_release(&prov);
    thing_marks_release(&m);
    is_empty(&m);
    thing_marks_release(&m);
    thing_marks_release(NULL);
}

static void names_need_no_cameras(void **state)
{
    (void)state;
    struct thing_marks m;
    struct err err = ERR_INIT;
    assert_ok(thing_names_read(&m, scratch_write("things.txt", marked), NULL, &err), err);
    same_names(&m);
    assert_int_equal(m.mark_count, 0);
    thing_marks_release(&m);
    assert_ok(thing_names_read(&m, scratch_write("things.txt", HEAD "thing x in nobody -1 1e9\n"), NULL, &err), err);
    assert_string_equal(m.names[0], "x");
    thing_marks_release(&m);
    assert_ok(thing_names_read(&m, scratch_write("things.txt", HEAD "thing " LONG " in a 0 0\n"), NULL, &err), err);
    assert_string_equal(m.names[0], LONG);
    thing_marks_release(&m);
    assert_ok(thing_names_read(&m, scratch_write("things.txt", HEAD), NULL, &err), err);
    is_empty(&m);
}

static void one_pixel_may_stand_for_an_outline(void **state)
{
    (void)state;
    struct thing_marks m;
    struct err err = ERR_INIT;
    const char *text = HEAD "flat rug in a 20 15\nflat poster in a 5 5 35 5 20 25\n";
    assert_ok(thing_marks_read(&m, scratch_write("things.txt", text), &set, &lens_list, NULL, &err), err);
    assert_true(m.name_count == 2 && m.flat[0] && m.flat[1]);
    assert_int_equal(m.mark_count, 4);
    assert_int_equal(m.marks[0].name, 0);
    thing_marks_release(&m);
}

static void outlines_are_rays_in_order(void **state)
{
    (void)state;
    struct thing_marks m;
    struct err err = ERR_INIT;
    const char *text = HEAD "thing sofa in a 20 15\nflat rug in a 5 5 35 5 20 25\n";
    assert_ok(thing_marks_read(&m, scratch_write("things.txt", text), &set, &lens_list, NULL, &err), err);
    assert_true(m.name_count == 2 && !m.flat[0] && m.flat[1]);
    assert_int_equal(m.mark_count, 4);
    for (int i = 1; i < 4; i++) assert_int_equal(m.marks[i].name, 1);
    is_ray(&m.marks[2], vec3_make(1, 2, 3), vec3_make(15, -10, 30));
    thing_marks_release(&m);
    assert_ok(thing_names_read(&m, scratch_write("things.txt", text), NULL, &err), err);
    assert_string_equal(m.names[1], "rug");
    thing_marks_release(&m);
}

struct refusal {
    const char *text, *error;
};

#define NAME_RULE "wanted a name of at most 64 letters, digits, _ and -, not a number"

static void what_is_wrong_is_named_with_its_line(void **state)
{
    (void)state;
    static const struct refusal cases[] = {
        {"", "found an empty file, wanted a line \"remodel-marked-things ...\""},
        {"remodel-things 1\n", "things.txt:1: found \"remodel-things\", wanted a line \"remodel-marked-things ...\""},
        {"remodel-marked-things\n", "things.txt:1: found the end of the line, wanted the version"},
        {"remodel-marked-things 2\n", "things.txt:1: found \"2\", wanted the version, an integer from 1 to 1"},
        {"remodel-marked-things 1 1\n", "things.txt:1: found \"1\""},
        {HEAD "material x in a 1 2\n", "things.txt:2: found \"material\", wanted thing or flat"},
        {HEAD "thing\n", "things.txt:2: found the end of the line, wanted a name"},
        {HEAD "thing \"a b\" in a 1 2\n", "things.txt:2: found \"a b\", " NAME_RULE},
        {HEAD "thing \"\" in a 1 2\n", "things.txt:2: found \"\", " NAME_RULE},
        {HEAD "thing -x in a 1 2\n", "things.txt:2: found \"-x\", " NAME_RULE},
        {HEAD "thing a/b in a 1 2\n", "things.txt:2: found \"a/b\", " NAME_RULE},
        {HEAD "thing 12 in a 1 2\n", "things.txt:2: found \"12\", " NAME_RULE},
        {HEAD "thing 1e5 in a 1 2\n", "things.txt:2: found \"1e5\", " NAME_RULE},
        {HEAD "thing " LONG "5 in a 1 2\n", NAME_RULE},
        {HEAD "thing x\n", "things.txt:2: found the end of the line, wanted \"in\""},
        {HEAD "thing x at a 1 2\n", "things.txt:2: found \"at\", wanted \"in\""},
        {HEAD "thing x in\n", "things.txt:2: found the end of the line, wanted a photo"},
        {HEAD "thing x in a\n", "things.txt:2: found the end of the line, wanted X"},
        {HEAD "thing x in a 1\n", "things.txt:2: found the end of the line, wanted Y"},
        {HEAD "thing x in a 1 nan\n", "things.txt:2: found \"nan\", wanted Y"},
        {HEAD "thing x in a 1 2\nthing y in a 1 2 3\n", "things.txt:3: found \"3\", wanted \"in\""},
        {HEAD "flat x in a 1 2 3 4\n", "things.txt:2: found the end of the line, wanted X"},
        {HEAD "flat x in a 1 2 3 4 5\n", "things.txt:2: found the end of the line, wanted Y"},
        {HEAD "flat x in a 1 2 3 4 5 6 in b 1 2\n", "things.txt:2: found \"in\", wanted X"},
        {HEAD "thing x in a 1 2\nflat x in a 1 2 3 4 5 6\n", "wanted another name: line 2 marks a thing of this name"},
        {HEAD "flat x in a 1 2 3 4 5 6\nthing x in a 1 2\n", "wanted another name: line 2 has an outline of it"},
    };
    for (size_t i = 0; i < 2 * sizeof cases / sizeof *cases; i++) {
        const struct refusal *c = &cases[i / 2];
        struct thing_marks m;
        struct err err = ERR_INIT;
        const char *path = scratch_write("things.txt", c->text);
        assert_int_equal(i % 2 ? thing_names_read(&m, path, NULL, &err)
                               : thing_marks_read(&m, path, &set, &lens_list, NULL, &err),
                         ST_DATA);
        assert_err(err, ST_DATA, c->error);
        is_empty(&m);
    }
}

static void marks_must_be_on_photos(void **state)
{
    (void)state;
    static const struct refusal cases[] = {
        {HEAD "thing x in a 1 2 in far 1 2\n",
         "things.txt:2: found \"far\", wanted a photo's id or a view's name from views/lenses.txt"},
        {HEAD "thing x in b@0 1 2\n", "things.txt:2: found \"b@0\""}, /* the set lacks it */
        {HEAD "thing x in b@2 1 2\n", "did you mean"},
        {HEAD "\nthing x in a 40.5 2\n",
         "things.txt:3: found \"pixel 40.5 2\", wanted a pixel of the photo, which has 40 x 30"},
        {HEAD "thing x in a 1 2 in a -0.5 2\n", "things.txt:2: found \"pixel -0.5 2\""},
        {HEAD "thing x in b 1 41\n", "wanted a pixel of the photo, which has 60 x 40"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct thing_marks m;
        struct err err = ERR_INIT;
        assert_int_equal(thing_marks_read(&m, scratch_write("things.txt", cases[i].text), &set, &lens_list, NULL, &err),
                         ST_DATA);
        assert_err(err, ST_DATA, cases[i].error);
        is_empty(&m);
    }
}

static void a_missing_file_is_an_error(void **state)
{
    (void)state;
    struct thing_marks m;
    struct err err = ERR_INIT;
    assert_int_equal(thing_names_read(&m, scratch_path("none.txt"), NULL, &err), ST_IO);
    assert_err(err, ST_IO, "none.txt");
    is_empty(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(marks_are_rays_in_the_world),          cmocka_unit_test(names_need_no_cameras),
        cmocka_unit_test(what_is_wrong_is_named_with_its_line), cmocka_unit_test(marks_must_be_on_photos),
        cmocka_unit_test(a_missing_file_is_an_error),           cmocka_unit_test(outlines_are_rays_in_order),
        cmocka_unit_test(one_pixel_may_stand_for_an_outline),
    };
    return cmocka_run_group_tests_name("thing_marks", tests, scratch_make, scratch_remove);
}
