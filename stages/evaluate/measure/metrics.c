/* metrics.c - PSNR and SSIM.
 *
 * SSIM [Wang 2004]: with the means ma, mb, variances sa^2, sb^2 and covariance sab under a Gaussian window of 11 x 11
 * whose weights sum to 1,
 *   ssim = (2 ma mb + C1)(2 sab + C2) / ((ma^2 + mb^2 + C1)(sa^2 + sb^2 + C2)),  C1 = (K1 L)^2, C2 = (K2 L)^2.
 * The window is separable: rows are filtered first, then columns. Sums are kept per chunk of rows and added in order,
 * so that they do not depend on the number of threads.
 *
 * Differs from the source: the paper compares luminance; here R, G and B are compared and averaged. */
#include "stages/evaluate/measure/metrics.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"

#define WINDOW     11
#define SIGMA      1.5
#define CHUNK_ROWS 32
#define MOMENTS    5 /* a, b, a a, b b, a b */
#define MAX_PSNR   99.0

enum status metrics_psnr(const uint8_t *a, const uint8_t *b, int width, int height, const uint8_t *mask, double *db,
                         struct err *err)
{
    uint64_t sum = 0, pixels = 0; /* exact: 2^31 samples of at most 255^2 fit */
    size_t area = (size_t)width * (size_t)height;
    for (size_t i = 0; i < area; i++) {
        if (mask && !mask[i]) continue;
        for (size_t c = 3 * i; c < 3 * i + 3; c++) {
            int d = a[c] - b[c];
            sum += (uint64_t)(d * d);
        }
        pixels++;
    }
    if (!pixels) return err_set(err, ST_DATA, "no PSNR: not one pixel of %d x %d is to be compared.", width, height);
    *db = MAX_PSNR;
    if (sum) *db = fmin(MAX_PSNR, 10 * log10(255.0 * 255.0 * 3 * (double)pixels / (double)sum));
    return ST_OK;
}

struct ssim_sum {
    double value;
    uint64_t count;
};

struct ssim_job {
    const uint8_t *a, *b, *mask;
    int width, height; /* of the pictures */
    double kernel[WINDOW];
    double *scratch;       /* per thread: MOMENTS x (CHUNK_ROWS + WINDOW - 1) rows x columns of windows */
    struct ssim_sum *sums; /* per chunk */
};

/* Filters row y of channel c along x: the moments of each column of windows. */
static void filter_row(const struct ssim_job *job, int y, int c, double *out, size_t stride)
{
    int columns = job->width - WINDOW + 1;
    const uint8_t *a = job->a + (size_t)y * (size_t)job->width * 3 + c;
    const uint8_t *b = job->b + (size_t)y * (size_t)job->width * 3 + c;
    for (int x = 0; x < columns; x++) {
        double m[MOMENTS] = {0};
        for (int k = 0; k < WINDOW; k++) {
            double va = a[3 * (x + k)], vb = b[3 * (x + k)], w = job->kernel[k];
            m[0] += w * va;
            m[1] += w * vb;
            m[2] += w * va * va;
            m[3] += w * vb * vb;
            m[4] += w * va * vb;
        }
        for (int i = 0; i < MOMENTS; i++) out[(size_t)i * stride + (size_t)x] = m[i];
    }
}

static double window_ssim(const double m[MOMENTS])
{
    const double c1 = 0.01 * 255 * 0.01 * 255, c2 = 0.03 * 255 * 0.03 * 255;
    double ab = m[0] * m[1], aa = m[0] * m[0], bb = m[1] * m[1];
    return (2 * ab + c1) * (2 * (m[4] - ab) + c2) / ((aa + bb + c1) * (m[2] - aa + m[3] - bb + c2));
}

