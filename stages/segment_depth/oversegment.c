/* oversegment.c - SLIC: k-means in colour and position, from a regular grid of seeds.
 *
 * Distance of a pixel to a centre: |d lab|^2 + (compactness / S)^2 |d xy|^2, S the seeds' spacing. A pixel looks at the
 * nine centres seeded around it (Ren and Reid's formulation), which makes rows independent of each other; centres are
 * summed in raster order. Differs from the paper in that the picture is smoothed by (1 2 1)/4 first, so that noise
 * does not fray the borders. Afterwards a centre keeps its largest connected part; other parts, and those under a sixth of
 * the mean size, go to the touching segment of the nearest colour. */
#include "stages/segment_depth/oversegment.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"

#define ITERATIONS 8

struct centre {
    float lab[3], x, y;
};

struct slic {
    int width, height, columns, rows;
    float spatial; /* weight of squared pixel distance */
    float *lab[3];
    const uint8_t *valid;
    struct centre *centres;
    int *label;
};

/* Opponent colours from gamma-encoded RGB, scaled like L*a*b*: a difference of 1 is just visible. */
static void lab_from_rgb(const struct gamma_image *g, float *lab[3])
{
    size_t pixels = (size_t)g->width * (size_t)g->height;
    for (size_t i = 0; i < pixels; i++) {
        float r = g->rgb[0][i], gr = g->rgb[1][i], b = g->rgb[2][i];
        lab[0][i] = 100 * (0.3f * r + 0.6f * gr + 0.1f * b);
        lab[1][i] = 90 * (r - gr);
        lab[2][i] = 70 * (0.5f * (r + gr) - b);
    }
}

/* (1 2 1)/4 both ways, in place; line holds max(width, height) floats. The ends repeat. */
static void smooth_line(float *at, size_t count, size_t step, float *line)
{
    for (size_t i = 0; i < count; i++) line[i] = at[i * step];
    for (size_t i = 0; i < count; i++)
        at[i * step] = 0.25f * line[i > 0 ? i - 1 : 0] + 0.5f * line[i] + 0.25f * line[i + 1 < count ? i + 1 : i];
}

static int bound(int cell, int cells, int size) { return (int)((int64_t)cell * size / cells); }

static void assign_rows(void *ctx, size_t begin, size_t end, int thread)
{
    struct slic *s = ctx;
    (void)thread;
    for (size_t row = begin; row < end; row++) {
        int gy = (int)((((int64_t)row + 1) * s->rows - 1) / s->height);
        float y = (float)row + 0.5f;
        for (int gx = 0; gx < s->columns; gx++) {
            int x0 = bound(gx, s->columns, s->width), x1 = bound(gx + 1, s->columns, s->width);
            struct centre near[9];
            int near_label[9], count = 0;
            for (int j = gy - 1; j <= gy + 1; j++)
                for (int i = gx - 1; i <= gx + 1; i++)
                    if (i >= 0 && j >= 0 && i < s->columns && j < s->rows) {
                        near_label[count] = j * s->columns + i;
                        near[count++] = s->centres[j * s->columns + i];
                    }
            for (int x = x0; x < x1; x++) {
                size_t p = row * (size_t)s->width + (size_t)x;
                float best = INFINITY;
                int label = -1;
                for (int k = 0; k < count && s->valid[p]; k++) {
                    float dl = s->lab[0][p] - near[k].lab[0], da = s->lab[1][p] - near[k].lab[1],
                          db = s->lab[2][p] - near[k].lab[2], dx = (float)x + 0.5f - near[k].x, dy = y - near[k].y;
                    float d = dl * dl + da * da + db * db + s->spatial * (dx * dx + dy * dy);
                    if (d < best) {
                        best = d;
                        label = near_label[k];
                    }
                }
                s->label[p] = label;
            }
        }
    }
}

