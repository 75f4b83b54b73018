/* update_vita.c - the view-independent atlas of an edited model, under the light that the edit makes.
 *
 * reads   MODEL, VITA/                       the unedited model and its atlas
 *         EDITED, MAP                        the edited model, and where its faces take their texture
 *         AXES                               the models' frame
 *         OUTDOORS                           what lies outside, by direction
 *         LIGHTS, REFERENCES/ID.exr          lamps and openings, and the lighting reference images that these name
 *         OBJECTS, SCENE/FILE.obj            synthetic objects of the edit
 * writes  OUT/rounds.txt                     what each round of light changed
 *         OUT/objects.txt                    irradiance on the objects
 *         OUT/vita/page0.exr, ..., atlas.txt the atlas */
#include <math.h>

#include "common/base/cli.h"
#include "common/base/work_estimate.h"
#include "common/relight/change_options.h"
#include "stages/update_vita/update.h"

#define PARAM_STRUCT struct update_params
static const struct param update_param_table[] = {UPDATE_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

/* Prints what this many edits will take. Samples lie as far apart on all faces as the first ones do, and light bends
 * until there are MOST times as many. The costs are those of loft's wider window, on one core of a server of 2023. */
static enum status estimate(const struct update_job *j, int edits, struct err *err)
{
    enum { MOST = 2 };
    struct work_estimate work = {0};
    struct model_rays m = {0};
    if (!solid_mesh_read(&m.mesh, j->files.base, NULL, err)) {
        const double spacing = j->params.spacing * model_rays_size(&m);
        const double first = spacing > 0 ? model_rays_area(&m) / (spacing * spacing) : 0;
        const double samples = fmin(MOST * first, j->params.max_samples);
        for (int i = 0; i < edits; i++) work_estimate_add(&work, 0.5 + 1.1e-6 * samples * j->params.rays, 430, 7e6);
        work_estimate_print(stdout, &work);
    }
    solid_mesh_release(&m.mesh);
    return err->status;
}

int main(int argc, char **argv)
{
    int to_estimate = 0;
    struct update_job job = {.params = UPDATE_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("The view-independent atlas of an edited model, under the light that the edit makes."),
        CHANGE_OPTIONS(&job.files, CLI_REQUIRED),
        CLI_INT("estimate", &to_estimate, CLI_OPTIONAL, "instead: print what this many edits of --model will take"),
        CLI_STR("out", &job.out, CLI_REQUIRED, "folder to write to"),
        CLI_PARAMS(update_param_table, &job.params, NULL),
        CLI_END,
    };
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "update_vita", opts, &job.prov, &err) == CLI_RUN) {
        if (to_estimate > 0)
            estimate(&job, to_estimate, &err);
        else
            update_vita(&job, &err);
    }
    err_report(&err);
    provenance_release(&job.prov);
    return err_exit_code(&err);
}
