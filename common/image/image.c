/* image.c - float images, and the sRGB curve. */
#include "common/image/image.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/image/samples.h"

enum status image_init(struct image *im, int width, int height, int channels, struct err *err)
{
    *im = (struct image){0};
    if (width < 1 || height < 1 || channels < 1)
        return err_set(err, ST_DATA,
                       "an image of %d x %d pixels with %d channels is not possible; each must be at least 1.", width,
                       height, channels);
    uint64_t area = (uint64_t)width * (uint64_t)height;
    if (area > (UINT64_C(1) << 31) / (uint64_t)channels)
        return err_set(err, ST_DATA,
                       "an image of %d x %d pixels with %d channels is too large; the limit is 2^31 samples.", width,
                       height, channels);
    size_t bytes = (size_t)area * (size_t)channels * sizeof(float);
    im->data = samples_alloc(bytes);
    if (!im->data) return err_nomem(err, "an image", bytes);
    im->width = width;
    im->height = height;
    im->channels = channels;
    return ST_OK;
}

void image_release(struct image *im)
{
    if (!im) return;
    free(im->data);
    *im = (struct image){0};
}

float srgb_from_linear(float linear)
{
    if (!(linear > 0)) return 0; /* NaN too */
    if (linear >= 1) return 1;
    return linear <= 0.0031308F ? 12.92F * linear : 1.055F * powf(linear, 1 / 2.4F) - 0.055F;
}

float linear_from_srgb(float srgb) { return srgb <= 0.04045F ? srgb / 12.92F : powf((srgb + 0.055F) / 1.055F, 2.4F); }

struct srgb8_job {
    const struct image *im;
    unsigned char *out;
};

static void srgb8_rows(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    const struct srgb8_job *job = ctx;
    int channels = job->im->channels;
    size_t width = (size_t)job->im->width;
    for (size_t i = begin * width; i < end * width; i++) {
        const float *pixel = job->im->data + i * (size_t)channels;
        for (int c = 0; c < 3; c++) {
            float value = channels >= 3 ? pixel[c] : pixel[0];
            job->out[3 * i + (size_t)c] = (unsigned char)(255 * srgb_from_linear(value) + 0.5F);
        }
    }
}

void image_to_srgb8(const struct image *im, unsigned char *out)
{
    struct srgb8_job job = {im, out};
    parallel_for((size_t)im->height, 16, srgb8_rows, &job);
}
