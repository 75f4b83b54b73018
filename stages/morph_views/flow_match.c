/* flow_match.c - discrete optical flow: coarse-to-fine semi-global matching [Hirschmueller 2008] with a soft epipolar
 * constraint.
 *
 * At each level of an image pyramid every pixel has up to LABELS candidate flows, which differ from pixel to pixel as
 * in [Menze 2015]. At the coarsest level they are the cheapest of all flows in the search range; at finer levels they
 * come from the coarser level, here and around, from the results of more distant pixels, from steps of one pixel, and
 * from matched features nearby. The energy of a labelling is
 *   E = sum over pixels (data cost + epipolar cost) + sum over neighbours (smoothness cost)
 * data cost: census and colour, each mapped to [0, 1] by 1 - exp(-difference / scale) as in ADCensus [Mei 2011];
 * epipolar cost: distance from the epipolar line, truncated; smoothness cost: difference of the flows, truncated, less
 * where the picture has an edge. Semi-global matching minimises it along eight directions.
 *
 * View morphing in [Colburn 2014, 3.4.5] uses a stereo method with a soft epipolar constraint. Here labels are flows,
 * not disparities, so an object that moved between the photos is one more label: it pays the truncated epipolar cost
 * once per pixel. */
#include "stages/morph_views/flow_match.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/image/luminance.h"
#include "common/math/lanes.h"
#include "common/math/numbers.h"

