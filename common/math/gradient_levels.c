/* gradient_levels.c - coarser forms of a gradient problem, by groups of nodes.
 *
 * A coarse unknown is one value for a group of nodes: the interpolation P copies it to them, and the coarse matrix is
 * P' A P. In the form of gradient_system.h that is simple: the excess of a group is the sum of its nodes' excesses, and
 * the weight between two groups the sum of the weights between their nodes. Nothing is subtracted, so a part without
 * excess stays exactly singular on every level, and weights of 1e-5 beside weights of 1 keep their digits.
 *
 * Groups are made by matching in pairs, twice [Notay 2010; Napov 2012]. Each group k in turn, at first each node, is
 * joined with the unmatched one h of the largest
 *     q = weight (1 / D_k + 1 / D_h),    D: sum of the diagonals of the group's nodes,
 * if q is at least 1/4. 2 / q bounds how much of the pair's difference the smoother leaves at small energy. So a weight
 * of 1e-5 joins a single node only if all its weights are small, and two nodes that a weight of 1 joins are never part
 * of a group with others to which they have only weights of 1e-5. On a plain raster the groups are squares of 2 x 2. A
 * third matching follows where two leave more groups than 2/5 of the nodes. Nodes that the smoother solves well alone
 * have no group: those without links, and those with an excess of more than 5 times their weights. A link to one of
 * them counts as excess.
 *
 * The last level is eliminated in the same form: of node k with pivot d = excess + weights, link (i, j) gets
 * weight(k, i) weight(k, j) / d and node i the excess weight(k, i) excess(k) / d [Grassmann 1985].
 *
 * Differs from the sources: the bound of pairs also judges groups of four and eight, with the sums of the diagonals,
 * and leaves the excess out; nodes are taken in order of rows. */
#include "common/math/gradient_levels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MIN_QUALITY 0.25F
#define DOMINANT    5.0F

/* The equations of a level while the next is made. Row i has links to smaller nodes at [begin[2 i], begin[2 i + 1]), to
 * larger ones up to begin[2 i + 2], each in ascending order. */
struct graph {
    int count;
    int *begin;
    struct gradient_link *link;
    float *excess, *diagonal;
};

/* Groups of nodes while they are matched: lists of members. */
struct groups {
    int count;
    int *first, *last; /* nodes of a group */
    int *next;         /* of a node in its list; -1: none */
    int *group;        /* of a node; -1: none */
    int *merged;       /* the group's new number while a pass runs */
    int *seen;         /* groups that are linked to the one in hand */
    float *inverse;    /* of a group: one over the sum of its nodes' diagonals */
    float *between;    /* a group's weight to the one in hand; 0: not seen */
};

static void graph_release(struct graph *g)
{
    free(g->begin);
    free(g->link);
    free(g->excess);
    free(g->diagonal);
    *g = (struct graph){0};
}

static enum status graph_allocate(struct graph *g, int count, size_t links, struct err *err)
{
    const size_t n = (size_t)count;
    g->count = count;
    g->begin = calloc(2 * n + 1, sizeof *g->begin);
    g->link = malloc((links + 1) * sizeof *g->link);
    g->excess = calloc(n + 1, sizeof *g->excess);
    g->diagonal = malloc((n + 1) * sizeof *g->diagonal);
    if (g->begin && g->link && g->excess && g->diagonal) return ST_OK;
    return err_nomem(err, "a level of a gradient problem", n * 4 * sizeof(float) + links * sizeof *g->link);
}

static void sum_diagonal(struct graph *g)
{
    for (int i = 0; i < g->count; i++) {
        g->diagonal[i] = g->excess[i];
        for (int e = g->begin[2 * i]; e < g->begin[2 * i + 2]; e++) g->diagonal[i] += g->link[e].weight;
    }
}

static enum status finest(struct graph *g, const struct gradient_system *s, float scale, struct err *err)
{
    size_t links = 0;
    for (int i = 0; i < s->count; i++) links += 2 * (size_t)((s->next[i][0] >= 0) + (s->next[i][1] >= 0));
    if (graph_allocate(g, s->count, links, err)) return err->status;
    int *at = malloc((size_t)s->count * sizeof *at); /* place of the next link to a smaller node */
    if (!at) return err_nomem(err, "a level of a gradient problem", (size_t)s->count * sizeof *at);
    for (int i = 0; i < s->count; i++) {
        g->excess[i] = (float)(s->excess[i] * (double)scale);
        for (int k = 0; k < 2; k++)
            if (s->next[i][k] >= 0) {
                g->begin[2 * i + 2]++;
                g->begin[2 * s->next[i][k] + 1]++;
            }
    }
    for (int i = 0; i < 2 * s->count; i++) g->begin[i + 1] += g->begin[i];
    for (int i = 0; i < s->count; i++) at[i] = g->begin[2 * i];
    for (int i = 0; i < s->count; i++)
        for (int k = 0, place = g->begin[2 * i + 1]; k < 2; k++) {
            const int j = s->next[i][k];
            if (j < 0) continue;
            const float weight = s->weight[i][k] * scale;
            g->link[place++] = (struct gradient_link){j, weight};
            g->link[at[j]++] = (struct gradient_link){i, weight};
        }
    free(at);
    sum_diagonal(g);
    return ST_OK;
}

