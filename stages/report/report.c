/* report.c - two pages about a scene: what was made, for people, and how it was made, in numbers.
 *
 * reads   FOLDER/{views,depth,parallax,log,slice}, SHARED/{photos,log,slice}   as far as they exist
 *         FOLDER/metrics.tsv, evaluate, holdout   metrics, the truth, held-out photographs
 *         FOLDER/model, remodel          models, their pictures, pictures of edits
 *         FOLDER/{vdta,vita,ids}         texture atlases, and what the views show of the model
 *         FOLDER/{lights,relight}        lamps, materials, irradiance, with their pictures
 *         FOLDER/relight/E, evaluate/relit/E   edits in the light that they make, and their truth
 *         SCRIPTS/E.txt                  what edits say of themselves
 *         PHOTOS/FILE                    the photographs, for thumbnails
 *         DEFAULTS                       the default parameters; the page marks those that differ
 *         FOLDER/lux                     with --levels: light by groups, pictures, tables
 *         PAGE/{page.css,numbers.css,page.js,...}   styles and scripts, which go into the pages
 * writes  page/NAME.{jpg,png,svg} beside OUT   pictures, named by what they show
 *         page/numbers.html beside OUT   the page of numbers; not with --remodel
 *         OUT                            the page, last. Then pictures of an older page are removed */
#include <string.h>

#include "common/base/cli.h"
#include "common/base/outfile.h"
#include "common/product/product.h"
#include "stages/report/page.h"
#include "stages/report/page_levels.h"
#include "stages/report/page_remodel.h"

struct job {
    const char *scene, *out, *parts, *back;
    char folder[FILE_PATH]; /* of the pictures */
    struct name_list pictures;
};

/* Writes one page through an outfile. */
struct writing {
    struct page page;
    struct outfile file;
};

static enum status begin_page(struct writing *w, const struct job *job, const char *path, const char *address,
                              const char *scene, struct err *err)
{
    *w = (struct writing){.page = {.parts = job->parts, .folder = job->folder, .address = address, .scene = scene}};
    if (outfile_open(&w->file, path, err)) return err->status;
    w->page.to = w->file.fp;
    return ST_OK;
}

static enum status end_page(struct writing *w, struct job *job, struct err *err)
{
    if (!err->status) outfile_commit(&w->file, err);
    for (int i = 0; !err->status && i < w->page.pictures.count; i++)
        name_list_add(&job->pictures, w->page.pictures.names[i], strlen(w->page.pictures.names[i]), err);
    outfile_discard(&w->file);
    name_list_release(&w->page.pictures);
    return err->status;
}

static enum status write_scene_pages(struct job *job, const struct contents_sources *from, struct err *err)
{
    struct contents contents = {0};
    struct writing w = {0};
    char numbers[FILE_PATH];
    const char *file = strrchr(job->out, '/') ? strrchr(job->out, '/') + 1 : job->out;
    char back[FILE_PATH];
    snprintf(back, sizeof back, "../%s", file);
    if (!contents_read(&contents, from, err) && !file_path(numbers, job->folder, "numbers.html", "", err)) {
        if (!begin_page(&w, job, numbers, "", "../", err))
            page_write_numbers(&w.page, job->scene, back, &contents, err);
        end_page(&w, job, err);
        if (!err->status && !begin_page(&w, job, job->out, "page/", "", err))
            page_write(&w.page, job->scene, "page/numbers.html", &contents, err);
        end_page(&w, job, err);
    }
    contents_release(&contents);
    return err->status;
}

static enum status write_remodel_page(struct job *job, const struct remodel_sources *from, struct err *err)
{
    struct remodel_contents contents = {0};
    struct writing w = {0};
    if (!remodel_contents_read(&contents, from, err) && !begin_page(&w, job, job->out, "page/", "../", err))
        remodel_page_write(&w.page, job->scene, job->back, &contents, err);
    end_page(&w, job, err);
    remodel_contents_release(&contents);
    return err->status;
}

