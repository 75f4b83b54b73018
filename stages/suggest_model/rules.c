/* rules.c - a first model script, on request. */
#include "common/graph/scene_rules.h"

RULES(suggest_model)
{
    (void)f;
    graph_step(g, "suggest", STEP_ONE, "depth");
    graph_goal(g, "suggest", PATH(g, SUGGESTED_MODEL));
    graph_rule(g, "all");
    rule_makes(g, PATH(g, SUGGESTED_MODEL));
    rule_makes(g, PATH(g, SUGGESTED_PLAN));
    rule_takes(g, "--axes", PATH(g, AXES));
    rule_takes_cameras(g);
    rule_needs_set(g, "views");
    rule_takes_depth(g);
    rule_takes(g, "--points", PATH(g, POINTS));
    rule_takes(g, "--frame", PATH(g, ROOM_FRAME));
    rule_option(g, "--picture", PATH(g, SUGGESTED_PLAN));
    rule_option(g, "--out", PATH(g, SUGGESTED_MODEL));
}
