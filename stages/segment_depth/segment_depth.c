/* segment_depth.c - layered depth of one view by multi-view segment matching.
 *
 * reads   VIEWS/cameras.txt, images.txt, points3D.txt   the cameras and sparse points
 *         VIEWS/VIEW.exr                                the view and the neighbours it selects, linear RGBA
 *         BEFORE/VIEW.exr, VIEW.txt, VIEW.round         with --before: depth of the view and its neighbours
 *         GIVEN/VIEW.exr, .png, .pfm, .tif, depth.txt   with --given: known depth, where there is any
 *         VIEWS/lenses.txt                              for given depth in the photo's pixels
 *         VIEWS/lenses.txt, RECORDS/ID.txt              with --records: the upper sides of the photos
 *         FRAME                                         with --frame: what straight edges show of the room
 *         MODEL, AXES                                   with --model: the solid model and its frame
 * writes  DEPS                                          make dependencies: the pictures that were read
 *         OUT with .round for .exr                      how much the depth changed in this round
 *         OUT with .txt for .exr, then OUT              segments; layers interior.* and boundary.* (RGBA, Z, id)
 *
 * --estimate prints the time and memory that depth will take instead; it reads cameras and points only. --foresee
 * prints between which times it will lie, from the sizes of the photos alone.
 *
 * Each file appears whole or not at all, OUT last: if it is new, so are the others. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/cli.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/base/make_deps.h"
#include "common/capture/upright.h"
#include "common/capture/view_image.h"
#include "common/product/product.h"
#include "stages/segment_depth/depth_estimate.h"
#include "stages/segment_depth/depth_rounds.h"
#include "stages/segment_depth/given_check.h"
#include "stages/segment_depth/given_depth.h"
#include "stages/segment_depth/given_read.h"
#include "stages/segment_depth/view_depth.h"

struct views_folder {
    const char *folder, *before, *given;
    const struct camera_set *set;
    struct provenance *prov;
};

static enum status read_view(void *ctx, int view_idx, struct image *im, struct err *err)
{
    const struct views_folder *f = ctx;
    const struct view *view = &f->set->views[view_idx];
    return view_image_read(im, f->folder, view, f->prov, err);
}

static enum status read_depth(void *ctx, int view_idx, struct layered_depth *d, struct err *err)
{
    const struct views_folder *f = ctx;
    const char *name = f->set->views[view_idx].name;
    char path[FILE_PATH];
    return product_path_in(path, f->before, PRODUCT_DEPTH, &(struct product_key){.view = name}, err) ||
                   layered_depth_read_ids(d, path, f->prov, err)
               ? err->status
               : ST_OK;
}

#define INSIDE_OUT (-0.3) /* rank correlation below which given depth falls where the points' depth rises */
#define UNRELATED  0.3    /* below which it hardly depends on it */

/* Whether the given depth may be used, as its view's sparse points say; makes depth of relative disparity. Warns in the
 * first round only. */
static enum status check_given(bool *usable, struct given *g, const struct views_folder *f, int view_idx,
                               struct err *err)
{
    const struct view *view = &f->set->views[view_idx];
    struct observed_points seen = {0};
    double ranks = NAN;
    bool fits = true;
    neighbours_find_points(&seen, f->set, view_idx, err);
    if (!err->status && g->relative) given_check_fit(&fits, g->z, view->width, view->height, &seen, err);
    if (!err->status && fits) given_check_ranks(&ranks, g->z, view->width, view->height, &seen, err);
    neighbours_release_points(&seen);
    *usable = fits && !(ranks < INSIDE_OUT);
    if (err->status || f->before) return err->status;
    if (!fits)
        log_warn(
            "the disparity given for view %s in %s has no scale, and none agrees with the view's sparse points; the "
            "view is matched as if there were none. Write the line \"scale NUMBER\" into %s/depth.txt, where depth "
            "is NUMBER divided by a sample.",
            view->name, f->given, f->given);
    else if (!*usable)
        log_warn(
            "the depth given for view %s in %s falls where that of its sparse points rises (rank correlation %.2f), "
            "so it seems to be %s; the view is matched as if there were none. Write the line \"samples %s\" into "
            "%s/depth.txt.",
            view->name, f->given, ranks, g->disparity ? "depth, not disparity" : "disparity, inverse depth",
            g->disparity ? "depth" : "disparity", f->given);
    else if (ranks < UNRELATED)
        log_warn(
            "the depth given for view %s in %s hardly follows that of its sparse points (rank correlation %.2f): it "
            "may be of another picture.",
            view->name, f->given, ranks);
    return ST_OK;
}

