/* rules.c - the page of a scene, and the page of its remodelled rooms, for the people who live there. */
#include <stdio.h>
#include <string.h>

#include "common/graph/scene_rules.h"

/* The steps of plain make: depth, what the scene asks for, its films, metrics where there is something to compare. */
static const char *steps_before(struct graph *g, const struct scene_facts *f)
{
    const char *steps = "depth";
    if (f->is_pair) return "morph";
    for (int i = 0; i < f->products.count; i++) {
        const char *step = graph_step_of(g, f->products.names[i]);
        if (step && strcmp(f->products.names[i], "parallax")) steps = graph_text(g, "%s %s", steps, step);
    }
    if (f->has_model && scene_asks_for(f, "remodel")) steps = graph_text(g, "%s walk", steps);
    if (f->films.count || *f->choose) steps = graph_text(g, "%s video", steps);
    if (f->compares_held || *scene_setting("TRUTH")) steps = graph_text(g, "%s evaluate", steps);
    return graph_text(g, "%s pan_scan", steps);
}

static void scene_page_rule(struct graph *g, const struct scene_facts *f)
{
    struct name_list stages = {0};
    name_list_add_words(&stages, scene_setting("STAGES"), graph_err(g));
    graph_rule(g, "page");
    rule_makes(g, PATH(g, PAGE));
    if (f->is_pair) {
        rule_needs(g, PATH(g, VIDEO, .film = "parallax/morph"));
    } else {
        rule_needs_cameras(g);
        rule_needs_list(g, GRAPH_SHOWN);
    }
    rule_needs_list(g, GRAPH_ALWAYS_SHOWN);
    rule_needs(g, PATH(g, PHOTO_LIST));
    for (int i = 0; i < stages.count; i++) rule_needs(g, graph_text(g, "%s/slice/%s.cfg", f->own, stages.names[i]));
    rule_needs(g, graph_own(g, "stamp/remodel-page.txt"));
    rule_option(g, "--scene", f->scene);
    rule_option(g, "--folder", f->own);
    rule_option(g, "--shared", f->shared);
    rule_photos(g, f, "--photos");
    rule_option(g, "--defaults", "configs/default.cfg");
    rule_option(g, "--stages", graph_text(g, "'%s'", scene_setting("STAGES")));
    if (f->edits.count) rule_option(g, "--scripts", graph_text(g, "%s/edits", f->folder));
    rule_option(g, "--page", "stages/report/page");
    rule_option(g, "--out", PATH(g, PAGE));
    name_list_release(&stages);
}

static bool says_yes(const char *path)
{
    FILE *f = fopen(path, "r");
    char word[8] = "";
    const bool yes = f && fgets(word, sizeof word, f) && !strncmp(word, "yes", 3);
    if (f) fclose(f);
    return yes;
}

static void remodel_page_rule(struct graph *g, const struct scene_facts *f)
{
    const char *scene_page = graph_own(g, "stamp/scene-page.txt"), *truths = graph_own(g, "evaluate/relit");
    const char *quality = scene_setting("QUALITY");
    struct name_list edits = {0}, true_edits = {0};
    name_list_add_files(&edits, graph_text(g, "%s/edits", f->folder), "", ".txt", graph_err(g));
    name_list_add_files(&true_edits, truths, "", "", graph_err(g));
    graph_rule(g, "remodel");
    rule_makes(g, PATH(g, REMODEL_PAGE));
    if (f->has_model && f->drawn_edits.count && f->views.count) rule_needs_set(g, "pictures");
    rule_needs_list(g, GRAPH_REMODEL_SHOWN);
    for (int i = 0; i < true_edits.count; i++) {
        struct name_list views = {0};
        name_list_add_files(&views, graph_text(g, "%s/%s", truths, true_edits.names[i]), "", ".exr", graph_err(g));
        for (int k = 0; k < views.count; k++)
            rule_needs(g, PATH(g, TRUTH_RELIT, .edit = true_edits.names[i], .view = views.names[k]));
        name_list_release(&views);
    }
    for (int i = 0; i < edits.count; i++) rule_needs(g, graph_text(g, "%s/edits/%s.txt", f->folder, edits.names[i]));
    rule_needs(g, scene_page);
    rule_option(g, "--scene", f->scene);
    rule_option(g, "--folder", f->own);
    rule_option(g, "--shared", f->shared);
    rule_photos(g, f, "--photos");
    rule_option(g, "--remodel", "");
    if (*quality && strcmp(quality, "default")) rule_option(g, "--quality", quality);
    rule_option(g, "--scripts", graph_text(g, "%s/edits", f->folder));
    if (says_yes(scene_page)) rule_option(g, "--back", "../index.html");
    rule_option(g, "--page", "stages/report/page");
    rule_option(g, "--out", PATH(g, REMODEL_PAGE));
    name_list_release(&edits);
    name_list_release(&true_edits);
}

/* The page of light levels, of the edits of this run and of those that have been made. */
static void levels_page_rule(struct graph *g, const struct scene_facts *f)
{
    const char *scene_page = graph_own(g, "stamp/scene-page.txt");
    graph_goal(g, "lux", PATH(g, LEVELS_PAGE));
    graph_rule(g, "levels");
    rule_makes(g, PATH(g, LEVELS_PAGE));
    rule_needs(g, PATH(g, LIGHT_SHEET, .lux = "lux"));
    for (int i = 0; i < f->edits.count; i++) {
        const char *sheet = PATH(g, LIGHT_SHEET, .lux = graph_text(g, "lux/%s", f->edits.names[i]));
        const bool wanted = *scene_setting("EDIT") && name_list_has(&f->drawn_edits, f->edits.names[i]);
        if (wanted || path_is_file(sheet)) rule_needs(g, sheet);
    }
    rule_needs(g, scene_page);
    rule_option(g, "--levels", "");
    rule_option(g, "--scene", f->scene);
    rule_option(g, "--folder", f->own);
    rule_option(g, "--shared", f->shared);
    if (says_yes(scene_page)) rule_option(g, "--back", "../index.html");
    rule_option(g, "--page", "stages/report/page");
    rule_option(g, "--out", PATH(g, LEVELS_PAGE));
    graph_list_if(g, GRAPH_ALWAYS_SHOWN, PATH(g, LEVELS_PAGE), false);
}

RULES(report)
{
    graph_step(g, "report", STEP_ONE, steps_before(g, f));
    graph_goal(g, "report", PATH(g, PAGE));
    if (scene_asks_for(f, "remodel")) graph_goal(g, "report", PATH(g, REMODEL_PAGE));
    graph_goal(g, "remodel-page", PATH(g, REMODEL_PAGE));
    scene_page_rule(g, f);
    remodel_page_rule(g, f);
    if (f->has_model) levels_page_rule(g, f);
}
