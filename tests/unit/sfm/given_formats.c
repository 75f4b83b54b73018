/* given_formats.c - cameras in transforms.json, Metashape's XML and RealityScan's CSV: poses and lenses of a known
 * camera, and errors that name the user's file. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "stages/sfm/csv_model.h"
#include "stages/sfm/metashape_model.h"
#include "stages/sfm/transforms_model.h"

#define assert_near(a, b, tolerance) assert_true(fabs((a) - (b)) <= (tolerance))

static char ids[2][2] = {"a", "b"}, files[2][8] = {"a.jpg", "b.png"};
static struct photo_record records[] = {
    {.id = ids[0], .file = files[0], .info = {.width = 640, .height = 480}},
    {.id = ids[1], .file = files[1], .info = {.width = 640, .height = 480}},
};
static const struct photo_list photos = {records, 2};

typedef enum status reader(struct sfm_model *m, bool *found, const char *folder, const struct photo_list *photos,
                           struct provenance *prov, struct err *err);

/* Reads a folder with one file. */
static enum status read_as(reader *read, struct sfm_model *m, const char *name, const char *text, struct err *err)
{
    bool found = false;
    *err = (struct err)ERR_INIT;
    scratch_write(name, text);
    read(m, &found, scratch, &photos, NULL, err);
    unlink(scratch_path(name));
    if (!err->status) assert_true(found);
    return err->status;
}

/* Camera a is at (1, 2, 3) and looks along the world's +y; the top of its picture is towards +z. So its x axis is +x,
 * its y axis -z. A point 10 ahead, 2 to the right and 1 up has the plane coordinates (0.2, -0.1). */
static void check_a(const struct sfm_model *m, double u, double v, double scale, struct vec3 offset)
{
    const struct sfm_image *im = &m->images[0];
    double at[2];
    const struct vec3 point = vec3_add(vec3_scale(vec3_make(1 + 2, 2 + 10, 3 + 1), scale), offset);
    const struct vec3 center = vec3_add(vec3_scale(vec3_make(1, 2, 3), scale), offset);
    assert_int_equal(m->image_count, 2);
    assert_non_null(strchr(im->name, 'a'));
    assert_near(vec3_length(vec3_sub(pose_center(&im->cam_from_world), center)), 0, 1e-9);
    assert_true(
        camera_project(&m->cameras[im->camera_idx].camera, pose_apply(&im->cam_from_world, point), &at[0], &at[1]));
    assert_near(at[0], u, 1e-8);
    assert_near(at[1], v, 1e-8);
}

#define POSES                                                                 \
    "\"frames\": [{\"file_path\": \"./images/a.jpg\", \"transform_matrix\": " \
    "[[1,0,0,1],[0,0,-1,2],[0,1,0,3],[0,0,0,1]]},"                            \
    "{\"file_path\": \"images\\\\b\", \"transform_matrix\": [[1,0,0,5],[0,1,0,6],[0,0,1,7]]}]}"

