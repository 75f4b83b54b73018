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
#include "common/base/cli.h"
#include "common/relight/change_options.h"
#include "stages/update_vita/update.h"

#define PARAM_STRUCT struct update_params
static const struct param update_param_table[] = {UPDATE_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

int main(int argc, char **argv)
{
    struct update_job job = {.params = UPDATE_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("The view-independent atlas of an edited model, under the light that the edit makes."),
        CHANGE_OPTIONS(&job.files, CLI_REQUIRED),
        CLI_STR("out", &job.out, CLI_REQUIRED, "folder to write to"),
        CLI_PARAMS(update_param_table, &job.params, NULL),
        CLI_END,
    };
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "update_vita", opts, &job.prov, &err) == CLI_RUN) update_vita(&job, &err);
    err_report(&err);
    provenance_release(&job.prov);
    return err_exit_code(&err);
}
