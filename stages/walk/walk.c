/* walk.c - a page in which the rooms can be walked through, before and after each edit [Colburn 2014, 4.6].
 *
 * reads   MODEL/, REMODEL/E/                         model.txt, plan.txt, texture.txt, objects.txt, tour/
 *         AXES                                       their frame in the scene
 *         VIEWS/cameras.txt, images.txt, lenses.txt  the cameras
 *         VIEWS/VIEW.exr, IDS/VIEW.exr, DEPTH/VIEW.exr, THINGS/  photographs, and the furniture that they show
 *         VDTA/PHOTO/, VITA/                         texture atlases
 *         OUTDOORS                                   what lies outside
 *         EXPOSURE                                   the exposure of all pictures of the scene
 *         REMODEL/E/pictures, RELIGHT/E/             pictures of the edited rooms, in the old and in the new light
 *         PAGE/                                      the parts of the page
 * writes  OUT/scene.js, vita.js, texture/PHOTO.js, ...  the data, as scripts
 *         OUT/index.html                             the page, last */
#include "common/base/cli.h"
#include "common/base/log.h"
#include "stages/walk/page_file.h"
#include "stages/walk/walk_data.h"

static const struct param walk_param_table[] = {
#define PARAM_STRUCT struct walk_params
    WALK_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

static enum status make_walk(const struct walk_files *files, const struct walk_params *params, struct provenance *prov,
                             struct err *err)
{
    struct walk_scene scene = {0};
    int64_t bytes = 0;
    if (!files->ids != !files->depth) return err_set(err, ST_USAGE, "--ids and --depth go together.");
    if (files->edits.count && !files->remodel)
        return err_set(err, ST_USAGE, "--edit wants --remodel, the folder of the edits.");
    if (!walk_scene_read(&scene, files, params, prov, err) && !walk_data_write(&scene, prov, &bytes, err) &&
        !page_file_write(files->page, files->out, files->name, &bytes, err))
        log_note("a walk past %d photos, with %d edits, %.1f MB", scene.place_count, scene.model_count - 1,
                 1e-6 * (double)bytes);
    walk_scene_release(&scene);
    return err->status;
}

int main(int argc, char **argv)
{
    struct walk_files files = {0};
    struct walk_params params = WALK_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("A page in which the rooms can be walked through, before and after each edit."),
        CLI_STR("name", &files.name, CLI_REQUIRED, "name of the scene, for the title"),
        CLI_STR("model", &files.model, CLI_REQUIRED, "folder of the unedited model"),
        CLI_STR("remodel", &files.remodel, CLI_OPTIONAL, "folder of the edited models"),
        CLI_LIST("edit", &files.edits, CLI_OPTIONAL, "show this edit, too; repeat for several"),
        CLI_STR("scripts", &files.scripts, CLI_OPTIONAL, "folder of the edits' scripts, whose comments the page shows"),
        CLI_STR("meshes", &files.meshes, CLI_OPTIONAL, "folder of the meshes of synthetic objects"),
        CLI_STR("axes", &files.axes, CLI_REQUIRED, "the models' frame, axes.txt"),
        CLI_STR("views", &files.views, CLI_REQUIRED, "folder of cameras and rectified views"),
        CLI_STR("vdta", &files.vdta, CLI_REQUIRED, "folder of the viewpoints' texture atlases"),
        CLI_STR("vita", &files.vita, CLI_REQUIRED, "folder of the atlas of all faces"),
        CLI_STR("ids", &files.ids, CLI_OPTIONAL, "for furniture: folder of the faces that each view shows"),
        CLI_STR("depth", &files.depth, CLI_OPTIONAL, "for furniture: folder of layered depth maps"),
        CLI_STR("things", &files.things, CLI_OPTIONAL,
                "for edits that clear, move or copy things: folder of find_things"),
        CLI_STR("relight", &files.relight, CLI_OPTIONAL, "folder of relit atlases and pictures"),
        CLI_STR("outdoors", &files.outdoors, CLI_OPTIONAL, "picture of what lies outside, outdoors.exr"),
        CLI_STR("exposure", &files.exposure, CLI_OPTIONAL,
                "the exposure of all pictures, exposure.txt of choose_exposure; default: 1"),
        CLI_STR("page", &files.page, CLI_REQUIRED, "folder of the page's parts: index.html and what it names"),
        CLI_STR("out", &files.out, CLI_REQUIRED, "folder to write to"),
        CLI_PARAMS(walk_param_table, &params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "walk", opts, &prov, &err) == CLI_RUN) make_walk(&files, &params, &prov, &err);
    err_report(&err);
    cli_list_release(&files.edits);
    provenance_release(&prov);
    return err_exit_code(&err);
}
