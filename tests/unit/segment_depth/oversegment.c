/* oversegment.c - segments of synthetic pictures, whose lists are checked pixel by pixel. */
#include "stages/segment_depth/oversegment.h"

#include "tests/unit/segment_depth/scene.h"

#include "common/base/parallel.h"

typedef void paint_fn(int x, int y, float rgba[4]);

static void grey(int x, int y, float rgba[4])
{
    (void)x, (void)y;
    for (int c = 0; c < 4; c++) rgba[c] = c < 3 ? 0.3f : 1;
}

static void noise(int x, int y, float rgba[4])
{
    for (int c = 0; c < 3; c++) rgba[c] = (float)scene_hash(x, y, c);
    rgba[3] = 1;
}

static void blobs(int x, int y, float rgba[4])
{
    for (int c = 0; c < 3; c++) rgba[c] = (float)scene_noise(x / 9.0, y / 9.0, 5 * c);
    rgba[3] = hypot(x - 40, y - 25) > 12 && (x + 2 * y) % 61 > 3; /* invalid in a disc and along stripes */
}

static void islands(int x, int y, float rgba[4])
{
    noise(x, y, rgba);
    rgba[3] = x % 3 == 0 && y % 3 == 0; /* isolated pixels */
}

static void nothing(int x, int y, float rgba[4])
{
    (void)x, (void)y;
    for (int c = 0; c < 4; c++) rgba[c] = 0;
}

static void not_numbers(int x, int y, float rgba[4])
{
    noise(x, y, rgba);
    if ((x + y) % 7 == 0) rgba[x % 3] = x % 2 ? NAN : y % 2 ? INFINITY : -INFINITY;
}

static bool in_disc(int x, int y) { return hypot(x + 0.5 - 60, y + 0.5 - 45) < 30; }

static void disc(int x, int y, float rgba[4])
{
    for (int c = 0; c < 3; c++) rgba[c] = (in_disc(x, y) ? 0.30f : 0.15f) + 0.03f * (float)scene_hash(x, y, c);
    rgba[3] = 1;
}

static void cut(struct segmentation *s, struct gamma_image *g, int width, int height, paint_fn *paint,
                int segment_pixels, double compactness)
{
    struct image im;
    struct err err = ERR_INIT;
    assert_int_equal(image_init(&im, width, height, 4, &err), ST_OK);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) paint(x, y, image_at(&im, x, y));
    assert_int_equal(gamma_image_make(g, &im, (struct tone){1, 0.5}, &err), ST_OK);
    image_release(&im);
    *s = (struct segmentation){0};
    if (oversegment(s, g, segment_pixels, compactness, &err)) fail_msg("%s", err.text);
}

static void release(struct segmentation *s, struct gamma_image *g)
{
    oversegment_release(s);
    gamma_image_release(g);
}

/* Number of the segment's pixels that are connected to its first one. */
static int walk(const struct segmentation *s, int segment, uint8_t *met, int *queue)
{
    int head = 0, tail = 0;
    queue[tail++] = s->pixel[s->segments[segment].first];
    met[queue[0]] = 1;
    while (head < tail) {
        const int p = queue[head++], x = p % s->width, y = p / s->width;
        for (int k = 0; k < 4; k++) {
            const int nx = x + (k == 0) - (k == 1), ny = y + (k == 2) - (k == 3), q = ny * s->width + nx;
            if (nx < 0 || ny < 0 || nx >= s->width || ny >= s->height || met[q] || s->label[q] != segment) continue;
            met[q] = 1;
            queue[tail++] = q;
        }
    }
    return tail;
}

/* Pixel sides shared by segment a and segment b (b < 0: all others). */
static int border(const struct segmentation *s, int a, int b)
{
    int sides = 0;
    for (int i = 0; i < s->segments[a].pixels; i++) {
        const int p = s->pixel[s->segments[a].first + i], x = p % s->width, y = p / s->width;
        for (int k = 0; k < 4; k++) {
            const int nx = x + (k == 0) - (k == 1), ny = y + (k == 2) - (k == 3);
            if (nx < 0 || ny < 0 || nx >= s->width || ny >= s->height) continue;
            const int other = s->label[ny * s->width + nx];
            sides += other >= 0 && other != a && (b < 0 || other == b);
        }
    }
    return sides;
}

