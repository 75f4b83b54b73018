/* rules.c - the judgement of the photos, which all qualities share. Nothing reads it but people. */
#include "common/graph/scene_rules.h"

RULES(judge_photos)
{
    graph_step(g, "doctor", STEP_ONE, "matches");
    graph_goal(g, "doctor", NULL);
    if (!scene_matches_photos(g, f) || !f->photos.count) return;
    graph_goal(g, "doctor", PATH(g, JUDGEMENT));
    graph_rule(g, "all");
    rule_shared(g);
    rule_makes(g, PATH(g, JUDGEMENT));
    rule_needs(g, PATH(g, PHOTO_LIST));
    rule_needs_set(g, "features");
    rule_needs_set(g, "matches");
    rule_photos(g, f, "--photos");
    rule_option(g, "--records", FOLDER(g, PHOTO_LIST));
    rule_option(g, "--features", FOLDER(g, FEATURES, .photo = ""));
    rule_option(g, "--matches", FOLDER(g, MATCHES, .photo = ""));
    rule_option(g, "--out", PATH(g, JUDGEMENT));
}
