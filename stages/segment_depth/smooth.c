/* smooth.c - sequential tree-reweighted message passing on the graph of touching segments.
 *
 * Nodes are visited in order of number, forwards and backwards; one message an edge is kept, always the one that runs in
 * the direction of the last visit. A message is a lower envelope of cut-off cones. */
#include "stages/segment_depth/smooth.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#define ROUNDS  10
#define REPAIRS 3

/* Colour difference at which two sides are half alike, and what remains of a border's weight between unlike ones: a
 * depth edge without a colour edge is rare, the reverse is common. */
#define ALIKE         9.0f
#define UNLIKE_WEIGHT 0.06f

float *touch_weights(const struct segmentation *s, int segment_pixels)
{
    int touches = s->first_touch[s->count];
    float *weights = malloc(((size_t)touches + 1) * sizeof *weights);
    if (!weights) return NULL;
    for (int i = 0; i < s->count; i++)
        for (int t = s->first_touch[i]; t < s->first_touch[i + 1]; t++) {
            const struct touch *touch = &s->touches[t];
            float d = 0;
            for (int c = 0; c < 3; c++) {
                float e = s->segments[i].colour[c] - s->segments[touch->other].colour[c];
                d += e * e;
            }
            /* the mean alone would tear gradients apart, the border alone would leak through soft edges */
            d = (0.5f * sqrtf(d) + touch->contrast) / ALIKE;
            weights[t] = (float)(touch->length / sqrt(segment_pixels)) *
                         (UNLIKE_WEIGHT + (1 - UNLIKE_WEIGHT) / (1 + d * d * d * d));
        }
    return weights;
}

struct pass {
    const struct segmentation *s;
    const float *weights;
    int labels;
    float slope, most;
    float *message; /* labels an edge */
    float *belief, *scratch;
};

static inline float smaller(float a, float b) { return a < b ? a : b; }

/* inout(l) = min_k inout(k) + min(slope |k - l|, most), less its minimum; scratch holds as many. Cones of 1, 2, 4 ... labels
 * one after another make the cone of their sum, as far as it is not cut off anyway; each step is a vector operation. */
static void truncated_linear(float *inout, float *scratch, int labels, float slope, float most)
{
    float least = inout[0], *from = inout, *to = scratch;
    for (int l = 1; l < labels; l++) least = smaller(inout[l], least);
    for (int reach = 1; reach < labels && (float)(reach - 1) * slope < most; reach *= 2) {
        float rise = (float)reach * slope;
        int inner = labels - reach > reach ? reach : labels - reach;
        for (int l = 0; l < inner; l++) to[l] = smaller(from[l], from[l + reach] + rise);
        for (int l = reach; l < labels - reach; l++)
            to[l] = smaller(from[l], smaller(from[l - reach], from[l + reach]) + rise);
        for (int l = inner; l < reach; l++) to[l] = from[l];
        for (int l = labels - reach > reach ? labels - reach : reach; l < labels; l++)
            to[l] = smaller(from[l], from[l - reach] + rise);
        float *swap = from;
        from = to;
        to = swap;
    }
    for (int l = 0; l < labels; l++) inout[l] = smaller(from[l], least + most) - least;
}

static void visit(struct pass *p, int i, const float *cost, bool forward)
{
    int before = 0, after = 0, labels = p->labels;
    int begin = p->s->first_touch[i], end = p->s->first_touch[i + 1];
    for (int l = 0; l < labels; l++) p->belief[l] = cost[l];
    for (int t = begin; t < end; t++) {
        const float *message = p->message + (size_t)p->s->touches[t].edge * (size_t)labels;
        for (int l = 0; l < labels; l++) p->belief[l] += message[l];
        if (p->s->touches[t].other < i)
            before++;
        else
            after++;
    }
    int share = before > after ? before : after;
    float part = share > 0 ? 1 / (float)share : 1;
    for (int t = begin; t < end; t++) {
        if ((p->s->touches[t].other > i) != forward) continue;
        float *message = p->message + (size_t)p->s->touches[t].edge * (size_t)labels;
        for (int l = 0; l < labels; l++) message[l] = part * p->belief[l] - message[l];
        truncated_linear(message, p->scratch, labels, p->slope * p->weights[t], p->most * p->weights[t]);
    }
}

/* Label of i given those of the segments before it, and the messages of those after it or else their labels too. */
static int decide(struct pass *p, int i, const float *cost, const int *label, bool messages)
{
    int best = 0;
    for (int l = 0; l < p->labels; l++) p->belief[l] = cost[l];
    for (int t = p->s->first_touch[i]; t < p->s->first_touch[i + 1]; t++) {
        int other = p->s->touches[t].other;
        const float *message = p->message + (size_t)p->s->touches[t].edge * (size_t)p->labels;
        for (int l = 0; l < p->labels; l++)
            p->belief[l] += other > i && messages
                                ? message[l]
                                : p->weights[t] * smaller(p->slope * (float)abs(l - label[other]), p->most);
    }
    for (int l = 1; l < p->labels; l++)
        if (p->belief[l] < p->belief[best]) best = l;
    return messages || p->belief[best] < p->belief[label[i]] ? best : label[i];
}

enum status smooth_labels(int *label, const struct segmentation *s, const float *cost, int labels, const float *weights,
                          float slope, float most, struct err *err)
{
    struct pass p = {.s = s, .weights = weights, .labels = labels, .slope = slope, .most = most};
    enum status st = ST_OK;
    p.message = calloc((size_t)s->edge_count * (size_t)labels + 1, sizeof *p.message);
    p.belief = malloc(2 * (size_t)labels * sizeof *p.belief);
    if (p.message && p.belief) {
        p.scratch = p.belief + labels;
        for (int round = 0; round < ROUNDS; round++) {
            for (int i = 0; i < s->count; i++) visit(&p, i, cost + (size_t)i * (size_t)labels, true);
            for (int i = s->count - 1; i >= 0; i--) visit(&p, i, cost + (size_t)i * (size_t)labels, false);
        }
        /* messages that tie leave labels that a look at the neighbours improves */
        for (int round = 0; round <= REPAIRS; round++)
            for (int i = 0; i < s->count; i++)
                label[i] = decide(&p, i, cost + (size_t)i * (size_t)labels, label, round == 0);
    } else {
        st = err_nomem(err, "messages between segments", (size_t)s->edge_count * (size_t)labels * sizeof(float));
    }
    free(p.message);
    free(p.belief);
    return st;
}