/* The depth of the only view of a scene: its scale is free, so that the nearest surfaces are at 1. */
static enum status scale_lone(struct given *g, const struct views_folder *f, const struct view *view, struct err *err)
{
    double farthest = 0;
    bool known = false;
    if (given_check_lone(&known, &farthest, g->z, view->width, view->height, g->relative, err)) return err->status;
    if (known && !f->before)
        log_note(
            "%s is the only view, so the scale of its depth is free: the nearest surfaces are taken to be at 1, the "
            "farthest at %.3g%s",
            view->name, farthest, farthest >= LONE_FARTHEST ? ", the limit" : "");
    return ST_OK;
}

/* *z: the view's given depth; NULL if there is none, or none that may be used. */
static enum status read_given(void *ctx, int view_idx, float **z, struct err *err)
{
    const struct views_folder *f = ctx;
    const struct view *view = &f->set->views[view_idx];
    struct lens_list lenses = {0};
    struct given given = {0};
    const bool lone = f->set->view_count == 1;
    bool usable = true;
    char path[FILE_PATH];
    *z = NULL;
    if (product_path_in(path, f->folder, PRODUCT_LENSES, NULL, err)) return err->status;
    if (!access(path, F_OK)) lens_list_read(&lenses, path, NULL, err);
    const int lens = err->status ? -1 : lens_list_find(&lenses, view->name);
    if (!err->status) given_read(&given, f->given, view, lens < 0 ? NULL : &lenses.lenses[lens], lone, f->prov, err);
    if (!err->status && lone && given.z) scale_lone(&given, f, view, err);
    double min_inverse_z = 0, max_inverse_z = 0;
    if (!err->status && given.z &&
        !given_depth_range(&min_inverse_z, &max_inverse_z, given.z, (size_t)view->width * (size_t)view->height)) {
        usable = false;
        if (!f->before) /* warns in the first round only */
            log_warn("the given depth of view %s in %s is unknown everywhere (0, NaN or infinite); the view is matched "
                     "as if there were none.",
                     view->name, f->given);
    } else if (!err->status && given.z && !lone) {
        check_given(&usable, &given, f, view_idx, err);
    }
    if (!err->status && usable)
        *z = given.z;
    else
        free(given.z);
    lens_list_release(&lenses);
    return err->status;
}

/* Writes the views and the depth of the round before that were read. */
static enum status write_deps(const char *deps, const char *out, const char *const folders[2],
                              const struct camera_set *set, const int *read, int count, struct err *err)
{
    char paths[2 * (1 + MAX_NEIGHBOURS)][FILE_PATH];
    const char *files[2 * (1 + MAX_NEIGHBOURS)];
    int n = 0;
    for (int f = 0; f < 2 && folders[f]; f++)
        for (int i = 0; !err->status && i < count; i++, n++) {
            product_path_in(paths[n], folders[f], f ? PRODUCT_DEPTH : PRODUCT_VIEW,
                            &(struct product_key){.view = set->views[read[i]].name}, err);
            files[n] = paths[n];
        }
    if (!err->status) make_deps_write(deps, out, files, n, err);
    return err->status;
}

static void log_coverage(const char *view, const struct layered_depth *d)
{
    const struct depth_shares shares = layered_depth_shares(d);
    log_note("%s: %.2f %% of the pixels have no depth%s, %.2f %% inherit it from neighbouring segments because no "
             "other view determines it",
             view, 100 * shares.unknown, shares.unknown > 0 ? " (masked, or outside the lens)" : "",
             100 * shares.inherited);
}

/* Warns if the depth range was guessed. */
static enum status warn_guessed_range(const struct camera_set *set, const int *read, int count,
                                      const struct segment_params *params, struct err *err)
{
    double min_inverse_z = 0, max_inverse_z = 0;
    bool guessed = false;
    if (params->near > 0 && params->far > 0) return ST_OK;
    neighbours_depth_range(&min_inverse_z, &max_inverse_z, &guessed, set, read[0], read + 1, count, err);
    if (!err->status && guessed)
        log_warn("too few sparse points to find the depth range: searched from a depth of %.4g on, at which the "
                 "disparity is a quarter of the picture's width; if the nearest surface is nearer or much farther, set "
                 "[segment_depth] near and far",
                 1 / max_inverse_z);
    return err->status;
}

