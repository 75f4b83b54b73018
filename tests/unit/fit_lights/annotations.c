/* annotations.c - lights.txt of a scene: what a person marks is read; mistakes are refused with file and line. */
#include "stages/fit_lights/annotations.h"

#include "tests/unit/scratch.h"

#define HEAD "remodel-lamps 1\n"
#define SPOT "disk spot in v01 100 20 rim 110 20\n"

static void lamps_windows_and_points_are_read(void **state)
{
    (void)state;
    struct annotation_list l;
    struct err err = ERR_INIT;
    assert_ok(annotation_list_read(&l,
                                   scratch_write("lights.txt", HEAD
                                                 "window sunny reference lri_1 lri_2\nshut north\n"
                                                 "lit spot in v02 5 6\n"
                                                 "disk spot in v01 100 20 rim 110 20 off 0.1 normal 0 0 -2 beta fit "
                                                 "exponent 1.5\n"
                                                 "area panel in v01 1 2 3 4 5 6 7 8 radiance 3 2 1\n"
                                                 "unlit panel in v01 1 2 3 4 of plaster\nline spot in v03 1 2 30 40\n"),
                                   NULL, &err),
              err);
    assert_int_equal(l.count, 7);
    assert_true(l.items[0].kind == NOTE_WINDOW && l.items[0].reference_count == 2);
    assert_string_equal(l.items[0].references[1], "lri_2");
    assert_true(l.items[1].kind == NOTE_SHUT);
    assert_true(l.items[2].kind == NOTE_LIT && l.items[2].lamp == 3 &&
                l.items[2].pixels == 1); /* a lamp further down */
    assert_true(l.items[3].has_beta == QUANTITY_FIT && l.items[3].has_exponent == QUANTITY_GIVEN);
    assert_true(l.items[3].normal.z == -1 && l.items[3].off == 0.1 && l.items[3].exponent == 1.5);
    assert_true(l.items[3].has_radiance == QUANTITY_DEFAULT && l.items[3].pixel[2] == 110);
    assert_true(l.items[4].kind == NOTE_AREA && l.items[4].pixel[7] == 8 && l.items[4].radiance[1] == 2);
    assert_true(l.items[5].lamp == 4 && l.items[5].pixels == 2);
    assert_string_equal(l.items[5].material, "plaster");
    assert_true(l.items[6].kind == NOTE_LINE && l.items[6].line == 8);
    annotation_list_release(&l);
    assert_null(l.items);
}

static void mistakes_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *wanted;
    } cases[] = {
        {"remodel-lights 1\n", "remodel-lamps"},
        {HEAD "lamp a in v01 1 2\n", "window, shut, disk, area, lit, unlit or line"},
        {HEAD SPOT SPOT, "a name that line 2 does not have"},
        {HEAD "lit spot in v01 1 2\n", "wanted the name of a lamp"},
        {HEAD "disk a in v01 1 2 rim 3 4 beta 0\n", "a lamp with a cone of 0 lights nothing"},
        {HEAD "disk a in v01 1 2 rim 3 4 beta 91\n", "from 0 to 90, or fit"},
        {HEAD "disk a in v01 1 2 rim 3 4 beta 9 beta 9\n", "only once"},
        {HEAD "disk a in v01 1 2 rim 3 4 exponent -1\n", "from 0 to 1000, or fit"},
        {HEAD "disk a in v01 1 2 rim 3 4 normal 0 0 0\n", "a length above 0"},
        {HEAD "disk a in v01 1 2 rim 3 4 radiance 1 1 -1\n", "a radiance, a number from 0"},
        {HEAD "disk a in v01 1 2 rim 3 4 of 1\n", "off, normal, beta, exponent or radiance"},
        {HEAD "disk a in v01 1 2 3 4\n", "\"rim\""},
        {HEAD "area a in v01 1 2 3 4 5 6\n", "a pixel's x"},
        {HEAD "area a in v01 1 2 3 4 5 6 7 8 beta 3\n", "off or radiance"},
        {HEAD SPOT "lit spot in v01 5 5 4 9\n", "its upper left and its lower right pixel"},
        {HEAD SPOT "line spot in v01 5 5 6 6\n", "at least 4 pixels"},
        {HEAD SPOT "lit spot on v01 5 5\n", "\"in\""},
        {HEAD SPOT "lit spot in v01 -5 5\n", "a pixel's x, a number from 0"},
        {HEAD "area p in v01 1 2 3 4 5 6 7 8\nline p in v01 1 1 9 9\n", "only a disk has a cone"},
        {HEAD "disk a in v01 1 2 rim 3 4 beta 30\nline a in v01 1 1 9 9\n", "write beta fit there"},
        {HEAD SPOT "lit spot in v01 5 5 on floor\n", "of, or a pixel's x, a number from 0 to 1000000"},
        {HEAD SPOT "lit spot in v01 5 5 of\n", "the name of a material"},
        {HEAD SPOT "line spot in v01 5 5 16 6 on a\n", "\"of\""},
        {HEAD "window w lri_1\n", "\"reference\""},
        {HEAD "window w reference\n", "lighting reference image"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct annotation_list l;
        struct err err = ERR_INIT;
        const char *path = scratch_write("bad.txt", cases[i].text);
        assert_int_equal(annotation_list_read(&l, path, NULL, &err), ST_DATA);
        assert_non_null(strstr(err.text, path));
        if (!strstr(err.text, cases[i].wanted)) fail_msg("case %zu says: %s", i, err.text);
        assert_null(l.items);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lamps_windows_and_points_are_read),
        cmocka_unit_test(mistakes_are_refused),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
