/* max_flow.c - minimum cuts of small graphs against all cuts, and of larger ones against plain augmenting paths. */
#include "stages/segment_depth/max_flow.h"

#include "tests/unit/segment_depth/scene.h"

enum { MAX_NODES = 1200, MAX_EDGES = 6000 };

struct edge {
    int from, to;
    int64_t forward, backward;
};

struct graph {
    int nodes, edges;
    int64_t terminal[MAX_NODES]; /* as max_flow_terminal() takes it */
    struct edge edge[MAX_EDGES];
};

static struct graph g; /* large */

static int64_t draw(int i, int seed, int kind, int max) { return (int64_t)(scene_hash(i, seed, kind) * (max + 1)); }

static void add_edge(int from, int to, int64_t forward, int64_t backward)
{
    assert_true(g.edges < MAX_EDGES);
    g.edge[g.edges++] = (struct edge){from, to, forward, backward};
}

/* A small `max_cost` makes ties; there are zeros and multiple edges. */
static void draw_graph(int nodes, int edges, int max_cost, int seed)
{
    g.nodes = nodes;
    g.edges = 0;
    for (int i = 0; i < nodes; i++) g.terminal[i] = draw(i, seed, 0, 2 * max_cost) - max_cost;
    for (int e = 0; e < edges; e++) {
        const int from = (int)(nodes * scene_hash(e, seed, 1)), step = 1 + (int)((nodes - 1) * scene_hash(e, seed, 2));
        add_edge(from, (from + step) % nodes, draw(e, seed, 3, max_cost), e % 3 ? draw(e, seed, 4, max_cost) : 0);
    }
}

/* A grid with random costs and ties; nodes in rows. */
static void draw_grid(int width, int height, int max_cost, int seed)
{
    g.nodes = width * height;
    g.edges = 0;
    assert_true(g.nodes <= MAX_NODES);
    for (int i = 0; i < g.nodes; i++) {
        g.terminal[i] = draw(i, seed, 0, 2 * max_cost) - max_cost;
        if (i % width + 1 < width) add_edge(i, i + 1, draw(i, seed, 1, max_cost), draw(i, seed, 2, max_cost));
        if (i + width < g.nodes) add_edge(i, i + width, draw(i, seed, 3, max_cost), draw(i, seed, 4, max_cost));
    }
}

/* The cost of a cut: sink[i] as max_flow_on_sink_side(). */
static int64_t cost_of(const bool *sink)
{
    int64_t sum = 0;
    for (int i = 0; i < g.nodes; i++) {
        if (sink[i] && g.terminal[i] > 0) sum += g.terminal[i];
        if (!sink[i] && g.terminal[i] < 0) sum -= g.terminal[i];
    }
    for (int e = 0; e < g.edges; e++) {
        const bool from = sink[g.edge[e].from], to = sink[g.edge[e].to];
        if (!from && to) sum += g.edge[e].forward;
        if (from && !to) sum += g.edge[e].backward;
    }
    return sum;
}

static void solve(struct max_flow *f, bool *sink)
{
    struct err err = ERR_INIT;
    assert_int_equal(max_flow_begin(f, g.nodes, g.edges, &err), ST_OK);
    for (int i = 0; i < g.nodes; i++) {
        /* terminal costs in two parts, some before and some after the edges */
        max_flow_terminal(f, i, g.terminal[i] - 5);
        if (i % 2) max_flow_terminal(f, i, 5);
    }
    for (int e = 0; e < g.edges; e++)
        max_flow_edge(f, g.edge[e].from, g.edge[e].to, g.edge[e].forward, g.edge[e].backward);
    for (int i = 0; i < g.nodes; i += 2) max_flow_terminal(f, i, 5);
    assert_int_equal(max_flow_solve(f, &err), ST_OK);
    for (int i = 0; i < g.nodes; i++) sink[i] = max_flow_on_sink_side(f, i);
}

static void cuts_of_small_graphs_are_minimal(void **state)
{
    (void)state;
    struct max_flow f = {0}; /* one for all graphs */
    for (int seed = 0; seed < 3000; seed++) {
        const int nodes = 1 + seed % 9, edges = nodes > 1 ? seed / 9 % 20 : 0, max_cost = seed % 5 ? 3 : 1000000;
        bool sink[16], all[16], smallest_side[16];
        draw_graph(nodes, edges, max_cost, seed);
        solve(&f, sink);
        int64_t best = INT64_MAX;
        for (int cut = 0; cut < 1 << nodes; cut++) {
            for (int i = 0; i < nodes; i++) all[i] = cut >> i & 1;
            const int64_t cost = cost_of(all);
            if (cost < best) memcpy(smallest_side, all, sizeof all);
            /* the nodes on the sink's side in all minimum cuts */
            for (int i = 0; i < nodes && cost == best; i++) smallest_side[i] = smallest_side[i] && all[i];
            best = cost < best ? cost : best;
        }
        assert_int_equal(cost_of(sink), best);
        assert_int_equal(cost_of(smallest_side), best);
        for (int i = 0; i < nodes; i++) assert_int_equal(sink[i], smallest_side[i]);
    }
    max_flow_release(&f);
}

/* Shortest augmenting paths by breadth-first search; the source is node `nodes`, the sink `nodes + 1`. */
struct plain {
    int first[MAX_NODES + 2], next[2 * (MAX_EDGES + MAX_NODES)], to[2 * (MAX_EDGES + MAX_NODES)], arcs;
    int64_t room[2 * (MAX_EDGES + MAX_NODES)];
    int queue[MAX_NODES + 2], came_by[MAX_NODES + 2];
};

