/* given_house.c - given cameras of a real house, for developers who have ../shared/data/zind-open: views that were cut
 * from panoramas, with few points of mostly two views each. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "stages/sfm_import/refine_cameras.h"

#define HOUSE "../shared/data/zind-open/"

static void refined_views_of_a_panorama_keep_their_centre_and_place(void **state)
{
    struct sfm_model model = {0}, truth = {0};
    struct refinement r;
    struct sfm_import_params params = SFM_IMPORT_PARAMS_DEFAULT;
    struct err err = ERR_INIT;
    FILE *there = fopen(HOUSE "sfm/images.txt", "r");
    double worst = 0;
    (void)state;
    if (!there) {
        print_message(HOUSE " does not exist: skipped\n");
        skip();
    }
    fclose(there);
    assert_ok(sfm_model_read_text(&model, HOUSE "sfm", NULL, &err), err);
    assert_ok(sfm_model_read_cameras(&truth, HOUSE "truth", NULL, &err), err);
    snprintf(params.refine, sizeof params.refine, "yes");
    assert_ok(refine_cameras(&r, &model, GIVEN_MODEL, (struct split_size){0}, &params, &err), err);
    assert_int_equal(model.image_count, truth.image_count);
    assert_true(!r.shifts && model.camera_count == 1);
    for (int i = 0; i < model.image_count; i++) {
        const struct vec3 a = pose_center(&model.images[i].cam_from_world);
        assert_string_equal(model.images[i].name, truth.images[i].name);
        worst = fmax(worst, vec3_length(vec3_sub(a, pose_center(&truth.images[i].cam_from_world))));
        for (int k = 0; k < i; k++) { /* names are pano_N_pANGLE.jpg */
            const size_t same = (size_t)(strrchr(model.images[i].name, '_') - model.images[i].name) + 1;
            if (strncmp(model.images[i].name, model.images[k].name, same)) continue;
            assert_true(vec3_length(vec3_sub(a, pose_center(&model.images[k].cam_from_world))) < 1e-4);
        }
    }
    print_message("largest distance from a true centre: %.1f cm\n", 100 * worst);
    assert_true(worst < 0.06);
    refine_cameras_release(&r);
    sfm_model_release(&model);
    sfm_model_release(&truth);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(refined_views_of_a_panorama_keep_their_centre_and_place),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
