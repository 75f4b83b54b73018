/* photo_scan.c - the photographs of a folder: ids, exclusion, checks, records.
 *
 * Ids. Everything after this stage names a photo by an id of letters, digits, _ and -, so that file names with
 * spaces or other characters are safe in Make and in COLMAP's text files. The id is the name without its extension,
 * each run of other characters replaced by one _, of limited length. Names that would get one id get the extension
 * added, then a number; names whose id is unique keep it, so that adding a photo changes as few ids as possible.
 * Only the order of the names matters, never that of the folder.
 *
 * Which files. The first bytes decide (photo_kind.h): phones and browsers give JPEGs names that end with .HEIC, .jfif
 * or nothing. A file that has a photo's name but no photo in it is an unusable photo. Where a camera wrote a raw file
 * or a HEIC and a JPEG of one name, the JPEG is taken, because its owner has seen it. What is left out has a reason
 * (left_out.h).
 *
 * Checks. Every photo is read to its end once, in parallel, because a truncated file should be found before hours of
 * work. The record has the hash of the bytes: a photo with the same hash as in its old record is not read again.
 *
 * A record is rewritten only if its text changes, and removed when its photo is gone, so Make redoes what depends on
 * the photos that changed. Unusable photos are collected and named in one message with the line that leaves them
 * out. */
#include "stages/import_photos/photo_scan.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/array.h"
#include "common/base/file_path.h"
#include "common/base/outfile.h"
#include "common/base/parallel.h"
#include "common/base/progress.h"
#include "common/base/textfile.h"

static size_t known_stem(const char *file, const char *const *extensions, size_t count)
{
    const size_t length = strlen(file);
    for (size_t i = 0; i < count; i++) {
        const size_t tail = strlen(extensions[i]);
        if (length > tail && !strcasecmp(file + length - tail, extensions[i])) return length - tail;
    }
    return 0;
}

/* photo_stem() for raw files only. */
static size_t raw_stem(const char *file)
{
    static const char *const extensions[] = {".dng", ".cr2", ".cr3", ".crw", ".nef", ".nrw", ".arw", ".sr2", ".raf",
                                             ".orf", ".rw2", ".pef", ".srw", ".x3f", ".3fr", ".iiq", ".mrw"};
    return known_stem(file, extensions, sizeof extensions / sizeof *extensions);
}

/* Length of the name without the extension of a photo; 0: it has none. */
static size_t named_stem(const char *file)
{
    static const char *const extensions[] = {".jpg",  ".jpeg", ".jpe",  ".jfif", ".png", ".tif", ".tiff",
                                             ".heic", ".heif", ".avif", ".webp", ".jxl", ".exr"};
    const size_t stem = known_stem(file, extensions, sizeof extensions / sizeof *extensions);
    return stem ? stem : raw_stem(file);
}

