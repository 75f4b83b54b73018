/* colmap_matches.c - COLMAP's database of photos, lenses, features and verified matches.
 *
 * feature_importer reads the photos' sizes and EXIF and makes lenses; it is given no features: those of the
 * scene go into its database directly (colmap_database.c).
 */
#include "stages/sfm/colmap_matches.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/clock.h"
#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/base/textfile.h"
#include "common/capture/frame_name.h"
#include "common/product/product.h"
#include "stages/sfm/colmap_database.h"
#include "stages/sfm/verify_matches.h"

enum { IMPORT_ARGS = 16 };

/* Whether two photos are imported together. Frames of one clip have one lens, and so have views of panoramas of one
 * size. Other photos have a lens each, and so have all if the user says so. */
static bool in_one_group(const struct colmap_job *job, const struct photo_record *a, const struct photo_record *b)
{
    char lens[2][SFM_LENS_TEXT] = {"", ""};
    const size_t clip = frame_name_clip(a->file);
    sfm_panorama_lens(lens[0], a);
    sfm_panorama_lens(lens[1], b);
    if (strcmp(lens[0], lens[1]) != 0) return false;
    if (job->single || *lens[0] || !strcmp(job->params->single_camera, "no")) return true;
    return clip == frame_name_clip(b->file) && !strncmp(a->file, b->file, clip);
}

/* Runs feature_importer for the group of photo `first`. */
static enum status import_group(const struct colmap_job *job, const char *lists, int first, struct err *err)
{
    const struct sfm_params *p = job->params;
    const struct photo_record *photos = job->photos->photos;
    char known[SFM_LENS_TEXT] = "";
    const bool panorama = sfm_panorama_lens(known, &photos[first]);
    const bool frames = strcmp(p->single_camera, "no") && frame_name_clip(photos[first].file);
    const char *lens = panorama ? known : job->lens;
    char *names = sfm_text_format(err, "%s.names", job->images);
    const char *args[IMPORT_ARGS] = {"feature_importer",
                                     "--database_path",
                                     job->database,
                                     "--image_path",
                                     job->images,
                                     "--import_path",
                                     lists,
                                     "--image_list_path",
                                     names,
                                     "--ImageReader.camera_model",
                                     panorama              ? "PINHOLE"
                                     : sfm_is_equisolid(p) ? "OPENCV_FISHEYE"
                                                           : p->camera_model,
                                     job->single || panorama || frames ? "--ImageReader.single_camera"
                                                                       : "--ImageReader.single_camera_per_image",
                                     "1"};
    struct outfile f = {0};
    int n = 0;
    while (args[n]) n++;
    if (*lens) {
        args[n++] = "--ImageReader.camera_params";
        args[n++] = lens;
    }
    if (!err->status) outfile_open(&f, names, err);
    for (int i = first; !err->status && i < job->photos->count; i++)
        if (in_one_group(job, &photos[first], &photos[i]))
            fprintf(f.fp, "%s%s\n", photos[i].id, colmap_extension(photos[i].file));
    if (!err->status) outfile_commit(&f, err);
    if (!err->status) colmap_run(job->logs[0], args, 0, err);
    outfile_discard(&f);
    free(names);
    return err->status;
}

/* Makes the database, with the photos and their lenses, but without features: each photo has an empty list. */
static enum status make_database(const struct colmap_job *job, struct err *err)
{
    char *lists = sfm_text_format(err, "%s.features", job->images);
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
    for (int i = 0; !err->status && i < job->photos->count; i++) {
        bool imported = false; /* with an earlier one */
        for (int k = 0; k < i && !imported; k++)
            imported = in_one_group(job, &job->photos->photos[k], &job->photos->photos[i]);
        if (!imported) import_group(job, lists, i, err);
    }
    free(lists);
    return err->status;
}

enum status colmap_matches_features(struct feature_list *list, const struct colmap_job *job, int photo, struct err *err)
{
    const struct product_key key = {.photo = job->photos->photos[photo].id};
    char path[FILE_PATH];
    *list = (struct feature_list){0};
    if (product_path_in(path, job->in->features, PRODUCT_FEATURES, &key, err)) return err->status;
    return feature_list_read(list, path, job->in->prov, err);
}

static enum status set_features(const struct colmap_job *job, int photo, struct colmap_database *db, struct err *err)
{
    const struct photo_record *p = &job->photos->photos[photo];
    struct feature_list list = {0};
    int id = 0;
    char *name = sfm_text_format(err, "%s%s", p->id, colmap_extension(p->file));
    if (name && !colmap_matches_features(&list, job, photo, err) && !colmap_database_image_id(&id, db, name, err) && id)
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

/* Records COLMAP's version, from the first line of its help ("COLMAP 3.8 -- ..."), or colmap-unknown. */
static enum status record_version(const struct colmap_job *job, struct err *err)
{
    static const char *const args[] = {"help", NULL};
    struct textfile t = {0};
    struct err ignored = ERR_INIT;
    char name[64] = "colmap-unknown", hash[HASH_TEXT], *word = NULL;
    int status = 0;
    if (colmap_exit_status(&status, job->logs[0], args, err)) return err->status;
    if (!textfile_open(&t, job->logs[0], &ignored) && textfile_next(&t) && !textfile_expect(&t, "COLMAP", &ignored) &&
        !textfile_word(&t, "a version", &word, &ignored))
        snprintf(name, sizeof name, "colmap-%.40s", word);
    textfile_release(&t);
    hash_bytes(hash, name, strlen(name));
    return provenance_add_hash(job->in->prov, name, hash, err);
}

enum status colmap_take_matches(long long *features, const struct colmap_job *job, struct err *err)
{
    log_note("step 1 of %d: %d photos, %s", COLMAP_STEPS, job->photos->count,
             job->single ? "one lens for all" : "a lens each");
    if (!record_version(job, err) && !make_database(job, err)) take_features(features, job, err);
    if (err->status || !*features) return err->status;
    log_note("step 2 of %d: verifying matches (%.1f s so far)", COLMAP_STEPS, clock_seconds() - job->started);
    return verify_matches(job, err);
}
