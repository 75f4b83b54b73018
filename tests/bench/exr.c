/* exr.c - one sample of the bench `exr`: writes or reads a picture with common/image/exr.c or with the OpenEXR
 * library.
 *
 * Prints one value per line: seconds of one write or read (median of as many as fit in a third of a second, after
 * one that does not count), error (maximum relative difference of the samples read back) and its unit, mb (size of
 * the samples in the file before compression, 10^6 bytes), bytes (of the file), pixels.
 *
 * The picture is a file: a view, or a picture made by --paint, with structure of all sizes that falls off as 1/f,
 * edges, a bright lamp, and photon noise, because codecs spend most of their bytes on noise. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common/base/cli.h"
#include "common/base/clock.h"
#include "common/base/outfile.h"
#include "common/base/parallel.h"
#include "common/base/rng.h"
#include "common/image/exr.h"
#include "tests/bench/exr_openexr.h"

#define MAX_RUNS     64
#define RUN_SECONDS  0.33
#define LARGEST_HALF 65504.0F

struct request {
    const char *picture, *by, *direction, *codec, *folder;
    int width, height;
    bool by_openexr, paint;
};

/* ------------------------------------------------------------------------------------------------------ the picture */

/* Value noise: random values on a grid of cells of `size` pixels, interpolated smoothly. */
static double value_noise(const struct rng *rng, uint64_t layer, double x, double y, double size)
{
    const double u = x / size, v = y / size, fu = u - floor(u), fv = v - floor(v);
    const double su = fu * fu * (3 - 2 * fu), sv = fv * fv * (3 - 2 * fv);
    double corner[4];
    for (int i = 0; i < 4; i++) {
        uint64_t cell = (uint64_t)(floor(u) + i % 2) << 32 | (uint64_t)(floor(v) + i / 2);
        corner[i] = rng_uniform(rng, cell, layer);
    }
    return (1 - sv) * ((1 - su) * corner[0] + su * corner[1]) + sv * ((1 - su) * corner[2] + su * corner[3]) - 0.5;
}

struct painting {
    struct exr_image *im;
    struct rng rng;
};

static void paint_rows(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    const struct painting *p = ctx;
    const struct exr_image *im = p->im;
    const int width = im->width;
    for (size_t y = begin; y < end; y++) {
        for (int x = 0; x < width; x++) {
            const size_t at = y * (size_t)width + (size_t)x;
            const double u = (double)x / width, v = (double)y / im->height;
            double texture = 0;
            for (int octave = 0; octave < 8; octave++)
                texture += value_noise(&p->rng, (uint64_t)octave, x, (double)y, 2 << octave) * (1 << octave) / 128;
            /* a wall, a floor, a row of boxes in front, a lamp */
            double light = v > 0.7 ? 0.5 : 0.9 - 0.5 * u;
            const bool box = fmod(u * 6, 1) > 0.35 && v > 0.45 && v < 0.8;
            if (box) light *= 0.3 + 0.1 * floor(u * 6);
            if (hypot(u - 0.7, (v - 0.2) * im->height / width) < 0.03) light = 60;
            for (int c = 0; c < 3; c++) {
                double radiance = light * (1 + texture) * (box ? 0.5 + 0.2 * c : 1.0 - 0.1 * c);
                /* photon noise of a camera that counts 2^13 at radiance 1, approximated by a sum of uniforms */
                double normal = -2;
                for (unsigned k = 0; k < 4; k++) normal += rng_uniform(&p->rng, at, 16 + 4 * (uint64_t)c + k);
                radiance += normal * sqrt(3 * radiance / 8192);
                im->planes[c].f[at] = (float)fmax(radiance, 0);
            }
            im->planes[3].f[at] = 1;
        }
    }
}