static void check_invariants(const struct segmentation *s, const struct gamma_image *g)
{
    const int pixels = s->width * s->height;
    uint8_t *met = calloc((size_t)pixels, 1);
    int *queue = malloc((size_t)pixels * sizeof *queue), valid = 0, listed = 0;
    assert_non_null(met);
    assert_non_null(queue);
    for (int i = 0; i < pixels; i++) {
        valid += g->valid[i];
        assert_true(g->valid[i] ? s->label[i] >= 0 && s->label[i] < s->count : s->label[i] == -1);
    }
    for (int k = 0; k < s->count; k++) {
        const struct segment *f = &s->segments[k];
        double cx = 0, cy = 0;
        int x0 = s->width, y0 = s->height, x1 = -1, y1 = -1;
        assert_int_equal(f->first, listed);
        assert_true(f->pixels > 0);
        listed += f->pixels;
        for (int i = 0; i < f->pixels; i++) {
            const int p = s->pixel[f->first + i], x = p % s->width, y = p / s->width;
            assert_int_equal(s->label[p], k);
            assert_true(i == 0 || p > s->pixel[f->first + i - 1]);
            cx += (x + 0.5) / f->pixels;
            cy += (y + 0.5) / f->pixels;
            x0 = x < x0 ? x : x0;
            x1 = x > x1 ? x : x1;
            y0 = y < y0 ? y : y0;
            y1 = y > y1 ? y : y1;
        }
        assert_true(x0 == f->x0 && x1 == f->x1 && y0 == f->y0 && y1 == f->y1);
        assert_near(f->cx, cx, 1e-6);
        assert_near(f->cy, cy, 1e-6);
        for (int c = 0; c < 3; c++) assert_true(isfinite(f->colour[c]));
        assert_int_equal(walk(s, k, met, queue), f->pixels); /* connected */

        int sides = 0;
        for (int t = s->first_border[k]; t < s->first_border[k + 1]; t++) {
            const struct border *a = &s->borders[t], *b = NULL;
            assert_true(a->other != k && a->other >= 0 && a->other < s->count);
            assert_true(t == s->first_border[k] || a[-1].other < a->other);
            assert_int_equal(a->length, border(s, k, a->other));
            assert_true(a->edge >= 0 && a->edge < s->edge_count && a->contrast >= 0 && isfinite(a->contrast));
            assert_true(a->u >= (float)x0 && a->u <= (float)x1 + 1 && a->v >= (float)y0 && a->v <= (float)y1 + 1);
            for (int r = s->first_border[a->other]; r < s->first_border[a->other + 1]; r++)
                if (s->borders[r].other == k) b = &s->borders[r];
            assert_non_null(b);
            assert_true(b->edge == a->edge && b->length == a->length);
            assert_memory_equal(&b->u, &a->u, sizeof a->u);
            assert_memory_equal(&b->v, &a->v, sizeof a->v);
            assert_memory_equal(&b->contrast, &a->contrast, sizeof a->contrast);
            sides += a->length;
        }
        assert_int_equal(sides, border(s, k, -1)); /* borders are complete */
    }
    assert_int_equal(listed, valid);
    assert_int_equal(s->first_border[s->count], 2 * s->edge_count);
    free(met);
    free(queue);
}

static void every_valid_pixel_is_in_one_connected_segment(void **state)
{
    (void)state;
    static paint_fn *const paints[] = {grey, noise, blobs, islands, disc, not_numbers};
    static const int sizes[] = {16, 64, 150};
    static const double compactness[] = {0.1, 8, 100};
    for (int k = 0; k < 6; k++)
        for (int i = 0; i < 3; i++) {
            struct segmentation s;
            struct gamma_image g;
            cut(&s, &g, 97, 61, paints[k], sizes[i], compactness[(i + k) % 3]);
            check_invariants(&s, &g);
            release(&s, &g);
        }
}

/* The upper rows begin one pixel farther to the right with every four columns, so that the first pixels of segments in
 * half the size are masked in the full one. */
