/* run_colmap.c - COLMAP's sparse reconstruction: verified matches, mapping, conversion to text.
 *
 * If the mapper finds no model that holds together, it runs again with relaxed thresholds; sets of a few photos taken
 * close together need this. If its largest model has too few photos, it runs again from other photos. */
#include "stages/sfm/run_colmap.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/clock.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/base/outfile.h"
#include "stages/sfm/colmap_log.h"
#include "stages/sfm/colmap_matches.h"
#include "stages/sfm/panorama_rigs.h"
#include "stages/sfm/start_photos.h"

#define MORE_STARTS 4  /* at most */
#define ENOUGH      90 /* per cent of the largest group of photos that verified matches connect */
#define MIN_POINTS  40 /* of a model; photos from one spot give models of three photos and a few points */

struct mapping {
    struct colmap_job job;
    struct sfm_folder *folder;
    const struct provenance *prov;
    int *placed; /* ids of the images of the largest model; owned */
    int placed_count;
    bool relaxed; /* the first pair was found only so */
};

static enum status explain_failure(const struct colmap_job *job, struct err *err)
{
    char few[700], linked[60] = "";
    const int connected = colmap_log_connected(job->logs[2]);
    colmap_list_poor(few, sizeof few, job->features, job->photos);
    if (connected > 0) snprintf(linked, sizeof linked, ", though %d match another one", connected);
    if (connected == 0)
        err_set(err, ST_DATA,
                "COLMAP placed none of the %d photos: no two of them match. Take photos that overlap, from places a "
                "step apart%s%s.",
                job->photos->count, *few ? "; few features: " : "", few);
    else
        err_set(err, ST_DATA,
                "COLMAP placed none of the %d photos%s. They may all be taken from one "
                "spot (step aside between photos, do not just turn) or overlap too little%s%s. Its log is %s.",
                job->photos->count, linked, *few ? "; few features: " : "", few, job->logs[2]);
    return err->status;
}

static enum status keep_placed(struct mapping *m, const struct sfm_model *model, struct err *err)
{
    int *ids = realloc(m->placed, ((size_t)model->image_count + 1) * sizeof *ids);
    if (!ids) return err_nomem(err, "ids of photos", (size_t)model->image_count * sizeof *ids);
    for (int i = 0; i < model->image_count; i++) ids[i] = (int)model->images[i].id;
    m->placed = ids;
    m->placed_count = model->image_count;
    return ST_OK;
}

/* Converts COLMAP's model number k in a folder to text, checks it, and adds it if it has enough points and more than
 * `above` photos. */
static enum status add_model(struct mapping *m, const char *sparse, int k, int above, struct err *err)
{
    const struct colmap_job *job = &m->job;
    struct sfm_model model = {0};
    char *from = sfm_text_format(err, "%s/%d", sparse, k), *text = sfm_text_format(err, "%s/%d.text", sparse, k);
    const char *args[] = {"model_converter", "--input_path", from, "--output_path", text, "--output_type", "TXT", NULL};
    if (from && text && !outfile_make_folders(text, err) && !colmap_run(job->logs[3], args, 0, err))
        sfm_model_read_text(&model, text, NULL, err);
    if (!err->status) {
        const bool enough = model.point_count >= MIN_POINTS;
        log_note("model: %d of %d photos, %d points%s", model.image_count, job->photos->count, model.point_count,
                 enough ? "" : "; too few points, not used");
        if (enough && model.image_count > above && !colmap_name_images(&model, job->photos, err) &&
            !panorama_rigs_join(&model, err) && !sfm_folder_add(m->folder, &model, m->prov, err) &&
            model.image_count > m->placed_count)
            keep_placed(m, &model, err);
    }
    sfm_model_release(&model);
    free(from);
    free(text);
    return err->status;
}

static int count_models(const char *sparse, struct err *err)
{
    for (int k = 0;; k++) {
        char *path = sfm_text_format(err, "%s/%d", sparse, k);
        bool exists = path && path_is_folder(path);
        free(path);
        if (!exists) return k;
    }
}

