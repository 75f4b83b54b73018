/* rules.c - the model of model.txt, one of each edit, and their edges drawn on photos.
 *
 * Scripts say what else a model is made from: points where they place walls in photographs, the edits that an edit
 * stands on, and the meshes of objects. A script that cannot be read says nothing here; the stage then reports why. */
#include <string.h>

#include "common/graph/scene_rules.h"
#include "stages/build_model/script/script.h"

static const enum product_id model_files[] = {PRODUCT_MODEL, PRODUCT_PLAN, PRODUCT_MERGED, PRODUCT_PLAN_PICTURE,
                                              PRODUCT_MODEL_PICTURE};
enum { MODEL_FILES = sizeof model_files / sizeof *model_files };

static const char *model_file(struct graph *g, enum product_id id, const char *model)
{
    return graph_path(g, id, &(struct product_key){.model = model});
}

/* What scripts ask for. */
struct asked_for {
    bool points;
    struct name_list edits; /* that the edit stands on, itself first */
    struct name_list meshes;
};

static void read_script(struct graph *g, struct asked_for *asked, const char *path)
{
    struct script script = {0};
    struct err unread = ERR_INIT;
    if (script_read(&script, path, &unread)) return;
    for (int i = 0; i < script.count; i++) {
        const struct statement *s = &script.statements[i];
        asked->points |= s->by_points;
        if (s->mesh) name_list_add(&asked->meshes, s->mesh, strlen(s->mesh), graph_err(g));
    }
    if (script.base && !name_list_has(&asked->edits, script.base))
        name_list_add(&asked->edits, script.base, strlen(script.base), graph_err(g));
    script_release(&script);
}

static const char *edit_script(struct graph *g, const struct scene_facts *f, const char *edit)
{
    return graph_text(g, "%s/edits/%s.txt", f->folder, edit);
}

static void release_asked(struct asked_for *asked)
{
    name_list_release(&asked->edits);
    name_list_release(&asked->meshes);
}

/* Whether a script of the scene places something in photographs. */
static bool needs_points(struct graph *g, const struct scene_facts *f)
{
    struct asked_for asked = {0};
    read_script(g, &asked, graph_text(g, "%s/model.txt", f->folder));
    for (int i = 0; i < f->edits.count; i++) read_script(g, &asked, edit_script(g, f, f->edits.names[i]));
    release_asked(&asked);
    return asked.points;
}

static void say_inputs(struct graph *g, const struct scene_facts *f, bool points)
{
    const char *things = graph_scene_file(g, "things.txt");
    rule_takes(g, "--script", graph_scene_file(g, "model.txt"));
    if (things) rule_takes(g, "--things", things);
    rule_needs(g, graph_stamp(g, "things.txt", things ? things : "none"));
    rule_takes(g, "--axes", PATH(g, AXES));
    rule_takes_cameras(g);
    rule_needs(g, PATH(g, LENSES));
    if (f->holds_out) {
        rule_needs_held_cameras(g);
    }
    if (points) rule_needs(g, PATH(g, POINTS));
    if (f->holds_out) rule_option(g, "--held", FOLDER(g, CAMERAS, .views = HELD_VIEWS));
    if (points) rule_option(g, "--points", PATH(g, POINTS));
}

/* The scripts of an edit and the meshes that they name. A mesh that is missing is for build_model to report. */
static void needs_edit(struct graph *g, const struct scene_facts *f, const char *edit)
{
    const char *objects = graph_scene_file(g, "objects.txt");
    struct asked_for asked = {0};
    name_list_add(&asked.edits, edit, strlen(edit), graph_err(g));
    for (int i = 0; i < asked.edits.count; i++) {
        const char *script = edit_script(g, f, asked.edits.names[i]);
        rule_needs(g, path_is_file(script) ? script : NULL);
        read_script(g, &asked, script);
    }
    /* a file that went is a change whatever the times of the others */
    rule_needs(g, graph_stamp(g, "objects.txt", objects ? objects : "none"));
    rule_needs(g, objects);
    if (objects) read_script(g, &asked, objects);
    name_list_sort(&asked.meshes);
    for (int i = 0; i < asked.meshes.count; i++) {
        const char *mesh = graph_scene_file(g, asked.meshes.names[i]);
        if (mesh)
            rule_needs(g, mesh);
        else
            rule_needs_force(g);
    }
    release_asked(&asked);
}

