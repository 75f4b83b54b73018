/* whole.c - from photo files to frames: the ends, the pictures between, chunks of frames, and invalid pairs. */
#include "../scratch.h"
#include "common/base/parallel.h"
#include "common/capture/photo_list.h"
#include "common/image/exr.h"
#include "made_pair.h"
#include "stages/morph_views/morph_frames.h"
#include "stages/morph_views/prepare.h"

/* Writes a photo and its record: the synthetic picture, cropped to width x height. */
static void write_photo(const char *id, const struct made_pair *pair, int second, int width, int height)
{
    struct err err = ERR_INIT;
    struct image im = {0};
    unsigned char *rgb = malloc(3 * (size_t)MADE_WIDTH * MADE_HEIGHT);
    char file[64];
    assert_ok(image_init(&im, MADE_WIDTH, MADE_HEIGHT, 3, &err), err);
    made_picture(&im, pair, second);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 3; c++)
                rgb[3 * (y * width + x) + c] = (unsigned char)lrintf(255 * srgb_from_linear(image_at(&im, x, y)[c]));
    snprintf(file, sizeof file, "%s.png", id);
    assert_ok(png_write(scratch_path(file), rgb, width, height, 3, &err), err);
    struct photo_record r = {.id = (char *)id,
                             .file = file,
                             .hash = "0",
                             .info = {.width = width, .height = height, .bits = 8, .orientation = 1}};
    memset(r.hash, '0', HASH_TEXT - 1);
    assert_ok(photo_record_write(&r, scratch_path("records"), &err), err);
    image_release(&im);
    free(rgb);
}

static enum status prepare(const char *first, const char *second, const char *out, struct err *err)
{
    struct morph_params params = MORPH_PARAMS_DEFAULT;
    struct provenance prov = {.stage = "morph_views", .version = "test"};
    const struct morph_job job = {scratch, scratch_path("records"), first, second, NULL};
    params.seconds = 0.5;
    params.fps = 10;
    enum status st = morph_prepare(&job, scratch_path(out), &params, &prov, err);
    provenance_release(&prov);
    return st;
}

static enum status frames(const char *morph, const char *list, const char *out, struct err *err)
{
    struct morph_params params = MORPH_PARAMS_DEFAULT;
    struct provenance prov = {.stage = "morph_views", .version = "test"};
    enum status st = morph_frames(scratch_path(morph), list, scratch_path(out), &params, &prov, err);
    provenance_release(&prov);
    return st;
}

static const struct made_pair moved = {{-4, 0}, {-12, 3}, true, 1};

static void the_ends_are_the_photos_and_the_middle_is_between(void **state)
{
    struct err err = ERR_INIT;
    struct image linear = {0}, middle = {0};
    struct made_pair half = moved;
    (void)state;
    write_photo("a", &moved, 0, MADE_WIDTH, MADE_HEIGHT);
    write_photo("b", &moved, 1, MADE_WIDTH, MADE_HEIGHT);
    assert_ok(prepare("a", "b", "m", &err), err);
    assert_ok(frames("m", "1:5", "m/frames", &err), err);
    for (int end = 0; end < 2; end++) {
        struct photo photo = {0};
        struct exr_image im = {0};
        assert_ok(photo_read(&photo, scratch_path(end ? "b.png" : "a.png"), &err), err);
        assert_ok(photo_to_linear(&linear, &photo, &err), err);
        assert_ok(exr_read(&im, scratch_path(end ? "m/frames/0005.exr" : "m/frames/0001.exr"), NULL, 0, &err), err);
        assert_string_equal(exr_attribute(&im, "remodel:t"), end ? "1" : "0");
        for (int c = 0; c < 3; c++)
            for (size_t p = 0; p < MADE_WIDTH * MADE_HEIGHT; p++) {
                float is = exr_find(&im, (const char *[]){"R", "G", "B"}[c])->f[p],
                      wanted = linear.data[3 * p + (size_t)c];
                assert_true(fabsf(is - wanted) <= wanted / 2048 + 1e-7f);
            }
        exr_image_release(&im);
        image_release(&linear);
        photo_release(&photo);
    }
    struct exr_image im = {0};
    for (int a = 0; a < 2; a++) {
        half.wall[a] /= 2;
        half.square[a] /= 2;
    }
    assert_ok(image_init(&middle, MADE_WIDTH, MADE_HEIGHT, 3, &err), err);
    made_picture(&middle, &half, 1);
    assert_ok(exr_read(&im, scratch_path("m/frames/0003.exr"), NULL, 0, &err), err);
    double sum = 0, still = 0;
    int count = 0;
    made_picture(&middle, &half, 1);
    for (int y = 12; y < MADE_HEIGHT - 12; y++)
        for (int x = 12; x < MADE_WIDTH - 12; x++, count++) {
            double d = exr_find(&im, "G")->f[y * MADE_WIDTH + x] - image_at(&middle, x, y)[1];
            sum += d * d;
            still += pow(made_texture(x, y, 7) - image_at(&middle, x, y)[1], 2);
        }
    assert_true(sqrt(sum / count) < 0.03);
    assert_true(sqrt(sum / count) < 0.3 * sqrt(still / count));
    exr_image_release(&im);
    image_release(&middle);
}