static void groups_release(struct groups *g)
{
    free(g->first);
    free(g->last);
    free(g->next);
    free(g->group);
    free(g->merged);
    free(g->seen);
    free(g->inverse);
    free(g->between);
}

static enum status groups_allocate(struct groups *g, int count, struct err *err)
{
    const size_t n = (size_t)count + 1;
    g->first = malloc(n * sizeof *g->first);
    g->last = malloc(n * sizeof *g->last);
    g->next = malloc(n * sizeof *g->next);
    g->group = malloc(n * sizeof *g->group);
    g->merged = malloc(n * sizeof *g->merged);
    g->seen = malloc(n * sizeof *g->seen);
    g->inverse = malloc(n * sizeof *g->inverse);
    g->between = calloc(n, sizeof *g->between);
    if (g->first && g->last && g->next && g->group && g->merged && g->seen && g->inverse && g->between) return ST_OK;
    return err_nomem(err, "groups of a gradient problem", n * (6 * sizeof(int) + 2 * sizeof(float)));
}

/* The first pass: pairs of nodes. */
static void match_nodes(struct groups *g, const struct graph *l)
{
    enum { UNMATCHED = -2 };
    for (int i = 0; i < l->count; i++) {
        const float links = l->diagonal[i] - l->excess[i];
        g->group[i] = links > 0 && l->excess[i] <= DOMINANT * links ? UNMATCHED : -1;
        g->next[i] = -1;
    }
    for (int i = 0; i < l->count; i++) {
        if (g->group[i] != UNMATCHED) continue;
        float most = MIN_QUALITY;
        int best = -1;
        for (int e = l->begin[2 * i + 1]; e < l->begin[2 * i + 2]; e++) {
            const int j = l->link[e].to;
            const float q = l->link[e].weight * (1 / l->diagonal[i] + 1 / l->diagonal[j]);
            if (g->group[j] != UNMATCHED || !(q > most || (q == most && best < 0))) continue;
            most = q;
            best = j;
        }
        const int k = g->count++;
        g->group[i] = k;
        g->first[k] = g->last[k] = i;
        if (best >= 0) {
            g->group[best] = k;
            g->next[i] = g->last[k] = best;
        }
        g->inverse[k] = 1 / (l->diagonal[i] + (best >= 0 ? l->diagonal[best] : 0));
    }
}

/* The unmatched group after k with the largest q; -1: none. */
static int best_match(struct groups *g, const struct graph *l, int k)
{
    int seen = 0, best = -1;
    float most = MIN_QUALITY;
    for (int i = g->first[k]; i >= 0; i = g->next[i])
        for (int e = l->begin[2 * i]; e < l->begin[2 * i + 2]; e++) {
            const int h = g->group[l->link[e].to];
            if (h <= k || g->merged[h] >= 0) continue;
            if (!(g->between[h] > 0)) g->seen[seen++] = h;
            g->between[h] += l->link[e].weight;
        }
    for (int s = 0; s < seen; s++) {
        const int h = g->seen[s];
        const float q = g->between[h] * (g->inverse[k] + g->inverse[h]);
        if (q > most || (q == most && best < 0)) {
            most = q;
            best = h;
        }
        g->between[h] = 0;
    }
    return best;
}

/* A later pass: pairs of groups. */
static void match_groups(struct groups *g, const struct graph *l)
{
    int count = 0;
    for (int k = 0; k < g->count; k++) g->merged[k] = -1;
    for (int k = 0; k < g->count; k++) {
        if (g->merged[k] >= 0) continue;
        const int h = best_match(g, l, k);
        g->merged[k] = count;
        /* count <= k: the new groups' places are free */
        g->first[count] = g->first[k];
        g->last[count] = g->last[k];
        g->inverse[count] = g->inverse[k];
        if (h >= 0) {
            g->merged[h] = count;
            g->next[g->last[count]] = g->first[h];
            g->last[count] = g->last[h];
            g->inverse[count] = 1 / (1 / g->inverse[k] + 1 / g->inverse[h]);
        }
        count++;
    }
    g->count = count;
    for (int i = 0; i < l->count; i++)
        if (g->group[i] >= 0) g->group[i] = g->merged[g->group[i]];
}

