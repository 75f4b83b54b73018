/* choose_views.c - chooses the views that films are made from: all of them, or where they look all round, a cluster.
 *
 * reads   VIEWS/cameras.txt, images.txt, points3D.txt   the cameras and the sparse points that they see
 *         VIEWS/lenses.txt                              with --subjects: the views' photos
 *         SUBJECTS                                      with --subjects: rectangles drawn by the user, which the
 *                                                       cluster must see
 * writes  OUT                                           the views; left alone if its text does not change */
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/base/scan.h"
#include "common/film/film_views.h"
#include "common/film/regions.h"
#include "common/product/product.h"
#include "stages/choose_views/view_cluster.h"

struct job {
    const char *views, *subjects, *out;
    struct cluster_params params;
};

/* The views that the user's rectangles are drawn in; *wanted is malloc'ed. */
static enum status read_wanted(int **wanted, int *count, const struct job *job, const struct camera_set *set,
                               struct provenance *prov, struct err *err)
{
    struct region_list regions = {0};
    struct lens_list lenses = {0};
    char path[FILE_PATH];
    if (!job->subjects) return ST_OK;
    if (!region_list_read(&regions, job->subjects, prov, err) &&
        !product_path_in(path, job->views, PRODUCT_LENSES, NULL, err))
        lens_list_read(&lenses, path, prov, err);
    if (!err->status && !(*wanted = malloc(((size_t)regions.count + 1) * sizeof **wanted)))
        err_nomem(err, "the views of subjects", (size_t)regions.count * sizeof **wanted);
    for (int i = 0; !err->status && i < regions.count; i++) {
        struct subject s = {0};
        double part;
        region_in_view(&s, &(*wanted)[(*count)++], &part, &regions.regions[i], job->subjects, set, &lenses, err);
        subject_release(&s);
    }
    lens_list_release(&lenses);
    region_list_release(&regions);
    return err->status;
}

static const char *view_name(const void *ctx, int i)
{
    const struct camera_set *set = ctx;
    return i < set->view_count ? set->views[i].name : NULL;
}

/* The view of [choose_views] around. */
static enum status find_seed(int *seed, const char *name, const struct camera_set *set, struct err *err)
{
    char shown[SCAN_QUOTED];
    *seed = camera_set_find(set, name);
    if (*seed >= 0) return ST_OK;
    const char *near = scan_nearest(name, view_name, set);
    return err_set(err, ST_USAGE,
                   "[choose_views] around = %s: wanted auto, all or a view's name as in views/images.txt%s%s%s",
                   scan_quote(shown, name), near ? "; did you mean " : "", near ? near : "", near ? "?" : ".");
}

static void log_cluster(const struct view_cluster *c, const struct camera_set *set)
{
    log_note("films use %d views, which look about the same way as %s and see the same points", c->count,
             set->views[c->seed].name);
    log_note("%s is in their middle: %.0f %% of its picture shows points with parallax, whose depths vary by %.0f %%",
             set->views[c->central].name, 100 * c->coverage, 100 * c->variety);
}

static enum status choose_cluster(struct view_cluster *c, const struct job *job, const struct camera_set *set, bool any,
                                  struct provenance *prov, struct err *err)
{
    int *wanted = NULL, count = 0, seed = -1;
    if (!any) find_seed(&seed, job->params.around, set, err);
    if (!err->status && !read_wanted(&wanted, &count, job, set, prov, err))
        view_cluster_find(c, set, seed, wanted, count, &job->params, err);
    if (!err->status && c->member)
        log_cluster(c, set);
    else if (!err->status)
        log_warn("films use all views: no cluster of them %ssees points from different places%s",
                 count ? "contains those with the subjects and " : "",
                 count ? "; draw the subjects in photos that show each other's subjects" : "");
    free(wanted);
    return err->status;
}

static enum status choose(const struct job *job, struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    struct view_cluster cluster = {0};
    const bool any = !strcmp(job->params.around, "auto"), all = !strcmp(job->params.around, "all");
    camera_set_read(&set, job->views, prov, err);
    if (!err->status && !all) {
        const double agreement = views_agreement(&set);
        const bool all_round = agreement < job->params.min_agreement;
        if (any && all_round)
            log_note("the %d views look all round: the mean of their directions has length %.2f", set.view_count,
                     agreement);
        if (!any || all_round) choose_cluster(&cluster, job, &set, any, prov, err);
    }
    if (!err->status) film_views_write(&set, cluster.member, job->out, prov, err);
    view_cluster_release(&cluster);
    camera_set_release(&set);
    return err->status;
}

int main(int argc, char **argv)
{
    struct job job = {.params = CLUSTER_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Chooses the views that films are made from: all of them, or where they look all round, a cluster."),
        CLI_STR("views", &job.views, CLI_REQUIRED, "folder of cameras"),
        CLI_STR("subjects", &job.subjects, CLI_OPTIONAL, "file of rectangles on photos, which the cluster must see"),
        CLI_STR("out", &job.out, CLI_REQUIRED, "file of the views to write"),
        CLI_PARAMS(cluster_param_table, &job.params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "choose_views", opts, &prov, &err) == CLI_RUN) choose(&job, &prov, &err);
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
