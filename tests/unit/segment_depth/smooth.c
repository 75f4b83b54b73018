/* smooth.c - labels of small graphs against exhaustive search. */
#include "stages/segment_depth/smooth.h"

#include "tests/unit/segment_depth/scene.h"

enum { MAX_NODES = 40, MAX_EDGES = 90, MAX_LABELS = 24 };

struct graph {
    struct segmentation s;
    int first_border[MAX_NODES + 1], ends[MAX_EDGES][2];
    struct border borders[2 * MAX_EDGES];
    struct segment segments[MAX_NODES];
    float weights[2 * MAX_EDGES], cost[MAX_NODES * MAX_LABELS];
    int labels;
    float slope, truncation;
};

static void add_edge(struct graph *g, int a, int b)
{
    g->ends[g->s.edge_count][0] = a < b ? a : b;
    g->ends[g->s.edge_count++][1] = a < b ? b : a;
    assert_true(g->s.edge_count <= MAX_EDGES);
}

/* Lists the borders; weights and costs are random, multiples of 1 and 1/4 if there are to be ties. */
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
                       fmin((double)g->slope * abs(label[i] - label[g->borders[t].other]), (double)g->truncation);
    }
    return sum;
}

static double best_energy(const struct graph *g)
{
    int label[MAX_NODES] = {0};
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
    if (smooth_labels(label, &g->s, g->cost, g->labels, g->weights, g->slope, g->truncation, &err))
        fail_msg("%s", err.text);
    for (int i = 0; i < g->s.count; i++) assert_true(label[i] >= 0 && label[i] < g->labels);
    return energy(g, label);
}

/* Each node's label of minimum data cost. */
static double selfish_energy(const struct graph *g)
{
    int label[MAX_NODES] = {0};
    for (int i = 0; i < g->s.count; i++)
        for (int l = 1; l < g->labels; l++)
            if (g->cost[i * g->labels + l] < g->cost[i * g->labels + label[i]]) label[i] = l;
    return energy(g, label);
}

static void labels_of_a_chain_are_optimal(void **state)
{
    (void)state;
    for (int seed = 0; seed < 300; seed++) {
        struct graph g = {.slope = 0.1f + 0.2f * (float)(seed % 5), .truncation = 0.2f + 0.3f * (float)(seed % 7)};
        int label[MAX_NODES];
        for (int i = 0; i < 5; i++) add_edge(&g, i, i + 1);
        finish(&g, 6, 4, seed, seed % 3 == 0);
        assert_near(solve(&g, label), best_energy(&g), 1e-5);
    }
}

static void labels_of_a_tree_are_optimal(void **state)
{
    (void)state;
    for (int seed = 0; seed < 300; seed++) {
        struct graph g = {.slope = 0.1f + 0.2f * (float)(seed % 5), .truncation = 0.2f + 0.3f * (float)(seed % 7)};
        int label[MAX_NODES];
        for (int i = 1; i < 7; i++) add_edge(&g, i, (int)(i * scene_hash(i, seed, 9))); /* from stars to chains */
        finish(&g, 7, 4, seed, false);
        assert_near(solve(&g, label), best_energy(&g), 1e-5);
    }
}

