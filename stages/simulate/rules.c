/* rules.c - photographs of a described scene come first; truth and edited scenes on request.
 *
 * photos.mk, which the program makes first, lists the shots (SHOTS), the files of each (SHOT_name), and the cameras
 * whose truth can be rendered. */
#include <string.h>

#include "common/graph/scene_rules.h"

static const char *const kinds[] = {"hdr", "depth", "ids"};

struct described {
    struct name_list shots, witnesses, true_views, objects, edits, edit_views, irradiance_views;
};

static void read_described(struct graph *g, struct described *d, const struct scene_facts *f)
{
    struct err *err = graph_err(g);
    const char *list = PATH(g, SIMULATED_MK);
    (void)(name_list_read(&d->shots, list, "SHOTS", err) || name_list_read(&d->witnesses, list, "WITNESSES", err) ||
           name_list_read(&d->true_views, list, "TRUE_VIEWS", err) ||
           name_list_add_files(&d->objects, f->folder, "", ".obj", err) ||
           name_list_add_words(&d->irradiance_views, scene_setting("IRRADIANCE_VIEWS"), err) ||
           name_list_add_words(&d->edit_views, scene_setting("EDIT_VIEWS"), err) ||
           name_list_add_words(&d->edits, scene_setting("EDIT"), err) ||
           (scene_setting_is("EDITS", "all") ? name_list_add_files(&d->edits, f->folder, "scene-", ".txt", err)
                                             : name_list_add_words(&d->edits, scene_setting("EDITS"), err)));
    name_list_sort(&d->edits);
    const struct name_list *asked[] = {&d->edit_views, &d->irradiance_views};
    for (int k = 0; k < 2; k++)
        for (int i = 0; d->shots.count && i < asked[k]->count; i++)
            if (!name_list_has(&d->true_views, asked[k]->names[i]))
                graph_refuse(g, "EDIT_VIEWS, IRRADIANCE_VIEWS: %s: %s/cameras.txt has no such photo or witness.",
                             asked[k]->names[i], f->folder);
}

static void release_described(struct described *d)
{
    struct name_list *lists[] = {&d->shots, &d->witnesses,  &d->true_views,      &d->objects,
                                 &d->edits, &d->edit_views, &d->irradiance_views};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) name_list_release(lists[i]);
}

/* The description of the scene, or of an edited one. */
static void needs_description(struct graph *g, const struct scene_facts *f, const struct described *d, const char *edit)
{
    if (edit) rule_needs(g, graph_text(g, "%s/scene-%s.txt", f->folder, edit));
    rule_needs(g, graph_text(g, "%s/scene.txt", f->folder));
    rule_needs(g, graph_text(g, "%s/cameras.txt", f->folder));
    for (int i = 0; i < d->objects.count; i++)
        rule_needs(g, graph_text(g, "%s/%s.obj", f->folder, d->objects.names[i]));
    rule_shared(g);
    rule_option(g, "--scene", f->folder);
    rule_option(g, "--out", FOLDER(g, SIMULATED_MK));
}

static void shot_rule(struct graph *g, const struct scene_facts *f, const struct described *d, const char *shot)
{
    struct name_list files = {0};
    name_list_read(&files, PATH(g, SIMULATED_MK), graph_text(g, "SHOT_%s", shot), graph_err(g));
    graph_piece(g, "%s", shot);
    for (int i = 0; i < files.count; i++) {
        const char *path = graph_text(g, "%s/%s", FOLDER(g, SIMULATED_MK), files.names[i]);
        rule_makes(g, path);
        graph_goal(g, "simulated", path);
    }
    needs_description(g, f, d, NULL);
    rule_option(g, "--photo", shot);
    name_list_release(&files);
}

/* Radiance, depth and faces of a camera, in a folder of truth/. */
static void truth_rule(struct graph *g, const struct scene_facts *f, const struct described *d, const char *folder,
                       const char *view, const char *edit, const char *goal)
{
    graph_piece(g, "%s-%s", folder, view);
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        const char *path = graph_text(g, "%s/truth/%s/%s/%s.exr", FOLDER(g, SIMULATED_MK), folder, kinds[k], view);
        rule_makes(g, path);
        graph_goal(g, goal, path);
    }
    needs_description(g, f, d, edit);
    rule_option(g, "--photo", view);
    rule_option(g, "--edit", edit);
    if (!strcmp(folder, "shell")) rule_option(g, "--kind", "shell");
}

static void irradiance_rule(struct graph *g, const struct scene_facts *f, const struct described *d, const char *view,
                            const char *edit, const char *goal)
{
    const char *truth = edit ? graph_text(g, "truth/edited-%s", edit) : "truth";
    const char *path = PATH(g, TRUE_IRRADIANCE, .truth = truth, .name = view);
    if (edit)
        graph_piece(g, "edited-%s-irradiance-%s", edit, view);
    else
        graph_piece(g, "irradiance-%s", view);
    rule_makes(g, path);
    graph_goal(g, goal, path);
    needs_description(g, f, d, edit);
    rule_option(g, "--photo", view);
    rule_option(g, "--kind", "irradiance");
    rule_option(g, "--edit", edit);
}

static void edit_rules(struct graph *g, const struct scene_facts *f, const struct described *d, const char *edit)
{
    const struct name_list *views = d->edit_views.count ? &d->edit_views : &d->true_views;
    const char *truth = graph_text(g, "truth/edited-%s", edit);
    const char *texts[] = {PATH(g, TRUE_SCENE, .truth = truth), PATH(g, TRUE_FACES, .truth = truth),
                           PATH(g, TRUE_IMAGES, .truth = truth)};
    graph_rule(g, "edited-%s", edit);
    for (int i = 0; i < 3; i++) {
        rule_makes(g, texts[i]);
        graph_goal(g, "edited-texts", texts[i]);
    }
    needs_description(g, f, d, edit);
    rule_option(g, "--common", "");
    rule_option(g, "--edit", edit);
    for (int i = 0; i < views->count; i++)
        truth_rule(g, f, d, graph_text(g, "edited-%s", edit), views->names[i], edit, "edited");
    for (int i = 0; i < d->irradiance_views.count; i++)
        irradiance_rule(g, f, d, d->irradiance_views.names[i], edit, "edited");
}

RULES(simulate)
{
    struct described d = {0};
    graph_step(g, "truth", STEP_ONE, "");
    graph_step(g, "edited", STEP_ONE, "");
    graph_goal(g, "simulated", NULL);
    graph_goal(g, "truth", NULL);
    graph_goal(g, "edited", "edited-texts");
    graph_goal(g, "edited-texts", NULL);
    if (!graph_scene_file(g, "scene.txt")) return;
    read_described(g, &d, f);
    graph_rule(g, "common");
    rule_makes(g, PATH(g, SIMULATED_MK));
    needs_description(g, f, &d, NULL);
    rule_option(g, "--common", "");
    for (int i = 0; i < d.shots.count; i++) shot_rule(g, f, &d, d.shots.names[i]);
    for (int i = 0; i < d.witnesses.count; i++) truth_rule(g, f, &d, "novel", d.witnesses.names[i], NULL, "truth");
    for (int i = 0; i < d.true_views.count; i++) truth_rule(g, f, &d, "shell", d.true_views.names[i], NULL, "truth");
    for (int i = 0; i < d.irradiance_views.count; i++)
        irradiance_rule(g, f, &d, d.irradiance_views.names[i], NULL, "truth");
    for (int i = 0; i < d.edits.count; i++) edit_rules(g, f, &d, d.edits.names[i]);
    release_described(&d);
}
