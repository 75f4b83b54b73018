/* ledger_gather.c - puts together what the processes of a run wrote down, at its end. */
#include "stages/verify/ledger_gather.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/file_path.h"
#include "common/capture/photo_list.h"
#include "common/product/product.h"
#include "stages/verify/ledger_file.h"

/* --- what people gave --- */

static enum status add_given(struct ledger *l, const char *path, struct err *err);

/* Names that begin with a dot are of editors and of files that are being written. */
static enum status add_given_folder(struct ledger *l, const char *folder, struct err *err)
{
    char path[FILE_PATH];
    DIR *dir = opendir(folder);
    if (!dir) return err_errno(err, "open", folder);
    errno = 0;
    for (const struct dirent *e; !err->status && (e = readdir(dir)); errno = 0)
        if (e->d_name[0] != '.' && !file_path(path, folder, e->d_name, "", err)) add_given(l, path, err);
    if (!err->status && errno) err_errno(err, "list", folder);
    closedir(dir);
    return err->status;
}

static enum status add_given(struct ledger *l, const char *path, struct err *err)
{
    char hash[HASH_TEXT];
    if (path_is_folder(path)) return add_given_folder(l, path, err);
    if (!path_is_file(path) || hash_file(hash, path, err)) return err->status;
    return ledger_append(l, hash, LEDGER_SCENE, path, err);
}

/* A photo or clip by its name, if it is still where the user said. */
static enum status add_photo(struct ledger *l, const struct cli_list *photos, const char *name, const char *hash,
                             struct err *err)
{
    char path[FILE_PATH];
    for (int i = 0; !err->status && i < photos->count; i++) {
        if (!path_is_folder(photos->items[i])) {
            if (!strcmp(path_file_name(photos->items[i]), name))
                return ledger_append(l, hash, LEDGER_PHOTO, photos->items[i], err);
        } else if (!file_path(path, photos->items[i], name, "", err) && path_is_file(path))
            return ledger_append(l, hash, LEDGER_PHOTO, path, err);
    }
    return err->status;
}

/* Lines "WORD NAME ... HASH": clips of frames.txt, photos of split.txt. skip: words between name and hash. */
static enum status add_photos_of_list(struct ledger *l, const struct cli_list *photos, const char *shared,
                                      enum product_id id, const char *word, int skip, struct err *err)
{
    struct textfile t = {0};
    char path[FILE_PATH];
    if (product_path_below(path, shared, id, NULL, err) || !path_is_file(path)) return err->status;
    product_open(&t, NULL, id, path, NULL, err);
    while (!err->status && textfile_next(&t)) {
        char *first, *name, *hash;
        if (textfile_word(&t, "a word", &first, err) || strcmp(first, word) != 0) continue;
        textfile_word(&t, "a name", &name, err);
        for (int i = 0; !err->status && i <= skip; i++) textfile_word(&t, "a hash", &hash, err);
        if (!err->status) add_photo(l, photos, name, hash, err);
    }
    textfile_release(&t);
    return err->status;
}

static enum status add_photos(struct ledger *l, const struct cli_list *photos, const char *shared, struct err *err)
{
    struct photo_list list = {0};
    char folder[FILE_PATH], path[FILE_PATH];
    if (file_path(folder, shared, "photos", "", err) || file_path(path, folder, "list.txt", "", err) ||
        !path_is_file(path) || photo_list_read(&list, folder, err))
        return err->status;
    for (int i = 0; !err->status && i < list.count; i++) {
        const struct photo_record *r = &list.photos[i];
        if (!r->bracket_count) add_photo(l, photos, r->file, r->hash, err);
        for (int k = 0; !err->status && k < r->bracket_count; k++)
            add_photo(l, photos, r->brackets[k].file, r->brackets[k].hash, err);
    }
    photo_list_release(&list);
    if (!err->status) add_photos_of_list(l, photos, shared, PRODUCT_CLIP_LIST, "clip", 1, err);
    return err->status ? err->status : add_photos_of_list(l, photos, shared, PRODUCT_SPLIT_LIST, "photo", 0, err);
}

/* --- what was made --- */

