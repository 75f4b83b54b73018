/* metric_table.c - the text of the tables: sorted, with notes, never a NaN. */
#include "stages/evaluate/measure/metric_table.h"

#include <math.h>

#include "tests/unit/scratch.h"

static void tables_are_sorted_and_finite(void **state)
{
    struct metric_table t = {0};
    struct err err = ERR_INIT, undeclared = ERR_INIT;
    (void)state;
    assert_ok(metric_add(&t, NULL, "holdout.psnr", 1.0 / 3, &err), err);
    assert_ok(metric_add(&t, "v2", "depth.bad1", 12.5, &err), err);
    assert_ok(metric_add(&t, NULL, "camera.scale", -0.0, &err), err);
    assert_ok(metric_add(&t, "v10", "depth.bad1", 1e-10, &err), err);
    assert_ok(metric_note(&t, &err, "skipped %s: two\nlines", "this"), err);
    assert_ok(metric_table_write(&t, false, scratch_path("metrics.tsv"), NULL, &err), err);
    assert_file_text(scratch_path("metrics.tsv"), "# skipped this: two lines\n# name\tvalue\tunit\tdirection\n"
                                                  "camera.scale\t0\tm\tnone\nholdout.psnr\t0.333333333\tdB\thigher\n");
    assert_ok(metric_table_write(&t, true, scratch_path("views.tsv"), NULL, &err), err);
    assert_file_text(scratch_path("views.tsv"), "# view\tname\tvalue\tunit\tdirection\n"
                                                "v10\tdepth.bad1\t1e-10\t%\tlower\nv2\tdepth.bad1\t12.5\t%\tlower\n");
    assert_int_equal(metric_add(&t, NULL, "x", NAN, &err), ST_INTERNAL);
    assert_err(err, ST_INTERNAL, "no finite value");
    assert_int_equal(metric_add(&t, NULL, "x", 1, &undeclared), ST_INTERNAL);
    assert_err(undeclared, ST_INTERNAL, "the metric x is not declared");
    assert_int_equal(metric_add(&t, NULL, "x", INFINITY, &err), ST_INTERNAL);
    metric_table_release(&t);
    metric_table_release(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(tables_are_sorted_and_finite)};
    return cmocka_run_group_tests_name("metric_table", tests, scratch_make, scratch_remove);
}
