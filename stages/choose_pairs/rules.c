/* rules.c - the pairs of photos that are compared, which all qualities share. */
#include "common/graph/scene_rules.h"

RULES(choose_pairs)
{
    graph_step(g, "pairs", STEP_ONE, "features");
    graph_goal(g, "pairs", NULL);
    if (!scene_matches_photos(g, f) || !f->photos.count) return;
    graph_goal(g, "pairs", PATH(g, PAIRS));
    graph_rule(g, "all");
    rule_shared(g);
    rule_makes(g, PATH(g, PAIRS));
    rule_needs(g, PATH(g, PHOTO_LIST));
    rule_needs_set(g, "features");
    rule_option(g, "--records", FOLDER(g, PHOTO_LIST));
    rule_option(g, "--features", FOLDER(g, FEATURES, .photo = ""));
    rule_option(g, "--out", PATH(g, PAIRS));
}
