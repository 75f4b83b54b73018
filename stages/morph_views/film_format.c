/* film_format.c - turning, scaling and cropping of photos; see film_format.h. */
#include "stages/morph_views/film_format.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/math/numbers.h"

enum { MIN_SIDE = 32, CHUNK = 16 };

void film_upright_size(int *width, int *height, int stored_width, int stored_height, int orientation)
{
    *width = orientation >= 5 ? stored_height : stored_width;
    *height = orientation >= 5 ? stored_width : stored_height;
}

enum status film_size(int *width, int *height, int photo_width, int photo_height, int max_side, struct err *err)
{
    int longest = photo_width > photo_height ? photo_width : photo_height;
    double scale = longest > max_side ? (double)max_side / longest : 1;
    *width = 2 * (int)floor(photo_width * scale / 2 + (scale < 1 ? 0.5 : 0));
    *height = 2 * (int)floor(photo_height * scale / 2 + (scale < 1 ? 0.5 : 0));
    if (*width > max_side) *width -= 2; /* if max_side is odd */
    if (*height > max_side) *height -= 2;
    if (*width < MIN_SIDE || *height < MIN_SIDE)
        return err_set(err, ST_DATA,
                       "its %d x %d pixels give a film of %d x %d; wanted at least %d on each side. Use a larger "
                       "photo, or raise max_side.",
                       photo_width, photo_height, *width, *height, MIN_SIDE);
    return ST_OK;
}

/* stored pixel = m (x, y, 1) for an upright pixel (x, y), for the eight orientations of EXIF. */
static void stored_from_upright(double m[2][3], int w, int h, int orientation)
{
    static const signed char axes[8][4] = {/* du/dx, du/dy, dv/dx, dv/dy */
                                           {1, 0, 0, 1}, {-1, 0, 0, 1}, {-1, 0, 0, -1}, {1, 0, 0, -1},
                                           {0, 1, 1, 0}, {0, 1, -1, 0}, {0, -1, -1, 0}, {0, -1, 1, 0}};
    const signed char *axis = axes[orientation >= 1 && orientation <= 8 ? orientation - 1 : 0];
    for (int i = 0; i < 2; i++) {
        m[i][0] = axis[2 * i];
        m[i][1] = axis[2 * i + 1];
        m[i][2] = m[i][0] + m[i][1] < 0 ? (i ? h : w) : 0;
    }
}

struct tent_taps { /* of an output pixel, along one axis */
    int first, count;
    float *weights;
};

struct resampling {
    const struct image *stored;
    struct image *out;
    int step_x[2], step_y[2], origin[2]; /* stored index = origin + x step_x + y step_y of an upright index */
    struct tent_taps *columns, *rows;
    float *weights;
};

/* Taps of a tent filter of half width max(scale, 1) for `count` output pixels; size: of the input axis. */
static void make_taps(struct tent_taps *taps, float *weights, int room, int count, double scale, double offset,
                      int size)
{
    double radius = fmax(scale, 1);
    for (int i = 0; i < count; i++) {
        double at = offset + (i + 0.5) * scale - 0.5, sum = 0;
        int first = (int)floor(at - radius) + 1, last = (int)ceil(at + radius) - 1;
        first = clamp_int(first, 0, size - 1);
        last = clamp_int(last, first, size - 1);
        struct tent_taps *t = &taps[i];
        *t = (struct tent_taps){first, last - first + 1, weights + (size_t)i * (size_t)room};
        for (int k = 0; k < t->count; k++) sum += t->weights[k] = (float)fmax(1 - fabs(first + k - at) / radius, 1e-6);
        for (int k = 0; k < t->count; k++) t->weights[k] = (float)(t->weights[k] / sum);
        if (scale == 1) *t = (struct tent_taps){(int)floor(offset + i + 0.5), 1, t->weights};
        if (scale == 1) t->weights[0] = 1;
    }
}

static void resample_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct resampling *r = ctx;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < r->out->width; x++) {
            const struct tent_taps *tx = &r->columns[x], *ty = &r->rows[y];
            float *out = image_at(r->out, x, (int)y);
            for (int j = 0; j < ty->count; j++)
                for (int i = 0; i < tx->count; i++) {
                    int ux = tx->first + i, uy = ty->first + j;
                    const float *in = image_at(r->stored, r->origin[0] + ux * r->step_x[0] + uy * r->step_y[0],
                                               r->origin[1] + ux * r->step_x[1] + uy * r->step_y[1]);
                    float weight = tx->weights[i] * ty->weights[j];
                    for (int c = 0; c < 3; c++) out[c] += weight * in[c];
                }
        }
}

static void invert(double out[2][3], const double m[2][3])
{
    double d = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    out[0][0] = m[1][1] / d;
    out[0][1] = -m[0][1] / d;
    out[1][0] = -m[1][0] / d;
    out[1][1] = m[0][0] / d;
    for (int i = 0; i < 2; i++) out[i][2] = -(out[i][0] * m[0][2] + out[i][1] * m[1][2]);
}

enum status film_picture_make(struct film_picture *out, const struct image *stored, int orientation, int width,
                              int height, struct err *err)
{
    struct resampling r = {.stored = stored, .out = &out->rgb};
    double m[2][3], offset[2];
    int w, h;
    film_upright_size(&w, &h, stored->width, stored->height, orientation);
    double scale = fmin((double)w / width, (double)h / height);
    if (scale * scale * width * height < 0.5 * w * h)
        return err_set(err, ST_DATA,
                       "its %d x %d pixels, turned upright, do not fit the shape of the first photo's film of %d x %d: "
                       "more than half of the photo would be cut off. Crop both photos to the same shape.",
                       w, h, width, height);
    offset[0] = (w - width * scale) / 2;
    offset[1] = (h - height * scale) / 2;
    if (scale == 1) {
        offset[0] = floor(offset[0]);
        offset[1] = floor(offset[1]);
    }
    stored_from_upright(m, stored->width, stored->height, orientation);
    for (int i = 0; i < 2; i++) {
        r.step_x[i] = (int)m[i][0];
        r.step_y[i] = (int)m[i][1];
        r.origin[i] = m[i][0] + m[i][1] < 0 ? (i ? stored->height : stored->width) - 1 : 0;
        out->photo_from_film[i][0] = m[i][0] * scale;
        out->photo_from_film[i][1] = m[i][1] * scale;
        out->photo_from_film[i][2] = m[i][0] * offset[0] + m[i][1] * offset[1] + m[i][2];
    }
    invert(out->film_from_photo, (const double(*)[3])out->photo_from_film);
    out->stored_width = stored->width;
    out->stored_height = stored->height;

    int room = 2 * (int)ceil(fmax(scale, 1)) + 2;
    size_t bytes = (size_t)(width + height) * (size_t)room * sizeof *r.weights;
    r.weights = malloc(bytes);
    r.columns = malloc((size_t)(width + height) * sizeof *r.columns);
    if (!r.weights || !r.columns) err_nomem(err, "a film's filter", bytes);
    if (!err->status && !image_init(&out->rgb, width, height, 3, err)) {
        r.rows = r.columns + width;
        make_taps(r.columns, r.weights, room, width, scale, offset[0], w);
        make_taps(r.rows, r.weights + (size_t)width * (size_t)room, room, height, scale, offset[1], h);
        parallel_for((size_t)height, CHUNK, resample_rows, &r);
    }
    free(r.columns);
    free(r.weights);
    return err->status;
}

void film_picture_release(struct film_picture *p)
{
    if (!p) return;
    image_release(&p->rgb);
    *p = (struct film_picture){0};
}
