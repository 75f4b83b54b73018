/* segment_depth.c - layered depth of one view by multi-view segment matching.
 *
 * reads   VIEWS/cameras.txt, images.txt, points3D.txt   the cameras and sparse points
 *         VIEWS/VIEW.exr                                the view and the neighbours it selects, linear RGBA
 *         BEFORE/VIEW.exr, VIEW.txt                     with --before: depth of the view and its neighbours
 *         GIVEN/VIEW.exr or .png, depth.txt             with --given: known depth, where there is any
 *         VIEWS/lenses.txt                              for given depth in the photo's pixels
 * writes  DEPS                                          make dependencies: the pictures that were read
 *         OUT with .txt for .exr, then OUT              segments; layers interior.* and boundary.* (RGBA, Z, id)
 *
 * --estimate prints the time and memory that depth will take instead; it reads cameras and points only.
 *
 * Each file appears whole or not at all, OUT last: if it is new, so are the others. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/cli.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/capture/view_image.h"
#include "stages/segment_depth/estimate.h"
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
    enum status st = view_image_read(im, f->folder, view, err);
    if (!st) st = provenance_add_in(f->prov, "views", f->folder, view->name, ".exr", NULL, err);
    return st;
}

static enum status read_depth(void *ctx, int view_idx, struct layered_depth *d, struct err *err)
{
    const struct views_folder *f = ctx;
    const char *name = f->set->views[view_idx].name;
    char path[FILE_PATH];
    enum status st = provenance_add_in(f->prov, "depth", f->before, name, ".exr", path, err);
    if (!st) st = layered_depth_read_ids(d, path, err);
    return st;
}

/* *z: the view's given depth; NULL if there is none or all of it is unknown. */
static enum status read_given(void *ctx, int view_idx, float **z, struct err *err)
{
    const struct views_folder *f = ctx;
    const struct view *view = &f->set->views[view_idx];
    struct lens_list lenses = {0};
    char *path = NULL;
    if (asprintf(&path, "%s/lenses.txt", f->folder) < 0) return err_nomem(err, "a file name", strlen(f->folder));
    enum status st = access(path, F_OK) ? ST_OK : lens_list_read(&lenses, path, err);
    const int lens = st ? -1 : lens_list_find(&lenses, view->name);
    if (!st) st = given_read(z, f->given, view, lens < 0 ? NULL : &lenses.lenses[lens], f->prov, err);
    double min_inverse_z = 0, max_inverse_z = 0;
    if (!st && *z &&
        !given_depth_range(&min_inverse_z, &max_inverse_z, *z, (size_t)view->width * (size_t)view->height)) {
        if (!f->before) /* warns in the first round only */
            log_warn("the given depth of view %s in %s is unknown everywhere (0, NaN or infinite); the view is matched "
                     "as if there were none.",
                     view->name, f->given);
        free(*z);
        *z = NULL;
    }
    lens_list_release(&lenses);
    free(path);
    return st;
}

static void print_escaped(FILE *to, const char *path)
{
    for (; *path; path++) {
        if (*path == ' ' || *path == '#' || *path == '\\') fputc('\\', to);
        if (*path == '$') fputc('$', to);
        fputc(*path, to);
    }
}

/* Writes "OUT: VIEWS/A.exr VIEWS/B.exr ... BEFORE/B.exr ...", and an empty rule for each, so that make does not stop at
 * a view that has been removed. */
static enum status write_deps(const char *deps, const char *out, const char *const folders[2],
                              const struct camera_set *set, const int *read, int count, struct err *err)
{
    struct outfile file = {0};
    enum status st = outfile_open(&file, deps, err);
    if (!st) {
        print_escaped(file.fp, out);
        fputc(':', file.fp);
        for (int rule = 0; rule < 2; rule++) {
            for (int f = 0; f < 2 && folders[f]; f++)
                for (int i = 0; i < count; i++) {
                    fputs(rule ? "" : " ", file.fp);
                    print_escaped(file.fp, folders[f]);
                    fprintf(file.fp, "/%s.exr%s", set->views[read[i]].name, rule ? ":\n" : "");
                }
            if (!rule) fputc('\n', file.fp);
        }
        st = outfile_commit(&file, err);
    }
    outfile_discard(&file);
    return st;
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
    enum status st = depth_range(&min_inverse_z, &max_inverse_z, &guessed, set, read[0], read + 1, count, err);
    if (!st && guessed)
        log_warn("too few sparse points to find the depth range: searched from a depth of %.4g on, at which the "
                 "disparity is a quarter of the picture's width; if the nearest surface is nearer or much farther, set "
                 "[segment_depth] near and far",
                 1 / max_inverse_z);
    return st;
}

