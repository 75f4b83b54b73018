/* render_views.c - renders the frames of a camera move, or of given cameras, from layered depth maps.
 *
 * reads   VIEWS/cameras.txt, images.txt, points3D.txt   the views
 *         FILM_VIEWS                                    with --film-views: the views that are used
 *         DEPTH/VIEW.exr, VIEW.txt                      layers and segments of every view that is used
 *         PATH/path.txt, path/NAME.txt                  the move; or
 *         CAMERAS/cameras.txt, images.txt, points3D.txt cameras of any size, e.g. of held-out views
 *         EFFECTS.txt                                   effect layers of a move
 * writes  OUT/NNNN.exr                                  one file per frame: R G B A, Z; or
 *         OUT/CAMERA.exr                                one file per camera: R G B A, Z, hole */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/frame_list.h"
#include "common/film/film_views.h"
#include "stages/render_views/frames.h"

struct render_job { /* the command line */
    const char *views, *film_views, *depth, *path, *frames, *cameras, *picture, *crop, *scale, *out;
    struct cli_list names;
    struct cli_list effects; /* files */
    struct frame_part part;
    struct render_params params;
};

static enum status render_path(const struct render_job *job, struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    struct camera_path path = {0};
    struct layer_scene scene = {0};
    struct effects effects = {0}, more = {0};
    struct renderer renderer = {0};
    bool *wanted = NULL;
    camera_set_read(&set, job->views, prov, err);

    if (!err->status) camera_path_read(&path, job->path, prov, err);
    for (int i = 0; !err->status && i < path.frame_count; i++)
        frame_part_camera(&path.frames[i].camera, &job->part, err);
    if (!err->status) {
        wanted = calloc((size_t)path.frame_count + 1, sizeof *wanted);
        if (wanted)
            frame_list_read(wanted, path.frame_count, job->frames, err);
        else
            err_nomem(err, "the frames of a path", (size_t)path.frame_count);
    }
    for (int i = 0; !err->status && i < job->effects.count; i++) {
        if (!effects_read(&more, job->effects.items[i], prov, err)) effects_append(&effects, &more, err);
        effects_release(&more);
    }
    if (!err->status && !film_views_keep(&set, job->film_views, prov, err) &&
        !layer_scene_read(&scene, &set, job->depth, prov, err))
        renderer_match_exposures(&scene, &job->params, err);
    if (!err->status) {
        renderer_init(&renderer, &scene, &path, &effects, &job->params);
        renderer.half_sphere = job->picture && !strcmp(job->picture, "half_sphere");
        frames_render(&path, wanted, &renderer, job->out, prov, err);
    }
    free(wanted);
    renderer_release(&renderer);
    effects_release(&effects);
    layer_scene_release(&scene);
    camera_path_release(&path);
    camera_set_release(&set);
    return err->status;
}

static enum status render_cameras(const struct render_job *job, struct provenance *prov, struct err *err)
{
    static const struct effects none = {0};
    struct camera_set set = {0}, cameras = {0};
    struct layer_scene scene = {0};
    struct renderer renderer = {0};
    bool *wanted = NULL;
    camera_set_read(&set, job->views, prov, err);

    if (!err->status) camera_set_read(&cameras, job->cameras, prov, err);
    for (int i = 0; !err->status && i < cameras.view_count; i++) frame_part_camera(&cameras.views[i], &job->part, err);
    if (!err->status) {
        wanted = calloc((size_t)cameras.view_count + 1, sizeof *wanted);
        if (wanted)
            frame_select_cameras(wanted, &cameras, job->names.items, job->names.count, err);
        else
            err_nomem(err, "cameras", (size_t)cameras.view_count);
    }
    if (!err->status && !layer_scene_read(&scene, &set, job->depth, prov, err))
        renderer_match_exposures(&scene, &job->params, err);
    if (!err->status) {
        renderer_init(&renderer, &scene, NULL, &none, &job->params);
        frame_render_cameras(&cameras, wanted, &renderer, job->out, prov, err);
    }
    free(wanted);
    renderer_release(&renderer);
    layer_scene_release(&scene);
    camera_set_release(&cameras);
    camera_set_release(&set);
    return err->status;
}

