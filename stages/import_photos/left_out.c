/* left_out.c - files in a folder of photographs that are not used, with the reason. */
#include "stages/import_photos/left_out.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "common/base/array.h"
#include "common/base/log.h"

enum { MAX_NAMED = 8 };

static const struct {
    bool warn;
    const char *why;
} reasons[LEFT_REASONS] = {
    [LEFT_FOLDER] = {true, "folders with photos, which are not searched; move the photos into one folder, or give that "
                           "one as the folder of photos"},
    [LEFT_VIDEO] = {true, "videos of a kind that is not read here; convert them to MP4"},
    [LEFT_CLIP] = {true, "videos, which are used only as photos of a scene"},
    [LEFT_LIVE] = {false,
                   "clips beside photos of the same name, as phones record them with a photo; to use one, give it "
                   "as PHOTOS or rename it"},
    [LEFT_ARCHIVE] = {true, "archives, which are not opened; unpack their photos into the folder"},
    [LEFT_PICTURE] = {true, "pictures of a kind that is not read; save them as JPEG, PNG or TIFF if they are photos"},
    [LEFT_DOUBLE] = {false,
                     "a raw file, HEIC or AVIF beside a JPEG of the same name, the same shot twice; to use them, "
                     "put them into a folder of their own"},
    [LEFT_SAME] = {false, "the same bytes as another photo, under a second name"},
    [LEFT_BACKUP] = {false, "backups, thumbnails or unfinished downloads by their names; rename those that are photos"},
    [LEFT_HIDDEN] = {false, "hidden files; rename those that are photos"},
    [LEFT_OTHER] = {false, "no pictures"},
};

enum status left_out_add(struct left_out *l, const char *file, enum left_reason reason, struct err *err)
{
    if (array_append(&l->files, (size_t)l->count, sizeof *l->files, "names of files", err)) return err->status;
    l->files[l->count] = (struct left_file){strdup(file), reason};
    return l->files[l->count++].file ? ST_OK : err_nomem(err, "a file name", strlen(file) + 1);
}

static int by_reason(const void *a, const void *b)
{
    const struct left_file *x = a, *y = b;
    if (x->reason != y->reason) return x->reason < y->reason ? -1 : 1;
    const int order = strverscmp(x->file, y->file);
    return order ? order : strcmp(x->file, y->file);
}

void left_out_sort(struct left_out *l)
{
    if (l->count) qsort(l->files, (size_t)l->count, sizeof *l->files, by_reason);
}

static bool ends_with(const char *file, const char *const *endings, size_t count)
{
    const size_t length = strlen(file);
    for (size_t i = 0; i < count; i++) {
        const size_t n = strlen(endings[i]);
        if (length > n && !strcasecmp(file + length - n, endings[i])) return true;
    }
    return false;
}

enum left_reason left_out_reason(const char *file)
{
    static const char *const videos[] = {".mp4",  ".mov", ".m4v", ".avi",  ".mkv", ".webm", ".mts",
                                         ".m2ts", ".3gp", ".lrv", ".insv", ".360", ".mpg",  ".wmv"};
    static const char *const pictures[] = {".gif", ".bmp", ".psd", ".psb", ".tga", ".svg", ".pdf", ".jp2", ".hdr"};
    static const char *const archives[] = {".zip", ".rar", ".7z", ".tar", ".tgz", ".gz", ".xz", ".bz2", ".zst"};
    if (ends_with(file, archives, sizeof archives / sizeof *archives)) return LEFT_ARCHIVE;
    if (ends_with(file, videos, sizeof videos / sizeof *videos)) return LEFT_VIDEO;
    return ends_with(file, pictures, sizeof pictures / sizeof *pictures) ? LEFT_PICTURE : LEFT_OTHER;
}

bool left_out_is_film(const char *file)
{
    static const char *const others[] = {".lrv", ".insv", ".360"};
    return !ends_with(file, others, sizeof others / sizeof *others);
}

bool left_out_is_backup(const char *file)
{
    static const char *const endings[] = {"_original", "~",     ".bak",     ".old",      ".orig",      ".thm",
                                          ".tmp",      ".part", ".partial", ".download", ".crdownload"};
    return ends_with(file, endings, sizeof endings / sizeof *endings);
}

void left_out_report(const struct left_out *l, const char *folder)
{
    for (int begin = 0, end; begin < l->count; begin = end) {
        const enum left_reason reason = l->files[begin].reason;
        char names[600] = "", more[32] = "";
        for (end = begin; end < l->count && l->files[end].reason == reason; end++) {
            const size_t n = strlen(names);
            if (end - begin < MAX_NAMED)
                snprintf(names + n, sizeof names - n, "%s%.64s", n ? ", " : "", l->files[end].file);
        }
        if (end - begin > MAX_NAMED) snprintf(more, sizeof more, " and %d more", end - begin - MAX_NAMED);
        (reasons[reason].warn ? log_warn : log_note)("not used in %s: %s%s (%s)%s", folder, names, more,
                                                     reasons[reason].why, reasons[reason].warn ? "." : "");
    }
}

void left_out_release(struct left_out *l)
{
    if (!l) return;
    for (int i = 0; i < l->count; i++) free(l->files[i].file);
    free(l->files);
    *l = (struct left_out){0};
}