static enum status segment_depth(const char *folder, const char *before, const char *given, const char *name,
                                 const char *out, const char *deps, const struct segment_params *params,
                                 struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    struct layered_depth depth = {0};
    int read[1 + MAX_NEIGHBOURS], count = 0;
    enum status st = camera_set_read(&set, folder, err);
    if (!st && (read[0] = camera_set_find(&set, name)) < 0)
        st = err_set(err, ST_USAGE, "there is no view %s in %s/images.txt; the views are listed in %s/views.mk.", name,
                     folder, folder);
    if (!st) st = estimate_log(&set, read[0], !before, params, err);
    if (!st) {
        struct views_folder views = {folder, before, given, &set, prov};
        const struct view_source source = {read_view, before ? read_depth : NULL, &views, given ? read_given : NULL};
        st = view_depth(&depth, read + 1, &count, &set, read[0], &source, params, err);
    }
    if (!st && deps) st = write_deps(deps, out, (const char *const[2]){folder, before}, &set, read, 1 + count, err);
    if (!st) st = layered_depth_write(&depth, &set.views[read[0]], out, prov, err);
    if (!st && count && !given) st = warn_guessed_range(&set, read, count, params, err);
    if (!st) log_coverage(name, &depth);
    layered_depth_release(&depth);
    camera_set_release(&set);
    return st;
}

static enum status estimate(const char *folder, const char *list, int jobs, const struct segment_params *params,
                            struct err *err)
{
    struct camera_set set = {0};
    enum status st =
        jobs < 0
            ? err_set(err, ST_USAGE, "--jobs %d: wanted the number of views made at a time, or 0 on a cluster.", jobs)
            : camera_set_read(&set, folder, err);
    if (!st) st = estimate_print(stdout, list, &set, jobs, params, err);
    camera_set_release(&set);
    return st;
}

int main(int argc, char **argv)
{
    const char *views = NULL, *before = NULL, *given = NULL, *view = NULL, *out = NULL, *deps = NULL, *list = NULL;
    int jobs = 1;
    struct segment_params params = SEGMENT_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Layered depth of one view by multi-view segment matching."),
        CLI_STR("views", &views, CLI_REQUIRED, "folder of cameras and rectified views"),
        CLI_STR("view", &view, CLI_OPTIONAL, "view to work on (required, with --out)"),
        CLI_STR("before", &before, CLI_OPTIONAL,
                "folder of all views' depth in the previous round; none in the first round"),
        CLI_STR("given", &given, CLI_OPTIONAL,
                "folder of known depth, of any of the views: VIEW.exr, or VIEW.png with depth.txt"),
        CLI_STR("out", &out, CLI_OPTIONAL, "EXR to write"),
        CLI_STR("deps", &deps, CLI_OPTIONAL, "make dependencies to write: the pictures that were read"),
        CLI_STR("estimate", &list, CLI_OPTIONAL,
                "file of lines VIEW ROUND: makes no depth, but prints the time and memory that these will take"),
        CLI_INT("jobs", &jobs, CLI_OPTIONAL,
                "with --estimate: views made at a time, each with all --threads (1); 0: on a cluster"),
        CLI_PARAMS(segment_param_table, &params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    const enum cli_verdict verdict = cli_parse(argc, argv, "segment_depth", opts, &prov, &err);
    if (verdict == CLI_RUN && !list == !(view && out))
        err_set(&err, ST_USAGE, "give --view and --out, or else --estimate.");
    else if (verdict == CLI_RUN && list)
        estimate(views, list, jobs, &params, &err);
    else if (verdict == CLI_RUN)
        segment_depth(views, before, given, view, out, deps, &params, &prov, &err);
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
