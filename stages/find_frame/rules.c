/* rules.c - the frame of the room. */
#include "common/graph/scene_rules.h"

RULES(find_frame)
{
    (void)f;
    graph_step(g, "frame", STEP_ONE, "lines");
    graph_goal(g, "frame", PATH(g, ROOM_FRAME));
    graph_rule(g, "all");
    rule_makes(g, PATH(g, ROOM_FRAME));
    rule_takes_cameras(g);
    rule_needs(g, PATH(g, LENSES));
    rule_needs_set(g, "lines");
    rule_needs(g, PATH(g, PHOTO_LIST));
    rule_option(g, "--records", FOLDER(g, PHOTO_LIST));
    rule_option(g, "--lines", FOLDER(g, LINES, .view = ""));
    rule_option(g, "--out", PATH(g, ROOM_FRAME));
}