#define PARAM_STRUCT struct morph_params
const struct param morph_param_table[] = {MORPH_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

enum status morph_params_check(const void *values, struct err *err)
{
    const struct morph_params *p = values;
    if (floor(p->seconds * p->fps + 0.5) >= 2) return ST_OK;
    return err_set(err, ST_USAGE,
                   "[morph_views] seconds = %g at fps = %g give fewer than two frames; raise one of them.", p->seconds,
                   p->fps);
}

enum {
    LABELS = 16,
    KEPT = 4, /* labels passed to the next round */
    COARSEST_SIDE = 96,
    ROUNDS = 2, /* per level */
    MAX_CANDIDATES = 96,
    CELL = 16, /* px, of the grid of features */
    CELL_FEATURES = 4,
    CHUNK = 8,
};
#define CENSUS_SCALE 18.0f /* of 62 bits: differences of this order are noise */
#define COLOUR_SCALE 12.0f /* of 255, mean of the three channels */
#define OUTSIDE_COST 1.1f  /* data cost of a match outside of the picture */
#define SMALL_STEP   0.08f /* smoothness cost per px of flow difference between neighbours */
#define LARGE_STEP   0.9f  /* max smoothness cost in uniform areas ... */
#define EDGE_STEP    0.22f /* ... and across an edge of the picture */
#define EDGE_SCALE   12.0f /* of 255 */
#define LENGTH_COST  2e-4f /* per px of flow, to break ties */
#define UNUSED       1e4f  /* cost of an unused label */

enum status flow_init(struct flow *f, int width, int height, struct err *err)
{
    size_t n = (size_t)width * (size_t)height;
    *f = (struct flow){.width = width, .height = height};
    f->uv = calloc(2 * n, sizeof *f->uv);
    f->confidence = calloc(n, sizeof *f->confidence);
    f->nearness = calloc(n, sizeof *f->nearness);
    if (f->uv && f->confidence && f->nearness) return ST_OK;
    flow_release(f);
    return err_nomem(err, "a flow", 4 * n * sizeof *f->uv);
}

void flow_release(struct flow *f)
{
    if (!f) return;
    free(f->uv);
    free(f->confidence);
    free(f->nearness);
    *f = (struct flow){0};
}

/* ------------------------------------------------------------------------------------------------------ pictures */

/* Median by a histogram of log2 of the grey. */
static float median_grey(const struct image *linear)
{
    enum { BINS = 1024, PER_STOP = 16 };
    size_t bins[BINS] = {0}, n = (size_t)linear->width * (size_t)linear->height, below = 0;
    for (size_t i = 0; i < n; i++) {
        float at = (log2f(fmaxf(luminance_of(linear->data + 3 * i), 1e-9f)) + 32) * PER_STOP;
        bins[at < 0 ? 0 : at > BINS - 1 ? BINS - 1 : (int)at]++;
    }
    int b = 0;
    while (b < BINS - 1 && (below += bins[b]) <= n / 2) b++;
    return exp2f((b + 0.5f) / PER_STOP - 32);
}

enum status match_image(struct image *out, const struct image *linear, struct err *err)
{
    if (image_init(out, linear->width, linear->height, 3, err)) return err->status;
    size_t n = (size_t)linear->width * (size_t)linear->height * 3;
    float median = median_grey(linear);
    for (size_t i = 0; i < n; i++) { /* x / (x + median): nearly linear around the median, compresses highlights */
        float x = cbrtf(fmaxf(linear->data[i], 0) / fmaxf(median, 1e-6f));
        out->data[i] = x / (x + 1);
    }
    return ST_OK;
}

static enum status halve(struct image *out, const struct image *in, struct err *err)
{
    if (image_init(out, in->width / 2, in->height / 2, 3, err)) return err->status;
    for (int y = 0; y < out->height; y++)
        for (int x = 0; x < out->width; x++)
            for (int c = 0; c < 3; c++)
                image_at(out, x, y)[c] =
                    0.25f * (image_at(in, 2 * x, 2 * y)[c] + image_at(in, 2 * x + 1, 2 * y)[c] +
                             image_at(in, 2 * x, 2 * y + 1)[c] + image_at(in, 2 * x + 1, 2 * y + 1)[c]);
    return ST_OK;
}

struct census_image { /* input of the data cost */
    int width, height;
    uint64_t *census; /* 62 bits: grey of the pixels in a 9 x 7 window compared with the centre's */
    uint8_t *rgb;     /* 4 bytes a pixel */
};

static void census_image_release(struct census_image *l)
{
    free(l->census);
    free(l->rgb);
    *l = (struct census_image){0};
}

static enum status census_image_make(struct census_image *l, const struct image *im, struct err *err)
{
    size_t n = (size_t)im->width * (size_t)im->height;
    *l = (struct census_image){.width = im->width, .height = im->height};
    l->census = calloc(n, sizeof *l->census);
    l->rgb = calloc(n, 4);
    float *grey = malloc(n * sizeof *grey);
    if (!l->census || !l->rgb || !grey) {
        census_image_release(l);
        free(grey);
        return err_nomem(err, "a picture to match", n * 16);
    }
    for (size_t i = 0; i < n; i++) {
        grey[i] = luminance_of(im->data + 3 * i);
        for (size_t c = 0; c < 3; c++)
            l->rgb[4 * i + c] = (uint8_t)lrintf(fminf(fmaxf(255 * im->data[3 * i + c], 0), 255));
    }
    for (int y = 0; y < im->height; y++)
        for (int x = 0; x < im->width; x++) {
            uint64_t bits = 0;
            float middle =
                grey[(size_t)y * (size_t)im->width + (size_t)x] + 0.002f; /* ignores noise in uniform areas */
            for (int j = -3; j <= 3; j++)
                for (int i = -4; i <= 4; i++) {
                    if (!i && !j) continue;
                    size_t at = (size_t)clamp_int(y + j, 0, im->height - 1) * (size_t)im->width +
                                (size_t)clamp_int(x + i, 0, im->width - 1);
                    bits = bits << 1 | (grey[at] > middle);
                }
            l->census[(size_t)y * (size_t)im->width + (size_t)x] = bits;
        }
    free(grey);
    return ST_OK;
}

/* -------------------------------------------------------------------------------------------------------- search */

struct flow_label { /* a flow in whole pixels of its level */
    int16_t x, y;
};

struct pixel_labels { /* a pixel's labels, as arrays for vector code */
    int16_t x[LABELS], y[LABELS];
    float cost[LABELS], sum[LABELS]; /* data and epipolar cost; sum of the messages of all directions */
};

struct flow_search { /* one level, from one picture to the other */
    const struct census_image *from, *to;
    const struct pair_geometry *geometry;
    const struct morph_params *params;
    int from_idx, width, height, scale; /* a pixel is `scale` pixels of the film wide */
    struct epipolar_line *lines;        /* of each pixel; all 0: unknown */
    float epipolar, epipolar_width;
    float census_cost[64], colour_cost[766];
    struct pixel_labels *labels;
    struct flow_label *kept;         /* KEPT per pixel, best first */
    const struct flow_label *coarse; /* the kept labels of the coarser level; NULL at the coarsest */
    int coarse_width, coarse_height;
    struct flow_label *features; /* CELL_FEATURES per cell of CELL x CELL pixels */
    uint8_t *feature_counts;
    int cells_wide;
    int round;
    int step_x, step_y; /* direction of the pass of semi-global matching */
};

static float pixel_cost(const struct flow_search *s, size_t p, size_t q)
{
    const uint8_t *a = s->from->rgb + 4 * p, *b = s->to->rgb + 4 * q;
    int colour = abs(a[0] - b[0]) + abs(a[1] - b[1]) + abs(a[2] - b[2]);
    return s->census_cost[__builtin_popcountll(s->from->census[p] ^ s->to->census[q])] + s->colour_cost[colour];
}

/* Cost of matching (x, y) with (x + f.x, y + f.y): data cost, mean over 3 x 3 pixels, and epipolar cost. */
static float match_cost(const struct flow_search *s, int x, int y, struct flow_label f)
{
    const int w = s->width, h = s->height;
    float sum = 0;
    int count = 0;
    for (int j = y > 0 ? -1 : 0; j <= (y < h - 1); j++)
        for (int i = x > 0 ? -1 : 0; i <= (x < w - 1); i++) {
            int u = x + i + f.x, v = y + j + f.y;
            count++;
            sum += u < 0 || v < 0 || u >= w || v >= h ? OUTSIDE_COST
                                                      : pixel_cost(s, (size_t)(y + j) * (size_t)w + (size_t)(x + i),
                                                                   (size_t)v * (size_t)w + (size_t)u);
        }
    const struct epipolar_line *l = &s->lines[(size_t)y * (size_t)w + (size_t)x];
    float cost = sum / (float)count + LENGTH_COST * (float)s->scale * (float)(abs(f.x) + abs(f.y));
    if (l->dx == 0 && l->dy == 0) return cost;
    float off = fabsf(l->dx * ((float)(y + f.y) + 0.5f) * (float)s->scale -
                      l->dy * ((float)(x + f.x) + 0.5f) * (float)s->scale + l->c);
    return cost + s->epipolar * fminf(off / s->epipolar_width, 1);
}

struct label_candidates { /* of a pixel */
    struct flow_label at[MAX_CANDIDATES];
    float cost[MAX_CANDIDATES];
    int count, certain; /* the first `certain` are kept at any cost */
};

static void add_candidate(struct label_candidates *t, int x, int y)
{
    if (t->count == MAX_CANDIDATES || abs(x) > 16000 || abs(y) > 16000) return;
    for (int i = 0; i < t->count; i++)
        if (t->at[i].x == x && t->at[i].y == y) return;
    t->at[t->count++] = (struct flow_label){(int16_t)x, (int16_t)y};
}

/* Sets the pixel's labels: the certain candidates, then the cheapest. */
static void select_labels(const struct flow_search *s, struct label_candidates *t, int x, int y)
{
    struct pixel_labels *out = &s->labels[(size_t)y * (size_t)s->width + (size_t)x];
    for (int i = 0; i < t->count; i++) t->cost[i] = match_cost(s, x, y, t->at[i]);
    int certain = t->certain < LABELS ? t->certain : LABELS;
    for (int k = 0; k < LABELS; k++) {
        int best = k;
        for (int i = k; k >= certain && i < t->count; i++)
            if (t->cost[i] < t->cost[best]) best = i;
        if (k < t->count) {
            struct flow_label f = t->at[best];
            float cost = t->cost[best];
            t->at[best] = t->at[k];
            t->cost[best] = t->cost[k];
            t->at[k] = f;
            t->cost[k] = cost;
            out->x[k] = f.x;
            out->y[k] = f.y;
            out->cost[k] = cost;
        } else {
            out->x[k] = out->x[0];
            out->y[k] = out->y[0];
            out->cost[k] = UNUSED;
        }
        out->sum[k] = 0;
    }
}

static void add_features(const struct flow_search *s, struct label_candidates *t, int x, int y)
{
    size_t cell = (size_t)(y / CELL) * (size_t)s->cells_wide + (size_t)(x / CELL);
    for (int i = 0; i < s->feature_counts[cell]; i++) {
        struct flow_label f = s->features[cell * CELL_FEATURES + (size_t)i];
        add_candidate(t, f.x, f.y);
    }
}

/* Coarsest level: the LABELS cheapest of all flows in the search range. */
static void search_all_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct flow_search *s = ctx;
    int range = (int)ceil(s->params->search * (s->width > s->height ? s->width : s->height));
    (void)thread;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < s->width; x++) {
            struct pixel_labels *out = &s->labels[(size_t)y * (size_t)s->width + (size_t)x];
            int count = 0;
            for (int k = 0; k < LABELS; k++) out->cost[k] = UNUSED, out->x[k] = out->y[k] = 0, out->sum[k] = 0;
            for (int fy = -range; fy <= range; fy++)
                for (int fx = -range; fx <= range; fx++) {
                    struct flow_label f = {(int16_t)fx, (int16_t)fy};
                    if (x + fx < 0 || y + fy < 0 || x + fx >= s->width || y + fy >= s->height) continue;
                    float cost = match_cost(s, x, y, f);
                    if (count == LABELS && cost >= out->cost[LABELS - 1]) continue;
                    int k = count < LABELS ? count++ : LABELS - 1;
                    for (; k > 0 && out->cost[k - 1] > cost; k--) {
                        out->x[k] = out->x[k - 1];
                        out->y[k] = out->y[k - 1];
                        out->cost[k] = out->cost[k - 1];
                    }
                    out->x[k] = f.x;
                    out->y[k] = f.y;
                    out->cost[k] = cost;
                }
        }
}