/* Maps into a folder, where COLMAP itself starts, and adds all models. */
static enum status map_into(struct mapping *m, const char *folder, struct err *err)
{
    if (colmap_map(&m->job, &(struct colmap_start){.folder = folder, .relaxed = m->relaxed}, err)) return err->status;
    const int models = count_models(folder, err);
    if (!err->status && models)
        log_note("step 4 of %d: text of %d models (%.1f s so far)", COLMAP_STEPS, models,
                 clock_seconds() - m->job.started);
    for (int k = 0; !err->status && k < models; k++) add_model(m, folder, k, 0, err);
    return err->status;
}

static enum status map_photos(struct mapping *m, struct err *err)
{
    if (map_into(m, m->job.sparse, err) || m->placed_count) return err->status;
    log_note("no model holds together; trying again with smaller angles and fewer matches");
    m->relaxed = true;
    char *folder = sfm_text_format(err, "%s-1", m->job.sparse);
    if (folder && !outfile_make_folders(folder, err)) map_into(m, folder, err);
    free(folder);
    if (!err->status && !m->placed_count) explain_failure(&m->job, err);
    return err->status;
}

static bool are_enough(const struct mapping *m, int linked) { return 100LL * m->placed_count >= ENOUGH * linked; }

/* Maps from other photos while the largest model has too few; adds what is larger. */
static enum status map_again(struct mapping *m, struct err *err)
{
    struct colmap_database *db = NULL;
    struct verified_pair *pairs = NULL;
    int count = 0, ids[MORE_STARTS], starts = 0, linked = 0;
    if (!colmap_database_open(&db, m->job.database, err)) colmap_database_pairs(&pairs, &count, db, err);
    colmap_database_close(db);
    if (!err->status)
        start_photos_choose(ids, &starts, MORE_STARTS, &linked, pairs, count, m->placed, m->placed_count, err);
    free(pairs);
    for (int i = 0; !err->status && i < starts && !are_enough(m, linked); i++) {
        char *folder = sfm_text_format(err, "%s-%d", m->job.sparse, i + 2);
        log_note("%d of the %d photos with verified matches are placed; mapping again from another photo (attempt %d, "
                 "%.1f s so far)",
                 m->placed_count, linked, i + 2, clock_seconds() - m->job.started);
        if (folder && !outfile_make_folders(folder, err) &&
            !colmap_map(&m->job, &(struct colmap_start){.folder = folder, .image = ids[i], .relaxed = m->relaxed},
                        err) &&
            count_models(folder, err) && !err->status)
            add_model(m, folder, 0, m->placed_count, err);
        free(folder);
    }
    return err->status;
}

enum status run_colmap(struct sfm_folder *f, const struct sfm_input *in, const struct provenance *prov, struct err *err)
{
    struct mapping m = {.folder = f, .prov = prov};
    long long features = 0;
    if (in->list->count < 2)
        return err_set(err, ST_DATA,
                       "there %s; structure from motion needs at least 2, better 8 or more, taken a step apart.",
                       in->list->count ? "is only 1 photo" : "are no photos");
    f->given = strcmp(in->params->refine_camera, "no") ? "nothing" : "lens";
    if (!colmap_prepare(&m.job, f, in, in->params, err)) colmap_take_matches(&features, &m.job, err);
    if (m.job.known) f->given = "model"; /* joined rigs are not taken apart again */
    if (!err->status && !features)
        err_set(err, ST_DATA, "none of the %d photos has features: they are blank, masked or unreadable.",
                in->list->count);
    if (!err->status)
        log_note("step 3 of %d: poses and points (%.1f s so far)", COLMAP_STEPS, clock_seconds() - m.job.started);
    if (!err->status && !map_photos(&m, err) && !map_again(&m, err)) colmap_keep_logs(&m.job, err);
    colmap_job_release(&m.job);
    free(m.placed);
    return err->status;
}