/* edit: -1 for the model itself */
static void model_rule(struct graph *g, const struct scene_facts *f, int edit, bool points)
{
    const char *model = scene_model_folder(g, &f->edits, edit), *name = scene_model_name(model);
    graph_rule(g, "%s", name);
    for (int i = 0; i < MODEL_FILES; i++) {
        const char *path = model_file(g, model_files[i], model);
        rule_makes(g, path);
        graph_goal(g, "model", path);
        graph_list_if(g, GRAPH_ALWAYS_SHOWN, path, scene_asks_for_any(f, "model textures remodel"));
    }
    if (edit >= 0) {
        rule_makes(g, PATH(g, TEXTURE_MAP, .model = model));
        rule_makes(g, PATH(g, OBJECTS, .model = model));
        needs_edit(g, f, name);
        rule_takes(g, "--base", PATH(g, MODEL));
    }
    say_inputs(g, f, points);
    if (edit >= 0) {
        rule_option(g, "--edit", edit_script(g, f, name));
        rule_option(g, "--scene", f->folder);
    }
    rule_option(g, "--out", graph_own(g, model));
    if (path_is_file(PATH(g, SHAPE, .model = model))) graph_source(g, PATH(g, SHAPE, .model = model));
}

/* A model that is built anew often has the same faces: after another paint, say. So an overlay needs its shape.txt,
 * which is written only if they change, where there is one. */
static void needs_shape(struct graph *g, const char *option, const char *model)
{
    const char *shape = PATH(g, SHAPE, .model = model), *path = PATH(g, MODEL, .model = model);
    const bool known = path_is_file(shape);
    rule_needs(g, known ? shape : path);
    if (known) rule_after(g, path);
    rule_option(g, option, path);
}

/* Of an edit, photos that show no difference get a copy of the unedited model's. */
static void overlay_rule(struct graph *g, const struct scene_facts *f, int edit, const char *photo)
{
    const char *model = scene_model_folder(g, &f->edits, edit),
               *path = PATH(g, OVERLAY, .model = model, .photo = photo);
    graph_piece(g, "%s-%s", scene_model_name(model), photo);
    rule_makes(g, path);
    needs_shape(g, "--model", model);
    if (edit >= 0) {
        needs_shape(g, "--base", "model");
        rule_takes(g, "--same", PATH(g, OVERLAY, .model = "model", .photo = photo));
    }
    rule_takes(g, "--axes", PATH(g, AXES));
    rule_takes_cameras(g);
    rule_needs(g, PATH(g, LENSES));
    rule_needs(g, scene_photo_source(g, f, photo));
    rule_option(g, "--overlay", photo);
    rule_photos(g, f, "--photos");
    rule_option(g, "--records", FOLDER(g, PHOTO_LIST));
    rule_option(g, "--out", path);
    if (edit >= 0 && !name_list_has(&f->drawn_edits, scene_model_name(model))) return;
    graph_goal(g, edit < 0 ? "overlays" : "edit-overlays", path);
    graph_list_if(g, GRAPH_ALWAYS_SHOWN, path, scene_asks_for_any(f, "model textures remodel"));
}

RULES(build_model)
{
    const bool modelled = f->has_model && scene_asks_for_any(f, "model textures remodel");
    graph_step(g, "model", STEP_ONE, "depth");
    graph_asked(g, "model", "model");
    graph_goal(g, "model", NULL);
    graph_goal(g, "overlays", NULL);
    graph_goal(g, "edit-overlays", NULL);
    graph_list_if(g, GRAPH_MEASURED, PATH(g, AXES), modelled);
    if (!f->has_model) return;
    graph_list_if(g, GRAPH_MEASURED, PATH(g, PLAN), modelled);
    const bool points = needs_points(g, f);
    for (int edit = -1; edit < f->edits.count; edit++) model_rule(g, f, edit, points);
    for (int i = 0; i < f->edits.count; i++) {
        const char *model = scene_model_folder(g, &f->edits, i);
        graph_goal(g, "model", PATH(g, TEXTURE_MAP, .model = model));
        graph_goal(g, "model", PATH(g, OBJECTS, .model = model));
    }
    for (int edit = -1; edit < f->edits.count; edit++)
        for (int i = 0; i < f->viewpoints.count; i++) overlay_rule(g, f, edit, f->viewpoints.photos[i].photo);
}
