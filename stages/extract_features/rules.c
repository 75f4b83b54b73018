/* rules.c - the features of each photo, which all qualities share. */
#include "common/graph/scene_rules.h"

RULES(extract_features)
{
    graph_step(g, "features", STEP_FARM, "hdr");
    graph_goal(g, "features", NULL);
    for (int i = 0; scene_matches_photos(g, f) && i < f->photos.count; i++) {
        const char *photo = f->photos.names[i], *out = PATH(g, FEATURES, .photo = photo);
        const char *mask = graph_text(g, "%s/stamp/mask/%s.txt", f->shared, photo);
        graph_piece(g, "%s", photo);
        rule_shared(g);
        rule_makes(g, out);
        rule_needs(g, f->bracketed ? PATH(g, HDR_PICTURE, .photo = photo) : PATH(g, PHOTO, .photo = photo));
        rule_needs(g, path_is_file(mask) ? mask : NULL);
        rule_photos(g, f, "--photos");
        rule_option(g, "--records", FOLDER(g, PHOTO_LIST));
        rule_masks(g, f);
        rule_option(g, "--photo", photo);
        rule_option(g, "--out", out);
        graph_set(g, "features", out);
        graph_goal(g, "features", out);
    }
}