static enum status move_centres(struct slic *s, struct err *err)
{
    size_t centres = (size_t)s->columns * (size_t)s->rows, p = 0;
    double(*sum)[6] = calloc(centres, sizeof *sum);
    if (!sum) return err_nomem(err, "segment centres", centres * sizeof *sum);
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++, p++) {
            if (s->label[p] < 0) continue;
            double *a = sum[s->label[p]];
            for (int c = 0; c < 3; c++) a[c] += (double)s->lab[c][p];
            a[3] += x + 0.5;
            a[4] += y + 0.5;
            a[5] += 1;
        }
    for (size_t k = 0; k < centres; k++) {
        struct centre *c = &s->centres[k];
        if (!(sum[k][5] > 0)) continue;
        for (int i = 0; i < 3; i++) c->lab[i] = (float)(sum[k][i] / sum[k][5]);
        c->x = (float)(sum[k][3] / sum[k][5]);
        c->y = (float)(sum[k][4] / sum[k][5]);
    }
    free(sum);
    return ST_OK;
}

/* Connected parts of equal label: part of each pixel (-1: none), and their sizes and mean colours. */
struct part {
    int label, first, pixels, into; /* into: the part that takes it, itself if it stays */
    double lab[3];
};

static int find_parts(const struct slic *s, int *part_of, int *queue, struct part *parts)
{
    int pixels = s->width * s->height, count = 0;
    for (int i = 0; i < pixels; i++) part_of[i] = -1;
    for (int i = 0; i < pixels; i++) {
        if (part_of[i] >= 0 || s->label[i] < 0) continue;
        struct part *part = &parts[count];
        *part = (struct part){.label = s->label[i], .first = i, .into = count};
        int head = 0, tail = 0;
        queue[tail++] = i;
        part_of[i] = count;
        while (head < tail) {
            int p = queue[head++], x = p % s->width;
            const int next[4] = {x > 0 ? p - 1 : -1, x + 1 < s->width ? p + 1 : -1, p - s->width,
                                 p + s->width < pixels ? p + s->width : -1};
            for (int c = 0; c < 3; c++) part->lab[c] += (double)s->lab[c][p];
            for (int k = 0; k < 4; k++)
                if (next[k] >= 0 && part_of[next[k]] < 0 && s->label[next[k]] == part->label) {
                    part_of[next[k]] = count;
                    queue[tail++] = next[k];
                }
        }
        part->pixels = tail;
        for (int c = 0; c < 3; c++) part->lab[c] /= tail;
        count++;
    }
    return count;
}

static int root_of(const struct part *parts, int i)
{
    while (parts[i].into != i) i = parts[i].into;
    return i;
}

/* Offers part b to a part a that must go: keeps the one of the nearest colour. */
static void offer(const struct part *parts, int a, int b, int *best, float *best_distance)
{
    float d = 0;
    for (int c = 0; c < 3; c++) {
        float e = (float)(parts[a].lab[c] - parts[b].lab[c]);
        d += e * e;
    }
    if (d < *best_distance || (d <= *best_distance && b < *best)) {
        *best_distance = d;
        *best = b;
    }
}

/* Parts that may not stay, in order, are given with all that was given to them to the touching part (as merged so far)
 * of the nearest colour. walked: w * h, scratch. */
