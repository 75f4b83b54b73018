/* user_model.c - models that the user already has: COLMAP text or binary, Bundler.
 *
 * What is looked for, in this order: a COLMAP model in the folder; COLMAP models in its subfolders 0, 1, ... until
 * one is missing; a Bundler file (any *.out that begins with "# Bundle file", bundle.out first) in the folder or in
 * bundle/.
 *
 * COLMAP. Text is read; a binary model is converted by COLMAP itself, because its format belongs to it. A model
 * without points is completed: points3D.txt may be missing, and points are triangulated from the photos with the
 * given cameras (triangulate.c).
 *
 * Bundler [Snavely 2006] knows images by their position in list.txt, and has no principal points: they are in the
 * middle of the photos, whose sizes come from the records. Images that are no photos of the scene keep their
 * position with size 0 x 0 and are left out.
 *
 * All models end as COLMAP text in one form (sfm_folder.c), so that no later stage knows where a model came from.
 * The hashes of the files that were read go into the provenance. */
#include "stages/sfm/user_model.h"

#include <dirent.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/array.h"
#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/base/textfile.h"
#include "common/capture/photo_match.h"
#include "stages/sfm/triangulate.h"

static bool has_file(const char *folder, const char *file)
{
    struct err ignored = ERR_INIT;
    char *path = sfm_text_format(&ignored, "%s/%s", folder, file);
    bool exists = path && !access(path, F_OK);
    free(path);
    return exists;
}

static bool is_text(const char *folder) { return has_file(folder, "cameras.txt") && has_file(folder, "images.txt"); }
static bool is_binary(const char *folder) { return has_file(folder, "cameras.bin") && has_file(folder, "images.bin"); }

/* Adds the hashes of the files that exist. */
static enum status add_inputs(struct provenance *prov, const char *folder, const char *const files[], int model,
                              struct err *err)
{
    for (int i = 0; !err->status && files[i]; i++) {
        if (!has_file(folder, files[i])) continue;
        char *path = sfm_text_format(err, "%s/%s", folder, files[i]);
        char *name = sfm_text_format(err, "model/%d/%s", model, files[i]);
        if (path && name) provenance_add_file(prov, name, path, err);
        free(path);
        free(name);
    }
    return err->status;
}

static enum status copy_file(const char *from_folder, const char *to_folder, const char *file, struct err *err)
{
    struct textfile t = {0};
    struct outfile out = {0};
    char *from = sfm_text_format(err, "%s/%s", from_folder, file), *to = sfm_text_format(err, "%s/%s", to_folder, file);
    if (from && to && !textfile_open(&t, from, err) && !outfile_open(&out, to, err)) {
        fwrite(t.bytes, 1, t.size, out.fp);
        outfile_commit(&out, err);
    }
    outfile_discard(&out);
    textfile_release(&t);
    free(from);
    free(to);
    return err->status;
}

/* A model without points may lack points3D.txt: copies the two other files beside an empty one and reads these. */
static enum status read_without_points(struct sfm_model *m, const struct sfm_folder *f, const char *folder,
                                       struct err *err)
{
    struct outfile empty = {0};
    char *copy = sfm_text_format(err, "%s/without-points", f->work);
    char *points = sfm_text_format(err, "%s/without-points/points3D.txt", f->work);
    if (copy && points && !outfile_open(&empty, points, err) && !outfile_commit(&empty, err) &&
        !copy_file(folder, copy, "cameras.txt", err) && !copy_file(folder, copy, "images.txt", err))
        sfm_model_read_text(m, copy, NULL, err);
    outfile_discard(&empty);
    free(copy);
    free(points);
    return err->status;
}

