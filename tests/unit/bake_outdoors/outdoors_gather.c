/* outdoors_gather.c - the picture of the outdoors: which pictures it is taken from, and gains. */
#include "stages/bake_outdoors/outdoors_gather.h"

#include "tests/unit/scratch.h"

#include "common/base/parallel.h"
#include "common/capture/view_image.h"
#include "common/image/exr.h"
#include "common/math/numbers.h"
#include "common/texture/view_ids.h"

enum { SIDE = 160, HEIGHT = 512 };

/* A room 4 m wide, its centre in the origin, with a square hole of 2 m in the wall x = 2. */
static void make_room(struct outdoors_model *m)
{
    static const struct vec3 c[8] = {{-2, -2, -2}, {2, -2, -2}, {2, 2, -2}, {-2, 2, -2},
                                     {-2, -2, 2},  {2, -2, 2},  {2, 2, 2},  {-2, 2, 2}};
    static const int quads[5][4] = {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {3, 2, 6, 7}, {0, 3, 7, 4}};
    struct err err = ERR_INIT;
    *m = (struct outdoors_model){0};
    m->rays.ids = 1;
    m->normals = calloc(1, sizeof *m->normals);
    for (int q = 0; q < 5; q++)
        for (int k = 1; k < 3; k++) {
            const struct vec3 t[3] = {c[quads[q][0]], c[quads[q][k]], c[quads[q][k + 1]]};
            assert_ok(ray_scene_add_triangle(&m->rays.rays, t, 0, &err), err);
        }
    for (int s = 0; s < 4; s++) { /* the frame around the hole: turned by s times 90 degrees about x */
        const double co = s == 0 ? 1 : s == 2 ? -1 : 0, si = s == 1 ? 1 : s == 3 ? -1 : 0;
        const double yz[4][2] = {{-2, -2}, {2, -2}, {1, -1}, {-1, -1}};
        struct vec3 p[4];
        for (int k = 0; k < 4; k++) p[k] = vec3_make(2, co * yz[k][0] - si * yz[k][1], si * yz[k][0] + co * yz[k][1]);
        for (int k = 1; k < 3; k++)
            assert_ok(ray_scene_add_triangle(&m->rays.rays, (const struct vec3[]){p[0], p[k], p[k + 1]}, 0, &err), err);
    }
    assert_ok(ray_scene_commit(&m->rays.rays, &err), err);
}

/* The truth: what lies in a direction. */
static double truth_of(struct vec3 d) { return 1 + 0.5 * d.y + 0.25 * d.z; }

/* A view from (0, y, z) along +x, 90 degrees wide. */
static struct view make_view(const char *name, double y, double z)
{
    struct view v = {.name = name, .width = SIDE, .height = SIDE, .fx = SIDE / 2, .fy = SIDE / 2, .cx = SIDE / 2};
    v.cy = SIDE / 2;
    v.cam_from_world = (struct mat3){{{0, -1, 0}, {0, 0, -1}, {1, 0, 0}}};
    v.center = vec3_make(0, y, z);
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, v.center), -1);
    return v;
}

struct shot {
    struct view view;
    double factor;  /* of its exposure */
    int black, cut; /* px: columns from the middle to the right that a curtain hides; that clip */
};

static struct vec3 ray_of(const struct view *v, int x, int y)
{
    const struct vec3 ray = {(x + 0.5 - v->cx) / v->fx, (y + 0.5 - v->cy) / v->fy, 1};
    return vec3_normalize(mat3_apply(mat3_transpose(v->cam_from_world), ray));
}

/* Writes what the view sees if everything were outdoors: the model says where it is. */
static void write_shot(struct outdoors_picture *p, const struct shot *shot, int photo)
{
    static const char *const names[] = {"R", "G", "B", "A", "sigma", "clipped"};
    const struct view *v = &shot->view;
    struct exr_image im = {0};
    struct exr_plane *plane;
    struct view_ids ids = {0};
    struct err err = ERR_INIT;
    char picture[64], faces[64], path[PATH_MAX];
    snprintf(picture, sizeof picture, "%s.exr", v->name);
    snprintf(faces, sizeof faces, "%s-ids.exr", v->name);
    snprintf(path, sizeof path, "%s", scratch_path(picture));
    assert_ok(exr_image_init(&im, SIDE, SIDE, &err), err);
    for (int k = 0; k < 6; k++) {
        assert_ok(exr_add_plane(&im, names[k], EXR_HALF, &plane, &err), err);
        for (int i = 0; i < SIDE * SIDE; i++) {
            const int right = i % SIDE - SIDE / 2;
            const float value = (float)(shot->factor * truth_of(ray_of(v, i % SIDE, i / SIDE)));
            if (k < 3) plane->f[i] = right >= 0 && right < shot->black ? 0.01f : value;
            if (k == 3) plane->f[i] = 1;
            if (k == 5) plane->f[i] = right >= 0 && right < shot->cut;
        }
    }
    assert_ok(exr_write(&im, path, NULL, &err), err);
    assert_ok(view_ids_init(&ids, SIDE, SIDE, &err), err);
    assert_ok(view_ids_write(&ids, v, scratch_path(faces), NULL, &err), err);
    assert_ok(outdoors_picture_of_view(p, v, path, scratch_path(faces), &err), err);
    p->photo = photo;
    view_ids_release(&ids);
    exr_image_release(&im);
}

