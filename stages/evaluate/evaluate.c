/* evaluate.c - a scene's products against the truth, and against photographs that were held out.
 *
 * reads   FOLDER/views, depth, holdout   cameras, depth maps, held-out photographs and their rendered frames
 *         SHARED/photos                  the photos' records
 *         TRUTH/cameras.txt, images.txt, depth/NAME.exr   true cameras and depths, if there are any
 * writes  FOLDER/evaluate/truth/VIEW.exr the true depth as the view would see it
 *         FOLDER/evaluate/views.tsv      metrics of each view
 *         OUT                            metrics of the scene; last. docs/evaluation.md defines them */
#include "common/base/cli.h"
#include "stages/evaluate/evaluation.h"

int main(int argc, char **argv)
{
    const char *folder = NULL, *shared = NULL, *truth = NULL, *out = NULL;
    struct evaluate_params params = EVALUATE_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Measures a scene's products against the truth and against photographs that were held out."),
        CLI_STR("folder", &folder, CLI_REQUIRED, "folder of the scene's products"),
        CLI_STR("shared", &shared, CLI_REQUIRED, "folder of its photo records, shared by qualities"),
        CLI_STR("truth", &truth, CLI_OPTIONAL, "folder of true cameras and depths"),
        CLI_STR("out", &out, CLI_REQUIRED, "table to write, metrics.tsv"),
        CLI_PARAMS(evaluate_param_table, &params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "evaluate", opts, &prov, &err) != CLI_RUN ||
        evaluate(folder, shared, truth, out, &params, &prov, &err))
        err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