static void merge_parts(const struct slic *s, int *part_of, int *walked, int *queue, struct part *parts, int count,
                        const int *largest, int least_pixels)
{
    int pixels = s->width * s->height;
    for (int p = 0; p < pixels; p++) walked[p] = -1;
    for (int i = 0; i < count; i++) {
        if (largest[parts[i].label] == i && parts[i].pixels >= least_pixels) continue;
        int best = -1, head = 0, tail = 0;
        float best_distance = INFINITY;
        queue[tail++] = parts[i].first;
        walked[parts[i].first] = i;
        while (head < tail) {
            int p = queue[head++], x = p % s->width;
            const int next[4] = {x > 0 ? p - 1 : -1, x + 1 < s->width ? p + 1 : -1, p - s->width,
                                 p + s->width < pixels ? p + s->width : -1};
            for (int k = 0; k < 4; k++) {
                if (next[k] < 0 || s->label[next[k]] < 0 || walked[next[k]] == i) continue;
                int root = root_of(parts, part_of[next[k]]);
                if (root == i) {
                    walked[next[k]] = i;
                    queue[tail++] = next[k];
                } else {
                    offer(parts, i, root, &best, &best_distance);
                }
            }
        }
        if (best < 0) continue; /* an island */
        parts[i].into = best;
        parts[best].pixels += parts[i].pixels;
    }
    for (int p = 0; p < pixels; p++)
        if (s->label[p] >= 0) part_of[p] = root_of(parts, part_of[p]);
}

static enum status connect_segments(struct slic *s, int segment_pixels, struct err *err)
{
    size_t pixels = (size_t)s->width * (size_t)s->height, centres = (size_t)s->columns * (size_t)s->rows;
    int *part_of = malloc(pixels * sizeof *part_of), *queue = malloc(pixels * sizeof *queue);
    int *largest = malloc(centres * sizeof *largest), *walked = malloc(pixels * sizeof *walked);
    struct part *parts = malloc(pixels * sizeof *parts);
    enum status st = ST_OK;
    if (part_of && queue && largest && walked && parts) {
        int count = find_parts(s, part_of, queue, parts);
        for (size_t k = 0; k < centres; k++) largest[k] = -1;
        for (int i = 0; i < count; i++) {
            int *l = &largest[parts[i].label];
            if (*l < 0 || parts[i].pixels > parts[*l].pixels) *l = i;
        }
        merge_parts(s, part_of, walked, queue, parts, count, largest, segment_pixels / 6);
        memcpy(s->label, part_of, pixels * sizeof *part_of);
    } else {
        st = err_nomem(err, "connected segments", pixels * (sizeof *parts + 12));
    }
    free(part_of);
    free(queue);
    free(largest);
    free(walked);
    free(parts);
    return st;
}

/* Numbers the labels from 0 in raster order of their first pixel; fills segments and pixel lists. */
static enum status list_segments(struct segmentation *s, float *const lab[3], struct err *err)
{
    int pixels = s->width * s->height;
    int *number = malloc((size_t)pixels * sizeof *number);
    s->pixel = malloc((size_t)pixels * sizeof *s->pixel);
    if (!number || !s->pixel) {
        free(number);
        return err_nomem(err, "lists of pixels", (size_t)pixels * 8);
    }
    for (int i = 0; i < pixels; i++) number[i] = -1;
    s->count = 0;
    for (int i = 0; i < pixels; i++)
        if (s->label[i] >= 0) {
            int *n = &number[s->label[i]];
            if (*n < 0) *n = s->count++;
            s->label[i] = *n;
        }
    free(number);
    s->segments = calloc((size_t)s->count + 1, sizeof *s->segments);
    if (!s->segments) return err_nomem(err, "segments", (size_t)s->count * sizeof *s->segments);
    for (int i = 0; i < pixels; i++)
        if (s->label[i] >= 0) s->segments[s->label[i]].pixels++;
    for (int k = 0, first = 0; k < s->count; k++) {
        s->segments[k].first = first;
        first += s->segments[k].pixels;
        s->segments[k].pixels = 0;
        s->segments[k].x0 = s->width;
        s->segments[k].y0 = s->height;
    }
    for (int i = 0; i < pixels; i++) {
        if (s->label[i] < 0) continue;
        struct segment *g = &s->segments[s->label[i]];
        int x = i % s->width, y = i / s->width;
        s->pixel[g->first + g->pixels++] = i;
        g->cx += x + 0.5;
        g->cy += y + 0.5;
        for (int c = 0; c < 3; c++) g->colour[c] += lab[c][i];
        g->x0 = x < g->x0 ? x : g->x0;
        g->x1 = x > g->x1 ? x : g->x1;
        g->y0 = y < g->y0 ? y : g->y0;
        g->y1 = y > g->y1 ? y : g->y1;
    }
    for (int k = 0; k < s->count; k++) {
        struct segment *g = &s->segments[k];
        g->cx /= g->pixels;
        g->cy /= g->pixels;
        for (int c = 0; c < 3; c++) g->colour[c] /= (float)g->pixels;
    }
    return ST_OK;
}