static void gather(struct outdoors *o, struct outdoors_totals *totals, const struct shot *shots, int count)
{
    const struct outdoors_params params = {.height = HEIGHT, .edge = 2, .max_clutter = 0.6, .agree = 0.3};
    struct outdoors_picture pictures[8] = {{0}};
    struct provenance prov = {0};
    struct outdoors_model model;
    struct err err = ERR_INIT;
    make_room(&model);
    *o = (struct outdoors){0};
    for (int i = 0; i < count; i++) write_shot(&pictures[i], &shots[i], i);
    assert_ok(outdoors_gather(o, totals, pictures, count, count, &model, &params, &prov, &err), err);
    for (int i = 0; i < count; i++) outdoors_picture_release(&pictures[i]);
    provenance_release(&prov);
    outdoors_model_release(&model);
}

/* The largest relative error over the pixels that a photo shows; *count: their number. */
static double error_of(const struct outdoors *o, int *count)
{
    double largest = 0;
    *count = 0;
    for (int y = 0; y < o->height; y++)
        for (int x = 0; x < o->width; x++) {
            const size_t at = (size_t)y * (size_t)o->width + (size_t)x;
            if (!o->source[at]) continue;
            largest =
                fmax(largest, fabs((double)o->rgb[3 * at] / truth_of(outdoors_direction(o, x + 0.5, y + 0.5)) - 1));
            ++*count;
        }
    return largest;
}

static void a_view_shows_the_outdoors_through_an_opening_and_nothing_of_the_walls(void **state)
{
    (void)state;
    const struct shot shot = {.view = make_view("a", 0, 0), .factor = 1};
    struct outdoors o;
    struct outdoors_totals totals;
    int count;
    gather(&o, &totals, &shot, 1);
    assert_true(
        error_of(&o, &count) <
        0.0025); /* a pixel at the rim may be a quarter of its width off: pi / 512 / 4 * 0.56, and half floats */
    assert_int_equal(totals.photos, 1);
    /* a square seen at 2 m, 2 m wide: a cube's face has a sixth of the sphere, this one as in the closed form */
    const double opening = 4 * asin(sin(atan(0.5)) * sin(atan(0.5))) / (4 * PI);
    assert_true(totals.by_photos < opening && totals.by_photos > 0.8 * opening);
    for (int y = 0; y < o.height; y++)
        for (int x = 0; x < o.width; x++) {
            const struct vec3 d = outdoors_direction(&o, x + 0.5, y + 0.5);
            const bool leaves = d.x > 0 && fabs(d.y) < d.x / 2 && fabs(d.z) < d.x / 2;
            if (o.source[y * o.width + x]) assert_true(leaves);
        }
    outdoors_release(&o);
}

static void a_curtain_in_one_photo_is_outvoted(void **state)
{
    (void)state;
    const struct shot shots[] = {{make_view("a", 0, 0), 1, 20, 0},
                                 {make_view("b", 0.1, 0), 1, 0, 0},
                                 {make_view("c", 0, 0.1), 1, 0, 0},
                                 {make_view("d", -0.1, 0), 1, 0, 0}};
    struct outdoors o;
    struct outdoors_totals totals;
    int count;
    gather(&o, &totals, shots, 4);
    assert_true(error_of(&o, &count) < 0.05);
    assert_true(count > 10000);
    outdoors_release(&o);
}

static void clipped_pixels_give_way_to_another_photo(void **state)
{
    (void)state;
    /* the clipped photo is also too dark there: were it used, the error would show it */
    const struct shot shots[] = {{make_view("a", 0, 0), 1, 20, 20}, {make_view("b", 0.4, 0), 1, 0, 0}};
    struct outdoors o;
    struct outdoors_totals totals;
    float rgb[3];
    gather(&o, &totals, shots, 2);
    const struct vec3 d = vec3_normalize(vec3_make(1, -0.1, 0)); /* 8 px right of the middle of `a` */
    assert_int_equal(outdoors_sample(rgb, &o, d), OUTDOORS_PHOTO);
    assert_true(fabs((double)rgb[0] / truth_of(d) - 1) < 0.02);
    outdoors_release(&o);
}

