/* file_path.c - paths are joined whole or not at all. */
#include "common/base/file_path.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "tests/unit/scratch.h"

static void a_path_is_folder_file_and_suffix(void **state)
{
    char path[FILE_PATH];
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(file_path(path, "out/x", "a.b", ".exr", &err), err);
    assert_string_equal(path, "out/x/a.b.exr");
    assert_ok(file_path(path, "out/x", "list.txt", "", &err), err);
    assert_string_equal(path, "out/x/list.txt");
}

/* The longest that fits has FILE_PATH - 1 letters; one letter more, in any of the parts, is refused. */
static void the_longest_fits_and_one_letter_more_does_not(void **state)
{
    char folder[FILE_PATH + 1], path[FILE_PATH];
    const size_t longest = FILE_PATH - 1 - strlen("/f.exr");
    struct err err = ERR_INIT;
    (void)state;
    memset(folder, 'x', sizeof folder);
    folder[longest] = 0;
    assert_ok(file_path(path, folder, "f", ".exr", &err), err);
    assert_int_equal(strlen(path), FILE_PATH - 1);
    assert_memory_equal(path, folder, longest);
    assert_string_equal(path + longest, "/f.exr");
    file_path(path, folder, "ff", ".exr", &err);
    assert_err(err, ST_IO, "the path xxx");
    folder[longest] = 'x';
    folder[longest + 1] = 0;
    err = (struct err)ERR_INIT;
    file_path(path, folder, "f", ".exr", &err);
    assert_err(err, ST_IO, "the path xxx");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_path_is_folder_file_and_suffix),
        cmocka_unit_test(the_longest_fits_and_one_letter_more_does_not),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
