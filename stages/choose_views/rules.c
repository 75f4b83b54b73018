/* rules.c - the views that films are made from are chosen in a step of its own, and written only if the choice is new:
 * films depend on its text and not on the files that it is made from. Hence the stamp, and the choice as a file that no
 * rule makes. */
#include "common/graph/scene_rules.h"

RULES(choose_views)
{
    (void)f;
    const char *drawn = graph_scene_file(g, "subjects.txt"), *done = graph_own(g, "stamp/film_views.txt");
    graph_step(g, "film_views", STEP_ONE, "sfm");
    graph_goal(g, "film_views", done);
    graph_rule(g, "all");
    rule_makes(g, done);
    rule_takes_cameras(g);
    rule_needs(g, PATH(g, LENSES));
    rule_takes(g, "--subjects", drawn);
    /* rectangles that came or went are a change whatever the file's time */
    rule_needs(g, graph_stamp(g, "drawn.txt", drawn ? drawn : "none"));
    if (!path_is_file(PATH(g, FILM_VIEWS))) rule_needs_force(g);
    rule_option(g, "--out", PATH(g, FILM_VIEWS));
    rule_then(g, graph_text(g, "mkdir -p %s && echo done >%s", graph_own(g, "stamp"), done));
    graph_source(g, PATH(g, FILM_VIEWS));
}
