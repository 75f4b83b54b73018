/* rules.c - the SfM model becomes the cameras of views, in the run's own folder; with a hold-out those that are held
 * out get a folder of their own. */
#include <string.h>

#include "common/graph/scene_rules.h"

static void check_holdout(struct graph *g)
{
    const char *every = scene_setting("HOLDOUT"), *views = scene_setting("HOLDOUT_VIEWS");
    const size_t digits = strspn(every, "0123456789");
    if (*every && (every[digits] || digits > 9 || *every == '0'))
        graph_refuse(g, "HOLDOUT=%s: wanted a number: every how many photos one is held out.", every);
    if (*every && *views) graph_refuse(g, "HOLDOUT and HOLDOUT_VIEWS are both given; give one of them.");
    if (views[strspn(views, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_@ -")])
        graph_refuse(g, "HOLDOUT_VIEWS=%s: names of photos and views are letters, digits, _, - and @.", views);
}

/* Photos to hold out by name: those that people want to compare, and those in other light. */
static const char *held_names(struct graph *g, const struct scene_facts *f)
{
    const char *names = scene_setting("HOLDOUT_VIEWS");
    for (int i = 0; i < f->other_light.count; i++)
        names = *names ? graph_text(g, "%s %s", names, f->other_light.names[i]) : f->other_light.names[i];
    return names;
}

RULES(sfm_import)
{
    check_holdout(g);
    const char *stamp = graph_stamp(
        g, "holdout.txt",
        f->holds_out ? graph_text(g, "every %s\nviews %s", scene_setting("HOLDOUT"), held_names(g, f)) : NULL);
    graph_step(g, "sfm", STEP_ONE, "matches");
    graph_goal(g, "sfm", PATH(g, VIEWS_MK));
    graph_rule(g, "all");
    rule_makes(g, PATH(g, CAMERAS));
    rule_makes(g, PATH(g, IMAGES));
    rule_makes(g, PATH(g, POINTS3D));
    rule_makes(g, PATH(g, LENSES));
    rule_makes(g, PATH(g, RESIDUALS));
    rule_makes(g, PATH(g, LENS_FORMS));
    rule_makes(g, PATH(g, VIEWS_MK));
    if (f->holds_out) {
        rule_makes(g, PATH(g, CAMERAS, .views = HELD_VIEWS));
        rule_makes(g, PATH(g, IMAGES, .views = HELD_VIEWS));
        rule_makes(g, PATH(g, POINTS3D, .views = HELD_VIEWS));
        rule_makes(g, PATH(g, LENSES, .views = HELD_VIEWS));
        rule_makes(g, PATH(g, VIEWS_MK, .views = HELD_VIEWS));
    }
    rule_needs(g, PATH(g, SFM_MODELS));
    rule_needs(g, PATH(g, PHOTO_LIST));
    rule_needs(g, graph_shared(g, "stamp/photo_sizes.txt"));
    if (f->holds_out) rule_needs(g, stamp);
    rule_option(g, "--sfm", FOLDER(g, SFM_MODELS));
    rule_option(g, "--records", FOLDER(g, PHOTO_LIST));
    rule_option(g, "--out", FOLDER(g, CAMERAS));
    if (*scene_setting("SPLIT")) rule_option(g, "--split", scene_setting("SPLIT"));
    if (*scene_setting("HOLDOUT")) rule_option(g, "--holdout", scene_setting("HOLDOUT"));
    if (*held_names(g, f)) rule_option(g, "--holdout-views", graph_text(g, "'%s'", held_names(g, f)));
}
