/* rules.c - one atlas of all faces. */
#include "common/graph/scene_rules.h"

RULES(bake_vita)
{
    graph_step(g, "vita", STEP_ONE, "ids things");
    graph_step(g, "textures", STEP_ONE, "vdta vita");
    graph_asked(g, "textures", "textures");
    graph_goal(g, "vita", NULL);
    graph_goal(g, "textures", "vdta vita");
    if (!f->has_model) return;
    graph_goal(g, "vita", PATH(g, ATLAS));
    graph_rule(g, "all");
    rule_makes(g, PATH(g, ATLAS));
    rule_takes_seen_model(g);
    for (int i = 0; i < f->edits.count; i++) {
        const char *edited = PATH(g, MODEL, .model = scene_model_folder(g, &f->edits, i));
        rule_takes(g, "--edit", edited);
    }
    if (f->views.count) rule_needs(g, PATH(g, FACE_INDEX));
    for (int i = 0; i < f->views.count; i++) rule_needs(g, PATH(g, THING_MASK, .view = f->views.names[i]));
    if (f->views.count) rule_option(g, "--things", FOLDER(g, THINGS));
    rule_option(g, "--out", FOLDER(g, ATLAS));
    graph_list_if(g, GRAPH_MEASURED, PATH(g, ATLAS), scene_asks_for_any(f, "textures remodel"));
    graph_list_if(g, GRAPH_ALWAYS_SHOWN, PATH(g, ATLAS), scene_asks_for_any(f, "textures remodel"));
}
