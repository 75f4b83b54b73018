/* rules.c - lamps that lights.txt marks, and windows as lights. */
#include "common/graph/scene_rules.h"

RULES(fit_lights)
{
    const char *lamps = graph_scene_file(g, "lights.txt");
    graph_step(g, "lights", STEP_ONE, "vita outdoors things");
    graph_goal(g, "lights", NULL);
    if (!f->has_model) return;
    graph_goal(g, "lights", PATH(g, LIGHTS));
    graph_rule(g, "all");
    rule_makes(g, PATH(g, LIGHT_FIT));
    rule_makes(g, PATH(g, LIGHTS));
    rule_takes_seen_model(g);
    rule_takes(g, "--plan", PATH(g, PLAN));
    rule_takes_vita(g);
    rule_takes_things(g, f);
    rule_takes(g, "--outdoors", PATH(g, OUTDOORS));
    if (lamps) rule_needs_references(g, f);
    rule_takes(g, "--lamps", lamps);
    /* a file of marks that came or went is a change whatever its time */
    rule_needs(g, graph_stamp(g, "lamps.txt", lamps ? lamps : "none"));
    if (lamps && scene_has_references(g, f)) rule_option(g, "--references", FOLDER(g, LRI, .photo = ""));
    rule_option(g, "--out", FOLDER(g, LIGHTS));
    graph_list_if(g, GRAPH_ALWAYS_SHOWN, PATH(g, LIGHTS), false);
}