static void transforms_have_axes_of_opengl(void **state)
{
    (void)state;
    struct sfm_model m;
    struct err err;
    const double x = 0.2, y = -0.1, s = x * x + y * y, g = 1 - 0.1 * s + 0.02 * s * s;
    assert_ok(read_as(transforms_model_read, &m, "transforms.json",
                      "\xEF\xBB\xBF{\"w\": 640, \"h\": 480, \"fl_x\": 500, \"fl_y\": 510, \"cx\": 322, \"cy\": 239,"
                      "\"k1\": -0.1, \"k2\": 0.02, \"p1\": 0.001, \"p2\": -0.002, \"camera_model\": \"OPENCV\", " POSES,
                      &err),
              err);
    check_a(&m, 322 + 500 * (x * g + 2 * 0.001 * x * y - 0.002 * (s + 2 * x * x)),
            239 + 510 * (y * g + 0.001 * (s + 2 * y * y) - 2 * 0.002 * x * y), 1, vec3_make(0, 0, 0));
    assert_string_equal(m.images[1].name, "images\\b");
    sfm_model_release(&m);

    /* a field of view, the middle, and the photos' size */
    assert_ok(read_as(transforms_model_read, &m, "transforms_train.json", "{\"camera_angle_x\": 1.2, " POSES, &err),
              err);
    const double f = 320 / tan(0.6);
    check_a(&m, 320 + f * x, 240 + f * y, 1, vec3_make(0, 0, 0));
    assert_int_equal(m.cameras[0].camera.model, CAMERA_PINHOLE);
    sfm_model_release(&m);

    /* fisheyes, without and with tangential terms; a third coefficient of a lens that is none */
    const double t = atan(hypot(x, y)), r = t * (1 + 0.05 * t * t), h = r / hypot(x, y);
    assert_ok(read_as(transforms_model_read, &m, "transforms.json",
                      "{\"fl_x\": 300, \"is_fisheye\": true, \"k1\": 0.05, " POSES, &err),
              err);
    check_a(&m, 320 + 300 * x * h, 240 + 300 * y * h, 1, vec3_make(0, 0, 0));
    assert_int_equal(m.cameras[0].camera.model, CAMERA_OPENCV_FISHEYE);
    sfm_model_release(&m);
    assert_ok(read_as(transforms_model_read, &m, "transforms.json",
                      "{\"fl_x\": 300, \"camera_model\": \"OPENCV_FISHEYE\", \"k3\": 0.3, \"p2\": 0.01, " POSES, &err),
              err);
    const double a = x * t / hypot(x, y), b = y * t / hypot(x, y), t2 = t * t;
    check_a(&m, 320 + 300 * (a * (1 + 0.3 * t2 * t2 * t2) + 0.01 * (t2 + 2 * a * a)),
            240 + 300 * (b * (1 + 0.3 * t2 * t2 * t2) + 2 * 0.01 * a * b), 1, vec3_make(0, 0, 0));
    sfm_model_release(&m);
    assert_ok(read_as(transforms_model_read, &m, "transforms.json", "{\"fl_x\": 500, \"k3\": 0.3, " POSES, &err), err);
    check_a(&m, 320 + 500 * x * (1 + 0.3 * s * s * s), 240 + 500 * y * (1 + 0.3 * s * s * s), 1, vec3_make(0, 0, 0));
    sfm_model_release(&m);
}

static void what_is_wrong_with_transforms_is_named(void **state)
{
    (void)state;
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"{\"fl_x\": 500,\n\"frames\": [}", "transforms.json:2: this is not JSON"},
        {"{\"fl_x\": NaN}", "transforms.json:1: this is not JSON"},
        {"{\"frames\": []}", "transforms.json has no list \"frames\""},
        {"[1]", "transforms.json has no list \"frames\""},
        {"{\"frames\": [{}]}", "transforms.json: frame 1 has no \"file_path\""},
        {"{" POSES, "transforms.json: frame 1 (\"./images/a.jpg\") has no focal length"},
        {"{\"fl_x\": \"500\", " POSES, "\"fl_x\" is not a number"},
        {"{\"fl_x\": 500, \"k4\": 0.1, " POSES, "has a fourth radial coefficient, k4 = 0.1"},
        {"{\"fl_x\": 500, \"camera_model\": \"CUBEMAP\", " POSES, "its camera_model is CUBEMAP"},
        {"{\"camera_model\": \"EQUIRECTANGULAR\", " POSES, "is a panorama, but its photo a.jpg is not taken for one"},
        {"{\"fl_x\": 500, \"frames\": [{\"file_path\": \"a.jpg\"}]}", "(\"a.jpg\"): its transform_matrix is missing"},
        {"{\"fl_x\": 500, \"frames\": [{\"file_path\": \"a.jpg\", \"transform_matrix\": "
         "[[1,0,0,0],[0,1,0,0],[0,0,-1,0],[0,0,0,1]]}]}",
         "a pose that is not a rotation"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct sfm_model m;
        struct err err;
        assert_int_equal(read_as(transforms_model_read, &m, "transforms.json", cases[i].text, &err), ST_DATA);
        assert_err(err, ST_DATA, cases[i].words);
        assert_int_equal(m.image_count + m.camera_count, 0);
    }
}

