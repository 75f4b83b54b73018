/* rules.c - depth in rounds: each reads what the one before left in its folder, depth/roundK; the last is depth itself.
 *
 * A view that little changes in and around is carried over from the round before: segment_depth decides that, from the
 * records VIEW.round. Every view waits for all pictures and for all of the round before, through one target, since a
 * list of all for each of them would be too long. Which neighbours a view really read is in VIEW.d. */
#include "common/base/scan.h"
#include "common/graph/scene_rules.h"

static const char *round_folder(struct graph *g, int round, int last)
{
    return round == last ? "depth" : graph_text(g, "depth/round%d", round);
}

static void view_rule(struct graph *g, const struct scene_facts *f, const char *view, int round, int last)
{
    const char *folder = round_folder(g, round, last), *before = round ? round_folder(g, round - 1, last) : NULL;
    const char *out = PATH(g, DEPTH, .depth = folder, .view = view);
    const char *segments = PATH(g, SEGMENTS, .depth = folder, .view = view);
    const char *record = PATH(g, DEPTH_ROUND, .depth = folder, .view = view);
    const char *given = graph_text(g, "%s/stamp/given/%s.txt", f->shared, view);
    const char *deps = graph_text(g, "%s/%s/%s.d", f->own, folder, view);
    graph_piece(g, "%s", view);
    rule_makes(g, out);
    rule_makes(g, segments);
    rule_makes(g, record);
    rule_needs(g, PATH(g, VIEW, .view = view));
    if (before) rule_needs(g, PATH(g, DEPTH, .depth = before, .view = view));
    rule_needs(g, path_is_file(given) ? given : NULL);
    rule_takes_cameras(g);
    rule_takes(g, "--frame", PATH(g, ROOM_FRAME));
    rule_needs_listed(g, deps);
    rule_after_set(g, "views");
    if (before) rule_after(g, graph_text(g, "depth-round%d", round - 1));
    rule_option(g, "--view", view);
    rule_option(g, "--records", FOLDER(g, PHOTO_LIST));
    if (before) rule_option(g, "--before", FOLDER(g, DEPTH, .depth = before, .view = view));
    rule_variable(g, "--given", "DEPTH");
    rule_option(g, "--out", out);
    rule_option(g, "--deps", deps);
    const char *goal = graph_text(g, "depth-round%d", round);
    graph_goal(g, goal, out);
    graph_goal(g, goal, segments);
    graph_goal(g, goal, record);
    if (round != last) return;
    graph_set(g, "depth", out);
    graph_set(g, "depth", segments);
}

RULES(segment_depth)
{
    int64_t last = -1;
    graph_step(g, "depth", STEP_FARM, "frame");
    graph_goal(g, "depth", NULL);
    if (!scan_int(graph_parameter(g, "rounds"), &last)) return;
    for (int round = 0; round <= (int)last; round++) {
        graph_goal(g, graph_text(g, "depth-round%d", round), NULL);
        for (int i = 0; i < f->views.count; i++) view_rule(g, f, f->views.names[i], round, (int)last);
    }
    if (!f->views.count) return;
    graph_goal(g, "depth", graph_text(g, "depth-round%d", (int)last));
    graph_list(g, GRAPH_MEASURED, graph_set_path(g, "depth"));
    graph_list(g, GRAPH_SHOWN, graph_set_path(g, "depth"));
}
