/* page.c - pages of an empty scene, of a photograph with an odd name, of changed parameters, of some stages. */
#include "stages/report/page.h"

#include "tests/unit/scratch.h"

#include "common/base/outfile.h"

/* The page of the scratch folder; the caller frees it. */
static char *page_of(const char *scene, const char *defaults)
{
    const struct contents_sources from = {scratch, scratch, scratch_path("originals"), "rectify sfm other report",
                                          defaults};
    struct contents c = {0};
    struct err err = ERR_INIT;
    char *text = NULL;
    size_t size;
    FILE *to = open_memstream(&text, &size);
    assert_int_equal(contents_read(&c, &from, &err), ST_OK);
    assert_int_equal(page_write(to, scene, &c, &err), ST_OK);
    fclose(to);
    contents_release(&c);
    contents_release(&c);
    return text;
}

static void missing_products_are_listed(void **state)
{
    char *page = page_of("<b>&", NULL);
    (void)state;
    assert_non_null(strstr(page, "<h1>&lt;b&gt;&amp;</h1>"));
    assert_null(strstr(page, "<b>&"));
    assert_non_null(strstr(page, "No camera move has been planned yet"));
    assert_non_null(strstr(page, "There are no views yet."));
    assert_non_null(strstr(page, "There is no list of photographs."));
    assert_non_null(strstr(page, "There are no logs."));
    assert_null(strstr(page, "http://"));
    assert_null(strstr(page, "https://"));
    free(page);
}

static void the_page_of_remodelled_rooms_is_linked_if_there_is_one(void **state)
{
    static const char link[] = "<a href=\"remodel/index.html\">Remodelled rooms</a>";
    struct err err = ERR_INIT;
    char *page = page_of("scene", NULL);
    (void)state;
    assert_null(strstr(page, link));
    free(page);
    assert_ok(outfile_make_folders(scratch_path("remodel"), &err), err);
    scratch_write("remodel/index.html", "");
    page = page_of("scene", NULL);
    assert_non_null(strstr(page, link));
    free(page);
}

static void things_are_shown_if_there_are_any(void **state)
{
    struct err err = ERR_INIT;
    char *page = page_of("scene", NULL);
    (void)state;
    assert_null(strstr(page, "Things"));
    free(page);
    assert_ok(outfile_make_folders(scratch_path("things"), &err), err);
    scratch_write("things/sheet.svg", "<svg/>");
    page = page_of("scene", NULL);
    assert_contains(page, "<a href=\"#things\">Things</a>");
    assert_contains(page, "<h2 id=\"things-title\">Things</h2>");
    assert_contains(page, "src=\"data:image/svg+xml;base64,PHN2Zy8+\"");
    assert_lacks(page, "Plan of the rooms");
    free(page);
    scratch_write("things/plan.svg", "<svg></svg>");
    page = page_of("scene", NULL);
    assert_contains(page,
                    "alt=\"Plan of the rooms with all things\" src=\"data:image/svg+xml;base64,PHN2Zz48L3N2Zz4=\"");
    free(page);
}

static void a_missing_scene_is_an_error(void **state)
{
    const struct contents_sources from = {scratch_path("no-such-scene"), scratch, scratch, "rectify", NULL};
    struct contents c = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(contents_read(&c, &from, &err), ST_IO);
    assert_non_null(strstr(err.text, "no-such-scene"));
    contents_release(&c);
}

static void photographs_are_shown_and_unlisted_ones_named(void **state)
{
    static const unsigned char GREY[6 * 4 * 3] = {0};
    char id[] = "a_b", file[] = "a <b>.jpg";
    struct photo_record r = {
        .id = id, .file = file, .info = {.width = 6, .height = 4, .bits = 8, .orientation = 1, .colour = "P3 & more"}};
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(outfile_make_folders(scratch_path("photos"), &err), ST_OK);
    assert_int_equal(outfile_make_folders(scratch_path("originals"), &err), ST_OK);
    assert_int_equal(jpeg_write(scratch_path("originals/a <b>.jpg"), GREY, 6, 4, 90, &err), ST_OK);
    assert_int_equal(jpeg_write(scratch_path("originals/unused.JPG"), GREY, 6, 4, 90, &err), ST_OK);
    assert_int_equal(hash_file(r.hash, scratch_path("originals/a <b>.jpg"), &err), ST_OK);
    assert_int_equal(photo_record_write(&r, scratch_path("photos"), &err), ST_OK);
    scratch_write("photos/list.txt", "a_b \"a <b>.jpg\"\n");

    char *page = page_of("scene", NULL);
    assert_non_null(strstr(page, "alt=\"Photograph a &lt;b&gt;.jpg\" src=\"data:image/jpeg;base64,/9j/"));
    assert_non_null(strstr(page, "6 × 4</span>, P3 &amp; more"));
    assert_non_null(strstr(page, "<b>unused.JPG</b> is in the folder"));
    assert_null(strstr(page, "not placed by SfM")); /* there are no views yet */
    free(page);
}

