/* rules.c - an atlas for each photo. Which other views it reads is known when it has been made, and listed in PHOTO.d.
 */
#include "common/graph/scene_rules.h"

static void photo_rule(struct graph *g, const struct scene_facts *f, const struct photo_views *p)
{
    const char *atlas = PATH(g, ATLAS, .atlas = graph_text(g, "vdta/%s", p->photo));
    const char *deps = graph_text(g, "%s/vdta/%s.d", f->own, p->photo);
    graph_piece(g, "%s", p->photo);
    rule_makes(g, atlas);
    rule_takes(g, "--model", PATH(g, MODEL));
    rule_takes(g, "--axes", PATH(g, AXES));
    rule_takes_cameras(g);
    rule_needs(g, PATH(g, LENSES));
    rule_needs(g, PATH(g, FACE_INDEX));
    for (int i = 0; i < p->count; i++) {
        rule_needs(g, PATH(g, VIEW, .view = p->views[i]));
        rule_needs(g, PATH(g, IDS, .view = p->views[i]));
        rule_needs(g, PATH(g, REVEAL, .view = p->views[i]));
        rule_needs(g, PATH(g, THING_MASK, .view = p->views[i]));
    }
    rule_needs(g, PATH(g, ATLAS, .atlas = FILL_ATLAS));
    rule_option(g, "--fill", FOLDER(g, ATLAS, .atlas = FILL_ATLAS));
    rule_needs_listed(g, deps);
    rule_after_set(g, "views");
    rule_after_set(g, "ids");
    rule_option(g, "--ids", FOLDER(g, FACE_INDEX));
    rule_option(g, "--things", FOLDER(g, THINGS));
    rule_option(g, "--reveal", FOLDER(g, REVEAL, .view = ""));
    rule_option(g, "--out", graph_own(g, "vdta"));
    rule_own(g);
    rule_option(g, "--photo", p->photo);
    rule_option(g, "--deps", deps);
    graph_goal(g, "vdta", atlas);
    graph_set(g, "vdta", atlas);
    if (!scene_asks_for_any(f, "textures remodel")) {
        graph_list_if(g, GRAPH_MEASURED, atlas, false);
        graph_list_if(g, GRAPH_ALWAYS_SHOWN, atlas, false);
    }
}

RULES(bake_vdta)
{
    graph_step(g, "vdta", STEP_FARM, "ids things fill");
    graph_step(g, "relit-vdta", STEP_FARM, "ids things fill"); /* of the photos that are relit: relight lists them */
    graph_goal(g, "vdta", NULL);
    graph_goal(g, "relit-vdta", NULL);
    if (!f->has_model || !f->views.count) return;
    for (int i = 0; i < f->viewpoints.count; i++) photo_rule(g, f, &f->viewpoints.photos[i]);
    if (!scene_asks_for_any(f, "textures remodel")) return;
    graph_list(g, GRAPH_MEASURED, graph_set_path(g, "vdta"));
    graph_list(g, GRAPH_ALWAYS_SHOWN, graph_set_path(g, "vdta"));
}