static void ssim_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct ssim_job *job = ctx;
    size_t columns = (size_t)(job->width - WINDOW + 1), stride = columns * (CHUNK_ROWS + WINDOW - 1);
    double *rows = job->scratch + (size_t)thread * MOMENTS * stride;
    struct ssim_sum *sum = &job->sums[begin / CHUNK_ROWS];
    for (int c = 0; c < 3; c++) {
        for (size_t y = begin; y < end + WINDOW - 1; y++)
            filter_row(job, (int)y, c, rows + (y - begin) * columns, stride);
        for (size_t y = begin; y < end; y++) {
            for (size_t x = 0; x < columns; x++) {
                size_t center = (y + WINDOW / 2) * (size_t)job->width + x + WINDOW / 2;
                if (job->mask && !job->mask[center]) continue;
                double m[MOMENTS] = {0};
                for (int i = 0; i < MOMENTS; i++)
                    for (size_t k = 0; k < WINDOW; k++)
                        m[i] += job->kernel[k] * rows[(size_t)i * stride + (y - begin + k) * columns + x];
                sum->value += window_ssim(m);
                sum->count++;
            }
        }
    }
}

enum status metrics_ssim(const uint8_t *a, const uint8_t *b, int width, int height, const uint8_t *mask, double *ssim,
                         struct err *err)
{
    if (width < WINDOW || height < WINDOW)
        return err_set(err, ST_DATA, "no SSIM: pictures of %d x %d pixels are smaller than its window of %d x %d.",
                       width, height, WINDOW, WINDOW);
    struct ssim_job job = {.a = a, .b = b, .mask = mask, .width = width, .height = height};
    size_t rows = (size_t)(height - WINDOW + 1), columns = (size_t)(width - WINDOW + 1);
    size_t chunks = (rows + CHUNK_ROWS - 1) / CHUNK_ROWS;
    size_t scratch = (size_t)parallel_threads() * MOMENTS * columns * (CHUNK_ROWS + WINDOW - 1) * sizeof(double);
    double weight = 0;

    for (int k = 0; k < WINDOW; k++) {
        double d = k - WINDOW / 2;
        job.kernel[k] = exp(-d * d / (2 * SIGMA * SIGMA));
        weight += job.kernel[k];
    }
    for (int k = 0; k < WINDOW; k++) job.kernel[k] /= weight;
    job.scratch = malloc(scratch);
    job.sums = calloc(chunks, sizeof *job.sums);
    if (!job.scratch || !job.sums) {
        err_nomem(err, "the windows of SSIM", scratch);
    } else {
        struct ssim_sum all = {0};
        parallel_for(rows, CHUNK_ROWS, ssim_rows, &job);
        for (size_t i = 0; i < chunks; i++) {
            all.value += job.sums[i].value;
            all.count += job.sums[i].count;
        }
        if (all.count)
            *ssim = all.value / (double)all.count;
        else
            err_set(err, ST_DATA, "no SSIM: not one window of %d x %d pixels is to be compared.", width, height);
    }
    free(job.scratch);
    free(job.sums);
    return err->status;
}

void metrics_ssim_windows(uint8_t *windows, const uint8_t *mask, int width, int height)
{
    memset(windows, 0, (size_t)width * (size_t)height);
    for (int y = 0; y < height; y++) { /* first pass: pixels whose row of the window is in the mask */
        int run = 0;
        for (int x = 0; x < width; x++) {
            run = mask[(size_t)y * (size_t)width + (size_t)x] ? run + 1 : 0;
            if (run >= WINDOW) windows[(size_t)y * (size_t)width + (size_t)(x - WINDOW / 2)] = 1;
        }
    }
    for (int x = 0; x < width;
         x++) { /* second pass: pixels with WINDOW of those rows; overwritten pixels have been read */
        uint32_t rows = 0;
        for (int y = 0; y < height + WINDOW / 2; y++) {
            uint8_t row = y < height ? windows[(size_t)y * (size_t)width + (size_t)x] : 0;
            rows = (rows << 1 | row) & ((1u << WINDOW) - 1);
            if (y >= WINDOW / 2)
                windows[(size_t)(y - WINDOW / 2) * (size_t)width + (size_t)x] = rows == (1u << WINDOW) - 1;
        }
    }
}
