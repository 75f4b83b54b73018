/* import_photos.c - checks the photographs of a folder, gives them ids, finds which are exposures of one view.
 *
 * reads   --photos DIR   JPEG, PNG, TIFF, EXR, raw files straight in it, exposures.txt; nothing in there is written
 *         --like DIR     records of a scene: these are its lighting reference images, on its scale
 *         --split CxR    each of them holds C x R pictures of a multi-lens camera, which are the photos
 *         --scene DIR    brackets.txt, exposures.txt if they are there
 * writes  --out DIR      ID.txt, a record a photo (content hash, size, EXIF); then list.txt; then photos.mk
 *                        where photos are brackets: members/ID.txt, a record a photo; ID.txt, a record a view, and
 *                        brackets.txt; then list.txt and photos.mk with the views
 *         --cuts DIR     with --split: ID_cXrY.png, the pictures; then split.txt
 *
 * Each file is rewritten only if its text changes, so that Make sees which photos did. A photo that cannot be used is
 * named with the reason, and so are all others like it, before the stage fails. */
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/cli.h"
#include "common/base/log.h"
#include "stages/import_photos/bracket_views.h"
#include "stages/import_photos/split_photos.h"

/* The user's folder is never written to. */
static enum status check_out(const char *photos, const char *option, const char *out, struct err *err)
{
    struct stat a, b;
    if (!out || stat(photos, &a) || stat(out, &b) || a.st_dev != b.st_dev || a.st_ino != b.st_ino) return ST_OK;
    return err_set(err, ST_USAGE, "%s %s is the folder of photos itself; name another one.", option, out);
}

static bool is_there(const char *folder, const char *name)
{
    char *path = NULL;
    bool there = asprintf(&path, "%s/%s", folder, name) >= 0 && !access(path, F_OK);
    free(path);
    return there;
}

/* Photos, and then views that are exposures of them, by the names that are to be left out. */
struct left_out {
    const struct cli_list *names;
    bool *used;
};

static void leave_out(struct photo_scan *scan, struct left_out *out)
{
    for (int i = 0; i < out->names->count; i++) out->used[i] |= photo_scan_exclude(scan, out->names->items[i]) > 0;
}

static void report_left_out(const struct photo_scan *scan, const struct left_out *out)
{
    for (int i = 0; i < out->names->count; i++)
        if (!out->used[i])
            log_warn("no photo in %s is called %s; nothing is left out for it.", scan->folder, out->names->items[i]);
}

static void report_scan(const struct photo_scan *scan)
{
    for (int i = 0; i < scan->count; i++) err_report(&scan->photos[i].err);
    if (scan->ignored) log_note("ignored in %s: %d that are no photos by their names", scan->folder, scan->ignored);
    if (scan->doubled)
        log_note("ignored in %s: %d raw files beside a JPEG of the same name; keep the raw files in a folder of their "
                 "own to "
                 "use them",
                 scan->folder, scan->doubled);
}

/* The pictures that the photos hold, cut out into `cuts`. */
static enum status cut(const char *photos, const char *split, const char *cuts, struct left_out *leave,
                       const struct import_params *params, struct err *err)
{
    struct photo_scan scan = {0};
    struct split_grid grid;
    enum status st = split_grid_parse(&grid, split, params, err);
    if (!st) st = photo_scan_folder(&scan, photos, err);
    if (!st) {
        leave_out(&scan, leave);
        if (is_there(photos, "exposures.txt"))
            log_warn("%s/exposures.txt is not read, for its photos are cut; write the pictures' exposures into that of "
                     "the scene.",
                     photos);
        st = split_photos(&scan, &grid, cuts, err);
        report_scan(&scan);
    }
    photo_scan_release(&scan);
    return st;
}

/* The exposure that makes 1 white in the scene whose records are in `folder`: the views' too, whatever their own
 * would be. */
static enum status share_white(struct bracket_views *views, const char *folder, struct err *err)
{
    struct photo_list scene = {0};
    enum status st = photo_list_read(&scene, folder, err);
    const double white = st || !scene.count ? 0 : scene.photos[0].white; /* all of them have one */
    if (!st && views->untimed)
        st = err_set(err, ST_DATA,
                     "no lighting reference image states its exposure, so that its light cannot be compared with the "
                     "scene's; write lines \"FILE SECONDS F_NUMBER ISO\" into exposures.txt in their folder.");
    if (!st && !(white > 0))
        log_warn(
            "the scene's photos are no bracketed exposures and have no common scale; the lighting reference images "
            "get one of their own ([import_photos] brackets = single brings photos of known exposure to one scale).");
    if (!st && white > 0) views->white = white;
    photo_list_release(&scene);
    return st;
}

