/* report.c - one page about a scene: video, photographs, depth, figures, times, parameters, and what was left out.
 *
 * reads   FOLDER/{views,depth,parallax,log,slice}, SHARED/{photos,log,slice}   whatever is there of them
 *         FOLDER/metrics.tsv, evaluate, holdout   what was measured, the truth, held-out photographs
 *         FOLDER/model, remodel          the solid models' pictures
 *         PHOTOS/FILE                    the photographs, for thumbnails
 *         DEFAULTS                       the default parameters, so that changed ones stand out
 * writes  OUT                            HTML with everything inside; what is missing is said there */
#include "common/base/cli.h"
#include "common/base/outfile.h"
#include "stages/report/page.h"

int main(int argc, char **argv)
{
    const char *scene = NULL, *folder = NULL, *shared = NULL, *photos = NULL, *defaults = NULL, *out = NULL;
    const struct cli_opt opts[] = {
        CLI_ABOUT("writes one HTML page about a scene, with its video, pictures and figures inside"),
        CLI_STR("scene", &scene, CLI_REQUIRED, "the scene's name, for the title"),
        CLI_STR("folder", &folder, CLI_REQUIRED, "folder of the scene's products"),
        CLI_STR("shared", &shared, CLI_REQUIRED, "folder of its photo records and SfM, shared by qualities"),
        CLI_STR("photos", &photos, CLI_REQUIRED, "folder of the photographs"),
        CLI_STR("defaults", &defaults, CLI_OPTIONAL, "default configuration, to mark parameters that differ"),
        CLI_STR("out", &out, CLI_REQUIRED, "HTML file to write"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct contents contents = {0};
    struct outfile page = {0};
    struct err err = ERR_INIT;
    enum cli_verdict verdict = cli_parse(argc, argv, "report", opts, &prov, &err);

    if (verdict == CLI_RUN && !contents_read(&contents, folder, shared, photos, defaults, &err) &&
        !outfile_open(&page, out, &err) && !page_write(page.fp, scene, &contents, &err))
        outfile_commit(&page, &err);
    err_report(&err);

    outfile_discard(&page);
    contents_release(&contents);
    provenance_release(&prov);
    return err_exit_code(&err);
}
