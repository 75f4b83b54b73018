/* colmap_job.c - COLMAP's commands on a work folder.
 *
 * COLMAP runs as three programs, each with its own log: feature_extractor, a matcher, and mapper. This file makes
 * their work folder, their arguments, and sentences from their failures; run_colmap.c decides when to run which.
 *
 * Names. COLMAP's text files cannot hold every file name, so the work folder has links PHOTO-ID.EXTENSION, and
 * colmap_name_images() puts the users' names back where a text file can hold them. COLMAP tells formats by the
 * extension; one with other characters than letters and digits becomes .img.
 *
 * Masks are black where something is to be ignored, as COLMAP's are, but have to be named like the image plus .png.
 * They are written for photos that have one.
 *
 * Lenses. start_lens.c decides whether all photos share one lens, and where its parameters begin; otherwise each
 * photo has its own. `refine_camera = no` holds focal lengths and distortion during mapping.
 *
 * Matching. All pairs up to 200 photos, then neighbours in order of name: pairs grow with the square of the photos.
 * The mapper may be run again `relaxed`, with a smaller angle and fewer inliers for its first pair; exit status 1 of
 * it means that it found no model, which the caller explains.
 *
 * COLMAP uses the processor only: its results depend neither on a GPU nor on a driver. */
#include "stages/sfm/colmap_job.h"

#include <ctype.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/clock.h"
#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/base/parallel.h"
#include "common/base/process.h"
#include "common/capture/photo_mask.h"
#include "stages/sfm/colmap_log.h"

enum { MAX_EXHAUSTIVE = 200, MAX_ARGS = 40 }; /* photos that the matcher "auto" matches in all pairs */

void colmap_job_release(struct colmap_job *job)
{
    free(job->images);
    free(job->masks);
    free(job->database);
    free(job->sparse);
    for (int i = 0; i < COLMAP_STEPS; i++) free(job->logs[i]);
}

const char *colmap_extension(const char *file)
{
    const char *dot = strrchr(file, '.');
    if (!dot || !dot[1] || strlen(dot) > 6) return ".img";
    for (const char *p = dot + 1; *p; p++)
        if (!isalnum((unsigned char)*p) || (unsigned char)*p > 127) return ".img";
    return dot;
}

static enum status link_file(const char *target, const char *link, struct err *err)
{
    return symlink(target, link) ? err_errno(err, "make the link", link) : ST_OK;
}

/* The photo's mask as COLMAP wants it, black where no features may be found, in IMAGES.masks. */
static enum status write_mask(struct colmap_job *job, const struct sfm_input *in, const struct photo_record *p,
                              int *count, struct err *err)
{
    struct photo_mask mask = {0};
    if (!photo_mask_read(&mask, in->masks, in->records, p, NULL, err) && mask.masked) {
        const size_t pixels = (size_t)mask.width * (size_t)mask.height;
        for (size_t i = 0; i < pixels; i++) mask.masked[i] = mask.masked[i] ? 0 : 255;
        if (!job->masks) {
            job->masks = sfm_text_format(err, "%s.masks", job->images);
            if (job->masks) outfile_make_folders(job->masks, err);
        }
        char *path =
            err->status ? NULL : sfm_text_format(err, "%s/%s%s.png", job->masks, p->id, colmap_extension(p->file));
        if (path) png_write(path, mask.masked, mask.width, mask.height, 1, err);
        free(path);
        ++*count;
    }
    photo_mask_release(&mask);
    return err->status;
}

static enum status link_photos(struct colmap_job *job, const struct sfm_input *in, struct err *err)
{
    char *from = realpath(in->photos, NULL);
    int mask_count = 0;
    if (from)
        outfile_make_folders(job->images, err);
    else
        err_errno(err, "open", in->photos);
    for (int i = 0; !err->status && i < job->photos->count; i++) {
        const struct photo_record *p = &job->photos->photos[i];
        char *target = sfm_text_format(err, "%s/%s", from, p->file);
        char *link = sfm_text_format(err, "%s/%s%s", job->images, p->id, colmap_extension(p->file));
        if (target && link && !link_file(target, link, err)) write_mask(job, in, p, &mask_count, err);
        free(target);
        free(link);
    }
    if (!err->status && mask_count) log_note("%d photos have a mask", mask_count);
    free(from);
    return err->status;
}

