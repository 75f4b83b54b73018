/* rules.c - a photo is read once for all of its views that are missing or stale. */
#include "common/graph/scene_rules.h"

/* cameras: the views' folder below O */
static void photo_rule(struct graph *g, const struct scene_facts *f, const struct photo_views *p, const char *cameras,
                       const char *set)
{
    const char *mask = graph_text(g, "%s/stamp/mask/%s.txt", f->shared, p->photo);
    graph_piece(g, "%s%s", scene_model_is_edited(cameras) ? "heldout-" : "", p->photo);
    for (int i = 0; i < p->count; i++) {
        const char *view = PATH(g, VIEW, .views = cameras, .view = p->views[i]);
        rule_makes(g, view);
        graph_set(g, set, view);
        graph_goal(g, "views", view);
    }
    rule_needs(g, scene_photo_source(g, f, p->photo));
    rule_needs(g, PATH(g, CAMERAS, .views = cameras));
    rule_needs(g, PATH(g, IMAGES, .views = cameras));
    rule_needs(g, PATH(g, POINTS3D, .views = cameras));
    rule_needs(g, PATH(g, LENSES, .views = cameras));
    rule_needs(g, path_is_file(mask) ? mask : NULL);
    rule_option(g, "--photo", p->photo);
    rule_photos(g, f, "--photos");
    rule_masks(g, f);
    rule_option(g, "--records", FOLDER(g, PHOTO_LIST));
    rule_option(g, "--views", FOLDER(g, CAMERAS, .views = cameras));
    rule_option(g, "--out", FOLDER(g, CAMERAS, .views = cameras));
    rule_stale(g, STALE_VIEWS);
}

RULES(rectify)
{
    graph_step(g, "views", STEP_FARM, "sfm");
    graph_goal(g, "views", NULL);
    for (int i = 0; i < f->viewpoints.count; i++) photo_rule(g, f, &f->viewpoints.photos[i], "views", "views");
    for (int i = 0; i < f->held_viewpoints.count; i++)
        photo_rule(g, f, &f->held_viewpoints.photos[i], HELD_VIEWS, "held_views");
}