static void plain_arc(struct plain *p, int from, int to, int64_t forward, int64_t backward)
{
    for (int k = 0; k < 2; k++) {
        p->to[p->arcs] = k ? from : to;
        p->room[p->arcs] = k ? backward : forward;
        p->next[p->arcs] = p->first[k ? to : from];
        p->first[k ? to : from] = p->arcs++;
    }
}

static int64_t plain_flow(void)
{
    static struct plain p;
    const int source = g.nodes, sink = g.nodes + 1;
    int64_t flow = 0;
    p.arcs = 0;
    for (int i = 0; i < g.nodes + 2; i++) p.first[i] = -1;
    for (int i = 0; i < g.nodes; i++)
        if (g.terminal[i] > 0)
            plain_arc(&p, source, i, g.terminal[i], 0);
        else
            plain_arc(&p, i, sink, -g.terminal[i], 0);
    for (int e = 0; e < g.edges; e++)
        plain_arc(&p, g.edge[e].from, g.edge[e].to, g.edge[e].forward, g.edge[e].backward);
    for (;;) {
        int begin = 0, end = 0;
        for (int i = 0; i < g.nodes + 2; i++) p.came_by[i] = -1;
        p.came_by[source] = -2;
        p.queue[end++] = source;
        while (begin < end && p.came_by[sink] == -1)
            for (int i = p.queue[begin++], a = p.first[i]; a >= 0; a = p.next[a])
                if (p.room[a] > 0 && p.came_by[p.to[a]] == -1) {
                    p.came_by[p.to[a]] = a;
                    p.queue[end++] = p.to[a];
                }
        if (p.came_by[sink] == -1) return flow;
        int64_t bottleneck = INT64_MAX;
        for (int i = sink; i != source; i = p.to[p.came_by[i] ^ 1])
            bottleneck = p.room[p.came_by[i]] < bottleneck ? p.room[p.came_by[i]] : bottleneck;
        for (int i = sink; i != source; i = p.to[p.came_by[i] ^ 1]) {
            p.room[p.came_by[i]] -= bottleneck;
            p.room[p.came_by[i] ^ 1] += bottleneck;
        }
        flow += bottleneck;
    }
}

static void cuts_of_grids_match_plain_augmenting_paths(void **state)
{
    (void)state;
    static bool sink[MAX_NODES];
    struct max_flow f = {0};
    for (int seed = 0; seed < 12; seed++) {
        static const int sizes[][2] = {{30, 40}, {3, 200}, {600, 1}, {20, 20}};
        draw_grid(sizes[seed % 4][0], sizes[seed % 4][1], seed < 8 ? 1000 : 4, seed);
        solve(&f, sink);
        assert_true(cost_of(sink) == plain_flow());
    }
    max_flow_release(&f);
}

/* The smallest sink side does not depend on the order in which a graph is given. */
static void the_order_of_edges_does_not_change_the_cut(void **state)
{
    (void)state;
    static bool sink[2][MAX_NODES];
    struct max_flow f = {0};
    for (int seed = 0; seed < 20; seed++) {
        draw_grid(25, 20, 3, seed); /* many ties */
        solve(&f, sink[0]);
        for (int e = 0; e < g.edges / 2; e++) {
            const struct edge swap = g.edge[e];
            g.edge[e] = g.edge[g.edges - 1 - e];
            g.edge[g.edges - 1 - e] = swap;
        }
        solve(&f, sink[1]);
        assert_memory_equal(sink[0], sink[1], (size_t)g.nodes * sizeof sink[0][0]);
    }
    max_flow_release(&f);
}

static void a_solver_is_reused_for_graphs_of_any_size(void **state)
{
    (void)state;
    static bool sink[2][MAX_NODES];
    static const int sizes[][2] = {{30, 30}, {1, 1}, {40, 30}, {2, 1}, {5, 5}, {40, 30}, {0, 0}, {3, 3}};
    struct max_flow f = {0};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct max_flow fresh = {0};
        draw_grid(sizes[i][0], sizes[i][1], 50, (int)i);
        solve(&f, sink[0]);
        solve(&fresh, sink[1]);
        assert_memory_equal(sink[0], sink[1], (size_t)g.nodes * sizeof sink[0][0]);
        max_flow_release(&fresh);
    }
    max_flow_release(&f);
    max_flow_release(&f);
    max_flow_release(NULL);
}

static void without_costs_all_nodes_are_on_the_sources_side(void **state)
{
    (void)state;
    bool sink[4];
    struct max_flow f = {0};
    g = (struct graph){.nodes = 4};
    solve(&f, sink);
    for (int i = 0; i < 4; i++) assert_false(sink[i]);
    g.terminal[2] = -1; /* cheaper on the sink's side, but held by the source through an uncuttable edge */
    g.terminal[0] = INT64_C(1) << 50;
    add_edge(0, 2, INT64_C(1) << 50, 0);
    solve(&f, sink);
    for (int i = 0; i < 4; i++) assert_false(sink[i]);
    g.edge[0].forward = 0;
    solve(&f, sink);
    for (int i = 0; i < 4; i++) assert_int_equal(sink[i], i == 2);
    max_flow_release(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cuts_of_small_graphs_are_minimal),
        cmocka_unit_test(cuts_of_grids_match_plain_augmenting_paths),
        cmocka_unit_test(the_order_of_edges_does_not_change_the_cut),
        cmocka_unit_test(a_solver_is_reused_for_graphs_of_any_size),
        cmocka_unit_test(without_costs_all_nodes_are_on_the_sources_side),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