size_t photo_stem(const char *file)
{
    const size_t stem = named_stem(file), length = strlen(file);
    const char *dot = strrchr(file, '.');
    if (stem || !dot || dot == file) return stem ? stem : length;
    /* of other names an extension is a letter with up to four letters and digits behind the last dot */
    const size_t tail = strspn(dot + 1, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789");
    const bool extension = tail >= 1 && tail <= 5 && !dot[1 + tail] && !(dot[1] >= '0' && dot[1] <= '9');
    return extension ? (size_t)(dot - file) : length;
}

/* Cameras that write two files of a shot give them the same name. The JPEG is used because its owner has seen it. */
static bool has_jpeg_twin(const struct photo_scan *scan, const struct scanned_photo *p)
{
    if (!raw_stem(p->file) && p->kind != PHOTO_KIND_HEIF) return false;
    const size_t stem = photo_stem(p->file);
    for (int i = 0; i < scan->count; i++) {
        const char *other = scan->photos[i].file;
        if (&scan->photos[i] != p && photo_stem(other) == stem && !strncmp(other, p->file, stem) &&
            (!strcasecmp(other + stem, ".jpg") || !strcasecmp(other + stem, ".jpeg")))
            return true;
    }
    return false;
}

static enum status drop_jpeg_twins(struct photo_scan *scan, struct err *err)
{
    int kept = 0;
    for (int i = 0; i < scan->count; i++) scan->photos[i].excluded = has_jpeg_twin(scan, &scan->photos[i]);
    for (int i = 0; i < scan->count; i++)
        if (scan->photos[i].excluded) {
            left_out_add(&scan->left, scan->photos[i].file, LEFT_DOUBLE, err);
            free(scan->photos[i].file);
        } else {
            scan->photos[kept++] = scan->photos[i];
        }
    scan->count = kept;
    return err->status;
}

static int by_file(const void *a, const void *b)
{
    return strcmp(((const struct scanned_photo *)a)->file, ((const struct scanned_photo *)b)->file);
}

static int by_id(const void *a, const void *b)
{
    return strcmp(((const struct scanned_photo *)a)->id, ((const struct scanned_photo *)b)->id);
}

bool photo_id_reserved(const char *id)
{
    static const char *const files[] = {"list", "brackets", "index", "offsets"};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        if (!strcmp(id, files[i])) return true;
    return false;
}

static bool id_taken(const struct photo_scan *scan, const char *id)
{
    if (photo_id_reserved(id)) return true;
    for (int i = 0; i < scan->count; i++)
        if (scan->photos[i].id && !strcmp(scan->photos[i].id, id)) return true;
    return false;
}

struct base_id {
    char text[MAX_PHOTO_ID + 1];
    int photo;
};

static int by_base(const void *a, const void *b)
{
    return strcmp(((const struct base_id *)a)->text, ((const struct base_id *)b)->text);
}

/* Photos are in order of file name. Unique ids are assigned first, then those that must be made unique. */
static enum status assign_ids(struct photo_scan *scan, struct err *err)
{
    size_t count = (size_t)scan->count;
    struct base_id *bases = calloc(count + 1, sizeof *bases), *sorted = calloc(count + 1, sizeof *sorted);
    bool *shared = calloc(count + 1, sizeof *shared);
    if (!bases || !sorted || !shared) err_nomem(err, "the photos' ids", count * sizeof *bases);

    for (size_t i = 0; !err->status && i < count; i++) {
        photo_id_from_stem(bases[i].text, scan->photos[i].file, photo_stem(scan->photos[i].file));
        bases[i].photo = (int)i;
        sorted[i] = bases[i];
    }
    if (!err->status) qsort(sorted, count, sizeof *sorted, by_base);
    for (size_t i = 0; !err->status && i < count; i++)
        shared[sorted[i].photo] = (i && !by_base(&sorted[i], &sorted[i - 1])) ||
                                  (i + 1 < count && !by_base(&sorted[i], &sorted[i + 1])) ||
                                  photo_id_reserved(sorted[i].text);
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; !err->status && i < count; i++) {
            struct scanned_photo *p = &scan->photos[i];
            char id[MAX_PHOTO_ID + 32];
            if (shared[i] != (pass == 1)) continue;
            if (shared[i]) {
                const char *extension = p->file + photo_stem(p->file);
                int n = 1,
                    length = snprintf(id, sizeof id, "%s_%s", bases[i].text, *extension ? extension + 1 : "photo");
                while (id_taken(scan, id)) snprintf(id + length, sizeof id - (size_t)length, "-%d", ++n);
            }
            p->id = strdup(shared[i] ? id : bases[i].text);
            if (!p->id) err_nomem(err, "a photo's id", MAX_PHOTO_ID);
        }
    }
    free(bases);
    free(sorted);
    free(shared);
    if (!err->status) qsort(scan->photos, count, sizeof *scan->photos, by_id);
    return err->status;
}

static char *join_path(const char *folder, const char *name, const char *suffix)
{
    char *path = NULL;
    return asprintf(&path, "%s/%s%s", folder, name, suffix) < 0 ? NULL : path;
}

/* What the file holds by its first bytes; OTHER also if it cannot be read, which is said later. */
static enum photo_kind kind_of_file(const char *path)
{
    unsigned char begin[64];
    FILE *f = fopen(path, "rb");
    const size_t size = f ? fread(begin, 1, sizeof begin, f) : 0;
    if (f) fclose(f);
    return photo_kind_of(begin, size);
}

static bool has_photos(const char *path)
{
    bool found = false;
    DIR *dir = opendir(path);
    for (struct dirent *e; dir && !found && (e = readdir(dir));) found = e->d_name[0] != '.' && named_stem(e->d_name);
    if (dir) closedir(dir);
    return found;
}

