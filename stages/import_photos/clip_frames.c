/* clip_frames.c - makes photos of clips.
 *
 * A clip is decoded twice: once to choose its frames (frame_choice.h), once to take them. All of it is decoded the
 * first time, so that damage is found. Frames are written in parallel, as many at a time as there are threads. */
#include "stages/import_photos/clip_frames.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "common/capture/frame_name.h"
#include "common/capture/panorama_name.h"
#include "stages/import_photos/clip_list.h"
#include "stages/import_photos/clip_reader.h"
#include "stages/import_photos/frame_choice.h"
#include "stages/import_photos/panorama.h"

/* Of the files in the folder; panorama_name_read() wants a place for the yaw. */
static bool is_our_name(const char *file)
{
    int yaw;
    return frame_name_clip(file) || panorama_name_read(&yaw, file);
}

static const char *const list_file = "frames.txt", *const exposures_file = "exposures.txt";

/* --------------------------------------------------------------------------------------------------------- choosing */

static enum status look_at(struct clip_reader *clip, struct frame_choice *choice, unsigned char *grey, int width,
                           int height, int *frames, struct err *err)
{
    struct clip_frame at;
    struct progress progress;
    progress_start(&progress, "choosing frames", 0, "frames");
    while (!err->status && clip_next(clip, &at, err)) {
        if (!clip_grey(clip, grey, width, height, err)) frame_choice_add(choice, grey, at.number, at.seconds, err);
        *frames = at.number + 1;
        progress_add(&progress, 1);
    }
    progress_end(&progress);
    return err->status;
}

static enum status choose_frames(struct chosen_frames *chosen, int *frames, const char *path, int most, struct err *err)
{
    struct clip_reader *clip = NULL;
    struct frame_choice *choice = NULL;
    unsigned char *grey = NULL;
    int width = 0, height = 0;
    *frames = 0;
    if (!clip_open(&clip, path, err)) {
        clip_size(clip, FRAME_SIDE, &width, &height);
        grey = malloc((size_t)width * (size_t)height);
        if (!grey) err_nomem(err, "a frame", (size_t)width * (size_t)height);
    }
    if (!err->status && !frame_choice_begin(&choice, width, height, err) &&
        !look_at(clip, choice, grey, width, height, frames, err))
        frame_choice_end(chosen, choice, most, err);
    if (!err->status && clip_is_interlaced(clip))
        log_note("%s is interlaced; every other row of its frames is used", path_file_name(path));
    frame_choice_release(choice);
    clip_close(clip);
    free(grey);
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------------- taking */

struct write_job {
    const char *out;
    struct clip_picture *pictures; /* of the photos */
    struct photo *photos;
    struct err *errs;
    int count;
};

static void write_pictures(void *ctx, size_t begin, size_t end, int thread)
{
    struct write_job *j = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        const struct photo *p = &j->photos[i];
        char path[FILE_PATH];
        if (!file_path(path, j->out, j->pictures[i].file, "", &j->errs[i]) &&
            !photo_write_part(path, p, 0, 0, p->info.width, p->info.height, &p->info, &j->errs[i]))
            hash_file(j->pictures[i].hash, path, &j->errs[i]);
    }
}

static enum status write_some(struct write_job *j, struct err *err)
{
    parallel_for((size_t)j->count, 1, write_pictures, j);
    for (int i = 0; i < j->count; i++) {
        if (!err->status && j->errs[i].status) err_set(err, j->errs[i].status, "%s", j->errs[i].text);
        photo_release(&j->photos[i]);
    }
    j->pictures += j->count;
    j->count = 0;
    return err->status;
}

static enum status take_frames(struct clip *c, struct clip_reader *clip, const char *out, struct err *err)
{
    const int room = parallel_threads();
    struct write_job job = {out, c->pictures, calloc((size_t)room, sizeof *job.photos),
                            calloc((size_t)room, sizeof *job.errs), 0};
    struct clip_frame at;
    int next = 0;
    if (!job.photos || !job.errs) err_nomem(err, "frames", (size_t)room * sizeof *job.photos);
    while (!err->status && next < c->count && clip_next(clip, &at, err)) {
        if (at.number != c->pictures[next].frame.number) continue;
        struct photo *p = &job.photos[job.count];
        if (clip_photo(clip, p, err)) break;
        if (p->info.taken > 0) p->info.taken += at.seconds;
        c->width = p->info.width;
        c->height = p->info.height;
        job.count++;
        if (++next == c->count || job.count == room) write_some(&job, err);
    }
    if (job.count) write_some(&job, err);
    free(job.photos);
    free(job.errs);
    return err->status;
}