/* A pair of pixels on either side of a border, a < b. */
struct side {
    int a, b;
    float u, v, contrast;
};

static int compare_sides(const void *p, const void *q)
{
    const struct side *a = p, *b = q;
    if (a->a != b->a) return a->a < b->a ? -1 : 1;
    if (a->b != b->b) return a->b < b->b ? -1 : 1;
    if (a->v < b->v || a->v > b->v) return a->v < b->v ? -1 : 1; /* a total order: qsort is not stable */
    return (a->u > b->u) - (a->u < b->u);
}

static int compare_touches(const void *p, const void *q)
{
    const struct touch *a = p, *b = q;
    return (a->other > b->other) - (a->other < b->other);
}

static int list_sides(const struct segmentation *s, float *const lab[3], struct side *sides)
{
    int count = 0;
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++)
            for (int k = 0; k < 2; k++) { /* to the right, down */
                int nx = x + (k == 0), ny = y + (k == 1), p = y * s->width + x, q = ny * s->width + nx;
                if (nx >= s->width || ny >= s->height || s->label[p] == s->label[q]) continue;
                if (s->label[p] < 0 || s->label[q] < 0) continue;
                if (sides) {
                    int a = s->label[p], b = s->label[q];
                    float d = 0;
                    for (int c = 0; c < 3; c++) d += (lab[c][p] - lab[c][q]) * (lab[c][p] - lab[c][q]);
                    sides[count] = (struct side){a < b ? a : b, a < b ? b : a, 0.5f * (float)(x + nx + 1),
                                                 0.5f * (float)(y + ny + 1), sqrtf(d)};
                }
                count++;
            }
    return count;
}

static enum status list_touches(struct segmentation *s, float *const lab[3], struct err *err)
{
    int sides_count = list_sides(s, lab, NULL), i = 0;
    struct side *sides = malloc(((size_t)sides_count + 1) * sizeof *sides);
    struct touch *edges = malloc(((size_t)sides_count + 1) * sizeof *edges);
    int(*ends)[2] = malloc(((size_t)sides_count + 1) * sizeof *ends);
    s->first_touch = calloc((size_t)s->count + 2, sizeof *s->first_touch);
    enum status st = ST_OK;
    if (sides && edges && ends && s->first_touch) {
        list_sides(s, lab, sides);
        qsort(sides, (size_t)sides_count, sizeof *sides, compare_sides);
        s->edge_count = 0;
        while (i < sides_count) {
            struct touch t = {.edge = s->edge_count};
            int a = sides[i].a, b = sides[i].b;
            double u = 0, v = 0, contrast = 0;
            for (; i < sides_count && sides[i].a == a && sides[i].b == b; i++, t.length++) {
                u += (double)sides[i].u;
                v += (double)sides[i].v;
                contrast += (double)sides[i].contrast;
            }
            t.u = (float)(u / t.length);
            t.v = (float)(v / t.length);
            t.contrast = (float)(contrast / t.length);
            ends[s->edge_count][0] = a;
            ends[s->edge_count][1] = b;
            edges[s->edge_count++] = t;
        }
        s->touches = malloc(((size_t)s->edge_count * 2 + 1) * sizeof *s->touches);
    }
    if (s->touches) {
        for (int e = 0; e < s->edge_count; e++)
            for (int k = 0; k < 2; k++) s->first_touch[ends[e][k] + 2]++;
        for (int k = 1; k <= s->count + 1; k++) s->first_touch[k] += s->first_touch[k - 1];
        for (int e = 0; e < s->edge_count; e++)
            for (int k = 0; k < 2; k++) {
                struct touch *t = &s->touches[s->first_touch[ends[e][k] + 1]++];
                *t = edges[e];
                t->other = ends[e][1 - k];
            }
        for (int k = 0; k < s->count; k++)
            qsort(s->touches + s->first_touch[k], (size_t)(s->first_touch[k + 1] - s->first_touch[k]),
                  sizeof *s->touches, compare_touches);
    } else {
        st = err_nomem(err, "borders between segments", (size_t)sides_count * sizeof *sides);
    }
    free(sides);
    free(edges);
    free(ends);
    return st;
}

