/* plan_parts.c - the parts of the search for a plan: minimum cuts, cells of a plan, thinned points, lines of sight,
 * joins of walls, the script. */
#include "stages/suggest_model/suggest.h"

#include "tests/unit/scratch.h"

#include "stages/suggest_model/min_cut.h"
#include "stages/suggest_model/plan_cells.h"
#include "stages/suggest_model/suggest_script.h"
#include "stages/suggest_model/wall_joins.h"
#include "tests/unit/suggest_model/made_plan.h"

/* A chain of nodes whose ends want opposite labels is cut at its cheapest link. */
static void a_chain_is_cut_at_its_weakest_link(void **state)
{
    (void)state;
    static const double LINKS[4] = {3, 2, 1, 4};
    struct cut_graph g;
    struct err err = ERR_INIT;
    bool source[5];
    assert_ok(cut_graph_init(&g, 5, &err), err);
    assert_ok(cut_graph_node(&g, 0, 0, 10, &err), err); /* dear on the sink's side */
    assert_ok(cut_graph_node(&g, 4, 10, 0, &err), err);
    for (int i = 0; i < 4; i++) assert_ok(cut_graph_pair(&g, i, i + 1, LINKS[i], LINKS[i], &err), err);
    cut_graph_solve(&g, source);
    for (int i = 0; i < 5; i++) assert_int_equal(source[i], i < 3);
    cut_graph_release(&g);
    cut_graph_release(&g);
}

/* The least cost over all labels of small random graphs, by trying them. */
static void a_cut_costs_the_least(void **state)
{
    (void)state;
    enum { NODES = 6 };
    for (uint64_t seed = 1; seed <= 20; seed++) {
        const struct rng rng = rng_make(seed, "cut", "made");
        double node[NODES][2], pair[NODES][NODES], cost[1 << NODES];
        struct cut_graph g;
        struct err err = ERR_INIT;
        bool source[NODES];
        assert_ok(cut_graph_init(&g, NODES, &err), err);
        for (uint64_t i = 0; i < NODES; i++) {
            for (uint64_t k = 0; k < 2; k++) node[i][k] = rng_uniform(&rng, i, k);
            assert_ok(cut_graph_node(&g, (int)i, node[i][0], node[i][1], &err), err);
            for (uint64_t k = 0; k < NODES; k++) pair[i][k] = i == k ? 0 : 0.4 * rng_uniform(&rng, i, 10 + k);
        }
        for (int i = 0; i < NODES; i++)
            for (int k = i + 1; k < NODES; k++) assert_ok(cut_graph_pair(&g, i, k, pair[i][k], pair[k][i], &err), err);
        cut_graph_solve(&g, source);
        int found = 0, best = 0;
        for (int labels = 0; labels < 1 << NODES; labels++) { /* a set bit: on the source's side */
            cost[labels] = 0;
            for (int i = 0; i < NODES; i++) {
                cost[labels] += node[i][!(labels >> i & 1)];
                for (int k = 0; k < NODES; k++)
                    if ((labels >> i & 1) && !(labels >> k & 1)) cost[labels] += pair[i][k];
            }
            if (cost[labels] < cost[best]) best = labels;
        }
        for (int i = 0; i < NODES; i++) found |= source[i] << i;
        assert_float_equal(cost[found], cost[best], 1e-9);
        cut_graph_release(&g);
    }
}

static void lines_cut_a_plan_into_cells_that_share_edges(void **state)
{
    (void)state;
    const struct wall_line lines[3] = {{{1, 0}, 2}, {{0, 1}, 1}, {{M_SQRT1_2, M_SQRT1_2}, 4 * M_SQRT1_2}};
    struct plan_cells p;
    struct err err = ERR_INIT;
    double area = 0;
    assert_ok(plan_cells_make(&p, (const double[2]){0, 0}, (const double[2]){5, 3}, lines, 3, &err), err);
    assert_int_equal(p.cell_count, 7); /* three lines in general position */
    for (int c = 0; c < p.cell_count; c++) area += p.cells[c].area;
    assert_float_equal(area, 15, 1e-9);
    for (int e = 0; e < p.edge_count; e++) {
        const int twin = p.edges[e].twin;
        assert_int_equal(twin < 0, p.edges[e].line < 0); /* the border of the plan has none */
        if (twin < 0) continue;
        assert_int_equal(p.edges[twin].twin, e);
        for (int k = 0; k < 2; k++) assert_float_equal(p.edges[twin].a[k], cell_edge_end(&p, e)[k], 1e-9);
    }
    plan_cells_release(&p);
    plan_cells_release(&p);
}

