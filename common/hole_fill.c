/* hole_fill.c - see hole_fill.h. */
#include "common/hole_fill.h"

#include <stdlib.h>
#include <string.h>

#include "common/parallel.h"

#define RADIUS     3 /* 7x7 */
#define LIST_CHUNK 1024
#define MAX_LEVELS 32

struct color_z {
    float rgb[3], z; /* z 0: unknown */
};

struct far_side {
    const struct soft_z *soft;
    float sigma;
};

/* Weighted mean that prefers the far ones; weights as given, 0 leaves one out. False if there is nothing. */
static bool far_mean(const struct far_side *far, const struct color_z *items, const float *weights, int count,
                     struct color_z *mean)
{
    float z_far = 0, sum = 0;
    for (int i = 0; i < count; i++)
        if (weights[i] > 0 && items[i].z > z_far) z_far = items[i].z;
    if (!(z_far > 0)) return false;

    const float rho = soft_z_rho(far->soft, z_far, far->sigma, z_far, far->sigma);
    struct color_z m = {0};
    for (int i = 0; i < count; i++) {
        if (!(weights[i] > 0) || !(items[i].z > 0)) continue;
        const float w = weights[i] * soft_z_weight(z_far - items[i].z, 0.1f * rho, rho);
        for (int k = 0; k < 3; k++) m.rgb[k] += w * items[i].rgb[k];
        m.z += w * items[i].z;
        sum += w;
    }
    for (int k = 0; k < 3; k++) mean->rgb[k] = m.rgb[k] / sum;
    mean->z = m.z / sum;
    return true;
}

static struct color_z pixel_get(const struct rendered_frame *f, size_t p)
{
    const float *c = f->rgba + 4 * p;
    return (struct color_z){{c[0], c[1], c[2]}, f->z[p]};
}

static void pixel_set(struct rendered_frame *f, size_t p, const struct color_z *v)
{
    float *c = f->rgba + 4 * p;
    memcpy(c, v->rgb, sizeof v->rgb);
    c[3] = 1;
    f->z[p] = v->z;
}

/* ---------------------------------------------------------------------------------------------- narrow holes */

static bool is_empty(const struct rendered_frame *f, size_t p) { return !(f->rgba[4 * p + 3] > 0); }

/* sums[(y + 1) * (w + 1) + x + 1]: of flags over [0, x] x [0, y]. */
static void summed_area(uint32_t *sums, const uint8_t *flags, int w, int h)
{
    memset(sums, 0, ((size_t)w + 1) * sizeof *sums);
    for (int y = 0; y < h; y++) {
        const uint32_t *above = sums + (size_t)y * ((size_t)w + 1);
        uint32_t *row = sums + ((size_t)y + 1) * ((size_t)w + 1), run = 0;
        row[0] = 0;
        for (int x = 0; x < w; x++) {
            run += flags[(size_t)y * (size_t)w + (size_t)x] != 0;
            row[x + 1] = above[x + 1] + run;
        }
    }
}

static uint32_t area(const uint32_t *sums, int w, int x0, int y0, int x1, int y1) /* over [x0, x1) x [y0, y1) */
{
    const size_t s = (size_t)w + 1, top = (size_t)y0 * s, bottom = (size_t)y1 * s;
    return sums[bottom + (size_t)x1] - sums[bottom + (size_t)x0] - sums[top + (size_t)x1] + sums[top + (size_t)x0];
}

enum status hole_narrow_pixels(uint32_t **list, size_t *count, const struct rendered_frame *f, int diameter,
                               struct err *err)
{
    const int w = f->width, h = f->height;
    const size_t pixels = (size_t)w * (size_t)h;
    uint32_t *sums = malloc(((size_t)w + 1) * ((size_t)h + 1) * sizeof *sums);
    uint8_t *flags = malloc(pixels);
    enum status st = ST_OK;