static void sort_links(struct gradient_link *link, int begin, int end)
{
    for (int a = begin + 1; a < end; a++) {
        const struct gradient_link moved = link[a];
        int b = a;
        for (; b > begin && link[b - 1].to > moved.to; b--) link[b] = link[b - 1];
        link[b] = moved;
    }
}

/* Makes row k; place: where a group's link is, at or after the row's begin if it has one yet. */
static void gather(struct graph *to, const struct graph *l, const struct groups *g, int *place, int k)
{
    const int begin = to->begin[2 * k];
    int end = begin, smaller = 0;
    for (int i = g->first[k]; i >= 0; i = g->next[i]) {
        to->excess[k] += l->excess[i];
        for (int e = l->begin[2 * i]; e < l->begin[2 * i + 2]; e++) {
            const int h = g->group[l->link[e].to];
            const float weight = l->link[e].weight;
            if (h < 0)
                to->excess[k] += weight;
            else if (h != k && place[h] >= begin)
                to->link[place[h]].weight += weight;
            else if (h != k) {
                place[h] = end;
                to->link[end++] = (struct gradient_link){h, weight};
                smaller += h < k;
            }
        }
    }
    sort_links(to->link, begin, end);
    to->begin[2 * k + 1] = begin + smaller;
    to->begin[2 * k + 2] = end;
}

static enum status coarsen(struct graph *to, const struct graph *l, struct groups *g, struct err *err)
{
    if (graph_allocate(to, g->count, (size_t)l->begin[2 * l->count], err)) return err->status;
    for (int k = 0; k < g->count; k++) g->merged[k] = -1;
    for (int k = 0; k < g->count; k++) gather(to, l, g, g->merged, k);
    sum_diagonal(to);
    return ST_OK;
}

/* Eliminates the last level. */
static enum status eliminate(struct gradient_levels *levels, const struct graph *l, struct err *err)
{
    const size_t n = (size_t)l->count, most = GRADIENT_DENSE;
    double weight[GRADIENT_DENSE][GRADIENT_DENSE] = {{0}}, excess[GRADIENT_DENSE];
    levels->dense = calloc(most * most, sizeof *levels->dense);
    levels->inverse_pivot = calloc(most, sizeof *levels->inverse_pivot);
    if (!levels->dense || !levels->inverse_pivot) return err_nomem(err, "a dense matrix", most * most * sizeof(float));
    for (size_t i = 0; i < n; i++) {
        excess[i] = (double)l->excess[i];
        for (int e = l->begin[2 * i + 1]; e < l->begin[2 * i + 2]; e++)
            weight[i][l->link[e].to] = weight[l->link[e].to][i] = (double)l->link[e].weight;
    }
    for (size_t k = 0; k < n; k++) {
        double pivot = excess[k];
        for (size_t i = k + 1; i < n; i++) pivot += weight[k][i];
        if (!(pivot > 0)) continue; /* the last node of a part without excess: its value is free */
        levels->inverse_pivot[k] = (float)(1 / pivot);
        for (size_t i = k + 1; i < n; i++) {
            const double share = weight[k][i] / pivot;
            levels->dense[k * most + i] = (float)share;
            excess[i] += share * excess[k];
            for (size_t j = k + 1; j < n && share > 0; j++)
                if (j != i) weight[i][j] += share * weight[k][j];
        }
    }
    return ST_OK;
}

/* Gives l the links of row i, `width` on either side next to i; returns the number of the others. */
static int place_links(struct gradient_level *l, const struct graph *g, int i, int more)
{
    const int w = l->width, begin = g->begin[2 * i], split = g->begin[2 * i + 1], end = g->begin[2 * i + 2];
    int *to = l->to + 2 * (size_t)w * (size_t)i;
    float *weight = l->weight + 2 * (size_t)w * (size_t)i;
    for (int e = 0; e < w; e++) {
        const int smaller = split - w + e, larger = split + e;
        const struct gradient_link none = {i, 0};
        const struct gradient_link a = smaller >= begin ? g->link[smaller] : none;
        const struct gradient_link b = larger < end ? g->link[larger] : none;
        to[e] = a.to;
        weight[e] = a.weight;
        to[w + e] = b.to;
        weight[w + e] = b.weight;
    }
    if (!l->more) return 0;
    const int first = more;
    for (int e = begin; e < split - w; e++) l->more[more++] = g->link[e];
    l->more_begin[2 * i + 1] = more;
    for (int e = split + w; e < end; e++) l->more[more++] = g->link[e];
    l->more_begin[2 * i + 2] = more;
    return more - first;
}