/* A plane through the borders of cubes keeps its position, by the weights. */
static void thinned_points_keep_a_plane_in_place(void **state)
{
    (void)state;
    const struct rng rng = rng_make(1, "thin", "made");
    struct point_cloud cloud = {.points = calloc(20000, sizeof *cloud.points)};
    struct thin_points thin;
    struct err err = ERR_INIT;
    double sum = 0, weight = 0, want = 0;
    assert_non_null(cloud.points);
    for (uint64_t i = 0; i < 20000; i++) {
        struct cloud_point *p = &cloud.points[cloud.count++];
        *p = (struct cloud_point){.normal = {1, 0, 0}, .views = 3, .confidence = 0.5f};
        p->position = vec3_make(0.098 + 0.01 * gauss(&rng, i, 0), rng_uniform(&rng, i, 4), rng_uniform(&rng, i, 5));
        want += p->position.x / 20000;
    }
    assert_ok(points_thin(&thin, &cloud, 0.1, &err), err);
    assert_true(thin.cloud.count >= 200 && thin.cloud.count <= 400);
    for (size_t i = 0; i < thin.cloud.count; i++) {
        sum += (double)thin.weight[i] * thin.cloud.points[i].position.x;
        weight += (double)thin.weight[i];
    }
    assert_float_equal(weight, 10000, 1);
    assert_float_equal(sum / weight, want, 1e-4);
    thin_points_release(&thin);
    point_cloud_release(&cloud);
}

/* Of a room of 4 x 3 behind a wall, nothing is visible; stray points before the wall hide nothing of it. */
static void stray_points_hide_no_wall(void **state)
{
    (void)state;
    struct made_plan p = {.high = 2.5, .low = {0, 0}, .most = {4, 6}, .stray = 0.05};
    struct sights sights;
    struct err err = ERR_INIT;
    size_t on_wall = 0, behind = 0, all = 0;
    made_line(&p, (const double[4][2]){{0, 0}, {4, 0}, {4, 6}, {0, 6}}, 4, true);
    made_wall(&p, 0, 3, 4, 3, 0, 2.5);
    for (int k = 0; k < 9; k++) made_camera(&p, 1 + 0.25 * k, 0.6 + 0.2 * (k % 3));
    const int before = p.view_count;
    made_camera(&p, 2, 5); /* shows the room behind */
    struct point_cloud cloud = made_points(&p, 5);
    assert_non_null(cloud.points);
    assert_ok(sights_make(&sights, &cloud, 0.05, p.views, before, &err), err);
    for (size_t i = 0; i < sights.points.cloud.count; i++) {
        const struct cloud_point *q = &sights.points.cloud.points[i];
        all += fabs(q->position.y - 3) < 0.01 && q->normal[1] < -0.8f;
    }
    for (size_t i = 0; i < sights.rays.count; i++) {
        const struct cloud_point *q = &sights.points.cloud.points[sights.rays.rays[i].point];
        on_wall += fabs(q->position.y - 3) < 0.01;
        behind += q->position.y > 3.3;
    }
    assert_true(all > 200 && on_wall > all * 9 / 10);
    assert_true(behind * 20 < on_wall);
    sights_release(&sights);
    point_cloud_release(&cloud);
}

/* ----------------------------------------------------------------------------------------------------------- joins */

static struct suggested_wall wall_of(double ax, double ay, double bx, double by)
{
    const double length = hypot(bx - ax, by - ay);
    struct suggested_wall w = {.line = {{(by - ay) / length, (ax - bx) / length}, 0}, .others = {-1, -1}};
    w.line.at = w.line.n[0] * ax + w.line.n[1] * ay;
    w.begin = w.seen[0] = line_along(&w.line, ax, ay);
    w.end = w.seen[1] = line_along(&w.line, bx, by);
    w.covered = w.confidence = 0.9;
    return w;
}

static void a_wall_ends_at_one_that_goes_on(void **state)
{
    (void)state;
    struct suggested_wall walls[3] = {wall_of(5, 0, 0, 0), wall_of(0, 0, 0, 4), wall_of(2, 4, 2, 0.05)};
    struct suggestion s = {.ceiling = 2.5, .walls = walls, .wall_count = 3};
    wall_joins_add(&s, &(struct wall_side){0, 0}, &(struct wall_side){1, 0});
    wall_joins_add(&s, &(struct wall_side){0, 0}, &(struct wall_side){2, 0});
    assert_int_equal(walls[0].joins[1], JOIN_CORNER);
    assert_int_equal(walls[1].joins[0], JOIN_CORNER);
    assert_int_equal(walls[2].joins[1], JOIN_MEETS);
    assert_int_equal(walls[2].others[1], 0);
    assert_true(wall_joins_has(&s, 2, 0) && !wall_joins_has(&s, 1, 2));
}

