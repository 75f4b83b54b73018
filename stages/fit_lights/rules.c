/* rules.c - lamps that lights.txt marks, and windows as lights. */
#include "common/graph/scene_rules.h"

RULES(fit_lights)
{
    const char *lamps = graph_scene_file(g, "lights.txt");
    graph_step(g, "lights", STEP_ONE, "vita outdoors");
    graph_goal(g, "lights", NULL);
    if (!f->has_model) return;
    graph_goal(g, "lights", PATH(g, LIGHTS));
    graph_rule(g, "all");
    rule_makes(g, PATH(g, LIGHT_FIT));
    rule_makes(g, PATH(g, LIGHTS));
    rule_needs(g, PATH(g, MODEL));
    rule_needs(g, PATH(g, PLAN));
    rule_needs(g, PATH(g, AXES));
    rule_needs_cameras(g);
    rule_needs(g, PATH(g, LENSES));
    rule_needs_set(g, "views");
    rule_needs_set(g, "ids");
    rule_needs(g, PATH(g, ATLAS));
    rule_needs(g, PATH(g, OUTDOORS));
    if (lamps) rule_needs_references(g, f);
    rule_needs(g, lamps);
    /* a file of marks that came or went is a change whatever its time */
    rule_needs(g, graph_stamp(g, "lamps.txt", lamps ? lamps : "none"));
    rule_option(g, "--lamps", lamps);
    rule_option(g, "--model", PATH(g, MODEL));
    rule_option(g, "--plan", PATH(g, PLAN));
    rule_option(g, "--axes", PATH(g, AXES));
    rule_option(g, "--views", FOLDER(g, CAMERAS));
    rule_option(g, "--ids", FOLDER(g, FACE_INDEX));
    rule_option(g, "--vita", FOLDER(g, ATLAS));
    rule_option(g, "--outdoors", PATH(g, OUTDOORS));
    if (lamps && scene_has_references(g, f)) rule_option(g, "--references", FOLDER(g, LRI, .photo = ""));
    rule_option(g, "--out", FOLDER(g, LIGHTS));
    graph_list_if(g, GRAPH_ALWAYS_SHOWN, PATH(g, LIGHTS), false);
}