/* Where photos are brackets their own records are in `members`, even when they cannot be grouped or one is bad: what
 * was known of the views stays untouched until all is well. */
static enum status import(struct photo_scan *scan, const char *scene, const char *like, struct left_out *leave,
                          const char *out, const struct import_params *params, struct err *err)
{
    struct bracket_views views = {0};
    char *members = NULL;
    bool bad = photo_scan_bad(scan) > 0;
    enum status st = ST_OK;
    if (asprintf(&members, "%s/members", out) < 0) return err_nomem(err, "a path", 0);
    if (!bad)
        st =
            bracket_views_find(&views, scan, scene, params, leave->names->items, leave->names->count, leave->used, err);
    if (!bad && !st && like) st = share_white(&views, like, err);
    bool bracketed = st || views.bracketed || (bad && is_there(out, "brackets.txt"));
    report_left_out(scan, leave);
    if (!bracketed)
        st = photo_scan_write(scan, out, err);
    else if (photo_scan_write_records(scan, members, err) || st)
        st = err->status;
    else
        st = bracket_views_write(&views, scan, out, err);
    bracket_views_release(&views);
    free(members);
    return st;
}

static enum status run(struct photo_scan *scan, const char *photos, const char *scene, const char *like,
                       const char *split, const char *cuts, const struct cli_list *exclude, const char *out,
                       const struct import_params *params, struct err *err)
{
    struct left_out left = {exclude, calloc((size_t)exclude->count + 1, sizeof(bool))};
    enum status st = left.used ? ST_OK : err_nomem(err, "names", (size_t)exclude->count);
    if (!st && !split != !cuts)
        st = err_set(err, ST_USAGE,
                     "--split and --cuts go together: how many pictures a photo holds, and where they go.");
    if (!st) st = check_out(photos, "--out", out, err);
    if (!st) st = check_out(photos, "--cuts", cuts, err);
    if (!st && split) st = cut(photos, split, cuts, &left, params, err);
    if (!st) st = photo_scan_folder(scan, split ? cuts : photos, err);
    scan->cut = split;
    scan->references = like;
    if (!st) leave_out(scan, &left);
    if (!st) st = photo_scan_check(scan, out, err);
    if (!st) st = import(scan, scene, like, &left, out, params, err);
    report_scan(scan);
    free(left.used);
    return st;
}

int main(int argc, char **argv)
{
    const char *photos = NULL, *scene = NULL, *like = NULL, *split = NULL, *cuts = NULL, *out = NULL;
    struct cli_list exclude = {0};
    struct import_params params = IMPORT_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("check the photographs of a folder, give them ids, record what they are"),
        CLI_STR("photos", &photos, CLI_REQUIRED,
                "folder of photos: JPEG, PNG, TIFF, EXR, raw; sub-folders are not looked into"),
        CLI_STR("scene", &scene, CLI_OPTIONAL, "folder that may hold brackets.txt and exposures.txt"),
        CLI_STR("like", &like, CLI_OPTIONAL,
                "folder of a scene's records: the photos are its lighting reference images, brought to its scale"),
        CLI_LIST("exclude", &exclude, CLI_OPTIONAL,
                 "photo to leave out: file name, with or without ending, or id; or a view"),
        CLI_STR("split", &split, CLI_OPTIONAL,
                "CxR: each photo holds C columns and R rows of pictures, of a multi-lens camera; these are the photos"),
        CLI_STR("cuts", &cuts, CLI_OPTIONAL, "folder to write these pictures into"),
        CLI_STR("out", &out, CLI_REQUIRED, "folder of records to write"),
        CLI_PARAMS(import_param_table, &params, import_params_check),
        CLI_END,
    };
    struct provenance prov = {0};
    struct photo_scan scan = {0};
    struct err err = ERR_INIT;

    switch (cli_parse(argc, argv, "import_photos", opts, &prov, &err)) {
    case CLI_RUN:
        run(&scan, photos, scene, like, split, cuts, &exclude, out, &params, &err);
        err_report(&err);
        break;
    case CLI_DONE:
        break;
    case CLI_FAILED:
        err_report(&err);
        break;
    }
    photo_scan_release(&scan);
    cli_list_release(&exclude);
    provenance_release(&prov);
    return err_exit_code(&err);
}