enum status colmap_prepare(struct colmap_job *job, const struct sfm_folder *f, const struct sfm_input *in,
                           const struct sfm_params *params, struct err *err)
{
    *job = (struct colmap_job){.folder = f, .started = clock_seconds(), .photos = in->list, .params = params};
    const char *work = job->folder->work;
    if (!sfm_single_camera(&job->single, job->photos, params, err)) sfm_start_lens(job->lens, job->photos, params, err);
    if (err->status) return err->status;
    snprintf(job->threads, sizeof job->threads, "%d", parallel_threads());
    snprintf(job->max_features, sizeof job->max_features, "%d", job->params->max_features);
    snprintf(job->max_image_size, sizeof job->max_image_size, "%d", job->params->max_image_size);
    job->images = sfm_text_format(err, "%s/images", work);
    job->database = sfm_text_format(err, "%s/database.db", work);
    job->sparse = sfm_text_format(err, "%s/sparse", work);
    if (!job->images || !job->database || !job->sparse) return err->status;
    for (int i = 0; i < COLMAP_STEPS; i++)
        if (!(job->logs[i] = sfm_text_format(err, "%s/colmap-%d.log", work, i + 1))) return err->status;
    return outfile_make_folders(job->sparse, err) || link_photos(job, in, err) ? err->status : ST_OK;
}

enum status colmap_exit_status(int *status, const struct colmap_job *job, int step, const char *const args[],
                               struct err *err)
{
    static const char *const env[] = {"QT_QPA_PLATFORM=offscreen", NULL};
    const char *argv[MAX_ARGS + 2] = {"colmap"};
    for (int n = 1; args[n - 1]; n++) argv[n] = args[n - 1];
    return process_run(argv, env, job->logs[step - 1], status, err);
}

enum status colmap_failed(const struct colmap_job *job, int step, const char *command, int status, struct err *err)
{
    char line[512];
    colmap_log_last_line(line, sizeof line, job->logs[step - 1]);
    return err_set(err, ST_IO, "colmap %s failed with exit status %d%s; its last line is \"%s\", its log is %s.",
                   command, status, status == 137 ? " (killed: out of memory?)" : "", line, job->logs[step - 1]);
}

enum status colmap_run(const struct colmap_job *job, int step, const char *const args[], int max_status,
                       struct err *err)
{
    int status = 0;
    if (!colmap_exit_status(&status, job, step, args, err) && status > max_status)
        colmap_failed(job, step, args[0], status, err);
    return err->status;
}

static enum status extract(const struct colmap_job *job, struct err *err)
{
    const struct sfm_params *p = job->params;
    const char *args[MAX_ARGS] = {"feature_extractor",
                                  "--database_path",
                                  job->database,
                                  "--image_path",
                                  job->images,
                                  "--ImageReader.camera_model",
                                  sfm_is_equisolid(p) ? "OPENCV_FISHEYE" : p->camera_model,
                                  job->single ? "--ImageReader.single_camera" : "--ImageReader.single_camera_per_image",
                                  "1",
                                  "--SiftExtraction.use_gpu",
                                  "0",
                                  "--SiftExtraction.num_threads",
                                  job->threads,
                                  "--SiftExtraction.max_num_features",
                                  job->max_features,
                                  "--SiftExtraction.max_image_size",
                                  job->max_image_size};
    int n = 0;
    while (args[n]) n++;
    if (*job->lens) {
        args[n++] = "--ImageReader.camera_params";
        args[n++] = job->lens;
    }
    if (job->masks) {
        args[n++] = "--ImageReader.mask_path";
        args[n++] = job->masks;
    }
    return colmap_run(job, 1, args, 0, err);
}

