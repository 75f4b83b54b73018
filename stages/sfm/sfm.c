/* sfm.c - finds the cameras of the photographs with COLMAP, or imports an existing model.
 *
 * reads   PHOTOS/FILE, RECORDS/list.txt, ID.txt    the photos and their records; of one photo these alone
 *         FEATURES/ID.txt, MATCHES/ID.txt          their features and matches
 *         MODEL                                    a model of COLMAP or another program (user_model.h)
 * writes  OUT/N/{cameras,images,points3D}.txt      the models; images have the photos' file names
 *         OUT/photos.txt                           ids and hashes of the photos
 *         OUT/models.txt                           the list of models
 *
 * --judge prints "enough" or "few" instead: whether the points of the model serve the photos; with --depth it makes
 * links to the depth maps that the model names.
 *
 * OUT is written in OUT.work and replaced as a whole. */
#include <stdbool.h>
#include <stdio.h>

#include "common/base/cli.h"
#include "stages/sfm/run_colmap.h"
#include "stages/sfm/single_photo.h"
#include "stages/sfm/transforms_model.h"
#include "stages/sfm/user_model.h"

static enum status run(const struct sfm_input *given, const char *records, const char *model, const char *out,
                       struct provenance *prov, struct err *err)
{
    struct photo_list list = {0};
    struct sfm_folder folder = {0};
    struct sfm_input in = *given;
    in.list = &list;
    in.prov = prov;
    if (!photo_list_read(&list, records, err)) sfm_folder_open(&folder, out, err);
    if (!err->status && model)
        user_model_add(&folder, model, &in, prov, err);
    else if (!err->status && list.count == 1)
        single_photo_add(&folder, &list, in.params, prov, err);
    else if (!err->status && (!in.features || !in.matches))
        err_set(err, ST_USAGE, "--features and --matches are required unless --model is given or there is one photo.");
    else if (!err->status)
        run_colmap(&folder, &in, prov, err);
    if (!err->status) sfm_folder_commit(&folder, &list, prov, err);
    sfm_folder_release(&folder);
    photo_list_release(&list);
    return err->status;
}

/* depth: a folder for links to depth maps, or NULL. */
static enum status judge(const char *records, const char *model, const char *depth, struct err *err)
{
    struct photo_list list = {0};
    bool suffice = false;
    int maps = 0;
    if (!photo_list_read(&list, records, err) && !user_model_judge(&suffice, model, &list, err) &&
        !(depth && transforms_link_depth(&maps, depth, model, &list, err)))
        puts(suffice ? "enough" : "few");
    photo_list_release(&list);
    return err->status;
}

int main(int argc, char **argv)
{
    const char *records = NULL, *model = NULL, *out = NULL, *depth = NULL;
    struct sfm_params params = SFM_PARAMS_DEFAULT;
    struct sfm_input in = {.params = &params};
    bool judges = false;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Finds the cameras of the photographs with COLMAP, or imports an existing model."),
        CLI_STR("photos", &in.photos, CLI_OPTIONAL, "folder of photographs (required, with --out)"),
        CLI_STR("records", &records, CLI_REQUIRED, "folder of the photos' records"),
        CLI_STR("features", &in.features, CLI_OPTIONAL,
                "folder of the photos' features; needed where no model is given"),
        CLI_STR("matches", &in.matches, CLI_OPTIONAL, "folder of the photos' matches; needed where no model is given"),
        CLI_STR("model", &model, CLI_OPTIONAL, "folder of cameras by COLMAP or another program"),
        CLI_STR("out", &out, CLI_OPTIONAL, "folder to write the models to; replaced as a whole"),
        CLI_FLAG("judge", &judges,
                 "instead: print whether the photos share enough points of the model: enough, or few; with --model"),
        CLI_STR("depth", &depth, CLI_OPTIONAL,
                "with --judge: folder to make, of links to the depth maps that the model names for photos"),
        CLI_PARAMS(sfm_param_table, &params, sfm_params_check),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    const enum cli_verdict verdict = cli_parse(argc, argv, "sfm", opts, &prov, &err);
    if (verdict == CLI_RUN && (judges ? !model : !(in.photos && out)))
        err_set(&err, ST_USAGE, "give --photos and --out, or else --model and --judge.");
    else if (verdict == CLI_RUN && judges)
        judge(records, model, depth, &err);
    else if (verdict == CLI_RUN)
        run(&in, records, model, out, &prov, &err);
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