static const struct flow_label *kept_at(const struct flow_search *s, int x, int y)
{
    return s->kept +
           KEPT * ((size_t)clamp_int(y, 0, s->height - 1) * (size_t)s->width + (size_t)clamp_int(x, 0, s->width - 1));
}

/* Labels from the coarser level (round 0) or from the results of the last round. */
static void search_candidate_rows(void *ctx, size_t begin, size_t end, int thread)
{
    static const int around[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
    static const int reach[2][3] = {{3, 8, 21}, {5, 13, 34}};
    const struct flow_search *s = ctx;
    (void)thread;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < s->width; x++) {
            struct label_candidates t = {0};
            if (s->round == 0) {
                int ax = clamp_int(x / 2, 0, s->coarse_width - 1), ay = clamp_int(y / 2, 0, s->coarse_height - 1);
                const struct flow_label *own = s->coarse + KEPT * ((size_t)ay * (size_t)s->coarse_width + (size_t)ax);
                for (int k = 0; k < KEPT; k++) add_candidate(&t, 2 * own[k].x, 2 * own[k].y);
                t.certain = 1;
                for (int i = 0; i < 8; i++) {
                    const struct flow_label *near =
                        s->coarse + KEPT * ((size_t)clamp_int(ay + around[i][1], 0, s->coarse_height - 1) *
                                                (size_t)s->coarse_width +
                                            (size_t)clamp_int(ax + around[i][0], 0, s->coarse_width - 1));
                    add_candidate(&t, 2 * near[0].x, 2 * near[0].y);
                }
                for (int i = 0; i < 8; i++) add_candidate(&t, 2 * own[0].x + around[i][0], 2 * own[0].y + around[i][1]);
                add_features(s, &t, x, y);
            } else {
                const struct flow_label *own = kept_at(s, x, y);
                add_candidate(&t, own[0].x, own[0].y);
                for (int i = 0; i < 4; i++) {
                    const struct flow_label *near = kept_at(s, x + around[i][0], y + around[i][1]);
                    add_candidate(&t, near[0].x, near[0].y);
                }
                t.certain = t.count;
                for (int k = 1; k < KEPT; k++) add_candidate(&t, own[k].x, own[k].y);
                for (int i = 0; i < 8; i++) add_candidate(&t, own[0].x + around[i][0], own[0].y + around[i][1]);
                for (int i = 0; i < 8; i++)
                    for (int k = 0; k < 3; k++) {
                        int r = reach[i & 1][k];
                        const struct flow_label *far = kept_at(s, x + r * around[i][0], y + r * around[i][1]);
                        add_candidate(&t, far[0].x, far[0].y);
                    }
            }
            select_labels(s, &t, x, y);
        }
}

