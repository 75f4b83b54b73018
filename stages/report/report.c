/* report.c - one page about a scene: videos, photographs, depth, key numbers, times, parameters, and what was left out.
 *
 * reads   FOLDER/{views,depth,parallax,log,slice}, SHARED/{photos,log,slice}   as far as they exist
 *         FOLDER/metrics.tsv, evaluate, holdout   metrics, the truth, held-out photographs
 *         FOLDER/model, remodel          pictures of the solid models
 *         FOLDER/{vdta,vita,ids}         texture atlases, and what the views show of the model
 *         FOLDER/{lights,relight}        lamps, materials, irradiance, with their pictures
 *         FOLDER/relight/E, evaluate/relit/E   edits in the light that they make, and their truth
 *         FOLDER/remodel/E/pictures      with --remodel: pictures of edits, and SCRIPTS/E.txt for what they say of
 *                                        themselves
 *         PHOTOS/FILE                    the photographs, for thumbnails
 *         DEFAULTS                       the default parameters; the page marks those that differ
 * writes  OUT                            self-contained HTML; it lists the products that are missing */
#include "common/base/cli.h"
#include "common/base/file_path.h"
#include "common/base/outfile.h"
#include "stages/report/page.h"
#include "stages/report/page_remodel.h"

static enum status write_page(FILE *to, const char *scene, const struct contents_sources *from, struct err *err)
{
    struct contents contents = {0};
    if (!contents_read(&contents, from, err)) page_write(to, scene, &contents, err);
    contents_release(&contents);
    return err->status;
}

static enum status write_remodel_page(FILE *to, const char *scene, const char *back, const struct remodel_sources *from,
                                      struct err *err)
{
    struct remodel_contents contents = {0};
    if (!remodel_contents_read(&contents, from, err)) remodel_page_write(to, scene, back, &contents, err);
    remodel_contents_release(&contents);
    return err->status;
}

static enum status check_usage(bool remodel, const struct contents_sources *from, const char *scripts, const char *back,
                               struct err *err)
{
    if (remodel ? from->photos || from->stages || from->defaults : !from->photos || !from->stages)
        return err_set(err, ST_USAGE, "wanted --photos and --stages, or --remodel without them; see --help.");
    if ((scripts || back) && !remodel)
        return err_set(err, ST_USAGE, "--scripts, --back and --quality go with --remodel.");
    return ST_OK;
}

int main(int argc, char **argv)
{
    const char *scene = NULL, *out = NULL, *scripts = NULL, *back = NULL, *quality = NULL;
    bool remodel = false;
    struct contents_sources from = {0};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Writes one self-contained HTML page about a scene: videos, pictures, key numbers."),
        CLI_STR("scene", &scene, CLI_REQUIRED, "name of the scene, for the title"),
        CLI_STR("folder", &from.folder, CLI_REQUIRED, "folder of the scene's products"),
        CLI_STR("shared", &from.shared, CLI_REQUIRED, "folder of its photo records and SfM, shared by all qualities"),
        CLI_STR("photos", &from.photos, CLI_OPTIONAL, "folder of the photographs"),
        CLI_STR("stages", &from.stages, CLI_OPTIONAL, "names of all stages in data-flow order, separated by spaces"),
        CLI_STR("defaults", &from.defaults, CLI_OPTIONAL,
                "default configuration; the page marks parameters that differ"),
        CLI_FLAG("remodel", &remodel, "instead: the page of remodelled rooms, each edit before and after"),
        CLI_STR("scripts", &scripts, CLI_OPTIONAL,
                "with --remodel: folder of the edits' scripts, whose comments are shown"),
        CLI_STR("back", &back, CLI_OPTIONAL,
                "with --remodel: address of the scene's page, to link to, relative to OUT"),
        CLI_STR("quality", &quality, CLI_OPTIONAL,
                "with --remodel: quality of the run, for the commands that the page names; default: default"),
        CLI_STR("out", &out, CLI_REQUIRED, "HTML file to write"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct outfile page = {0};
    struct err err = ERR_INIT;
    char records[FILE_PATH];
    if (cli_parse(argc, argv, "report", opts, &prov, &err) == CLI_RUN &&
        !check_usage(remodel, &from, scripts ? scripts : quality, back, &err) &&
        !file_path(records, from.shared, "photos", "", &err) && !outfile_open(&page, out, &err)) {
        const struct remodel_sources edits = {from.folder, records, scripts, quality};
        if (!(remodel ? write_remodel_page(page.fp, scene, back, &edits, &err)
                      : write_page(page.fp, scene, &from, &err)))
            outfile_commit(&page, &err);
    }
    err_report(&err);
    outfile_discard(&page);
    provenance_release(&prov);
    return err_exit_code(&err);
}
