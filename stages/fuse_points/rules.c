/* rules.c - points from all depth maps. */
#include "common/graph/scene_rules.h"

RULES(fuse_points)
{
    (void)f;
    graph_step(g, "points", STEP_ONE, "depth");
    graph_goal(g, "points", PATH(g, POINTS));
    graph_rule(g, "all");
    rule_makes(g, PATH(g, POINTS));
    rule_takes_cameras(g);
    rule_takes_depth(g);
    rule_option(g, "--out", PATH(g, POINTS));
}
