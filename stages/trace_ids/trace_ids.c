/* trace_ids.c - which faces of the solid model each view shows, how far they are, and where furniture hides them.
 *
 * With several --view, as many --out; the model and the cameras are read once for all of them.
 *
 * reads   MODEL, AXES                                   the solid model and its frame
 *         VIEWS/cameras.txt, images.txt                 the cameras
 *         DEPTH/VIEW.exr, VIEW.txt                      the view's layered depth
 * writes  VIEW.txt beside OUT                           the faces that the view shows
 *         OUT                                           face id, depth, distance from depth jumps, clutter
 * With --reveal instead:
 * reads   MODEL, AXES, VIEWS; EDIT, ...                 the edited models
 * writes  OUT, only if its bytes change                 surfaces that some edit reveals in the view
 *         VIEW.txt beside OUT                           how many pixels each edit reveals
 * With --index instead:
 * reads   MODEL, AXES, VIEWS; IDS/VIEW.txt of all views
 * writes  IDS/offsets.txt                               where the photographs say that faces are
 *         OUT                                           the views of each face, best first
 *
 * --estimate prints what views will take instead, and reads nothing but the cameras. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/log.h"
#include "common/base/memory_text.h"
#include "common/model/scene_inputs.h"
#include "common/product/product.h"
#include "stages/trace_ids/face_offsets.h"
#include "stages/trace_ids/reveal.h"
#include "stages/trace_ids/trace_estimate.h"
#include "stages/trace_ids/view_ranks.h"

#define PARAM_STRUCT struct trace_params
const struct param trace_param_table[] = {TRACE_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

struct job {
    const char *model, *axes, *views, *depth, *index, *estimate;
    bool reveal;
    struct cli_list view, out, edits;
    struct trace_params params;
    struct provenance prov;
    struct model_rays rays, *edited; /* edited: a model for each of edits; owned */
    struct scene_inputs in;
};

static enum status read_inputs(struct job *j, struct err *err)
{
    const struct scene_files files = {.views = j->views, .axes = j->axes};
    if (model_rays_read(&j->rays, j->model, MODEL_WITH_GLASS, &j->prov, err)) return err->status;
    return scene_inputs_read(&j->in, SCENE_CAMERAS | SCENE_AXES, &files, &j->prov, err);
}

/* The name of an edit, from .../E/model.txt. */
static void edit_name(char name[FILE_PATH], const char *path)
{
    const char *end = strrchr(path, '/'), *begin = end;
    while (begin && begin > path && begin[-1] != '/') begin--;
    snprintf(name, FILE_PATH, "%.*s", end ? (int)(end - begin) : 0, begin ? begin : "");
}

static enum status read_edits(struct job *j, struct err *err)
{
    const size_t n = (size_t)j->edits.count;
    if (!(j->edited = calloc(n + 1, sizeof *j->edited))) return err_nomem(err, "models", n * sizeof *j->edited);
    for (size_t i = 0; i < n; i++) {
        if (model_rays_read(&j->edited[i], j->edits.items[i], MODEL_WITH_GLASS, &j->prov, err)) return err->status;
    }
    return ST_OK;
}

static void release_inputs(struct job *j)
{
    for (int i = 0; j->edited && i < j->edits.count; i++) model_rays_release(&j->edited[i]);
    free(j->edited);
    scene_inputs_release(&j->in);
    model_rays_release(&j->rays);
}

static enum status find_view(const struct view **view, const struct job *j, const char *name, struct err *err)
{
    const int at = camera_set_find(&j->in.set, name);
    if (at < 0) return err_set(err, ST_DATA, "%s/images.txt has no view %s.", j->views, name);
    *view = &j->in.set.views[at];
    return ST_OK;
}

