/* colmap_options.c - names of options, from the help of several versions of COLMAP. */
#include "tests/unit/scratch.h"

#include "stages/sfm/colmap_options.h"

static void options_of_3_8_are_those_of_sift(void **state)
{
    (void)state;
    struct colmap_options o;
    assert_true(colmap_options_find(&o, "  --match_type arg (=pairs)\n  --SiftMatching.num_threads arg (=-1)\n"
                                        "  --SiftMatching.use_gpu arg (=1)\n  --SiftMatching.gpu_index arg (=-1)\n"));
    assert_string_equal(o.use_gpu, "--SiftMatching.use_gpu");
    assert_string_equal(o.num_threads, "--SiftMatching.num_threads");
}

static void options_of_3_13_are_those_of_all_features(void **state)
{
    (void)state;
    struct colmap_options o;
    assert_true(colmap_options_find(&o, "  --FeatureMatching.type arg (=SIFT)\n  --FeatureMatching.num_threads arg\n"
                                        "  --FeatureMatching.use_gpu arg (=1)\n  --SiftMatching.max_ratio arg (=0.8)\n"
                                        "  --SiftMatching.cpu_brute_force_matcher arg (=0)\n"));
    assert_string_equal(o.use_gpu, "--FeatureMatching.use_gpu");
    assert_string_equal(o.num_threads, "--FeatureMatching.num_threads");
}

static void a_longer_name_is_another_option(void **state)
{
    (void)state;
    struct colmap_options o;
    assert_false(colmap_options_find(&o, ""));
    assert_false(colmap_options_find(&o, "  --SiftMatching.use_gpu_index arg\n  --SiftMatching.num_threads arg\n"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(options_of_3_8_are_those_of_sift),
        cmocka_unit_test(options_of_3_13_are_those_of_all_features),
        cmocka_unit_test(a_longer_name_is_another_option),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
