/* passing.c - a lack of memory and an error of the disk are refused. A missing or damaged file is not, even if its
 * name has the word memory. */
#include "stages/report/passing.h"

#include <errno.h>

#include "tests/unit/scratch.h"

static bool passes(const char *sentence)
{
    struct err err = ERR_INIT;
    const bool refused = passing_refuse(sentence, &err) != ST_OK;
    assert_int_equal(err.status, refused ? ST_IO : ST_OK);
    if (refused) assert_string_equal(err.text, sentence);
    return refused;
}

static void troubles_that_pass_are_refused(void **state)
{
    static const int reasons[] = {EIO, EMFILE, ENFILE, ENOMEM, ESTALE};
    (void)state;
    for (size_t i = 0; i < sizeof reasons / sizeof *reasons; i++) {
        struct err err = ERR_INIT;
        errno = reasons[i];
        err_errno(&err, "read", "out/t/views/a.exr");
        assert_true(passes(err.text));
    }
    struct err err = ERR_INIT;
    err_nomem(&err, "a frame", 100);
    assert_true(passes(err.text));
    assert_true(passes("cannot read a.exr: Unable to allocate memory."));
    assert_true(passes("a.jpg is damaged (Insufficient memory (case 4))."));
}

static void what_is_missing_or_damaged_is_not(void **state)
{
    (void)state;
    assert_false(passes("cannot open out/memory/parallax/memory-lane/path.txt: No such file or directory."));
    assert_false(passes("out/memory.d/metrics.tsv:3: found \"x\", wanted a number."));
    assert_false(passes("out/t/parallax/orbit/video.mp4 is missing."));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(troubles_that_pass_are_refused),
        cmocka_unit_test(what_is_missing_or_damaged_is_not),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