static void sawtooth(int x, int y, float rgba[4])
{
    noise(x, y, rgba);
    rgba[3] = y % 12 > (x / 4 + y / 12) % 3 && (x + y) % 5 > 1;
}

static void segments_of_half_the_size_keep_their_numbers(void **state)
{
    (void)state;
    static paint_fn *const paints[] = {grey, noise, blobs, islands, disc, not_numbers, sawtooth};
    for (int k = 0; k < 7; k++)
        for (int odd = 0; odd < 2; odd++) {
            struct segmentation fine, s = {0}, doubled = {0};
            struct gamma_image g, half;
            struct err err = ERR_INIT;
            cut(&fine, &g, 96 + odd, 60 + odd, paints[k], 64, 8);
            assert_int_equal(gamma_image_half_covering(&half, &g, &err), ST_OK);
            assert_true(half.width == 48 + odd && half.height == 30 + odd);
            assert_int_equal(oversegment(&s, &half, 40, 8, &err), ST_OK);
            assert_int_equal(oversegment_double(&doubled, &s, &g, &err), ST_OK);
            assert_int_equal(doubled.count, s.count);
            for (int y = 0; y < g.height; y++)
                for (int x = 0; x < g.width; x++) {
                    const int i = y * g.width + x, own = s.label[y / 2 * half.width + x / 2];
                    assert_int_equal(doubled.label[i], g.valid[i] ? own : -1);
                    assert_true(!g.valid[i] || own >= 0);
                }
            for (int i = 0; i < s.count; i++) {
                assert_in_range(doubled.segments[i].pixels, 1, 4 * s.segments[i].pixels);
                if (doubled.segments[i].pixels < 4 * s.segments[i].pixels) continue; /* masked, or cut off */
                assert_near(doubled.segments[i].cx, 2 * s.segments[i].cx, 1e-9);
                assert_near(doubled.segments[i].cy, 2 * s.segments[i].cy, 1e-9);
            }
            oversegment_release(&doubled);
            release(&s, &half);
            release(&fine, &g);
        }
}

static void segments_have_about_the_requested_size(void **state)
{
    (void)state;
    static paint_fn *const paints[] = {grey, noise, disc};
    for (int k = 0; k < 3; k++)
        for (int size = 16; size <= 256; size *= 2) {
            struct segmentation s;
            struct gamma_image g;
            cut(&s, &g, 160, 120, paints[k], size, 8);
            assert_near(s.count * size / 19200.0, 1, paints[k] == noise ? 0.5 : 0.15);
            for (int i = 0; i < s.count; i++)
                assert_in_range(s.segments[i].pixels, size / 6, paints[k] == noise ? 19200 : 2 * size);
            release(&s, &g);
        }
}

static void a_uniform_picture_gives_a_grid(void **state)
{
    (void)state;
    struct segmentation s;
    struct gamma_image g;
    cut(&s, &g, 64, 48, grey, 64, 8);
    assert_int_equal(s.count, 48);
    for (int i = 0; i < s.count; i++) {
        assert_int_equal(s.segments[i].pixels, 64);
        assert_near(s.segments[i].cx, i % 8 * 8 + 4, 1e-9);
        assert_near(s.segments[i].cy, i / 8 * 8 + 4, 1e-9);
        assert_int_equal(s.segments[i].x1 - s.segments[i].x0, 7);
    }
    assert_int_equal(s.edge_count, 7 * 6 + 8 * 5);
    for (int t = 0; t < 2 * s.edge_count; t++) {
        assert_int_equal(s.borders[t].length, 8);
        assert_near(s.borders[t].contrast, 0, 1e-5);
    }
    release(&s, &g);
}

static void odd_picture_sizes_work(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {1, 500}, {500, 1}, {2, 2}, {3, 40}, {20000, 16}, {16, 3000}};
    static paint_fn *const paints[] = {grey, noise, nothing, islands};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        for (int k = 0; k < 4; k++) {
            struct segmentation s;
            struct gamma_image g;
            cut(&s, &g, sizes[i][0], sizes[i][1], paints[k], 64, 8);
            check_invariants(&s, &g);
            assert_true(k == 2 ? s.count == 0 : s.count > 0);
            release(&s, &g);
        }
    struct segmentation s;
    struct gamma_image g;
    cut(&s, &g, 30, 20, noise, 100000, 8); /* a segment larger than the picture */
    assert_int_equal(s.count, 1);
    assert_int_equal(s.segments[0].pixels, 600);
    release(&s, &g);
}

