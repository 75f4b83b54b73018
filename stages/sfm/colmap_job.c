/* colmap_job.c - COLMAP's commands on a work folder.
 *
 * COLMAP runs as programs, each with its own log: feature_importer (colmap_matches.c), matches_importer
 * (verify_matches.c), mapper.
 * This file makes their work folder and turns their failures into sentences; run_colmap.c decides when to run which.
 *
 * Names. COLMAP's text files cannot hold every file name, so the work folder has links PHOTO-ID.EXTENSION, and
 * colmap_name_images() puts the users' names back where a text file can hold them. The link keeps the file's extension
 * if it has letters and digits only, otherwise it gets .img; COLMAP reads the content.
 *
 * Lenses. start_lens.c decides whether all photos share one lens, and where its parameters begin; otherwise each
 * photo has its own. `refine_camera = no` holds focal lengths and distortion during mapping.
 *
 * The mapper runs in one thread. Several add up the sums of bundle adjustment in any order, and each has random numbers
 * of its own for unknown focal lengths, so that cameras would differ from run to run.
 *
 * The mapper may be run again, from another photo or `relaxed`. Its exit status 1 means that it found no model, which
 * the caller explains. */
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
#include "common/base/process.h"
#include "common/math/numbers.h"
#include "stages/sfm/colmap_log.h"

enum { MAX_ARGS = 40 };

