/* sample_validity.c - samples the viewpoints that show a scene without visible holes, for each end of a move.
 *
 * reads   VIEWS/cameras.txt, images.txt, points3D.txt   the cameras
 *         VIEWS/lenses.txt, RECORDS/ID.txt              with --records: the orientation of the photos
 *         FILM_VIEWS                                    with --film-views: the views that are used
 *         DEPTH/VIEW.exr, VIEW.txt                      the layers of these views
 *         SUBJECTS                                      with --subjects: the scene's subjects
 * writes  OUT/validity.png                              picture of the regions
 *         OUT/validity.txt                              the regions, written last: if it is new, so is the picture */
#include <stdio.h>
#include <stdlib.h>

#include "common/base/cli.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/capture/upright.h"
#include "common/film/film_views.h"
#include "common/product/product.h"
#include "stages/sample_validity/picture.h"
#include "stages/sample_validity/sample.h"

struct job {
    const char *views, *film_views, *records, *depth, *subjects, *effect, *out;
    struct validity_params params;
};

static void log_summary(const struct validity *v, const struct sampling_notes *n)
{
    static const char *const ends[] = {"start", "end"};
    for (int i = 0; i < 2; i++) {
        const struct validity_region *r = &v->region[i];
        double back = 0, forward = 0;
        for (int k = 0; k < r->columns * r->rows; k++) {
            back = fmin(back, r->cells[k].low);
            forward = fmax(forward, r->cells[k].high);
        }
        if (n->no_valid[i])
            log_warn("the %s of the move has no valid viewpoint: it is placed at view %s", ends[i], n->center_view);
        else
            log_note("%s: %d of %d cells are valid, z from %.3g to %.3g median depths", ends[i],
                     validity_region_count(r), r->columns * r->rows, back / v->shot.median_depth,
                     forward / v->shot.median_depth);
    }
    if (v->zoom > 1)
        log_note("f is %.0f %% longer than the views' mean focal length, to keep the photos' borders out of the frames",
                 100 * (v->zoom - 1));
    if (v->limits.max_h > n->requested_h)
        log_warn("H is not below %g even at view %s; raising the limit to %.3g", n->requested_h, n->center_view,
                 v->limits.max_h);
    if (v->limits.max_outside > n->requested_outside)
        log_warn(
            "even at view %s more than %.3g %% of the frame is beyond the views' borders; raising the limit to %.3g %%",
            n->center_view, 100 * n->requested_outside, 100 * v->limits.max_outside);
    if (n->error.limits)
        log_note(
            "in full pictures %d of %d limits are within one step (%.2g %% of the median depth); the largest error is "
            "%.0f steps",
            n->error.within, n->error.limits, 100 * v->step / v->shot.median_depth, n->error.worst);
}

static enum status sample(const struct job *job, struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    struct layer_scene scene = {0};
    struct subject_list subjects = {0};
    struct validity v = {0};
    struct sampling_notes notes = {0};
    struct film_effect effect;
    struct vec3 *ups = NULL;
    char picture[FILE_PATH], text[FILE_PATH];

    if (!film_effect_parse(&effect, job->effect, err) &&
        !product_path_in(picture, job->out, PRODUCT_VALIDITY_PICTURE, NULL, err) &&
        !product_path_in(text, job->out, PRODUCT_VALIDITY, NULL, err) && !camera_set_read(&set, job->views, prov, err))
        film_views_keep(&set, job->film_views, prov, err);
    if (!err->status && job->records) {
        ups = calloc((size_t)set.view_count + 1, sizeof *ups);
        if (ups)
            upright_read(ups, &set, job->views, job->records, prov, err);
        else
            err_nomem(err, "upright directions", (size_t)set.view_count * sizeof *ups);
    }
    if (!err->status && job->subjects) subject_list_read(&subjects, job->subjects, prov, err);
    const struct scene_subjects available = film_scene_subjects(&subjects);
    if (!err->status && !film_effect_check(&effect, &available, err) &&
        !layer_scene_read(&scene, &set, job->depth, prov, err) &&
        !validity_sample(&v, &notes, &scene, ups, &subjects, &effect, &job->params, err) &&
        !validity_picture_write(&v, &scene.mesh, picture, err) && !validity_write(&v, text, prov, err))
        log_summary(&v, &notes);
    validity_release(&v);
    layer_scene_release(&scene);
    subject_list_release(&subjects);
    camera_set_release(&set);
    free(ups);
    return err->status;
}

int main(int argc, char **argv)
{
    struct job job = {.params = VALIDITY_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Samples the viewpoints that show a scene without visible holes, for each end of a move."),
        CLI_STR("views", &job.views, CLI_REQUIRED, "folder of cameras"),
        CLI_STR("film-views", &job.film_views, CLI_OPTIONAL,
                "views that films are made from (choose_views); default: all"),
        CLI_STR("depth", &job.depth, CLI_REQUIRED, "folder of the views' layers"),
        CLI_STR("records", &job.records, CLI_OPTIONAL, "folder of the photos' records, which make the film upright"),
        CLI_STR("subjects", &job.subjects, CLI_OPTIONAL, "file of the scene's subjects, for a move that needs any"),
        CLI_STR("effect", &job.effect, CLI_REQUIRED,
                "effect of the taxonomy, such as dolly_in+narrow_dof (docs/formats.md)"),
        CLI_STR("out", &job.out, CLI_REQUIRED, "folder to write validity.txt and validity.png into"),
        CLI_PARAMS(validity_param_table, &job.params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "sample_validity", opts, &prov, &err) == CLI_RUN) sample(&job, &prov, &err);
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