static void depth_that_transforms_name_is_linked(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    int count = 0;
    scratch_write("transforms.json", "{\"fl_x\": 500, \"integer_depth_scale\": 0.0025, \"frames\": ["
                                     "{\"file_path\": \"images/a.jpg\", \"depth_path\": \"images/a.depth.PNG\"},"
                                     "{\"file_path\": \"images/b.png\", \"depth_path\": \"images/missing.png\"},"
                                     "{\"file_path\": \"images/c.png\", \"depth_path\": \"images/a.depth.PNG\"}]}");
    mkdir(scratch_path("images"), 0777);
    scratch_write("images/a.depth.PNG", "depth");
    for (int k = 0; k < 2; k++) { /* also over an older folder */
        assert_ok(transforms_link_depth(&count, scratch_path("depth"), scratch, &photos, &err), err);
        assert_int_equal(count, 1);
        assert_file_text(scratch_path("depth/a.png"), "depth");
        assert_file_text(scratch_path("depth/depth.txt"), "scale 0.0025\npixels photo\n");
        assert_int_equal(count_entries(scratch_path("depth")), 2);
    }
    /* nerfstudio's words; millimetres are its default, and only of whole numbers */
    scratch_write("images/b.exr", "depth");
    scratch_write("transforms.json",
                  "{\"frames\": [{\"file_path\": \"a\", \"depth_file_path\": \"images/a.depth.PNG\"}]}");
    assert_ok(transforms_link_depth(&count, scratch_path("depth"), scratch, &photos, &err), err);
    assert_file_text(scratch_path("depth/depth.txt"), "scale 0.001\npixels photo\n");
    scratch_write("transforms.json", "{\"frames\": [{\"file_path\": \"b\", \"depth_file_path\": \"images/b.exr\"}]}");
    assert_ok(transforms_link_depth(&count, scratch_path("depth"), scratch, &photos, &err), err);
    assert_file_text(scratch_path("depth/depth.txt"), "pixels photo\n");
    scratch_write("transforms.json", "{\"frames\": [{\"file_path\": \"b\"}]}");
    assert_ok(transforms_link_depth(&count, scratch_path("depth"), scratch, &photos, &err), err);
    assert_int_equal(count, 0);
    assert_int_equal(access(scratch_path("depth"), F_OK), -1);
    unlink(scratch_path("transforms.json"));
    assert_ok(transforms_link_depth(&count, scratch_path("depth"), scratch, &photos, &err), err);
    assert_int_equal(count, 0);
}

/* ------------------------------------------------------------------------------------------------------ Metashape */

/* A document: the type of its sensor, the body of its calibration, what precedes its cameras. */
static const char *document(const char *type, const char *calibration, const char *components)
{
    static char text[4096];
    snprintf(text, sizeof text,
             "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<document version=\"2.1.0\">\n<chunk label=\"1\">\n"
             "<sensors>\n<sensor id=\"3\" type=\"%s\">\n<resolution width=\"640\" height=\"480\"/>\n"
             "<calibration class=\"adjusted\">%s</calibration>\n"
             "<calibration class=\"initial\"><k1>0</k1></calibration>\n</sensor>\n</sensors>\n%s<cameras>\n"
             "<camera id=\"0\" sensor_id=\"3\" component_id=\"0\" label=\"a.jpg\"><transform>\n"
             "1 0 0 1 0 0 1 2 0 -1 0 3 0 0 0 1</transform></camera>\n"
             "<group id=\"1\"><camera id=\"1\" sensor_id=\"3\" label=\"b\"><transform>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1"
             "</transform></camera></group>\n<camera id=\"2\" sensor_id=\"3\" label=\"c\"/>\n</cameras>\n"
             "<transform><rotation>nonsense</rotation></transform>\n</chunk>\n</document>\n",
             type, calibration, components);
    return text;
}