static void photos_of_different_exposure_get_gains(void **state)
{
    (void)state;
    const struct shot shots[] = {
        {make_view("a", 0, 0), 1, 0, 0}, {make_view("b", 0.3, 0), 1.2, 0, 0}, {make_view("c", -0.3, 0), 1 / 1.2, 0, 0}};
    struct outdoors o;
    struct outdoors_totals totals;
    int count;
    gather(&o, &totals, shots, 3);
    assert_true(totals.max_gain > 1.15 && totals.max_gain < 1.2);
    assert_true(totals.min_gain < 1 / 1.15 && totals.min_gain > 1 / 1.2);
    assert_true(error_of(&o, &count) < 0.04);
    outdoors_release(&o);
}

static void without_an_opening_in_sight_the_picture_is_black_and_guessed(void **state)
{
    (void)state;
    struct shot shot = {.view = make_view("a", 0, 0), .factor = 1};
    shot.view.cam_from_world = (struct mat3){{{0, 1, 0}, {0, 0, -1}, {-1, 0, 0}}}; /* looks at the wall behind */
    struct outdoors o;
    struct outdoors_totals totals;
    gather(&o, &totals, &shot, 1);
    assert_int_equal(totals.photos + totals.references, 0);
    for (int i = 0; i < o.width * o.height; i++) assert_true(!o.source[i] && o.rgb[3 * i] == 0);
    outdoors_release(&o);
}

static void the_same_bytes_for_any_number_of_threads(void **state)
{
    (void)state;
    const struct shot shots[] = {
        {make_view("a", 0, 0), 1, 20, 0}, {make_view("b", 0.3, 0.2), 1.1, 0, 9}, {make_view("c", -0.3, 0), 0.9, 0, 0}};
    struct outdoors o[2];
    struct outdoors_totals totals;
    for (int k = 0; k < 2; k++) {
        parallel_set_threads(1 + 2 * k);
        gather(&o[k], &totals, shots, 3);
    }
    parallel_set_threads(0);
    assert_memory_equal(o[0].rgb, o[1].rgb, (size_t)o[0].width * (size_t)o[0].height * 3 * sizeof(float));
    assert_memory_equal(o[0].source, o[1].source, (size_t)o[0].width * (size_t)o[0].height);
    outdoors_release(&o[0]);
    outdoors_release(&o[1]);
}

/* ------------------------------------------------------------------------------------------------- reference images */

enum { FISHEYE = 120 };

/* Writes a fisheye of 180 degrees that looks along +x out of the hole, of `factor` times the truth and black beyond its
 * circle, and reads it. lens: NULL: the true one. */
static enum status read_reference(struct outdoors_picture *p, double factor, const char *lens, bool *placed,
                                  struct err *err)
{
    static const char *const names[] = {"R", "G", "B", "clipped", "variance"};
    const struct camera camera = camera_equisolid(FISHEYE, FISHEYE, FISHEYE / (2 * sqrt(2)), FISHEYE / 2, FISHEYE / 2);
    const struct model_axes axes = {.rotation = {1, 0, 0, 0}, .scale = 1};
    struct view v = make_view("r", 0.25, -0.5);
    struct exr_image im = {0};
    struct exr_plane *plane;
    struct err made = ERR_INIT;
    char text[256];
    v.center.x = 2.5;
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, v.center), -1);
    assert_ok(exr_image_init(&im, FISHEYE, FISHEYE, &made), made);
    for (int k = 0; k < 5; k++) {
        assert_ok(exr_add_plane(&im, names[k], k == 3 ? EXR_UINT : EXR_FLOAT, &plane, &made), made);
        for (int i = 0; i < FISHEYE * FISHEYE; i++) {
            const double x = i % FISHEYE + 0.5, y = (double)(i / FISHEYE) + 0.5;
            struct vec3 ray;
            const bool inside =
                hypot(x - FISHEYE / 2, y - FISHEYE / 2) < FISHEYE / 2 && camera_unproject(&camera, x, y, &ray);
            if (inside) ray = mat3_apply(mat3_transpose(v.cam_from_world), ray);
            if (k < 3) plane->f[i] = inside ? (float)(factor * truth_of(ray)) : 0;
            if (k == 4) plane->f[i] = inside ? 1e-6f : 1;
        }
    }
    snprintf(text, sizeof text, "OPENCV_FISHEYE %d %d %.9g %.9g %.9g %.9g %.9g %.9g %.9g %.9g", FISHEYE, FISHEYE,
             camera.params[0], camera.params[1], camera.params[2], camera.params[3], camera.params[4], camera.params[5],
             camera.params[6], camera.params[7]);
    view_image_set_camera(&im, &v);
    assert_ok(exr_set_attribute(&im, "remodel:lens", lens ? lens : text, &made), made);
    assert_ok(exr_write(&im, scratch_path("sky.exr"), NULL, &made), made);
    exr_image_release(&im);
    return outdoors_picture_of_reference(p, scratch_path("sky.exr"), &axes, placed, err);
}

