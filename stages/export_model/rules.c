/* rules.c - the textured model and its edits, with their furniture, for other programs. The pages come first, the IFC
 * file last. */
#include "common/graph/scene_rules.h"

RULES(export_model)
{
    graph_step(g, "exports", STEP_ONE, "vita things");
    graph_goal(g, "exports", NULL);
    for (int edit = -1; f->has_model && edit < f->edits.count; edit++) {
        const char *model = scene_model_folder(g, &f->edits, edit), *name = scene_model_name(model);
        const char *map = scene_model_is_edited(model) ? PATH(g, TEXTURE_MAP, .model = model) : NULL;
        graph_goal(g, "exports", PATH(g, EXPORT_IFC, .model = model));
        graph_rule(g, "%s", name);
        rule_makes(g, PATH(g, EXPORT_IFC, .model = model));
        rule_needs(g, PATH(g, MODEL, .model = model));
        rule_needs(g, PATH(g, PLAN, .model = model));
        rule_takes(g, "--map", map);
        rule_takes(g, "--base", map ? PATH(g, MODEL) : NULL);
        rule_takes_things(g, f);
        rule_takes(g, "--objects", map ? PATH(g, OBJECTS, .model = model) : NULL);
        if (map) rule_needs_webs(g, f);
        rule_option(g, "--scene", map ? f->folder : NULL);
        rule_takes(g, "--axes", PATH(g, AXES));
        rule_takes_vita(g);
        rule_option(g, "--name", map ? graph_text(g, "%s-%s", f->scene, name) : f->scene);
        rule_option(g, "--model", FOLDER(g, MODEL, .model = model));
        rule_option(g, "--out", FOLDER(g, EXPORT_IFC, .model = model));
    }
}
