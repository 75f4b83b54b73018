/* evaluate.c - metrics of a scene's products, against a truth and against held-out photographs.
 *
 * reads   FOLDER/views, depth, holdout   cameras, views, depth maps, held-out photographs and their rendered frames
 *         FOLDER/model, remodel/E        axes, plans and solids of the model and of its edits
 *         FOLDER/vdta, vita, reveal      texture atlases, and what edits reveal to the views
 *         FOLDER/relight                 irradiance.txt: irradiance at points; pictures of it like those in RENDERED;
 *                                        E, E/unlit: pictures under the light that edits make, and before
 *         SHARED/photos, hdr             the photos' records, merged exposures
 *         RENDERED/novel, edited-E, relit-E, shell, irradiance, edited-E/irradiance   rendered pictures, and their
 *                                                                                     cameras
 *         TRUTH                          what is true of the scene; docs/formats.md lists it
 * writes  FOLDER/evaluate/truth/VIEW.exr the true depth resampled to the view
 *         FOLDER/evaluate/cameras        cameras of the truth in the frame of the views, for programs that render them
 *         FOLDER/evaluate/relit/E/VIEW.exr   the true picture after edit E, of views that were relit
 *         FOLDER/evaluate/irradiance_points.txt   points of the truth in that frame
 *         FOLDER/evaluate/views.tsv      metrics of each view, picture and face
 *         OUT                            metrics of the scene, written last; docs/evaluation.md defines them */
#include "common/base/cli.h"
#include "stages/evaluate/evaluation.h"

int main(int argc, char **argv)
{
    struct evaluate_inputs from = {0};
    const char *out = NULL;
    struct evaluate_params params = EVALUATE_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Measures a scene's products against a truth and against held-out photographs."),
        CLI_STR("folder", &from.folder, CLI_REQUIRED, "folder of the scene's products"),
        CLI_STR("shared", &from.shared, CLI_REQUIRED, "folder of its photo records, shared by all qualities"),
        CLI_STR("truth", &from.truth, CLI_OPTIONAL,
                "folder of the truth: true cameras, depths, pictures, edited scenes"),
        CLI_STR(
            "rendered", &from.rendered, CLI_OPTIONAL,
            "folder of rendered pictures: novel/, edited-E/, relit-E/, shell/, irradiance/ (default: FOLDER/rendered)"),
        CLI_STR("out", &out, CLI_REQUIRED, "table of metrics to write (metrics.tsv)"),
        CLI_PARAMS(evaluate_param_table, &params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "evaluate", opts, &prov, &err) != CLI_RUN || evaluate(&from, out, &params, &prov, &err))
        err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
