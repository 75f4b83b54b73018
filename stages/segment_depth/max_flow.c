/* max_flow.c - minimum cut by augmenting paths between two search trees [Boykov 2004].
 *
 * A tree of residual arcs grows from each terminal. Three steps repeat until neither tree can grow:
 *   grow      active nodes take free neighbours into their tree, until an arc joins the two trees
 *   augment   the path through that arc carries its bottleneck; nodes whose parent arc is saturated become orphans
 *   adopt     an orphan looks for another parent in its tree; without one it becomes free, and its children orphans
 * A node's parent is the arc towards the root of its tree. Its distance to the root is valid if its timestamp is the
 * current time; adopting the nearest parent, and taking shorter ways while growing, keeps paths short (the source's
 * heuristics).
 *
 * What differs from the source: terminal arcs are one signed excess per node, since only their difference matters; and
 * capacities are integers, so that there is no rounding. */
#include "stages/segment_depth/max_flow.h"

#include <stdlib.h>

enum { NONE = -1, TERMINAL = -2, ORPHAN = -3 }; /* instead of a parent arc */

struct flow_node {
    int64_t excess; /* > 0: residual capacity from the source; < 0: to the sink */
    int64_t timestamp;
    int first, parent, next_active, distance; /* next_active: NONE outside the list, itself at the end */
    bool sink;
};

struct flow_arc { /* arc a's reverse is a ^ 1 */
    int to, next;
    int64_t residual;
};

enum status max_flow_begin(struct max_flow *f, int nodes, int edges, struct err *err)
{
    if (nodes > f->node_room) {
        free(f->nodes);
        f->node_room = 2 * nodes;
        if (!(f->nodes = malloc((size_t)f->node_room * sizeof *f->nodes))) {
            f->node_room = 0;
            return err_nomem(err, "a graph's nodes", (size_t)nodes * sizeof *f->nodes);
        }
    }
    if (2 * edges > f->arc_room) {
        free(f->arcs);
        f->arc_room = 4 * edges;
        if (!(f->arcs = malloc((size_t)f->arc_room * sizeof *f->arcs))) {
            f->arc_room = 0;
            return err_nomem(err, "a graph's arcs", (size_t)edges * 2 * sizeof *f->arcs);
        }
    }
    f->node_count = nodes;
    f->arc_count = 0;
    for (int i = 0; i < nodes; i++)
        f->nodes[i] = (struct flow_node){.first = NONE, .parent = NONE, .next_active = NONE};
    return ST_OK;
}

void max_flow_terminal(struct max_flow *f, int node, int64_t cost) { f->nodes[node].excess += cost; }

void max_flow_edge(struct max_flow *f, int from, int to, int64_t forward, int64_t backward)
{
    const int a = f->arc_count;
    f->arcs[a] = (struct flow_arc){to, f->nodes[from].first, forward};
    f->arcs[a + 1] = (struct flow_arc){from, f->nodes[to].first, backward};
    f->nodes[from].first = a;
    f->nodes[to].first = a + 1;
    f->arc_count += 2;
}

static void activate(struct max_flow *f, int i)
{
    if (f->nodes[i].next_active != NONE) return;
    if (f->last_active == NONE)
        f->first_active = i;
    else
        f->nodes[f->last_active].next_active = i;
    f->last_active = i;
    f->nodes[i].next_active = i;
}

/* Takes the first active node that still belongs to a tree from the list; NONE if there is none. */
static int next_active(struct max_flow *f)
{
    while (f->first_active != NONE) {
        const int i = f->first_active;
        const bool last = f->nodes[i].next_active == i;
        f->first_active = last ? NONE : f->nodes[i].next_active;
        if (last) f->last_active = NONE;
        f->nodes[i].next_active = NONE;
        if (f->nodes[i].parent != NONE) return i;
    }
    return NONE;
}

static enum status make_orphan(struct max_flow *f, int i, struct err *err)
{
    if (f->orphan_count == f->orphan_room) {
        const int room = 2 * f->orphan_room + 64;
        int *more = realloc(f->orphans, (size_t)room * sizeof *more);
        if (!more) return err_nomem(err, "a graph's orphans", (size_t)room * sizeof *more);
        f->orphans = more;
        f->orphan_room = room;
    }
    f->nodes[i].parent = ORPHAN;
    f->orphans[f->orphan_count++] = i;
    return ST_OK;
}

/* Residual capacity of a tree arc in the direction of flow: from parent to child in the source's tree, from child to
 * parent in the sink's. */
static inline int64_t tree_residual(const struct max_flow *f, int arc_to_parent, bool sink)
{
    return f->arcs[sink ? arc_to_parent : arc_to_parent ^ 1].residual;
}