static void any_chunk_and_thread_count_gives_the_same_frame(void **state)
{
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(frames("m", "3", "one", &err), err);
    parallel_set_threads(1);
    assert_ok(prepare("a", "b", "n", &err), err);
    assert_ok(frames("n", "2:3", "two", &err), err);
    parallel_set_threads(0);
    static const char *const same[][2] = {{"m/first.exr", "n/first.exr"},
                                          {"m/second.exr", "n/second.exr"},
                                          {"m/path.txt", "n/path.txt"},
                                          {"one/0003.exr", "two/0003.exr"},
                                          {"one/0003.exr", "m/frames/0003.exr"}};
    for (int i = 0; i < 5; i++) {
        char hash[2][HASH_TEXT];
        for (int k = 0; k < 2; k++) assert_ok(hash_file(hash[k], scratch_path(same[i][k]), &err), err);
        assert_string_equal(hash[0], hash[1]);
    }
}

static void photos_of_different_sizes_are_fitted_to_the_first_ones_film(void **state)
{
    struct err err = ERR_INIT;
    struct exr_image im = {0};
    (void)state;
    write_photo("odd", &moved, 0, MADE_WIDTH - 1, MADE_HEIGHT - 3);
    assert_ok(prepare("odd", "b", "sizes", &err), err);
    assert_ok(exr_read(&im, scratch_path("sizes/second.exr"), NULL, 0, &err), err);
    assert_int_equal(im.width, MADE_WIDTH - 2);
    assert_int_equal(im.height, MADE_HEIGHT - 4);
    exr_image_release(&im);
    write_photo("narrow", &moved, 0, 40, MADE_HEIGHT);
    assert_int_equal(prepare("b", "narrow", "sizes", &err), ST_DATA);
    assert_err(err, ST_DATA, "more than half of the photo would be cut off");
    assert_contains(err.text, "narrow");
    err = (struct err)ERR_INIT;
    write_photo("dot", &moved, 0, 3, 3);
    prepare("dot", "b", "sizes", &err);
    assert_err(err, ST_DATA, "photo dot: its 3 x 3 pixels");
}

static void photos_without_common_content_are_rejected(void **state)
{
    struct err err = ERR_INIT;
    const struct made_pair other = {{5000, 3000}, {0, 0}, false, 1};
    (void)state;
    write_photo("other", &other, 1, MADE_WIDTH, MADE_HEIGHT);
    prepare("a", "other", "nothing", &err);
    assert_err(err, ST_DATA, "they show different things");
    assert_int_equal(access(scratch_path("nothing/first.exr"), F_OK), -1);
}

static void identical_and_textureless_photos_are_morphed(void **state)
{
    struct err err = ERR_INIT;
    const struct made_pair black = {{0, 0}, {0, 0}, false, 0};
    (void)state;
    assert_ok(prepare("a", "a", "same", &err), err);
    assert_ok(frames("same", "3", "same", &err), err);
    write_photo("black", &black, 1, MADE_WIDTH, MADE_HEIGHT);
    assert_ok(prepare("black", "black", "dark", &err), err);
    assert_ok(frames("dark", "3", "dark", &err), err);
}

static void invalid_frame_numbers_and_flows_are_rejected(void **state)
{
    struct err err = ERR_INIT;
    (void)state;
    struct exr_image im = {0};
    assert_ok(exr_read(&im, scratch_path("m/first.exr"), NULL, 0, &err), err);
    exr_find(&im, "flow.x")->f[7] = 1e5f;
    assert_ok(exr_write(&im, scratch_path("n/first.exr"), NULL, &err), err);
    frames("n", "2", "broken", &err);
    assert_err(err, ST_DATA, "flow.x is 100000 at pixel (7, 0)");
    err = (struct err)ERR_INIT;
    exr_find(&im, "flow.x")->f[7] = 0;
    assert_ok(exr_set_attribute(&im, "remodel:gain", "1 none 1", &err), err);
    assert_ok(exr_write(&im, scratch_path("n/first.exr"), NULL, &err), err);
    frames("n", "2", "broken", &err);
    assert_err(err, ST_DATA, "remodel:gain");
    exr_image_release(&im);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_ends_are_the_photos_and_the_middle_is_between),
        cmocka_unit_test(any_chunk_and_thread_count_gives_the_same_frame),
        cmocka_unit_test(photos_of_different_sizes_are_fitted_to_the_first_ones_film),
        cmocka_unit_test(photos_without_common_content_are_rejected),
        cmocka_unit_test(identical_and_textureless_photos_are_morphed),
        cmocka_unit_test(invalid_frame_numbers_and_flows_are_rejected),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