static void forms_of_lens_show_the_chosen_one_and_those_refused(void **state)
{
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(outfile_make_folders(scratch_path("views"), &err), ST_OK);
    scratch_write("views/lens_forms.txt", "remodel-lens-forms 1\nform SIMPLE_RADIAL shared 4 0.455 0.407 0 chosen\n"
                                          "form OPENCV per_photo - - - - refused\nshift a 1 2 - -\n");
    char *page = page_of("scene", NULL);
    assert_non_null(strstr(page, "<tr class=\"changed\"><th scope=\"row\">SIMPLE_RADIAL</th><td>shared</td>"
                                 "<td class=\"n\">4</td><td class=\"n\">0.455</td>"));
    assert_non_null(strstr(page, "<td>per photo</td><td class=\"n\">–</td>"));
    assert_non_null(strstr(page, "<td>refused</td>"));
    free(page);

    scratch_write("views/lens_forms.txt", "remodel-lens-forms 1\nform OPENCV kept 3 nan 1 2 -\n");
    page = page_of("scene", NULL);
    assert_non_null(strstr(page, "lens_forms.txt is not shown."));
    free(page);
}

static void changed_parameters_are_marked(void **state)
{
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(outfile_make_folders(scratch_path("slice"), &err), ST_OK);
    scratch_write("slice/rectify.cfg", "[rectify]\nwidth = 5\nheight = 2\nwidth = 7\n");
    const char *defaults = scratch_write("default.cfg", "[rectify]\nwidth = 5\nheight = 2.0\n[other]\nheight = 9\n");
    char *page = page_of("scene", defaults);
    assert_non_null(strstr(page, "2 parameters, 1 changed"));
    assert_non_null(strstr(page,
                           "<tr class=\"changed\"><th scope=\"row\"><code>width</code></th><td><code>7</code></td>"
                           "<td class=\"how\">default 5</td></tr>"));
    free(page);
    page = page_of("scene", NULL);
    assert_null(strstr(page, "changed\"><th"));
    free(page);
}

static int position(const char *page, const char *text)
{
    const char *at = strstr(page, text);
    assert_non_null(at);
    return (int)(at - page);
}

static void stages_are_listed_in_the_given_order(void **state)
{
    static const char USED[] = "x: used 1 s wall, 1 s cpu, 1 MiB peak\n";
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(outfile_make_folders(scratch_path("log"), &err), ST_OK);
    assert_int_equal(outfile_make_folders(scratch_path("slice"), &err), ST_OK);
    scratch_write("log/a_program.x.log", USED);
    scratch_write("log/other.x.log", USED);
    scratch_write("log/rectify.x.log", USED);
    scratch_write("slice/other.cfg", "[other]\na = 1\n");
    scratch_write("slice/rectify.cfg", "[rectify]\na = 1\n");
    char *page = page_of("scene", NULL);
    assert_true(position(page, "<th scope=\"row\">rectify") < position(page, "<th scope=\"row\">other"));
    assert_true(position(page, "<th scope=\"row\">other") < position(page, "<th scope=\"row\">a_program"));
    assert_true(position(page, "<summary><code>rectify") < position(page, "<summary><code>other"));
    assert_non_null(strstr(page, "have not run for this scene: <code>sfm</code>.</li>")); /* report is running */
    free(page);
}

static void a_wrong_list_of_stages_is_refused(void **state)
{
    static const char *const CASES[][2] = {
        {"", "found no name"},
        {"  ", "found no name"},
        {"rectify <b>", "found \"<b>\""},
        {"rectify sfm rectify", "found rectify twice"},
        {"a23456789012345678901234567890123456789012345678901234567890wxyz", "at most 63"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        struct stage_list list = {0};
        struct err err = ERR_INIT;
        assert_int_equal(stage_list_parse(&list, CASES[i][0], &err), ST_USAGE);
        assert_err(err, ST_USAGE, CASES[i][1]);
        assert_int_equal(list.count, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(missing_products_are_listed, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(the_page_of_remodelled_rooms_is_linked_if_there_is_one, scratch_make,
                                        scratch_remove),
        cmocka_unit_test_setup_teardown(things_are_shown_if_there_are_any, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(a_missing_scene_is_an_error, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(photographs_are_shown_and_unlisted_ones_named, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(forms_of_lens_show_the_chosen_one_and_those_refused, scratch_make,
                                        scratch_remove),
        cmocka_unit_test_setup_teardown(changed_parameters_are_marked, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(stages_are_listed_in_the_given_order, scratch_make, scratch_remove),
        cmocka_unit_test(a_wrong_list_of_stages_is_refused),
    };
    return cmocka_run_group_tests_name("page", tests, NULL, NULL);
}