static enum status name_pictures(struct clip *c, const struct chosen_frames *chosen, struct err *err)
{
    c->pictures = calloc((size_t)chosen->count + 1, sizeof *c->pictures);
    if (!c->pictures) return err_nomem(err, "frames of a clip", (size_t)chosen->count * sizeof *c->pictures);
    for (int i = 0; i < chosen->count; i++) {
        struct clip_picture *p = &c->pictures[c->count++];
        p->frame = chosen->frames[i];
        if (!(p->file = frame_name_make(c->id, p->frame.number))) return err_nomem(err, "a file name", 0);
    }
    return ST_OK;
}

static void report_frames(const struct clip *c, const struct chosen_frames *chosen, int frames)
{
    char times[600] = "";
    for (int i = 0; i < c->count && strlen(times) + 40 < sizeof times; i++) {
        const size_t n = strlen(times);
        snprintf(times + n, sizeof times - n, "%s%.2f", n ? ", " : "", c->pictures[i].frame.seconds);
    }
    log_note("%s: %d of %d frames become photos, at %s s", c->file, c->count, frames, times);
    if (c->count > 1 && chosen->most_parallax < FRAME_PARALLAX / 4)
        log_warn("%s: its frames overlap less and less, but nothing moves against its background: the camera turns on "
                 "the spot, or films a plane. Film while walking past the scene.",
                 c->file);
}

/* One frame alone shows no parallax. Beside other clips or photos it may be one of several views. */
static enum status check_movement(const struct clip *c, const struct chosen_frames *chosen, int frames, bool alone,
                                  const char *path, struct err *err)
{
    if (c->count > 1) return ST_OK;
    if (alone && !c->count)
        return err_set(
            err, ST_DATA,
            "%s: none of its %d frames shows enough texture to follow; film something with texture, in enough "
            "light.",
            path, frames);
    if (alone)
        return err_set(
            err, ST_DATA,
            "%s: its camera moves too little: in its %d frames things move by %.2g %% of the picture's longer "
            "side against each other, wanted %g %%; film while walking past the scene.",
            path, frames, 100 * chosen->most_parallax, 100 * FRAME_PARALLAX);
    log_warn("%s: its camera moves too little; it gives %d photo%s.", c->file, c->count, c->count ? "" : "s");
    return ST_OK;
}

static bool up_to_date(struct clip *c, const struct clip_list *old, int most, const char *out)
{
    struct clip *before = NULL;
    for (int i = 0; i < old->count && old->most == most && !before; i++)
        if (!strcmp(old->clips[i].file, c->file) && !strcmp(old->clips[i].id, c->id) &&
            !strcmp(old->clips[i].hash, c->hash))
            before = &old->clips[i];
    for (int i = 0; before && i < before->count; i++) {
        char path[FILE_PATH], hash[HASH_TEXT];
        struct err ignored = ERR_INIT;
        if (file_path(path, out, before->pictures[i].file, "", &ignored) || hash_file(hash, path, &ignored) ||
            strcmp(hash, before->pictures[i].hash) != 0)
            return false;
    }
    if (!before) return false;
    c->pictures = before->pictures; /* taken over */
    c->count = before->count;
    c->width = before->width;
    c->height = before->height;
    before->pictures = NULL;
    before->count = 0;
    return true;
}

