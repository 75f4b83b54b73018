/* hdr.c - one sample of the bench `hdr`: reads and merges the exposures of a view, as hdr_merge does.
 *
 * With --paint it makes the exposures instead, FOLDER/eK.jpg: JPEGs of a known radiance over four decades, with camera
 * noise. A sample prints one value per line:
 *   seconds                   reading, aligning and merging
 *   read_s, align_s, merge_s  its parts
 *   tone_s                    the tone-mapped picture for structure from motion
 *   write_s                   the EXR, in memory where the machine has /dev/shm
 *   mpixels                   of all exposures
 *   error, unit               median relative luminance error of the pixels that an exposure captures well
 * seconds and its parts are medians of as many runs as fit in a second, after one that does not count. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/clock.h"
#include "common/base/parallel.h"
#include "common/base/rng.h"
#include "common/base/sort.h"
#include "common/image/exr.h"
#include "common/math/numbers.h"
#include "stages/hdr_merge/align.h"
#include "stages/hdr_merge/bracket_noise.h"
#include "stages/hdr_merge/merge.h"
#include "stages/hdr_merge/tone.h"

enum { MAX_RUNS = 64, QUALITY = 94 };
#define RUN_SECONDS 1.0
#define ELECTRONS   30000

struct request {
    const char *folder;
    int width, height, exposures;
    bool paint;
};

static double median(double *values, int count)
{
    sort_doubles(values, (size_t)count);
    return values[count / 2];
}

/* Panels with structure of several sizes over four decades, smooth enough for JPEG. */
static double radiance_at(int x, int y, int c)
{
    const double u = x / 37.0, v = y / 29.0;
    const double large = sin(0.11 * u) * cos(0.13 * v), small = sin(1.3 * u + 0.7 * c) * sin(1.1 * v);
    const int panel = (x / 190 * 7 + y / 140 * 5) % 4;
    return pow(10, -1.2 + 1.1 * large + 0.12 * small + 0.6 * (panel - 1.5)) * (1 - 0.12 * c);
}

static double exposure_of(int k, int count) { return pow(4, k - count / 2); }

static double normal(const struct rng *rng, uint64_t i, uint32_t k)
{
    const double a = rng_uniform(rng, i, 2 * k), b = rng_uniform(rng, i, 2 * k + 1);
    return sqrt(-2 * log(1 - a)) * cos(2 * PI * b);
}

struct paint_job {
    unsigned char *rgb;
    int width, k;
    double exposure;
};

static void paint_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct paint_job *job = ctx;
    const struct rng rng = rng_make(1, "bench", "hdr");
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < job->width; x++)
            for (int c = 0; c < 3; c++) {
                const size_t i = 3 * (y * (size_t)job->width + (size_t)x) + (size_t)c;
                const double v = radiance_at(x, (int)y, c) * job->exposure;
                const double seen = v + normal(&rng, i, (uint32_t)job->k) * sqrt(v * ELECTRONS + 36) / ELECTRONS;
                job->rgb[i] = (unsigned char)lrintf(255 * srgb_from_linear((float)seen));
            }
}

static enum status paint(const struct request *r, struct err *err)
{
    const size_t samples = (size_t)r->width * (size_t)r->height * 3;
    unsigned char *rgb = malloc(samples);
    if (!rgb) err_nomem(err, "a photo", samples);
    for (int k = 0; !err->status && k < r->exposures; k++) {
        char path[FILE_PATH], name[32];
        struct paint_job job = {rgb, r->width, k, exposure_of(k, r->exposures)};
        parallel_for((size_t)r->height, 16, paint_rows, &job);
        snprintf(name, sizeof name, "e%d", k);
        if (!file_path(path, r->folder, name, ".jpg", err)) jpeg_write(path, rgb, r->width, r->height, QUALITY, err);
    }
    free(rgb);
    return err->status;
}

struct view {
    const struct request *request;
    struct photo photos[MERGE_MAX_EXPOSURES];
    double exposures[MERGE_MAX_EXPOSURES];
    struct err errs[MERGE_MAX_EXPOSURES];
    struct merged merged;
};

static void read_photos(void *ctx, size_t begin, size_t end, int thread)
{
    struct view *v = ctx;
    (void)thread;
    for (size_t k = begin; k < end; k++) {
        char path[FILE_PATH], name[32];
        snprintf(name, sizeof name, "e%zu", k);
        if (!file_path(path, v->request->folder, name, ".jpg", &v->errs[k]))
            photo_read_any(&v->photos[k], path, &v->errs[k]);
    }
}

struct times {
    double read, align, merge;
};

static void release(struct view *v)
{
    for (int k = 0; k < MERGE_MAX_EXPOSURES; k++) photo_release(&v->photos[k]);
    merge_release(&v->merged);
}

static enum status merge_once(struct view *v, struct times *times, struct err *err)
{
    static const struct response srgb;
    const struct merge_params params = MERGE_PARAMS_DEFAULT;
    const int count = v->request->exposures;
    struct alignment alignment;
    struct noise noise[MERGE_MAX_EXPOSURES], measured;
    bool known = false;
    const double begun = clock_seconds();
    parallel_for((size_t)count, 1, read_photos, v);
    for (int k = 0; k < count; k++) {
        if (v->errs[k].status) return err_set(err, v->errs[k].status, "%s", v->errs[k].text);
        v->exposures[k] = exposure_of(k, count);
    }
    const double read = clock_seconds();
    struct brackets b = {v->photos, v->exposures, count, &srgb, alignment.shifts};
    struct exposure_agreement agreement;
    align_brackets(&alignment, &b, count / 2, params.max_shift, err);
    const double aligned = clock_seconds();
    if (!err->status && !merge_agreement(&agreement, &b, err)) noise_measure(&measured, &known, &b, err);
    for (int k = 0; k < count; k++)
        noise[k] = known ? measured : noise_given(params.electrons, params.read_noise, &srgb, 8);
    if (!err->status) merge_brackets(&v->merged, &b, noise, &params, err);
    *times = (struct times){read - begun, aligned - read, clock_seconds() - aligned};
    return err->status;
}