static enum status add_photo(struct photo_scan *scan, const char *name, enum photo_kind kind, struct err *err)
{
    if (array_append(&scan->photos, (size_t)scan->count, sizeof *scan->photos, "photos", err)) return err->status;
    scan->photos[scan->count] = (struct scanned_photo){.file = strdup(name), .kind = kind};
    return scan->photos[scan->count++].file ? ST_OK : err_nomem(err, "a file name", strlen(name) + 1);
}

static enum status add_clip(struct photo_scan *scan, const char *path, struct err *err)
{
    if (array_append(&scan->clips, (size_t)scan->clip_count, sizeof *scan->clips, "clips", err)) return err->status;
    scan->clips[scan->clip_count] = (struct scanned_clip){.path = strdup(path)};
    return scan->clips[scan->clip_count++].path ? ST_OK : err_nomem(err, "a path", strlen(path) + 1);
}

/* Phones write a clip of a few seconds beside a photo. */
static enum status drop_live_clips(struct photo_scan *scan, struct err *err)
{
    int kept = 0;
    for (int i = 0; i < scan->clip_count; i++) {
        const char *file = path_file_name(scan->clips[i].path);
        const size_t stem = photo_stem(file);
        bool live = false;
        for (int k = 0; k < scan->count && !live; k++)
            live = photo_stem(scan->photos[k].file) == stem && !strncmp(scan->photos[k].file, file, stem);
        if (!live) {
            scan->clips[kept++] = scan->clips[i];
            continue;
        }
        left_out_add(&scan->left, file, LEFT_LIVE, err);
        free(scan->clips[i].path);
    }
    scan->clip_count = kept;
    return err->status;
}

static int by_clip(const void *a, const void *b)
{
    const char *x = ((const struct scanned_clip *)a)->path, *y = ((const struct scanned_clip *)b)->path;
    const int order = strcmp(path_file_name(x), path_file_name(y));
    return order ? order : strcmp(x, y);
}

/* The ids leave room for what follows them in the names of frames. */
static enum status name_clips(struct photo_scan *scan, struct err *err)
{
    enum { MAX_CLIP_ID = MAX_PHOTO_ID - 20 };
    if (scan->clip_count) qsort(scan->clips, (size_t)scan->clip_count, sizeof *scan->clips, by_clip);
    for (int i = 0; i < scan->clip_count; i++) {
        const char *file = path_file_name(scan->clips[i].path);
        char id[MAX_PHOTO_ID + 32];
        photo_id_from_stem(id, file, photo_stem(file));
        id[MAX_CLIP_ID] = 0;
        const size_t length = strlen(id);
        for (int k = 0, n = 1; k < i; k++)
            if (!strcmp(scan->clips[k].id, id)) {
                snprintf(id + length, sizeof id - length, "-%d", ++n);
                k = -1;
            }
        if (!(scan->clips[i].id = strdup(id))) return err_nomem(err, "a clip's id", sizeof id);
    }
    return ST_OK;
}

/* What was given in place of a folder or of videos. */
static enum status refuse_source(const char *path, struct err *err)
{
    if (path_is_folder(path))
        return err_set(err, ST_DATA, "%s is a folder; give one folder of photos, or videos alone.", path);
    if (left_out_reason(path) == LEFT_ARCHIVE)
        return err_set(err, ST_DATA, "%s is an archive; unpack it, and give the folder of its photos.", path);
    if (kind_of_file(path) != PHOTO_KIND_OTHER)
        return err_set(err, ST_DATA, "%s is one photo; give the folder that holds all photos of the scene.", path);
    return err_set(
        err, ST_DATA,
        "%s does not contain a video in MP4, QuickTime, Matroska or AVI; convert other videos to MP4, or give a folder "
        "of photos.",
        path);
}

enum status photo_scan_clips(struct photo_scan *scan, const char *const *paths, int count, struct err *err)
{
    *scan = (struct photo_scan){0};
    for (int i = 0; !err->status && i < count; i++) {
        struct stat info;
        if (stat(paths[i], &info))
            err_errno(err, "read", paths[i]);
        else if (S_ISREG(info.st_mode) && kind_of_file(paths[i]) == PHOTO_KIND_VIDEO)
            add_clip(scan, paths[i], err);
        else
            refuse_source(paths[i], err);
    }
    return err->status ? err->status : name_clips(scan, err);
}

