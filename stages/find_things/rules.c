/* rules.c - the things of a scene, from all of its views at once. */
#include "common/graph/scene_rules.h"

RULES(find_things)
{
    graph_step(g, "things", STEP_ONE, "ids");
    graph_goal(g, "things", NULL);
    if (!f->has_model || !f->views.count) return;
    graph_goal(g, "things", PATH(g, THINGS));
    graph_rule(g, "all");
    rule_makes(g, PATH(g, THINGS));
    rule_makes(g, PATH(g, THING_VOLUME));
    rule_makes(g, PATH(g, THING_SHEET));
    rule_makes(g, PATH(g, THING_PLAN));
    for (int i = 0; i < f->views.count; i++) {
        rule_makes(g, PATH(g, THING_MASK, .view = f->views.names[i]));
        graph_goal(g, "things", PATH(g, THING_MASK, .view = f->views.names[i]));
    }
    rule_takes(g, "--model", PATH(g, MODEL));
    rule_takes(g, "--plan", PATH(g, PLAN));
    rule_takes(g, "--axes", PATH(g, AXES));
    rule_takes_cameras(g);
    rule_needs(g, PATH(g, LENSES));
    rule_needs_set(g, "views");
    rule_takes_ids(g);
    for (int i = 0; i < f->views.count; i++) {
        rule_needs(g, PATH(g, DEPTH, .depth = MODEL_DEPTH, .view = f->views.names[i]));
        rule_needs(g, PATH(g, SEGMENTS, .depth = MODEL_DEPTH, .view = f->views.names[i]));
    }
    rule_option(g, "--depth", FOLDER(g, DEPTH, .depth = MODEL_DEPTH, .view = ""));
    const char *marks = graph_scene_file(g, "things.txt");
    if (marks) rule_takes(g, "--marks", marks);
    rule_option(g, "--out", FOLDER(g, THINGS));
    graph_list_if(g, GRAPH_ALWAYS_SHOWN, PATH(g, THING_SHEET), scene_asks_for_any(f, "textures remodel"));
    graph_list_if(g, GRAPH_ALWAYS_SHOWN, PATH(g, THING_PLAN), scene_asks_for_any(f, "textures remodel"));
}
