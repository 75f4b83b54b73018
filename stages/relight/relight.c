/* relight.c - pictures of an edited model under the light that the edit makes.
 *
 * reads   PICTURES/NAME.exr, NAME.txt        pictures as render_model drew them
 *         MODEL, VITA/                       the unedited model and its atlas
 *         EDITED, MAP                        the edited model, and where its faces take their texture
 *         RELIT/vita/, objects.txt           its atlas and objects under the new light
 *         AXES                               the models' frame
 *         OUTDOORS                           what lies outside, by direction
 *         LIGHTS, REFERENCES/ID.exr          lamps and openings, and the lighting reference images that these name
 *         MATERIALS                          glossy materials
 *         OBJECTS, SCENE/FILE.obj            synthetic objects of the edit
 *         VIEWS/, IDS/NAME.exr, DEPTH/NAME.exr   cameras, faces and depth of pictures that are original views
 *         PICTURES/pictures.txt              with --list: which pictures
 * writes  OUT/NAME-ratio.exr, NAME-ratio.png light after the edit over light before it
 *         OUT/NAME-integrals.exr             the light itself
 *         OUT/NAME.exr, NAME.jpg, NAME.txt   the picture
 *         OUT/NAME.exr                       with --frames: frames of a film instead
 *         OUT/pictures.txt                   with --list: the same list, when all are there */
#include "stages/relight/relight.h"

#include <math.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/capture/picture_estimate.h"
#include "common/relight/change_options.h"

#define PARAM_STRUCT struct relight_params
static const struct param relight_param_table[] = {RELIGHT_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

static enum status check_options(struct relight_job *j, struct err *err)
{
    const struct light_change_files *f = &j->files;
    if (!j->names.count == !j->list) return err_set(err, ST_USAGE, "wanted either --picture NAME or --list.");
    if (j->from) {
        if (!j->materials || j->list)
            return err_set(err, ST_USAGE, "--from needs --materials, a file of changes, and --picture NAME.");
        j->changes = j->materials;
        return ST_OK;
    }
    if (!f->base || !f->edited || !f->map || !f->axes || !f->vita || !j->relit || !j->pictures)
        return err_set(err, ST_USAGE,
                       "wanted --model, --edited, --map, --axes, --vita, --relit and --pictures; or "
                       "--from and --materials. See --help.");
    if (!j->ids != !j->depth) return err_set(err, ST_USAGE, "--ids and --depth go together.");
    if ((j->ids || j->materials) && !j->views)
        return err_set(err, ST_USAGE, "--ids, --depth and --materials need --views, the folder of cameras.");
    return ST_OK;
}

/* Measured on loft, pictures of 853 x 853 px of two edits at draft, of which the edit changes a part or nothing: 20
 * to 35 core-seconds for the three pictures of a photo, 450 to 560 MiB, 30 MB. The time grows with the number of
 * gathers in a row of pixels, and with their rays, of which a smaller error needs more, though many end early. */
static enum status estimate(const struct relight_job *j, const char *list, struct err *err)
{
    const struct relight_params *p = &j->params, drafts = {.step = 8, .target_error = 0.05};
    const double finer =
        !strcmp(p->light, "atlas") ? 0.2 : drafts.step / (double)p->step * sqrt(drafts.target_error / p->target_error);
    const struct picture_cost cost = {
        .process_seconds = 2, .seconds = 12 * finer, .process_mib = 420, .mib = 180, .bytes = 14e6};
    if (!j->views) return err_set(err, ST_USAGE, "--estimate needs --views, the folder of cameras.");
    return picture_estimate_print(stdout, list, j->views, &cost, err);
}

int main(int argc, char **argv)
{
    const char *to_estimate = NULL;
    struct relight_job job = {.params = RELIGHT_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Pictures of an edited model under the light that the edit makes."),
        CHANGE_OPTIONS(&job.files, CLI_OPTIONAL),
        CLI_STR("relit", &job.relit, CLI_OPTIONAL, "folder that update_vita wrote"),
        CLI_STR("pictures", &job.pictures, CLI_OPTIONAL, "folder of the pictures, as render_model drew them"),
        CLI_LIST("picture", &job.names, CLI_OPTIONAL, "name of a picture; repeat for several"),
        CLI_FLAG("list", &job.list, "instead: all that PICTURES/pictures.txt lists"),
        CLI_FLAG("frames", &job.frames, "write frames of a film: NAME.exr alone, radiance times exposure"),
        CLI_STR("views", &job.views, CLI_OPTIONAL, "folder of cameras, of pictures that are original views"),
        CLI_STR("ids", &job.ids, CLI_OPTIONAL, "for furniture in original views: folder of the faces that they show"),
        CLI_STR("depth", &job.depth, CLI_OPTIONAL, "for furniture in original views: folder of layered depth maps"),
        CLI_STR("materials", &job.materials, CLI_OPTIONAL,
                "glossy materials, materials.txt; with --from: changes of materials and lamps"),
        CLI_STR("from", &job.from, CLI_OPTIONAL,
                "instead: change relit pictures of this folder by --materials, from their integrals"),
        CLI_STR("estimate", &to_estimate, CLI_OPTIONAL,
                "instead: print what processes will take, of a file with a line \"process NAME...\" for each"),
        CLI_STR("out", &job.out, CLI_REQUIRED, "folder to write to"),
        CLI_PARAMS(relight_param_table, &job.params, NULL),
        CLI_END,
    };
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "relight", opts, &job.prov, &err) == CLI_RUN) {
        if (to_estimate)
            estimate(&job, to_estimate, &err);
        else if (!check_options(&job, &err))
            relight(&job, &err);
    }
    err_report(&err);
    cli_list_release(&job.names);
    provenance_release(&job.prov);
    return err_exit_code(&err);
}
