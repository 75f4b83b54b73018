/* smooth.c - labels of small graphs against every labelling there is. */
#include "stages/segment_depth/smooth.h"

#include "tests/unit/segment_depth/scene.h"

enum { MOST_NODES = 40, MOST_EDGES = 90, MOST_LABELS = 24 };

struct graph {
    struct segmentation s;
    int first_border[MOST_NODES + 1], ends[MOST_EDGES][2];
    struct border borders[2 * MOST_EDGES];
    struct segment segments[MOST_NODES];
    float weights[2 * MOST_EDGES], cost[MOST_NODES * MOST_LABELS];
    int labels;
    float slope, most;
};

static void add_edge(struct graph *g, int a, int b)
{
    g->ends[g->s.edge_count][0] = a < b ? a : b;
    g->ends[g->s.edge_count++][1] = a < b ? b : a;
    assert_true(g->s.edge_count <= MOST_EDGES);
}

/* Lists the touches; weights and costs are drawn from `seed`, multiples of 1 and 1/4 if there are to be ties. */
static void finish(struct graph *g, int nodes, int labels, int seed, bool ties)
{
    int n = 0;
    g->s.count = nodes;
    g->labels = labels;
    g->s.first_border = g->first_border;
    g->s.borders = g->borders;
    g->s.segments = g->segments;
    for (int i = 0; i < nodes; i++) {
        g->first_border[i] = n;
        for (int other = 0; other < nodes; other++)
            for (int e = 0; e < g->s.edge_count; e++) {
                if (g->ends[e][0] != (i < other ? i : other) || g->ends[e][1] != (i < other ? other : i)) continue;
                const double w = scene_hash(e, seed, 1);
                g->weights[n] = (float)(ties ? rint(3 * w) : 2 * w);
                g->borders[n++] = (struct border){.other = other, .edge = e, .length = 1};
            }
    }
    g->first_border[nodes] = n;
    for (int k = 0; k < nodes * labels; k++)
        g->cost[k] = (float)(ties ? rint(4 * scene_hash(k, seed, 2)) / 4 : scene_hash(k, seed, 2));
}

static double energy(const struct graph *g, const int *label)
{
    double sum = 0;
    for (int i = 0; i < g->s.count; i++) {
        sum += (double)g->cost[i * g->labels + label[i]];
        for (int t = g->first_border[i]; t < g->first_border[i + 1]; t++)
            if (g->borders[t].other > i)
                sum += (double)g->weights[t] *
                       fmin((double)g->slope * abs(label[i] - label[g->borders[t].other]), (double)g->most);
    }
    return sum;
}

static double best_energy(const struct graph *g)
{
    int label[MOST_NODES] = {0};
    double best = HUGE_VAL;
    for (int i = 0; i < g->s.count;) {
        best = fmin(best, energy(g, label));
        for (i = 0; i < g->s.count && ++label[i] == g->labels; i++) label[i] = 0;
    }
    return best;
}

static double solve(const struct graph *g, int *label)
{
    struct err err = ERR_INIT;
    if (smooth_labels(label, &g->s, g->cost, g->labels, g->weights, g->slope, g->most, &err)) fail_msg("%s", err.text);
    for (int i = 0; i < g->s.count; i++) assert_true(label[i] >= 0 && label[i] < g->labels);
    return energy(g, label);
}

/* Each node alone, its own cheapest label. */
static double selfish_energy(const struct graph *g)
{
    int label[MOST_NODES] = {0};
    for (int i = 0; i < g->s.count; i++)
        for (int l = 1; l < g->labels; l++)
            if (g->cost[i * g->labels + l] < g->cost[i * g->labels + label[i]]) label[i] = l;
    return energy(g, label);
}

static void a_chain_gets_its_best_labels(void **state)
{
    (void)state;
    for (int seed = 0; seed < 300; seed++) {
        struct graph g = {.slope = 0.1f + 0.2f * (float)(seed % 5), .most = 0.2f + 0.3f * (float)(seed % 7)};
        int label[MOST_NODES];
        for (int i = 0; i < 5; i++) add_edge(&g, i, i + 1);
        finish(&g, 6, 4, seed, seed % 3 == 0);
        assert_near(solve(&g, label), best_energy(&g), 1e-5);
    }
}

static void a_tree_gets_its_best_labels(void **state)
{
    (void)state;
    for (int seed = 0; seed < 300; seed++) {
        struct graph g = {.slope = 0.1f + 0.2f * (float)(seed % 5), .most = 0.2f + 0.3f * (float)(seed % 7)};
        int label[MOST_NODES];
        for (int i = 1; i < 7; i++) add_edge(&g, i, (int)(i * scene_hash(i, seed, 9))); /* stars, chains, and between */
        finish(&g, 7, 4, seed, false);
        assert_near(solve(&g, label), best_energy(&g), 1e-5);
    }
}

static void loops_get_nearly_the_best_labels(void **state)
{
    (void)state;
    int best = 0;
    for (int seed = 0; seed < 200; seed++) {
        struct graph g = {.slope = 0.1f + 0.2f * (float)(seed % 5), .most = 0.2f + 0.3f * (float)(seed % 7)};
        int label[MOST_NODES];
        for (int i = 0; i < 9; i++) { /* a 3 x 3 grid with one diagonal a cell */
            if (i % 3 < 2) add_edge(&g, i, i + 1);
            if (i < 6) add_edge(&g, i, i + 3);
            if (i % 3 < 2 && i < 6) add_edge(&g, i, i + 4);
        }
        finish(&g, 9, 3, seed, false);
        const double found = solve(&g, label), optimum = best_energy(&g);
        assert_true(found >= optimum - 1e-5);
        assert_true(found <= selfish_energy(&g) + 1e-5);
        assert_true(found <= 1.01 * optimum + 1e-5);
        best += found <= optimum + 1e-5;
    }
    assert_true(best >= 190);
}

