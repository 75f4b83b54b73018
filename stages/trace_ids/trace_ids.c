/* trace_ids.c - which faces of the solid model each view shows, how far they are, and where furniture hides them.
 *
 * reads   MODEL, AXES                                   the solid model and its frame
 *         VIEWS/cameras.txt, images.txt, points3D.txt   the cameras
 *         DEPTH/VIEW.exr, VIEW.txt                      the view's layered depth
 * writes  VIEW.txt beside OUT                           the faces that the view shows
 *         OUT                                           face id, depth, distance from depth jumps, clutter */
#include <stdio.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "stages/trace_ids/view_record.h"

#define PARAM_STRUCT struct trace_params
const struct param trace_param_table[] = {TRACE_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

struct job {
    const char *model, *axes, *views, *view, *depth, *out;
    struct trace_params params;
    struct provenance prov;
    struct model_rays rays;
    struct model_axes frame;
    struct camera_set set;
};

static enum status read_inputs(struct job *j, struct err *err)
{
    if (provenance_add_file(&j->prov, "model/model.txt", j->model, err) ||
        model_rays_read(&j->rays, j->model, MODEL_WITH_GLASS, err) ||
        provenance_add_file(&j->prov, "model/axes.txt", j->axes, err) || model_axes_read(&j->frame, j->axes, err) ||
        camera_set_add_inputs(&j->prov, j->views, err) || camera_set_read(&j->set, j->views, err))
        return err->status;
    return ST_OK;
}

static enum status find_view(const struct view **view, const struct job *j, struct err *err)
{
    const int at = camera_set_find(&j->set, j->view);
    if (at < 0) return err_set(err, ST_DATA, "%s/images.txt has no view %s.", j->views, j->view);
    *view = &j->set.views[at];
    return ST_OK;
}

static enum status read_depth(struct layered_depth *depth, struct job *j, const struct view *view, struct err *err)
{
    char path[FILE_PATH];
    if (provenance_add_in(&j->prov, "depth", j->depth, view->name, ".txt", path, err) ||
        provenance_add_in(&j->prov, "depth", j->depth, view->name, ".exr", path, err) ||
        layered_depth_read(depth, path, err))
        return err->status;
    if (depth->width == view->width && depth->height == view->height) return ST_OK;
    return err_set(err, ST_DATA, "%s is %d x %d px, but the view is %d x %d px; make the depth again.", path,
                   depth->width, depth->height, view->width, view->height);
}

/* OUT with .txt in place of .exr */
static enum status record_path(char path[FILE_PATH], const char *out, struct err *err)
{
    const size_t n = strlen(out);
    if (n < 5 || strcmp(out + n - 4, ".exr") || n >= FILE_PATH)
        return err_set(err, ST_USAGE, "--out %s: wanted a name that ends in .exr.", out);
    snprintf(path, FILE_PATH, "%.*s.txt", (int)n - 4, out);
    return ST_OK;
}

static enum status trace_view(struct job *j, struct err *err)
{
    struct layered_depth depth = {0};
    struct view_trace trace = {0};
    struct view_ids ids = {0};
    struct view_record record = {0};
    const struct view *view = NULL;
    char text[FILE_PATH];
    enum status st = record_path(text, j->out, err);
    if (!st) st = read_inputs(j, err);
    if (!st) st = find_view(&view, j, err);
    if (!st) st = read_depth(&depth, j, view, err);
    if (!st) st = view_trace(&trace, &j->rays, &j->frame, view, err);
    if (!st && trace.in_solid)
        log_warn("the camera of view %s is inside a solid of the model, or on its surface: the view shows no face.",
                 view->name);
    if (!st) st = view_ids_init(&ids, view->width, view->height, err);
    if (!st) view_trace_ids(&ids, &trace);
    if (!st) st = find_jumps(&ids, &trace, &depth, &j->params, err);
    if (!st) st = find_clutter(&ids, &trace, &depth, &j->params, err);
    if (!st) st = view_record_make(&record, &ids, &trace, &j->params, err);
    if (!st) st = view_record_write(&record, text, &j->prov, err);
    if (!st) st = view_ids_write(&ids, view, j->out, &j->prov, err);
    view_record_release(&record);
    view_ids_release(&ids);
    view_trace_release(&trace);
    layered_depth_release(&depth);
    return st;
}

int main(int argc, char **argv)
{
    struct job j = {.params = TRACE_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Face ids, depth, depth jumps and clutter of the solid model in a view."),
        CLI_STR("model", &j.model, CLI_REQUIRED, "model.txt of the unedited model"),
        CLI_STR("axes", &j.axes, CLI_REQUIRED, "the model's frame, axes.txt"),
        CLI_STR("views", &j.views, CLI_REQUIRED, "folder of cameras"),
        CLI_STR("view", &j.view, CLI_REQUIRED, "view to trace"),
        CLI_STR("depth", &j.depth, CLI_REQUIRED, "folder of the views' depth"),
        CLI_STR("out", &j.out, CLI_REQUIRED, "EXR to write; the faces' list is written beside it"),
        CLI_PARAMS(trace_param_table, &j.params, NULL),
        CLI_END,
    };
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "trace_ids", opts, &j.prov, &err) != CLI_RUN || trace_view(&j, &err)) err_report(&err);
    camera_set_release(&j.set);
    model_rays_release(&j.rays);
    provenance_release(&j.prov);
    return err_exit_code(&err);
}
