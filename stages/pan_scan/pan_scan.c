/* pan_scan.c - a camera move in 2D: crops of one photograph that follow the move as closely as crops can.
 *
 * reads   VIEWS/cameras.txt, images.txt, points3D.txt   the views and their sparse points
 *         VIEWS/VIEW.exr                                the view that is shown
 *         DEPTH/VIEW.exr, VIEW.txt                      with --depth: the view's depth
 *         PATH/path.txt, path/NAME.txt                  the move
 * writes  OUT/NNNN.exr                                  one file per frame: R G B A */
#include <stdio.h>
#include <stdlib.h>

#include "common/base/cli.h"
#include "common/base/file_path.h"
#include "common/base/frame_list.h"
#include "common/base/log.h"
#include "common/base/progress.h"
#include "common/capture/view_image.h"
#include "common/image/exr.h"
#include "common/product/product.h"
#include "stages/pan_scan/crop_move.h"
#include "stages/pan_scan/crop_picture.h"
#include "stages/pan_scan/pan_params.h"

#define MIN_BEYOND 0.5 /* frame px beyond the photograph from which a warning is given */

#define PARAM_STRUCT struct pan_params
const struct param pan_param_table[] = {PAN_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

struct job { /* the command line */
    const char *views, *depth, *path, *frames, *out;
    struct pan_params params;
};

static enum status find_view(int *view_idx, const struct job *job, const struct camera_set *set,
                             const struct camera_path *path, struct err *err)
{
    if (!job->params.view[0]) {
        *view_idx = crop_move_choose_view(set, path);
        return ST_OK;
    }
    *view_idx = camera_set_find(set, job->params.view);
    if (*view_idx >= 0) return ST_OK;
    return err_set(err, ST_USAGE, "--view %s: %s/images.txt has no view of this name; its first is %s.",
                   job->params.view, job->views, set->views[0].name);
}

static enum status read_depth(struct layered_depth *depth, const struct job *job, const char *view,
                              struct provenance *prov, struct err *err)
{
    char path[FILE_PATH];
    if (product_path_in(path, job->depth, PRODUCT_DEPTH, &(struct product_key){.view = view}, err) ||
        layered_depth_read_interior(depth, path, prov, err))
        return err->status;
    return ST_OK;
}

/* Reports an end only if this process makes its frame. */
static void log_summary(const struct crop_move *m, const bool *wanted)
{
    static const char *const names[] = {"first", "last"};
    const int frames[] = {0, m->path->frame_count - 1};
    for (int end = 0; end < 2; end++) {
        const struct crop c = crop_move_stored(m, m->ends[end].crop);
        if (!wanted[frames[end]]) continue;
        log_note(
            "the %s frame shows %.0f x %.0f pixels of view %s from (%.0f, %.0f) on; the median error of the scene's "
            "points is %.1f px",
            names[end], c.width, c.height, m->view.name, c.x, c.y, m->misfits[end]);
        if (m->ends[end].beyond > MIN_BEYOND)
            log_warn(
                "the %s frame's crop is held at the border of view %s: following the move would take it %.0f px beyond "
                "the photograph",
                names[end], m->view.name, m->ends[end].beyond);
    }
}

static enum status frame_write(const struct image *frame, const struct crop_move *m, int i, const char *file,
                               const struct provenance *prov, struct err *err)
{
    const size_t pixels = (size_t)frame->width * (size_t)frame->height;
    const struct crop c = crop_move_stored(m, crop_move_crop(m, i));
    struct exr_image im = {0};
    size_t empty = 0;
    double misfit = 0;
    char crop[128];

    exr_init_rgba(&im, frame->data, frame->width, frame->height, err);
    for (size_t p = 0; p < pixels; p++) empty += frame->data[4 * p + 3] < 0.5f;
    if (!err->status) crop_move_misfit(&misfit, m, i, err);
    const double holes = (double)empty / (double)pixels;
    snprintf(crop, sizeof crop, "%.9g %.9g %.9g %.9g", c.x, c.y, c.width, c.height);
    view_image_set_camera(&im, &m->view);
    if (!err->status && !exr_set_number(&im, "remodel:holes", holes, err) &&
        !exr_set_number(&im, "remodel:unfilled", holes, err) &&
        !exr_set_attribute(&im, "remodel:view", m->view.name, err) &&
        !exr_set_attribute(&im, "remodel:crop", crop, err) && !exr_set_number(&im, "remodel:misfit", misfit, err))
        exr_write(&im, file, prov, err);
    exr_image_release(&im);
    return err->status;
}

static enum status make_frames(const struct crop_move *m, const bool *wanted, const struct image *picture,
                               const char *folder, const struct provenance *prov, struct err *err)
{
    const struct view *camera = &m->path->frames[0].camera;
    struct image frame = {0};
    struct progress progress;
    char file[FILE_PATH];
    int count = 0;
    image_init(&frame, camera->width, camera->height, 4, err);
    for (int i = 0; i < m->path->frame_count; i++) count += wanted[i];
    progress_start(&progress, "cropping", count, "frames");
    for (int i = 0; !err->status && i < m->path->frame_count; i++) {
        if (!wanted[i]) continue;
        const struct crop crop = crop_move_crop(m, i);
        if (!product_path_in(file, folder, PRODUCT_PAN_SCAN_FRAME,
                             &(struct product_key){.frame = m->path->frames[i].camera.name}, err) &&
            !crop_picture(&frame, picture, &crop, err))
            frame_write(&frame, m, i, file, prov, err);
        progress_add(&progress, 1);
    }
    progress_end(&progress);
    image_release(&frame);
    return err->status;
}

static enum status pan_scan(const struct job *job, struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    struct camera_path path = {0};
    struct layered_depth depth = {0};
    struct crop_move move = {0};
    struct image picture = {0};
    bool *wanted = NULL;
    int view_idx = 0;
    camera_set_read(&set, job->views, prov, err);

    if (!err->status) camera_path_read(&path, job->path, prov, err);
    if (!err->status) {
        wanted = calloc((size_t)path.frame_count, sizeof *wanted);
        if (wanted)
            frame_list_read(wanted, path.frame_count, job->frames, err);
        else
            err_nomem(err, "the frames of a path", (size_t)path.frame_count);
    }
    if (!err->status) find_view(&view_idx, job, &set, &path, err);
    if (!err->status && job->depth) read_depth(&depth, job, set.views[view_idx].name, prov, err);
    if (!err->status &&
        !crop_move_init(&move, &set, view_idx, job->depth ? &depth : NULL, &path, job->params.tolerance, err) &&
        !view_image_read(&picture, job->views, &set.views[view_idx], prov, err) &&
        !crop_move_turn(&picture, &move, err))
        log_summary(&move, wanted);
    if (!err->status) make_frames(&move, wanted, &picture, job->out, prov, err);
    free(wanted);
    image_release(&picture);
    crop_move_release(&move);
    layered_depth_release(&depth);
    camera_path_release(&path);
    camera_set_release(&set);
    return err->status;
}

int main(int argc, char **argv)
{
    struct job job = {.params = PAN_PARAMS_DEFAULT};
    const char *view = NULL;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Makes a camera move in 2D: crops of one photograph that follow the move as closely as crops can."),
        CLI_STR("views", &job.views, CLI_REQUIRED, "folder of cameras and rectified views"),
        CLI_STR("depth", &job.depth, CLI_OPTIONAL,
                "folder of layered depth maps to fit crops to; without it, the sparse points"),
        CLI_STR("path", &job.path, CLI_REQUIRED, "folder of the move: path.txt and path/"),
        CLI_STR("frames", &job.frames, CLI_REQUIRED, "frames of the move to make, such as 1:30 or 1:30,45"),
        CLI_STR("out", &job.out, CLI_REQUIRED, "folder of the EXR files to write, NNNN.exr"),
        CLI_PARAM("view", &view, "view whose photograph is shown"),
        CLI_PARAMS(pan_param_table, &job.params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;

    if (cli_parse(argc, argv, "pan_scan", opts, &prov, &err) == CLI_RUN) pan_scan(&job, &prov, &err);
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