static enum status augment(struct max_flow *f, int bridge, struct err *err)
{
    /* the bridge runs from the source's tree to the sink's */
    const int ends[2] = {f->arcs[bridge ^ 1].to, f->arcs[bridge].to};
    int64_t bottleneck = f->arcs[bridge].residual;
    for (int side = 0; side < 2; side++) {
        int i = ends[side];
        for (int a; (a = f->nodes[i].parent) != TERMINAL; i = f->arcs[a].to) {
            const int64_t r = tree_residual(f, a, side);
            if (r < bottleneck) bottleneck = r;
        }
        const int64_t r = side ? -f->nodes[i].excess : f->nodes[i].excess;
        if (r < bottleneck) bottleneck = r;
    }
    f->arcs[bridge].residual -= bottleneck;
    f->arcs[bridge ^ 1].residual += bottleneck;
    for (int side = 0; side < 2; side++) {
        int i = ends[side];
        for (int a; (a = f->nodes[i].parent) != TERMINAL;) {
            const int down = side ? a : a ^ 1;
            f->arcs[down].residual -= bottleneck;
            f->arcs[down ^ 1].residual += bottleneck;
            const int up = f->arcs[a].to;
            if (f->arcs[down].residual == 0 && !err->status) make_orphan(f, i, err);
            i = up;
        }
        f->nodes[i].excess += side ? bottleneck : -bottleneck;
        if (f->nodes[i].excess == 0 && !err->status) make_orphan(f, i, err);
    }
    return err->status;
}

/* Arcs from a node to its tree's root; -1 if the path ends at an orphan. Updates the nodes on the path. */
static int distance_to_root(struct max_flow *f, int start)
{
    int steps = 0, i = start;
    for (;;) {
        struct flow_node *n = &f->nodes[i];
        if (n->timestamp == f->time) {
            steps += n->distance;
            break;
        }
        if (n->parent == ORPHAN) return -1;
        steps++;
        if (n->parent == TERMINAL) {
            n->timestamp = f->time;
            n->distance = 1;
            break;
        }
        i = f->arcs[n->parent].to;
    }
    int left = steps;
    for (i = start; f->nodes[i].timestamp != f->time; i = f->arcs[f->nodes[i].parent].to) {
        f->nodes[i].timestamp = f->time;
        f->nodes[i].distance = left--;
    }
    return steps;
}

static enum status adopt(struct max_flow *f, int i, struct err *err)
{
    struct flow_node *n = &f->nodes[i];
    const bool sink = n->sink;
    int best = NONE, nearest = 0;
    for (int a = n->first; a != NONE; a = f->arcs[a].next) {
        const int j = f->arcs[a].to;
        if (!(tree_residual(f, a, sink) > 0) || f->nodes[j].sink != sink || f->nodes[j].parent == NONE) continue;
        const int d = distance_to_root(f, j);
        if (d >= 0 && (best == NONE || d < nearest)) {
            best = a;
            nearest = d;
        }
    }
    if (best != NONE) {
        n->parent = best;
        n->timestamp = f->time;
        n->distance = nearest + 1;
        return ST_OK;
    }
    n->parent = NONE;
    for (int a = n->first; a != NONE; a = f->arcs[a].next) {
        const int j = f->arcs[a].to;
        struct flow_node *m = &f->nodes[j];
        if (m->sink != sink || m->parent == NONE) continue;
        if (tree_residual(f, a, sink) > 0) activate(f, j);
        if (m->parent >= 0 && f->arcs[m->parent].to == i && !err->status) make_orphan(f, j, err);
    }
    return err->status;
}

/* Adds an active node's free neighbours to its tree. Returns an arc from the source's tree to the sink's, or NONE. */
static int grow(struct max_flow *f, int i)
{
    struct flow_node *n = &f->nodes[i];
    for (int a = n->first; a != NONE; a = f->arcs[a].next) {
        if (!(f->arcs[n->sink ? a ^ 1 : a].residual > 0)) continue;
        const int j = f->arcs[a].to;
        struct flow_node *m = &f->nodes[j];
        if (m->parent == NONE) {
            m->sink = n->sink;
            m->parent = a ^ 1;
            m->timestamp = n->timestamp;
            m->distance = n->distance + 1;
            activate(f, j);
        } else if (m->sink != n->sink) {
            return n->sink ? a ^ 1 : a;
        } else if (m->timestamp <= n->timestamp && m->distance > n->distance) {
            m->parent = a ^ 1; /* a shorter path to the root */
            m->timestamp = n->timestamp;
            m->distance = n->distance + 1;
        }
    }
    return NONE;
}

enum status max_flow_solve(struct max_flow *f, struct err *err)
{
    f->first_active = f->last_active = NONE;
    f->orphan_count = 0;
    f->time = 0;
    for (int i = 0; i < f->node_count; i++) {
        struct flow_node *n = &f->nodes[i];
        if (n->excess == 0) continue;
        n->sink = n->excess < 0;
        n->parent = TERMINAL;
        n->distance = 1;
        activate(f, i);
    }
    int current = NONE;
    for (;;) {
        if (current == NONE || f->nodes[current].parent == NONE) current = next_active(f);
        if (current == NONE) return ST_OK;
        const int bridge = grow(f, current);
        f->time++;
        if (bridge == NONE) {
            current = NONE;
            continue;
        }
        /* the same node may find more paths */
        augment(f, bridge, err);
        while (!err->status && f->orphan_count > 0) adopt(f, f->orphans[--f->orphan_count], err);
        if (err->status) return err->status;
    }
}

bool max_flow_on_sink_side(const struct max_flow *f, int node)
{
    return f->nodes[node].parent != NONE && f->nodes[node].sink;
}

void max_flow_release(struct max_flow *f)
{
    if (!f) return;
    free(f->nodes);
    free(f->arcs);
    free(f->orphans);
    *f = (struct max_flow){0};
}
