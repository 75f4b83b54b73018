/* plan_eyes.c - plans the two eyes of a stereo film: their distance, where they converge, and their cameras.
 *
 * reads   VIEWS/cameras.txt, images.txt, points3D.txt   the cameras of the views
 *         FILM_VIEWS                                    with --film-views: the views that are used
 *         DEPTH/VIEW.exr, VIEW.txt                      the layers of these views
 *         PATH/path.txt, path/NAME.txt                  the film
 * writes  OUT/left/path.txt, path/NAME.txt              the left eye's cameras
 *         OUT/right/path.txt, path/NAME.txt             the right eye's
 *         OUT/eyes.txt                                  distance, depths and disparities; written last */
#include <string.h>

#include "common/base/cli.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/film/film_views.h"
#include "common/product/product.h"
#include "stages/plan_eyes/eyes.h"

struct job { /* the command line */
    const char *views, *film_views, *depth, *path, *picture, *out;
    struct eyes_params params;
};

static enum status write_eye(const struct camera_path *film, const struct eyes_plan *plan, int side, const char *out,
                             const struct provenance *prov, struct err *err)
{
    struct camera_path eye = {0};
    char folder[FILE_PATH];
    if (!file_path(folder, out, side < 0 ? "left" : "right", "", err) && !eyes_path(&eye, film, plan, side, err))
        camera_path_write(&eye, folder, prov, err);
    camera_path_release(&eye);
    return err->status;
}

static void log_plan(const struct eyes_plan *p, const struct eyes_params *params)
{
    const double front = 100 * p->front / p->width, behind = 100 * p->behind / p->width;
    log_note("the eyes are %.4g scene units apart, 1/%.0f of the nearest depth (limited by %s)", p->base,
             p->nearest / p->base, p->limit);
    if (p->kind == EYES_FLAT)
        log_note("disparity: at most %.2f %% of the width (%.1f px) in front of the screen, %.2f %% (%.1f px) behind "
                 "it; limits: %g %% and %g %%",
                 front, p->front, behind, p->behind, params->max_front, params->max_behind);
    else
        log_note("disparity of the nearest points: %.2f %% of the width (%.1f px), %.2f degrees", front, p->front,
                 1.8 * front);
    if (p->nearest / p->base < params->near_ratio * (1 - 1e-9))
        log_warn("[plan_eyes] base is more than 1/%g of the nearest depth: near things will be hard to fuse",
                 params->near_ratio);
    /* smoothing the convergence moves the screen by a few percent of the budget */
    if (p->kind == EYES_FLAT && front + behind > 1.1 * (params->max_front + params->max_behind))
        log_warn("the disparities exceed their limits: reduce [plan_eyes] base");
}

static enum status run(const struct job *job, struct provenance *prov, struct err *err)
{
    const bool sphere = job->picture && !strcmp(job->picture, "half_sphere");
    struct camera_set set = {0};
    struct camera_path film = {0};
    struct layer_scene scene = {0};
    struct eyes_plan plan = {0};
    char file[FILE_PATH];
    if (job->picture && !sphere && strcmp(job->picture, "flat") != 0)
        return err_set(err, ST_USAGE, "--picture %s: wanted flat or half_sphere.", job->picture);
    if (!camera_set_read(&set, job->views, prov, err) && !camera_path_read(&film, job->path, prov, err) &&
        !film_views_keep(&set, job->film_views, prov, err) && !layer_scene_read(&scene, &set, job->depth, prov, err) &&
        !eyes_plan(&plan, &film, &scene, sphere ? EYES_HALF_SPHERE : EYES_FLAT, &job->params, err) &&
        !write_eye(&film, &plan, -1, job->out, prov, err) && !write_eye(&film, &plan, 1, job->out, prov, err) &&
        !product_path_in(file, job->out, PRODUCT_EYES, NULL, err) &&
        !eyes_write(&plan, &film, &job->params, file, prov, err))
        log_plan(&plan, &job->params);
    eyes_plan_release(&plan);
    layer_scene_release(&scene);
    camera_path_release(&film);
    camera_set_release(&set);
    return err->status;
}

int main(int argc, char **argv)
{
    struct job job = {.params = EYES_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Plans the two eyes of a stereo film: their distance, where they converge, and their cameras."),
        CLI_STR("views", &job.views, CLI_REQUIRED, "folder of the views' cameras"),
        CLI_STR("film-views", &job.film_views, CLI_OPTIONAL,
                "views that the move is made from (choose_views); default: all"),
        CLI_STR("depth", &job.depth, CLI_REQUIRED, "folder of layered depth maps"),
        CLI_STR("path", &job.path, CLI_REQUIRED, "folder of the film: path.txt and path/"),
        CLI_STR("picture", &job.picture, CLI_OPTIONAL,
                "what an eye sees: flat, a picture for a screen (default), or half_sphere, 180 degrees"),
        CLI_STR("out", &job.out, CLI_REQUIRED, "folder to write left/, right/ and eyes.txt into"),
        CLI_PARAMS(eyes_param_table, &job.params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "plan_eyes", opts, &prov, &err) == CLI_RUN) run(&job, &prov, &err);
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