/* The files of processes, in the order of their names. A node may still be writing others: only these are removed. */
struct new_files {
    struct dirent **names; /* owned, as they are */
    int count;
};

static enum status read_new(struct ledger *l, struct new_files *files, const char *folder, struct err *err)
{
    char path[FILE_PATH];
    files->count = scandir(folder, &files->names, NULL, alphasort);
    if (files->count < 0) {
        files->count = 0;
        return errno == ENOENT ? ST_OK : err_errno(err, "open", folder);
    }
    for (int i = 0; !err->status && i < files->count; i++) {
        struct err bad = ERR_INIT;
        if (files->names[i]->d_name[0] == '.' || file_path(path, folder, files->names[i]->d_name, "", err)) continue;
        if (ledger_add_lines(l, path, &bad)) log_warn("%s What else it says is left out.", bad.text);
    }
    return err->status;
}

static void remove_new(const struct new_files *files, const char *folder, struct err *err)
{
    char path[FILE_PATH];
    for (int i = 0; i < files->count; i++)
        if (files->names[i]->d_name[0] != '.' && !file_path(path, folder, files->names[i]->d_name, "", err))
            unlink(path);
}

/* Below S or S+..., but not what a run keeps for itself there, nor what lies in a folder with a name of its own until
 * it is whole. */
static bool is_of_scene(const char *path, const char *shared)
{
    static const char *const own[] = {"log/", "slice/", "stamp/", "graph/", "jobs/", "sfm.work/"};
    const size_t n = strlen(shared);
    if (strncmp(path, shared, n) != 0 || (path[n] != '/' && path[n] != '+')) return false;
    const char *below = strchr(path + n, '/');
    for (size_t i = 0; below && i < sizeof own / sizeof *own; i++)
        if (!strncmp(below + 1, own[i], strlen(own[i]))) return false;
    return below;
}

/* Keeps one of the entries of a path: the last, or that which has the file's bytes. */
static enum status keep_one(struct ledger *to, const struct ledger_entry *e, int count, struct err *err)
{
    const struct ledger_entry *kept = &e[count - 1];
    bool differ = false;
    char hash[HASH_TEXT];
    for (int i = 1; i < count; i++) differ |= strcmp(e[i].hash, e[0].hash) != 0;
    if (differ && hash_file(hash, e->path, err)) return err->status;
    for (int i = count - 1; differ && i >= 0; i--)
        if (!strcmp(e[i].hash, hash)) {
            kept = &e[i];
            break;
        }
    return ledger_append(to, kept->hash, kept->maker, kept->path, err);
}

static enum status merge(struct ledger *to, const struct ledger *all, const char *shared, bool drop_given,
                         struct err *err)
{
    for (int i = 0, next; !err->status && i < all->count; i = next) {
        const struct ledger_entry *e = &all->entries[i];
        for (next = i + 1; next < all->count && !strcmp(all->entries[next].path, e->path); next++)
            ;
        if (ledger_is_given(e) ? !drop_given : is_of_scene(e->path, shared) && path_is_file(e->path))
            keep_one(to, e, next - i, err);
    }
    return err->status;
}

enum status ledger_gather(const struct ledger_gather_in *in, struct err *err)
{
    struct ledger all = {0}, kept = {0};
    struct new_files files = {0};
    char path[FILE_PATH], added[FILE_PATH];

    if (file_path(path, in->shared, "log/ledger.txt", "", err) || file_path(added, in->shared, "log/ledger", "", err))
        return err->status;
    if (!ledger_read(&all, path, err) && !read_new(&all, &files, added, err) && !ledger_sort(&all, err))
        merge(&kept, &all, in->shared, in->given->count > 0, err);
    for (int i = 0; !err->status && i < in->given->count; i++) add_given(&kept, in->given->items[i], err);
    if (!err->status && in->given->count) add_photos(&kept, in->photos, in->shared, err);
    if (!err->status && !ledger_sort(&kept, err) && !ledger_write(&kept, path, err)) remove_new(&files, added, err);
    for (int i = 0; i < files.count; i++) free(files.names[i]);
    free(files.names);
    ledger_release(&kept);
    ledger_release(&all);
    return err->status;
}