static enum status render(struct render_job *job, struct provenance *prov, struct err *err)
{
    const bool cameras = job->cameras;

    if (cameras ? job->path || job->frames : !job->path || !job->frames || job->names.count)
        return err_set(err, ST_USAGE, "wanted either --path and --frames, or --cameras; --camera goes with --cameras.");
    if (cameras && job->effects.count)
        return err_set(err, ST_USAGE,
                       "--effects goes with --path: single cameras have no time, which the effects' keys need.");
    if (cameras && job->film_views)
        return err_set(err, ST_USAGE, "--film-views goes with --path: single cameras are rendered from all views.");
    if (job->picture && strcmp(job->picture, "flat") != 0 && strcmp(job->picture, "half_sphere") != 0)
        return err_set(err, ST_USAGE, "--picture %s: wanted flat or half_sphere.", job->picture);
    if (cameras && job->picture)
        return err_set(err, ST_USAGE, "--picture goes with --path: frames of single cameras are flat.");
    if (job->crop && job->picture && !strcmp(job->picture, "half_sphere"))
        return err_set(err, ST_USAGE, "--crop goes with flat pictures: of a half-sphere --scale alone is possible.");
    if (frame_part_read(&job->part, job->crop, job->scale, err)) return err->status;
    return cameras ? render_cameras(job, prov, err) : render_path(job, prov, err);
}

int main(int argc, char **argv)
{
    struct render_job job = {.params = RENDER_PARAMS_DEFAULT};
    const char *renderer = NULL;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Renders the frames of a camera move, or of given cameras, from layered depth maps."),
        CLI_STR("views", &job.views, CLI_REQUIRED, "folder of the views' cameras"),
        CLI_STR("film-views", &job.film_views, CLI_OPTIONAL,
                "views that the move is rendered from (choose_views); default: all"),
        CLI_STR("depth", &job.depth, CLI_REQUIRED, "folder of layered depth maps"),
        CLI_STR("path", &job.path, CLI_OPTIONAL, "folder of the move: path.txt and path/"),
        CLI_STR("frames", &job.frames, CLI_OPTIONAL, "frames of the move to render: 1:30 or 1:30,45"),
        CLI_LIST("effects", &job.effects, CLI_OPTIONAL, "file of effect layers applied to the frames of the move"),
        CLI_STR("cameras", &job.cameras, CLI_OPTIONAL,
                "instead of a move: folder of cameras, of which one frame each is rendered"),
        CLI_LIST("camera", &job.names, CLI_OPTIONAL, "with --cameras: render only the camera of this name"),
        CLI_STR("picture", &job.picture, CLI_OPTIONAL,
                "what a frame of the move shows: flat, a pinhole picture (default), or half_sphere, 180 degrees"),
        CLI_STR("crop", &job.crop, CLI_OPTIONAL, "part of the frames to render: X,Y,WIDTH,HEIGHT, px"),
        CLI_STR("scale", &job.scale, CLI_OPTIONAL, "scale factor of the frames, applied after --crop"),
        CLI_STR("out", &job.out, CLI_REQUIRED, "folder of the EXR files to write, NNNN.exr or CAMERA.exr"),
        CLI_PARAM("renderer", &renderer, "rendering method: offline (best quality) or fast"),
        CLI_PARAMS(render_param_table, &job.params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;

    if (cli_parse(argc, argv, "render_views", opts, &prov, &err) == CLI_RUN) render(&job, &prov, &err);
    err_report(&err);
    cli_list_release(&job.names);
    cli_list_release(&job.effects);
    provenance_release(&prov);
    return err_exit_code(&err);
}
