/* rules.c - the reflectance of materials that materials.txt marks. */
#include "common/graph/scene_rules.h"

RULES(fit_materials)
{
    const char *materials = scene_materials(g, f);
    graph_step(g, "materials", STEP_ONE, "vita outdoors");
    graph_goal(g, "materials", materials);
    if (!materials) return;
    graph_rule(g, "all");
    rule_makes(g, materials);
    rule_makes(g, PATH(g, MATERIAL_SAMPLES));
    rule_takes(g, "--marks", graph_scene_file(g, "materials.txt"));
    rule_takes_seen_model(g);
    rule_takes_vita(g);
    rule_takes(g, "--outdoors", PATH(g, OUTDOORS));
    rule_takes(g, "--lights", scene_lights(g, f));
    rule_option(g, "--out", FOLDER(g, MATERIALS));
    graph_list_if(g, GRAPH_ALWAYS_SHOWN, materials, false);
}
