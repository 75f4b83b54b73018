/* The Cornell box of ../shared/data/cornell-box, for developers who have it: a run is compared over coarse blocks
 * with one that has 16 times the samples and another seed. */
#include "tests/unit/simulate/worlds.h"

#include "common/base/outfile.h"
#include "stages/simulate/render.h"

#define BOX    "../shared/data/cornell-box/"
#define SIDE   48
#define BLOCKS 6

static void copy_mesh(const char *name)
{
    char path[200], file[60];
    snprintf(path, sizeof path, BOX "meshes/cbox_%s.obj", name);
    snprintf(file, sizeof file, "%s.obj", name);
    char *text = scratch_read(path);
    scratch_write(file, text);
    free(text);
}

/* The next rgb element, value="R, G, B", after a mark in an XML file. */
static void xml_rgb(char rgb[80], const char *file, const char *mark)
{
    char *text = scratch_read(file), *at = strstr(text, mark), *value = at ? strstr(at, "value=\"") : NULL;
    double r, g, b;
    assert_non_null(value);
    assert_int_equal(sscanf(value, "value=\"%lf, %lf, %lf\"", &r, &g, &b), 3);
    snprintf(rgb, 80, "%.9g %.9g %.9g", r, g, b);
    free(text);
}

static struct world cornell_box(void)
{
    static const char *const materials[4] = {"white", "red", "green", "box"};
    static const char *const meshes[7][2] = {{"floor", "white"},     {"ceiling", "white"}, {"back", "white"},
                                             {"greenwall", "green"}, {"redwall", "red"},   {"smallbox", "box"},
                                             {"largebox", "box"}};
    char text[4000] = "", rgb[80], mark[40];
    size_t n = 0;
    for (int i = 0; i < 4; i++) {
        snprintf(mark, sizeof mark, "id=\"%s\"", materials[i]);
        xml_rgb(rgb, BOX "fragments/bsdfs-rgb.xml", mark);
        n += (size_t)snprintf(text + n, sizeof text - n, "texture %s rgb %s\nmaterial %s lambert %s\n", materials[i],
                              rgb, materials[i], materials[i]);
    }
    for (int i = 0; i < 7; i++) {
        copy_mesh(meshes[i][0]);
        n += (size_t)snprintf(text + n, sizeof text - n, "mesh m-%s %s.obj %s\n", meshes[i][0], meshes[i][0],
                              meshes[i][1]);
    }
    xml_rgb(rgb, BOX "cbox-rgb.xml", "area-emitter");
    snprintf(text + n, sizeof text - n, "lamp light quad 213 548.3 227  130 0 0  0 0 105  %s\n", rgb);
    return world_from(text);
}

static void few_samples_agree_with_many(void **state)
{
    struct err err = ERR_INIT;
    struct shoot s;
    (void)state;
    if (access(BOX "fragments/bsdfs-rgb.xml", R_OK)) {
        print_message(BOX " does not exist: skipped\n");
        skip();
    }
    struct world w = cornell_box();
    scratch_write("cameras.txt",
                  "remodel-shoot 1\nlens p pinhole 48 48 67.2 67.2 24 24\nexposure 1\nsensor 30000 6 1 1\n"
                  "photo a p 278 273 -800  278 273 -799\n");
    assert_ok(shoot_read(&s, scratch, 1, NULL, &err), err);
    const struct camera_view view = render_view_make(&s, &s.photos[0]);
    struct image im[2] = {{0}, {0}};
    for (int i = 0; i < 2; i++) {
        const struct simulate_params params = {.samples = i ? 1024 : 64, .scale = 1, .seed = 1 + i};
        assert_ok(render_radiance(&im[i], &w, &view, "a", &params, NULL, &err), err);
    }
    double error = 0;
    int counted = 0;
    for (int block = 0; block < BLOCKS * BLOCKS; block++) {
        double sum[2] = {0, 0};
        for (int i = 0; i < 2; i++)
            for (int k = 0; k < 64; k++) {
                const float *p = image_at(&im[i], block % BLOCKS * 8 + k % 8, block / BLOCKS * 8 + k / 8);
                sum[i] += (double)(p[0] + p[1] + p[2]);
            }
        if (sum[1] > 0) {
            error += fabs(sum[0] / sum[1] - 1);
            counted++;
        }
    }
    print_message("mean relative difference of %d blocks: %.4f\n", counted, error / counted);
    assert_int_equal(counted, BLOCKS * BLOCKS);
    assert_true(error / counted < 0.02);
    /* the red wall is on the left, the green one on the right */
    const float *left = image_at(&im[1], 3, 24), *right = image_at(&im[1], 44, 24);
    assert_true(left[0] > 3 * left[1] && right[1] > 1.1f * right[0]);
    image_release(&im[0]);
    image_release(&im[1]);
    shoot_release(&s);
    path_world_release(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(few_samples_agree_with_many)};
    return cmocka_run_group_tests_name("simulate cornell box", tests, scratch_make, scratch_remove);
}
