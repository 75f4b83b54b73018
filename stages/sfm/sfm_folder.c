/* sfm_folder.c - the stage's output folder. */
#include "stages/sfm/sfm_folder.h"

#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/ledger.h"
#include "common/base/outfile.h"
#include "common/product/product.h"

char *sfm_text_format(struct err *err, const char *fmt, ...)
{
    char *text = NULL;
    va_list args;
    va_start(args, fmt);
    if (vasprintf(&text, fmt, args) < 0) {
        text = NULL;
        err_nomem(err, "a text", strlen(fmt));
    }
    va_end(args);
    return text;
}

static int remove_one(const char *path, const struct stat *info, int kind, struct FTW *ftw)
{
    (void)info, (void)kind, (void)ftw;
    return remove(path);
}

enum status sfm_remove_tree(const char *path, struct err *err)
{
    if (nftw(path, remove_one, 16, FTW_DEPTH | FTW_PHYS) && errno != ENOENT) return err_errno(err, "remove", path);
    return ST_OK;
}

/* `out` will be replaced as a whole, so it must be missing, an empty folder, or a product of this stage. */
static enum status check_replaceable(const char *out, struct err *err)
{
    char models[FILE_PATH];
    if (product_path_in(models, out, PRODUCT_SFM_MODELS, NULL, err)) return err->status;
    bool ours = !access(models, F_OK);
    if (ours || !rmdir(out) || errno == ENOENT) return ST_OK;
    return err_set(
        err, ST_USAGE,
        "%s exists and is not a folder of structure-from-motion models (it has no models.txt), and it would be "
        "replaced as a whole; give another folder with --out.",
        out);
}

enum status sfm_folder_open(struct sfm_folder *f, const char *out, struct err *err)
{
    size_t length = strlen(out);
    *f = (struct sfm_folder){0};
    while (length > 1 && out[length - 1] == '/') length--;
    f->out = sfm_text_format(err, "%.*s", (int)length, out);
    f->work = sfm_text_format(err, "%.*s.work", (int)length, out);
    f->made = sfm_text_format(err, "%.*s.work/sfm", (int)length, out);
    if (!f->out || !f->work || !f->made) return err->status;
    return check_replaceable(f->out, err) || sfm_remove_tree(f->work, err) || outfile_make_folders(f->made, err)
               ? err->status
               : ST_OK;
}

enum status sfm_folder_add(struct sfm_folder *f, const struct sfm_model *m, const struct provenance *prov,
                           struct err *err)
{
    char *folder = sfm_text_format(err, "%s/%d", f->made, f->models);
    if (folder && !sfm_model_write_text(m, folder, prov, err)) f->models++;
    free(folder);
    return err->status;
}

static enum status write_lists(const struct sfm_folder *f, const struct photo_list *photos,
                               const struct provenance *prov, struct err *err)
{
    struct outfile list = {0}, models = {0};
    char list_path[FILE_PATH], models_path[FILE_PATH];
    if (!product_path_in(list_path, f->made, PRODUCT_SFM_PHOTOS, NULL, err) &&
        !product_path_in(models_path, f->made, PRODUCT_SFM_MODELS, NULL, err) &&
        !product_begin(&list, PRODUCT_SFM_PHOTOS, list_path, prov, err)) {
        for (int i = 0; i < photos->count; i++)
            fprintf(list.fp, "%s %s\n", photos->photos[i].id, photos->photos[i].hash);
        outfile_commit(&list, err);
    }
    if (!err->status && !product_begin(&models, PRODUCT_SFM_MODELS, models_path, prov, err)) {
        for (int i = 0; i < f->models; i++) fprintf(models.fp, "%d colmap %s\n", i, f->given);
        outfile_commit(&models, err);
    }
    outfile_discard(&list);
    outfile_discard(&models);
    return err->status;
}

/* The files of the folder were written below `made`; the ledger has them by the names that they will have. */
static enum status add_to_ledger(const struct sfm_folder *f, struct err *err)
{
    static const char *const names[] = {"cameras.txt", "images.txt", "points3D.txt"};
    static const enum product_id lists[] = {PRODUCT_SFM_PHOTOS, PRODUCT_SFM_MODELS};
    char made[FILE_PATH], out[FILE_PATH];
    for (int i = 0; i < (int)(sizeof lists / sizeof *lists); i++)
        if (!product_path_in(made, f->made, lists[i], NULL, err) && !product_path_in(out, f->out, lists[i], NULL, err))
            ledger_add(out, made, err);
    for (int i = 0; !err->status && i < f->models * 3; i++) {
        char name[64];
        snprintf(name, sizeof name, "%d/%s", i / 3, names[i % 3]);
        if (!file_path(made, f->made, name, "", err) && !file_path(out, f->out, name, "", err))
            ledger_add(out, made, err);
    }
    return err->status;
}

enum status sfm_folder_commit(struct sfm_folder *f, const struct photo_list *photos, const struct provenance *prov,
                              struct err *err)
{
    if (!write_lists(f, photos, prov, err)) add_to_ledger(f, err);
    char *old = sfm_text_format(err, "%s/old", f->work);
    /* if there is no old folder, or the file system cannot exchange two, an old one is moved away first */
    if (!err->status && renameat2(AT_FDCWD, f->made, AT_FDCWD, f->out, RENAME_EXCHANGE) &&
        ((rename(f->out, old) && errno != ENOENT) || rename(f->made, f->out)))
        err_errno(err, "replace", f->out);
    free(old);
    if (!err->status) sfm_remove_tree(f->work, err);
    return err->status;
}

void sfm_folder_release(struct sfm_folder *f)
{
    if (!f) return;
    free(f->out);
    free(f->work);
    free(f->made);
    *f = (struct sfm_folder){0};
}