    *count = 0;
    *list = malloc(pixels * sizeof **list);
    if (!*list || !sums || !flags) {
        free(*list);
        *list = NULL;
        st = err_nomem(err, "the narrow holes of a frame", pixels * 9);
        goto done;
    }
    for (size_t p = 0; p < pixels; p++) flags[p] = is_empty(f, p);
    summed_area(sums, flags, w, h);
    memset(flags, 0, pixels); /* from here on: the upper left corner of a square of empty pixels */
    for (int y = 0; y + diameter <= h; y++)
        for (int x = 0; x + diameter <= w; x++)
            flags[(size_t)y * (size_t)w + (size_t)x] =
                area(sums, w, x, y, x + diameter, y + diameter) == (uint32_t)diameter * (uint32_t)diameter;
    summed_area(sums, flags, w, h);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            const size_t p = (size_t)y * (size_t)w + (size_t)x;
            const int x0 = x >= diameter ? x - diameter + 1 : 0, y0 = y >= diameter ? y - diameter + 1 : 0;
            if (is_empty(f, p) && !area(sums, w, x0, y0, x + 1, y + 1)) (*list)[(*count)++] = (uint32_t)p;
        }
done:
    free(flags);
    free(sums);
    return st;
}

struct narrow_pass {
    const struct rendered_frame *frame;
    const struct far_side *far;
    const uint32_t *list;
    struct color_z *filled; /* parallel to the list */
};

static void narrow_chunk(void *ctx, size_t begin, size_t end, int thread)
{
    const struct narrow_pass *n = ctx;
    const struct rendered_frame *f = n->frame;
    (void)thread;

    for (size_t i = begin; i < end; i++) {
        const int x = (int)(n->list[i] % (uint32_t)f->width), y = (int)(n->list[i] / (uint32_t)f->width);
        struct color_z items[(2 * RADIUS + 1) * (2 * RADIUS + 1)];
        float weights[(2 * RADIUS + 1) * (2 * RADIUS + 1)];
        int count = 0;
        for (int v = y - RADIUS; v <= y + RADIUS; v++)
            for (int u = x - RADIUS; u <= x + RADIUS; u++) {
                if (u < 0 || v < 0 || u >= f->width || v >= f->height) continue;
                const size_t p = (size_t)v * (size_t)f->width + (size_t)u;
                weights[count] = f->rgba[4 * p + 3];
                items[count++] = pixel_get(f, p);
            }
        n->filled[i] = (struct color_z){0};
        far_mean(n->far, items, weights, count, &n->filled[i]);
    }
}

enum status hole_fill_pixels(struct rendered_frame *f, const uint32_t *list, size_t count, const struct soft_z *soft,
                             float sigma, int diameter, struct err *err)
{
    const struct far_side far = {soft, sigma};
    struct color_z *filled = malloc((count + 1) * sizeof *filled);

    if (!filled) return err_nomem(err, "the narrow holes of a frame", count * sizeof *filled);
    /* each pass reads the one before only, so the far side crosses RADIUS pixels a pass, whatever the order */
    for (int reached = 0; count && reached < diameter; reached += RADIUS) {
        struct narrow_pass pass = {f, &far, list, filled};
        parallel_for(count, LIST_CHUNK, narrow_chunk, &pass);
        for (size_t i = 0; i < count; i++)
            if (filled[i].z > 0) pixel_set(f, list[i], &filled[i]);
    }
    free(filled);
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------ wide holes */

struct level {
    int w, h;
    struct color_z *texels;
};

struct pyramid_step {
    const struct level *from, *to;
    const struct far_side *far;
};

static void pull_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct pyramid_step *s = ctx;
    (void)thread;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < s->to->w; x++) {
            struct color_z items[4] = {0}, *to = &s->to->texels[(size_t)y * (size_t)s->to->w + (size_t)x];
            float weights[4] = {0};
            for (int k = 0; k < 4; k++) {
                const int u = 2 * x + (k & 1), v = 2 * y + (k >> 1);
                if (u >= s->from->w || v >= s->from->h) continue;
                items[k] = s->from->texels[(size_t)v * (size_t)s->from->w + (size_t)u];
                weights[k] = items[k].z > 0;
            }
            *to = (struct color_z){0};
            far_mean(s->far, items, weights, 4, to);
        }
}

