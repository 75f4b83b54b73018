/* film_signal.c - signals of films.
 *
 * H.264 gets 8-bit sRGB, which ffmpeg converts. All other formats get planes of 10-bit Y'CbCr in the narrow range,
 * computed here, so that a radiance has one code value whatever ffmpeg's scaler does:
 *     Y' = Kr R' + Kg G' + Kb B', Cb = (B' - Y') / (2 - 2 Kb), Cr = (R' - Y') / (2 - 2 Kr)
 *     code = 64 + 876 Y', 512 + 896 C
 * with the constants of BT.709, or of BT.2020 (non-constant luminance) for films of high dynamic range. Chroma lies on
 * the left luma column of its pair, and between the two rows of a 4:2:0 pair: weights 1 2 1 across, 1 1 down.
 *
 * High dynamic range [ITU 2018]. Radiance goes to the primaries of BT.2020 [ITU 2015] and times FILM_WHITE becomes
 * light of the display, F, in cd/m2.
 *   PQ    E' = ((c1 + c2 Y^m1) / (1 + c3 Y^m1))^m2, Y = F / 10000
 *   HLG   is a signal of the scene, E' = OETF(E); E is the light whose rendering by the system's gamma (1.2 on a
 *         display of 1000 cd/m2) is F: E = (F / 1000) (Y / 1000)^((1 - 1.2) / 1.2), Y the luminance of F
 * so both show the same picture: white has the signal 0.58 in PQ and 0.75 in HLG. */
#include "common/film/film_signal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"

static const struct film_format formats[] = {
    {"h264", "mp4", "libx264", "rgb24", FILM_SRGB, 8, 1},
    {"av1", "mp4", "libsvtav1", "yuv420p10le", FILM_SRGB, 10, 2},
    {"prores", "mov", "prores_ks", "yuv422p10le", FILM_SRGB, 10, 1},
    {"hlg", "mp4", "libx265", "yuv420p10le", FILM_HLG, 10, 2},
    {"pq", "mp4", "libx265", "yuv420p10le", FILM_PQ, 10, 2},
};
enum { FORMATS = sizeof formats / sizeof *formats };

const struct film_format *film_format_find(const char *name)
{
    for (int i = 0; i < FORMATS; i++)
        if (!strcmp(formats[i].name, name)) return &formats[i];
    return NULL;
}

const char *film_format_names(void) { return "h264, av1, prores, hlg, pq"; }

double film_pq_from_light(double f)
{
    const double m1 = 2610.0 / 16384, m2 = 2523.0 / 4096 * 128;
    const double c1 = 3424.0 / 4096, c2 = 2413.0 / 4096 * 32, c3 = 2392.0 / 4096 * 32;
    const double y = pow(fmin(fmax(f / 10000, 0), 1), m1);
    return pow((c1 + c2 * y) / (1 + c3 * y), m2);
}

static double hlg_oetf(double e)
{
    const double a = 0.17883277, b = 1 - 4 * a, c = 0.5 - a * log(4 * a);
    if (!(e > 0)) return 0;
    return e <= 1.0 / 12 ? sqrt(3 * e) : fmin(1, a * log(12 * e - b) + c);
}

/* light: R G B of BT.2020, cd/m2; replaced by the signal. */
static void hlg_signal(double light[3])
{
    const double gamma = 1.2;
    const double y = (0.2627 * light[0] + 0.6780 * light[1] + 0.0593 * light[2]) / FILM_HLG_PEAK;
    const double factor = y > 0 ? pow(y, (1 - gamma) / gamma) / FILM_HLG_PEAK : 0;
    for (int k = 0; k < 3; k++) light[k] = hlg_oetf(factor * light[k]);
}

double film_hlg_from_light(double f)
{
    double grey[3] = {f, f, f};
    hlg_signal(grey);
    return grey[0];
}

/* Light in cd/m2, of BT.2020, from scene-linear Rec.709; negative and undefined radiance is dark. */
static void light_of(double out[3], const float *rgb, double peak)
{
    static const double to_2020[3][3] = {{0.627403896, 0.329283039, 0.043313065},
                                         {0.069097289, 0.919540395, 0.011362316},
                                         {0.016391439, 0.088013308, 0.895595253}};
    for (int k = 0; k < 3; k++) {
        double sum = 0;
        for (int i = 0; i < 3; i++) sum += to_2020[k][i] * (double)rgb[i];
        out[k] = sum > 0 ? fmin(FILM_WHITE * sum, peak) : 0;
    }
}

static void signal_of(double out[3], const struct film_format *format, const float *rgb, double peak)
{
    if (format->curve == FILM_SRGB) {
        for (int k = 0; k < 3; k++) out[k] = (double)srgb_from_linear(rgb[k]);
        return;
    }
    light_of(out, rgb, format->curve == FILM_HLG ? FILM_HLG_PEAK : peak);
    if (format->curve == FILM_HLG) hlg_signal(out);
    for (int k = 0; k < 3 && format->curve == FILM_PQ; k++) out[k] = film_pq_from_light(out[k]);
}

