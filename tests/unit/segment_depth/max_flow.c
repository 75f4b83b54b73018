/* max_flow.c - least cuts of small graphs against every cut there is, and of larger ones against plain augmenting paths. */
#include "stages/segment_depth/max_flow.h"

#include "tests/unit/segment_depth/scene.h"

enum { MOST_NODES = 1200, MOST_EDGES = 6000 };

struct edge {
    int from, to;
    int64_t forward, backward;
};

struct graph {
    int nodes, edges;
    int64_t terminal[MOST_NODES]; /* as max_flow_terminal() takes it */
    struct edge edge[MOST_EDGES];
};

static struct graph g; /* large */

static int64_t draw(int i, int seed, int kind, int most) { return (int64_t)(scene_hash(i, seed, kind) * (most + 1)); }

static void add_edge(int from, int to, int64_t forward, int64_t backward)
{
    assert_true(g.edges < MOST_EDGES);
    g.edge[g.edges++] = (struct edge){from, to, forward, backward};
}

/* Few and small numbers make ties; zeros and edges between the same two nodes are among them. */
static void draw_graph(int nodes, int edges, int most, int seed)
{
    g.nodes = nodes;
    g.edges = 0;
    for (int i = 0; i < nodes; i++) g.terminal[i] = draw(i, seed, 0, 2 * most) - most;
    for (int e = 0; e < edges; e++) {
        const int from = (int)(nodes * scene_hash(e, seed, 1)), step = 1 + (int)((nodes - 1) * scene_hash(e, seed, 2));
        add_edge(from, (from + step) % nodes, draw(e, seed, 3, most), e % 3 ? draw(e, seed, 4, most) : 0);
    }
}

/* A grid with random costs, ties among them; nodes in rows. */
static void draw_grid(int width, int height, int most, int seed)
{
    g.nodes = width * height;
    g.edges = 0;
    assert_true(g.nodes <= MOST_NODES);
    for (int i = 0; i < g.nodes; i++) {
        g.terminal[i] = draw(i, seed, 0, 2 * most) - most;
        if (i % width + 1 < width) add_edge(i, i + 1, draw(i, seed, 1, most), draw(i, seed, 2, most));
        if (i + width < g.nodes) add_edge(i, i + width, draw(i, seed, 3, most), draw(i, seed, 4, most));
    }
}

/* What a choice of sides costs: sink[i] as max_flow_on_sink_side(). */
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
        /* in two parts, and some before the edges and some after them */
        max_flow_terminal(f, i, g.terminal[i] - 5);
        if (i % 2) max_flow_terminal(f, i, 5);
    }
    for (int e = 0; e < g.edges; e++)
        max_flow_edge(f, g.edge[e].from, g.edge[e].to, g.edge[e].forward, g.edge[e].backward);
    for (int i = 0; i < g.nodes; i += 2) max_flow_terminal(f, i, 5);
    assert_int_equal(max_flow_solve(f, &err), ST_OK);
    for (int i = 0; i < g.nodes; i++) sink[i] = max_flow_on_sink_side(f, i);
}

static void small_graphs_are_cut_as_cheaply_as_can_be(void **state)
{
    (void)state;
    struct max_flow f = {0}; /* one for all of them */
    for (int seed = 0; seed < 3000; seed++) {
        const int nodes = 1 + seed % 9, edges = nodes > 1 ? seed / 9 % 20 : 0, most = seed % 5 ? 3 : 1000000;
        bool sink[16], all[16], least_side[16];
        draw_graph(nodes, edges, most, seed);
        solve(&f, sink);
        int64_t best = INT64_MAX;
        for (int cut = 0; cut < 1 << nodes; cut++) {
            for (int i = 0; i < nodes; i++) all[i] = cut >> i & 1;
            const int64_t cost = cost_of(all);
            if (cost < best) memcpy(least_side, all, sizeof all);
            /* of equally cheap cuts, the nodes that are on the sink's side in every one */
            for (int i = 0; i < nodes && cost == best; i++) least_side[i] = least_side[i] && all[i];
            best = cost < best ? cost : best;
        }
        assert_int_equal(cost_of(sink), best);
        assert_int_equal(cost_of(least_side), best);
        for (int i = 0; i < nodes; i++) assert_int_equal(sink[i], least_side[i]);
    }
    max_flow_release(&f);
}

/* Shortest augmenting paths by breadth-first search, on a list of arcs: source is node `nodes`, sink the one after it. */
struct plain {
    int first[MOST_NODES + 2], next[2 * (MOST_EDGES + MOST_NODES)], to[2 * (MOST_EDGES + MOST_NODES)], arcs;
    int64_t room[2 * (MOST_EDGES + MOST_NODES)];
    int queue[MOST_NODES + 2], came_by[MOST_NODES + 2];
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
        int64_t least = INT64_MAX;
        for (int i = sink; i != source; i = p.to[p.came_by[i] ^ 1])
            least = p.room[p.came_by[i]] < least ? p.room[p.came_by[i]] : least;
        for (int i = sink; i != source; i = p.to[p.came_by[i] ^ 1]) {
            p.room[p.came_by[i]] -= least;
            p.room[p.came_by[i] ^ 1] += least;
        }
        flow += least;
    }
}

static void larger_grids_are_cut_as_plain_augmenting_paths_cut_them(void **state)
{
    (void)state;
    static bool sink[MOST_NODES];
    struct max_flow f = {0};
    for (int seed = 0; seed < 12; seed++) {
        static const int sizes[][2] = {{30, 40}, {3, 200}, {600, 1}, {20, 20}};
        draw_grid(sizes[seed % 4][0], sizes[seed % 4][1], seed < 8 ? 1000 : 4, seed);
        solve(&f, sink);
        assert_true(cost_of(sink) == plain_flow());
    }
    max_flow_release(&f);
}

/* The least sink side does not hang on the order in which a graph is given. */
static void the_order_of_edges_does_not_change_the_cut(void **state)
{
    (void)state;
    static bool sink[2][MOST_NODES];
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

static void one_struct_serves_graphs_of_any_size_in_any_order(void **state)
{
    (void)state;
    static bool sink[2][MOST_NODES];
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

static void a_graph_without_costs_keeps_all_on_the_sources_side(void **state)
{
    (void)state;
    bool sink[4];
    struct max_flow f = {0};
    g = (struct graph){.nodes = 4};
    solve(&f, sink);
    for (int i = 0; i < 4; i++) assert_false(sink[i]);
    g.terminal[2] = -1; /* the sink's in part: but held by the source through an edge that cannot be cut */
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
        cmocka_unit_test(small_graphs_are_cut_as_cheaply_as_can_be),
        cmocka_unit_test(larger_grids_are_cut_as_plain_augmenting_paths_cut_them),
        cmocka_unit_test(the_order_of_edges_does_not_change_the_cut),
        cmocka_unit_test(one_struct_serves_graphs_of_any_size_in_any_order),
        cmocka_unit_test(a_graph_without_costs_keeps_all_on_the_sources_side),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
