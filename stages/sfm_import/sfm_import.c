/* sfm_import.c - chooses a structure-from-motion model, refines it and converts it into rectified pinhole views.
 *
 * reads   SFM/models.txt, photos.txt, N/{cameras,images,points3D}.txt   the models, in COLMAP's text format
 *         RECORDS/list.txt, ID.txt                                      the photos' names and sizes
 * writes  OUT/points3D.txt, cameras.txt, images.txt                     the views' pinhole cameras and the points they
 * see
 *         OUT/lenses.txt                                                photo and lens of each view
 *         OUT/residuals.txt, lens_forms.txt                             reprojection errors; the forms of lens compared
 *         OUT/views.mk                                                  names of the views, for Make; written last
 *         OUT/../holdout/views/                                         the same files for held-out views */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/outfile.h"
#include "common/product/product.h"
#include "stages/sfm_import/choose_model.h"
#include "stages/sfm_import/holdout.h"
#include "stages/sfm_import/place_siblings.h"
#include "stages/sfm_import/refine_cameras.h"

struct holdout { /* views to hold out; every 0 and names NULL: none */
    int every;
    const char *names;
};

/* OUT/views.mk is written last of all files. */
static enum status write_split(const struct imported *all, const struct holdout *which, const char *out,
                               const struct provenance *prov, struct err *err)
{
    struct imported kept = {0}, held = {0};
    size_t size = strlen(out) + 32;
    bool *marks = calloc((size_t)all->lenses.count + 1, sizeof *marks);
    char *folder = malloc(size);
    if (!marks || !folder) err_nomem(err, "views", size);
    if (!err->status) snprintf(folder, size, "%s/../holdout/views", out);
    if (!err->status && !outfile_make_folders(out, err) &&
        !holdout_choose(marks, &all->lenses, which->every, which->names, err) &&
        !holdout_split(&kept, &held, all, marks, err) && !import_write(&held, folder, prov, err))
        import_write(&kept, out, prov, err);
    import_release(&kept);
    import_release(&held);
    free(folder);
    free(marks);
    return err->status;
}

static enum status write_reports(const struct imported *in, const struct refinement *refinement,
                                 const struct sfm_model *model, const struct photo_list *photos, const char *out,
                                 const struct provenance *prov, struct err *err)
{
    char residuals[FILE_PATH], forms[FILE_PATH];
    return outfile_make_folders(out, err) || product_path_in(residuals, out, PRODUCT_RESIDUALS, NULL, err) ||
                   product_path_in(forms, out, PRODUCT_LENS_FORMS, NULL, err) ||
                   residual_table_write(&in->residuals, photos, residuals, prov, err) ||
                   refine_cameras_write(refinement, model, photos, forms, prov, err)
               ? err->status
               : ST_OK;
}

static enum status run(const char *sfm, const char *records, const char *out, const struct holdout *held,
                       struct split_size split, const struct sfm_import_params *params, struct provenance *prov,
                       struct err *err)
{
    struct photo_list photos = {0};
    struct sfm_model model = {0};
    struct imported imported = {0};
    struct refinement refinement = {.chosen = -1};
    enum given_cameras given = GIVEN_MODEL;
    char *name = NULL;
    if (!photo_list_read(&photos, records, err) && !import_choose(&model, &name, &given, sfm, &photos, prov, err) &&
        !import_check_photos(sfm, &photos, err))
        refine_cameras(&refinement, &model, given, split, params, err);
    if (!refinement.rig.lenses) split = (struct split_size){0}; /* its lenses do not keep their poses */
    if (!err->status && given != GIVEN_MODEL) place_siblings(&model, &photos, split, err);
    if (!err->status && import_model(&imported, &model, &photos, params, err)) err_context(err, "%s/%s", sfm, name);
    if (!err->status) write_reports(&imported, &refinement, &model, &photos, out, prov, err);
    if (!err->status && (held->every || (held->names && *held->names)))
        write_split(&imported, held, out, prov, err);
    else if (!err->status)
        import_write(&imported, out, prov, err);
    import_release(&imported);
    refine_cameras_release(&refinement);
    sfm_model_release(&model);
    photo_list_release(&photos);
    free(name);
    return err->status;
}

int main(int argc, char **argv)
{
    const char *sfm = NULL, *records = NULL, *out = NULL, *grid = NULL;
    struct holdout held = {0};
    struct split_size split = {0};
    struct sfm_import_params params = SFM_IMPORT_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Chooses a structure-from-motion model, checks it and converts it into rectified pinhole views."),
        CLI_STR("sfm", &sfm, CLI_REQUIRED, "folder of the models"),
        CLI_STR("records", &records, CLI_REQUIRED, "folder of the photos' records"),
        CLI_STR("out", &out, CLI_REQUIRED, "folder to write the views' cameras, points and lenses to"),
        CLI_INT("holdout", &held.every, CLI_OPTIONAL,
                "hold out every Nth photo in order of name, the first included; its views go to OUT/../holdout"),
        CLI_STR("holdout-views", &held.names, CLI_OPTIONAL,
                "views to hold out, or photos, which means all their views: \"NAME NAME\""),
        CLI_STR("split", &grid, CLI_OPTIONAL,
                "COLUMNSxROWS of pictures ID_cXrY in each photo of a multi-lens camera, such as 3x2: its lenses keep "
                "their relative poses, unless the pictures contradict that"),
        CLI_PARAMS(sfm_import_param_table, &params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    enum cli_verdict verdict = cli_parse(argc, argv, "sfm_import", opts, &prov, &err);
    if (verdict == CLI_RUN && held.every < 0)
        err_set(&err, ST_USAGE, "--holdout %d: wanted N from 1, to hold out every Nth photo.", held.every);
    else if (verdict == CLI_RUN && !(grid && split_size_parse(&split, grid, &err)))
        run(sfm, records, out, &held, split, &params, &prov, &err);
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
