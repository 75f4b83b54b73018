/* rules.c - the page in which people draw a model. It needs no model: people may begin with it. */
#include <string.h>

#include "common/base/file_path.h"
#include "common/graph/scene_rules.h"

/* Sources of the page, and the code that it runs. */
static const char *const sources[] = {"page.html", "page.css",    "wasi.js",  "live.js",  "script.js", "canvas.js",
                                      "points.js", "photos.js",   "photo.js", "draft.js", "plan.js",   "marks.js",
                                      "masks.js",  "gestures.js", "forms.js", "store.js", "draw.js"};

static void needs_texts(struct graph *g, const struct scene_facts *f)
{
    static const char *const files[] = {"model.txt",    "things.txt",    "objects.txt", "scale.txt",    "lights.txt",
                                        "axes_fix.txt", "materials.txt", "tour.txt",    "subjects.txt", "lri.txt"};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        const char *path = graph_scene_file(g, files[i]);
        rule_needs(g, graph_stamp(g, graph_text(g, "draw-%s", files[i]), path ? path : "none"));
        rule_needs(g, path);
    }
    rule_needs(g, graph_stamp_list(g, "draw-edits.txt", &f->edits));
    for (int i = 0; i < f->edits.count; i++)
        rule_needs(g, graph_text(g, "%s/edits/%s.txt", f->folder, f->edits.names[i]));
    struct name_list meshes = {0};
    name_list_add_files(&meshes, f->folder, "", ".obj", graph_err(g));
    rule_needs(g, graph_stamp_list(g, "draw-meshes.txt", &meshes));
    for (int i = 0; i < meshes.count; i++) rule_needs(g, graph_text(g, "%s/%s.obj", f->folder, meshes.names[i]));
    name_list_release(&meshes);
}

/* A product that may be there: the page shows what it says, and does not wait for it. folder: passed in its place;
 * NULL: the product is. option: NULL: it is passed already. */
static void takes_if_made(struct graph *g, const char *option, const char *path, const char *folder)
{
    const bool is_made = path_is_file(path);
    if (option) rule_needs(g, graph_stamp(g, graph_text(g, "draw-made%s.txt", option + 1), is_made ? "yes" : "none"));
    if (is_made) rule_needs(g, path);
    if (option) rule_option(g, option, is_made ? (folder ? folder : path) : NULL);
}

RULES(draw_model)
{
    const char *wasm = graph_text(g, "%.*swasm/build_model.wasm", (int)(strlen(f->bin) - strlen("bin")), f->bin);
    graph_step(g, "draw", STEP_ONE, "lines suggest");
    graph_goal(g, "draw", PATH(g, DRAW_PAGE));
    graph_rule(g, "page");
    rule_makes(g, PATH(g, DRAW_PAGE));
    rule_makes(g, PATH(g, DRAW_SCENE));
    rule_makes(g, PATH(g, DRAW_POINTS));
    rule_makes(g, PATH(g, DRAW_CODE));
    rule_makes(g, PATH(g, DRAW_PHOTOS));
    rule_takes_cameras(g);
    rule_needs(g, PATH(g, LENSES));
    rule_takes(g, "--axes", PATH(g, AXES));
    rule_takes(g, "--points", PATH(g, POINTS));
    rule_takes(g, "--suggested", PATH(g, SUGGESTED_MODEL));
    /* as far as make lights and make things have made them: this page waits for no lamp and no furniture */
    takes_if_made(g, "--candidates", PATH(g, MARK_CANDIDATES), NULL);
    takes_if_made(g, "--lights", PATH(g, LIGHTS), NULL);
    takes_if_made(g, "--things", PATH(g, THINGS), FOLDER(g, THINGS));
    for (int i = 0; i < f->references.count; i++)
        takes_if_made(g, i ? NULL : "--references", PATH(g, LRI_PICTURE, .photo = f->references.names[i]),
                      FOLDER(g, LRI, .photo = ""));
    rule_needs_set(g, "lines");
    rule_option(g, "--lines", FOLDER(g, LINES, .view = ""));
    rule_takes(g, "--model-config", graph_text(g, "%s/slice/build_model.cfg", f->own));
    for (int i = 0; i < f->viewpoints.count; i++)
        rule_needs(g, scene_photo_source(g, f, f->viewpoints.photos[i].photo));
    rule_photos(g, f, "--photos");
    rule_option(g, "--records", FOLDER(g, PHOTO_LIST));
    needs_texts(g, f);
    for (size_t i = 0; i < sizeof sources / sizeof *sources; i++)
        rule_needs(g, graph_text(g, "stages/draw_model/page/%s", sources[i]));
    rule_takes(g, "--wasm", wasm);
    rule_option(g, "--page", "stages/draw_model/page");
    rule_option(g, "--name", f->scene);
    rule_option(g, "--scene", f->folder);
    rule_option(g, "--out", FOLDER(g, DRAW_PAGE));
}