/* What main was asked for. */
struct request {
    const char *views, *records, *frame, *model, *axes, *before, *given, *view, *out, *deps;
    const struct segment_params *params;
};

/* The share of pixels whose depth differs from the round before. */
static enum status find_change(double *changed, const struct layered_depth *depth, const struct request *r,
                               struct err *err)
{
    struct layered_depth before = {0};
    char path[FILE_PATH];
    *changed = 1;
    if (!r->before) return ST_OK;
    if (!product_path_in(path, r->before, PRODUCT_DEPTH, &(struct product_key){.view = r->view}, err) &&
        !layered_depth_read(&before, path, NULL, err))
        *changed = round_change(depth, &before);
    layered_depth_release(&before);
    return err->status;
}

static enum status write_record(double changed, bool estimated, const struct request *r, const struct provenance *prov,
                                struct err *err)
{
    const struct round_record record = {changed, estimated};
    char path[FILE_PATH];
    return round_file(path, r->out, ".round", err) || round_record_write(&record, path, prov, err) ? err->status
                                                                                                   : ST_OK;
}

/* read[0]: the view; the rest: the neighbours that were read. */
static enum status make_depth(const struct request *r, const struct camera_set *set, int read[1 + MAX_NEIGHBOURS],
                              struct provenance *prov, struct err *err)
{
    struct views_folder views = {r->views, r->before, r->given, set, prov};
    struct vec3 *ups = NULL;
    struct room_frame frame = {0};
    struct model_rays model = {0};
    struct model_axes axes = {0};
    struct layered_depth depth = {0};
    double changed = 1;
    int count = 0;
    estimate_log(set, read[0], !r->before, r->params, err);
    if (!err->status && r->records) {
        ups = calloc((size_t)set->view_count + 1, sizeof *ups);
        if (ups)
            upright_read(ups, set, r->views, r->records, prov, err);
        else
            err_nomem(err, "upright directions", (size_t)set->view_count * sizeof *ups);
    }
    if (!err->status && r->frame) room_frame_read(&frame, r->frame, prov, err);
    if (!err->status && r->model && !model_rays_read(&model, r->model, MODEL_WITH_GLASS, prov, err))
        model_axes_read(&axes, r->axes, prov, err);
    const struct view_source source = {.read = read_view,
                                       .read_depth = r->before ? read_depth : NULL,
                                       .ctx = &views,
                                       .read_given = r->given ? read_given : NULL,
                                       .ups = ups,
                                       .frame = frame.known ? &frame : NULL,
                                       .model = r->model ? &model : NULL,
                                       .axes = &axes};
    if (!err->status && !view_depth(&depth, read + 1, &count, set, read[0], &source, r->params, err))
        find_change(&changed, &depth, r, err);
    if (!err->status && r->deps)
        write_deps(r->deps, r->out, (const char *const[2]){r->views, r->before}, set, read, 1 + count, err);
    if (!err->status && !write_record(changed, true, r, prov, err))
        layered_depth_write(&depth, &set->views[read[0]], r->out, prov, err);
    if (!err->status && count && !r->given) warn_guessed_range(set, read, count, r->params, err);
    if (!err->status) log_coverage(r->view, &depth);
    if (!err->status && r->before)
        log_note("%s: the depth of %.2f %% of the pixels changed by more than %g %%", r->view, 100 * changed,
                 100 * CHANGED_PART);
    free(ups);
    room_frame_release(&frame);
    model_rays_release(&model);
    layered_depth_release(&depth);
    return err->status;
}

/* Copies the depth of the round before if neither the view nor a neighbour changed in it; *carried: they did not. */
static enum status carry_over(bool *carried, const struct request *r, const struct camera_set *set,
                              int read[1 + MAX_NEIGHBOURS], struct provenance *prov, struct err *err)
{
    struct observed_points seen = {0};
    struct provenance records = {.stage = prov->stage, .version = prov->version, .params = prov->params};
    struct err alone = ERR_INIT;
    int count = 0;
    *carried = false;
    neighbours_find_points(&seen, set, read[0], err);
    /* without neighbours a view has given depth, or view_depth() says what is wrong */
    if (!err->status &&
        neighbours_choose(read + 1, &count, set, read[0], &seen, r->params->neighbours, &alone) == ST_NOMEM)
        err_set(err, ST_NOMEM, "%s", alone.text);
    if (!err->status) round_is_settled(carried, r->before, set, read, 1 + count, r->params->min_change, &records, err);
    if (!err->status && *carried && r->deps)
        write_deps(r->deps, r->out, (const char *const[2]){r->views, r->before}, set, read, 1 + count, err);
    if (!err->status && *carried && !write_record(0, false, r, &records, err) &&
        !round_carry_over(r->before, r->view, r->out, err))
        log_note("%s: little changed here and in the neighbours in the round before, so its depth is carried over",
                 r->view);
    records.params = NULL; /* is prov's */
    provenance_release(&records);
    neighbours_release_points(&seen);
    return err->status;
}