static enum status read_depth(struct layered_depth *depth, struct job *j, const struct view *view, struct err *err)
{
    char path[FILE_PATH];
    if (product_path_in(path, j->depth, PRODUCT_DEPTH, &(struct product_key){.view = view->name}, err) ||
        layered_depth_read(depth, path, &j->prov, err))
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

static enum status trace_view(void *ctx, int i, struct err *err)
{
    struct job *j = ctx;
    const int shared = j->prov.count;
    const char *out = j->out.items[i];
    struct layered_depth depth = {0};
    struct view_trace trace = {0};
    struct view_ids ids = {0};
    struct view_record record = {0};
    const struct view *view = NULL;
    char text[FILE_PATH];
    if (!record_path(text, out, err) && !find_view(&view, j, j->view.items[i], err) &&
        !read_depth(&depth, j, view, err))
        view_trace(&trace, &j->rays, &j->in.axes, view, err);
    if (!err->status && trace.in_solid)
        log_warn("the camera of view %s is inside a solid of the model, or on its surface: the view shows no face.",
                 view->name);
    if (!err->status && !view_ids_init(&ids, view->width, view->height, err)) view_trace_ids(&ids, &trace);
    if (!err->status && !view_jumps_find(&ids, &trace, &depth, &j->params, err) &&
        !view_clutter_find(&ids, &trace, &depth, j->in.axes.scale, &j->params, err) &&
        !view_record_make(&record, &ids, &trace, &depth, &j->params, err) &&
        !view_record_write(&record, text, &j->prov, err))
        view_ids_write(&ids, view, out, &j->prov, err);
    provenance_keep(&j->prov, shared);
    view_record_release(&record);
    view_ids_release(&ids);
    view_trace_release(&trace);
    layered_depth_release(&depth);
    return err->status;
}

/* Adds what one edit reveals, and a line to the record. */
static enum status add_edit(struct reveal *r, FILE *record, const struct job *j, const struct view *view, int edit,
                            struct err *err)
{
    struct view_trace trace = {0};
    char name[FILE_PATH], quoted[FILE_PATH];
    int64_t pixels = 0;
    edit_name(name, j->edits.items[edit]);
    if (!view_trace(&trace, &j->edited[edit], &j->in.axes, view, err) && !reveal_add(r, &trace, &pixels, err) &&
        !textfile_quote(name, quoted, sizeof quoted, err))
        fprintf(record, "edit %s %" PRId64 "\n", quoted, pixels);
    view_trace_release(&trace);
    return err->status;
}

static enum status write_reveal(const struct reveal *r, const struct job *j, const struct view *view, const char *out,
                                struct err *err)
{
    /* without inputs and parameters: the bytes change only with what is revealed */
    const struct provenance prov = {.stage = j->prov.stage, .version = j->prov.version};
    struct view_reveal result = {0};
    bool changed = false;
    if (!reveal_result(&result, r, err)) view_reveal_write(&result, view, out, &prov, &changed, err);
    if (!err->status && !changed) log_note("%s: what edits reveal has not changed", view->name);
    view_reveal_release(&result);
    return err->status;
}

static enum status write_reveal_record(const struct job *j, const char *path, const char *lines, struct err *err)
{
    struct outfile f = {0};
    product_begin(&f, PRODUCT_REVEAL_LIST, path, &j->prov, err);
    if (!err->status) {
        fputs(lines, f.fp);
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}

static enum status reveal_view(void *ctx, int i, struct err *err)
{
    const struct job *j = ctx;
    struct view_trace trace = {0};
    struct reveal reveal = {.base = &trace};
    const struct view *view = NULL;
    char text[FILE_PATH];
    struct memory_text lines = {0};
    if (!memory_text_open(&lines, "a record", err)) record_path(text, j->out.items[i], err);
    if (!err->status && !find_view(&view, j, j->view.items[i], err))
        view_trace(&trace, &j->rays, &j->in.axes, view, err);
    for (int e = 0; !err->status && e < j->edits.count; e++) add_edit(&reveal, lines.to, j, view, e, err);
    if (!err->status) memory_text_close(&lines, "a record", err);
    if (!err->status && !write_reveal(&reveal, j, view, j->out.items[i], err))
        write_reveal_record(j, text, lines.text, err);
    memory_text_release(&lines);
    reveal_release(&reveal);
    view_trace_release(&trace);
    return err->status;
}

/* Warns if no camera is within the model's bounding box: then the axes or the model are wrong. */
static void warn_if_outside(const struct job *j)
{
    int within = 0;
    for (int i = 0; i < j->in.set.view_count; i++)
        within += model_rays_near(&j->rays, model_from_world_view(&j->in.axes, &j->in.set.views[i]).center);
    if (!within && j->in.set.view_count)
        log_warn("all %d cameras are outside the model, so no view shows its rooms from within; check axes.txt, the "
                 "scale and the script of the model.",
                 j->in.set.view_count);
}

static enum status index_faces(struct job *j, struct err *err)
{
    struct view_ranks ranks = {.max_views = j->params.index_views};
    struct face_offsets offsets = {0};
    char path[FILE_PATH];
    int empty = 0;
    warn_if_outside(j);
    for (int i = 0; !err->status && i < j->in.set.view_count; i++) {
        struct view_record record = {0};
        const struct product_key key = {.view = j->in.set.views[i].name};
        if (!product_path_in(path, j->index, PRODUCT_VIEW_FACES, &key, err) &&
            !view_record_read(&record, path, NULL, err))
            view_ranks_add(&ranks, j->in.set.views[i].name, &record, err);
        if (!err->status) face_offsets_add(&offsets, &record, err);
        empty += !err->status && !record.count;
        view_record_release(&record);
    }
    if (!err->status && !product_path_in(path, j->index, PRODUCT_FACE_OFFSETS, NULL, err) &&
        !face_offsets_write(&offsets, &j->rays, &j->in.axes, path, &j->prov, err))
        view_ranks_write(&ranks, j->out.items[0], &j->prov, err);
    if (!err->status && empty) log_note("%d of %d views show no face of the model", empty, j->in.set.view_count);
    face_offsets_release(&offsets);
    view_ranks_release(&ranks);
    return err->status;
}

static enum status check_usage(const struct job *j, struct err *err)
{
    if (j->estimate && (j->view.count || j->reveal || j->index))
        return err_set(err, ST_USAGE, "--estimate excludes --view, --reveal and --index.");
    if (j->estimate) return ST_OK;
    if (j->reveal && j->index) return err_set(err, ST_USAGE, "--reveal and --index exclude each other.");
    if (j->edits.count && !j->reveal) return err_set(err, ST_USAGE, "--edit is only for --reveal.");
    if (!j->index && !j->view.count) return err_set(err, ST_USAGE, "--view is missing; see --help.");
    if (!j->index && !j->reveal && !j->depth) return err_set(err, ST_USAGE, "--depth is missing; see --help.");
    if (j->out.count != (j->index ? 1 : j->view.count))
        return err_set(err, ST_USAGE, "found %d --view and %d --out; give an --out for each view, or one for --index.",
                       j->view.count, j->out.count);
    return ST_OK;
}

static enum status estimate(struct job *j, struct err *err)
{
    return camera_set_read_cameras(&j->in.set, j->views, NULL, err) ||
                   estimate_print(stdout, j->estimate, &j->in.set, j->views, j->edits.count, err)
               ? err->status
               : ST_OK;
}

static enum status run(struct job *j, struct err *err)
{
    if (j->estimate) return estimate(j, err);
    if (read_inputs(j, err) || read_edits(j, err)) return err->status;
    if (j->index) return index_faces(j, err);
    return cli_make_each(&j->view, j->reveal ? reveal_view : trace_view, j, err);
}

int main(int argc, char **argv)
{
    struct job j = {.params = TRACE_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Face ids, depth, depth jumps and clutter of the solid model in a view."),
        CLI_STR("model", &j.model, CLI_REQUIRED, "model.txt of the unedited model"),
        CLI_STR("axes", &j.axes, CLI_REQUIRED, "the model's frame, axes.txt"),
        CLI_STR("views", &j.views, CLI_REQUIRED, "folder of cameras"),
        CLI_LIST("view", &j.view, CLI_OPTIONAL, "view to trace; repeat for several"),
        CLI_STR("depth", &j.depth, CLI_OPTIONAL, "folder of the views' depth"),
        CLI_FLAG("reveal", &j.reveal, "find what edits reveal in the view, in place of its ids"),
        CLI_LIST("edit", &j.edits, CLI_OPTIONAL, "with --reveal, or --estimate: model.txt of an edited model"),
        CLI_STR("index", &j.index, CLI_OPTIONAL, "folder of the views' lists of faces: index them, in place of a view"),
        CLI_LIST("out", &j.out, CLI_REQUIRED,
                 "EXR to write, with a list beside it, one for each --view; with --index the index"),
        CLI_STR("estimate", &j.estimate, CLI_OPTIONAL,
                "file with lines VIEW ids and VIEW reveal: traces nothing, but prints the time and memory that these "
                "will take"),
        CLI_PARAMS(trace_param_table, &j.params, NULL),
        CLI_END,
    };
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "trace_ids", opts, &j.prov, &err) != CLI_RUN || check_usage(&j, &err) || run(&j, &err))
        err_report(&err);
    release_inputs(&j);
    cli_list_release(&j.view);
    cli_list_release(&j.out);
    cli_list_release(&j.edits);
    provenance_release(&j.prov);
    return err_exit_code(&err);
}