/* The fraction of pixels in a segment that lies mostly on the other side of the disc's edge. */
static double wrong_side(const struct segmentation *s)
{
    int wrong = 0;
    for (int k = 0; k < s->count; k++) {
        int inside = 0;
        for (int i = 0; i < s->segments[k].pixels; i++) {
            const int p = s->pixel[s->segments[k].first + i];
            inside += in_disc(p % s->width, p / s->width);
        }
        wrong += inside < s->segments[k].pixels - inside ? inside : s->segments[k].pixels - inside;
    }
    return (double)wrong / (s->width * s->height);
}

static void segments_respect_a_colour_edge(void **state)
{
    (void)state;
    struct segmentation s;
    struct gamma_image g;
    cut(&s, &g, 120, 90, disc, 64, 8);
    assert_true(wrong_side(&s) < 0.005); /* the rim itself is 1.7 % of the pixels */
    release(&s, &g);
    cut(&s, &g, 120, 90, disc, 64, 100); /* square segments do not respect it */
    assert_true(wrong_side(&s) > 0.01);
    release(&s, &g);
}

static void borders_store_their_contrast(void **state)
{
    (void)state;
    struct segmentation s;
    struct gamma_image g;
    double across = 0, within = 0;
    int across_count = 0, within_count = 0;
    cut(&s, &g, 120, 90, disc, 64, 8);
    for (int k = 0; k < s.count; k++)
        for (int t = s.first_border[k]; t < s.first_border[k + 1]; t++) {
            const double a = hypot(s.segments[k].cx - 60, s.segments[k].cy - 45);
            const double b = hypot(s.segments[s.borders[t].other].cx - 60, s.segments[s.borders[t].other].cy - 45);
            if ((a < 30) != (b < 30)) {
                across += (double)s.borders[t].contrast;
                across_count++;
            } else {
                within += (double)s.borders[t].contrast;
                within_count++;
            }
        }
    assert_true(across_count > 20 && within_count > 200);
    assert_true(across / across_count > 3 * within / within_count);
    release(&s, &g);
}

static void thread_counts_give_the_same_segments(void **state)
{
    (void)state;
    struct segmentation s[2];
    struct gamma_image g[2];
    for (int k = 0; k < 2; k++) {
        parallel_set_threads(1 + 2 * k);
        cut(&s[k], &g[k], 97, 61, blobs, 40, 8);
    }
    parallel_set_threads(0);
    assert_int_equal(s[0].count, s[1].count);
    assert_int_equal(s[0].edge_count, s[1].edge_count);
    assert_memory_equal(s[0].label, s[1].label, 97 * 61 * sizeof *s[0].label);
    assert_memory_equal(s[0].segments, s[1].segments, (size_t)s[0].count * sizeof *s[0].segments);
    assert_memory_equal(s[0].borders, s[1].borders, (size_t)s[0].edge_count * 2 * sizeof *s[0].borders);
    for (int k = 0; k < 2; k++) release(&s[k], &g[k]);
}

static void release_may_be_repeated(void **state)
{
    (void)state;
    struct segmentation s = {0};
    oversegment_release(NULL);
    oversegment_release(&s);
    oversegment_release(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_valid_pixel_is_in_one_connected_segment),
        cmocka_unit_test(segments_of_half_the_size_keep_their_numbers),
        cmocka_unit_test(segments_have_about_the_requested_size),
        cmocka_unit_test(a_uniform_picture_gives_a_grid),
        cmocka_unit_test(odd_picture_sizes_work),
        cmocka_unit_test(segments_respect_a_colour_edge),
        cmocka_unit_test(borders_store_their_contrast),
        cmocka_unit_test(thread_counts_give_the_same_segments),
        cmocka_unit_test(release_may_be_repeated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
