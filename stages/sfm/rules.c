/* rules.c - SfM: COLMAP on features and matches of the photos, or a given model. */
#include "common/graph/scene_rules.h"

RULES(sfm)
{
    graph_rule(g, "all");
    rule_shared(g);
    rule_makes(g, PATH(g, SFM_MODELS));
    rule_needs(g, PATH(g, PHOTO_LIST));
    rule_needs(g, graph_shared(g, "stamp/sfm_source.txt"));
    for (int i = 0; f->bracketed && i < f->photos.count; i++) {
        rule_after(g, PATH(g, HDR, .photo = f->photos.names[i]));
        rule_after(g, PATH(g, HDR_PICTURE, .photo = f->photos.names[i]));
    }
    rule_photos(g, f, "--photos");
    rule_option(g, "--records", FOLDER(g, PHOTO_LIST));
    rule_option(g, "--out", FOLDER(g, SFM_MODELS));
    if (scene_matches_photos(g, f)) {
        rule_needs_set(g, "features");
        rule_needs_set(g, "matches");
        rule_option(g, "--features", FOLDER(g, FEATURES, .photo = ""));
        rule_option(g, "--matches", FOLDER(g, MATCHES, .photo = ""));
    }
    rule_variable(g, "--model", "SFM");
}