static enum status add_text(struct sfm_folder *f, const char *folder, const struct sfm_input *in,
                            const struct provenance *prov, struct err *err)
{
    struct sfm_model m = {0};
    if (has_file(folder, "points3D.txt"))
        sfm_model_read_text(&m, folder, NULL, err);
    else
        read_without_points(&m, f, folder, err);
    if (!err->status) log_note("model %d: %d images, %d points", f->models, m.image_count, m.point_count);
    if (!err->status && !m.point_count) triangulate(&m, f, in, err);
    if (!err->status) sfm_folder_add(f, &m, prov, err);
    sfm_model_release(&m);
    return err->status;
}

static enum status add_binary(struct sfm_folder *f, const char *folder, const struct sfm_input *in,
                              const struct provenance *prov, struct err *err)
{
    char *text = sfm_text_format(err, "%s/text/%d", f->work, f->models),
         *log = sfm_text_format(err, "%s/colmap.log", f->work);
    const char *args[] = {"model_converter", "--input_path", folder, "--output_path", text,
                          "--output_type",   "TXT",          NULL};
    int code = 0;
    if (text && log && !outfile_make_folders(text, err)) colmap_exit_status(&code, log, args, err);
    if (!err->status && code)
        err_set(err, ST_DATA, "colmap could not read the binary model in %s (exit status %d); its log is %s.", folder,
                code, log);
    if (!err->status) add_text(f, text, in, prov, err);
    free(text);
    free(log);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------- Bundler */

/* Finds a file whose name ends with `suffix` and that `accept` accepts: the one called `first` if it exists, otherwise
 * the first by name. *path stays NULL if there is none. */
static enum status find_file(char **path, const char *folder, const char *first, bool (*accept)(const char *path),
                             const char *suffix, struct err *err)
{
    struct dirent **names = NULL;
    int count = scandir(folder, &names, NULL, alphasort);
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < count && !err->status && !*path; i++) {
            const char *name = names[i]->d_name;
            size_t n = strlen(name), tail = strlen(suffix);
            if (n < tail || strcmp(name + n - tail, suffix) || (pass == 0) != !strcmp(name, first)) continue;
            char *p = sfm_text_format(err, "%s/%s", folder, name);
            if (p && accept(p))
                *path = p;
            else
                free(p);
        }
    for (int i = 0; i < count; i++) free(names[i]);
    free(names);
    return err->status;
}

static bool is_bundle(const char *path)
{
    char line[16] = "";
    FILE *fp = fopen(path, "re");
    bool is = fp && fgets(line, sizeof line, fp) && !strncmp(line, "# Bundle file", 13);
    if (fp) fclose(fp);
    return is;
}

static bool is_list(const char *path)
{
    const char *slash = strrchr(path, '/');
    return strstr(slash ? slash : path, "list");
}

struct image_names {
    char **names;
    int (*sizes)[2];
    int count;
};

static void image_names_release(struct image_names *n)
{
    for (int i = 0; i < n->count; i++) free(n->names[i]);
    free(n->names);
    free(n->sizes);
}

/* One image per line: its name, possibly followed by numbers. Sizes are the photos'; 0 x 0 for images that are not
 * photos of the scene. */
static enum status read_list(struct image_names *n, const char *path, const struct photo_list *photos, struct err *err)
{
    struct textfile t = {0};
    int unknown = 0;
    textfile_open(&t, path, err);
    while (!err->status && textfile_next(&t)) {
        char *name = NULL;
        if (textfile_word(&t, "name of an image", &name, err) ||
            array_append(&n->names, (size_t)n->count, sizeof *n->names, "images", err) ||
            array_append(&n->sizes, (size_t)n->count, sizeof *n->sizes, "images", err))
            break;
        int at = photo_list_match(photos, name), *size = n->sizes[n->count];
        size[0] = at < 0 ? 0 : photos->photos[at].info.width;
        size[1] = at < 0 ? 0 : photos->photos[at].info.height;
        unknown += at < 0;
        n->names[n->count] = strdup(name);
        if (!n->names[n->count++]) err_nomem(err, "a name", strlen(name) + 1);
    }
    textfile_release(&t);
    if (!err->status && n->count == unknown)
        err_set(err, ST_DATA, "none of the %d images in %s is a photo of the scene; use the model of these photos.",
                n->count, path);
    if (!err->status && unknown)
        log_note("%d images of the model are not photos of the scene and are left out", unknown);
    return err->status;
}

