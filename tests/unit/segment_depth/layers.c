/* layers.c - mattes of mixed pixels whose alpha is known. */
#include "stages/segment_depth/layers.h"

#include "tests/unit/segment_depth/scene.h"

#include "common/base/parallel.h"

enum { W = 60, H = 44 };

static const double step = 0.01, near_depth = 2, far_depth = 5;
static const float near_colour[3] = {0.6f, 0.2f, 0.1f}, far_colour[3] = {0.05f, 0.2f, 0.7f};

/* Alpha of the near side: its edge is the line x + y / 4 = 30, blurred over `blur` pixels. */
static double share(int x, int y, double blur)
{
    return fmin(fmax((30 - (x + 0.5 + (y + 0.5) / 4)) / blur + 0.5, 0), 1);
}

struct bench {
    struct image photo;
    struct segmentation s;
    struct plane *planes;
    struct layered_depth out;
};

/* Segments of 6 x 6 pixels divided by the edge, even numbers near, odd ones far; with a disc of invalid pixels if
 * `holed`. */
static void start(struct bench *b, const float near[3], const float far[3], double blur, bool holed, double far_z)
{
    struct err err = ERR_INIT;
    memset(b, 0, sizeof *b);
    assert_int_equal(image_init(&b->photo, W, H, 4, &err), ST_OK);
    b->s = (struct segmentation){.width = W, .height = H, .count = 2 * (W / 6) * (H / 6 + 1)};
    b->s.label = malloc(sizeof(int) * W * H);
    b->planes = malloc((size_t)b->s.count * sizeof *b->planes);
    assert_true(b->s.label && b->planes);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const double alpha = share(x, y, blur);
            const bool valid = !(holed && hypot(x - 27, y - 20) < 9);
            b->s.label[y * W + x] = valid ? 2 * (y / 6 * (W / 6) + x / 6) + (alpha < 0.5) : -1;
            for (int c = 0; c < 3 && valid; c++)
                image_at(&b->photo, x, y)[c] = (float)(alpha * (double)near[c] + (1 - alpha) * (double)far[c]) *
                                               (1 + 0.02f * (float)scene_hash(x, y, c));
            image_at(&b->photo, x, y)[3] = valid;
        }
    for (int i = 0; i < b->s.count; i++) /* both sides are slightly slanted */
        b->planes[i] = (struct plane){i % 2 ? 1e-4 : 5e-4, -2e-4, 1 / (i % 2 ? far_z : near_depth)};
    assert_int_equal(layered_depth_init(&b->out, W, H, &err), ST_OK);
    b->out.segment_count = b->s.count;
    b->out.segments = calloc((size_t)b->s.count, sizeof *b->out.segments);
    assert_non_null(b->out.segments);
}

static void make(struct bench *b, bool matte)
{
    struct err err = ERR_INIT;
    if (layers_make(&b->out, b->s.label, b->planes, &b->photo, step, matte, &err)) fail_msg("%s", err.text);
}

static void finish(struct bench *b)
{
    image_release(&b->photo);
    oversegment_release(&b->s);
    free(b->planes);
    layered_depth_release(&b->out);
}

/* The invariants of docs/formats.md. */
static void check_invariants(const struct bench *b)
{
    int *pixels = calloc((size_t)b->s.count, sizeof *pixels);
    assert_non_null(pixels);
    for (int i = 0; i < W * H; i++) {
        const struct layer *layers[2] = {&b->out.interior, &b->out.boundary};
        const float *photo = b->photo.data + 4 * i;
        float sum[4] = {0};
        for (int k = 0; k < 2; k++) {
            const float *rgba = layers[k]->rgba + 4 * i;
            const uint32_t id = layers[k]->id[i];
            for (int c = 0; c < 4; c++) {
                assert_true(isfinite(rgba[c]) && rgba[c] >= 0);
                sum[c] += rgba[c];
            }
            assert_true(id <= (uint32_t)b->s.count);
            assert_true((id > 0) == (rgba[3] > 0) && (id > 0) == (layers[k]->z[i] > 0));
            if (!id) continue;
            const double inverse = plane_at(b->planes[id - 1], i % W + 0.5, i / W + 0.5);
            assert_near(layers[k]->z[i] * inverse, 1, 1e-6);
            assert_near(rintf(rgba[3] * 1024), rgba[3] * 1024, 0);
            pixels[id - 1] += k == 0;
        }
        assert_near(sum[3], photo[3], 0);
        for (int c = 0; c < 3; c++) assert_near(sum[c], photo[c], 1e-7);
        if (layers[1]->id[i]) assert_true(layers[1]->id[i] != layers[0]->id[i]);
    }
    for (int i = 0; i < b->s.count; i++) assert_int_equal(b->out.segments[i].pixels, pixels[i]);
    free(pixels);
}

static double near_share(const struct bench *b, int x, int y)
{
    const int i = y * W + x;
    double sum = 0;
    if (b->out.interior.id[i] % 2 == 1) sum += (double)b->out.interior.rgba[4 * i + 3]; /* id is label + 1 */
    if (b->out.boundary.id[i] % 2 == 1) sum += (double)b->out.boundary.rgba[4 * i + 3];
    return sum;
}