static enum status match(const struct colmap_job *job, struct err *err)
{
    const char *which = job->params->matcher;
    bool all = !strcmp(which, "exhaustive") || (!strcmp(which, "auto") && job->photos->count <= MAX_EXHAUSTIVE);
    const char *args[] = {all ? "exhaustive_matcher" : "sequential_matcher",
                          "--database_path",
                          job->database,
                          "--SiftMatching.use_gpu",
                          "0",
                          "--SiftMatching.num_threads",
                          job->threads,
                          NULL};
    return colmap_run(job, 2, args, 0, err);
}

enum status colmap_map(const struct colmap_job *job, bool relaxed, struct err *err)
{
    const char *refine = strcmp(job->params->refine_camera, "no") ? "1" : "0";
    const char *args[MAX_ARGS] = {"mapper",      "--database_path",
                                  job->database, "--image_path",
                                  job->images,   "--output_path",
                                  job->sparse,   "--Mapper.num_threads",
                                  job->threads,  "--Mapper.ba_refine_focal_length",
                                  refine,        "--Mapper.ba_refine_extra_params",
                                  refine};
    int n = 0;
    while (args[n]) n++;
    if (relaxed) {
        static const char *const relaxations[] = {"--Mapper.init_min_tri_angle",       "4",
                                                  "--Mapper.init_min_num_inliers",     "50",
                                                  "--Mapper.abs_pose_min_num_inliers", "20"};
        for (size_t i = 0; i < sizeof relaxations / sizeof *relaxations; i++) args[n++] = relaxations[i];
    }
    /* exit status 1 means that it found no model; the caller counts the models and explains */
    return colmap_run(job, 3, args, 1, err);
}

static enum status count_features(long long *found, const struct colmap_job *job, struct err *err)
{
    struct feature_counts c = {0};
    char few[1024];
    long long total = 0;
    if (colmap_counts_read(&c, job->logs[0], err)) return err->status;
    for (int i = 0; i < c.count; i++) total += c.list[i].features > 0 ? c.list[i].features : 0;
    log_note("%lld features in %d photos", total, job->photos->count);
    colmap_counts_list_poor(few, sizeof few, &c, job->photos, MIN_FEATURES);
    if (*few)
        log_warn("few features (blurred, dark, little texture, or masked), so their poses may be poor or missing: %s",
                 few);
    *found = total;
    colmap_counts_release(&c);
    return err->status;
}

enum status colmap_extract_and_match(long long *features, const struct colmap_job *job, struct err *err)
{
    log_note("step 1 of %d: features of %d photos, %s", COLMAP_STEPS, job->photos->count,
             job->single ? "one lens for all" : "a lens each");
    if (!extract(job, err)) count_features(features, job, err);
    if (err->status || !*features) return err->status;
    log_note("step 2 of %d: matches (%.1f s so far)", COLMAP_STEPS, clock_seconds() - job->started);
    return match(job, err);
}

enum status colmap_keep_logs(const struct colmap_job *job, struct err *err)
{
    for (int i = 0; !err->status && i < COLMAP_STEPS; i++) {
        char *kept = sfm_text_format(err, "%s/colmap-%d.log", job->folder->made, i + 1);
        if (kept && rename(job->logs[i], kept) && errno != ENOENT) err_errno(err, "keep", job->logs[i]);
        free(kept);
    }
    return err->status;
}

enum status colmap_name_images(struct sfm_model *m, const struct photo_list *photos, struct err *err)
{
    for (int i = 0; i < m->image_count; i++) {
        char *name = m->images[i].name, *dot = strrchr(name, '.');
        if (dot) *dot = '\0';
        int at = photo_list_find_id(photos, name);
        if (dot) *dot = '.';
        if (at < 0) return err_set(err, ST_INTERNAL, "COLMAP's model has an image \"%s\" that it was not given.", name);
        const char *file = photos->photos[at].file;
        size_t n = strlen(file);
        if (strpbrk(file, "\r\n") || strchr(" \t", file[0]) || strchr(" \t", file[n - 1])) continue;
        if (!(name = strdup(file))) return err_nomem(err, "a name", n + 1);
        free(m->images[i].name);
        m->images[i].name = name;
    }
    return ST_OK;
}
