/* rules.c - walks through the rooms of the model and of each edit. */
#include "common/graph/scene_rules.h"

RULES(plan_tour)
{
    static const enum product_id files[] = {PRODUCT_PATH,         PRODUCT_TOUR_PAIRS,  PRODUCT_TOUR_PLAN,
                                            PRODUCT_PATH_CAMERAS, PRODUCT_PATH_IMAGES, PRODUCT_PATH_POINTS};
    const char *script = graph_scene_file(g, "tour.txt");
    graph_step(g, "tour-path", STEP_ONE, "model things");
    graph_goal(g, "tour-path", NULL);
    for (int edit = -1; f->has_model && edit < f->edits.count; edit++) {
        const char *model = scene_model_folder(g, &f->edits, edit), *tour = graph_text(g, "%s/tour", model);
        graph_rule(g, "%s", scene_model_name(model));
        for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
            const char *path = graph_path(g, files[i], &(struct product_key){.film = tour});
            rule_makes(g, path);
            graph_goal(g, "tour-path", path);
        }
        rule_needs(g, PATH(g, MODEL, .model = model));
        rule_needs(g, PATH(g, PLAN, .model = model));
        rule_takes(g, "--axes", PATH(g, AXES));
        rule_takes_cameras(g);
        rule_needs(g, PATH(g, LENSES));
        if (scene_model_is_edited(model)) {
            rule_takes(g, "--map", PATH(g, TEXTURE_MAP, .model = model));
            if (f->views.count) rule_needs(g, PATH(g, THINGS));
            if (f->views.count) rule_option(g, "--things", FOLDER(g, THINGS));
        }
        rule_takes(g, "--script", script);
        rule_option(g, "--model", FOLDER(g, MODEL, .model = model));
        rule_option(g, "--out", graph_own(g, tour));
    }
}
