/* report.c - one page about a scene: videos, photographs, depth, key numbers, times, parameters, and what was left out.
 *
 * reads   FOLDER/{views,depth,parallax,log,slice}, SHARED/{photos,log,slice}   as far as they exist
 *         FOLDER/metrics.tsv, evaluate, holdout   metrics, the truth, held-out photographs
 *         FOLDER/model, remodel          pictures of the solid models
 *         FOLDER/{vdta,vita,ids}         texture atlases, and what the views show of the model
 *         PHOTOS/FILE                    the photographs, for thumbnails
 *         DEFAULTS                       the default parameters; the page marks those that differ
 * writes  OUT                            self-contained HTML; it lists the products that are missing */
#include "common/base/cli.h"
#include "common/base/outfile.h"
#include "stages/report/page.h"

int main(int argc, char **argv)
{
    const char *scene = NULL, *out = NULL;
    struct contents_sources from = {0};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Writes one self-contained HTML page about a scene: videos, pictures, key numbers."),
        CLI_STR("scene", &scene, CLI_REQUIRED, "name of the scene, for the title"),
        CLI_STR("folder", &from.folder, CLI_REQUIRED, "folder of the scene's products"),
        CLI_STR("shared", &from.shared, CLI_REQUIRED, "folder of its photo records and SfM, shared by all qualities"),
        CLI_STR("photos", &from.photos, CLI_REQUIRED, "folder of the photographs"),
        CLI_STR("stages", &from.stages, CLI_REQUIRED, "names of all stages in data-flow order, separated by spaces"),
        CLI_STR("defaults", &from.defaults, CLI_OPTIONAL,
                "default configuration; the page marks parameters that differ"),
        CLI_STR("out", &out, CLI_REQUIRED, "HTML file to write"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct contents contents = {0};
    struct outfile page = {0};
    struct err err = ERR_INIT;
    enum cli_verdict verdict = cli_parse(argc, argv, "report", opts, &prov, &err);

    if (verdict == CLI_RUN && !contents_read(&contents, &from, &err) && !outfile_open(&page, out, &err) &&
        !page_write(page.fp, scene, &contents, &err))
        outfile_commit(&page, &err);
    err_report(&err);

    outfile_discard(&page);
    contents_release(&contents);
    provenance_release(&prov);
    return err_exit_code(&err);
}