void colmap_job_release(struct colmap_job *job)
{
    free(job->images);
    free(job->database);
    free(job->features);
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

/* COLMAP reads no pictures of 16 bits. It needs their size alone, since features are given to it: a blank one does. */
static enum status write_blank(const struct photo_info *info, const char *path, struct err *err)
{
    unsigned char *grey = calloc((size_t)info->height, (size_t)info->width);
    if (!grey) return err_nomem(err, "a blank picture", (size_t)info->height * (size_t)info->width);
    png_write(path, grey, info->width, info->height, 1, err);
    free(grey);
    return err->status;
}

static enum status link_photos(const struct colmap_job *job, struct err *err)
{
    char *from = realpath(job->in->photos, NULL);
    if (from)
        outfile_make_folders(job->images, err);
    else
        err_errno(err, "open", job->in->photos);
    for (int i = 0; !err->status && i < job->photos->count; i++) {
        const struct photo_record *p = &job->photos->photos[i];
        char *target = sfm_text_format(err, "%s/%s", from, p->file);
        char *link = sfm_text_format(err, "%s/%s%s", job->images, p->id, colmap_extension(p->file));
        if (target && link && p->info.bits == 16)
            write_blank(&p->info, link, err);
        else if (target && link)
            link_file(target, link, err);
        free(target);
        free(link);
    }
    free(from);
    return err->status;
}

enum status colmap_prepare(struct colmap_job *job, const struct sfm_folder *f, const struct sfm_input *in,
                           const struct sfm_params *params, struct err *err)
{
    *job = (struct colmap_job){.folder = f, .started = clock_seconds(), .in = in, .photos = in->list, .params = params};
    const char *work = job->folder->work;
    char known[SFM_LENS_TEXT];
    job->known = job->photos->count > 0;
    for (int i = 0; i < job->photos->count; i++) job->known &= sfm_panorama_lens(known, &job->photos->photos[i]);
    if (!sfm_single_camera(&job->single, job->photos, params, err)) sfm_start_lens(job->lens, job->photos, params, err);
    if (err->status) return err->status;
    job->images = sfm_text_format(err, "%s/images-%d", work, f->models);
    job->database = sfm_text_format(err, "%s/database-%d.db", work, f->models);
    job->sparse = sfm_text_format(err, "%s/sparse-%d", work, f->models);
    job->features = calloc((size_t)job->photos->count + 1, sizeof *job->features);
    if (!job->features) err_nomem(err, "numbers of features", (size_t)job->photos->count * sizeof *job->features);
    if (err->status) return err->status;
    for (int i = 0; i < COLMAP_STEPS; i++)
        if (!(job->logs[i] = sfm_text_format(err, "%s/colmap-%d.log", work, i + 1))) return err->status;
    return outfile_make_folders(job->sparse, err) || link_photos(job, err) ? err->status : ST_OK;
}

static enum status run(int *status, const char *log, const char *const args[], struct colmap_progress *progress,
                       struct err *err)
{
    const char *slash = strrchr(log, '/'), *argv[MAX_ARGS + 2] = {"colmap"};
    /* else its library for logs leaves files in /tmp */
    char *logs = sfm_text_format(err, "GLOG_log_dir=%.*s", slash ? (int)(slash - log) : 1, slash ? log : ".");
    const char *const env[] = {"QT_QPA_PLATFORM=offscreen", "OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1", logs, NULL};
    for (int n = 1; args[n - 1]; n++) argv[n] = args[n - 1];
    if (logs) process_run_watched(argv, env, log, progress ? colmap_progress_tick : NULL, progress, status, err);
    free(logs);
    return err->status;
}

enum status colmap_exit_status(int *status, const char *log, const char *const args[], struct err *err)
{
    return run(status, log, args, NULL, err);
}

enum status colmap_failed(const char *log, const char *command, int status, struct err *err)
{
    char line[512];
    colmap_log_last_line(line, sizeof line, log);
    return err_set(err, ST_IO, "colmap %s failed with exit status %d%s; its last line is \"%s\", its log is %s.",
                   command, status, status == 137 ? " (killed: out of memory?)" : "", line, log);
}

enum status colmap_run(const char *log, const char *const args[], int max_status, struct err *err)
{
    return colmap_run_long(log, args, max_status, NULL, err);
}

enum status colmap_run_long(const char *log, const char *const args[], int max_status, struct colmap_progress *progress,
                            struct err *err)
{
    int status = 0;
    run(&status, log, args, progress, err);
    if (!err->status && status > max_status) colmap_failed(log, args[0], status, err);
    return err->status;
}

/* Of a model, in photos: a quarter of the set, from 3 to 10. */
static int min_model_size(int photos) { return clamp_int(photos / 4, 3, 10); }

enum status colmap_map(const struct colmap_job *job, const struct colmap_start *start, struct err *err)
{
    const char *refine = strcmp(job->params->refine_camera, "no") && !job->known ? "1" : "0";
    char image[16], smallest[16];
    const char *args[MAX_ARGS] = {"mapper",      "--database_path",
                                  job->database, "--image_path",
                                  job->images,   "--output_path",
                                  start->folder, "--Mapper.num_threads",
                                  "1",           "--Mapper.ba_refine_focal_length",
                                  refine,        "--Mapper.ba_refine_extra_params",
                                  refine,        "--Mapper.min_model_size",
                                  smallest};
    int n = 0;
    while (args[n]) n++;
    /* COLMAP drops models of fewer than 10 photos, and of 10 photos or fewer every model that lacks one of them */
    snprintf(smallest, sizeof smallest, "%d", min_model_size(job->photos->count));
    if (start->image) {
        snprintf(image, sizeof image, "%d", start->image);
        args[n++] = "--Mapper.init_image_id1";
        args[n++] = image;
        args[n++] = "--Mapper.multiple_models";
        args[n++] = "0";
    }
    if (start->relaxed) {
        static const char *const relaxations[] = {"--Mapper.init_min_tri_angle",       "4",
                                                  "--Mapper.init_min_num_inliers",     "50",
                                                  "--Mapper.abs_pose_min_num_inliers", "20"};
        for (size_t i = 0; i < sizeof relaxations / sizeof *relaxations; i++) args[n++] = relaxations[i];
    }
    struct progress placed;
    struct colmap_progress progress;
    progress_start(&placed, "placing photos", job->photos->count, "photos");
    colmap_progress_start(&progress, &placed, job->logs[2], "Registering image #", true);
    /* exit status 1 means that it found no model; the caller counts the models and explains */
    colmap_run_long(job->logs[2], args, 1, &progress, err);
    progress_end(&placed);
    return err->status;
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