static enum status paint(struct exr_image *im, int width, int height, struct err *err)
{
    static const char *const names[] = {"R", "G", "B", "A"};
    exr_image_init(im, width, height, err);
    for (int i = 0; !err->status && i < 4; i++) exr_add_plane(im, names[i], EXR_FLOAT, NULL, err);
    if (err->status) return err->status;
    struct painting p = {im, rng_make(1, "bench", "exr")};
    parallel_for((size_t)height, 16, paint_rows, &p);
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------- the sample */

static enum status codec_from_name(enum exr_codec *codec, const char *name, struct err *err)
{
    static const struct {
        const char *name;
        enum exr_codec codec;
    } known[] = {{"none", EXR_NONE}, {"RLE", EXR_RLE}, {"ZIPS", EXR_ZIPS}, {"ZIP", EXR_ZIP}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        if (strcmp(known[i].name, name)) continue;
        *codec = known[i].codec;
        return ST_OK;
    }
    return err_set(err, ST_USAGE, "found --codec %s, wanted none, RLE, ZIPS or ZIP.", name);
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static enum status go(const struct request *r, const struct exr_image *im, const char *path, struct exr_image *read,
                      struct err *err)
{
    if (!read) return r->by_openexr ? openexr_write(im, path, err) : exr_write(im, path, NULL, err);
    return r->by_openexr ? openexr_read(read, path, err) : exr_read(read, path, NULL, 0, err);
}

/* back: the result of the last read; unchanged when writing */
static enum status time_it(const struct request *r, const struct exr_image *im, const char *path, double *seconds,
                           struct exr_image *back, struct err *err)
{
    double runs[MAX_RUNS], total = 0;
    int count = 0;
    for (int i = -1; i < MAX_RUNS && total < RUN_SECONDS; i++) {
        exr_image_release(back);
        const double begin = clock_seconds();
        go(r, im, path, strcmp(r->direction, "write") ? back : NULL, err);
        const double took = clock_seconds() - begin;
        if (err->status) return err->status;
        if (i < 0) continue;
        runs[count++] = took;
        total += took;
    }
    qsort(runs, (size_t)count, sizeof *runs, by_value);
    *seconds = (runs[(count - 1) / 2] + runs[count / 2]) / 2;
    return ST_OK;
}

/* The maximum relative difference; different integers count as 1. */
static double difference(const struct exr_image *a, const struct exr_image *b)
{
    double max = a->count == b->count && a->width == b->width && a->height == b->height ? 0 : INFINITY;
    for (int i = 0; max < 1 && i < a->count; i++) {
        const struct exr_plane *p = &a->planes[i], *q = exr_find(b, p->name);
        if (!q || q->type != p->type) return INFINITY;
        for (size_t s = 0; s < (size_t)a->width * (size_t)a->height; s++) {
            if (p->type == EXR_UINT) {
                if (p->u[s] != q->u[s]) max = fmax(max, 1);
                continue;
            }
            double meant = p->f[s];
            if (p->type == EXR_HALF) meant = fmin(fmax(meant, -LARGEST_HALF), LARGEST_HALF);
            max = fmax(max, fabs(q->f[s] - meant) / fmax(fabs(meant), 0x1p-14)); /* the smallest normal half */
        }
    }
    return max;
}

static enum status sample(const struct request *r, struct err *err)
{
    struct exr_image im = {0}, back = {0};
    struct stat file;
    double seconds = 0, bytes = 0;
    enum exr_codec codec = EXR_ZIP;
    char *path = NULL;
    if (asprintf(&path, "%s/sample.exr", r->folder) < 0) return err_nomem(err, "a file name", strlen(r->folder));

    if (!codec_from_name(&codec, r->codec, err)) exr_read(&im, r->picture, NULL, 0, err);
    for (int i = 0; i < im.count; i++) /* colours are half in the file, as in all products */
        if (strlen(im.planes[i].name) == 1 && strchr("RGBA", im.planes[i].name[0])) im.planes[i].type = EXR_HALF;
    im.codec = codec;
    if (!err->status) {
        if (strcmp(r->direction, "write"))
            exr_write(&im, path, NULL, err);
        else
            outfile_make_folders(r->folder, err);
    }
    if (!err->status) time_it(r, &im, path, &seconds, &back, err);
    if (!err->status && !back.count) exr_read(&back, path, NULL, 0, err);
    if (!err->status && stat(path, &file)) err_errno(err, "read", path);
    for (int i = 0; i < im.count; i++) bytes += (double)im.width * im.height * (im.planes[i].type == EXR_HALF ? 2 : 4);
    if (!err->status)
        printf("seconds %.6f\nerror %.3g\nunit 1\nmb %.6g\nbytes %lld\npixels %lld\n", seconds, difference(&im, &back),
               bytes * 1e-6, (long long)file.st_size, (long long)im.width * im.height);
    exr_image_release(&im);
    exr_image_release(&back);
    free(path);
    return err->status;
}

static enum status write_painting(const struct request *r, struct err *err)
{
    struct exr_image im = {0};
    if (!paint(&im, r->width, r->height, err)) exr_write(&im, r->picture, NULL, err);
    exr_image_release(&im);
    return err->status;
}

static bool one_of(const char *word, const char *a, const char *b) { return !strcmp(word, a) || !strcmp(word, b); }

int main(int argc, char **argv)
{
    struct request r = {
        .direction = "write", .folder = ".", .by = "remodel", .codec = "ZIP", .width = 1920, .height = 1280};
    const struct cli_opt opts[] = {
        CLI_ABOUT("One sample of the bench exr: writes or reads a picture."),
        CLI_STR("direction", &r.direction, CLI_OPTIONAL, "write or read (default write)"),
        CLI_STR("folder", &r.folder, CLI_OPTIONAL, "folder for the file (default .)"),
        CLI_STR("picture", &r.picture, CLI_REQUIRED, "EXR file of the picture"),
        CLI_STR("by", &r.by, CLI_OPTIONAL, "implementation: remodel or OpenEXR (default remodel)"),
        CLI_STR("codec", &r.codec, CLI_OPTIONAL, "compression: none, RLE, ZIPS or ZIP (default ZIP)"),
        CLI_FLAG("paint", &r.paint, "only write the synthetic picture to the file PICTURE"),
        CLI_INT("width", &r.width, CLI_OPTIONAL, "width of the synthetic picture, px (default 1920)"),
        CLI_INT("height", &r.height, CLI_OPTIONAL, "height of the synthetic picture, px (default 1280)"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "bench_exr", opts, &prov, &err) == CLI_RUN) {
        r.by_openexr = !strcmp(r.by, "OpenEXR");
        openexr_set_threads(parallel_threads());
        if (!one_of(r.direction, "write", "read"))
            err_set(&err, ST_USAGE, "found --direction %s, wanted write or read.", r.direction);
        else if (!one_of(r.by, "remodel", "OpenEXR"))
            err_set(&err, ST_USAGE, "found --by %s, wanted remodel or OpenEXR.", r.by);
        else if (r.paint)
            write_painting(&r, &err);
        else
            sample(&r, &err);
    }
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
