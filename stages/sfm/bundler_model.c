/* bundler_model.c - a model in the format of Bundler, with the list of its images.
 *
 * The model is a *.out file that begins with "# Bundle file", bundle.out first, in the folder or in its folder bundle.
 * Bundler [Snavely 2006] knows images by their position in a list, and has no principal points: they are in the middle
 * of the photos, whose sizes come from the records. Images that are no photos of the scene keep their position with
 * size 0 x 0 and are left out.
 *
 * The list is list.txt, another *list*.txt, or a *.lst, as RealityCapture and others write it, in the folder or beside
 * the model. A line is the path of an image, on any system, in quotes or not; Bundler's own lines end in "0 FOCAL". As
 * paths may have blanks, and may end in numbers, the line as a whole is looked for among the photos first. */
#include "stages/sfm/bundler_model.h"

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"
#include "common/capture/photo_match.h"

/* Finds a file whose name ends with `suffix` and that `accept` accepts: the one called `first` if it exists, otherwise
 * the first by name. path stays "" if there is none. */
static enum status find_file(char path[FILE_PATH], const char *folder, const char *first,
                             bool (*accept)(const char *path), const char *suffix, struct err *err)
{
    struct dirent **names = NULL;
    const int count = scandir(folder, &names, NULL, alphasort);
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < count && !err->status && !*path; i++) {
            const char *name = names[i]->d_name;
            const size_t n = strlen(name), tail = strlen(suffix);
            if (n < tail || strcasecmp(name + n - tail, suffix) || (pass == 0) != !strcmp(name, first)) continue;
            if (!file_path(path, folder, name, "", err) && !accept(path)) *path = '\0';
        }
    for (int i = 0; i < count; i++) free(names[i]);
    free(names);
    return err->status;
}

static bool is_bundle(const char *path)
{
    static const char mark[] = "\xEF\xBB\xBF";
    char line[20] = "";
    FILE *fp = fopen(path, "re");
    const bool any = fp && fgets(line, sizeof line, fp);
    const char *text = strncmp(line, mark, strlen(mark)) ? line : line + strlen(mark);
    if (fp) fclose(fp);
    return any && !strncmp(text, "# Bundle file", 13);
}

static bool is_named_list(const char *path) { return strstr(path_file_name(path), "list"); }
static bool is_any(const char *path) { return path_is_file(path); }

static enum status find_list(char list[FILE_PATH], const char *folder, const char *inner, struct err *err)
{
    const char *const folders[] = {folder, inner};
    *list = '\0';
    for (int i = 0; !err->status && !*list && i < 2; i++) {
        find_file(list, folders[i], "list.txt", is_named_list, ".txt", err);
        if (!err->status && !*list) find_file(list, folders[i], "list.lst", is_any, ".lst", err);
    }
    return err->status;
}

struct image_names {
    char **names;
    int (*sizes)[2];
    int count, unknown;
};

static void image_names_release(struct image_names *n)
{
    for (int i = 0; i < n->count; i++) free(n->names[i]);
    free(n->names);
    free(n->sizes);
}

/* What is inside of the quotes, if the text is quoted; in place. */
static char *without_quotes(char *text)
{
    char *end = *text == '"' ? strrchr(text + 1, '"') : NULL;
    if (!end) return text;
    *end = '\0';
    return text + 1;
}

/* Cuts the last word off, if it is a number and not all of the text. */
static bool cut_number(char *text)
{
    char *last = text + strlen(text);
    double value;
    while (last > text && last[-1] != ' ' && last[-1] != '\t') last--;
    if (last == text || !scan_double(last, &value)) return false;
    while (last > text && (last[-1] == ' ' || last[-1] == '\t')) last--;
    *last = '\0';
    return last > text;
}

/* The photo that a line of the list names, -1 if none; *name: the name of the image, in the line. */
static int photo_of_line(char **name, char *line, const struct photo_list *photos)
{
    int photo = -1;
    do {
        *name = without_quotes(line);
        photo = photo_list_match(photos, *name);
    } while (photo < 0 && *name == line && cut_number(line));
    return photo;
}

static enum status add_name(struct image_names *n, char *line, const struct photo_list *photos, struct err *err)
{
    char *name = NULL;
    const int at = photo_of_line(&name, line, photos);
    if (at < 0 && *line == '#') return ST_OK; /* a comment */
    if (array_append(&n->names, (size_t)n->count, sizeof *n->names, "images", err) ||
        array_append(&n->sizes, (size_t)n->count, sizeof *n->sizes, "images", err))
        return err->status;
    n->sizes[n->count][0] = at < 0 ? 0 : photos->photos[at].info.width;
    n->sizes[n->count][1] = at < 0 ? 0 : photos->photos[at].info.height;
    n->unknown += at < 0;
    n->names[n->count] = strdup(name);
    return n->names[n->count++] ? ST_OK : err_nomem(err, "a name", strlen(name) + 1);
}

static enum status read_list(struct image_names *n, const char *path, const struct photo_list *photos, struct err *err)
{
    struct textfile t = {0};
    char *line = NULL;
    textfile_open(&t, path, err);
    while (!err->status && textfile_next_raw(&t))
        if (textfile_more(&t) && !textfile_rest(&t, "name of an image", &line, err)) add_name(n, line, photos, err);
    textfile_release(&t);
    if (!err->status && n->count && n->count == n->unknown)
        err_set(err, ST_DATA,
                "none of the %d images in %s (\"%s\", ...) is a photo of the scene (\"%s\", ...); use the model of "
                "these photos.",
                n->count, path, n->names[0], photos->count ? photos->photos[0].file : "");
    if (!err->status && n->unknown)
        log_note("%d images of the model are not photos of the scene and are left out", n->unknown);
    return err->status;
}

enum status bundler_model_read(struct sfm_model *m, bool *found, const char *folder, const struct photo_list *photos,
                               struct provenance *prov, struct err *err)
{
    struct image_names n = {0};
    char inner[FILE_PATH], bundle[FILE_PATH] = "", list[FILE_PATH] = "";
    *m = (struct sfm_model){0};
    *found = false;
    if (file_path(inner, folder, "bundle", "", err) || find_file(bundle, folder, "bundle.out", is_bundle, ".out", err))
        return err->status;
    if (!*bundle && find_file(bundle, inner, "bundle.out", is_bundle, ".out", err)) return err->status;
    *found = *bundle;
    if (!*found || find_list(list, folder, inner, err)) return err->status;
    if (!*list)
        return err_set(err, ST_DATA,
                       "%s has no list of its images; put the list that was written with it, list.txt or a file .lst, "
                       "into %s.",
                       bundle, folder);
    if ((!prov || (!provenance_add_file(prov, "model/bundle.out", bundle, err) &&
                   !provenance_add_file(prov, "model/list.txt", list, err))) &&
        !read_list(&n, list, photos, err))
        sfm_model_read_bundler(m, bundle, (const char *const *)n.names, (const int(*)[2])n.sizes, n.count, err);
    image_names_release(&n);
    return err->status;
}
