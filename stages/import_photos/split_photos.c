/* split_photos.c - cuts photographs of a multi-lens camera into their pictures.
 *
 * A multi-lens camera takes a grid of small pictures on one photo. Each becomes a photo of its own, PHOTO_cXrY.png,
 * without loss. split_layout.h finds where the pictures lie; pixels beyond a multiple of the grid belong to none,
 * and a note says how many.
 *
 * EXIF is passed on, with the focal length in 35 mm scaled by the ratio of the diagonals: the same lens covers only
 * a part of the frame.
 *
 * Work is done once. split.txt holds the hash of each photo and of each of its pictures. A photo is cut again if its
 * bytes changed, if the grid changed, or if one of its pictures is missing or was changed; otherwise hashes and
 * positions are taken over. Pictures of photos that are gone are removed, and only files with a name like a
 * picture's.
 *
 * One unusable photo does not stop the others: its error is kept with it, and all bad ones are named in one message
 * at the end. Pictures of a photo are written in parallel; memory holds one photo. */
#include "stages/import_photos/split_photos.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/base/parallel.h"
#include "stages/import_photos/split_list.h"

static char *join_path(const char *folder, const char *name)
{
    char *path = NULL;
    return asprintf(&path, "%s/%s", folder, name) < 0 ? NULL : path;
}

/* Names the photo's pictures; hashes and positions are not set yet. */
static enum status name_cuts(struct split_photo *s, const struct scanned_photo *p, const struct split_grid *g,
                             struct err *err)
{
    const size_t cuts = (size_t)(g->columns * g->rows);
    s->file = strdup(p->file);
    s->cuts = calloc(cuts, sizeof *s->cuts);
    if (!s->file || !s->cuts) return err_nomem(err, "a list of pictures", cuts * sizeof *s->cuts);
    for (int r = 1; r <= g->rows; r++)
        for (int c = 1; c <= g->columns; c++) {
            struct split_cut *cut = &s->cuts[s->count];
            if (!(cut->file = split_name_make(p->id, c, r))) return err_nomem(err, "a file name", 0);
            s->count++;
        }
    return ST_OK;
}

/* Whether the existing pictures are up to date; fills their hashes and positions if so. */
static bool up_to_date(struct split_photo *s, const struct split_list *old, const struct split_grid *g, const char *out)
{
    const struct split_photo *before = NULL;
    if (memcmp(&old->grid, g, sizeof *g)) return false;
    for (int i = 0; i < old->count && !before; i++)
        if (!strcmp(old->photos[i].file, s->file) && !strcmp(old->photos[i].hash, s->hash)) before = &old->photos[i];
    for (int k = 0; before && k < s->count; k++) {
        const struct split_cut *was = &before->cuts[k];
        struct split_cut *cut = &s->cuts[k];
        struct err ignored = ERR_INIT;
        char *path = strcmp(was->file, cut->file) ? NULL : join_path(out, cut->file);
        const bool same =
            path && !access(path, F_OK) && !hash_file(cut->hash, path, &ignored) && !strcmp(cut->hash, was->hash);
        free(path);
        if (!same) return false;
        cut->x = was->x;
        cut->y = was->y;
    }
    if (before) s->width = before->width, s->height = before->height;
    return before;
}

struct cut_job {
    struct split_photo *to;
    const struct photo *from;
    const struct photo_info *info;
    const char *out;
    struct err *errs; /* of each picture */
};

static void cut_pictures(void *ctx, size_t begin, size_t end, int thread)
{
    (void)thread;
    struct cut_job *job = ctx;
    for (size_t i = begin; i < end; i++) {
        struct split_cut *c = &job->to->cuts[i];
        char *path = join_path(job->out, c->file);
        struct err *err = &job->errs[i];
        if (!path)
            err_nomem(err, "a path", 0);
        else if (!photo_write_part(path, job->from, c->x, c->y, job->to->width, job->to->height, job->info, err))
            hash_file(c->hash, path, err);
        free(path);
    }
}

static enum status write_cuts(struct split_photo *s, const struct photo *p, const char *out, struct err *err)
{
    struct photo_info info = p->info;
    info.focal35_mm *= hypot(p->info.width, p->info.height) / hypot(s->width, s->height);
    struct cut_job job = {s, p, &info, out, calloc((size_t)s->count, sizeof *job.errs)};
    if (!job.errs) return err_nomem(err, "errors", (size_t)s->count * sizeof *job.errs);
    parallel_for((size_t)s->count, 1, cut_pictures, &job);
    for (int i = 0; !err->status && i < s->count; i++)
        if (job.errs[i].status) err_set(err, job.errs[i].status, "%s", job.errs[i].text);
    free(job.errs);
    return err->status;
}