/* The page of light levels has no pictures of its own. */
static enum status write_levels_page(struct job *job, const char *folder, struct err *err)
{
    const struct levels_sources from = {job->scene, folder, job->back};
    struct writing w = {0};
    if (!begin_page(&w, job, job->out, "", "../", err)) levels_page_write(&w.page, &from, err);
    return end_page(&w, job, err);
}

/* The folder `page` beside the page. */
static enum status find_folder(struct job *job, struct err *err)
{
    const char *slash = strrchr(job->out, '/');
    const int length = slash ? (int)(slash - job->out) + 1 : 0;
    if (snprintf(job->folder, sizeof job->folder, "%.*spage", length, job->out) >= (int)sizeof job->folder)
        return err_set(err, ST_USAGE, "--out: the path is too long.");
    return outfile_make_folders(job->folder, err);
}

static enum status check_usage(bool levels, bool remodel, const struct contents_sources *from, const char *back,
                               const char *quality, struct err *err)
{
    if (levels && remodel) return err_set(err, ST_USAGE, "wanted --remodel or --levels, not both.");
    if (remodel || levels ? from->stages || from->defaults : !from->photos || !from->stages)
        return err_set(err, ST_USAGE,
                       "wanted --photos and --stages, or --remodel or --levels without --stages; see --help.");
    if (quality && !remodel) return err_set(err, ST_USAGE, "--quality goes with --remodel.");
    if (back && !remodel && !levels) return err_set(err, ST_USAGE, "--back goes with --remodel or --levels.");
    return ST_OK;
}

int main(int argc, char **argv)
{
    const char *quality = NULL;
    struct job job = {.parts = "stages/report/page"};
    bool remodel = false, levels = false;
    struct contents_sources from = {0};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Writes two HTML pages about a scene: what was made, for people, and how, in numbers."),
        CLI_STR("scene", &job.scene, CLI_REQUIRED, "name of the scene, for the title"),
        CLI_STR("folder", &from.folder, CLI_REQUIRED, "folder of the scene's products"),
        CLI_STR("shared", &from.shared, CLI_REQUIRED, "folder of its photo records and SfM, shared by all qualities"),
        CLI_STR("photos", &from.photos, CLI_OPTIONAL, "folder of the photographs"),
        CLI_STR("stages", &from.stages, CLI_OPTIONAL, "names of all stages in data-flow order, separated by spaces"),
        CLI_STR("defaults", &from.defaults, CLI_OPTIONAL,
                "default configuration; the page marks parameters that differ"),
        CLI_STR("scripts", &from.scripts, CLI_OPTIONAL, "folder of the edits' scripts, whose comments are shown"),
        CLI_STR("page", &job.parts, CLI_OPTIONAL, "folder of the pages' parts: styles and scripts"),
        CLI_FLAG("remodel", &remodel,
                 "instead: the page of remodelled rooms, each edit with its plan, films and files"),
        CLI_FLAG("levels", &levels, "instead: the page of light levels, of what make lux has made"),
        CLI_STR("back", &job.back, CLI_OPTIONAL,
                "with --remodel or --levels: address of the scene's page, to link to, relative to OUT"),
        CLI_STR("quality", &quality, CLI_OPTIONAL,
                "with --remodel: quality of the run, for the commands that the page names; default: default"),
        CLI_STR("out", &job.out, CLI_REQUIRED, "HTML file to write; its pictures go into the folder page beside it"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "report", opts, &prov, &err) == CLI_RUN &&
        !check_usage(levels, remodel, &from, job.back, quality, &err) &&
        !(levels ? write_levels_page(&job, from.folder, &err) : find_folder(&job, &err)) && !levels) {
        const struct remodel_sources edits = {{from.folder, from.shared, from.photos, from.scripts}, quality};
        if (!(remodel ? write_remodel_page(&job, &edits, &err) : write_scene_pages(&job, &from, &err)))
            page_remove_old(job.folder, &job.pictures);
    }
    err_report(&err);
    name_list_release(&job.pictures);
    provenance_release(&prov);
    return err_exit_code(&err);
}
