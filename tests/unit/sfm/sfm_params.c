/* sfm_params.c - checks of the parameters. */
#include "tests/unit/scratch.h"

#include "stages/sfm/sfm_params.h"

static void camera_params_must_fit_the_camera_model(void **state)
{
    (void)state;
    static const struct {
        const char *model, *params, *refine, *message; /* message NULL: valid */
    } cases[] = {
        {"SIMPLE_RADIAL", "", "yes", NULL},
        {"SIMPLE_RADIAL", "500,320,240,-0.1", "yes", NULL},
        {"PINHOLE", "500, 510, 320, 2.4e2", "no", NULL},
        {"OPENCV_FISHEYE", "500,500,320,240,0,0,0,0", "no", NULL},
        {"SIMPLE_RADIAL", "", "no", "needs the lens"},
        {"SIMPLE_RADIAL", "500,320,240", "yes", "wanted the 4 numbers of SIMPLE_RADIAL"},
        {"PINHOLE", "500,500,320,240,0", "yes", "wanted the 4 numbers of PINHOLE"},
        {"PINHOLE", "500,500,320,", "yes", "wanted the 4 numbers"},
        {"PINHOLE", "500 500 320 240", "yes", "wanted the 4 numbers"},
        {"PINHOLE", "500,0,320,240", "yes", "focal length is 0"},
        {"PINHOLE", "500,nan,320,240", "yes", "parameter 2"},
        {"EQUISOLID", "", "yes", NULL},
        {"EQUISOLID", "426.7", "no", NULL},
        {"EQUISOLID", "426.7,480,320", "yes", NULL},
        {"EQUISOLID", "", "no", "needs the lens"},
        {"EQUISOLID", "0", "yes", "focal length is 0"},
        {"EQUISOLID", "426.7,480", "yes", "wanted F or F,CX,CY of EQUISOLID"},
        {"EQUISOLID", "426.7,426.7,480,320,0,0,0,0", "yes", "wanted F or F,CX,CY of EQUISOLID"},
        {"EQUISOLID", "wide", "yes", "wanted F or F,CX,CY of EQUISOLID"},
        {"PINHOLE", "1,2,3,4,5,6,7,8,9,10,11,12,13,14", "yes", "wanted the 4 numbers"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct sfm_params p = SFM_PARAMS_DEFAULT;
        struct err err = ERR_INIT;
        snprintf(p.camera_model, sizeof p.camera_model, "%s", cases[i].model);
        snprintf(p.camera_params, sizeof p.camera_params, "%s", cases[i].params);
        snprintf(p.refine_camera, sizeof p.refine_camera, "%s", cases[i].refine);
        if (cases[i].message) {
            assert_int_equal(sfm_params_check(&p, &err), ST_USAGE);
            assert_err(err, ST_USAGE, cases[i].message);
        } else {
            assert_ok(sfm_params_check(&p, &err), err);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(camera_params_must_fit_the_camera_model),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
