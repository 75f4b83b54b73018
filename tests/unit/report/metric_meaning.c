/* metric_meaning.c - every kind of metric has a meaning, and exact names come before patterns. */
#include "stages/report/metric_meaning.h"

#include "tests/unit/scratch.h"

static void metrics_of_every_group_have_a_meaning(void **state)
{
    static const char *const names[] = {
        "depth.within2",    "depth.sigma1_sure", "depth.share_unsure",  "model.faces",        "edited.a-b.walls",
        "novel.psnr",       "edited.no.ssim",    "radiance.rms",        "irradiance.error50", "radiance.scale",
        "shell.rms_hidden", "axes.up",           "edited.a.relit_psnr", "edited.a.unlit_psnr"};
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (!metric_meaning(names[i])[0]) fail_msg("%s has no meaning", names[i]);
    assert_string_equal(metric_meaning("nothing"), "");
    assert_string_equal(metric_meaning("depth.error50"), "relative depth error, median");
    assert_string_equal(metric_meaning("edited.a.relit_gain_other"), "the same on other surfaces");
    assert_string_equal(metric_meaning("irradiance.error50_model"), "the same on surfaces that the model has");
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(metrics_of_every_group_have_a_meaning)};
    return cmocka_run_group_tests_name("metric_meaning", tests, NULL, NULL);
}
