/* rules.c - metrics of whatever a run makes or finds, against a truth and held-out photos. */
#include "common/graph/scene_rules.h"

/* What a relighting program wrote; no rule makes it. */
static void needs_irradiance(struct graph *g, const char *folder)
{
    static const char *const endings[] = {".exr", ".txt"};
    struct name_list found = {0};
    for (int k = 0; k < 2; k++) {
        name_list_add_files(&found, folder, "", endings[k], graph_err(g));
        for (int i = 0; i < found.count; i++)
            rule_needs(g, graph_text(g, "%s/%s%s", folder, found.names[i], endings[k]));
        name_list_release(&found);
    }
}

static void needs_edited(struct graph *g, const struct scene_facts *f)
{
    const bool made = scene_asks_for_any(f, "model textures remodel");
    struct name_list edited = {0};
    for (int edit = -1; f->has_model && edit < f->edits.count; edit++) {
        const char *model = PATH(g, MODEL, .model = scene_model_folder(g, &f->edits, edit));
        if (made || path_is_file(model)) rule_needs(g, model);
    }
    if (path_is_file(PATH(g, IRRADIANCE))) rule_needs(g, PATH(g, IRRADIANCE));
    needs_irradiance(g, graph_own(g, "relight/irradiance"));
    name_list_add_files(&edited, graph_own(g, "relight"), "edited-", "", graph_err(g));
    for (int i = 0; i < edited.count; i++)
        needs_irradiance(g, graph_text(g, "%s/relight/edited-%s/irradiance", f->own, edited.names[i]));
    name_list_release(&edited);
}

RULES(evaluate)
{
    graph_step(g, "evaluate", STEP_ONE, "depth");
    graph_goal(g, "evaluate", PATH(g, METRICS));
    graph_rule(g, "all");
    rule_makes(g, PATH(g, METRICS));
    rule_needs_cameras(g);
    rule_needs(g, PATH(g, LENSES));
    rule_needs_list(g, GRAPH_MEASURED);
    if (f->holds_out) {
        rule_needs_held_cameras(g);
        rule_needs_set(g, "held_views");
    }
    rule_needs(g, PATH(g, PHOTO_LIST));
    if (*scene_setting("TRUTH")) needs_edited(g, f);
    rule_needs(g, graph_own(g, "stamp/truth.txt"));
    rule_needs(g, graph_own(g, "stamp/rendered.txt"));
    rule_option(g, "--folder", f->own);
    rule_option(g, "--shared", f->shared);
    rule_variable(g, "--truth", "TRUTH");
    if (*scene_setting("RENDERED"))
        rule_variable(g, "--rendered", "RENDERED");
    else
        rule_option(g, "--rendered", graph_own(g, "rendered"));
    rule_option(g, "--out", PATH(g, METRICS));
    if (f->compares_held || *scene_setting("TRUTH")) graph_list(g, GRAPH_SHOWN, PATH(g, METRICS));
}