static enum status make_clip(struct clip *c, const struct scanned_clip *from, const char *out, int most, bool alone,
                             struct err *err)
{
    struct chosen_frames chosen = {0};
    struct clip_reader *clip = NULL;
    int frames = 0;
    if (!choose_frames(&chosen, &frames, from->path, most, err) && !name_pictures(c, &chosen, err) &&
        !check_movement(c, &chosen, frames, alone, from->path, err) && !clip_open(&clip, from->path, err))
        take_frames(c, clip, out, err);
    if (!err->status) report_frames(c, &chosen, frames);
    clip_close(clip);
    frame_choice_free(&chosen);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------ panoramas */

/* The views of a panorama, whose numbers are their yaws. */
static enum status cut_panorama(struct clip *c, const char *path, const char *out, struct err *err)
{
    struct photo whole = {0}, views[PANORAMA_VIEWS] = {0};
    struct err errs[PANORAMA_VIEWS] = {0};
    struct write_job job = {out, NULL, views, errs, 0};
    c->pictures = calloc(PANORAMA_VIEWS, sizeof *c->pictures);
    if (!c->pictures) return err_nomem(err, "views of a panorama", PANORAMA_VIEWS * sizeof *c->pictures);
    job.pictures = c->pictures;
    photo_read(&whole, path, err);
    for (int i = 0; !err->status && i < PANORAMA_VIEWS; i++) {
        struct clip_picture *p = &c->pictures[c->count++];
        p->frame.number = i * PANORAMA_STEP;
        if (!(p->file = panorama_name_make(c->id, i))) err_nomem(err, "a file name", 0);
        if (!err->status && !panorama_cut(&views[i], &whole, p->frame.number, err)) job.count++;
        views[i].space = whole.space; /* borrowed */
    }
    if (!err->status) {
        c->width = c->height = panorama_side(&whole);
        parallel_for((size_t)job.count, 1, write_pictures, &job);
    }
    for (int i = 0; i < PANORAMA_VIEWS; i++) {
        if (!err->status && errs[i].status) err_set(err, errs[i].status, "%s", errs[i].text);
        views[i].space = NULL;
        photo_release(&views[i]);
    }
    if (!err->status)
        log_note("%s is a panorama of 360 degrees; it becomes %d views of %d x %d px", c->file, PANORAMA_VIEWS,
                 c->width, c->height);
    photo_release(&whole);
    return err->status;
}

static enum status cut_panoramas(struct clip_list *list, struct photo_scan *scan, const struct clip_list *old,
                                 const char *out, struct err *err)
{
    for (int i = 0; !err->status && i < scan->count; i++) {
        struct scanned_photo *from = &scan->photos[i];
        struct clip *c = &list->clips[list->count];
        char path[FILE_PATH];
        if (!from->panorama || file_path(path, scan->folder, from->file, "", err)) continue;
        list->count++;
        *c = (struct clip){.file = strdup(from->file), .id = strdup(from->id)};
        if (!c->file || !c->id) err_nomem(err, "a panorama", 0);
        if (!err->status && !hash_file(c->hash, path, err) && !up_to_date(c, old, list->most, out))
            cut_panorama(c, path, out, err);
    }
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------------- folder */

static enum status link_file(const char *folder, const char *file, const char *out, struct err *err)
{
    char from[FILE_PATH], to[FILE_PATH], old[FILE_PATH];
    if (file_path(to, out, file, "", err)) return err->status;
    char *full = realpath(folder, NULL);
    if (!full) return err_errno(err, "open", folder);
    file_path(from, full, file, "", err);
    free(full);
    const ssize_t length = err->status ? -1 : readlink(to, old, sizeof old - 1);
    if (length >= 0) old[length] = 0;
    if (err->status || (length >= 0 && !strcmp(old, from))) return err->status;
    if (unlink(to) && errno != ENOENT) return err_errno(err, "remove", to);
    return symlink(from, to) ? err_errno(err, "make the link", to) : ST_OK;
}

static bool is_wanted(const struct photo_scan *scan, const struct clip_list *list, const char *file)
{
    for (int i = 0; i < list->count; i++)
        for (int k = 0; k < list->clips[i].count; k++)
            if (!strcmp(list->clips[i].pictures[k].file, file)) return true;
    for (int i = 0; scan && i < scan->count; i++)
        if (!scan->photos[i].panorama && !strcmp(scan->photos[i].file, file)) return true;
    return false;
}

/* Removes frames and links that are not wanted; scan NULL: all of them. Other files are not ours. */
static enum status remove_others(const struct photo_scan *scan, const struct clip_list *list, const char *out,
                                 struct err *err)
{
    DIR *dir = opendir(out);
    if (!dir) return errno == ENOENT ? ST_OK : err_errno(err, "open", out);
    for (struct dirent *e; !err->status && (e = readdir(dir));) {
        char path[FILE_PATH];
        struct stat info;
        if (e->d_name[0] == '.' || is_wanted(scan, list, e->d_name)) continue;
        if (file_path(path, out, e->d_name, "", err) || lstat(path, &info)) continue;
        const bool frame = S_ISREG(info.st_mode) && (is_our_name(e->d_name) || !strcmp(e->d_name, list_file));
        const bool keep = scan && (!strcmp(e->d_name, list_file) || !strcmp(e->d_name, exposures_file));
        if (!keep && (frame || S_ISLNK(info.st_mode)) && unlink(path)) err_errno(err, "remove", path);
    }
    closedir(dir);
    return err->status;
}

static enum status link_photos(const struct photo_scan *scan, const struct clip_list *list, const char *out,
                               struct err *err)
{
    char exposures[FILE_PATH], old[FILE_PATH];
    for (int i = 0; !err->status && i < scan->count; i++) {
        const char *file = scan->photos[i].file;
        if (scan->photos[i].panorama) continue;
        if (is_wanted(NULL, list, file))
            err_set(err, ST_DATA, "%s/%s has the name of a frame of a clip; rename it.", scan->folder, file);
        else
            link_file(scan->folder, file, out, err);
    }
    if (err->status || file_path(old, out, exposures_file, "", err)) return err->status;
    if (scan->folder && !file_path(exposures, scan->folder, exposures_file, "", err) && path_is_file(exposures))
        return link_file(scan->folder, exposures_file, out, err);
    return unlink(old) && errno != ENOENT ? err_errno(err, "remove", old) : ST_OK;
}

static enum status refuse_bad(const struct photo_scan *scan, struct err *err)
{
    char names[1024] = "";
    int bad = 0, used = 0;
    for (int i = 0; i < scan->clip_count; i++) {
        const struct scanned_clip *c = &scan->clips[i];
        const size_t n = strlen(names);
        used += !c->excluded;
        if (c->excluded || !c->err.status) continue;
        bad++;
        snprintf(names + n, sizeof names - n, " %s", c->id);
    }
    if (!bad) return ST_OK;
    return err_set(err, ST_DATA, "%d of %d clips cannot be used; replace them, or leave them out (EXCLUDE =%s).", bad,
                   used, names);
}

enum status clip_frames_make(struct photo_scan *scan, const char *out, const struct photo_params *params,
                             struct err *err)
{
    struct clip_list old = {0}, list = {.most = params->frames};
    struct err ignored = ERR_INIT;
    char path[FILE_PATH];
    int used = 0;
    for (int i = 0; i < scan->clip_count; i++) used += !scan->clips[i].excluded;
    list.clips = calloc((size_t)scan->clip_count + (size_t)scan->count + 1, sizeof *list.clips);
    if (!list.clips) err_nomem(err, "clips", (size_t)scan->clip_count * sizeof *list.clips);
    if (!err->status && !outfile_make_folders(out, err) && !file_path(path, out, list_file, "", err))
        clip_list_read(&old, path, &ignored); /* if it cannot be read, all frames are taken again */
    for (int i = 0; !err->status && i < scan->clip_count; i++) {
        struct scanned_clip *from = &scan->clips[i];
        struct clip *c = &list.clips[list.count];
        if (from->excluded) continue;
        list.count++;
        *c = (struct clip){.file = strdup(path_file_name(from->path)), .id = strdup(from->id)};
        if (!c->file || !c->id) err_nomem(err, "a clip", 0);
        if (!err->status && !hash_file(c->hash, from->path, &from->err) && !up_to_date(c, &old, params->frames, out))
            make_clip(c, from, out, params->frames, used == 1 && !photo_scan_used(scan), &from->err);
        if (from->err.status == ST_NOMEM) err_set(err, ST_NOMEM, "%s", from->err.text);
    }
    (void)(err->status || refuse_bad(scan, err) || cut_panoramas(&list, scan, &old, out, err) ||
           remove_others(scan, &list, out, err) || link_photos(scan, &list, out, err) ||
           clip_list_write(&list, path, err));
    clip_list_release(&old);
    clip_list_release(&list);
    return err->status;
}

enum status clip_frames_remove(const char *out, struct err *err)
{
    const struct clip_list none = {0};
    return remove_others(NULL, &none, out, err);
}
