/* min_cut.c - maximum flow along shortest paths, level by level [Dinic 1970].
 *
 * Breadth-first search from the source numbers the nodes by level; augmenting paths climb one level per arc, and each
 * node remembers which of its arcs are used up. When the sink is reached no more, the nodes that are reached are the
 * source's side. Paths are followed with a stack of their own, as they may be long. Capacities below EPSILON count as
 * used up, so that rounding cannot make paths without end. */
#include "stages/suggest_model/min_cut.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"

static const double EPSILON = 1e-9;

enum status cut_graph_init(struct cut_graph *g, int nodes, struct err *err)
{
    const size_t count = (size_t)nodes + 2;
    *g = (struct cut_graph){.node_count = nodes + 2};
    g->first = malloc(count * sizeof *g->first);
    g->level = malloc(count * sizeof *g->level);
    g->queue = malloc(count * sizeof *g->queue);
    g->at = malloc(count * sizeof *g->at);
    if (!g->first || !g->level || !g->queue || !g->at) {
        cut_graph_release(g);
        return err_nomem(err, "a graph", 4 * count * sizeof *g->first);
    }
    for (int i = 0; i < g->node_count; i++) g->first[i] = -1;
    return ST_OK;
}

void cut_graph_release(struct cut_graph *g)
{
    if (!g) return;
    free(g->arcs);
    free(g->first);
    free(g->level);
    free(g->queue);
    free(g->at);
    *g = (struct cut_graph){0};
}

enum status cut_graph_pair(struct cut_graph *g, int a, int b, double cost, double opposite, struct err *err)
{
    for (int k = 0; k < 2; k++) {
        if (array_append(&g->arcs, (size_t)g->arc_count, sizeof *g->arcs, "arcs of a graph", err)) return err->status;
        const int from = k ? b : a;
        g->arcs[g->arc_count] = (struct cut_arc){k ? a : b, g->first[from], k ? opposite : cost};
        g->first[from] = g->arc_count++;
    }
    return ST_OK;
}

enum status cut_graph_node(struct cut_graph *g, int node, double cost_source, double cost_sink, struct err *err)
{
    const double both = fmin(cost_source, cost_sink); /* is paid anyway */
    if (cost_sink > both) return cut_graph_pair(g, g->node_count - 2, node, cost_sink - both, 0, err);
    return cost_source > both ? cut_graph_pair(g, node, g->node_count - 1, cost_source - both, 0, err) : ST_OK;
}

static bool number_levels(struct cut_graph *g)
{
    const int source = g->node_count - 2;
    int head = 0, tail = 0;
    for (int i = 0; i < g->node_count; i++) g->level[i] = -1;
    g->level[source] = 0;
    g->queue[tail++] = source;
    while (head < tail) {
        const int node = g->queue[head++];
        for (int a = g->first[node]; a >= 0; a = g->arcs[a].next) {
            const int to = g->arcs[a].to;
            if (g->arcs[a].left <= EPSILON || g->level[to] >= 0) continue;
            g->level[to] = g->level[node] + 1;
            g->queue[tail++] = to;
        }
    }
    return g->level[g->node_count - 1] >= 0;
}

/* Sends flow along one path; false: there is none. The queue holds the path's arcs. */
static bool augment(struct cut_graph *g)
{
    const int source = g->node_count - 2, sink = g->node_count - 1;
    int node = source, length = 0;
    while (node != sink) {
        int a = g->at[node];
        while (a >= 0 && (g->arcs[a].left <= EPSILON || g->level[g->arcs[a].to] != g->level[node] + 1))
            a = g->arcs[a].next;
        g->at[node] = a;
        if (a >= 0) {
            g->queue[length++] = a;
            node = g->arcs[a].to;
        } else if (length) { /* a dead end: back, and not here again */
            g->level[node] = -1;
            node = g->arcs[g->queue[--length] ^ 1].to;
        } else
            return false;
    }
    double flow = HUGE_VAL;
    for (int i = 0; i < length; i++) flow = fmin(flow, g->arcs[g->queue[i]].left);
    for (int i = 0; i < length; i++) {
        g->arcs[g->queue[i]].left -= flow;
        g->arcs[g->queue[i] ^ 1].left += flow;
    }
    return true;
}

void cut_graph_solve(struct cut_graph *g, bool *source)
{
    while (number_levels(g)) {
        for (int i = 0; i < g->node_count; i++) g->at[i] = g->first[i];
        while (augment(g)) continue;
    }
    for (int i = 0; i < g->node_count - 2; i++) source[i] = g->level[i] >= 0;
}
