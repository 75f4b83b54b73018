/* rules.c - the page to walk through the rooms. It shows pictures of edits and of new light where they exist, and waits
 * for those that plain make draws. */
#include "common/graph/scene_rules.h"

/* A picture that this run makes, or that stands. */
static void rule_needs_picture(struct graph *g, const char *path, bool wanted)
{
    if (wanted || path_is_file(path)) rule_needs(g, path);
}

static void rule_needs_edit(struct graph *g, const struct scene_facts *f, const char *edit)
{
    const char *model = graph_text(g, "remodel/%s", edit), *relit = graph_text(g, "relight/%s", edit);
    const char *pictures = graph_text(g, "%s/pictures", model);
    const bool drawn = name_list_has(&f->drawn_edits, edit);
    rule_needs(g, PATH(g, MODEL, .model = model));
    rule_needs(g, PATH(g, PLAN, .model = model));
    rule_needs(g, PATH(g, TEXTURE_MAP, .model = model));
    rule_needs(g, PATH(g, OBJECTS, .model = model));
    rule_needs(g, graph_text(g, "%s/edits/%s.txt", f->folder, edit));
    rule_needs_tour(g, graph_text(g, "%s/tour", model));
    for (int i = 0; drawn && i < f->views.count; i++) {
        rule_needs_picture(g, PATH(g, PICTURE_RECORD, .pictures = pictures, .name = f->views.names[i]),
                           scene_asks_for(f, "remodel"));
        rule_needs_picture(g, PATH(g, RELIT_RECORD, .relit = relit, .name = f->views.names[i]), false);
    }
    if (drawn) rule_needs_picture(g, PATH(g, ATLAS, .atlas = graph_text(g, "%s/vita", relit)), false);
}

RULES(walk)
{
    static const char *const parts[] = {"index.html", "walk.css", "space.js",    "model.js",   "load.js",    "draw.js",
                                        "plan.js",    "state.js", "textures.js", "picture.js", "measure.js", "move.js",
                                        "tools.js",   "input.js", "probe.js",    "walk.js"};
    const char *before = "textures outdoors exposure things tour-path";
    if (scene_asks_for(f, "remodel")) before = graph_text(g, "%s remodel", before);
    if (scene_asks_for(f, "relight")) before = graph_text(g, "%s relight", before);
    graph_step(g, "walk", STEP_ONE, before);
    graph_asked(g, "walk", "walk");
    graph_goal(g, "walk", NULL);
    if (!f->has_model || !f->views.count) return;
    graph_goal(g, "walk", PATH(g, WALK_PAGE));
    graph_rule(g, "all");
    rule_makes(g, PATH(g, WALK_PAGE));
    rule_option(g, "--name", f->scene);
    rule_needs(g, PATH(g, MODEL));
    rule_needs(g, PATH(g, PLAN));
    rule_needs_tour(g, "model/tour");
    rule_option(g, "--model", FOLDER(g, MODEL));
    if (f->edits.count) {
        rule_option(g, "--remodel", graph_own(g, "remodel"));
        rule_option(g, "--scripts", graph_text(g, "%s/edits", f->folder));
        rule_option(g, "--meshes", f->folder);
        rule_option(g, "--relight", graph_own(g, "relight"));
    }
    for (int i = 0; i < f->edits.count; i++) {
        rule_needs_edit(g, f, f->edits.names[i]);
        rule_option(g, "--edit", f->edits.names[i]);
    }
    rule_takes(g, "--axes", PATH(g, AXES));
    rule_takes_cameras(g);
    rule_needs(g, PATH(g, LENSES));
    rule_needs_set(g, "views");
    rule_needs_set(g, "vdta");
    rule_takes_vita(g);
    rule_takes_ids(g);
    for (int i = 0; i < f->views.count; i++)
        rule_needs(g, PATH(g, DEPTH, .depth = MODEL_DEPTH, .view = f->views.names[i]));
    rule_option(g, "--depth", FOLDER(g, DEPTH, .depth = MODEL_DEPTH, .view = ""));
    rule_needs(g, PATH(g, THINGS));
    rule_needs(g, PATH(g, THING_VOLUME));
    rule_option(g, "--things", FOLDER(g, THINGS));
    rule_option(g, "--vdta", graph_own(g, "vdta"));
    rule_takes(g, "--outdoors", PATH(g, OUTDOORS));
    rule_takes(g, "--exposure", PATH(g, EXPOSURE));
    rule_after(g, graph_own(g, "stamp/exposure.txt"));
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        rule_needs(g, graph_text(g, "stages/walk/page/%s", parts[i]));
    rule_option(g, "--page", "stages/walk/page");
    rule_option(g, "--out", FOLDER(g, WALK_PAGE));
}
