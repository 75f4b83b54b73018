/* render_views.c - the frames of a camera move, or of given cameras, from layered depth maps.
 *
 * reads   VIEWS/cameras.txt, images.txt, points3D.txt   the views
 *         DEPTH/VIEW.exr, VIEW.txt                      layers and segments of every view
 *         PATH/path.txt, path/NAME.txt                  the move; or
 *         CAMERAS/cameras.txt, images.txt, points3D.txt cameras of any sizes, such as those of views that are held out
 * writes  OUT/NNNN.exr                                  a file a frame: R G B A, Z; or
 *         OUT/CAMERA.exr                                the same and hole, a file a camera */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/cli.h"
#include "stages/render_views/frames.h"

static enum status add_input(struct provenance *prov, const char *prefix, const char *folder, const char *file,
                             struct err *err)
{
    char path[4096], name[512];
    snprintf(name, sizeof name, "%s/%s", prefix, file);
    if (snprintf(path, sizeof path, "%s/%s", folder, file) >= (int)sizeof path)
        return err_set(err, ST_IO, "the path %s/%s is too long.", folder, file);
    return provenance_add_file(prov, name, path, err);
}

static enum status add_inputs(struct provenance *prov, const char *views, const char *path_folder, const char *effect,
                              struct err *err)
{
    static const char *const view_files[] = {"cameras.txt", "images.txt", "points3D.txt"};
    static const char *const path_files[] = {"path.txt", "path/cameras.txt", "path/images.txt"};
    char prefix[128];
    enum status st = ST_OK;

    snprintf(prefix, sizeof prefix, "parallax/%s", effect);
    for (int i = 0; !st && i < 3; i++) st = add_input(prov, "views", views, view_files[i], err);
    for (int i = 0; !st && i < 3; i++) st = add_input(prov, prefix, path_folder, path_files[i], err);
    return st;
}

static enum status render_path(const char *views, const char *depth, const char *path_folder, const char *list,
                               const char *out, const struct render_params *params, struct provenance *prov,
                               struct err *err)
{
    struct camera_set set = {0};
    struct camera_path path = {0};
    struct layer_scene scene = {0};
    bool *wanted = NULL;
    enum status st = camera_set_read(&set, views, err);

    if (!st) st = camera_path_read(&path, path_folder, err);
    if (!st) {
        wanted = calloc((size_t)path.frame_count + 1, sizeof *wanted);
        st = wanted ? frames_select(wanted, path.frame_count, list, err)
                    : err_nomem(err, "the frames of a path", (size_t)path.frame_count);
    }
    if (!st) st = add_inputs(prov, views, path_folder, path.effect, err);
    if (!st) st = layer_scene_read(&scene, &set, depth, prov, err);
    if (!st) st = frames_render(&path, wanted, &scene, params, out, prov, err);
    free(wanted);
    layer_scene_release(&scene);
    camera_path_release(&path);
    camera_set_release(&set);
    return st;
}

static enum status render_cameras(const char *views, const char *depth, const char *folder,
                                  const struct cli_list *names, const char *out, const struct render_params *params,
                                  struct provenance *prov, struct err *err)
{
    static const char *const files[] = {"cameras.txt", "images.txt", "points3D.txt"};
    struct camera_set set = {0}, cameras = {0};
    struct layer_scene scene = {0};
    bool *wanted = NULL;
    enum status st = camera_set_read(&set, views, err);

    if (!st) st = camera_set_read(&cameras, folder, err);
    if (!st) {
        wanted = calloc((size_t)cameras.view_count + 1, sizeof *wanted);
        st = wanted ? cameras_select(wanted, &cameras, names->items, names->count, err)
                    : err_nomem(err, "cameras", (size_t)cameras.view_count);
    }
    for (int i = 0; !st && i < 3; i++) st = add_input(prov, "views", views, files[i], err);
    for (int i = 0; !st && i < 2; i++) st = add_input(prov, "cameras", folder, files[i], err);
    if (!st) st = layer_scene_read(&scene, &set, depth, prov, err);
    if (!st) st = cameras_render(&cameras, wanted, &scene, params, out, prov, err);
    free(wanted);
    layer_scene_release(&scene);
    camera_set_release(&cameras);
    camera_set_release(&set);
    return st;
}

int main(int argc, char **argv)
{
    const char *views = NULL, *depth = NULL, *path = NULL, *frames = NULL, *cameras = NULL, *out = NULL;
    struct cli_list names = {0};
    struct render_params params = RENDER_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Renders the frames of a camera move, or of given cameras, from layered depth maps."),
        CLI_STR("views", &views, CLI_REQUIRED, "folder of cameras"),
        CLI_STR("depth", &depth, CLI_REQUIRED, "folder of layered depth maps"),
        CLI_STR("path", &path, CLI_OPTIONAL, "folder of the move: path.txt and path/"),
        CLI_STR("frames", &frames, CLI_OPTIONAL, "frames of the move to render: 1:30 or 1:30,45"),
        CLI_STR("cameras", &cameras, CLI_OPTIONAL, "in place of a move: folder of cameras, a frame each"),
        CLI_LIST("camera", &names, CLI_OPTIONAL, "of these cameras only this one; may be given several times"),
        CLI_STR("out", &out, CLI_REQUIRED, "folder of the EXR files to write, NNNN.exr or CAMERA.exr"),
        CLI_PARAMS(render_param_table, &params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;

    enum cli_verdict verdict = cli_parse(argc, argv, "render_views", opts, &prov, &err);

    if (verdict == CLI_RUN && (cameras ? path || frames : !path || !frames || names.count))
        err_set(&err, ST_USAGE, "wanted either --path with --frames, or --cameras; --camera goes with --cameras.");
    else if (verdict == CLI_RUN && cameras)
        render_cameras(views, depth, cameras, &names, out, &params, &prov, &err);
    else if (verdict == CLI_RUN)
        render_path(views, depth, path, frames, out, &params, &prov, &err);
    err_report(&err);
    cli_list_release(&names);
    provenance_release(&prov);
    return err_exit_code(&err);
}