static void push_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct pyramid_step *s = ctx;
    (void)thread;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < s->to->w; x++) {
            struct color_z items[4] = {0}, *to = &s->to->texels[(size_t)y * (size_t)s->to->w + (size_t)x];
            float weights[4] = {0};
            if (to->z > 0) continue;
            for (int k = 0; k < 4; k++) { /* bilinear: the parent has 3/4 of each axis */
                const int u = x / 2 + ((k & 1) ? (x & 1 ? 1 : -1) : 0), v = y / 2 + ((k >> 1) ? (y & 1 ? 1 : -1) : 0);
                if (u < 0 || v < 0 || u >= s->from->w || v >= s->from->h) continue;
                items[k] = s->from->texels[(size_t)v * (size_t)s->from->w + (size_t)u];
                weights[k] = ((k & 1) ? 0.25f : 0.75f) * ((k >> 1) ? 0.25f : 0.75f);
            }
            far_mean(s->far, items, weights, 4, to);
        }
}

static enum status fill_wide(struct rendered_frame *f, const struct far_side *far, struct err *err)
{
    struct level levels[MAX_LEVELS] = {{f->width, f->height, NULL}};
    const size_t pixels = (size_t)f->width * (size_t)f->height;
    enum status st = ST_OK;
    int count = 1;

    while (levels[count - 1].w > 1 || levels[count - 1].h > 1) {
        levels[count] = (struct level){(levels[count - 1].w + 1) / 2, (levels[count - 1].h + 1) / 2, NULL};
        count++;
    }
    for (int i = 0; i < count; i++) {
        const size_t size = (size_t)levels[i].w * (size_t)levels[i].h * sizeof *levels[i].texels;
        levels[i].texels = malloc(size);
        if (!levels[i].texels) {
            st = err_nomem(err, "a pyramid of a frame", size);
            goto done;
        }
    }
    for (size_t p = 0; p < pixels; p++)
        levels[0].texels[p] = f->rgba[4 * p + 3] > 0 ? pixel_get(f, p) : (struct color_z){0};
    for (int i = 0; i + 1 < count; i++) {
        struct pyramid_step step = {&levels[i], &levels[i + 1], far};
        parallel_for((size_t)step.to->h, 32, pull_rows, &step);
    }
    for (int i = count - 2; i >= 0; i--) {
        struct pyramid_step step = {&levels[i + 1], &levels[i], far};
        parallel_for((size_t)step.to->h, 32, push_rows, &step);
    }
    for (size_t p = 0; p < pixels; p++)
        if (!(f->rgba[4 * p + 3] > 0) && levels[0].texels[p].z > 0) pixel_set(f, p, &levels[0].texels[p]);
done:
    for (int i = 0; i < count; i++) free(levels[i].texels);
    return st;
}

static size_t count_empty(const struct rendered_frame *f)
{
    size_t empty = 0;
    for (size_t p = 0; p < (size_t)f->width * (size_t)f->height; p++) empty += is_empty(f, p);
    return empty;
}

enum status hole_fill(struct rendered_frame *frame, const struct soft_z *soft, float sigma, int diameter,
                      struct err *err)
{
    const struct far_side far = {soft, sigma};
    const double pixels = (double)frame->width * (double)frame->height;
    uint32_t *list = NULL;
    size_t count = 0;
    enum status st = ST_OK;

    if (diameter > 0 && count_empty(frame)) {
        st = hole_narrow_pixels(&list, &count, frame, diameter, err);
        if (!st) st = hole_fill_pixels(frame, list, count, soft, sigma, diameter, err);
        if (!st && count_empty(frame)) st = fill_wide(frame, &far, err);
    }
    frame->unfilled_fraction = (double)count_empty(frame) / pixels;
    free(list);
    return st;
}