static enum status add_bundler(struct sfm_folder *f, const char *bundle, const char *list,
                               const struct photo_list *photos, const struct provenance *prov, struct err *err)
{
    struct image_names n = {0};
    struct sfm_model m = {0};
    if (!read_list(&n, list, photos, err) &&
        !sfm_model_read_bundler(&m, bundle, (const char *const *)n.names, (const int(*)[2])n.sizes, n.count, err)) {
        log_note("Bundler model: %d images, %d points", m.image_count, m.point_count);
        sfm_folder_add(f, &m, prov, err);
    }
    sfm_model_release(&m);
    image_names_release(&n);
    return err->status;
}

/* *found: whether a Bundler file exists. */
static enum status try_bundler(struct sfm_folder *f, const char *from, const struct photo_list *photos, bool *found,
                               struct provenance *prov, struct err *err)
{
    char *inner = sfm_text_format(err, "%s/bundle", from), *bundle = NULL, *list = NULL;
    if (inner) find_file(&bundle, from, "bundle.out", is_bundle, ".out", err);
    if (!err->status && !bundle) find_file(&bundle, inner, "bundle.out", is_bundle, ".out", err);
    *found = bundle;
    if (!err->status && bundle) find_file(&list, from, "list.txt", is_list, ".txt", err);
    if (!err->status && bundle && !list)
        err_set(err, ST_DATA, "%s has no list of its images; put Bundler's list.txt into %s.", bundle, from);
    if (!err->status && bundle && !provenance_add_file(prov, "model/bundle.out", bundle, err) &&
        !provenance_add_file(prov, "model/list.txt", list, err))
        add_bundler(f, bundle, list, photos, prov, err);
    free(inner);
    free(bundle);
    free(list);
    return err->status;
}

/* -------------------------------------------------------------------------------------------------------------- all */

/* *found: whether the folder contains a COLMAP model. */
static enum status try_colmap(struct sfm_folder *f, const char *folder, const struct sfm_input *in, bool *found,
                              struct provenance *prov, struct err *err)
{
    static const char *const text[] = {"cameras.txt", "images.txt", "points3D.txt", NULL};
    static const char *const binary[] = {"cameras.bin", "images.bin", "points3D.bin", NULL};
    bool as_text = is_text(folder), as_binary = !as_text && is_binary(folder);
    *found = as_text || as_binary;
    if (*found) add_inputs(prov, folder, as_text ? text : binary, f->models, err);
    if (!err->status && as_text) add_text(f, folder, in, prov, err);
    if (!err->status && as_binary) add_binary(f, folder, in, prov, err);
    return err->status;
}

enum status user_model_add(struct sfm_folder *f, const char *from, const struct sfm_input *in, struct provenance *prov,
                           struct err *err)
{
    bool found = false, next = true;
    if (access(from, R_OK | X_OK)) return err_errno(err, "open", from);
    f->given = "model";
    try_colmap(f, from, in, &found, prov, err);
    for (int k = 0; !err->status && !found && next; k++) {
        char *folder = sfm_text_format(err, "%s/%d", from, k);
        if (folder) try_colmap(f, folder, in, &next, prov, err);
        free(folder);
    }
    if (!err->status && !f->models) try_bundler(f, from, in->list, &found, prov, err);
    if (!err->status && !f->models)
        err_set(err, ST_DATA,
                "%s contains no structure-from-motion model; wanted COLMAP's cameras, images and points3D (.txt or "
                ".bin), in it or in its subfolders 0, 1, ..., or a Bundler file (.out, beginning with \"# Bundle "
                "file\") with its list.txt.",
                from);
    return err->status;
}
