/* oversegment.c - superpixels by SLIC [Achanta 2012]: k-means in colour and position, from a regular grid of seeds.
 *
 * The squared distance of a pixel to a cluster centre is |d lab|^2 + (compactness / S)^2 |d xy|^2, with S the spacing
 * of the seeds. Each iteration assigns pixels to their nearest centres and moves the centres to the means of their
 * pixels. A pixel considers the nine centres seeded around it [Ren 2011], so that rows are independent; means are
 * summed in raster order. Then each centre keeps its largest connected component; other components, and those below a
 * sixth of the mean size, are merged into the adjacent segment of the nearest colour.
 *
 * What differs from the source: the picture is smoothed by (1 2 1)/4 first, so that noise does not fray the borders. */
#include "stages/segment_depth/oversegment.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "stages/segment_depth/segment_graph.h"

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

/* Opponent colours of gamma-encoded RGB, scaled like L*a*b*: a difference of 1 is just visible. */
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

/* Smooths a row or column by (1 2 1)/4 in place; the ends are repeated. line: scratch of `count` floats. */
static void smooth_line(float *at, size_t count, size_t step, float *line)
{
    for (size_t i = 0; i < count; i++) line[i] = at[i * step];
    for (size_t i = 0; i < count; i++)
        at[i * step] = 0.25f * line[i > 0 ? i - 1 : 0] + 0.5f * line[i] + 0.25f * line[i + 1 < count ? i + 1 : i];
}

static int cell_start(int cell, int cells, int size) { return (int)((int64_t)cell * size / cells); }

