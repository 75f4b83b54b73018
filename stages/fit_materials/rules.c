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
    rule_needs(g, graph_scene_file(g, "materials.txt"));
    rule_needs(g, PATH(g, MODEL));
    rule_needs(g, PATH(g, AXES));
    rule_needs_cameras(g);
    rule_needs(g, PATH(g, LENSES));
    rule_needs_set(g, "views");
    rule_needs_set(g, "ids");
    rule_needs(g, PATH(g, ATLAS));
    rule_needs(g, PATH(g, OUTDOORS));
    rule_needs(g, scene_lights(g, f));
    rule_option(g, "--marks", graph_scene_file(g, "materials.txt"));
    rule_option(g, "--model", PATH(g, MODEL));
    rule_option(g, "--axes", PATH(g, AXES));
    rule_option(g, "--views", FOLDER(g, CAMERAS));
    rule_option(g, "--ids", FOLDER(g, FACE_INDEX));
    rule_option(g, "--vita", FOLDER(g, ATLAS));
    rule_option(g, "--outdoors", PATH(g, OUTDOORS));
    rule_option(g, "--lights", scene_lights(g, f));
    rule_option(g, "--out", FOLDER(g, MATERIALS));
    graph_list_if(g, GRAPH_ALWAYS_SHOWN, materials, false);
}