static void metashape_has_its_own_lens(void **state)
{
    (void)state;
    struct sfm_model m;
    struct err err;
    const double x = 0.2, y = -0.1, s = x * x + y * y, g = 1 - 0.1 * s + 0.02 * s * s + 0.3 * s * s * s;
    const double xd = x * g + 0.001 * (s + 2 * x * x) - 2 * 0.002 * x * y;
    const double yd = y * g - 0.002 * (s + 2 * y * y) + 2 * 0.001 * x * y;
    assert_ok(read_as(metashape_model_read, &m, "cameras.xml",
                      document("frame",
                               "<f>500</f><cx>2</cx><cy>-1</cy><b1>10</b1><b2>0</b2><k1>-0.1</k1><k2>0.02</k2>"
                               "<k3>0.3</k3><p1>0.001</p1><p2>-0.002</p2>",
                               ""),
                      &err),
              err);
    check_a(&m, 322 + 510 * xd, 239 + 500 * yd, 1, vec3_make(0, 0, 0));
    sfm_model_release(&m);

    /* a component that is turned by 90 degrees about z, scaled and moved: the camera looks along -x then */
    assert_ok(read_as(metashape_model_read, &m, "CAMERAS.XML",
                      document("frame", "<f>500</f>",
                               "<components><component id=\"0\"><transform><rotation>0 -1 0 1 0 0 0 0 1</rotation>"
                               "<translation>7 8 9</translation><scale>2</scale></transform></component></components>"),
                      &err),
              err);
    const struct vec3 center = pose_center(&m.images[0].cam_from_world);
    assert_near(vec3_length(vec3_sub(center, vec3_make(7 - 4, 8 + 2, 9 + 6))), 0, 1e-9);
    const struct vec3 ahead = pose_apply(&m.images[0].cam_from_world, vec3_make(3 - 5, 10, 15));
    assert_near(vec3_length(vec3_sub(ahead, vec3_make(0, 0, 5))), 0, 1e-9);
    sfm_model_release(&m);

    /* a fisheye with tangential terms, and a lens of PhotoScan before 1.2 */
    const double t = atan(hypot(x, y)), a = x * t / hypot(x, y), b = y * t / hypot(x, y), t2 = t * t;
    assert_ok(read_as(metashape_model_read, &m, "cameras.xml",
                      document("fisheye", "<f>300</f><k1>0.05</k1><p1>0.01</p1>", ""), &err),
              err);
    check_a(&m, 320 + 300 * (a * (1 + 0.05 * t2) + 0.01 * (t2 + 2 * a * a)),
            240 + 300 * (b * (1 + 0.05 * t2) + 2 * 0.01 * a * b), 1, vec3_make(0, 0, 0));
    sfm_model_release(&m);
    assert_ok(read_as(metashape_model_read, &m, "cameras.xml",
                      document("frame", "<fx>500</fx><fy>510</fy><cx>322</cx><cy>239</cy>", ""), &err),
              err);
    check_a(&m, 322 + 500 * x, 239 + 510 * y, 1, vec3_make(0, 0, 0));
    sfm_model_release(&m);
}

static void what_is_wrong_with_xml_is_named(void **state)
{
    (void)state;
    static const struct {
        const char *type, *calibration, *components, *words;
    } cases[] = {
        {"cylindrical", "<f>500</f>", "", "cameras.xml:5: sensor 3 is of type cylindrical"},
        {"spherical", "<f>500</f>", "", "is a panorama, but its photo a.jpg is not taken for one"},
        {"frame", "<cx>5</cx>", "", "cameras.xml:5: sensor 3 has no calibration"},
        {"frame", "<f>500</f><b2>5</b2>", "", "has the skew b2 = 5 px"},
        {"frame", "<f>500</f><k4>0.5</k4>", "", "has a fourth radial coefficient, k4 = 0.5"},
        {"frame", "<f>five</f>", "", "cameras.xml:7: found \"five\" in f, wanted 1 numbers"},
        {"frame", "<f>500</f>", "</chunk>", "cameras.xml:18: this is not XML: mismatched tag"},
        {"frame", "<f>500</f>",
         "<components><component id=\"0\"><transform><rotation>1 0 0 0 1 0 0 0 -1</rotation></transform></component>"
         "</components>",
         "cameras.xml:12: camera \"a.jpg\": found a pose that is not a rotation"},
    };
    struct sfm_model m;
    struct err err;
    bool found = true;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        assert_int_equal(read_as(metashape_model_read, &m, "cameras.xml",
                                 document(cases[i].type, cases[i].calibration, cases[i].components), &err),
                         ST_DATA);
        assert_err(err, ST_DATA, cases[i].words);
        assert_int_equal(m.image_count, 0);
    }
    err = (struct err)ERR_INIT;
    scratch_write("other.xml", "<?xml version=\"1.0\"?>\n<project><broken></project>\n");
    assert_ok(metashape_model_read(&m, &found, scratch, &photos, NULL, &err), err);
    assert_false(found);
    unlink(scratch_path("other.xml"));
}

