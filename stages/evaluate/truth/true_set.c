/* true_set.c - see true_set.h. */
#include "stages/evaluate/truth/true_set.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/capture/sfm_model.h"

static int compare_pictures(const void *a, const void *b)
{
    const struct true_picture *x = a, *y = b;
    return strcmp(x->name, y->name);
}

/* Adds the cameras of two files; a name that the set has already is left out. */
static enum status add_cameras(struct true_set *set, const char *of_cameras, const char *of_images, struct err *err)
{
    struct sfm_model m = {0};
    const int before = set->count;
    sfm_model_read_camera_files(&m, of_cameras, of_images, NULL, err);
    for (int i = 0; !err->status && i < m.image_count; i++) {
        const char *dot = strrchr(m.images[i].name, '.');
        struct true_picture p = {.lens = m.cameras[m.images[i].camera_idx].camera, .pose = m.images[i].cam_from_world};
        p.name = dot && dot != m.images[i].name ? strndup(m.images[i].name, (size_t)(dot - m.images[i].name))
                                                : strdup(m.images[i].name);
        bool known = false;
        for (int k = 0; p.name && k < before; k++) known = known || !strcmp(set->pictures[k].name, p.name);
        if (!p.name) err_nomem(err, "a name", strlen(m.images[i].name));
        if (!err->status && !known)
            array_append(&set->pictures, (size_t)set->count, sizeof *set->pictures, "true pictures", err);
        if (err->status || known)
            free(p.name);
        else
            set->pictures[set->count++] = p;
    }
    sfm_model_release(&m);
    return err->status;
}

/* Adds FOLDER/WHEREcameras.txt and images.txt if both exist; *found says so. */
static enum status try_cameras(struct true_set *set, const char *truth, const char *where, bool *found,
                               struct provenance *prov, struct err *err)
{
    static const char *const files[2] = {"cameras.txt", "images.txt"};
    char paths[2][FILE_PATH];
    *found = true;
    for (int k = 0; k < 2; k++) {
        if (file_path(paths[k], truth, where, files[k], err)) return err->status;
        *found = *found && path_is_file(paths[k]);
    }
    if (!*found) return ST_OK;
    for (int k = 0; k < 2; k++)
        if (provenance_add_in(prov, "truth", truth, where, files[k], NULL, err)) return err->status;
    return add_cameras(set, paths[0], paths[1], err);
}

enum status true_set_read(struct true_set *set, const char *truth, const char *where, struct provenance *prov,
                          struct err *err)
{
    char in[80], beside[80];
    bool found = false;
    *set = (struct true_set){0};
    snprintf(set->where, sizeof set->where, "%s", where);
    snprintf(set->prefix, sizeof set->prefix, "%s", where);
    if (!strncmp(where, "edited-", 7)) set->prefix[6] = '.';
    if (*where ? file_path(set->folder, truth, where, "", err)
               : snprintf(set->folder, sizeof set->folder, "%s", truth) >= FILE_PATH)
        return *where ? err->status : err_set(err, ST_IO, "the path of the truth is too long: %s.", truth);
    if (!path_is_folder(set->folder)) return ST_OK;
    snprintf(in, sizeof in, "%s%s", where, *where ? "/" : "");
    snprintf(beside, sizeof beside, "%s-", where);
    try_cameras(set, truth, in, &found, prov, err);
    if (!err->status && !found && *where) try_cameras(set, truth, beside, &found, prov, err);
    set->own_cameras = found;
    static const char *const others[] = {"", "novel/", "novel-"};
    for (int k = 0; !err->status && !set->own_cameras && k < 3; k++)
        try_cameras(set, truth, others[k], &found, prov, err);
    if (err->status)
        true_set_release(set);
    else if (set->count)
        qsort(set->pictures, (size_t)set->count, sizeof *set->pictures, compare_pictures);
    return err->status;
}

void true_set_release(struct true_set *set)
{
    for (int i = 0; i < set->count; i++) free(set->pictures[i].name);
    free(set->pictures);
    *set = (struct true_set){0};
}

const struct true_picture *true_set_find(const struct true_set *set, const char *name)
{
    for (int i = 0; i < set->count; i++)
        if (!strcmp(set->pictures[i].name, name)) return &set->pictures[i];
    return NULL;
}

bool true_set_file(char path[FILE_PATH], const struct true_set *set, const char *kind, const char *name)
{
    const bool hdr = !strcmp(kind, "hdr"), depth = !strcmp(kind, "depth");
    int n = snprintf(path, FILE_PATH, "%s/%s/%s.exr", set->folder, kind, name);
    if (n > 0 && n < FILE_PATH && path_is_file(path)) return true;
    if ((!hdr && !depth) || !*set->where) return false;
    n = snprintf(path, FILE_PATH, "%s/%s%s.exr", set->folder, name, depth ? "-depth" : "");
    return n > 0 && n < FILE_PATH && path_is_file(path);
}

static bool plain_name(const char *name)
{
    const size_t length = strspn(name, "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-");
    return length && !name[length] && length <= 40;
}

enum status true_edits_find(struct true_edits *list, const char *truth, struct err *err)
{
    struct dirent **entries = NULL;
    *list = (struct true_edits){0};
    const int count = scandir(truth, &entries, NULL, alphasort);
    if (count < 0) return err_errno(err, "list", truth);
    for (int i = 0; i < count; i++) {
        const char *name = entries[i]->d_name;
        char path[FILE_PATH];
        if (!err->status && !strncmp(name, "edited-", 7) && !file_path(path, truth, name, "", err) &&
            path_is_folder(path)) {
            if (!plain_name(name + 7))
                list->others++;
            else if (!array_append(&list->names, (size_t)list->count, sizeof *list->names, "edits", err))
                snprintf(list->names[list->count++], sizeof *list->names, "%s", name + 7);
        }
        free(entries[i]);
    }
    free(entries);
    if (err->status) true_edits_release(list);
    return err->status;
}

void true_edits_release(struct true_edits *list)
{
    free(list->names);
    *list = (struct true_edits){0};
}
