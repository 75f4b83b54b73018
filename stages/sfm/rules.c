/* rules.c - SfM runs once for a set of photos: COLMAP is not reproducible, so a changed photo or mask, or another
 * program, does not redo it; make resfm does. */
#include "common/graph/scene_rules.h"

RULES(sfm)
{
    graph_step(g, "resfm", STEP_ONE, "hdr");
    graph_rule(g, "all");
    rule_shared(g);
    rule_ignores_code(g);
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
    rule_masks(g, f);
    rule_variable(g, "--model", "SFM");
}
