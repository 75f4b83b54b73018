/* colmap_job.c - COLMAP's commands on a work folder.
 *
 * COLMAP runs as programs, each with its own log: feature_importer, matches_importer, mapper. This file makes their
 * work folder, their arguments, and sentences from their failures; run_colmap.c decides when to run which.
 *
 * Names. COLMAP's text files cannot hold every file name, so the work folder has links PHOTO-ID.EXTENSION, and
 * colmap_name_images() puts the users' names back where a text file can hold them. COLMAP tells formats by the
 * extension; one with other characters than letters and digits becomes .img.
 *
 * Features. feature_importer reads the photos' sizes and EXIF and makes lenses; it is given no features: those of the
 * scene go into its database directly (colmap_database.c).
 *
 * Matches. matches_importer verifies them, pair by pair in the order of the photos, in one thread: its random numbers
 * go on from pair to pair, so this order is a part of the result.
 *
 * Lenses. start_lens.c decides whether all photos share one lens, and where its parameters begin; otherwise each
 * photo has its own. `refine_camera = no` holds focal lengths and distortion during mapping.
 *
 * The mapper may be run again `relaxed`, with a smaller angle and fewer inliers for its first pair; exit status 1 of
 * it means that it found no model, which the caller explains. */
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
#include "common/base/textfile.h"
#include "common/capture/match_list.h"
#include "common/product/product.h"
#include "stages/sfm/colmap_database.h"
#include "stages/sfm/colmap_log.h"

enum { MAX_ARGS = 40, MIN_MATCHES = 15 }; /* COLMAP takes no fewer verified matches for a pair */

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

static enum status link_photos(struct colmap_job *job, const struct sfm_input *in, struct err *err)
{
    char *from = realpath(in->photos, NULL);
    if (from)
        outfile_make_folders(job->images, err);
    else
        err_errno(err, "open", in->photos);
    for (int i = 0; !err->status && i < job->photos->count; i++) {
        const struct photo_record *p = &job->photos->photos[i];
        char *target = sfm_text_format(err, "%s/%s", from, p->file);
        char *link = sfm_text_format(err, "%s/%s%s", job->images, p->id, colmap_extension(p->file));
        if (target && link) link_file(target, link, err);
        free(target);
        free(link);
    }
    free(from);
    return err->status;
}