static void assign_rows(void *ctx, size_t begin, size_t end, int thread)
{
    struct slic *s = ctx;
    (void)thread;
    for (size_t row = begin; row < end; row++) {
        int gy = (int)((((int64_t)row + 1) * s->rows - 1) / s->height);
        float y = (float)row + 0.5f;
        for (int gx = 0; gx < s->columns; gx++) {
            int x0 = cell_start(gx, s->columns, s->width), x1 = cell_start(gx + 1, s->columns, s->width);
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

/* A connected component of pixels of one label. parent: the component that it was merged into, itself if none. */
struct component {
    int label, first, pixels, parent;
    double lab[3];
};

/* Fills component_of (w * h, -1 where there is no label) and the components; returns how many. queue: w * h,
 * scratch. */
static int find_components(const struct slic *s, int *component_of, int *queue, struct component *components)
{
    int pixels = s->width * s->height, count = 0;
    for (int i = 0; i < pixels; i++) component_of[i] = -1;
    for (int i = 0; i < pixels; i++) {
        if (component_of[i] >= 0 || s->label[i] < 0) continue;
        struct component *component = &components[count];
        *component = (struct component){.label = s->label[i], .first = i, .parent = count};
        int head = 0, tail = 0;
        queue[tail++] = i;
        component_of[i] = count;
        while (head < tail) {
            int p = queue[head++], x = p % s->width;
            const int next[4] = {x > 0 ? p - 1 : -1, x + 1 < s->width ? p + 1 : -1, p - s->width,
                                 p + s->width < pixels ? p + s->width : -1};
            for (int c = 0; c < 3; c++) component->lab[c] += (double)s->lab[c][p];
            for (int k = 0; k < 4; k++)
                if (next[k] >= 0 && component_of[next[k]] < 0 && s->label[next[k]] == component->label) {
                    component_of[next[k]] = count;
                    queue[tail++] = next[k];
                }
        }
        component->pixels = tail;
        for (int c = 0; c < 3; c++) component->lab[c] /= tail;
        count++;
    }
    return count;
}

static int find_root(const struct component *components, int i)
{
    while (components[i].parent != i) i = components[i].parent;
    return i;
}

/* Updates the best neighbour of component a, the one of the nearest colour, by component b. */
static void consider_neighbour(const struct component *components, int a, int b, int *best, float *best_distance)
{
    float d = 0;
    for (int c = 0; c < 3; c++) {
        float e = (float)(components[a].lab[c] - components[b].lab[c]);
        d += e * e;
    }
    if (d < *best_distance || (d <= *best_distance && b < *best)) {
        *best_distance = d;
        *best = b;
    }
}

/* Merges components that are too small or not the largest of their label, in order, with all that was merged into them,
 * into the adjacent component (as merged so far) of the nearest colour. visited: w * h, scratch. */
static void merge_components(const struct slic *s, int *component_of, int *visited, int *queue,
                             struct component *components, int count, const int *largest, int min_pixels)
{
    int pixels = s->width * s->height;
    for (int p = 0; p < pixels; p++) visited[p] = -1;
    for (int i = 0; i < count; i++) {
        if (largest[components[i].label] == i && components[i].pixels >= min_pixels) continue;
        int best = -1, head = 0, tail = 0;
        float best_distance = INFINITY;
        queue[tail++] = components[i].first;
        visited[components[i].first] = i;
        while (head < tail) {
            int p = queue[head++], x = p % s->width;
            const int next[4] = {x > 0 ? p - 1 : -1, x + 1 < s->width ? p + 1 : -1, p - s->width,
                                 p + s->width < pixels ? p + s->width : -1};
            for (int k = 0; k < 4; k++) {
                if (next[k] < 0 || s->label[next[k]] < 0 || visited[next[k]] == i) continue;
                int root = find_root(components, component_of[next[k]]);
                if (root == i) {
                    visited[next[k]] = i;
                    queue[tail++] = next[k];
                } else {
                    consider_neighbour(components, i, root, &best, &best_distance);
                }
            }
        }
        if (best < 0) continue; /* has no neighbour */
        components[i].parent = best;
        components[best].pixels += components[i].pixels;
    }
    for (int p = 0; p < pixels; p++)
        if (s->label[p] >= 0) component_of[p] = find_root(components, component_of[p]);
}

static enum status connect_segments(struct slic *s, int segment_pixels, struct err *err)
{
    size_t pixels = (size_t)s->width * (size_t)s->height, centres = (size_t)s->columns * (size_t)s->rows;
    int *component_of = malloc(pixels * sizeof *component_of), *queue = malloc(pixels * sizeof *queue);
    int *largest = malloc(centres * sizeof *largest), *visited = malloc(pixels * sizeof *visited);
    struct component *components = malloc(pixels * sizeof *components);
    if (component_of && queue && largest && visited && components) {
        int count = find_components(s, component_of, queue, components);
        for (size_t k = 0; k < centres; k++) largest[k] = -1;
        for (int i = 0; i < count; i++) {
            int *l = &largest[components[i].label];
            if (*l < 0 || components[i].pixels > components[*l].pixels) *l = i;
        }
        merge_components(s, component_of, visited, queue, components, count, largest, segment_pixels / 6);
        memcpy(s->label, component_of, pixels * sizeof *component_of);
    } else {
        err_nomem(err, "connected segments", pixels * (sizeof *components + 12));
    }
    free(component_of);
    free(queue);
    free(largest);
    free(visited);
    free(components);
    return err->status;
}

static void seed(struct slic *s)
{
    for (int j = 0; j < s->rows; j++)
        for (int i = 0; i < s->columns; i++) {
            struct centre *c = &s->centres[j * s->columns + i];
            int x = cell_start(i, s->columns, s->width) + cell_start(i + 1, s->columns, s->width);
            int y = cell_start(j, s->rows, s->height) + cell_start(j + 1, s->rows, s->height);
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
    if (!ok) err_nomem(err, "the over-segmentation", pixels * 16);
    if (!err->status) {
        lab_from_rgb(g, slic.lab);
        for (int c = 0; c < 3; c++) {
            for (size_t y = 0; y < (size_t)g->height; y++)
                smooth_line(slic.lab[c] + y * (size_t)g->width, (size_t)g->width, 1, line);
            for (size_t x = 0; x < (size_t)g->width; x++)
                smooth_line(slic.lab[c] + x, (size_t)g->height, (size_t)g->width, line);
        }
        seed(&slic);
    }
    for (int i = 0; !err->status && i < ITERATIONS; i++) {
        parallel_for((size_t)g->height, 16, assign_rows, &slic);
        if (i + 1 < ITERATIONS) move_centres(&slic, err);
    }
    if (!err->status && !connect_segments(&slic, segment_pixels, err)) segment_graph_make(s, slic.lab, err);
    for (int c = 0; c < 3; c++) free(slic.lab[c]);
    free(slic.centres);
    free(line);
    if (err->status) oversegment_release(s);
    return err->status;
}

enum status oversegment_double(struct segmentation *s, const struct segmentation *half, const struct gamma_image *g,
                               struct err *err)
{
    const int width = g->width, height = g->height;
    *s = (struct segmentation){.width = width, .height = height, .count = half->count};
    s->label = malloc((size_t)width * (size_t)height * sizeof *s->label);
    if (!s->label) return err_nomem(err, "the segments of pixels", (size_t)width * (size_t)height * sizeof *s->label);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            s->label[y * width + x] = g->valid[y * width + x] ? half->label[y / 2 * half->width + x / 2] : -1;
    if (segment_graph_of_numbers(s, NULL, err)) oversegment_release(s);
    return err->status;
}

void oversegment_release(struct segmentation *s)
{
    if (!s) return;
    free(s->label);
    free(s->pixel);
    free(s->segments);
    free(s->first_border);
    free(s->borders);
    *s = (struct segmentation){0};
}