/* One line of a pass: messages from the border at (x, y) along (step_x, step_y). */
static void pass_line(const struct flow_search *s, int x, int y)
{
    float message[LABELS], fx[LABELS], fy[LABELS];
    const f32x8 small = f32x8_all(SMALL_STEP * (float)s->scale);
    float min = 0;
    const uint8_t *previous = NULL;
    for (; x >= 0 && y >= 0 && x < s->width && y < s->height; x += s->step_x, y += s->step_y) {
        size_t p = (size_t)y * (size_t)s->width + (size_t)x;
        struct pixel_labels *l = &s->labels[p];
        const uint8_t *rgb = s->from->rgb + 4 * p;
        f32x8 lx[2], ly[2], m[2];
        for (int b = 0; b < 2; b++) {
            lx[b] = f32x8_from_i32(i32x8_from_i16(l->x + 8 * b));
            ly[b] = f32x8_from_i32(i32x8_from_i16(l->y + 8 * b));
            m[b] = (f32x8){0};
        }
        if (previous) {
            float edge = (float)(abs(rgb[0] - previous[0]) + abs(rgb[1] - previous[1]) + abs(rgb[2] - previous[2])) / 3;
            float step = EDGE_STEP + (LARGE_STEP - EDGE_STEP) * expf(-edge / EDGE_SCALE);
            const f32x8 large = f32x8_all(step);
            m[0] = m[1] = f32x8_all(min + step);
            for (int j = 0; j < LABELS; j++) {
                if (message[j] > min + step) continue;
                const f32x8 jx = f32x8_all(fx[j]), jy = f32x8_all(fy[j]), jm = f32x8_all(message[j]);
                for (int b = 0; b < 2; b++) {
                    f32x8 d = f32x8_abs(lx[b] - jx) + f32x8_abs(ly[b] - jy);
                    m[b] = f32x8_min(m[b], jm + f32x8_min(d * small, large));
                }
            }
        }
        const f32x8 base = f32x8_all(min);
        for (int b = 0; b < 2; b++) {
            f32x8 v = f32x8_load(l->cost + 8 * b) + (m[b] - base);
            f32x8_store(message + 8 * b, v);
            f32x8_store(l->sum + 8 * b, f32x8_load(l->sum + 8 * b) + v);
            f32x8_store(fx + 8 * b, lx[b]);
            f32x8_store(fy + 8 * b, ly[b]);
        }
        min = message[0];
        for (int k = 1; k < LABELS; k++) min = fminf(min, message[k]);
        previous = rgb;
    }
}