static void labels_of_loops_are_nearly_optimal(void **state)
{
    (void)state;
    int best = 0;
    for (int seed = 0; seed < 200; seed++) {
        struct graph g = {.slope = 0.1f + 0.2f * (float)(seed % 5), .truncation = 0.2f + 0.3f * (float)(seed % 7)};
        int label[MAX_NODES];
        for (int i = 0; i < 9; i++) { /* a 3 x 3 grid with one diagonal per cell */
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

/* Two regions of constant depth, measured with noise, become constant with one step between them. */
static void noise_is_smoothed_and_a_step_is_kept(void **state)
{
    (void)state;
    struct graph g = {.slope = 0.05f, .truncation = 0.3f};
    int label[MAX_NODES];
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

static void without_weight_each_node_takes_its_cheapest_label(void **state)
{
    (void)state;
    for (int part = 0; part < 3; part++) { /* weights, slope or truncation is zero */
        struct graph g = {.slope = part == 1 ? 0 : 0.3f, .truncation = part == 2 ? 0 : 0.5f};
        int label[MAX_NODES];
        for (int i = 1; i < 20; i++) add_edge(&g, i, i / 2);
        finish(&g, 20, 7, part, false);
        if (part == 0) memset(g.weights, 0, sizeof g.weights);
        assert_near(solve(&g, label), selfish_energy(&g), 1e-6);
    }
}

static void one_label_one_node_or_no_node_works(void **state)
{
    (void)state;
    struct graph g = {.slope = 0.3f, .truncation = 0.5f};
    int label[MAX_NODES] = {7};
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

/* The min-convolution works by doubling; with two nodes the result must be the exact minimum for any number of labels
 * and any cone. */
static void two_nodes_are_optimal_for_any_cone(void **state)
{
    (void)state;
    for (int seed = 0; seed < 400; seed++) {
        struct graph g = {.slope = 0.01f + 0.02f * (float)(seed % 11),
                          .truncation = 0.03f + 0.11f * (float)(seed % 13)};
        int label[MAX_NODES];
        add_edge(&g, 0, 1);
        finish(&g, 2, 1 + seed % MAX_LABELS, seed, false);
        assert_near(solve(&g, label), best_energy(&g), 1e-6);
    }
}

static void repeated_runs_give_the_same_labels(void **state)
{
    (void)state;
    struct graph g = {.slope = 0.25f, .truncation = 0.5f};
    int label[2][MAX_NODES];
    for (int i = 1; i < 30; i++)
        for (int k = 1; k < 4 && k <= i; k++) add_edge(&g, i, i - k);
    finish(&g, 30, 8, 3, true);
    for (int k = 0; k < 2; k++) solve(&g, label[k]);
    assert_memory_equal(label[0], label[1], 30 * sizeof(int));
}

static void borders_between_unlike_colours_have_low_weight(void **state)
{
    (void)state;
    struct graph g = {0};
    add_edge(&g, 0, 1);
    add_edge(&g, 1, 2);
    add_edge(&g, 0, 2);
    finish(&g, 3, 1, 1, false);
    g.segments[2].colour[0] = 60; /* 0 and 1 have one colour, 2 another; the border 0-2 is twice as long */
    for (int i = 0; i < 3; i++)
        for (int t = g.first_border[i]; t < g.first_border[i + 1]; t++) {
            g.borders[t].length = i + g.borders[t].other == 2 ? 16 : 8;
            g.borders[t].contrast = i == 2 || g.borders[t].other == 2 ? 60 : 0;
        }
    float *w = smooth_border_weights(&g.s, 64);
    assert_non_null(w);
    for (int i = 0; i < 3; i++)
        for (int t = g.first_border[i]; t < g.first_border[i + 1]; t++) {
            const int pair = i + g.borders[t].other;
            if (pair == 1) assert_near(w[t], 1, 1e-6); /* equal colours, one segment width long */
            if (pair == 2) assert_near(w[t], 2 * (double)w[g.first_border[2] + 1], 1e-6);
            if (pair > 1) assert_true(w[t] > 0 && w[t] < 0.2f);
        }
    free(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(labels_of_a_chain_are_optimal),
        cmocka_unit_test(labels_of_a_tree_are_optimal),
        cmocka_unit_test(labels_of_loops_are_nearly_optimal),
        cmocka_unit_test(noise_is_smoothed_and_a_step_is_kept),
        cmocka_unit_test(without_weight_each_node_takes_its_cheapest_label),
        cmocka_unit_test(one_label_one_node_or_no_node_works),
        cmocka_unit_test(two_nodes_are_optimal_for_any_cone),
        cmocka_unit_test(repeated_runs_give_the_same_labels),
        cmocka_unit_test(borders_between_unlike_colours_have_low_weight),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