size_t film_format_bytes(const struct film_format *format, int width, int height)
{
    const size_t pixels = (size_t)width * (size_t)height;
    if (format->depth == 8) return 3 * pixels;
    return 2 * (pixels + pixels / (size_t)format->chroma_rows);
}

enum { ROWS = 5 };

struct signal_job {
    const struct film_format *format;
    const struct image *linear;
    double peak;
    uint16_t *planes[3];
    double *scratch; /* ROWS rows for each thread */
};

static uint16_t code(double value, double range, double zero)
{
    return (uint16_t)fmin(fmax(floor(zero + range * value + 0.5), 4), 1019);
}

/* Y' Cb Cr of a row, 0 to 1 and -0.5 to 0.5: three arrays of the picture's width. */
static void row_signal(double *y, double *cb, double *cr, const struct signal_job *job, int row)
{
    const bool wide = job->format->curve != FILM_SRGB;
    const double kr = wide ? 0.2627 : 0.2126, kb = wide ? 0.0593 : 0.0722;
    for (int x = 0; x < job->linear->width; x++) {
        double s[3];
        signal_of(s, job->format, image_at(job->linear, x, row), job->peak);
        y[x] = kr * s[0] + (1 - kr - kb) * s[1] + kb * s[2];
        cb[x] = (s[2] - y[x]) / (2 - 2 * kb);
        cr[x] = (s[0] - y[x]) / (2 - 2 * kr);
    }
}

/* Chroma at the left column of a pair. */
static double across(const double *c, int x, int width)
{
    const double before = c[x > 0 ? x - 1 : 0], after = c[x + 1 < width ? x + 1 : x];
    return (before + 2 * c[x] + after) / 4;
}

/* One row of chroma, with the rows of luma that share it. */
static void write_rows(const struct signal_job *job, int chroma_row, double *scratch)
{
    const int width = job->linear->width, rows = job->format->chroma_rows, half = width / 2;
    double *y = scratch, *sum_b = scratch + 3 * width, *sum_r = sum_b + width;
    for (int x = 0; x < width; x++) sum_b[x] = sum_r[x] = 0;
    for (int k = 0; k < rows; k++) {
        const int row = chroma_row * rows + k;
        double *cb = y + width, *cr = cb + width;
        row_signal(y, cb, cr, job, row);
        for (int x = 0; x < width; x++) {
            job->planes[0][(size_t)row * (size_t)width + (size_t)x] = code(y[x], 876, 64);
            sum_b[x] += cb[x] / rows;
            sum_r[x] += cr[x] / rows;
        }
    }
    for (int x = 0; x < half; x++) {
        const size_t at = (size_t)chroma_row * (size_t)half + (size_t)x;
        job->planes[1][at] = code(across(sum_b, 2 * x, width), 896, 512);
        job->planes[2][at] = code(across(sum_r, 2 * x, width), 896, 512);
    }
}

static void write_chunk(void *ctx, size_t begin, size_t end, int thread)
{
    const struct signal_job *job = ctx;
    double *scratch = job->scratch + ROWS * (size_t)thread * (size_t)job->linear->width;
    for (size_t row = begin; row < end; row++) write_rows(job, (int)row, scratch);
}

enum status film_format_signal(const struct film_format *format, const struct image *linear, double peak, void *out,
                               struct err *err)
{
    const size_t pixels = (size_t)linear->width * (size_t)linear->height;
    const size_t scratch = ROWS * (size_t)parallel_threads() * (size_t)linear->width * sizeof(double);
    struct signal_job job = {.format = format, .linear = linear, .peak = peak};
    if (format->depth == 8) {
        image_to_srgb8(linear, out);
        return ST_OK;
    }
    if (!(job.scratch = malloc(scratch))) return err_nomem(err, "rows of a frame", scratch);
    job.planes[0] = out;
    job.planes[1] = job.planes[0] + pixels;
    job.planes[2] = job.planes[1] + pixels / 2 / (size_t)format->chroma_rows;
    parallel_for((size_t)(linear->height / format->chroma_rows), 16, write_chunk, &job);
    free(job.scratch);
    return ST_OK;
}

void film_light_add(struct film_light *light, const struct image *linear, double peak)
{
    const size_t pixels = (size_t)linear->width * (size_t)linear->height;
    double sum = 0;
    for (size_t p = 0; p < pixels; p++) {
        double f[3];
        light_of(f, linear->data + p * (size_t)linear->channels, peak);
        const double most = fmax(f[0], fmax(f[1], f[2]));
        light->max_cll = fmax(light->max_cll, most);
        sum += most;
    }
    light->max_fall = fmax(light->max_fall, sum / (double)pixels);
}