static enum status segment_depth(const struct request *r, struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    int read[1 + MAX_NEIGHBOURS];
    bool carried = false;
    camera_set_read(&set, r->views, NULL, err);
    if (!err->status && (read[0] = camera_set_find(&set, r->view)) < 0)
        err_set(err, ST_USAGE, "there is no view %s in %s/images.txt; the views are listed in %s/views.mk.", r->view,
                r->views, r->views);
    if (!err->status && r->before && !r->model) carry_over(&carried, r, &set, read, prov, err);
    if (!err->status && !carried) make_depth(r, &set, read, prov, err);
    camera_set_release(&set);
    return err->status;
}

static enum status estimate(const char *folder, const char *list, int jobs, const struct segment_params *params,
                            struct err *err)
{
    struct camera_set set = {0};
    if (jobs < 0)
        err_set(err, ST_USAGE, "--jobs %d: wanted the number of views made at a time, or 0 on a cluster.", jobs);
    else
        camera_set_read(&set, folder, NULL, err);
    if (!err->status) estimate_print(stdout, list, &set, jobs, params, err);
    camera_set_release(&set);
    return err->status;
}

int main(int argc, char **argv)
{
    struct segment_params params = SEGMENT_PARAMS_DEFAULT;
    struct request r = {.params = &params};
    const char *list = NULL, *sizes = NULL;
    int jobs = 1;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Layered depth of one view by multi-view segment matching."),
        CLI_STR("views", &r.views, CLI_OPTIONAL, "folder of cameras and rectified views (required, without --foresee)"),
        CLI_STR("records", &r.records, CLI_OPTIONAL,
                "folder of the photos' records, which tell their upper sides; without them all are taken as upright"),
        CLI_STR("frame", &r.frame, CLI_OPTIONAL, "what straight edges say of the room: frame.txt"),
        CLI_STR("model", &r.model, CLI_OPTIONAL, "model.txt, whose faces the view is expected to show; needs --before"),
        CLI_STR("axes", &r.axes, CLI_OPTIONAL, "the model's frame, axes.txt; with --model"),
        CLI_STR("view", &r.view, CLI_OPTIONAL, "view to work on (required, with --out)"),
        CLI_STR("before", &r.before, CLI_OPTIONAL,
                "folder of all views' depth in the previous round; none in the first round"),
        CLI_STR("given", &r.given, CLI_OPTIONAL,
                "folder of known depth, of any of the views: VIEW.exr, .png, .pfm, .tif or .tiff, and depth.txt"),
        CLI_STR("out", &r.out, CLI_OPTIONAL, "EXR to write"),
        CLI_STR("deps", &r.deps, CLI_OPTIONAL, "make dependencies to write: the pictures that were read"),
        CLI_STR("estimate", &list, CLI_OPTIONAL,
                "file of lines VIEW ROUND: makes no depth, but prints the time and memory that these will take"),
        CLI_STR("foresee", &sizes, CLI_OPTIONAL,
                "file of lines WIDTH HEIGHT, a view each: prints between which times the depth of all of them lies"),
        CLI_INT("jobs", &jobs, CLI_OPTIONAL,
                "with --estimate: views made at a time, each with all --threads (1); 0: on a cluster"),
        CLI_PARAMS(segment_param_table, &params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    const enum cli_verdict verdict = cli_parse(argc, argv, "segment_depth", opts, &prov, &err);
    if (verdict == CLI_RUN && sizes)
        estimate_foresee(stdout, sizes, &params, &err);
    else if (verdict == CLI_RUN && (!r.views || !list == !(r.view && r.out)))
        err_set(&err, ST_USAGE, "give --views, and --view and --out, or else --estimate; or --foresee alone.");
    else if (verdict == CLI_RUN && (!r.model != !r.axes || (r.model && !r.before)))
        err_set(&err, ST_USAGE, "--model, --axes and --before go together.");
    else if (verdict == CLI_RUN && list)
        estimate(r.views, list, jobs, &params, &err);
    else if (verdict == CLI_RUN)
        segment_depth(&r, &prov, &err);
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
