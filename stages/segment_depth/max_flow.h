/* max_flow.h - minimum cut of a small graph, for binary labellings.
 *
 * Capacities are integers, so that the solver terminates and the cut depends on nothing but the graph. One struct
 * serves many graphs: its arrays grow and are reused. Method: max_flow.c. */
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
    int *orphans; /* stack of nodes that lost their path to a terminal */
    int node_count, arc_count, node_room, arc_room, orphan_room;
    int first_active, last_active, orphan_count;
    int64_t time;
};

/* Starts a graph of `nodes` nodes, with room for `edges` edges of two arcs each. */
enum status max_flow_begin(struct max_flow *f, int nodes, int edges, struct err *err);
/* Adds a terminal arc: cost >= 0 is paid if the node is on the sink's side, -cost (cost < 0) if it is on the
 * source's. */
void max_flow_terminal(struct max_flow *f, int node, int64_t cost);
/* Adds an edge: `forward` is paid if `from` is on the source's side and `to` on the sink's, `backward` if it is the
 * reverse; both >= 0. */
void max_flow_edge(struct max_flow *f, int from, int to, int64_t forward, int64_t backward);
/* Finds the minimum cut of the graph. ST_NOMEM. */
enum status max_flow_solve(struct max_flow *f, struct err *err);
/* The node's side of the minimum cut; if there are several, of the one with the fewest nodes on the sink's side. */
bool max_flow_on_sink_side(const struct max_flow *f, int node);
void max_flow_release(struct max_flow *f);

#endif
