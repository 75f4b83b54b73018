/* rules.c - points from all depth maps. */
#include "common/graph/scene_rules.h"

RULES(fuse_points)
{
    (void)f;
    graph_step(g, "points", STEP_ONE, "depth");
    graph_goal(g, "points", PATH(g, POINTS));
    graph_rule(g, "all");
    rule_makes(g, PATH(g, POINTS));
    rule_needs_cameras(g);
    rule_needs_set(g, "depth");
    rule_option(g, "--views", FOLDER(g, CAMERAS));
    rule_option(g, "--depth", FOLDER(g, DEPTH, .view = ""));
    rule_option(g, "--out", PATH(g, POINTS));
}