static enum status scan_entry(struct photo_scan *scan, const char *name, struct err *err)
{
    struct stat info;
    if (!strcmp(name, "exposures.txt") || !strcmp(name, "split.txt") || !strcmp(name, "frames.txt")) return ST_OK;
    if (name[0] == '.') return named_stem(name) ? left_out_add(&scan->left, name, LEFT_HIDDEN, err) : ST_OK;
    char *path = join_path(scan->folder, name, "");
    if (!path) return err_nomem(err, "a path", 0);
    const bool there = !stat(path, &info), file = there && S_ISREG(info.st_mode);
    const enum photo_kind kind = file ? kind_of_file(path) : PHOTO_KIND_OTHER;
    if (there && S_ISDIR(info.st_mode))
        left_out_add(&scan->left, name, has_photos(path) ? LEFT_FOLDER : LEFT_OTHER, err);
    else if (kind != PHOTO_KIND_OTHER && left_out_is_backup(name))
        left_out_add(&scan->left, name, LEFT_BACKUP, err);
    else if (kind == PHOTO_KIND_VIDEO && !named_stem(name))
        left_out_is_film(name) ? add_clip(scan, path, err) : left_out_add(&scan->left, name, LEFT_VIDEO, err);
    else if (kind != PHOTO_KIND_OTHER || (named_stem(name) && (file || !there)))
        add_photo(scan, name, kind, err); /* a dead link, and a photo's name without a photo, are unusable photos */
    else
        left_out_add(&scan->left, name, left_out_reason(name), err);
    free(path);
    return err->status;
}

enum status photo_scan_folder(struct photo_scan *scan, const char *folder, struct err *err)
{
    *scan = (struct photo_scan){.folder = strdup(folder)};
    if (!scan->folder) return err_nomem(err, "a path", strlen(folder) + 1);
    DIR *dir = opendir(folder);
    if (!dir && errno == ENOENT)
        return err_set(err, ST_IO, "the folder of photos %s is missing; give the folder of the photos.", folder);
    if (!dir && errno == ENOTDIR)
        return err_set(err, ST_DATA, "%s is not a folder; give the folder of the photos.", folder);
    if (!dir) return err_errno(err, "open the folder of photos", folder);

    errno = 0;
    for (struct dirent *entry; !err->status && (entry = readdir(dir)); errno = 0) scan_entry(scan, entry->d_name, err);
    if (!err->status && errno) err_errno(err, "list the folder of photos", folder);
    closedir(dir);
    if (!err->status && !drop_live_clips(scan, err)) name_clips(scan, err);
    if (!err->status) drop_jpeg_twins(scan, err);
    left_out_sort(&scan->left);
    if (!err->status && scan->count) {
        qsort(scan->photos, (size_t)scan->count, sizeof *scan->photos, by_file);
        assign_ids(scan, err);
    }
    return err->status;
}

int photo_scan_exclude(struct photo_scan *scan, const char *name)
{
    int matched = 0;
    for (int i = 0; i < scan->clip_count; i++) {
        struct scanned_clip *c = &scan->clips[i];
        const char *file = path_file_name(c->path);
        const size_t stem = photo_stem(file);
        if (strcmp(name, file) && strcmp(name, c->id) && (strlen(name) != stem || strncmp(name, file, stem))) continue;
        c->excluded = true;
        matched++;
    }
    for (int i = 0; i < scan->count; i++) {
        struct scanned_photo *p = &scan->photos[i];
        size_t stem = photo_stem(p->file);
        if (strcmp(name, p->file) && strcmp(name, p->id) && (strlen(name) != stem || strncmp(name, p->file, stem)))
            continue;
        p->excluded = true;
        matched++;
    }
    return matched;
}

struct check_job {
    struct photo_scan *scan;
    const char *records;
    struct progress progress;
};

/* A record of a mirrored photo is of an earlier release: photos lose their mirror when they are read. */
static bool is_mirrored(int orientation)
{
    return orientation == 2 || orientation == 4 || orientation == 5 || orientation == 7;
}