/* Lines are numbered along the borders at which they start. */
static void pass_lines(void *ctx, size_t begin, size_t end, int thread)
{
    const struct flow_search *s = ctx;
    int x0 = s->step_x < 0 ? s->width - 1 : 0, y0 = s->step_y < 0 ? s->height - 1 : 0;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        int k = (int)i;
        if (s->step_y == 0)
            pass_line(s, x0, k);
        else if (k < s->width)
            pass_line(s, k, y0);
        else /* a diagonal from the side; the corner's is among the others */
            pass_line(s, x0, s->step_y < 0 ? k - s->width : k - s->width + 1);
    }
}

static void pass_all(struct flow_search *s)
{
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++) {
            if (!x && !y) continue;
            s->step_x = x;
            s->step_y = y;
            size_t lines = (size_t)(y == 0 ? s->height : x == 0 ? s->width : s->width + s->height - 1);
            parallel_for(lines, CHUNK, pass_lines, s);
        }
}

/* The KEPT labels of lowest sum of each pixel, best first. */
static void keep_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct flow_search *s = ctx;
    (void)thread;
    for (size_t p = begin * (size_t)s->width; p < end * (size_t)s->width; p++) {
        const struct pixel_labels *l = &s->labels[p];
        struct flow_label *kept = s->kept + KEPT * p;
        int count = 0;
        while (count < KEPT) { /* at least 2 px apart, to keep real alternatives */
            int best = -1;
            for (int k = 0; k < LABELS; k++) {
                bool apart = l->cost[k] < UNUSED;
                for (int i = 0; i < count; i++) apart &= abs(kept[i].x - l->x[k]) > 1 || abs(kept[i].y - l->y[k]) > 1;
                if (apart && (best < 0 || l->sum[k] < l->sum[best])) best = k;
            }
            if (best < 0) break;
            kept[count++] = (struct flow_label){l->x[best], l->y[best]};
        }
        for (; count < KEPT; count++) kept[count] = kept[0];
    }
}

