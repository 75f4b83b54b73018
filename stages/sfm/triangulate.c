/* triangulate.c - points for a model that has only cameras.
 *
 * Features and matches are those of a full reconstruction; COLMAP's point_triangulator then finds the points
 * with poses and lenses held fixed. The images written for it must have the names and ids of the database. */
#include "stages/sfm/triangulate.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/clock.h"
#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/capture/photo_match.h"
#include "stages/sfm/colmap_database.h"
#include "stages/sfm/colmap_log.h"
#include "stages/sfm/colmap_matches.h"

/* The lens for verifying matches: the model's, if it has only one. */
static void params_of_model(struct sfm_params *params, const struct sfm_model *m)
{
    if (m->camera_count != 1) {
        if (!sfm_is_equisolid(params)) return;
        strcpy(params->camera_model, "OPENCV_FISHEYE"); /* the model's lenses are used: no start is needed */
        *params->camera_params = '\0';
        return;
    }
    const struct camera *c = &m->cameras[0].camera;
    char text[PARAM_TEXT_SIZE] = "";
    size_t used = 0;
    for (int i = 0; i < camera_model_params(c->model) && used < sizeof text; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%.12g", i ? "," : "", c->params[i]);
    if (used >= sizeof text) return;
    snprintf(params->camera_model, sizeof params->camera_model, "%s", camera_model_name(c->model));
    memcpy(params->camera_params, text, sizeof text);
}

/* Writes the model's cameras and poses, its images with their names and ids in the database. */
static enum status write_known(const struct colmap_job *job, const struct sfm_model *m, const char *folder,
                               struct err *err)
{
    struct sfm_model known = {.cameras = m->cameras, .camera_count = m->camera_count};
    struct colmap_database *db = NULL;
    colmap_database_open(&db, job->database, err);
    known.images = calloc((size_t)m->image_count + 1, sizeof *known.images);
    if (!err->status && !known.images) err_nomem(err, "images", (size_t)m->image_count * sizeof *known.images);
    for (int i = 0; !err->status && i < m->image_count; i++) {
        int at = photo_list_match(job->photos, m->images[i].name);
        if (at < 0) continue;
        const struct photo_record *p = &job->photos->photos[at];
        char *name = sfm_text_format(err, "%s%s", p->id, colmap_extension(p->file));
        int id = 0;
        if (!name || colmap_database_image_id(&id, db, name, err) || !id) {
            free(name);
            continue;
        }
        known.images[known.image_count++] =
            (struct sfm_image){id, m->images[i].cam_from_world, m->images[i].camera_idx, name, NULL, 0};
    }
    if (!err->status && known.image_count < 2)
        err_set(err, ST_DATA,
                "the model has no points, and none can be triangulated: only %d of its %d images are readable photos "
                "of the scene. Use the model of these photos.",
                known.image_count, m->image_count);
    if (!err->status) sfm_model_write_text(&known, folder, NULL, err);
    for (int i = 0; i < known.image_count; i++) free(known.images[i].name);
    free(known.images);
    colmap_database_close(db);
    return err->status;
}

static bool sizes_match(const struct sfm_model *m, const struct photo_list *photos)
{
    for (int i = 0; i < m->image_count; i++) {
        int at = photo_list_match(photos, m->images[i].name);
        const struct camera *c = &m->cameras[m->images[i].camera_idx].camera;
        if (at >= 0 && (c->width != photos->photos[at].info.width || c->height != photos->photos[at].info.height))
            return false;
    }
    return true;
}

/* Runs COLMAP's triangulator on the cameras in `known`. *points: whether it made a model. It aborts in its bundle
 * adjustment if it found no points or kept none; that is not an error here. Tracks of two photos, which are more often
 * wrong, are used only if there are no longer ones. */
static enum status find_points(bool *points, const struct colmap_job *job, const char *known, const char *made,
                               struct err *err)
{
    *points = false;
    for (int pass = 0; !err->status && !*points && pass < 2; pass++) {
        const char *args[] = {"point_triangulator",
                              "--database_path",
                              job->database,
                              "--image_path",
                              job->images,
                              "--input_path",
                              known,
                              "--output_path",
                              made,
                              "--Mapper.num_threads",
                              "1", /* as in colmap_map() */
                              "--Mapper.tri_ignore_two_view_tracks",
                              pass ? "0" : "1",
                              NULL};
        const int aborted = 128 + SIGABRT;
        char line[512];
        int status = 0;
        colmap_exit_status(&status, job->logs[2], args, err);
        colmap_log_last_line(line, sizeof line, job->logs[2]);
        *points = !err->status && !status;
        if (!err->status && status && !(status == aborted && strstr(line, "bundle_adjuster.Solve")))
            colmap_failed(job->logs[2], args[0], status, err);
    }
    return err->status;
}

enum status triangulate(struct sfm_model *m, const struct sfm_folder *f, const struct sfm_input *in, struct err *err)
{
    struct colmap_job job = {0};
    struct sfm_model found = {0};
    struct sfm_params params = *in->params;
    long long features = 0;
    bool points = false;
    if (!in->features || !in->matches) {
        log_warn("the model has no points, and none can be found: features and matches of the photos were not given");
        return ST_OK;
    }
    if (!sizes_match(m, in->list)) {
        log_warn("the model has no points, and none can be found: its cameras differ from the photos in size");
        return ST_OK;
    }
    params_of_model(&params, m);
    char *known = sfm_text_format(err, "%s/known-%d", f->work, f->models);
    char *made = sfm_text_format(err, "%s/triangulated-%d", f->work, f->models);
    char *text = sfm_text_format(err, "%s/triangulated-text-%d", f->work, f->models);
    if (known && made && text) colmap_prepare(&job, f, in, &params, err);
    const char *converter[] = {"model_converter", "--input_path", made, "--output_path", text,
                               "--output_type",   "TXT",          NULL};
    if (!err->status && !outfile_make_folders(made, err) && !outfile_make_folders(text, err) &&
        !colmap_take_matches(&features, &job, err))
        write_known(&job, m, known, err);
    if (!err->status && features) {
        log_note("step 3 of %d: points (%.1f s so far)", COLMAP_STEPS, clock_seconds() - job.started);
        find_points(&points, &job, known, made, err);
    }
    if (!err->status && points && !colmap_run(job.logs[3], converter, 0, err) &&
        !sfm_model_read_text(&found, text, NULL, err))
        colmap_name_images(&found, in->list, err);
    if (!err->status) colmap_keep_logs(&job, err);
    if (!err->status && found.point_count) {
        log_note("triangulated %d points from the model's cameras", found.point_count);
        sfm_model_release(m);
        *m = found;
        found = (struct sfm_model){0};
    } else if (!err->status) {
        log_warn(
            "the model has no points, and none can be found: %s. Its cameras are used as they are; depths are searched "
            "between [segment_depth] near and far or, if these are not set, where the baselines allow it",
            features ? "no two photos show the same features where its cameras see them"
                     : "the photos have no features");
    }
    sfm_model_release(&found);
    colmap_job_release(&job);
    free(known);
    free(made);
    free(text);
    return err->status;
}
