/* rules.c - the lines of each view. */
#include "common/graph/scene_rules.h"

RULES(find_lines)
{
    graph_step(g, "lines", STEP_FARM, "views");
    graph_goal(g, "lines", NULL);
    for (int i = 0; i < f->views.count; i++) {
        const char *view = f->views.names[i], *out = PATH(g, LINES, .view = view);
        graph_piece(g, "%s", view);
        rule_makes(g, out);
        rule_needs(g, PATH(g, VIEW, .view = view));
        rule_takes_cameras(g);
        rule_option(g, "--view", view);
        rule_option(g, "--out", out);
        graph_set(g, "lines", out);
        graph_goal(g, "lines", out);
    }
}
