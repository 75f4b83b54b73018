/* match.c - see match.h: a discrete search, coarse to fine.
 *
 * At each level of a pyramid every pixel has up to LABELS candidates for its flow: at the coarsest all that lie within
 * the search range compete; below, what the level above liked best here and around, what pixels some way off found,
 * steps of a pixel, and matched features near by. Semi-global matching (Hirschmueller 2008) along eight directions
 * chooses among them: a candidate costs what its pixels look different (census and colour, as in ADCensus: Mei 2011),
 * plus the soft epipolar term, plus what sets it apart from its neighbours' candidates. As labels are flows, not
 * disparities, a thing that moved between the photos is one more label: it pays the epipolar term once a pixel, and
 * that grows no more beyond a few pixels. Candidates that differ from pixel to pixel are as in discrete flow (Menze
 * 2015). */
#include "stages/morph_views/match.h"

#include <immintrin.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"

#define PARAM_STRUCT struct morph_params
const struct param morph_param_table[] = {MORPH_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

enum status morph_params_check(const void *values, struct err *err)
{
    const struct morph_params *p = values;
    if (floor(p->seconds * p->fps + 0.5) >= 2) return ST_OK;
    return err_set(err, ST_USAGE, "[morph_views] seconds = %g at fps = %g make fewer than two frames.", p->seconds,
                   p->fps);
}

enum {
    LABELS = 16,
    KEPT = 4, /* of them for the next round */
    COARSEST_SIDE = 96,
    ROUNDS = 2, /* at each level below the coarsest */
    TRIED_MOST = 96,
    CELL = 16, /* px: features are looked up by cell */
    CELL_FEATURES = 4,
    CHUNK = 8,
};
#define CENSUS_SCALE 18.0f /* bits: of 62 so many may differ by noise */
#define COLOUR_SCALE 12.0f /* of 255, mean of three */
#define OUTSIDE_COST 1.1f  /* of a match beyond the picture's border */
#define SMALL_STEP   0.08f /* smoothness: a pixel's difference between neighbours */
#define LARGE_STEP   0.9f  /* and at most, where the picture is even ... */
#define EDGE_STEP    0.22f /* ... and where it has an edge */
#define EDGE_SCALE   12.0f /* of 255 */
#define LENGTH_COST  2e-4f /* a px of flow: decides where nothing else does */
#define UNUSED       1e4f

enum status flow_init(struct flow *f, int width, int height, struct err *err)
{
    size_t n = (size_t)width * (size_t)height;
    *f = (struct flow){.width = width, .height = height};
    f->uv = calloc(2 * n, sizeof *f->uv);
    f->sure = calloc(n, sizeof *f->sure);
    f->near = calloc(n, sizeof *f->near);
    if (f->uv && f->sure && f->near) return ST_OK;
    flow_release(f);
    return err_nomem(err, "a flow", 4 * n * sizeof *f->uv);
}

void flow_release(struct flow *f)
{
    if (!f) return;
    free(f->uv);
    free(f->sure);
    free(f->near);
    *f = (struct flow){0};
}

/* ------------------------------------------------------------------------------------------------------ pictures */

static float grey_of(const float *rgb) { return 0.2126f * rgb[0] + 0.7152f * rgb[1] + 0.0722f * rgb[2]; }

/* A histogram's median: of log2 of the grey, so that one exceeding another by a stop is 16 bins farther. */
static float median_grey(const struct image *linear)
{
    enum { BINS = 1024, PER_STOP = 16 };
    size_t bins[BINS] = {0}, n = (size_t)linear->width * (size_t)linear->height, below = 0;
    for (size_t i = 0; i < n; i++) {
        float at = (log2f(fmaxf(grey_of(linear->data + 3 * i), 1e-9f)) + 32) * PER_STOP;
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
    for (size_t i = 0; i < n; i++) { /* x / (x + median): even steps around the median, and white ends softly */
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

struct look { /* what costs read of a picture */
    int width, height;
    uint64_t *census; /* 62 bits: the greys of 9 x 7 pixels against the middle one's */
    uint8_t *rgb;     /* 4 bytes a pixel */
};

static void look_release(struct look *l)
{
    free(l->census);
    free(l->rgb);
    *l = (struct look){0};
}

static int clamp_int(int x, int most) { return x < 0 ? 0 : x > most ? most : x; }

static enum status look_make(struct look *l, const struct image *im, struct err *err)
{
    size_t n = (size_t)im->width * (size_t)im->height;
    *l = (struct look){.width = im->width, .height = im->height};
    l->census = calloc(n, sizeof *l->census);
    l->rgb = calloc(n, 4);
    float *grey = malloc(n * sizeof *grey);
    if (!l->census || !l->rgb || !grey) {
        look_release(l);
        free(grey);
        return err_nomem(err, "a picture to match", n * 16);
    }
    for (size_t i = 0; i < n; i++) {
        grey[i] = grey_of(im->data + 3 * i);
        for (size_t c = 0; c < 3; c++)
            l->rgb[4 * i + c] = (uint8_t)lrintf(fminf(fmaxf(255 * im->data[3 * i + c], 0), 255));
    }
    for (int y = 0; y < im->height; y++)
        for (int x = 0; x < im->width; x++) {
            uint64_t bits = 0;
            float middle =
                grey[(size_t)y * (size_t)im->width + (size_t)x] + 0.002f; /* noise in an even area is no bit */
            for (int j = -3; j <= 3; j++)
                for (int i = -4; i <= 4; i++) {
                    if (!i && !j) continue;
                    size_t at = (size_t)clamp_int(y + j, im->height - 1) * (size_t)im->width +
                                (size_t)clamp_int(x + i, im->width - 1);
                    bits = bits << 1 | (grey[at] > middle);
                }
            l->census[(size_t)y * (size_t)im->width + (size_t)x] = bits;
        }
    free(grey);
    return ST_OK;
}

/* -------------------------------------------------------------------------------------------------------- search */

struct label {
    int16_t x, y;
};

struct labels { /* of a pixel, apart so that eight are handled together */
    int16_t x[LABELS], y[LABELS];
    float cost[LABELS], sum[LABELS];
};

struct search { /* one level, one direction */
    const struct look *from, *to;
    const struct geometry *geometry;
    const struct morph_params *params;
    int from_idx, width, height, scale; /* a pixel is `scale` of the film's wide */
    struct epipolar_line *lines;        /* all 0 where not known */
    float epipolar, epipolar_width;
    float census_cost[64], colour_cost[766];
    struct labels *labels;
    struct label *kept;        /* KEPT a pixel, best first */
    const struct label *above; /* the kept ones of the level above; NULL: none */
    int above_width, above_height;
    struct label *features; /* CELL_FEATURES a cell of CELL pixels */
    uint8_t *feature_counts;
    int cells_wide;
    int round;
    /* one pass of semi-global matching */
    int step_x, step_y;
};

static float pixel_cost(const struct search *s, size_t p, size_t q)
{
    const uint8_t *a = s->from->rgb + 4 * p, *b = s->to->rgb + 4 * q;
    int colour = abs(a[0] - b[0]) + abs(a[1] - b[1]) + abs(a[2] - b[2]);
    return s->census_cost[__builtin_popcountll(s->from->census[p] ^ s->to->census[q])] + s->colour_cost[colour];
}

/* What the match of (x, y) with (x + f.x, y + f.y) costs: the mean over 3 x 3 pixels, and the epipolar term. */
static float match_cost(const struct search *s, int x, int y, struct label f)
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

struct tried { /* a pixel's candidates while they are collected */
    struct label at[TRIED_MOST];
    float cost[TRIED_MOST];
    int count, certain; /* the first `certain` stay, whatever they cost */
};

static void try_label(struct tried *t, int x, int y)
{
    if (t->count == TRIED_MOST || abs(x) > 16000 || abs(y) > 16000) return;
    for (int i = 0; i < t->count; i++)
        if (t->at[i].x == x && t->at[i].y == y) return;
    t->at[t->count++] = (struct label){(int16_t)x, (int16_t)y};
}

static void keep_best(const struct search *s, struct tried *t, int x, int y)
{
    struct labels *out = &s->labels[(size_t)y * (size_t)s->width + (size_t)x];
    for (int i = 0; i < t->count; i++) t->cost[i] = match_cost(s, x, y, t->at[i]);
    int certain = t->certain < LABELS ? t->certain : LABELS;
    for (int k = 0; k < LABELS; k++) {
        int best = k;
        for (int i = k; k >= certain && i < t->count; i++)
            if (t->cost[i] < t->cost[best]) best = i;
        if (k < t->count) {
            struct label f = t->at[best];
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

static void try_features(const struct search *s, struct tried *t, int x, int y)
{
    size_t cell = (size_t)(y / CELL) * (size_t)s->cells_wide + (size_t)(x / CELL);
    for (int i = 0; i < s->feature_counts[cell]; i++) {
        struct label f = s->features[cell * CELL_FEATURES + (size_t)i];
        try_label(t, f.x, f.y);
    }
}

/* All labels in range, the LABELS cheapest. */
static void search_all_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct search *s = ctx;
    int range = (int)ceil(s->params->search * (s->width > s->height ? s->width : s->height));
    (void)thread;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < s->width; x++) {
            struct labels *out = &s->labels[(size_t)y * (size_t)s->width + (size_t)x];
            int count = 0;
            for (int k = 0; k < LABELS; k++) out->cost[k] = UNUSED, out->x[k] = out->y[k] = 0, out->sum[k] = 0;
            for (int fy = -range; fy <= range; fy++)
                for (int fx = -range; fx <= range; fx++) {
                    struct label f = {(int16_t)fx, (int16_t)fy};
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

static const struct label *kept_at(const struct search *s, int x, int y)
{
    return s->kept +
           KEPT * ((size_t)clamp_int(y, s->height - 1) * (size_t)s->width + (size_t)clamp_int(x, s->width - 1));
}

static void try_rows(void *ctx, size_t begin, size_t end, int thread)
{
    static const int around[8][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}};
    static const int reach[2][3] = {{3, 8, 21}, {5, 13, 34}};
    const struct search *s = ctx;
    (void)thread;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < s->width; x++) {
            struct tried t = {0};
            if (s->round == 0) { /* from the level above */
                int ax = clamp_int(x / 2, s->above_width - 1), ay = clamp_int(y / 2, s->above_height - 1);
                const struct label *own = s->above + KEPT * ((size_t)ay * (size_t)s->above_width + (size_t)ax);
                for (int k = 0; k < KEPT; k++) try_label(&t, 2 * own[k].x, 2 * own[k].y);
                t.certain = 1;
                for (int i = 0; i < 8; i++) {
                    const struct label *near =
                        s->above +
                        KEPT * ((size_t)clamp_int(ay + around[i][1], s->above_height - 1) * (size_t)s->above_width +
                                (size_t)clamp_int(ax + around[i][0], s->above_width - 1));
                    try_label(&t, 2 * near[0].x, 2 * near[0].y);
                }
                for (int i = 0; i < 8; i++) try_label(&t, 2 * own[0].x + around[i][0], 2 * own[0].y + around[i][1]);
                try_features(s, &t, x, y);
            } else {
                const struct label *own = kept_at(s, x, y);
                try_label(&t, own[0].x, own[0].y);
                for (int i = 0; i < 4; i++) {
                    const struct label *near = kept_at(s, x + around[i][0], y + around[i][1]);
                    try_label(&t, near[0].x, near[0].y);
                }
                t.certain = t.count;
                for (int k = 1; k < KEPT; k++) try_label(&t, own[k].x, own[k].y);
                for (int i = 0; i < 8; i++) try_label(&t, own[0].x + around[i][0], own[0].y + around[i][1]);
                for (int i = 0; i < 8; i++)
                    for (int k = 0; k < 3; k++) {
                        int r = reach[i & 1][k];
                        const struct label *far = kept_at(s, x + r * around[i][0], y + r * around[i][1]);
                        try_label(&t, far[0].x, far[0].y);
                    }
            }
            keep_best(s, &t, x, y);
        }
}

/* One line of a pass: messages along (step_x, step_y) from the border on. */
static void pass_line(const struct search *s, int x, int y)
{
    float message[LABELS], fx[LABELS], fy[LABELS];
    const __m256 abs_mask = _mm256_castsi256_ps(_mm256_set1_epi32(0x7fffffff));
    const __m256 small = _mm256_set1_ps(SMALL_STEP * (float)s->scale);
    float least = 0;
    const uint8_t *before = NULL;
    for (; x >= 0 && y >= 0 && x < s->width && y < s->height; x += s->step_x, y += s->step_y) {
        size_t p = (size_t)y * (size_t)s->width + (size_t)x;
        struct labels *l = &s->labels[p];
        const uint8_t *rgb = s->from->rgb + 4 * p;
        __m256 lx[2], ly[2], m[2];
        for (int b = 0; b < 2; b++) {
            lx[b] = _mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(_mm_loadu_si128((const __m128i *)(l->x + 8 * b))));
            ly[b] = _mm256_cvtepi32_ps(_mm256_cvtepi16_epi32(_mm_loadu_si128((const __m128i *)(l->y + 8 * b))));
            m[b] = _mm256_set1_ps(0);
        }
        if (before) {
            float edge = (float)(abs(rgb[0] - before[0]) + abs(rgb[1] - before[1]) + abs(rgb[2] - before[2])) / 3;
            float step = EDGE_STEP + (LARGE_STEP - EDGE_STEP) * expf(-edge / EDGE_SCALE);
            const __m256 large = _mm256_set1_ps(step);
            m[0] = m[1] = _mm256_set1_ps(least + step);
            for (int j = 0; j < LABELS; j++) {
                if (message[j] > least + step) continue;
                const __m256 jx = _mm256_set1_ps(fx[j]), jy = _mm256_set1_ps(fy[j]), jm = _mm256_set1_ps(message[j]);
                for (int b = 0; b < 2; b++) {
                    __m256 d = _mm256_add_ps(_mm256_and_ps(abs_mask, _mm256_sub_ps(lx[b], jx)),
                                             _mm256_and_ps(abs_mask, _mm256_sub_ps(ly[b], jy)));
                    m[b] = _mm256_min_ps(m[b], _mm256_add_ps(jm, _mm256_min_ps(_mm256_mul_ps(d, small), large)));
                }
            }
        }
        const __m256 base = _mm256_set1_ps(least);
        for (int b = 0; b < 2; b++) {
            __m256 v = _mm256_add_ps(_mm256_loadu_ps(l->cost + 8 * b), _mm256_sub_ps(m[b], base));
            _mm256_storeu_ps(message + 8 * b, v);
            _mm256_storeu_ps(l->sum + 8 * b, _mm256_add_ps(_mm256_loadu_ps(l->sum + 8 * b), v));
            _mm256_storeu_ps(fx + 8 * b, lx[b]);
            _mm256_storeu_ps(fy + 8 * b, ly[b]);
        }
        least = message[0];
        for (int k = 1; k < LABELS; k++) least = fminf(least, message[k]);
        before = rgb;
    }
}

/* Lines are counted along the borders that they come from. */
static void pass_lines(void *ctx, size_t begin, size_t end, int thread)
{
    const struct search *s = ctx;
    int x0 = s->step_x < 0 ? s->width - 1 : 0, y0 = s->step_y < 0 ? s->height - 1 : 0;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        int k = (int)i;
        if (s->step_y == 0)
            pass_line(s, x0, k);
        else if (k < s->width)
            pass_line(s, k, y0);
        else /* a diagonal from the side; the corner's was among the others */
            pass_line(s, x0, s->step_y < 0 ? k - s->width : k - s->width + 1);
    }
}

static void pass_all(struct search *s)
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

static void keep_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct search *s = ctx;
    (void)thread;
    for (size_t p = begin * (size_t)s->width; p < end * (size_t)s->width; p++) {
        const struct labels *l = &s->labels[p];
        struct label *kept = s->kept + KEPT * p;
        int count = 0;
        while (count < KEPT) { /* apart from each other, so that they are choices */
            int best = -1;
            for (int k = 0; k < LABELS; k++) {
                bool apart = l->cost[k] < UNUSED;
                for (int i = 0; i < count; i++) apart &= abs(kept[i].x - l->x[k]) > 1 || abs(kept[i].y - l->y[k]) > 1;
                if (apart && (best < 0 || l->sum[k] < l->sum[best])) best = k;
            }
            if (best < 0) break;
            kept[count++] = (struct label){l->x[best], l->y[best]};
        }
        for (; count < KEPT; count++) kept[count] = kept[0];
    }
}

static enum status sort_features(struct search *s, const struct feature_match *matches, int count, struct err *err)
{
    s->cells_wide = (s->width + CELL - 1) / CELL;
    size_t cells = (size_t)s->cells_wide * (size_t)((s->height + CELL - 1) / CELL);
    s->features = calloc(cells * CELL_FEATURES, sizeof *s->features);
    s->feature_counts = calloc(cells, 1);
    if (!s->features || !s->feature_counts) return err_nomem(err, "features by place", cells * 16);
    for (int i = 0; i < count; i++) {
        const struct feature_match *m = &matches[i];
        double x = (s->from_idx ? m->x2 : m->x1) / s->scale, y = (s->from_idx ? m->y2 : m->y1) / s->scale;
        double sign = (s->from_idx ? -1.0 : 1.0) / s->scale;
        struct label f = {(int16_t)lrint(sign * (m->x2 - m->x1)), (int16_t)lrint(sign * (m->y2 - m->y1))};
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
    const struct search *s = ctx;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < s->width; x++) {
            struct epipolar_line *l = &s->lines[y * (size_t)s->width + (size_t)x];
            double px = (x + 0.5) * s->scale, py = ((double)y + 0.5) * s->scale, at[2] = {px, py};
            if (s->above) {
                size_t q = (size_t)clamp_int((int)y / 2, s->above_height - 1) * (size_t)s->above_width +
                           (size_t)clamp_int(x / 2, s->above_width - 1);
                at[0] += 2 * s->scale * s->above[KEPT * q].x;
                at[1] += 2 * s->scale * s->above[KEPT * q].y;
            }
            if (!geometry_line(s->geometry, s->from_idx, px, py, s->above ? at : NULL, l))
                *l = (struct epipolar_line){0};
        }
}

/* One level: from the kept labels of the level above (*kept, NULL at the coarsest) to its own. */
static enum status search_level(struct search *s, struct label **kept, int above_width, int above_height,
                                const struct feature_match *matches, int match_count, struct err *err)
{
    size_t n = (size_t)s->width * (size_t)s->height, bytes = n * sizeof *s->labels;
    enum status st = ST_OK;
    s->above = *kept;
    s->above_width = above_width;
    s->above_height = above_height;
    s->epipolar = (float)s->params->epipolar;
    s->epipolar_width = (float)fmax(s->params->epipolar_width, 1.5 * s->scale);
    for (int i = 0; i < 64; i++) s->census_cost[i] = 1 - expf(-(float)i / CENSUS_SCALE);
    for (int i = 0; i < 766; i++) s->colour_cost[i] = 1 - expf(-(float)i / 3 / COLOUR_SCALE);
    s->lines = malloc(n * sizeof *s->lines);
    s->labels = malloc(bytes);
    s->kept = malloc(n * KEPT * sizeof *s->kept);
    if (!s->lines || !s->labels || !s->kept) st = err_nomem(err, "candidates for the flow", bytes);
    if (!st) st = sort_features(s, matches, match_count, err);
    if (!st) {
        parallel_for((size_t)s->height, CHUNK, line_rows, s);
        for (s->round = 0; s->round < (s->above ? ROUNDS : 2); s->round++) {
            parallel_for((size_t)s->height, CHUNK, s->round || s->above ? try_rows : search_all_rows, s);
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
    return st;
}

enum status match_whole_pixels(struct flow *flow, const struct image pictures[2], int from,
                               const struct geometry *geometry, const struct feature_match *matches, int match_count,
                               const struct morph_params *params, struct err *err)
{
    enum { MOST_LEVELS = 16 };
    struct image pyramid[2][MOST_LEVELS] = {0};
    struct label *kept = NULL;
    int levels = 1, above_width = 0, above_height = 0;
    enum status st = ST_OK;
    for (int i = 0; i < 2; i++) pyramid[i][0] = pictures[i]; /* borrowed */
    while (!st && levels < MOST_LEVELS) {
        const struct image *last = &pyramid[0][levels - 1];
        if (last->width <= COARSEST_SIDE && last->height <= COARSEST_SIDE) break;
        if (last->width < 16 || last->height < 16) break;
        for (int i = 0; !st && i < 2; i++) st = halve(&pyramid[i][levels], &pyramid[i][levels - 1], err);
        levels++;
    }
    for (int l = levels - 1; !st && l >= 0; l--) {
        struct look looks[2] = {0};
        for (int i = 0; !st && i < 2; i++) st = look_make(&looks[i], &pyramid[i][l], err);
        struct search s = {.from = &looks[from],
                           .to = &looks[!from],
                           .geometry = geometry,
                           .params = params,
                           .from_idx = from,
                           .width = pyramid[0][l].width,
                           .height = pyramid[0][l].height,
                           .scale = 1 << l};
        if (!st) st = search_level(&s, &kept, above_width, above_height, matches, match_count, err);
        above_width = s.width;
        above_height = s.height;
        for (int i = 0; i < 2; i++) look_release(&looks[i]);
    }
    if (!st) st = flow_init(flow, pictures[0].width, pictures[0].height, err);
    if (!st) {
        size_t n = (size_t)flow->width * (size_t)flow->height;
        for (size_t p = 0; p < n; p++) {
            flow->uv[2 * p] = kept[KEPT * p].x;
            flow->uv[2 * p + 1] = kept[KEPT * p].y;
        }
    }
    for (int i = 0; i < 2; i++)
        for (int l = 1; l < levels; l++) image_release(&pyramid[i][l]);
    free(kept);
    return st;
}

enum status match_pictures(struct flow flows[2], const struct image pictures[2], const struct geometry *geometry,
                           const struct feature_match *matches, int match_count, const struct morph_params *params,
                           struct err *err)
{
    enum status st = ST_OK;
    for (int i = 0; !st && i < 2; i++) {
        st = match_whole_pixels(&flows[i], pictures, i, geometry, matches, match_count, params, err);
        if (!st) st = flow_refine(&flows[i], pictures, i, geometry, params, err);
    }
    return st ? st : flow_check(flows, pictures, geometry, err);
}