static enum status level_init(struct gradient_level *l, const struct graph *g, int width, struct err *err)
{
    const size_t n = (size_t)g->count, places = 2 * (size_t)width * n + 1;
    size_t others = 0;
    for (int i = 0; i < g->count; i++) {
        const int smaller = g->begin[2 * i + 1] - g->begin[2 * i], larger = g->begin[2 * i + 2] - g->begin[2 * i + 1];
        others += (size_t)((smaller > width ? smaller - width : 0) + (larger > width ? larger - width : 0));
    }
    l->count = g->count;
    l->width = width;
    l->to = malloc(places * sizeof *l->to);
    l->weight = malloc(places * sizeof *l->weight);
    l->excess = malloc((n + 1) * sizeof *l->excess);
    l->inverse = malloc((n + 1) * sizeof *l->inverse);
    l->more_begin = others ? calloc(2 * n + 1, sizeof *l->more_begin) : NULL;
    l->more = others ? malloc(others * sizeof *l->more) : NULL;
    if (!l->to || !l->weight || !l->excess || !l->inverse || (others && !(l->more_begin && l->more)))
        return err_nomem(err, "a level of a gradient problem", places * (sizeof *l->to + sizeof *l->weight));
    for (int i = 0, more = 0; i < g->count; i++) {
        more += place_links(l, g, i, more);
        l->excess[i] = g->excess[i];
        l->inverse[i] = g->diagonal[i] > 0 ? 1 / g->diagonal[i] : 0;
    }
    return ST_OK;
}

/* Makes groups of l, and their graph. They are left out if they are nearly as many as the nodes: to stays empty. */
static enum status next_graph(struct graph *to, struct gradient_level *level, const struct graph *l, struct err *err)
{
    struct groups g = {0};
    enum status status = groups_allocate(&g, l->count, err);
    if (!status) {
        match_nodes(&g, l);
        match_groups(&g, l);
        if (5 * (size_t)g.count > 2 * (size_t)l->count) match_groups(&g, l);
        if (g.count > 0 && 10 * (size_t)g.count < 9 * (size_t)l->count) {
            status = coarsen(to, l, &g, err);
            for (int i = 0; i < l->count; i++)
                if (g.group[i] < 0) g.group[i] = g.count;
            level->group = g.group;
            g.group = NULL;
        }
    }
    groups_release(&g);
    return status;
}

/* Two steps on a level where they leave the work of a cycle bounded: each level at most 3/5 of the one before. */
static void choose_steps(struct gradient_levels *levels)
{
    double work = 1, bound = 1; /* over that of the finest level */
    for (int k = 1; k < levels->count; k++) {
        work *= (double)levels->level[k].count / levels->level[k - 1].count;
        bound *= 0.6;
        levels->level[k].twice = 2 * work <= bound;
        if (levels->level[k].twice) work *= 2;
    }
}

/* Brings the largest weight near 1. */
static float scale_of_weights(const struct gradient_system *s)
{
    double most = 0;
    int exponent;
    for (int i = 0; i < s->count; i++) {
        const double link = (double)(s->weight[i][0] > s->weight[i][1] ? s->weight[i][0] : s->weight[i][1]);
        most = s->excess[i] > most ? s->excess[i] : most;
        most = link > most ? link : most;
    }
    if (!(most > 0)) return 1;
    frexp(most, &exponent);
    return (float)ldexp(1, -exponent);
}

enum status gradient_levels_init(struct gradient_levels *levels, const struct gradient_system *s, struct err *err)
{
    levels->scale = scale_of_weights(s);
    struct graph g = {0}, next = {0};
    enum status status = finest(&g, s, levels->scale, err);
    while (!status) {
        struct gradient_level *l = &levels->level[levels->count];
        status = level_init(l, &g, levels->count ? GRADIENT_COARSE_WIDTH : GRADIENT_FINE_WIDTH, err);
        levels->count++;
        if (status || g.count <= GRADIENT_DENSE || levels->count == GRADIENT_MAX_LEVELS) break;
        status = next_graph(&next, l, &g, err);
        if (status || !next.count) break;
        graph_release(&g);
        g = next;
        next = (struct graph){0};
    }
    if (!status && g.count <= GRADIENT_DENSE) status = eliminate(levels, &g, err);
    graph_release(&g);
    graph_release(&next);
    if (status)
        gradient_levels_release(levels);
    else
        choose_steps(levels);
    return status;
}

void gradient_levels_release(struct gradient_levels *levels)
{
    for (int k = 0; k < levels->count; k++) {
        struct gradient_level *l = &levels->level[k];
        free(l->to);
        free(l->weight);
        free(l->more_begin);
        free(l->more);
        free(l->excess);
        free(l->inverse);
        free(l->group);
    }
    free(levels->dense);
    free(levels->inverse_pivot);
    *levels = (struct gradient_levels){0};
}
