/* rules.c - one atlas of all faces, those of edits too; and one of the unedited model's, from which viewpoints take
 * what no photo shows: an edit that is added must not bake them all again. */
#include "common/graph/scene_rules.h"

static void bake_rule(struct graph *g, const struct scene_facts *f, const char *name, const char *folder, bool edits)
{
    graph_rule(g, "%s", name);
    rule_makes(g, PATH(g, ATLAS, .atlas = folder));
    rule_takes_seen_model(g);
    for (int i = 0; edits && i < f->edits.count; i++)
        rule_takes(g, "--edit", PATH(g, MODEL, .model = scene_model_folder(g, &f->edits, i)));
    if (f->views.count) rule_needs(g, PATH(g, FACE_INDEX));
    for (int i = 0; i < f->views.count; i++) rule_needs(g, PATH(g, THING_MASK, .view = f->views.names[i]));
    if (f->views.count) rule_option(g, "--things", FOLDER(g, THINGS));
    rule_option(g, "--out", FOLDER(g, ATLAS, .atlas = folder));
}

RULES(bake_vita)
{
    graph_step(g, "fill", STEP_ONE, "ids things");
    graph_step(g, "vita", STEP_ONE, "ids things");
    graph_step(g, "textures", STEP_ONE, "vdta vita");
    graph_asked(g, "textures", "textures");
    graph_goal(g, "fill", NULL);
    graph_goal(g, "vita", NULL);
    graph_goal(g, "textures", "vdta vita");
    if (!f->has_model) return;
    graph_goal(g, "vita", PATH(g, ATLAS));
    bake_rule(g, f, "all", "vita", true);
    bake_rule(g, f, "fill", FILL_ATLAS, false);
    graph_goal(g, "fill", PATH(g, ATLAS, .atlas = FILL_ATLAS));
    graph_list_if(g, GRAPH_MEASURED, PATH(g, ATLAS), scene_asks_for_any(f, "textures remodel"));
    graph_list_if(g, GRAPH_ALWAYS_SHOWN, PATH(g, ATLAS), scene_asks_for_any(f, "textures remodel"));
}
