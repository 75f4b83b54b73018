/* max_flow.h - the least cut of a small graph, for binary choices among neighbours.
 *
 * Augmenting paths between two search trees that are kept from path to path (Y. Boykov, V. Kolmogorov, "An Experimental
 * Comparison of Min-Cut/Max-Flow Algorithms", 2004). Capacities are integers, so it ends, and the cut does not depend on
 * anything but the graph. One struct serves many graphs: its arrays grow and are used again. */
#ifndef REMODEL_MAX_FLOW_H
#define REMODEL_MAX_FLOW_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/err.h"

struct flow_node;
struct flow_arc;

struct max_flow {
    struct flow_node *nodes;
    struct flow_arc *arcs;
    int *orphans; /* scratch of nodes that lost their way to a terminal */
    int node_count, arc_count, node_room, arc_room, orphan_room;
    int first_active, last_active, orphan_count;
    int64_t time;
};

/* An empty graph of that many nodes; room for that many edges (of two arcs). */
enum status max_flow_begin(struct max_flow *f, int nodes, int edges, struct err *err);
/* Adds what it costs that the node is cut from the source (>= 0), or from the sink (< 0: -cost). */
void max_flow_terminal(struct max_flow *f, int node, int64_t cost);
/* What it costs that `from` is on the source's side and `to` on the sink's, and the other way round; both >= 0. */
void max_flow_edge(struct max_flow *f, int from, int to, int64_t forward, int64_t backward);
enum status max_flow_solve(struct max_flow *f, struct err *err);
/* Of several least cuts the one with the fewest nodes on the sink's side. */
bool max_flow_on_sink_side(const struct max_flow *f, int node);
void max_flow_release(struct max_flow *f);

#endif