/* The border steps back by 10 cm: a wall of 15 cm beside the step would swallow it. */
static void a_wall_beside_a_small_step_becomes_thinner(void **state)
{
    (void)state;
    struct suggested_wall walls[3] = {wall_of(2, 0, 0, 0), wall_of(2, 0.1, 2, 0), wall_of(4, 0.1, 2, 0.1)};
    struct suggestion s = {.ceiling = 2.5, .walls = walls, .wall_count = 3};
    wall_joins_add(&s, &(struct wall_side){2, 0}, &(struct wall_side){1, 0});
    wall_joins_add(&s, &(struct wall_side){1, 0}, &(struct wall_side){0, 0});
    wall_joins_fit(&s, 0.15);
    assert_true(wall_joins_has(&s, 0, 1) && wall_joins_has(&s, 1, 2));
    assert_true(walls[2].thickness > 0 && walls[2].thickness < 0.1);
}

static void openings_stay_between_corners(void **state)
{
    (void)state;
    struct suggested_wall walls[2] = {wall_of(5, 0, 0, 0), wall_of(2, 4, 2, 0)};
    struct suggested_opening openings[3] = {{0, -5.2, -3, 0.9, 2, true, false},    /* beyond the wall's beginning */
                                            {0, -2.1, -0.5, 0, 2.1, false, false}, /* where the other wall ends */
                                            {0, -4, -3.5, 1, 1.5, true, false}};   /* in the first one */
    struct suggestion s = {.ceiling = 2.5, .walls = walls, .wall_count = 2, .openings = openings, .opening_count = 3};
    wall_joins_add(&s, &(struct wall_side){1, 0}, &(struct wall_side){0, 0});
    wall_joins_cut_openings(&s, 0.15, 0.1);
    assert_int_equal(s.opening_count, 2);
    assert_float_equal(openings[0].begin, -5, 1e-9);
    assert_true(openings[1].begin >= -2 - 1e-9 && openings[1].begin < -1.8);
}

static void the_script_says_what_is_missing(void **state)
{
    (void)state;
    struct suggested_wall walls[2] = {wall_of(5, 0, 0, 0), wall_of(0, 0, 0, 4)};
    struct suggested_doubt doubts[] = {{DOUBT_BORDER, {0, 4}, {5, 4}, -1, 0.1, 0},
                                       {DOUBT_BORDER, {5, 4}, {5, 0}, -1, 0, 7}};
    int room_walls[2] = {0, 1};
    struct suggested_room room = {0, 2, false, {2.5, 2}, 20};
    struct suggested_opening opening = {0, -4, -3, 0.9, 2, true, true};
    struct suggestion s = {.ceiling = 2.5,
                           .walls = walls,
                           .wall_count = 2,
                           .openings = &opening,
                           .opening_count = 1,
                           .doubts = doubts,
                           .doubt_count = 2,
                           .rooms = &room,
                           .room_count = 1,
                           .room_walls = room_walls,
                           .room_wall_count = 2};
    const struct model_axes axes = {.scale = 1, .ceiling = 2.5};
    struct wall_names names;
    struct err err = ERR_INIT;
    char *text = NULL;
    size_t size = 0;
    FILE *to = open_memstream(&text, &size);
    assert_non_null(to);
    wall_joins_add(&s, &(struct wall_side){0, 0}, &(struct wall_side){1, 0});
    assert_ok(suggest_names_make(&names, &s, &err), err);
    suggest_script_print(to, &s, &names, &axes, NULL);
    fclose(to);
    assert_non_null(strstr(text, "# south: confidence 0.90; 90 % of its length was seen\n"
                                 "wall south from 5.0000 0.0000 to 0.0000 0.0000\n"));
    assert_non_null(strstr(text, "\njoin south west\n"));
    assert_non_null(strstr(text, "\n# the start of south is joined to nothing: join south ...\n"));
    assert_non_null(strstr(text, "# bright and without depth: a window, or a patch of light\n"
                                 "# window window1 on south from 3.0000 0.9000 to 4.0000 2.0000\n"));
    assert_non_null(strstr(text, "is not closed"));
    assert_non_null(strstr(text, "\n# room room1 south west ...\n"));
    assert_non_null(
        strstr(text, "# what was seen ends from 0.0000 4.0000 to 5.0000 4.0000: a wall there was seen over 10 "));
    assert_non_null(
        strstr(text, "# what was seen ends from 5.0000 4.0000 to 5.0000 0.0000: no wall is there, since 7 views"));
    free(text);
    suggest_names_release(&names);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_chain_is_cut_at_its_weakest_link),
        cmocka_unit_test(a_cut_costs_the_least),
        cmocka_unit_test(lines_cut_a_plan_into_cells_that_share_edges),
        cmocka_unit_test(thinned_points_keep_a_plane_in_place),
        cmocka_unit_test(stray_points_hide_no_wall),
        cmocka_unit_test(a_wall_ends_at_one_that_goes_on),
        cmocka_unit_test(a_wall_beside_a_small_step_becomes_thinner),
        cmocka_unit_test(openings_stay_between_corners),
        cmocka_unit_test(the_script_says_what_is_missing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