/* Enters the matched features into the grid of cells, with their neighbour cells. */
static enum status sort_features(struct flow_search *s, const struct feature_match *matches, int count, struct err *err)
{
    s->cells_wide = (s->width + CELL - 1) / CELL;
    size_t cells = (size_t)s->cells_wide * (size_t)((s->height + CELL - 1) / CELL);
    s->features = calloc(cells * CELL_FEATURES, sizeof *s->features);
    s->feature_counts = calloc(cells, 1);
    if (!s->features || !s->feature_counts) return err_nomem(err, "the grid of features", cells * 16);
    for (int i = 0; i < count; i++) {
        const struct feature_match *m = &matches[i];
        double x = (s->from_idx ? m->x2 : m->x1) / s->scale, y = (s->from_idx ? m->y2 : m->y1) / s->scale;
        double sign = (s->from_idx ? -1.0 : 1.0) / s->scale;
        struct flow_label f = {(int16_t)lrint(sign * (m->x2 - m->x1)), (int16_t)lrint(sign * (m->y2 - m->y1))};
        for (int j = -1; j <= 1; j++)
            for (int k = -1; k <= 1; k++) {
                int cx = (int)floor(x / CELL) + k, cy = (int)floor(y / CELL) + j;
                if (cx < 0 || cy < 0 || cx >= s->cells_wide || cy * CELL >= s->height) continue;
                size_t cell = (size_t)cy * (size_t)s->cells_wide + (size_t)cx;
                if (s->feature_counts[cell] < CELL_FEATURES)
                    s->features[cell * CELL_FEATURES + s->feature_counts[cell]++] = f;
            }
    }
    return ST_OK;
}

static void line_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct flow_search *s = ctx;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < s->width; x++) {
            struct epipolar_line *l = &s->lines[y * (size_t)s->width + (size_t)x];
            double px = (x + 0.5) * s->scale, py = ((double)y + 0.5) * s->scale, at[2] = {px, py};
            if (s->coarse) {
                size_t q = (size_t)clamp_int((int)y / 2, 0, s->coarse_height - 1) * (size_t)s->coarse_width +
                           (size_t)clamp_int(x / 2, 0, s->coarse_width - 1);
                at[0] += 2 * s->scale * s->coarse[KEPT * q].x;
                at[1] += 2 * s->scale * s->coarse[KEPT * q].y;
            }
            if (!epipolar_line_at(s->geometry, s->from_idx, px, py, s->coarse ? at : NULL, l))
                *l = (struct epipolar_line){0};
        }
}

