/* render_model.c - draws the model, or an edited model, under its photographic texture [Colburn 2014, 4.6, 4.7].
 *
 * reads   MODEL, BASE, MAP                              model.txt; of an edit also the unedited one, and texture.txt
 *         AXES                                          their frame in the scene
 *         VIEWS/cameras.txt, images.txt, lenses.txt     the cameras
 *         VIEWS/VIEW.exr, IDS/VIEW.exr, DEPTH/VIEW.exr  pixels, faces and layers of the views that are used
 *         VDTA/PHOTO/, VITA/                            texture atlases
 *         OUTDOORS                                      what lies outside
 *         EXPOSURE                                      the exposure of all pictures of the scene
 *         CAMERAS/cameras.txt, images.txt               with --cameras: the cameras to draw from
 *         PATH/path.txt, path/, pairs.txt               with --path: a film
 * writes  OUT/VIEW.txt, VIEW.jpg, VIEW.exr              of each --view
 *         OUT/NAME.exr, NAME.jpg, NAME.txt              of each camera
 *         OUT/NNNN.exr                                  of each frame */
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/file_path.h"
#include "common/base/frame_list.h"
#include "common/capture/picture_estimate.h"
#include "common/product/product.h"
#include "stages/render_model/room_pictures.h"

static const struct param render_model_param_table[] = {
#define PARAM_STRUCT struct render_model_params
    RENDER_MODEL_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

struct job { /* the command line */
    struct room_files files;
    struct render_model_params params;
    struct cli_list views, names;
    struct camera_source cameras;
    const char *frame, *path, *frames, *out;
};

static enum status read_usage(struct job *job, struct err *err)
{
    const int kinds = (job->views.count > 0) + (job->cameras.folder != NULL) + (job->path != NULL);
    if (kinds != 1) return err_set(err, ST_USAGE, "wanted one of --view, --cameras and --path; see --help.");
    if (job->names.count && !job->cameras.folder) return err_set(err, ST_USAGE, "--camera goes with --cameras.");
    if (!job->path != !job->frames) return err_set(err, ST_USAGE, "--path and --frames go together.");
    if (!job->files.base != !job->files.map) return err_set(err, ST_USAGE, "--base and --map go together.");
    if (!job->files.ids != !job->files.depth) return err_set(err, ST_USAGE, "--ids and --depth go together.");
    if (!job->frame || !strcmp(job->frame, "scene"))
        job->cameras.frame = FRAME_SCENE;
    else if (!strcmp(job->frame, "model"))
        job->cameras.frame = FRAME_MODEL;
    else
        return err_set(err, ST_USAGE, "--frame %s: wanted scene or model.", job->frame);
    if (!job->cameras.photos) return ST_OK;
    if (job->frame) return err_set(err, ST_USAGE, "wanted either --frame or --frame-of, not both.");
    if (!job->cameras.records) return err_set(err, ST_USAGE, "--frame-of also needs --records.");
    job->cameras.frame = FRAME_PHOTOS;
    return ST_OK;
}

static enum status render_film(struct job *job, struct room *room, struct provenance *prov, struct err *err)
{
    struct camera_path path = {0};
    struct viewpoint_pairs pairs = {0};
    bool *wanted = NULL;
    char file[FILE_PATH];
    if (!camera_path_read(&path, job->path, prov, err)) product_path_in(file, job->path, PRODUCT_TOUR_PAIRS, NULL, err);
    const bool paired = !err->status && path_is_file(file);
    if (!err->status && paired) viewpoint_pairs_read(&pairs, file, prov, err);
    if (!err->status) {
        wanted = calloc((size_t)path.frame_count + 1, sizeof *wanted);
        if (wanted)
            frame_list_read(wanted, path.frame_count, job->frames, err);
        else
            err_nomem(err, "the frames of a film", (size_t)path.frame_count);
    }
    if (!err->status) pictures_of_frames(room, &path, paired ? &pairs : NULL, wanted, job->out, prov, err);
    free(wanted);
    viewpoint_pairs_release(&pairs);
    camera_path_release(&path);
    return err->status;
}

static enum status render(struct job *job, struct provenance *prov, struct err *err)
{
    struct room room = {0};
    if (!read_usage(job, err)) room_open(&room, &job->files, &job->params, prov, err);
    if (!err->status && job->views.count)
        pictures_of_views(&room, &job->views, job->out, prov, err);
    else if (!err->status && job->path)
        render_film(job, &room, prov, err);
    else if (!err->status)
        pictures_of_cameras(&room, &job->cameras, &job->names, job->out, prov, err);
    room_close(&room);
    return err->status;
}

/* Measured on loft, photos of three pictures of 853 x 853 px at draft: 2.7 to 3.9 core-seconds and 500 to 570 MiB a
 * photo, 15 MB. */
static const struct picture_cost drawing = {
    .process_seconds = 0.5, .seconds = 1.3, .process_mib = 380, .mib = 220, .bytes = 7e6};

int main(int argc, char **argv)
{
    const char *to_estimate = NULL;
    struct job job = {.params = RENDER_MODEL_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Draws the model, or an edited model, under its photographic texture."),
        CLI_STR("model", &job.files.model, CLI_REQUIRED, "the model to draw, model.txt"),
        CLI_STR("base", &job.files.base, CLI_OPTIONAL, "of an edited model: model.txt of the unedited one"),
        CLI_STR("map", &job.files.map, CLI_OPTIONAL, "of an edited model: its texture.txt"),
        CLI_STR("axes", &job.files.axes, CLI_REQUIRED, "the models' frame, axes.txt"),
        CLI_STR("views", &job.files.views, CLI_REQUIRED, "folder of cameras and rectified views"),
        CLI_STR("vdta", &job.files.vdta, CLI_REQUIRED, "folder of the viewpoints' texture atlases"),
        CLI_STR("vita", &job.files.vita, CLI_REQUIRED, "folder of the atlas of all faces"),
        CLI_STR("ids", &job.files.ids, CLI_OPTIONAL, "for clutter: folder of the faces that each view shows"),
        CLI_STR("depth", &job.files.depth, CLI_OPTIONAL, "for clutter: folder of layered depth maps"),
        CLI_STR("things", &job.files.things, CLI_OPTIONAL,
                "for an edit that clears, moves or copies things: folder of find_things"),
        CLI_STR("outdoors", &job.files.outdoors, CLI_OPTIONAL, "picture of what lies outside, outdoors.exr"),
        CLI_STR("exposure", &job.files.exposure, CLI_OPTIONAL,
                "the exposure of all pictures, exposure.txt of choose_exposure; default: 1"),
        CLI_LIST("view", &job.views, CLI_OPTIONAL, "draw this original view; repeat for several"),
        CLI_STR("cameras", &job.cameras.folder, CLI_OPTIONAL,
                "instead: draw the cameras of this folder (COLMAP text, any lens)"),
        CLI_LIST("camera", &job.names, CLI_OPTIONAL, "with --cameras: draw only the camera of this name"),
        CLI_STR("frame", &job.frame, CLI_OPTIONAL, "with --cameras: their frame: scene (default) or model"),
        CLI_STR("frame-of", &job.cameras.photos, CLI_OPTIONAL,
                "with --cameras: a COLMAP text model in their frame that has the scene's photographs"),
        CLI_STR("records", &job.cameras.records, CLI_OPTIONAL, "with --frame-of: folder of the photos' records"),
        CLI_STR("path", &job.path, CLI_OPTIONAL, "instead: draw frames of the film of this folder, path.txt and path/"),
        CLI_STR("frames", &job.frames, CLI_OPTIONAL, "frames of the film to draw: 1:30 or 1:30,45"),
        CLI_STR("estimate", &to_estimate, CLI_OPTIONAL,
                "instead: print what processes will take, of a file with a line \"process NAME...\" for each"),
        CLI_STR("out", &job.out, CLI_REQUIRED, "folder to write to"),
        CLI_PARAMS(render_model_param_table, &job.params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "render_model", opts, &prov, &err) == CLI_RUN) {
        if (to_estimate)
            picture_estimate_print(stdout, to_estimate, job.files.views, &drawing, &err);
        else
            render(&job, &prov, &err);
    }
    err_report(&err);
    cli_list_release(&job.views);
    cli_list_release(&job.names);
    provenance_release(&prov);
    return err_exit_code(&err);
}