static void seed(struct slic *s)
{
    for (int j = 0; j < s->rows; j++)
        for (int i = 0; i < s->columns; i++) {
            struct centre *c = &s->centres[j * s->columns + i];
            int x = bound(i, s->columns, s->width) + bound(i + 1, s->columns, s->width);
            int y = bound(j, s->rows, s->height) + bound(j + 1, s->rows, s->height);
            size_t p = (size_t)(y / 2) * (size_t)s->width + (size_t)(x / 2);
            *c = (struct centre){{s->lab[0][p], s->lab[1][p], s->lab[2][p]}, 0.5f * (float)x, 0.5f * (float)y};
        }
}

enum status oversegment(struct segmentation *s, const struct gamma_image *g, int segment_pixels, double compactness,
                        struct err *err)
{
    double spacing = sqrt(segment_pixels);
    struct slic slic = {
        .width = g->width,
        .height = g->height,
        .columns = (int)fmax(1, round(g->width / spacing)),
        .rows = (int)fmax(1, round(g->height / spacing)),
        .spatial = (float)(compactness * compactness / segment_pixels),
        .valid = g->valid,
    };
    size_t pixels = (size_t)g->width * (size_t)g->height;
    size_t longest = (size_t)(g->width > g->height ? g->width : g->height);
    float *line = malloc(longest * sizeof *line);
    *s = (struct segmentation){.width = g->width, .height = g->height};
    s->label = slic.label = malloc(pixels * sizeof *s->label);
    slic.centres = malloc((size_t)slic.columns * (size_t)slic.rows * sizeof *slic.centres);
    bool ok = line && slic.label && slic.centres;
    for (int c = 0; c < 3; c++) ok = (slic.lab[c] = malloc(pixels * sizeof(float))) && ok;
    enum status st = ok ? ST_OK : err_nomem(err, "the over-segmentation", pixels * 16);
    if (!st) {
        lab_from_rgb(g, slic.lab);
        for (int c = 0; c < 3; c++) {
            for (size_t y = 0; y < (size_t)g->height; y++)
                smooth_line(slic.lab[c] + y * (size_t)g->width, (size_t)g->width, 1, line);
            for (size_t x = 0; x < (size_t)g->width; x++)
                smooth_line(slic.lab[c] + x, (size_t)g->height, (size_t)g->width, line);
        }
        seed(&slic);
    }
    for (int i = 0; !st && i < ITERATIONS; i++) {
        parallel_for((size_t)g->height, 16, assign_rows, &slic);
        if (i + 1 < ITERATIONS) st = move_centres(&slic, err);
    }
    if (!st) st = connect_segments(&slic, segment_pixels, err);
    if (!st) st = list_segments(s, slic.lab, err);
    if (!st) st = list_touches(s, slic.lab, err);
    for (int c = 0; c < 3; c++) free(slic.lab[c]);
    free(slic.centres);
    free(line);
    if (st) segmentation_release(s);
    return st;
}

void segmentation_release(struct segmentation *s)
{
    if (!s) return;
    free(s->label);
    free(s->pixel);
    free(s->segments);
    free(s->first_touch);
    free(s->touches);
    *s = (struct segmentation){0};
}
