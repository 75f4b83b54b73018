/* metric_rows.c - tables as `evaluate` writes them, and damaged ones. */
#include "stages/report/metric_rows.h"

#include "tests/unit/scratch.h"

static void rows_and_notes_are_read(void **state)
{
    struct metric_rows r;
    struct err err = ERR_INIT;
    (void)state;
    const char *path =
        scratch_write("metrics.tsv", "# remodel evaluate 0.1.0\n# input views/a.exr 12\n# skipped this: why\n"
                                     "# note: sizes\n\n# name\tvalue\tunit\tdirection\n"
                                     "depth.bad1\t12.5\t%\tlower\nholdout.ssim\t1e-3\t1\thigher\n");
    assert_ok(metric_rows_read(&r, path, false, &err), err);
    assert_int_equal(r.count, 2);
    assert_int_equal(r.note_count, 2);
    assert_string_equal(r.notes[0], "skipped this: why");
    assert_string_equal(r.notes[1], "sizes");
    assert_true(metric_rows_find(&r, "", "holdout.ssim")->value == 1e-3);
    assert_string_equal(metric_rows_find(&r, "", "depth.bad1")->unit, "%");
    assert_null(metric_rows_find(&r, "v", "depth.bad1"));
    metric_rows_release(&r);
    metric_rows_release(&r);
    assert_ok(metric_rows_read(&r, scratch_write("views.tsv", "v@1\tdepth.bad1\t0\t%\tlower\n"), true, &err), err);
    assert_non_null(metric_rows_find(&r, "v@1", "depth.bad1"));
    metric_rows_release(&r);
}

static void a_damaged_line_is_named(void **state)
{
    static const char *const bad[] = {"a\tnan\t1\tnone\n", "a\t1\t1\n", "a\t1\t1\tnone\tmore\n",
                                      "a\t1\tmicroscopic-units\tnone\n"};
    (void)state;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct metric_rows r;
        struct err err = ERR_INIT;
        assert_int_equal(metric_rows_read(&r, scratch_write("bad.tsv", bad[i]), false, &err), ST_DATA);
        assert_err(err, ST_DATA, "bad.tsv:1");
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_and_notes_are_read),
        cmocka_unit_test(a_damaged_line_is_named),
    };
    return cmocka_run_group_tests_name("metric_rows", tests, scratch_make, scratch_remove);
}
