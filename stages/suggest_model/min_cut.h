/* min_cut.h - the minimum cut of a small graph. */
#ifndef REMODEL_MIN_CUT_H
#define REMODEL_MIN_CUT_H

#include <stdbool.h>

#include "common/base/err.h"

/* {0} is the empty graph. Capacities are >= 0. */
struct cut_arc {
    int to, next; /* next: arc of the same node, -1 none; arc a ^ 1 is the reverse of arc a */
    double left;  /* capacity that is left */
};
struct cut_graph {
    struct cut_arc *arcs; /* owned */
    int arc_count;
    int *first, *level, *queue, *at; /* owned; of nodes */
    int node_count;                  /* the last two are source and sink */
};

/* nodes: without source and sink. The caller releases the graph. */
enum status cut_graph_init(struct cut_graph *g, int nodes, struct err *err);
void cut_graph_release(struct cut_graph *g);

/* Costs of a node that is on the source's side, or on the sink's. */
enum status cut_graph_node(struct cut_graph *g, int node, double cost_source, double cost_sink, struct err *err);
/* Cost of a on the source's side and b on the sink's; and of the opposite. */
enum status cut_graph_pair(struct cut_graph *g, int a, int b, double cost, double opposite, struct err *err);

/* source[i] is set where node i is on the source's side. */
void cut_graph_solve(struct cut_graph *g, bool *source);

#endif
