/* rules.c - depth in rounds: each reads what the one before left in its folder, depth/roundK; the last is depth itself.
 * A scene with a model has one more after it, depth/model, which knows the model; films do not read it.
 *
 * A view that little changes in and around is carried over from the round before: segment_depth decides that, from the
 * records VIEW.round. Every view waits for all pictures and for all of the round before, through one target, since a
 * list of all for each of them would be too long. Which neighbours a view really read is in VIEW.d. */
#include <string.h>

#include "common/base/scan.h"
#include "common/graph/scene_rules.h"

/* Below O: where a round writes, and what it reads of the one before; NULL in the first. */
struct round {
    const char *folder, *before;
    const char *goal, *goal_before; /* of all its views */
    bool knows_model;
};

static const char *round_folder(struct graph *g, int round, int last)
{
    return round == last ? "depth" : graph_text(g, "depth/round%d", round);
}

static void view_rule(struct graph *g, const struct scene_facts *f, const char *view, const struct round *r)
{
    const char *folder = r->folder, *before = r->before;
    const char *out = PATH(g, DEPTH, .depth = folder, .view = view);
    const char *segments = PATH(g, SEGMENTS, .depth = folder, .view = view);
    const char *record = PATH(g, DEPTH_ROUND, .depth = folder, .view = view);
    const char *given = graph_text(g, "%s/stamp/given/%s.txt", f->shared, view);
    const char *deps = graph_text(g, "%s/%s/%s.d", f->own, folder, view);
    graph_piece(g, r->knows_model ? "model-%s" : "%s", view);
    rule_makes(g, out);
    rule_makes(g, segments);
    rule_makes(g, record);
    rule_needs(g, PATH(g, VIEW, .view = view));
    if (before) rule_needs(g, PATH(g, DEPTH, .depth = before, .view = view));
    rule_needs(g, path_is_file(given) ? given : NULL);
    rule_takes_cameras(g);
    rule_takes(g, "--frame", PATH(g, ROOM_FRAME));
    if (r->knows_model) {
        rule_takes(g, "--model", PATH(g, MODEL));
        rule_takes(g, "--axes", PATH(g, AXES));
    }
    rule_needs_listed(g, deps);
    rule_after_set(g, "views");
    if (before) rule_after(g, r->goal_before);
    rule_option(g, "--view", view);
    rule_option(g, "--records", FOLDER(g, PHOTO_LIST));
    if (before) rule_option(g, "--before", FOLDER(g, DEPTH, .depth = before, .view = view));
    if (*scene_setting("DEPTH"))
        rule_variable(g, "--given", "DEPTH");
    else if (path_is_folder(graph_shared(g, "sfm_depth")))
        rule_option(g, "--given", graph_shared(g, "sfm_depth"));
    else if (path_is_folder(graph_shared(g, "photo_depth")))
        rule_option(g, "--given", graph_shared(g, "photo_depth"));
    rule_option(g, "--out", out);
    rule_option(g, "--deps", deps);
    graph_goal(g, r->goal, out);
    graph_goal(g, r->goal, segments);
    graph_goal(g, r->goal, record);
    if (r->knows_model) graph_list_if(g, GRAPH_MEASURED, out, scene_asks_for_any(f, "textures remodel"));
    if (strcmp(folder, "depth") != 0) return;
    graph_set(g, "depth", out);
    graph_set(g, "depth", segments);
}

RULES(segment_depth)
{
    int64_t last = -1;
    graph_step(g, "depth", STEP_FARM, "frame");
    graph_goal(g, "depth", NULL);
    graph_step(g, "model_depth", STEP_FARM, "model");
    graph_goal(g, "model_depth", NULL);
    if (!scan_int(graph_parameter(g, "rounds"), &last)) return;
    for (int k = 0; k <= (int)last; k++) {
        const struct round r = {round_folder(g, k, (int)last), k ? round_folder(g, k - 1, (int)last) : NULL,
                                graph_text(g, "depth-round%d", k), k ? graph_text(g, "depth-round%d", k - 1) : NULL,
                                false};
        graph_goal(g, r.goal, NULL);
        for (int i = 0; i < f->views.count; i++) view_rule(g, f, f->views.names[i], &r);
    }
    const struct round known = {MODEL_DEPTH, "depth", "model_depth", graph_text(g, "depth-round%d", (int)last), true};
    for (int i = 0; f->has_model && i < f->views.count; i++) view_rule(g, f, f->views.names[i], &known);
    if (!f->views.count) return;
    graph_goal(g, "depth", graph_text(g, "depth-round%d", (int)last));
    graph_list(g, GRAPH_MEASURED, graph_set_path(g, "depth"));
    graph_list(g, GRAPH_SHOWN, graph_set_path(g, "depth"));
}