/* Noisy measurements of two flat regions come out flat, with one step between them. */
static void noise_is_smoothed_and_a_step_stays(void **state)
{
    (void)state;
    struct graph g = {.slope = 0.05f, .most = 0.3f};
    int label[MOST_NODES];
    for (int i = 0; i + 1 < 40; i++) add_edge(&g, i, i + 1);
    finish(&g, 40, 24, 5, false);
    for (int t = 0; t < 2 * 39; t++) g.weights[t] = 1;
    for (int i = 0; i < 40; i++)
        for (int l = 0; l < 24; l++) {
            const int truth = i < 20 ? 5 : 17, measured = i % 7 == 3 ? (truth + 9) % 24 : truth;
            g.cost[i * 24 + l] = 0.1f * fminf((float)abs(l - measured), 3);
        }
    solve(&g, label);
    for (int i = 0; i < 40; i++) assert_int_equal(label[i], i < 20 ? 5 : 17);
}

static void no_weight_is_everyone_for_himself(void **state)
{
    (void)state;
    for (int part = 0; part < 3; part++) { /* weights, slope, or the most is zero */
        struct graph g = {.slope = part == 1 ? 0 : 0.3f, .most = part == 2 ? 0 : 0.5f};
        int label[MOST_NODES];
        for (int i = 1; i < 20; i++) add_edge(&g, i, i / 2);
        finish(&g, 20, 7, part, false);
        if (part == 0) memset(g.weights, 0, sizeof g.weights);
        assert_near(solve(&g, label), selfish_energy(&g), 1e-6);
    }
}

static void one_label_one_node_or_none_at_all(void **state)
{
    (void)state;
    struct graph g = {.slope = 0.3f, .most = 0.5f};
    int label[MOST_NODES] = {7};
    finish(&g, 0, 4, 1, false);
    solve(&g, label);
    assert_int_equal(label[0], 7);
    finish(&g, 1, 4, 1, false);
    assert_near(solve(&g, label), selfish_energy(&g), 1e-6);
    for (int i = 0; i < 10; i++) add_edge(&g, i, i + 1);
    finish(&g, 11, 1, 1, false);
    solve(&g, label);
    for (int i = 0; i < 11; i++) assert_int_equal(label[i], 0);
}

/* The envelope of cut-off cones is computed by doubling; with two nodes the outcome must be the exact minimum for any
 * number of labels and any cone. */
static void two_nodes_agree_exactly_for_any_cone(void **state)
{
    (void)state;
    for (int seed = 0; seed < 400; seed++) {
        struct graph g = {.slope = 0.01f + 0.02f * (float)(seed % 11), .most = 0.03f + 0.11f * (float)(seed % 13)};
        int label[MOST_NODES];
        add_edge(&g, 0, 1);
        finish(&g, 2, 1 + seed % MOST_LABELS, seed, false);
        assert_near(solve(&g, label), best_energy(&g), 1e-6);
    }
}

static void the_same_again_is_the_same(void **state)
{
    (void)state;
    struct graph g = {.slope = 0.25f, .most = 0.5f};
    int label[2][MOST_NODES];
    for (int i = 1; i < 30; i++)
        for (int k = 1; k < 4 && k <= i; k++) add_edge(&g, i, i - k);
    finish(&g, 30, 8, 3, true);
    for (int k = 0; k < 2; k++) solve(&g, label[k]);
    assert_memory_equal(label[0], label[1], 30 * sizeof(int));
}

static void unlike_sides_are_tied_loosely(void **state)
{
    (void)state;
    struct graph g = {0};
    add_edge(&g, 0, 1);
    add_edge(&g, 1, 2);
    add_edge(&g, 0, 2);
    finish(&g, 3, 1, 1, false);
    g.segments[2].colour[0] = 60; /* 0 and 1 are alike, 2 is another colour; the border 0-2 is twice as long */
    for (int i = 0; i < 3; i++)
        for (int t = g.first_border[i]; t < g.first_border[i + 1]; t++) {
            g.borders[t].length = i + g.borders[t].other == 2 ? 16 : 8;
            g.borders[t].contrast = i == 2 || g.borders[t].other == 2 ? 60 : 0;
        }
    float *w = border_weights(&g.s, 64);
    assert_non_null(w);
    for (int i = 0; i < 3; i++)
        for (int t = g.first_border[i]; t < g.first_border[i + 1]; t++) {
            const int pair = i + g.borders[t].other;
            if (pair == 1) assert_near(w[t], 1, 1e-6); /* alike, as long as a segment is wide */
            if (pair == 2) assert_near(w[t], 2 * (double)w[g.first_border[2] + 1], 1e-6);
            if (pair > 1) assert_true(w[t] > 0 && w[t] < 0.2f);
        }
    free(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_chain_gets_its_best_labels),         cmocka_unit_test(a_tree_gets_its_best_labels),
        cmocka_unit_test(loops_get_nearly_the_best_labels),     cmocka_unit_test(noise_is_smoothed_and_a_step_stays),
        cmocka_unit_test(no_weight_is_everyone_for_himself),    cmocka_unit_test(one_label_one_node_or_none_at_all),
        cmocka_unit_test(two_nodes_agree_exactly_for_any_cone), cmocka_unit_test(the_same_again_is_the_same),
        cmocka_unit_test(unlike_sides_are_tied_loosely),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
