/* rules.c - faces, or the rectangles that a user drew. */
#include "common/graph/scene_rules.h"

RULES(find_subjects)
{
    (void)f;
    const char *drawn = graph_scene_file(g, "subjects.txt");
    graph_step(g, "subjects", STEP_ONE, "depth film_views");
    graph_goal(g, "subjects", PATH(g, SUBJECTS));
    graph_rule(g, "all");
    rule_makes(g, PATH(g, SUBJECTS));
    rule_takes_cameras(g);
    rule_needs(g, PATH(g, LENSES));
    if (drawn)
        rule_needs(g, drawn);
    else
        rule_needs_set(g, "views");
    rule_takes_depth(g);
    rule_takes(g, "--film-views", PATH(g, FILM_VIEWS));
    rule_needs(g, graph_stamp(g, "drawn.txt", drawn ? drawn : "none"));
    rule_after(g, graph_own(g, "stamp/film_views.txt"));
    rule_option(g, "--records", FOLDER(g, PHOTO_LIST));
    rule_option(g, "--subjects", drawn);
    rule_option(g, "--out", PATH(g, SUBJECTS));
}
