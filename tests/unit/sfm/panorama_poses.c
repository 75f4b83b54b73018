/* panorama_poses.c - poses of panoramas, as transforms.json and Metashape state them, become poses of their views. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "common/math/numbers.h"
#include "stages/sfm/metashape_model.h"
#include "stages/sfm/panorama_poses.h"
#include "stages/sfm/transforms_model.h"

enum { SIDE = 652, PHOTOS = 5 };

static char ids[PHOTOS][24] = {"a", "hall_1_yaw000", "hall_1_yaw060", "hall_1_yaw240", "other_yaw000"};
static char files[PHOTOS][32] = {"a.jpg", "hall_1_yaw000.png", "hall_1_yaw060.png", "hall_1_yaw240.png",
                                 "other_yaw000.png"};
static struct photo_record records[PHOTOS];
static const struct photo_list photos = {records, PHOTOS};

static int set_up(void **state)
{
    for (int i = 0; i < PHOTOS; i++)
        records[i] = (struct photo_record){
            .id = ids[i], .file = files[i], .info = {.width = i ? SIDE : 640, .height = i ? SIDE : 480}};
    return scratch_make(state);
}

/* The panorama "hall 1.jpg" is at (1, 2, 3); its middle looks along the world's +y, its upper side is +z. So its right
 * is +x. A view that is turned to the right by N degrees sees what lies in (sin N, cos N, 0). */
static void check(const struct sfm_model *m)
{
    static const int yaws[] = {0, 60, 240};
    assert_int_equal(m->image_count, 4);
    assert_int_equal(m->point_count, 0);
    for (int i = 0; i < 3; i++) {
        const struct sfm_image *im = &m->images[i + 1];
        const struct camera *c = &m->cameras[im->camera_idx].camera;
        const double n = yaws[i] * DEGREE;
        double u, v;
        assert_string_equal(im->name, files[i + 1]);
        assert_true(c->model == CAMERA_PINHOLE && c->width == SIDE && c->height == SIDE && c->params[0] == SIDE / 2);
        assert_true(vec3_length(vec3_sub(pose_center(&im->cam_from_world), vec3_make(1, 2, 3))) < 1e-12);
        /* ahead, half to the right, a quarter up */
        const struct vec3 point = vec3_make(1 + sin(n) + 0.5 * cos(n), 2 + cos(n) - 0.5 * sin(n), 3 + 0.25);
        assert_true(camera_project(c, pose_apply(&im->cam_from_world, point), &u, &v));
        assert_true(fabs(u - 0.75 * SIDE) < 1e-9 && fabs(v - 0.375 * SIDE) < 1e-9);
    }
}

static void read_and_check(enum status (*read)(struct sfm_model *, bool *, const char *, const struct photo_list *,
                                               struct provenance *, struct err *),
                           const char *name, const char *text)
{
    struct sfm_model m;
    struct err err = ERR_INIT;
    bool found = false;
    int replaced = 0;
    scratch_write(name, text);
    assert_ok(read(&m, &found, scratch, &photos, NULL, &err), err);
    unlink(scratch_path(name));
    assert_true(found);
    assert_int_equal(m.image_count, 2);
    assert_ok(panorama_poses_expand(&replaced, &m, &photos, &err), err);
    assert_int_equal(replaced, 1);
    check(&m);
    sfm_model_release(&m);
}

static void transforms_may_be_of_panoramas(void **state)
{
    (void)state;
    read_and_check(transforms_model_read, "transforms.json",
                   "{\"fl_x\": 500, \"frames\": [{\"file_path\": \"a.jpg\", \"transform_matrix\": "
                   "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}, {\"file_path\": \"x\\\\hall 1.jpg\", \"camera_model\": "
                   "\"EQUIRECTANGULAR\", \"transform_matrix\": [[1,0,0,1],[0,0,-1,2],[0,1,0,3],[0,0,0,1]]}]}");
}

static void sensors_of_metashape_may_be_spherical(void **state)
{
    (void)state;
    read_and_check(metashape_model_read, "cameras.xml",
                   "<document><chunk><sensors><sensor id=\"1\" type=\"spherical\"><resolution width=\"2048\" "
                   "height=\"1024\"/></sensor><sensor id=\"2\"><resolution width=\"640\" height=\"480\"/><calibration>"
                   "<f>500</f></calibration></sensor></sensors><cameras><camera sensor_id=\"1\" label=\"hall 1\">"
                   "<transform>1 0 0 1 0 0 1 2 0 -1 0 3 0 0 0 1</transform></camera><camera sensor_id=\"2\" "
                   "label=\"a\"><transform>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</transform></camera></cameras></chunk>"
                   "</document>");
}

/* COLMAP has no lens for panoramas, so that any one stands there. Points of a panorama's pixels go. */
static void models_of_colmap_name_panoramas(void **state)
{
    struct sfm_model m;
    struct err err = ERR_INIT;
    int replaced = 0;
    (void)state;
    scratch_write("cameras.txt", "1 SIMPLE_PINHOLE 2048 1024 300 1024 512\n");
    /* from world to camera: x = x - 1, y = 3 - z, z = y - 2 */
    scratch_write("images.txt", "1 0.70710678118654757 0.70710678118654757 0 0 -1 3 -2 1 hall 1.jpg\n10 20 5\n"
                                "2 1 0 0 0 0 0 0 1 a.jpg\n30 40 5\n");
    scratch_write("points3D.txt", "5 0 0 5 1 2 3 0.5 1 0 2 0\n");
    assert_ok(sfm_model_read_text(&m, scratch, NULL, &err), err);
    assert_ok(panorama_poses_expand(&replaced, &m, &photos, &err), err);
    assert_int_equal(replaced, 1);
    check(&m);
    sfm_model_release(&m);
}

static void other_models_stay(void **state)
{
    struct sfm_model m;
    struct err err = ERR_INIT;
    int replaced = 1;
    (void)state;
    scratch_write("cameras.txt", "1 SIMPLE_PINHOLE 640 480 300 320 240\n");
    scratch_write("images.txt", "1 1 0 0 0 0 0 0 1 hall_1_yaw060.png\n10 20 5\n2 1 0 0 0 0 0 0 1 b.jpg\n30 40 5\n");
    scratch_write("points3D.txt", "5 0 0 5 1 2 3 0.5 1 0 2 0\n");
    assert_ok(sfm_model_read_text(&m, scratch, NULL, &err), err);
    assert_ok(panorama_poses_expand(&replaced, &m, &photos, &err), err);
    assert_true(replaced == 0 && m.image_count == 2 && m.point_count == 1);
    sfm_model_release(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transforms_may_be_of_panoramas),
        cmocka_unit_test(sensors_of_metashape_may_be_spherical),
        cmocka_unit_test(models_of_colmap_name_panoramas),
        cmocka_unit_test(other_models_stay),
    };
    return cmocka_run_group_tests_name("panorama_poses", tests, set_up, scratch_remove);
}
