/* crop_picture.c - separable resampling with the Catmull-Rom cubic [Keys 1981], widened by the factor of reduction.
 *
 * The first pass filters the rows that are needed into a strip, the second the strip's columns. Unlike the plain cubic,
 * each pass clamps its result to the range of the samples within one kernel unit, so there are no halos around lights
 * and no negative values. */
#include "stages/pan_scan/crop_picture.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/math/numbers.h"

enum { CHUNK = 8 };

struct filter_taps {      /* for the output pixels along one axis; arrays have one entry per pixel */
    int max_count;        /* weights allocated per pixel */
    int *first, *count;   /* first sample, number of samples */
    int *near_end, *near; /* taps [near, near_end) are within one kernel unit */
    float *weights;       /* max_count per pixel */
};

static void taps_release(struct filter_taps *t)
{
    free(t->first);
    free(t->weights);
    *t = (struct filter_taps){0};
}

static double kernel(double x)
{
    x = fabs(x);
    return x < 1 ? 1 + x * x * (1.5 * x - 2.5) : x < 2 ? 2 + x * (-4 + x * (2.5 - 0.5 * x)) : 0;
}

/* Taps of `pixels` pixels over the interval of `length` samples that begins at `from`. */
static enum status taps_make(struct filter_taps *t, int pixels, double from, double length, struct err *err)
{
    const double step = length / pixels, stretch = fmax(1, step);
    const size_t n = (size_t)pixels;
    *t = (struct filter_taps){.max_count = (int)ceil(4 * stretch) + 1};
    t->first = malloc(4 * n * sizeof *t->first);
    t->weights = malloc(n * (size_t)t->max_count * sizeof *t->weights);
    if (!t->first || !t->weights) {
        taps_release(t);
        return err_nomem(err, "a filter", n * (size_t)t->max_count * sizeof *t->weights);
    }
    t->count = t->first + n, t->near = t->count + n, t->near_end = t->near + n;
    for (int i = 0; i < pixels; i++) {
        const double at = from + (i + 0.5) * step - 0.5; /* in samples; their centres are integers here */
        float *weight = t->weights + (size_t)i * (size_t)t->max_count;
        double sum = 0;
        t->first[i] = (int)ceil(at - 2 * stretch);
        t->count[i] = (int)floor(at + 2 * stretch) - t->first[i] + 1;
        if (t->count[i] > t->max_count) t->count[i] = t->max_count;
        t->near[i] = (int)ceil(at - stretch);
        t->near_end[i] = (int)floor(at + stretch) + 1;
        t->near[i] -= t->first[i], t->near_end[i] -= t->first[i];
        for (int k = 0; k < t->count[i]; k++) sum += kernel((t->first[i] + k - at) / stretch);
        for (int k = 0; k < t->count[i]; k++) weight[k] = (float)(kernel((t->first[i] + k - at) / stretch) / sum);
    }
    return ST_OK;
}

/* Filters one pixel. Sample i of the axis, of `samples`, is at base + i stride. */
static void filter(float *out, const struct filter_taps *t, int pixel, const float *base, size_t stride, int samples,
                   int channels)
{
    const float *weight = t->weights + (size_t)pixel * (size_t)t->max_count;
    for (int c = 0; c < channels; c++) {
        float sum = 0, min = INFINITY, max = -INFINITY;
        for (int k = 0; k < t->count[pixel]; k++) {
            const float s = base[(size_t)clamp_int(t->first[pixel] + k, 0, samples - 1) * stride + (size_t)c];
            sum += weight[k] * s;
            if (k < t->near[pixel] || k >= t->near_end[pixel]) continue;
            min = s < min ? s : min;
            max = s > max ? s : max;
        }
        out[c] = sum < min ? min : sum > max ? max : sum;
    }
}

struct crop_passes {
    const struct image *picture;
    struct image strip; /* rows [top, top + strip.height) of the picture, filtered to the frame's width */
    int top;
    struct image *out;
    struct filter_taps across, down;
};

static void along_rows(void *ctx, size_t begin, size_t end, int thread)
{
    struct crop_passes *p = ctx;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < p->strip.width; x++)
            filter(image_at(&p->strip, x, (int)y), &p->across, x, image_at(p->picture, 0, p->top + (int)y),
                   (size_t)p->picture->channels, p->picture->width, p->picture->channels);
}

static void along_columns(void *ctx, size_t begin, size_t end, int thread)
{
    struct crop_passes *p = ctx;
    const size_t stride = (size_t)p->strip.width * (size_t)p->strip.channels;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < p->out->width; x++)
            filter(image_at(p->out, x, (int)y), &p->down, (int)y, image_at(&p->strip, x, 0), stride, p->strip.height,
                   p->strip.channels);
}

enum status crop_picture(struct image *out, const struct image *picture, const struct crop *crop, struct err *err)
{
    struct crop_passes p = {.picture = picture, .out = out};
    if (!taps_make(&p.across, out->width, crop->x, crop->width, err))
        taps_make(&p.down, out->height, crop->y, crop->height, err);
    if (!err->status) {
        const int last = out->height - 1;
        p.top = clamp_int(p.down.first[0], 0, picture->height - 1);
        const int bottom = clamp_int(p.down.first[last] + p.down.count[last] - 1, 0, picture->height - 1);
        for (int i = 0; i <= last; i++) p.down.first[i] -= p.top; /* indices into the strip */
        image_init(&p.strip, out->width, bottom - p.top + 1, picture->channels, err);
    }
    if (!err->status) {
        parallel_for((size_t)p.strip.height, CHUNK, along_rows, &p);
        parallel_for((size_t)out->height, CHUNK, along_columns, &p);
    }
    image_release(&p.strip);
    taps_release(&p.across);
    taps_release(&p.down);
    return err->status;
}
