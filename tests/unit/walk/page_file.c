/* page_file.c - the page of a walk holds its parts, and what it shows of names is safe. */
#include "stages/walk/page_file.h"

#include "common/base/file_bytes.h"
#include "stages/walk/data_file.h"
#include "tests/unit/scratch.h"

static char *text_of(const char *path)
{
    struct file_bytes file = {0};
    struct err err = ERR_INIT;
    assert_ok(file_bytes_read(&file, path, &err), err);
    return file.bytes;
}

static void parts_stand_where_the_page_names_them(void **state)
{
    struct err err = ERR_INIT;
    int64_t bytes = 0;
    (void)state;
    scratch_write("index.html",
                  "<h1>@NAME@</h1>\n<link rel=\"stylesheet\" href=\"a.css\">\n<script src=\"b.js\"></script>\n");
    scratch_write("a.css", "p { }\n");
    scratch_write("b.js", "f();\n");
    assert_ok(page_file_write(scratch, scratch_path("out"), "flat", &bytes, &err), err);
    char *page = text_of(scratch_path("out/index.html"));
    assert_string_equal(page, "<h1>flat</h1>\n<style>\np { }\n</style>\n<script>\nf();\n</script>\n");
    assert_int_equal(bytes, strlen(page));
    free(page);
}

static void a_missing_part_leaves_no_page(void **state)
{
    struct err err = ERR_INIT;
    int64_t bytes = 0;
    (void)state;
    scratch_write("index.html", "<script src=\"gone.js\"></script>\n");
    assert_int_equal(page_file_write(scratch, scratch_path("none"), "flat", &bytes, &err), ST_IO);
    assert_non_null(strstr(err.text, "gone.js"));
    assert_int_not_equal(access(scratch_path("none/index.html"), F_OK), 0);
}

/* Names come from files of people: they must end neither the text nor the script. */
static void texts_are_escaped(void **state)
{
    char *text = NULL;
    size_t length;
    (void)state;
    FILE *to = open_memstream(&text, &length);
    data_write_text(to, "a\"b\\c</script>\n");
    data_write_text(to, NULL);
    data_write_numbers(to, (const double[]){0.5, -2}, 2);
    fclose(to);
    assert_string_equal(text, "\"a\\u0022b\\u005cc\\u003c/script>\\u000a\"null[0.5,-2]");
    free(text);
}

static void data_are_a_call(void **state)
{
    struct data_file f;
    struct err err = ERR_INIT;
    int64_t bytes = 0;
    (void)state;
    assert_ok(data_file_open(&f, scratch, "vita", &err), err);
    fputs("[1]", f.fp);
    assert_ok(data_file_commit(&f, &bytes, &err), err);
    data_file_discard(&f);
    char *text = text_of(scratch_path("vita.js"));
    assert_string_equal(text, "walk_take(\"vita\", [1]);\n");
    assert_int_equal(bytes, strlen(text));
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_stand_where_the_page_names_them),
        cmocka_unit_test(a_missing_part_leaves_no_page),
        cmocka_unit_test(texts_are_escaped),
        cmocka_unit_test(data_are_a_call),
    };
    return cmocka_run_group_tests_name("page_file", tests, scratch_make, scratch_remove);
}