static bool read_old_record(struct photo_record *old, const char *records, const char *id)
{
    struct err absent = ERR_INIT, ignored = ERR_INIT;
    char *members = join_path(records, "members", "");
    bool found = (members && !photo_record_read(old, members, id, NULL, &absent)) ||
                 !photo_record_read(old, records, id, NULL, &ignored);
    free(members);
    return found && !is_mirrored(old->info.orientation);
}

/* Whether a record of the same bytes was made with the present setting of gain maps. */
static bool same_setting(const struct scanned_photo *p, const struct photo_info *old, const char *path, bool gain_maps)
{
    struct photo_info info;
    struct err ignored = ERR_INIT;
    if (p->kind != PHOTO_KIND_JPEG || (!gain_maps && old->bits != 32)) return true;
    return gain_maps && !photo_read_hdr_info(&info, path, &ignored) && info.bits == old->bits;
}

/* Makes the record of the file's present content. The old record is reused if the hash is the same. */
static enum status check_photo(struct scanned_photo *p, const char *folder, const char *records, bool gain_maps)
{
    struct photo_record old = {0};
    struct photo photo = {0};
    char quoted[1024];
    char *path = join_path(folder, p->file, "");

    if (!path) err_nomem(&p->err, "a path", 0);
    if (!p->err.status && !textfile_quote(p->file, quoted, sizeof quoted, &p->err))
        hash_file(p->record.hash, path, &p->err);
    if (!p->err.status && read_old_record(&old, records, p->id) && !strcmp(old.hash, p->record.hash) &&
        same_setting(p, &old.info, path, gain_maps)) {
        p->record.info = old.info;
    } else if (!p->err.status) {
        photo_check(&photo, path, gain_maps, &p->err);
        p->record.info = photo.info;
        p->transparent = photo.transparent;
        p->pages = photo.pages;
    }
    if (!p->err.status) {
        p->record.file = strdup(p->file);
        p->record.id = strdup(p->id);
        if (!p->record.file || !p->record.id) err_nomem(&p->err, "a record", 0);
    }
    photo_record_release(&old);
    photo_release(&photo);
    free(path);
    return p->err.status;
}

static void check_photos(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    struct check_job *job = ctx;
    for (size_t i = begin; i < end; i++) {
        struct scanned_photo *p = &job->scan->photos[i];
        if (!p->excluded) check_photo(p, job->scan->folder, job->records, job->scan->gain_maps);
        progress_add(&job->progress, 1);
    }
}

enum status photo_scan_check(struct photo_scan *scan, const char *records, struct err *err)
{
    struct check_job job = {.scan = scan, .records = records};
    progress_start(&job.progress, "checking photos", scan->count, "photos");
    parallel_for((size_t)scan->count, 1, check_photos, &job);
    progress_end(&job.progress);
    for (int i = 0; i < scan->count; i++) /* not an error of the photo */
        if (scan->photos[i].err.status == ST_NOMEM) return err_set(err, ST_NOMEM, "%s", scan->photos[i].err.text);
    return ST_OK;
}

/* Of photos with the same bytes the one with the shortest name stays: the others are called "copy of". */
enum status photo_scan_drop_same(struct photo_scan *scan, bool *dropped, struct err *err)
{
    for (int i = 0; !err->status && i < scan->count; i++) {
        struct scanned_photo *p = &scan->photos[i];
        for (int k = 0; !p->excluded && !p->err.status && k < scan->count; k++) {
            const struct scanned_photo *q = &scan->photos[k];
            const size_t own = strlen(p->file), other = strlen(q->file);
            if (k == i || q->excluded || q->err.status || strcmp(p->record.hash, q->record.hash) || other > own ||
                (other == own && k > i))
                continue;
            p->excluded = *dropped = true;
            left_out_add(&scan->left, p->file, LEFT_SAME, err);
        }
    }
    left_out_sort(&scan->left);
    return err->status;
}

static bool usable(const struct scanned_photo *p) { return !p->excluded && !p->err.status; }

static bool has_id(const char *const *ids, int count, const char *id, size_t length)
{
    for (int i = 0; i < count; i++)
        if (strlen(ids[i]) == length && !strncmp(ids[i], id, length)) return true;
    return false;
}