enum status colmap_prepare(struct colmap_job *job, const struct sfm_folder *f, const struct sfm_input *in,
                           const struct sfm_params *params, struct err *err)
{
    *job = (struct colmap_job){.folder = f, .started = clock_seconds(), .photos = in->list, .params = params};
    job->features_from = in->features;
    job->matches_from = in->matches;
    job->prov = in->prov;
    const char *work = job->folder->work;
    if (!sfm_single_camera(&job->single, job->photos, params, err)) sfm_start_lens(job->lens, job->photos, params, err);
    if (err->status) return err->status;
    snprintf(job->threads, sizeof job->threads, "%d", parallel_threads());
    job->images = sfm_text_format(err, "%s/images", work);
    job->database = sfm_text_format(err, "%s/database.db", work);
    job->sparse = sfm_text_format(err, "%s/sparse", work);
    job->features = calloc((size_t)job->photos->count + 1, sizeof *job->features);
    if (!job->features) err_nomem(err, "numbers of features", (size_t)job->photos->count * sizeof *job->features);
    if (err->status) return err->status;
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

/* Makes the database, with the photos and their lenses, but without features: each photo has an empty list. */
static enum status make_database(const struct colmap_job *job, struct err *err)
{
    const struct sfm_params *p = job->params;
    char *lists = sfm_text_format(err, "%s.features", job->images);
    const char *args[MAX_ARGS] = {"feature_importer",
                                  "--database_path",
                                  job->database,
                                  "--image_path",
                                  job->images,
                                  "--import_path",
                                  lists,
                                  "--ImageReader.camera_model",
                                  sfm_is_equisolid(p) ? "OPENCV_FISHEYE" : p->camera_model,
                                  job->single ? "--ImageReader.single_camera" : "--ImageReader.single_camera_per_image",
                                  "1"};
    int n = 0;
    while (args[n]) n++;
    if (*job->lens) {
        args[n++] = "--ImageReader.camera_params";
        args[n++] = job->lens;
    }
    for (int i = 0; !err->status && i < job->photos->count; i++) {
        const struct photo_record *photo = &job->photos->photos[i];
        struct outfile f = {0};
        char *list = sfm_text_format(err, "%s/%s%s.txt", lists, photo->id, colmap_extension(photo->file));
        if (list && !outfile_open(&f, list, err)) {
            fprintf(f.fp, "0 %d\n", DESCRIPTOR_SIZE);
            outfile_commit(&f, err);
        }
        outfile_discard(&f);
        free(list);
    }
    if (!err->status) colmap_run(job, 1, args, 0, err);
    free(lists);
    return err->status;
}

static enum status set_features(const struct colmap_job *job, int photo, struct colmap_database *db, struct err *err)
{
    const struct photo_record *p = &job->photos->photos[photo];
    struct feature_list list = {0};
    char path[FILE_PATH];
    int id = 0;
    char *name = sfm_text_format(err, "%s%s", p->id, colmap_extension(p->file));
    if (name &&
        !product_path_in(path, job->features_from, PRODUCT_FEATURES, &(struct product_key){.photo = p->id}, err) &&
        !feature_list_read(&list, path, job->prov, err) && !colmap_database_image_id(&id, db, name, err) && id)
        colmap_database_set_features(db, id, &list, err);
    job->features[photo] = id ? list.count : -1;
    feature_list_release(&list);
    free(name);
    return err->status;
}

static enum status take_features(long long *found, const struct colmap_job *job, struct err *err)
{
    struct colmap_database *db = NULL;
    char few[1024];
    *found = 0;
    colmap_database_open(&db, job->database, err);
    for (int i = 0; !err->status && i < job->photos->count; i++) {
        set_features(job, i, db, err);
        *found += job->features[i] > 0 ? job->features[i] : 0;
    }
    if (!err->status) colmap_database_commit(db, err);
    colmap_database_close(db);
    if (err->status) return err->status;
    log_note("%lld features in %d photos", *found, job->photos->count);
    colmap_list_poor(few, sizeof few, job->features, job->photos);
    if (*few)
        log_warn("few features (blurred, dark, little texture, or masked), so their poses may be poor or missing: %s",
                 few);
    return ST_OK;
}

/* Writes the pairs of a photo in COLMAP's form: the names of both, a line for each match, a blank line. */
static enum status write_pairs(FILE *to, const struct colmap_job *job, int photo, struct err *err)
{
    const struct photo_record *p = &job->photos->photos[photo];
    struct match_list list = {0};
    char path[FILE_PATH];
    if (product_path_in(path, job->matches_from, PRODUCT_MATCHES, &(struct product_key){.photo = p->id}, err) ||
        match_list_read(&list, path, job->prov, err))
        return err->status;
    for (int i = 0; i < list.count; i++) {
        const struct photo_pair *pair = &list.pairs[i];
        const int other = photo_list_find_id(job->photos, pair->other);
        if (other < 0 || job->features[other] < 0 || pair->count < MIN_MATCHES) continue;
        fprintf(to, "%s%s %s%s\n", p->id, colmap_extension(p->file), pair->other,
                colmap_extension(job->photos->photos[other].file));
        for (int k = 0; k < pair->count; k++) fprintf(to, "%d %d\n", pair->matches[k].first, pair->matches[k].second);
        fputc('\n', to);
    }
    match_list_release(&list);
    return ST_OK;
}

static enum status take_pairs(const struct colmap_job *job, struct err *err)
{
    struct outfile f = {0};
    char *list = sfm_text_format(err, "%s.matches.txt", job->images);
    const char *args[] = {"matches_importer",
                          "--database_path",
                          job->database,
                          "--match_list_path",
                          list,
                          "--match_type",
                          "raw",
                          "--SiftMatching.use_gpu",
                          "0",
                          "--SiftMatching.num_threads",
                          job->threads,
                          NULL};
    if (list) outfile_open(&f, list, err);
    for (int i = 0; !err->status && i < job->photos->count; i++)
        if (job->features[i] >= 0) write_pairs(f.fp, job, i, err);
    if (!err->status && !outfile_commit(&f, err)) colmap_run(job, 2, args, 0, err);
    outfile_discard(&f);
    free(list);
    return err->status;
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

void colmap_list_poor(char *text, size_t size, const int *features, const struct photo_list *photos)
{
    size_t used = 0;
    int named = 0, omitted = 0;
    *text = '\0';
    for (int i = 0; i < photos->count; i++) {
        const struct photo_record *p = &photos->photos[i];
        if (features[i] >= MIN_FEATURES) continue;
        if (used + strlen(p->file) + 40 > size) {
            omitted++;
            continue;
        }
        used += (size_t)snprintf(text + used, size - used, features[i] < 0 ? "%s%s (unreadable)" : "%s%s (%d)",
                                 named++ ? ", " : "", p->file, features[i]);
    }
    if (omitted) snprintf(text + used, size - used, " and %d more", omitted);
}

/* Its first line is "COLMAP 3.8 -- ..."; a program that does not say it is recorded as colmap-unknown. */
static enum status record_version(const struct colmap_job *job, struct err *err)
{
    static const char *const args[] = {"help", NULL};
    struct textfile t = {0};
    struct err ignored = ERR_INIT;
    char name[64] = "colmap-unknown", hash[HASH_TEXT], *word = NULL;
    int status = 0;
    if (colmap_exit_status(&status, job, 1, args, err)) return err->status;
    if (!textfile_open(&t, job->logs[0], &ignored) && textfile_next(&t) && !textfile_expect(&t, "COLMAP", &ignored) &&
        !textfile_word(&t, "a version", &word, &ignored))
        snprintf(name, sizeof name, "colmap-%.40s", word);
    textfile_release(&t);
    hash_bytes(hash, name, strlen(name));
    return provenance_add_hash(job->prov, name, hash, err);
}

enum status colmap_take_matches(long long *features, const struct colmap_job *job, struct err *err)
{
    log_note("step 1 of %d: %d photos, %s", COLMAP_STEPS, job->photos->count,
             job->single ? "one lens for all" : "a lens each");
    if (!record_version(job, err) && !make_database(job, err)) take_features(features, job, err);
    if (err->status || !*features) return err->status;
    log_note("step 2 of %d: verifying matches (%.1f s so far)", COLMAP_STEPS, clock_seconds() - job->started);
    return take_pairs(job, err);
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
