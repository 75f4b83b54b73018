/* rules.c - the matches of each photo, which all qualities share. A program keeps the pairs whose features have not
 * changed, so a rule may need the features of all photos. */
#include "common/graph/scene_rules.h"

RULES(match_photos)
{
    graph_step(g, "matches", STEP_FARM, "pairs");
    graph_goal(g, "matches", NULL);
    for (int i = 0; scene_matches_photos(g, f) && i < f->photos.count; i++) {
        const char *photo = f->photos.names[i], *out = PATH(g, MATCHES, .photo = photo);
        graph_piece(g, "%s", photo);
        rule_shared(g);
        rule_makes(g, out);
        rule_needs_set(g, "features");
        rule_takes(g, "--pairs", PATH(g, PAIRS));
        rule_option(g, "--features", FOLDER(g, FEATURES, .photo = photo));
        rule_option(g, "--photo", photo);
        rule_option(g, "--out", out);
        graph_set(g, "matches", out);
        graph_goal(g, "matches", out);
    }
}