enum status photo_scan_remove_others(const char *records, const char *const *ids, int count, struct err *err)
{
    DIR *dir = opendir(records);
    if (!dir) return err_errno(err, "open", records);
    errno = 0;
    for (struct dirent *entry; !err->status && (entry = readdir(dir)); errno = 0) {
        size_t length = strlen(entry->d_name);
        if (length < 5 || strcmp(entry->d_name + length - 4, ".txt") || entry->d_name[0] == '.' ||
            !strcmp(entry->d_name, "list.txt") || has_id(ids, count, entry->d_name, length - 4))
            continue;
        char *path = join_path(records, entry->d_name, "");
        if (!path)
            err_nomem(err, "a path", 0);
        else if (unlink(path))
            err_errno(err, "remove", path);
        free(path);
    }
    if (!err->status && errno) err_errno(err, "list", records);
    closedir(dir);
    return err->status;
}

int photo_scan_bad(const struct photo_scan *scan)
{
    int bad = 0;
    for (int i = 0; i < scan->count; i++) bad += !scan->photos[i].excluded && scan->photos[i].err.status;
    return bad;
}

int photo_scan_used(const struct photo_scan *scan)
{
    int used = 0;
    for (int i = 0; i < scan->count; i++) used += !scan->photos[i].excluded;
    return used;
}

enum status photo_scan_refuse_bad(const struct photo_scan *scan, struct err *err)
{
    char names[1024] = "";
    int bad = photo_scan_bad(scan);
    if (!bad) return ST_OK;
    for (int i = 0; i < scan->count; i++) {
        size_t n = strlen(names);
        if (!scan->photos[i].excluded && scan->photos[i].err.status)
            snprintf(names + n, sizeof names - n, " %s", scan->photos[i].id);
    }
    return err_set(err, ST_DATA, "%d of %d photos in %s cannot be used; replace them, or leave them out (EXCLUDE =%s).",
                   bad, photo_scan_used(scan), scan->folder, names);
}

enum status photo_scan_write_records(const struct photo_scan *scan, const char *records, struct err *err)
{
    int count = 0;
    const char **ids = calloc((size_t)scan->count + 1, sizeof *ids);
    if (ids)
        outfile_make_folders(records, err);
    else
        err_nomem(err, "ids", (size_t)scan->count * sizeof *ids);

    for (int i = 0; !err->status && i < scan->count; i++)
        if (usable(&scan->photos[i])) ids[count++] = scan->photos[i].id;
    if (!err->status) photo_scan_remove_others(records, ids, count, err);
    for (int i = 0; !err->status && i < scan->count; i++)
        if (usable(&scan->photos[i])) photo_record_write(&scan->photos[i].record, records, err);
    if (!err->status) photo_scan_refuse_bad(scan, err);
    free(ids);
    return err->status;
}

enum status photo_scan_write(const struct photo_scan *scan, const char *records, struct err *err)
{
    struct photo_list list = {0};
    int used = photo_scan_used(scan);
    photo_scan_write_records(scan, records, err);

    if (!err->status && used < (scan->single ? 1 : 2))
        err_set(err, ST_DATA,
                "%s contains %s photo%s; a parallax video needs at least 2, taken from different places, or one with "
                "its depth (DEPTH).",
                scan->folder, used ? "one" : "no", used < scan->count ? " besides those left out" : "");
    if (!err->status && !(list.photos = calloc((size_t)scan->count + 1, sizeof *list.photos)))
        err_nomem(err, "a list of photos", (size_t)scan->count * sizeof *list.photos);
    for (int i = 0; !err->status && i < scan->count; i++)
        if (usable(&scan->photos[i])) list.photos[list.count++] = scan->photos[i].record; /* borrowed */
    if (!err->status) photo_list_write(&list, records, err);
    free(list.photos);
    return err->status;
}

void photo_scan_release(struct photo_scan *scan)
{
    if (!scan) return;
    for (int i = 0; i < scan->count; i++) {
        free(scan->photos[i].file);
        free(scan->photos[i].id);
        photo_record_release(&scan->photos[i].record);
    }
    for (int i = 0; i < scan->clip_count; i++) {
        free(scan->clips[i].path);
        free(scan->clips[i].id);
    }
    free(scan->photos);
    free(scan->clips);
    left_out_release(&scan->left);
    free(scan->folder);
    *scan = (struct photo_scan){0};
}
