/* A page is made of whatever there is: of nothing, of a real photograph with an odd name, of parameters that differ. */
#include "stages/report/page.h"

#include "tests/unit/scratch.h"

#include "common/base/outfile.h"

static char *page_of(const char *scene, const char *defaults)
{
    struct contents c = {0};
    struct err err = ERR_INIT;
    char *text = NULL;
    size_t size;
    FILE *to = open_memstream(&text, &size);
    assert_int_equal(contents_read(&c, scratch, scratch, scratch_path("originals"), defaults, &err), ST_OK);
    assert_int_equal(page_write(to, scene, &c, &err), ST_OK);
    fclose(to);
    contents_release(&c);
    contents_release(&c);
    return text;
}

static void says_what_is_missing(void **state)
{
    char *page = page_of("<b>&", NULL);
    (void)state;
    assert_non_null(strstr(page, "<h1>&lt;b&gt;&amp;</h1>"));
    assert_null(strstr(page, "<b>&"));
    assert_non_null(strstr(page, "No camera move was planned yet"));
    assert_non_null(strstr(page, "There are no views yet."));
    assert_non_null(strstr(page, "There is no list of photographs."));
    assert_non_null(strstr(page, "No stage left a log."));
    assert_null(strstr(page, "http://"));
    assert_null(strstr(page, "https://"));
    free(page);
}

static void a_missing_scene_is_an_error(void **state)
{
    struct contents c = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(contents_read(&c, scratch_path("no-such-scene"), scratch, scratch, NULL, &err), ST_IO);
    assert_non_null(strstr(err.text, "no-such-scene"));
    contents_release(&c);
}

static void shows_photographs_and_names_those_left_out(void **state)
{
    static const unsigned char GREY[6 * 4 * 3] = {0};
    char id[] = "a_b", file[] = "a <b>.jpg";
    struct photo_record r = {.id = id, .file = file, .info = {.width = 6, .height = 4, .bits = 8, .orientation = 1}};
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(make_folders(scratch_path("photos"), &err), ST_OK);
    assert_int_equal(make_folders(scratch_path("originals"), &err), ST_OK);
    assert_int_equal(jpeg_write(scratch_path("originals/a <b>.jpg"), GREY, 6, 4, 90, &err), ST_OK);
    assert_int_equal(jpeg_write(scratch_path("originals/unused.JPG"), GREY, 6, 4, 90, &err), ST_OK);
    assert_int_equal(hash_file(r.hash, scratch_path("originals/a <b>.jpg"), &err), ST_OK);
    assert_int_equal(photo_record_write(&r, scratch_path("photos"), &err), ST_OK);
    scratch_write("photos/list.txt", "a_b \"a <b>.jpg\"\n");

    char *page = page_of("scene", NULL);
    assert_non_null(strstr(page, "alt=\"Photograph a &lt;b&gt;.jpg\" src=\"data:image/jpeg;base64,/9j/"));
    assert_non_null(strstr(page, "<b>unused.JPG</b> stands in the folder"));
    assert_null(strstr(page, "not placed by SfM")); /* nobody tried yet */
    free(page);
}

static void marks_parameters_that_differ(void **state)
{
    struct err err = ERR_INIT;
    (void)state;
    assert_int_equal(make_folders(scratch_path("slice"), &err), ST_OK);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(says_what_is_missing, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(a_missing_scene_is_an_error, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(shows_photographs_and_names_those_left_out, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(marks_parameters_that_differ, scratch_make, scratch_remove),
    };
    return cmocka_run_group_tests_name("page", tests, NULL, NULL);
}
