/* rules.c - what each view sees of the model and what edits reveal to it, then the index of faces.
 *
 * reveal/VIEW.exr is replaced only if its bytes change, so that its readers are not redone for nothing: Make goes by
 * VIEW.txt, and its next call sees whether VIEW.exr changed. */
#include "common/graph/scene_rules.h"

#include <unistd.h>

static void say_model(struct graph *g)
{
    rule_takes(g, "--model", PATH(g, MODEL));
    rule_takes(g, "--axes", PATH(g, AXES));
    rule_takes_cameras(g);
}

static void ids_rule(struct graph *g, const char *view)
{
    const char *ids = PATH(g, IDS, .view = view), *faces = PATH(g, VIEW_FACES, .view = view);
    graph_piece(g, "%s", view);
    rule_makes(g, faces);
    rule_makes(g, ids);
    say_model(g);
    rule_needs(g, PATH(g, DEPTH, .depth = MODEL_DEPTH, .view = view));
    rule_needs(g, PATH(g, SEGMENTS, .depth = MODEL_DEPTH, .view = view));
    rule_option(g, "--depth", FOLDER(g, DEPTH, .depth = MODEL_DEPTH, .view = view));
    rule_own(g);
    rule_option(g, "--view", view);
    rule_option(g, "--out", ids);
    graph_set(g, "ids", ids);
    graph_goal(g, "ids-views", ids);
    graph_goal(g, "ids-views", faces);
}

static void reveal_rule(struct graph *g, const struct scene_facts *f, const char *view, const char *edits)
{
    const char *reveal = PATH(g, REVEAL, .view = view), *list = PATH(g, REVEAL_LIST, .view = view);
    graph_piece(g, "reveal-%s", view);
    rule_makes(g, list);
    say_model(g);
    rule_option(g, "--reveal", "");
    for (int i = 0; i < f->edits.count; i++) {
        const char *edited = PATH(g, MODEL, .model = scene_model_folder(g, &f->edits, i));
        rule_takes(g, "--edit", edited);
    }
    rule_needs(g, edits);
    if (access(reveal, F_OK)) rule_needs_force(g);
    rule_own(g);
    rule_option(g, "--view", view);
    rule_option(g, "--out", reveal);
    graph_beside(g, reveal, list);
    graph_goal(g, "ids-reveal", reveal);
}

RULES(trace_ids)
{
    graph_step(g, "ids", STEP_FARM, "model_depth");
    graph_goal(g, "ids-views", NULL);
    graph_goal(g, "ids-reveal", NULL);
    graph_goal(g, "ids", "ids-views ids-reveal");
    if (!f->has_model || !f->views.count) return;
    /* an edit that went is a change whatever the times of the others */
    const char *edits = graph_stamp_list(g, "edits.txt", &f->edits);
    for (int i = 0; i < f->views.count; i++) ids_rule(g, f->views.names[i]);
    for (int i = 0; i < f->views.count; i++) reveal_rule(g, f, f->views.names[i], edits);
    graph_goal(g, "ids", PATH(g, FACE_INDEX));
    graph_rule(g, "index");
    rule_makes(g, PATH(g, FACE_INDEX));
    rule_makes(g, PATH(g, FACE_OFFSETS));
    for (int i = 0; i < f->views.count; i++) rule_needs(g, PATH(g, VIEW_FACES, .view = f->views.names[i]));
    say_model(g);
    rule_option(g, "--index", FOLDER(g, FACE_INDEX));
    rule_option(g, "--out", PATH(g, FACE_INDEX));
}
