/* choose_exposure.c - chooses the exposure of all pictures and films of a scene's rooms from its photographs.
 *
 * reads   VIEWS/cameras.txt, images.txt   the views
 *         VIEWS/VIEW.exr                  their pixels
 * writes  OUT                             the exposure; left alone if its text does not change */
#include <stdlib.h>

#include "common/base/cli.h"
#include "common/base/log.h"
#include "common/base/progress.h"
#include "common/capture/view_image.h"
#include "common/texture/exposure.h"
#include "common/texture/scene_exposure.h"
#include "stages/choose_exposure/exposure_params.h"

static const struct param exposure_param_table[] = {
#define PARAM_STRUCT struct exposure_params
    EXPOSURE_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

struct job {
    const char *views, *out;
    struct exposure_params params;
};

/* What a camera would have chosen for a view; pixels past the photo's border do not count. */
static enum status look(double *exposure, struct model_picture *p, const struct job *job, const struct view *view,
                        struct err *err)
{
    const size_t pixels = (size_t)view->width * (size_t)view->height;
    struct image im = {0};
    if (!view_image_read(&im, job->views, view, NULL, err)) model_picture_resize(p, view->width, view->height, err);
    for (size_t i = 0; !err->status && i < pixels; i++) {
        p->made[i] = im.data[4 * i + 3] > 0 ? MADE_PHOTO : MADE_NOTHING;
        for (size_t c = 0; c < 3; c++) p->rgb[3 * i + c] = im.data[4 * i + c];
    }
    if (!err->status) *exposure = exposure_choose(p, job->params.saturated);
    image_release(&im);
    return err->status;
}

static enum status choose(const struct job *job, struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    struct model_picture picture = {0};
    struct progress progress;
    double *of_views = NULL;
    camera_set_read(&set, job->views, NULL, err);
    const int count = set.view_count < job->params.views ? set.view_count : job->params.views;
    if (!err->status && !(of_views = malloc(((size_t)count + 1) * sizeof *of_views)))
        err_nomem(err, "exposures", (size_t)count * sizeof *of_views);
    progress_start(&progress, "looking at", count, "views");
    for (int i = 0; !err->status && i < count; i++) {
        const int view = (int)((int64_t)i * set.view_count / count);
        look(&of_views[i], &picture, job, &set.views[view], err);
        progress_add(&progress, 1);
    }
    progress_end(&progress);
    if (!err->status) {
        /* the text has no hashes of the views, so that it changes only with the exposure */
        const double exposure = scene_exposure_of(of_views, count);
        log_note("pictures of the rooms have exposure %.3g; cameras would have chosen %.3g to %.3g", exposure,
                 count ? of_views[0] : exposure, count ? of_views[count - 1] : exposure);
        scene_exposure_write(exposure, job->out, prov, err);
    }
    free(of_views);
    model_picture_release(&picture);
    camera_set_release(&set);
    return err->status;
}

int main(int argc, char **argv)
{
    struct job job = {.params = EXPOSURE_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Chooses the exposure of all pictures and films of a scene's rooms from its photographs."),
        CLI_STR("views", &job.views, CLI_REQUIRED, "folder of cameras and rectified views"),
        CLI_STR("out", &job.out, CLI_REQUIRED, "file of the exposure to write"),
        CLI_PARAMS(exposure_param_table, &job.params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "choose_exposure", opts, &prov, &err) == CLI_RUN) choose(&job, &prov, &err);
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
