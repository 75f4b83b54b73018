/* page.c - the two pages of an empty scene, of a photograph with an odd name, of changed parameters, of some stages. */
#include "stages/report/page.h"

#include "tests/unit/report/scratch_page.h"
#include "tests/unit/scratch.h"

#include "common/base/outfile.h"

/* The page of numbers, or the one for people, of the scratch folder; the caller frees it. */
static char *any_page(const char *scene, const char *defaults, bool numbers)
{
    const struct contents_sources from = {.folder = scratch,
                                          .shared = scratch,
                                          .photos = scratch_path("originals"),
                                          .stages = "rectify sfm other report",
                                          .defaults = defaults};
    return scratch_page_of(&from, scene, numbers);
}

static char *page_of(const char *scene, const char *defaults) { return any_page(scene, defaults, true); }

static char *people_page(const char *scene) { return any_page(scene, NULL, false); }

static void missing_products_are_listed(void **state)
{
    char *page = page_of("<b>&", NULL);
    (void)state;
    assert_non_null(strstr(page, "<h1>&lt;b&gt;&amp;, in numbers</h1>"));
    assert_null(strstr(page, "<b>&"));
    assert_non_null(strstr(page, "No camera move has been planned yet"));
    assert_non_null(strstr(page, "There are no views yet."));
    assert_non_null(strstr(page, "There is no list of photographs."));
    assert_non_null(strstr(page, "There are no logs."));
    assert_null(strstr(page, "http://"));
    assert_null(strstr(page, "https://"));
    free(page);
}

static void an_empty_scene_has_a_page_for_people(void **state)
{
    char *page = people_page("<b>&");
    (void)state;
    assert_contains(page, "<h1>&lt;b&gt;&amp;</h1>");
    assert_contains(page, "No film has been made yet.");
    assert_contains(page, "No photographs are listed yet.");
    assert_contains(page, "<a href=\"page/numbers.html\">How it was made, in numbers</a>");
    assert_lacks(page, "id=\"rooms\"");
    assert_lacks(page, "id=\"few-numbers\"");
    assert_lacks(page, "http://");
    assert_lacks(page, "https://");
    free(page);
}

static void other_pages_are_linked_if_they_exist(void **state)
{
    static const char *const links[][2] = {{"remodel", "href=\"remodel/index.html\">All about each change</a>"},
                                           {"walk", "href=\"walk/index.html\">Walk through the rooms</a>"},
                                           {"draw", "href=\"draw/index.html\">Draw on the photographs</a>"}};
    (void)state;
    for (int i = 0; i < 3; i++) {
        struct err err = ERR_INIT;
        char name[64];
        char *page = people_page("scene");
        assert_lacks(page, links[i][1]);
        free(page);
        assert_ok(outfile_make_folders(scratch_path(links[i][0]), &err), err);
        snprintf(name, sizeof name, "%s/index.html", links[i][0]);
        scratch_write(name, "");
        page = people_page("scene");
        assert_contains(page, links[i][1]);
        free(page);
    }
}

static void films_are_linked_and_named_in_ordinary_words(void **state)
{
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(outfile_make_folders(scratch_path("parallax/dolly_zoom+pull_focus"), &err), err);
    assert_ok(outfile_make_folders(scratch_path("relight/no-wall/tour"), &err), err);
    scratch_write("parallax/dolly_zoom+pull_focus/video.mp4", "film");
    scratch_write("relight/no-wall/tour/video.mp4", "film");
    char *page = people_page("scene");
    assert_contains(page, "src=\"parallax/dolly_zoom%2Bpull_focus/video.mp4\"");
    assert_contains(page, "The camera moves while it zooms the other way");
    assert_contains(page, "src=\"relight/no-wall/tour/video.mp4\"");
    assert_contains(page, "A walk through the rooms after the change: no wall, in the new light");
    free(page);
}