static void alpha_at_a_depth_edge_is_recovered(void **state)
{
    (void)state;
    struct bench b;
    int mixed = 0;
    start(&b, near_colour, far_colour, 2, false, far_depth);
    make(&b, true);
    check_invariants(&b);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            const double alpha = share(x, y, 2);
            assert_near(near_share(&b, x, y), alpha, 0.08);
            if (alpha < 0.1 || alpha > 0.9) continue;
            assert_near(near_share(&b, x, y), alpha, 0.04);
            mixed++;
        }
    assert_true(mixed >= H);
    finish(&b);
}

static void the_two_layers_have_the_colours_of_the_two_sides(void **state)
{
    (void)state;
    struct bench b;
    start(&b, near_colour, far_colour, 2, false, far_depth);
    make(&b, true);
    for (int i = 0; i < W * H; i++) {
        const float *part = b.out.boundary.rgba + 4 * i;
        const float *colour = b.out.boundary.id[i] % 2 ? near_colour : far_colour;
        for (int c = 0; c < 3 && part[3] > 0.25f; c++) assert_near(part[c] / part[3], colour[c], 0.04);
    }
    finish(&b);
}

static void a_segment_border_off_by_a_pixel_is_corrected(void **state)
{
    (void)state;
    struct bench b;
    start(&b, near_colour, far_colour, 0.01, false, far_depth);
    for (int y = 0; y < H; y++) /* every third row's first far pixel belongs to a near segment */
        for (int x = 1; x < W; x++)
            if (y % 3 == 0 && share(x, y, 0.01) < 0.5 && share(x - 1, y, 0.01) > 0.5) b.s.label[y * W + x] -= 1;
    make(&b, true);
    check_invariants(&b);
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) assert_near(near_share(&b, x, y), share(x, y, 0.01), 0.02);
    finish(&b);
}

static void without_depth_edge_contrast_or_matte_there_is_one_layer(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        struct bench b;
        /* 1.5 steps apart; equal colours; no matte */
        start(&b, near_colour, k == 1 ? near_colour : far_colour, 2, false,
              k == 0 ? 1 / (1 / near_depth - 0.008) : far_depth);
        make(&b, k != 2);
        check_invariants(&b);
        for (int i = 0; i < W * H; i++) {
            assert_int_equal(b.out.boundary.id[i], 0);
            assert_int_equal(b.out.interior.id[i], b.s.label[i] + 1);
        }
        finish(&b);
    }
}

static void invalid_pixels_stay_empty(void **state)
{
    (void)state;
    struct bench b;
    start(&b, near_colour, far_colour, 2, true, far_depth);
    make(&b, true);
    check_invariants(&b);
    assert_int_equal(b.out.interior.id[20 * W + 27], 0);
    finish(&b);
}

static void layers_of_bright_black_and_thin_objects_sum_to_the_photo(void **state)
{
    (void)state;
    static const float colours[][3] = {{1e4f, 1e4f, 1e4f}, {0, 0, 0}, {1, 1, 1}, {1e-6f, 0, 0}, {0, 1, 0}};
    for (int k = 0; k < 25; k++) {
        struct bench b;
        start(&b, colours[k / 5], colours[k % 5], 3, k % 2, far_depth);
        for (int i = 0; i < W * H; i += 7) /* scattered single pixels of the other side */
            if (b.s.label[i] >= 0) b.s.label[i] ^= 1;
        make(&b, true);
        for (int i = 0; i < W * H; i++)
            for (int c = 0; c < 4; c++) {
                const float sum = b.out.interior.rgba[4 * i + c] + b.out.boundary.rgba[4 * i + c];
                assert_near(sum, b.photo.data[4 * i + c], 1e-6 * (double)b.photo.data[4 * i + c]);
                assert_true(b.out.interior.rgba[4 * i + c] >= 0 && b.out.boundary.rgba[4 * i + c] >= 0);
            }
        finish(&b);
    }
}

static void thread_counts_give_the_same_layers(void **state)
{
    (void)state;
    struct bench b[2];
    for (int k = 0; k < 2; k++) {
        parallel_set_threads(1 + 2 * k);
        start(&b[k], near_colour, far_colour, 2, true, far_depth);
        make(&b[k], true);
    }
    parallel_set_threads(0);
    assert_memory_equal(b[0].out.interior.rgba, b[1].out.interior.rgba, sizeof(float) * 4 * W * H);
    assert_memory_equal(b[0].out.boundary.rgba, b[1].out.boundary.rgba, sizeof(float) * 4 * W * H);
    assert_memory_equal(b[0].out.boundary.z, b[1].out.boundary.z, sizeof(float) * W * H);
    for (int k = 0; k < 2; k++) finish(&b[k]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(alpha_at_a_depth_edge_is_recovered),
        cmocka_unit_test(the_two_layers_have_the_colours_of_the_two_sides),
        cmocka_unit_test(a_segment_border_off_by_a_pixel_is_corrected),
        cmocka_unit_test(without_depth_edge_contrast_or_matte_there_is_one_layer),
        cmocka_unit_test(invalid_pixels_stay_empty),
        cmocka_unit_test(layers_of_bright_black_and_thin_objects_sum_to_the_photo),
        cmocka_unit_test(thread_counts_give_the_same_layers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