/* ------------------------------------------------------------------------------------------------------------ CSV */

/* Heading is the compass direction of the camera's top or, once it is tilted up from looking down, of its view. */
static void angles_of_realityscan_turn_the_camera(void **state)
{
    (void)state;
    struct sfm_model m;
    struct err err;
    const double x = 0.2, y = -0.1, s = x * x + y * y, g = 1 - 0.1 * s;
    const char *text = "#cameras 3\n#name,x,y,alt,heading,pitch,roll,f,px,py,k1,k2,k3,k4,t1,t2\n"
                       "C:\\Photos\\a.jpg,1,2,3,0,90,0,27,0.01,-0.02,-0.1,0,0,0,0,0\r\n"
                       "\"b.png\",0,0,0,90,90,0,27,0,0,0,0,0,0,0,0\nother.jpg,0,0,0,0,0,0,27,0,0,0,0,0,0,0,0\n";
    assert_ok(read_as(csv_model_read, &m, "cams.csv", text, &err), err);
    check_a(&m, 320 + 6.4 + 480 * x * g, 240 - 12.8 + 480 * y * g, 1, vec3_make(0, 0, 0));
    /* heading 90: it looks east, along +x; south, -y, is to the right */
    struct vec3 p = pose_apply(&m.images[1].cam_from_world, vec3_make(10, -2, 1));
    assert_near(vec3_length(vec3_sub(p, vec3_make(2, -1, 10))), 0, 1e-9);
    sfm_model_release(&m);

    /* pitch 0 looks down with north at the top; roll 90 then looks west */
    assert_ok(read_as(csv_model_read, &m, "cams.csv",
                      "name;x;y;alt;heading;pitch;roll;f\na.jpg;0;0;10,5;0;0;0;18\nb.png;0;0;0;0;0;90;18\n", &err),
              err);
    p = pose_apply(&m.images[0].cam_from_world, vec3_make(1, 2, 5.5));
    assert_near(vec3_length(vec3_sub(p, vec3_make(1, -2, 5))), 0, 1e-9);
    p = pose_apply(&m.images[1].cam_from_world, vec3_make(-10, 2, 1));
    assert_near(vec3_length(vec3_sub(p, vec3_make(-1, -2, 10))), 0, 1e-9);
    assert_near(m.cameras[0].camera.params[0], 320, 1e-9);
    sfm_model_release(&m);
}

static void what_is_wrong_with_a_table_is_named(void **state)
{
    (void)state;
    struct sfm_model m;
    struct err err;
    bool found = true;
    assert_int_equal(
        read_as(csv_model_read, &m, "c.csv", "#name,x,y,alt,heading,pitch,roll,f\na.jpg,0,0,0,0,zero,0,27\n", &err),
        ST_DATA);
    assert_err(err, ST_DATA, "c.csv:2: found \"zero\", wanted the number pitch");
    assert_int_equal(read_as(csv_model_read, &m, "c.csv", "#name,x,y,alt,heading,pitch,roll,f\na.jpg,0,0\n", &err),
                     ST_DATA);
    assert_err(err, ST_DATA, "c.csv:2: found the end of the line, wanted the number alt");
    assert_int_equal(
        read_as(csv_model_read, &m, "c.csv", "#name,x,y,alt,heading,pitch,roll,f\nz.jpg,0,0,0,0,0,0,27\n", &err),
        ST_DATA);
    assert_err(err, ST_DATA, "c.csv places no photo of the scene");
    err = (struct err)ERR_INIT;
    scratch_write("other.csv", "time,value\n1,2\n");
    assert_ok(csv_model_read(&m, &found, scratch, &photos, NULL, &err), err);
    assert_false(found);
    unlink(scratch_path("other.csv"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transforms_have_axes_of_opengl),
        cmocka_unit_test(what_is_wrong_with_transforms_is_named),
        cmocka_unit_test(depth_that_transforms_name_is_linked),
        cmocka_unit_test(metashape_has_its_own_lens),
        cmocka_unit_test(what_is_wrong_with_xml_is_named),
        cmocka_unit_test(angles_of_realityscan_turn_the_camera),
        cmocka_unit_test(what_is_wrong_with_a_table_is_named),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