/* Searches one level. *kept: in, the coarser level's kept labels (NULL at the coarsest level); out, this level's. */
static enum status search_level(struct flow_search *s, struct flow_label **kept, int coarse_width, int coarse_height,
                                const struct feature_match *matches, int match_count, struct err *err)
{
    size_t n = (size_t)s->width * (size_t)s->height, bytes = n * sizeof *s->labels;
    s->coarse = *kept;
    s->coarse_width = coarse_width;
    s->coarse_height = coarse_height;
    s->epipolar = (float)s->params->epipolar;
    s->epipolar_width = (float)fmax(s->params->epipolar_width, 1.5 * s->scale);
    for (int i = 0; i < 64; i++) s->census_cost[i] = 1 - expf(-(float)i / CENSUS_SCALE);
    for (int i = 0; i < 766; i++) s->colour_cost[i] = 1 - expf(-(float)i / 3 / COLOUR_SCALE);
    s->lines = malloc(n * sizeof *s->lines);
    s->labels = malloc(bytes);
    s->kept = malloc(n * KEPT * sizeof *s->kept);
    if (!s->lines || !s->labels || !s->kept) err_nomem(err, "candidates for the flow", bytes);
    if (!err->status && !sort_features(s, matches, match_count, err)) {
        parallel_for((size_t)s->height, CHUNK, line_rows, s);
        for (s->round = 0; s->round < (s->coarse ? ROUNDS : 2); s->round++) {
            parallel_for((size_t)s->height, CHUNK, s->round || s->coarse ? search_candidate_rows : search_all_rows, s);
            pass_all(s);
            parallel_for((size_t)s->height, CHUNK, keep_rows, s);
        }
        free(*kept);
        *kept = s->kept;
        s->kept = NULL;
    }
    free(s->kept);
    free(s->labels);
    free(s->lines);
    free(s->features);
    free(s->feature_counts);
    return err->status;
}

enum status match_whole_pixels(struct flow *flow, const struct image pictures[2], int from,
                               const struct pair_geometry *geometry, const struct feature_match *matches,
                               int match_count, const struct morph_params *params, struct err *err)
{
    enum { MAX_LEVELS = 16 };
    struct image pyramid[2][MAX_LEVELS] = {0};
    struct flow_label *kept = NULL;
    int levels = 1, coarse_width = 0, coarse_height = 0;
    for (int i = 0; i < 2; i++) pyramid[i][0] = pictures[i]; /* borrowed */
    while (!err->status && levels < MAX_LEVELS) {
        const struct image *last = &pyramid[0][levels - 1];
        if (last->width <= COARSEST_SIDE && last->height <= COARSEST_SIDE) break;
        if (last->width < 16 || last->height < 16) break;
        for (int i = 0; !err->status && i < 2; i++) halve(&pyramid[i][levels], &pyramid[i][levels - 1], err);
        levels++;
    }
    for (int l = levels - 1; !err->status && l >= 0; l--) {
        struct census_image images[2] = {0};
        for (int i = 0; !err->status && i < 2; i++) census_image_make(&images[i], &pyramid[i][l], err);
        struct flow_search s = {.from = &images[from],
                                .to = &images[!from],
                                .geometry = geometry,
                                .params = params,
                                .from_idx = from,
                                .width = pyramid[0][l].width,
                                .height = pyramid[0][l].height,
                                .scale = 1 << l};
        if (!err->status) search_level(&s, &kept, coarse_width, coarse_height, matches, match_count, err);
        coarse_width = s.width;
        coarse_height = s.height;
        for (int i = 0; i < 2; i++) census_image_release(&images[i]);
    }
    if (!err->status && !flow_init(flow, pictures[0].width, pictures[0].height, err)) {
        size_t n = (size_t)flow->width * (size_t)flow->height;
        for (size_t p = 0; p < n; p++) {
            flow->uv[2 * p] = kept[KEPT * p].x;
            flow->uv[2 * p + 1] = kept[KEPT * p].y;
        }
    }
    for (int i = 0; i < 2; i++)
        for (int l = 1; l < levels; l++) image_release(&pyramid[i][l]);
    free(kept);
    return err->status;
}

enum status match_pictures(struct flow flows[2], const struct image pictures[2], const struct pair_geometry *geometry,
                           const struct feature_match *matches, int match_count, const struct morph_params *params,
                           struct err *err)
{
    for (int i = 0; !err->status && i < 2; i++)
        if (!match_whole_pixels(&flows[i], pictures, i, geometry, matches, match_count, params, err))
            flow_refine(&flows[i], pictures, i, geometry, params, err);
    if (!err->status) flow_check(flows, pictures, geometry, err);
    return err->status;
}
