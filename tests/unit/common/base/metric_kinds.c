/* metric_kinds.c - exact names come before patterns; variants have the unit of their base. */
#include "common/base/metric_kinds.h"

#include "tests/unit/scratch.h"

static void metrics_are_found_by_name(void **state)
{
    static const struct {
        const char *name, *unit, *direction, *meaning;
    } cases[] = {
        {"depth.error50", "%", "lower", "relative depth error, median"},
        {"depth.within2_visible", "%", "higher", "the same over points that another photograph sees"},
        {"depth.sigma_factor", "1", "none", "factor that would make the stated deviation right"},
        {"depth.sigma_factor_sure", "1", "none", "the same over segments of one confidence"},
        {"depth.share_unsure", "%", "none", "pixels in segments of this confidence"},
        {"model.walls", "m", "lower", "error of a wall, maximum"},
        {"edited.a-b.walls", "m", "lower", "error of a wall, maximum"},
        {"edited.no.ssim", "1", "higher", "structural similarity, mean"},
        {"edited.a.relit_gain_other", "dB", "higher", "the same on other surfaces"},
        {"irradiance.error50_model", "%", "lower", "the same on surfaces that the model has"},
        {"radiance.merged.scale", "1", "none", "true radiance of the photographs' radiance 1"},
        {"texture.vita.psnr_seen", "dB", "higher",
         "PSNR of textures that a photograph shows without clutter, median over faces"},
    };
    static const char *const unknown[] = {"nothing", "", "walls", "model.psnr", "depth.nothing_visible", "novel.walls"};
    struct metric_kind kind;
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        if (!metric_kind_find(&kind, cases[i].name)) fail_msg("%s is unknown", cases[i].name);
        assert_string_equal(kind.unit, cases[i].unit);
        assert_string_equal(kind.direction, cases[i].direction);
        assert_string_equal(kind.meaning, cases[i].meaning);
    }
    for (size_t i = 0; i < sizeof unknown / sizeof *unknown; i++)
        if (metric_kind_find(&kind, unknown[i])) fail_msg("%s is known", unknown[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(metrics_are_found_by_name)};
    return cmocka_run_group_tests_name("metric_kinds", tests, NULL, NULL);
}
