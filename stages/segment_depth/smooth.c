/* smooth.c - sequential tree-reweighted message passing (TRW-S) on the graph of segments [Kolmogorov 2006].
 *
 * Minimizes, over one label per segment,
 *   E(l) = sum_i cost_i(l_i) + sum over adjacent i, j of w_ij min(slope |l_i - l_j|, truncation)
 * Nodes are visited in order of their numbers, forwards and backwards. A visit sends to each neighbour that comes later
 * in the direction of the visit the message
 *   m_ij(l) = min_k (belief_i(k) / n_i - m_ji(k) + V_ij(k, l)),   n_i = max(number of earlier, number of later
 * neighbours) where the belief is the cost plus all incoming messages. One message per edge is stored: that of the last
 * visit. Labels are chosen in order, given the labels of earlier segments and the messages of later ones (the source,
 * 3.3). What differs from the source: a fixed number of rounds without its lower bound, followed by ICM_ROUNDS rounds
 * of iterated conditional modes, since messages that tie leave labels that their neighbours alone improve. */
#include "stages/segment_depth/smooth.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#define ROUNDS     10
#define ICM_ROUNDS 3

/* SIMILAR: colour difference that halves a border's weight. MIN_WEIGHT: the weight between different colours; depth
 * edges without a colour edge are rare, the reverse is common. */
#define SIMILAR    9.0f
#define MIN_WEIGHT 0.06f

float *smooth_border_weights(const struct segmentation *s, int segment_pixels)
{
    int borders = s->first_border[s->count];
    float *weights = malloc(((size_t)borders + 1) * sizeof *weights);
    if (!weights) return NULL;
    for (int i = 0; i < s->count; i++)
        for (int t = s->first_border[i]; t < s->first_border[i + 1]; t++) {
            const struct border *border = &s->borders[t];
            float d = 0;
            for (int c = 0; c < 3; c++) {
                float e = s->segments[i].colour[c] - s->segments[border->other].colour[c];
                d += e * e;
            }
            /* the segments' means alone would cut gradients, the border's contrast alone would leak through soft
             * edges */
            d = (0.5f * sqrtf(d) + border->contrast) / SIMILAR;
            weights[t] =
                (float)(border->length / sqrt(segment_pixels)) * (MIN_WEIGHT + (1 - MIN_WEIGHT) / (1 + d * d * d * d));
        }
    return weights;
}

struct trws {
    const struct segmentation *s;
    const float *weights;
    int labels;
    float slope, truncation;
    float *message; /* `labels` per edge */
    float *belief, *scratch;
};

static inline float min_float(float a, float b) { return a < b ? a : b; }

/* Min-convolution with the truncated linear cost: inout(l) = min_k inout(k) + min(slope |k - l|, truncation), minus the
 * minimum of inout. scratch: `labels` floats. Convolutions with cones of radius 1, 2, 4 ... labels in sequence make a
 * cone of the sum of the radii, which need not rise above the truncation; each is a vector operation. */
static void truncated_linear(float *inout, float *scratch, int labels, float slope, float truncation)
{
    float lowest = inout[0], *from = inout, *to = scratch;
    for (int l = 1; l < labels; l++) lowest = min_float(inout[l], lowest);
    for (int reach = 1; reach < labels && (float)(reach - 1) * slope < truncation; reach *= 2) {
        float rise = (float)reach * slope;
        int inner = labels - reach > reach ? reach : labels - reach;
        for (int l = 0; l < inner; l++) to[l] = min_float(from[l], from[l + reach] + rise);
        for (int l = reach; l < labels - reach; l++)
            to[l] = min_float(from[l], min_float(from[l - reach], from[l + reach]) + rise);
        for (int l = inner; l < reach; l++) to[l] = from[l];
        for (int l = labels - reach > reach ? labels - reach : reach; l < labels; l++)
            to[l] = min_float(from[l], from[l - reach] + rise);
        float *swap = from;
        from = to;
        to = swap;
    }
    for (int l = 0; l < labels; l++) inout[l] = min_float(from[l], lowest + truncation) - lowest;
}

static void update_messages(struct trws *p, int i, const float *cost, bool forward)
{
    int before = 0, after = 0, labels = p->labels;
    int begin = p->s->first_border[i], end = p->s->first_border[i + 1];
    for (int l = 0; l < labels; l++) p->belief[l] = cost[l];
    for (int t = begin; t < end; t++) {
        const float *message = p->message + (size_t)p->s->borders[t].edge * (size_t)labels;
        for (int l = 0; l < labels; l++) p->belief[l] += message[l];
        if (p->s->borders[t].other < i)
            before++;
        else
            after++;
    }
    int share = before > after ? before : after;
    float part = share > 0 ? 1 / (float)share : 1;
    for (int t = begin; t < end; t++) {
        if ((p->s->borders[t].other > i) != forward) continue;
        float *message = p->message + (size_t)p->s->borders[t].edge * (size_t)labels;
        for (int l = 0; l < labels; l++) message[l] = part * p->belief[l] - message[l];
        truncated_linear(message, p->scratch, labels, p->slope * p->weights[t], p->truncation * p->weights[t]);
    }
}

/* Label of segment i, given the labels of the segments before it and, of those after it, the messages or else the
 * labels. */
static int choose_label(struct trws *p, int i, const float *cost, const int *label, bool use_messages)
{
    int best = 0;
    for (int l = 0; l < p->labels; l++) p->belief[l] = cost[l];
    for (int t = p->s->first_border[i]; t < p->s->first_border[i + 1]; t++) {
        int other = p->s->borders[t].other;
        const float *message = p->message + (size_t)p->s->borders[t].edge * (size_t)p->labels;
        for (int l = 0; l < p->labels; l++)
            p->belief[l] += other > i && use_messages
                                ? message[l]
                                : p->weights[t] * min_float(p->slope * (float)abs(l - label[other]), p->truncation);
    }
    for (int l = 1; l < p->labels; l++)
        if (p->belief[l] < p->belief[best]) best = l;
    return use_messages || p->belief[best] < p->belief[label[i]] ? best : label[i];
}

enum status smooth_labels(int *label, const struct segmentation *s, const float *cost, int labels, const float *weights,
                          float slope, float truncation, struct err *err)
{
    struct trws p = {.s = s, .weights = weights, .labels = labels, .slope = slope, .truncation = truncation};
    p.message = calloc((size_t)s->edge_count * (size_t)labels + 1, sizeof *p.message);
    p.belief = malloc(2 * (size_t)labels * sizeof *p.belief);
    if (p.message && p.belief) {
        p.scratch = p.belief + labels;
        for (int round = 0; round < ROUNDS; round++) {
            for (int i = 0; i < s->count; i++) update_messages(&p, i, cost + (size_t)i * (size_t)labels, true);
            for (int i = s->count - 1; i >= 0; i--) update_messages(&p, i, cost + (size_t)i * (size_t)labels, false);
        }
        /* round 0 reads the labels off the messages, the others are iterated conditional modes */
        for (int round = 0; round <= ICM_ROUNDS; round++)
            for (int i = 0; i < s->count; i++)
                label[i] = choose_label(&p, i, cost + (size_t)i * (size_t)labels, label, round == 0);
    } else {
        err_nomem(err, "messages between segments", (size_t)s->edge_count * (size_t)labels * sizeof(float));
    }
    free(p.message);
    free(p.belief);
    return err->status;
}