/* Errors in the photo itself go to its own `err`. */
static enum status cut_photo(struct split_photo *s, struct scanned_photo *p, const struct split_grid *g,
                             const char *path, const char *out, struct err *err)
{
    struct photo photo = {0};
    struct split_layout layout = {0};
    if (!photo_read(&photo, path, &p->err) && !split_layout_find(&layout, g, &photo, path, &p->err)) {
        s->width = layout.width;
        s->height = layout.height;
        for (int i = 0; i < s->count; i++) {
            s->cuts[i].x = layout.x[i % g->columns];
            s->cuts[i].y = layout.y[i / g->columns];
        }
        if (layout.over_width || layout.over_height)
            log_note(
                "%s: %d x %d px are no multiple of %d x %d pictures; %d px across and %d px down are in none of them",
                p->file, photo.info.width, photo.info.height, g->columns, g->rows, layout.over_width,
                layout.over_height);
        if (photo.info.orientation > 4 && g->columns != g->rows)
            log_warn("%s is stored rotated by 90 degrees; its %d columns and %d rows of pictures count in the photo as "
                     "stored.",
                     p->file, g->columns, g->rows);
        write_cuts(s, &photo, out, err);
    }
    photo_release(&photo);
    return err->status;
}

static bool is_listed(const struct split_list *list, const char *file)
{
    for (int i = 0; i < list->count; i++)
        for (int k = 0; k < list->photos[i].count; k++)
            if (!strcmp(list->photos[i].cuts[k].file, file)) return true;
    return false;
}

/* Whether a name ends with _cXrY.png, as those of pictures do. */
static bool is_cut_name(const char *name)
{
    const char *at = strrchr(name, '_');
    int column, row, end = 0;
    return at && sscanf(at, "_c%2dr%2d.png%n", &column, &row, &end) == 2 && end && !at[end];
}

static enum status remove_others(const struct split_list *list, const char *out, struct err *err)
{
    DIR *dir = opendir(out);
    if (!dir) err_errno(err, "open", out);
    for (struct dirent *e; !err->status && (e = readdir(dir));) {
        if (e->d_name[0] == '.' || !is_cut_name(e->d_name) || is_listed(list, e->d_name)) continue;
        char *path = join_path(out, e->d_name);
        if (!path)
            err_nomem(err, "a path", 0);
        else if (unlink(path))
            err_errno(err, "remove", path);
        free(path);
    }
    if (dir) closedir(dir);
    return err->status;
}

static enum status split_all(struct split_list *list, int *kept, struct photo_scan *scan, const struct split_list *old,
                             const char *out, struct err *err)
{
    for (int i = 0; !err->status && i < scan->count; i++) {
        struct scanned_photo *p = &scan->photos[i];
        struct split_photo *s = &list->photos[list->count];
        if (p->excluded) continue;
        char *path = join_path(scan->folder, p->file);
        if (!path) err_nomem(err, "a path", 0);
        list->count++;
        if (!err->status && !name_cuts(s, p, &list->grid, err) && !hash_file(s->hash, path, &p->err)) {
            if (up_to_date(s, old, &list->grid, out))
                ++*kept;
            else
                cut_photo(s, p, &list->grid, path, out, err); /* goes on with the next one if only this is unusable */
        }
        free(path);
    }
    return err->status;
}

enum status split_photos(struct photo_scan *scan, const struct split_grid *grid, const char *out, struct err *err)
{
    struct split_list old = {0}, list = {.grid = *grid};
    struct err ignored = ERR_INIT;
    int kept = 0;
    if (!photo_scan_used(scan))
        return err_set(err, ST_DATA, "%s contains no photo%s to cut into pictures.", scan->folder,
                       scan->count ? " besides those left out" : "");
    char *path = join_path(out, "split.txt");
    list.photos = calloc((size_t)scan->count, sizeof *list.photos);
    if (path && list.photos)
        outfile_make_folders(out, err);
    else
        err_nomem(err, "a list of photos", 0);
    if (!err->status) {
        split_list_read(&old, path, &ignored); /* if it cannot be read, all photos are cut again */
        if (!split_all(&list, &kept, scan, &old, out, err) && !photo_scan_refuse_bad(scan, err))
            remove_others(&list, out, err);
    }
    if (!err->status && (kept < list.count || list.count != old.count)) split_list_write(&list, path, err);
    if (!err->status && kept < list.count)
        log_note("%d of %d photos cut into %d x %d pictures each", list.count - kept, list.count, grid->columns,
                 grid->rows);
    split_list_release(&old);
    split_list_release(&list);
    free(path);
    return err->status;
}
