/* file_path.c - paths are joined completely or not at all. */
#include "common/base/file_path.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "tests/unit/scratch.h"

static void a_path_joins_folder_file_and_suffix(void **state)
{
    char path[FILE_PATH];
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(file_path(path, "out/x", "a.b", ".exr", &err), err);
    assert_string_equal(path, "out/x/a.b.exr");
    assert_ok(file_path(path, "out/x", "list.txt", "", &err), err);
    assert_string_equal(path, "out/x/list.txt");
}

/* The longest path has FILE_PATH - 1 letters; one more, in any part, is an error. */
static void paths_up_to_the_limit_fit(void **state)
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
        cmocka_unit_test(a_path_joins_folder_file_and_suffix),
        cmocka_unit_test(paths_up_to_the_limit_fit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