static void a_reference_image_has_its_lens_and_pose_in_its_file(void **state)
{
    (void)state;
    struct outdoors_picture p = {0};
    struct err err = ERR_INIT;
    bool placed;
    assert_ok(read_reference(&p, 1, NULL, &placed, &err), err);
    assert_true(placed && p.reference && !p.ids);
    assert_string_equal(p.name, "sky");
    assert_true(vec3_length(vec3_sub(p.center, vec3_make(2.5, 0.25, -0.5))) < 1e-6);
    const struct vec3 ahead = mat3_apply(p.cam_from_model, vec3_make(1, 0, 0));
    assert_true(vec3_length(vec3_sub(ahead, vec3_make(0, 0, 1))) < 1e-6);
    outdoors_picture_release(&p);
    read_reference(&p, 1, "PINHOLE 7 7 3 3 3 3", &placed, &err);
    assert_err(err, ST_DATA, "remodel:lens says 7 x 7");
    outdoors_picture_release(&p);
    err = (struct err)ERR_INIT;
    read_reference(&p, 1, "TELESCOPE 7 7", &placed, &err);
    assert_err(err, ST_DATA, "TELESCOPE");
    outdoors_picture_release(&p);
}

/* The outdoors of a reference image and a photo that is darker by a tenth. order: of the reference image, the photo. */
static void gather_both(struct outdoors *o, struct outdoors_totals *totals, int of_reference, int of_photo)
{
    const struct outdoors_params params = {.height = HEIGHT, .edge = 2, .max_clutter = 0.6, .agree = 0.3};
    const struct shot shot = {make_view("a", 0, 0), 0.9, 0, 0};
    struct outdoors_picture pictures[2] = {{0}};
    struct provenance prov = {0};
    struct outdoors_model model;
    struct err err = ERR_INIT;
    bool placed;
    make_room(&model);
    *o = (struct outdoors){0};
    assert_ok(read_reference(&pictures[0], 1, NULL, &placed, &err), err);
    write_shot(&pictures[1], &shot, 0);
    pictures[0].photo = 1;
    pictures[0].order = of_reference;
    pictures[1].order = of_photo;
    assert_ok(outdoors_gather(o, totals, pictures, 2, 2, &model, &params, &prov, &err), err);
    for (int i = 0; i < 2; i++) outdoors_picture_release(&pictures[i]);
    provenance_release(&prov);
    outdoors_model_release(&model);
}

static void a_reference_image_comes_before_photos_and_sets_their_level(void **state)
{
    (void)state;
    struct outdoors o;
    struct outdoors_totals totals;
    int count;
    gather_both(&o, &totals, 1, 0);
    assert_int_equal(totals.references, 1);
    assert_true(totals.by_photos == 0);
    /* half of the sphere, less a rim of 2 px of 60 */
    assert_true(totals.by_references < 0.5 && totals.by_references > 0.5 * 0.9);
    assert_true(error_of(&o, &count) < 0.02);
    outdoors_release(&o);
    gather_both(&o, &totals, 0, 1);
    assert_int_equal(totals.photos, 1);
    assert_true(totals.by_photos > 0.03);
    assert_true(fabs(totals.max_gain - 1 / 0.9) < 0.01);
    assert_true(error_of(&o, &count) < 0.02);
    outdoors_release(&o);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_view_shows_the_outdoors_through_an_opening_and_nothing_of_the_walls),
        cmocka_unit_test(a_curtain_in_one_photo_is_outvoted),
        cmocka_unit_test(clipped_pixels_give_way_to_another_photo),
        cmocka_unit_test(photos_of_different_exposure_get_gains),
        cmocka_unit_test(without_an_opening_in_sight_the_picture_is_black_and_guessed),
        cmocka_unit_test(the_same_bytes_for_any_number_of_threads),
        cmocka_unit_test(a_reference_image_has_its_lens_and_pose_in_its_file),
        cmocka_unit_test(a_reference_image_comes_before_photos_and_sets_their_level),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
