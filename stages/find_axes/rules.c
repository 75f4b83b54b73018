/* rules.c - the room's frame, from points and a user's marks. */
#include "common/graph/scene_rules.h"

RULES(find_axes)
{
    (void)f;
    const char *scale = graph_scene_file(g, "scale.txt"), *fix = graph_scene_file(g, "axes_fix.txt");
    graph_step(g, "axes", STEP_ONE, "depth");
    graph_goal(g, "axes", PATH(g, AXES));
    graph_rule(g, "all");
    rule_makes(g, PATH(g, AXES));
    rule_takes_cameras(g);
    rule_needs(g, PATH(g, LENSES));
    rule_needs_set(g, "views");
    rule_takes(g, "--points", PATH(g, POINTS));
    rule_takes(g, "--frame", PATH(g, ROOM_FRAME));
    rule_takes(g, "--scale", scale);
    rule_takes(g, "--fix", fix);
    /* marks that came or went are a change whatever the files' times */
    rule_needs(g, graph_stamp(g, "axes_marks.txt",
                              graph_text(g, "scale %s fix %s", scale ? "yes" : "no", fix ? "yes" : "no")));
    rule_needs(g, PATH(g, PHOTO_LIST));
    rule_option(g, "--records", FOLDER(g, PHOTO_LIST));
    rule_option(g, "--out", PATH(g, AXES));
    graph_list_if(g, GRAPH_SHOWN, PATH(g, AXES), false);
}
