/* exposure.c - see exposure.h.
 *
 * Overview. A photographer exposes so that a small part of the picture saturates, and so does a camera's automatic. A
 * pixel saturates as soon as one of its colours does, so its level is the largest of the three. The exposure is one
 * over the level that the wanted share of pixels reaches: with n pixels, the k-th largest, k = ceil(saturated n), at
 * least 1, so that the brightest pixel is at white if nothing is to saturate.
 *
 * Mathematics. The k-th largest of n numbers is found by counting, not by sorting: bits of a number >= 0 in IEEE 754,
 * read as an integer, are in the order of the numbers. A histogram of the upper 11 bits says in which of 2048 intervals
 * the k-th number is; two more, of 10 bits each, over the numbers in the interval found before, say which it is. Time
 * is linear for any input, and the result is exact.
 *
 * Source: the exposure of views between photographs is [Colburn 2014, 4.6]. Different here: it is chosen from the
 * picture itself, so that pictures of edited rooms, which no camera saw, have one too. */
#include "common/texture/exposure.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "common/capture/view_image.h"
#include "common/image/exr.h"
#include "common/image/image.h"
#include "common/image/photo.h"
#include "common/math/numbers.h"

enum { BINS = 1 << 11, DIGITS = 3 }; /* 11 + 10 + 10 bits */
enum { JPEG_QUALITY = 95 };

static uint32_t level_bits(const struct model_picture *p, size_t i)
{
    const float *rgb = p->rgb + 3 * i;
    const float level = fmaxf(fmaxf(rgb[0], rgb[1]), fmaxf(rgb[2], 0));
    uint32_t bits;
    memcpy(&bits, &level, sizeof bits);
    return bits & 0x7fffffffu; /* -0 is 0 */
}

/* The bin from which upwards there are at least *k pixels; *k becomes what is missing to it within the bin. */
static uint32_t find_bin(const size_t *bins, size_t *k)
{
    uint32_t bin = BINS - 1;
    for (; bin > 0 && bins[bin] < *k; bin--) *k -= bins[bin];
    return bin;
}

/* The k-th largest level, k from 1 to the number of pixels that show something. */
static double select_level(const struct model_picture *p, size_t k)
{
    static const int shifts[DIGITS] = {20, 10, 0};
    const size_t pixels = (size_t)p->width * (size_t)p->height;
    uint32_t found = 0, known = 0; /* digits that are found, as a number and as a mask */
    for (int digit = 0; digit < DIGITS; digit++) {
        const uint32_t mask = (digit ? BINS / 2 : BINS) - 1;
        size_t bins[BINS] = {0};
        for (size_t i = 0; i < pixels; i++) {
            const uint32_t bits = level_bits(p, i);
            if (p->made[i] != MADE_NOTHING && (bits & known) == found) bins[bits >> shifts[digit] & mask]++;
        }
        found |= find_bin(bins, &k) << shifts[digit];
        known |= mask << shifts[digit];
    }
    float level;
    memcpy(&level, &found, sizeof level);
    return (double)level;
}

double exposure_choose(const struct model_picture *p, double saturated)
{
    const size_t pixels = (size_t)p->width * (size_t)p->height;
    size_t seen = 0;
    double level = 0;
    for (size_t i = 0; i < pixels; i++) seen += p->made[i] != MADE_NOTHING;
    const double wanted = ceil(saturated * (double)seen);
    const size_t k = wanted < 1 ? 1 : wanted > (double)seen ? seen : (size_t)wanted;
    if (seen) level = select_level(p, k);
    return level > 0 ? 1 / level : 1;
}

double exposure_follow(double exposure, double was, double is)
{
    const double low = fmin(EXPOSURE_DIM, was * exposure), high = fmax(EXPOSURE_BRIGHT, was * exposure);
    if (!(is > 0)) return exposure;
    return exposure * fmin(fmax(clamp(is * exposure, low, high) / (is * exposure), 1 / EXPOSURE_MOST), EXPOSURE_MOST);
}

static bool ends_in(const char *path, const char *ending)
{
    const size_t n = strlen(path), m = strlen(ending);
    return n > m && !strcmp(path + n - m, ending);
}

/* *bytes: 3 a pixel, sRGB; the caller frees them. */
static enum status to_srgb(unsigned char **bytes, const struct model_picture *p, double exposure, struct err *err)
{
    const size_t pixels = (size_t)p->width * (size_t)p->height;
    struct image im = {0};
    image_init(&im, p->width, p->height, 3, err);
    for (size_t i = 0; !err->status && i < pixels; i++)
        for (size_t c = 0; c < 3 && p->made[i] != MADE_NOTHING; c++)
            im.data[3 * i + c] = (float)(exposure * (double)p->rgb[3 * i + c]);
    if (!err->status && !(*bytes = malloc(pixels * 3))) err_nomem(err, "a picture", pixels * 3);
    if (!err->status) image_to_srgb8(&im, *bytes);
    image_release(&im);
    return err->status;
}

enum status exposure_write(const struct model_picture *p, double exposure, const char *path, struct err *err)
{
    const bool png = ends_in(path, ".png");
    unsigned char *bytes = NULL;
    if (!png && !ends_in(path, ".jpg") && !ends_in(path, ".jpeg"))
        return err_set(err, ST_USAGE, "%s: wanted a name that ends in .jpg, .jpeg or .png.", path);
    to_srgb(&bytes, p, exposure, err);
    if (!err->status) {
        if (png)
            png_write(path, bytes, p->width, p->height, 3, err);
        else
            jpeg_write(path, bytes, p->width, p->height, JPEG_QUALITY, err);
    }
    free(bytes);
    return err->status;
}

enum status exposure_write_frame(const struct model_picture *p, double exposure, const struct view *camera,
                                 const char *path, const struct provenance *prov, struct err *err)
{
    const size_t pixels = (size_t)p->width * (size_t)p->height;
    struct exr_image im = {0};
    float *rgba = calloc(pixels, 4 * sizeof *rgba);
    if (!rgba) err_nomem(err, "a frame", 4 * pixels * sizeof *rgba);
    for (size_t i = 0; !err->status && i < pixels; i++) {
        for (size_t c = 0; c < 3; c++) rgba[4 * i + c] = (float)(exposure * p->rgb[3 * i + c]);
        rgba[4 * i + 3] = p->made[i] != MADE_NOTHING;
    }
    if (!err->status && !exr_init_rgba(&im, rgba, p->width, p->height, err) &&
        !exr_add_plane(&im, "made", EXR_UINT, NULL, err)) {
        for (size_t i = 0; i < pixels; i++) im.planes[4].u[i] = p->made[i];
        view_image_set_camera(&im, camera);
        if (!exr_set_number(&im, "remodel:exposure", exposure, err)) exr_write(&im, path, prov, err);
    }
    exr_image_release(&im);
    free(rgba);
    return err->status;
}
