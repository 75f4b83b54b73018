/* run_colmap.c - COLMAP's sparse reconstruction: verified matches, mapping, conversion to text. If the mapper finds no
 * initial pair it runs again with relaxed thresholds, as sets of a few photos taken close together need. */
#include "stages/sfm/run_colmap.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/clock.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/base/outfile.h"
#include "stages/sfm/colmap_log.h"
#include "stages/sfm/colmap_matches.h"

static enum status explain_failure(const struct colmap_job *job, struct err *err)
{
    char few[700];
    int connected = colmap_log_connected(job->logs[2]);
    colmap_list_poor(few, sizeof few, job->features, job->photos);
    if (connected == 0)
        err_set(err, ST_DATA,
                "COLMAP placed none of the %d photos: no two of them match. Take photos that overlap, from places a "
                "step apart%s%s.",
                job->photos->count, *few ? "; few features: " : "", few);
    else
        err_set(err, ST_DATA,
                "COLMAP placed none of the %d photos, though %d match another one. They may all be taken from one "
                "spot (step aside between photos, do not just turn) or overlap too little%s%s. Its log is %s.",
                job->photos->count, connected, *few ? "; few features: " : "", few, job->logs[2]);
    return err->status;
}

/* Converts COLMAP's model number k to text, checks it and adds it to the folder. */
static enum status add_model(const struct colmap_job *job, struct sfm_folder *f, int k, const struct provenance *prov,
                             struct err *err)
{
    struct sfm_model m = {0};
    char *from = sfm_text_format(err, "%s/%d", job->sparse, k), *text = sfm_text_format(err, "%s/text/%d", f->work, k);
    const char *args[] = {"model_converter", "--input_path", from, "--output_path", text, "--output_type", "TXT", NULL};
    if (from && text && !outfile_make_folders(text, err) && !colmap_run(job, 4, args, 0, err) &&
        !sfm_model_read_text(&m, text, NULL, err)) {
        log_note("model %d: %d of %d photos, %d points", k, m.image_count, job->photos->count, m.point_count);
        if (!colmap_name_images(&m, job->photos, err)) sfm_folder_add(f, &m, prov, err);
    }
    sfm_model_release(&m);
    free(from);
    free(text);
    return err->status;
}

static int count_models(const struct colmap_job *job, struct err *err)
{
    for (int k = 0;; k++) {
        char *path = sfm_text_format(err, "%s/%d", job->sparse, k);
        bool exists = path && path_is_folder(path);
        free(path);
        if (!exists) return k;
    }
}

enum status run_colmap(struct sfm_folder *f, const struct sfm_input *in, const struct provenance *prov, struct err *err)
{
    struct colmap_job job = {0};
    long long features = 0;
    int models = 0;
    if (in->list->count < 2)
        return err_set(err, ST_DATA,
                       "there %s; structure from motion needs at least 2, better 8 or more, taken a step apart.",
                       in->list->count ? "is only 1 photo" : "are no photos");
    f->given = strcmp(in->params->refine_camera, "no") ? "nothing" : "lens";
    if (!colmap_prepare(&job, f, in, in->params, err)) colmap_take_matches(&features, &job, err);
    if (!err->status && !features)
        err_set(err, ST_DATA, "none of the %d photos has features: they are blank, masked or unreadable.",
                in->list->count);
    if (!err->status)
        log_note("step 3 of %d: poses and points (%.1f s so far)", COLMAP_STEPS, clock_seconds() - job.started);
    if (!err->status) colmap_map(&job, false, err);
    if (!err->status && !(models = count_models(&job, err))) {
        log_note("no pair of photos is good enough to start from; trying again with smaller angles and fewer matches");
        if (!colmap_map(&job, true, err)) models = count_models(&job, err);
    }
    if (!err->status && !models) explain_failure(&job, err);
    if (!err->status)
        log_note("step 4 of %d: text of %d models (%.1f s so far)", COLMAP_STEPS, models,
                 clock_seconds() - job.started);
    for (int k = 0; !err->status && k < models; k++) add_model(&job, f, k, prov, err);
    if (!err->status) colmap_keep_logs(&job, err);
    colmap_job_release(&job);
    return err->status;
}