static void scores_have_ordinary_names(void **state)
{
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(outfile_make_folders(scratch_path("parallax/dolly_in/path"), &err), err);
    scratch_write("parallax/dolly_in/path/cameras.txt", "1 PINHOLE 6 4 5 5 3 2\n");
    scratch_write("parallax/dolly_in/path/images.txt", "1 1 0 0 0 0 0 0 1 0001.exr\n\n");
    scratch_write("parallax/dolly_in/path/points3D.txt", "");
    scratch_write("parallax/dolly_in/path.txt", "remodel-path 1\neffect dolly_in\nfps 30\nscore worst_h 1.5 \"\"\n"
                                                "score length_of_thesis 2 \"scene units\"\nscore shot_1 3 s\n"
                                                "frames 1\nframe 0001 0 0 0\n");
    char *page = page_of("scene", NULL);
    assert_contains(page, "<dt>largest holes</dt><dd>1.5 </dd><dd class=\"under\">how large the gaps");
    assert_contains(page, "<dt>length by the coarse search</dt><dd>2 scene units</dd>");
    assert_contains(page, "<dt>shot 1</dt><dd>3 s</dd></div>");
    assert_lacks(page, "thesis");
    assert_lacks(page, "worst h");
    free(page);
}

static void a_picture_is_written_once_and_old_ones_are_removed(void **state)
{
    static unsigned char grey[6 * 4 * 3];
    const struct picture p = {6, 4, grey};
    struct page page;
    struct err err = ERR_INIT;
    char *text, folder[PATH_MAX], first[PICTURE_NAME], second[PICTURE_NAME], third[PICTURE_NAME];
    size_t size;
    (void)state;
    scratch_page_begin(&page, &text, &size, folder, "page/", "");
    assert_ok(page_write_picture(&page, &p, 80, first, &err), err);
    assert_ok(page_write_picture(&page, &p, 80, second, &err), err);
    grey[0] = 9;
    assert_ok(page_write_picture(&page, &p, 0, third, &err), err);
    assert_string_equal(first, second);
    assert_string_not_equal(first, third);
    assert_int_equal(page.pictures.count, 2);
    scratch_write("page/0123456789abcdef-8.jpg", "of an older page");
    scratch_write("page/numbers.html", "");
    page_remove_old(folder, &page.pictures);
    char name[128];
    snprintf(name, sizeof name, "page/%s", third);
    assert_int_equal(access(scratch_path(name), F_OK), 0);
    assert_int_not_equal(access(scratch_path("page/0123456789abcdef-8.jpg"), F_OK), 0);
    assert_int_equal(access(scratch_path("page/numbers.html"), F_OK), 0);
    scratch_page_end(&page);
    free(text);
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
    assert_contains(page, "src=\"../things/sheet.svg\"");
    assert_lacks(page, "Plan of the rooms");
    free(page);
    scratch_write("things/plan.svg", "<svg></svg>");
    page = page_of("scene", NULL);
    assert_contains(page, "alt=\"Plan of the rooms with all things\" src=\"../things/plan.svg\"");
    free(page);
}

static void a_missing_scene_is_an_error(void **state)
{
    const struct contents_sources from = {
        .folder = scratch_path("no-such-scene"), .shared = scratch, .photos = scratch, .stages = "rectify"};
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

    char *page = people_page("scene");
    assert_contains(page,
                    "<img loading=\"lazy\" width=\"6\" height=\"4\" alt=\"Photograph a &lt;b&gt;.jpg\" src=\"page/");
    assert_lacks(page, "could not be placed"); /* there are no views yet */
    free(page);
    page = page_of("scene", NULL);
    assert_contains(page, "<b>unused.JPG</b> is in the folder");
    assert_contains(page, "P3 &amp; more");
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
        cmocka_unit_test_setup_teardown(an_empty_scene_has_a_page_for_people, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(other_pages_are_linked_if_they_exist, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(films_are_linked_and_named_in_ordinary_words, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(scores_have_ordinary_names, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(a_picture_is_written_once_and_old_ones_are_removed, scratch_make,
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
