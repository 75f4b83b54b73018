/* webp_picture.c - pictures of a walk: colours with little loss, alpha without, the same bytes each time; pages of
 * atlases say by alpha what their texels come from. */
#include "stages/walk/webp_picture.h"

#include <math.h>
#include <webp/decode.h>

#include "stages/walk/atlas_texture.h"
#include "tests/unit/scratch.h"

enum { WIDTH = 64, HEIGHT = 48, PIXELS = WIDTH * HEIGHT };

static void a_picture_comes_back(void **state)
{
    static unsigned char rgba[4 * PIXELS];
    unsigned char *bytes = NULL, *again = NULL;
    size_t size, size_again;
    struct err err = ERR_INIT;
    int width, height;
    double sum = 0;
    (void)state;
    for (int i = 0; i < PIXELS; i++) {
        const int x = i % WIDTH, y = i / WIDTH;
        const unsigned char pixel[4] = {(unsigned char)(3 * x), (unsigned char)(4 * y), (unsigned char)(x + y),
                                        (unsigned char)(x < 20 ? 0 : 64 * (y / 16) + 63)};
        memcpy(rgba + 4 * i, pixel, sizeof pixel);
    }
    assert_ok(webp_picture_encode(&bytes, &size, rgba, WIDTH, HEIGHT, 90, 3, &err), err);
    assert_ok(webp_picture_encode(&again, &size_again, rgba, WIDTH, HEIGHT, 90, 3, &err), err);
    assert_int_equal(size, size_again);
    assert_memory_equal(bytes, again, size);
    unsigned char *back = WebPDecodeRGBA(bytes, size, &width, &height);
    assert_non_null(back);
    assert_int_equal(width, WIDTH);
    assert_int_equal(height, HEIGHT);
    for (int i = 0; i < PIXELS; i++) {
        assert_int_equal(back[4 * i + 3], rgba[4 * i + 3]);
        for (int c = 0; c < 3; c++) sum += pow(back[4 * i + c] - rgba[4 * i + c], 2);
    }
    assert_true(sqrt(sum / (3 * PIXELS)) < 3);
    WebPFree(back);
    free(bytes);
    free(again);
}

/* A page of one tile: original, from another photo, synthesised, default, none. */
static void alpha_says_what_texels_come_from(void **state)
{
    char first[] = "v1", second[] = "v2", *views[] = {first}, *sources[] = {first, second};
    struct atlas_tile tile = {.face = 1, .width = 5, .height = 1};
    int sizes[1][2] = {{5, 1}};
    const struct atlas a = {.views = views,
                            .view_count = 1,
                            .sources = sources,
                            .source_count = 2,
                            .tiles = &tile,
                            .tile_count = 1,
                            .page_sizes = sizes,
                            .page_count = 1};
    const uint32_t made[5] = {ATLAS_VIEWS, ATLAS_VIEWS + 1, ATLAS_SYNTHESISED, ATLAS_DEFAULT, ATLAS_NONE};
    const unsigned char wanted[5] = {ALPHA_ORIGINAL, ALPHA_WARPED, ALPHA_SYNTHESISED, ALPHA_DEFAULT, ALPHA_NONE};
    const struct walk_params params = WALK_PARAMS_DEFAULT;
    struct atlas_page page = {0};
    struct err err = ERR_INIT;
    char *text = NULL;
    size_t length;
    int width, height;
    (void)state;
    assert_ok(atlas_page_init(&page, 5, 1, &err), err);
    for (int i = 0; i < 5; i++) page.source[i] = made[i];
    for (int i = 0; i < 12; i++) page.rgb[i] = 0.25f;
    FILE *to = open_memstream(&text, &length);
    assert_ok(atlas_texture_write(to, &a, &page, 0, 4, &params, &err), err);
    fclose(to);
    for (int c = 0; c < 3; c++) assert_float_equal(page.rgb[12 + c], 0.25f, 0); /* spread */
    assert_int_equal(text[0], '"');
    unsigned char bytes[1024];
    size_t size = 0;
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (const char *p = text + 1; *p != '"' && *p != '='; p += 4) {
        unsigned bits = 0;
        for (int k = 0; k < 4; k++) bits = bits << 6 | (p[k] == '=' ? 0u : (unsigned)(strchr(digits, p[k]) - digits));
        for (int k = 2; k >= 0; k--) bytes[size++] = (unsigned char)(bits >> (8 * k));
        if (p[3] == '=') break;
    }
    unsigned char *back = WebPDecodeRGBA(bytes, size, &width, &height);
    assert_non_null(back);
    for (int i = 0; i < 5; i++) {
        assert_int_equal(back[4 * i + 3], wanted[i]);
        for (int c = 0; c < 3; c++) assert_true(back[4 * i + c] > 250); /* white: radiance times exposure is 1 */
    }
    WebPFree(back);
    free(text);
    atlas_page_release(&page);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_picture_comes_back),
        cmocka_unit_test(alpha_says_what_texels_come_from),
    };
    return cmocka_run_group_tests_name("webp_picture", tests, NULL, NULL);
}