static enum status find_error(const struct view *v, double *error, struct err *err)
{
    const struct request *r = v->request;
    const size_t pixels = (size_t)r->width * (size_t)r->height;
    double *errors = malloc(pixels * sizeof *errors);
    size_t n = 0;
    if (!errors) return err_nomem(err, "errors", pixels * sizeof *errors);
    for (int y = 0; y < r->height; y++)
        for (int x = 0; x < r->width; x++) {
            const float *rgb = image_at(&v->merged.radiance, x, y);
            double color[3], max = 0;
            for (int c = 0; c < 3; c++) max = fmax(max, color[c] = radiance_at(x, y, c));
            const double truth = 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2];
            bool well_exposed = false;
            for (int k = 0; k < r->exposures; k++)
                well_exposed |= max * v->exposures[k] < 0.76 && truth * v->exposures[k] > 0.05;
            if (well_exposed)
                errors[n++] =
                    fabs((0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2]) / truth - 1);
        }
    sort_doubles(errors, n);
    *error = n ? errors[n / 2] : 0;
    free(errors);
    return ST_OK;
}

static enum status write_radiance(const struct view *v, double *seconds, struct err *err)
{
    static const char *const names[] = {"R", "G", "B"};
    const size_t pixels = (size_t)v->request->width * (size_t)v->request->height;
    struct exr_image im = {0};
    struct exr_plane *plane = NULL;
    char path[FILE_PATH];
    const double begun = clock_seconds();
    if (!file_path(path, v->request->folder, "merged", ".exr", err))
        exr_image_init(&im, v->request->width, v->request->height, err);
    for (size_t c = 0; !err->status && c < 3; c++) {
        exr_add_plane(&im, names[c], EXR_HALF, &plane, err);
        for (size_t i = 0; !err->status && i < pixels; i++) plane->f[i] = v->merged.radiance.data[3 * i + c];
    }
    if (!err->status) exr_write(&im, path, NULL, err);
    *seconds = clock_seconds() - begun;
    exr_image_release(&im);
    return err->status;
}

static enum status sample(const struct request *r, struct err *err)
{
    struct view *v = calloc(1, sizeof *v);
    double total[MAX_RUNS], read[MAX_RUNS], align[MAX_RUNS], merge[MAX_RUNS], error = 0, wrote = 0, toned = 0;
    int runs = -1; /* the first run does not count */
    if (!v) err_nomem(err, "a view", sizeof *v);
    for (double begun = clock_seconds();
         !err->status && runs < MAX_RUNS && (runs < 1 || clock_seconds() - begun < RUN_SECONDS); runs++) {
        struct times t = {0};
        release(v);
        *v = (struct view){.request = r};
        merge_once(v, &t, err);
        if (runs < 0) begun = clock_seconds();
        if (err->status || runs < 0) continue;
        total[runs] = t.read + t.align + t.merge;
        read[runs] = t.read;
        align[runs] = t.align;
        merge[runs] = t.merge;
    }
    if (!err->status) find_error(v, &error, err);
    if (!err->status) {
        unsigned char *rgb = malloc((size_t)r->width * (size_t)r->height * 3);
        const double begun = clock_seconds();
        if (rgb)
            tone_map(rgb, &v->merged.radiance, err);
        else
            err_nomem(err, "a picture", 0);
        toned = clock_seconds() - begun;
        free(rgb);
    }
    if (!err->status) write_radiance(v, &wrote, err);
    if (!err->status)
        printf("seconds %.6f\nread_s %.6f\nalign_s %.6f\nmerge_s %.6f\ntone_s %.6f\nwrite_s %.6f\nmpixels %.6g\nerror "
               "%.4g\n"
               "unit 1\n",
               median(total, runs), median(read, runs), median(align, runs), median(merge, runs), toned, wrote,
               1e-6 * r->width * r->height * r->exposures, error);
    if (v) release(v);
    free(v);
    return err->status;
}

int main(int argc, char **argv)
{
    struct request r = {.width = 3000, .height = 2000, .exposures = 3};
    const struct cli_opt opts[] = {
        CLI_ABOUT("One sample of the bench hdr: reads and merges the exposures of a view."),
        CLI_STR("folder", &r.folder, CLI_REQUIRED, "folder of the exposures"),
        CLI_FLAG("paint", &r.paint, "only write the exposures"),
        CLI_INT("width", &r.width, CLI_OPTIONAL, "width of the view, px (default 3000)"),
        CLI_INT("height", &r.height, CLI_OPTIONAL, "height of the view, px (default 2000)"),
        CLI_INT("exposures", &r.exposures, CLI_OPTIONAL, "number of exposures (default 3)"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "bench_hdr", opts, &prov, &err) == CLI_RUN) {
        if (r.width < 8 || r.height < 8 || r.width > 30000 || r.height > 30000 || r.exposures < 1 ||
            r.exposures > MERGE_MAX_EXPOSURES)
            err_set(&err, ST_USAGE, "found %d x %d px and %d exposures, wanted 8 to 30000 px and 1 to %d exposures.",
                    r.width, r.height, r.exposures, (int)MERGE_MAX_EXPOSURES);
        else if (r.paint)
            paint(&r, &err);
        else
            sample(&r, &err);
    }
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
