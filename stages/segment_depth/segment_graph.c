/* segment_graph.c - segments and the borders between them, from a label per pixel.
 *
 * A border is the set of pixel sides that two segments share; it is an edge of the segment graph, stored once in each
 * direction. Everything is listed in a fixed order, whatever the labels' numbers are. */
#include "stages/segment_depth/segment_graph.h"

#include <math.h>
#include <stdlib.h>

/* Numbers the labels from 0 in raster order of their first pixel. */
static enum status number_segments(struct segmentation *s, struct err *err)
{
    int pixels = s->width * s->height;
    int *segment_of_label = malloc((size_t)pixels * sizeof *segment_of_label);
    if (!segment_of_label) return err_nomem(err, "the numbers of segments", (size_t)pixels * sizeof *segment_of_label);
    for (int i = 0; i < pixels; i++) segment_of_label[i] = -1;
    s->count = 0;
    for (int i = 0; i < pixels; i++)
        if (s->label[i] >= 0) {
            int *n = &segment_of_label[s->label[i]];
            if (*n < 0) *n = s->count++;
            s->label[i] = *n;
        }
    free(segment_of_label);
    return ST_OK;
}

/* Fills the segments and their pixel lists. */
static enum status list_segments(struct segmentation *s, float *const lab[3], struct err *err)
{
    int pixels = s->width * s->height;
    s->pixel = malloc((size_t)pixels * sizeof *s->pixel);
    if (!s->pixel) return err_nomem(err, "lists of pixels", (size_t)pixels * sizeof *s->pixel);
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
        for (int c = 0; lab && c < 3; c++) g->colour[c] += lab[c][i];
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

/* A side shared by two pixels of different segments a < b: its middle, and the colour difference across it. */
struct pixel_side {
    int a, b;
    float u, v, contrast;
};

static int compare_sides(const void *p, const void *q)
{
    const struct pixel_side *a = p, *b = q;
    if (a->a != b->a) return a->a < b->a ? -1 : 1;
    if (a->b != b->b) return a->b < b->b ? -1 : 1;
    if (a->v < b->v || a->v > b->v) return a->v < b->v ? -1 : 1; /* a total order: qsort is not stable */
    return (a->u > b->u) - (a->u < b->u);
}

static int compare_borders(const void *p, const void *q)
{
    const struct border *a = p, *b = q;
    return (a->other > b->other) - (a->other < b->other);
}

static int list_sides(const struct segmentation *s, float *const lab[3], struct pixel_side *sides)
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
                    for (int c = 0; lab && c < 3; c++) d += (lab[c][p] - lab[c][q]) * (lab[c][p] - lab[c][q]);
                    sides[count] = (struct pixel_side){a < b ? a : b, a < b ? b : a, 0.5f * (float)(x + nx + 1),
                                                       0.5f * (float)(y + ny + 1), sqrtf(d)};
                }
                count++;
            }
    return count;
}

static enum status list_borders(struct segmentation *s, float *const lab[3], struct err *err)
{
    int sides_count = list_sides(s, lab, NULL), i = 0;
    struct pixel_side *sides = malloc(((size_t)sides_count + 1) * sizeof *sides);
    struct border *edges = malloc(((size_t)sides_count + 1) * sizeof *edges);
    int(*ends)[2] = malloc(((size_t)sides_count + 1) * sizeof *ends);
    s->first_border = calloc((size_t)s->count + 2, sizeof *s->first_border);
    if (sides && edges && ends && s->first_border) {
        list_sides(s, lab, sides);
        qsort(sides, (size_t)sides_count, sizeof *sides, compare_sides);
        s->edge_count = 0;
        while (i < sides_count) {
            struct border t = {.edge = s->edge_count};
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
        s->borders = malloc(((size_t)s->edge_count * 2 + 1) * sizeof *s->borders);
    }
    if (s->borders) {
        for (int e = 0; e < s->edge_count; e++)
            for (int k = 0; k < 2; k++) s->first_border[ends[e][k] + 2]++;
        for (int k = 1; k <= s->count + 1; k++) s->first_border[k] += s->first_border[k - 1];
        for (int e = 0; e < s->edge_count; e++)
            for (int k = 0; k < 2; k++) {
                struct border *t = &s->borders[s->first_border[ends[e][k] + 1]++];
                *t = edges[e];
                t->other = ends[e][1 - k];
            }
        for (int k = 0; k < s->count; k++)
            qsort(s->borders + s->first_border[k], (size_t)(s->first_border[k + 1] - s->first_border[k]),
                  sizeof *s->borders, compare_borders);
    } else {
        err_nomem(err, "borders between segments", (size_t)sides_count * sizeof *sides);
    }
    free(sides);
    free(edges);
    free(ends);
    return err->status;
}

enum status segment_graph_make(struct segmentation *s, float *const lab[3], struct err *err)
{
    return number_segments(s, err) || segment_graph_of_numbers(s, lab, err) ? err->status : ST_OK;
}

enum status segment_graph_of_numbers(struct segmentation *s, float *const lab[3], struct err *err)
{
    return list_segments(s, lab, err) || list_borders(s, lab, err) ? err->status : ST_OK;
}
