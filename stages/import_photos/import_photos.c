/* import_photos.c - checks the photographs of a folder, gives them ids, groups exposures of one view.
 *
 * reads   --photos DIR   photos of any kind (common/image/photo_kind.h), clips, exposures.txt; nothing is written
 *         --photos CLIP  a clip; several clips: the option several times
 *         --like DIR     records of a scene: the photos are its lighting reference images, on its scale
 *         --split CxR    each photo contains C x R pictures of a multi-lens camera; these become the photos
 *         --scene DIR    brackets.txt and exposures.txt, if they exist
 * writes  --out DIR      ID.txt, one record per photo (content hash, size, EXIF); then list.txt; then photos.mk
 *                        for brackets: members/ID.txt, one record per photo; ID.txt, one record per view, and
 *                        brackets.txt; then list.txt and photos.mk with the views
 *         --frames DIR   CLIP_fN.png, frames of the clips, and links to the photos; then frames.txt. Without clips
 *                        these are removed
 *         --depth DIR    ID.pfm and depth.txt, of a lone HEIC or AVIF that carries its depth; otherwise removed
 *         --cuts DIR     with --split: ID_cXrY.png, the pictures; then split.txt
 *
 * Each file is rewritten only if its text changes, so that Make sees which photos changed. All photos that cannot be
 * used are reported, with the reason, before the stage fails. */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/cli.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "stages/import_photos/bracket_views.h"
#include "stages/import_photos/clip_frames.h"
#include "stages/import_photos/panorama.h"
#include "stages/import_photos/portrait_depth.h"
#include "stages/import_photos/split_photos.h"

/* The stage never writes to the user's folder. */
static enum status check_out(const char *photos, const char *option, const char *out, struct err *err)
{
    struct stat a, b;
    if (!out || stat(photos, &a) || stat(out, &b) || a.st_dev != b.st_dev || a.st_ino != b.st_ino) return ST_OK;
    return err_set(err, ST_USAGE, "%s %s is the folder of photos itself; give another folder.", option, out);
}

static bool exists(const char *folder, const char *name)
{
    char *path = NULL;
    bool found = asprintf(&path, "%s/%s", folder, name) >= 0 && !access(path, F_OK);
    free(path);
    return found;
}

/* Names of photos or views to leave out; used[i]: names[i] matched one. */
struct exclusion {
    const struct cli_list *names;
    bool *used;
};

static void exclude_photos(struct photo_scan *scan, struct exclusion *out)
{
    for (int i = 0; i < out->names->count; i++) out->used[i] |= photo_scan_exclude(scan, out->names->items[i]) > 0;
}

static void report_unused(const struct photo_scan *scan, const struct exclusion *out)
{
    for (int i = 0; i < out->names->count; i++)
        if (!out->used[i])
            log_warn("no photo in %s is called %s; nothing is left out for this name.", scan->folder,
                     out->names->items[i]);
}

static void report_scan(const struct photo_scan *scan)
{
    for (int i = 0; i < scan->clip_count; i++) err_report(&scan->clips[i].err);
    for (int i = 0; i < scan->count; i++) err_report(&scan->photos[i].err);
    left_out_report(&scan->left, scan->folder);
}

/* Cuts the pictures out of the photos into `cuts`. */
static enum status cut(const char *photos, const char *split, const char *cuts, struct exclusion *leave,
                       const struct photo_params *params, struct err *err)
{
    struct photo_scan scan = {0};
    struct split_grid grid;
    if (!split_grid_parse(&grid, split, params, err)) photo_scan_folder(&scan, photos, err);
    if (!err->status) {
        exclude_photos(&scan, leave);
        if (exists(photos, "exposures.txt"))
            log_warn("%s/exposures.txt is not read because its photos are cut; write the pictures' exposures into the "
                     "scene's exposures.txt.",
                     photos);
        split_photos(&scan, &grid, cuts, err);
        report_scan(&scan);
    }
    photo_scan_release(&scan);
    return err->status;
}

/* The colour spaces that came in, but for sRGB. */
static void report_colours(const struct photo_scan *scan)
{
    for (int i = 0; i < scan->count; i++) {
        const struct scanned_photo *p = &scan->photos[i];
        int before = 0, count = 0;
        if (p->excluded || p->err.status || !*p->record.info.colour) continue;
        for (int k = 0; k < scan->count; k++) {
            const struct scanned_photo *q = &scan->photos[k];
            const bool same = !q->excluded && !q->err.status && !strcmp(p->record.info.colour, q->record.info.colour);
            before += same && k < i;
            count += same;
        }
        if (before) continue;
        if (count == 1)
            log_note("%s: its colours are in %s; they become linear Rec.709.", p->file, p->record.info.colour);
        else
            log_note("%s and %d more photos: their colours are in %s; they become linear Rec.709.", p->file, count - 1,
                     p->record.info.colour);
    }
}

/* How many photos came in with the light of their gain maps. */
static void report_gain_maps(const struct photo_scan *scan)
{
    int used = 0, count = 0;
    for (int i = 0; i < scan->count; i++) {
        const struct scanned_photo *p = &scan->photos[i];
        if (p->excluded || p->err.status || p->kind != PHOTO_KIND_JPEG) continue;
        count++;
        used += p->record.info.bits == 32;
    }
    if (!scan->gain_maps) return;
    if (used)
        log_note("%d of %d JPEGs have gain maps, which are applied: white is 1, and lights are brighter.", used, count);
    else
        log_warn("[import_photos] gain_map is yes, but none of the photos in %s has a gain map.", scan->folder);
}

/* What photos hold that is not used. */
static void report_unused_parts(const struct photo_scan *scan)
{
    for (int i = 0; i < scan->count; i++) {
        const struct scanned_photo *p = &scan->photos[i];
        if (p->excluded || p->err.status) continue;
        if (p->pages)
            log_warn("%s/%s has %d pages, and only the first is used; save each photo as a file of its own.",
                     scan->folder, p->file, p->pages);
        if (p->transparent > 1e-4)
            log_warn("%s/%s: %.2g %% of its pixels are transparent, but are used like the others; to leave them out, "
                     "draw them black in masks/%s.png in the scene's folder.",
                     scan->folder, p->file, 100 * p->transparent, p->id);
    }
}

/* Gives the views the white exposure of the scene whose records are in `folder`, so that both have one scale. */
static enum status share_white(struct bracket_views *views, const char *folder, struct err *err)
{
    struct photo_list scene = {0};
    photo_list_read(&scene, folder, err);
    const double white = err->status || !scene.count ? 0 : scene.photos[0].white; /* all photos have the same */
    if (!err->status && views->untimed)
        err_set(
            err, ST_DATA,
            "the exposures of the lighting reference images are unknown, so their light cannot be compared with the "
            "scene's; write lines \"FILE SECONDS F_NUMBER ISO\" into exposures.txt in their folder.");
    if (!err->status && !(white > 0))
        log_warn("the scene's photos are not bracketed and have no common scale; the lighting reference images get a "
                 "scale of "
                 "their own ([import_photos] brackets = single brings photos of known exposure to one scale).");
    if (!err->status && white > 0) views->white = white;
    photo_list_release(&scene);
    return err->status;
}

/* Photos with the same bytes as another one are left out, but not those of a bracket: its exposures may be equal. */
static enum status find_views(struct bracket_views *views, struct photo_scan *scan, const char *scene, const char *like,
                              struct exclusion *leave, const struct photo_params *params, struct err *err)
{
    bool several = false, dropped = false;
    bracket_views_find(views, scan, scene, params, leave->names->items, leave->names->count, leave->used, err);
    for (int i = 0; i < views->count; i++) several |= views->views[i].count > 1;
    if (err->status || like || several || photo_scan_drop_same(scan, &dropped, err) || !dropped) return err->status;
    bracket_views_release(views);
    return bracket_views_find(views, scan, scene, params, leave->names->items, leave->names->count, leave->used, err);
}

/* The records of bracketed photos are in `members`, even if they cannot be grouped or one is unusable: the views'
 * records stay untouched until everything is valid. */
static enum status import(struct photo_scan *scan, const char *scene, const char *like, struct exclusion *leave,
                          const char *out, const struct photo_params *params, struct err *err)
{
    struct bracket_views views = {0};
    char *members = NULL;
    bool bad = photo_scan_bad(scan) > 0;
    struct err failed = ERR_INIT; /* of the members, whose records are written whether they can be grouped or not */
    if (asprintf(&members, "%s/members", out) < 0) return err_nomem(err, "a path", 0);
    if (!bad) find_views(&views, scan, scene, like, leave, params, err);
    if (!bad && !err->status && like) share_white(&views, like, err);
    bool bracketed = err->status || views.bracketed || (bad && exists(out, "brackets.txt"));
    report_unused(scan, leave);
    report_colours(scan);
    report_gain_maps(scan);
    report_unused_parts(scan);
    if (!bracketed && !bad && !like && !err->status) bracket_views_take_exposures(scan, scene, err);
    if (!bracketed)
        photo_scan_write(scan, out, err);
    else if (photo_scan_write_records(scan, members, &failed))
        err_set(err, failed.status, "%s", failed.text);
    else if (!err->status)
        bracket_views_write(&views, scan, out, err);
    bracket_views_release(&views);
    free(members);
    return err->status;
}

/* What --photos gives: one folder, or clips. */
static enum status scan_sources(struct photo_scan *scan, const struct cli_list *photos, struct err *err)
{
    const char *first = photos->items[0];
    return photos->count == 1 && (path_is_folder(first) || !path_is_file(first))
               ? photo_scan_folder(scan, first, err)
               : photo_scan_clips(scan, photos->items, photos->count, err);
}

/* Takes the frames of the clips, if there are any: *folder becomes `frames`. */
static enum status take_frames(const char **folder, const struct cli_list *photos, const char *frames,
                               struct exclusion *leave, const struct photo_params *params, struct err *err)
{
    struct photo_scan scan = {0};
    int clips = 0;
    scan_sources(&scan, photos, err);
    if (!err->status) exclude_photos(&scan, leave);
    for (int i = 0; i < scan.clip_count; i++) clips += !scan.clips[i].excluded;
    if (!err->status && !frames && !scan.folder)
        err_set(err, ST_USAGE, "--photos %s is a clip and needs --frames, a folder for its frames.", photos->items[0]);
    const bool cut = !err->status && frames && scan.folder && panorama_find(&scan, params);
    if (!err->status && frames && (clips || cut || !scan.folder)) {
        clip_frames_make(&scan, frames, params, err);
        *folder = frames;
        report_scan(&scan);
    } else if (!err->status && frames) {
        clip_frames_remove(frames, err);
    }
    photo_scan_release(&scan);
    return err->status;
}

/* Clips of a folder whose clips are not used. */
static enum status leave_clips_out(struct photo_scan *scan, struct err *err)
{
    for (int i = 0; !err->status && i < scan->clip_count; i++)
        if (!scan->clips[i].excluded) left_out_add(&scan->left, path_file_name(scan->clips[i].path), LEFT_CLIP, err);
    left_out_sort(&scan->left);
    return err->status;
}

/* A lone portrait brings its depth with it. */
static enum status take_depth(struct photo_scan *scan, const char *out, struct err *err)
{
    const struct scanned_photo *only = NULL;
    bool taken = false;
    char path[FILE_PATH];
    for (int i = 0; i < scan->count; i++)
        if (!scan->photos[i].excluded) only = &scan->photos[i];
    if (only && photo_scan_used(scan) == 1 && !only->err.status && only->kind == PHOTO_KIND_HEIF && !scan->single &&
        !file_path(path, scan->folder, only->file, "", err))
        portrait_depth_take(&taken, path, only->id, out, err);
    if (!err->status) portrait_depth_remove(taken ? only->id : NULL, out, err);
    if (!err->status && taken) log_note("%s carries its depth, from which a film is made", only->file);
    scan->single |= taken;
    return err->status;
}

/* Where the stage reads and writes. */
struct places {
    const struct cli_list *photos;
    const char *scene, *like, *split, *cuts, *frames, *depth, *out;
    bool single;
};

static enum status run(struct photo_scan *scan, const struct places *p, const struct cli_list *exclude,
                       const struct photo_params *params, struct err *err)
{
    const char *folder = p->photos->items[0];
    struct exclusion left = {exclude, calloc((size_t)exclude->count + 1, sizeof(bool))};
    if (!left.used) err_nomem(err, "names", (size_t)exclude->count);
    if (!err->status && !p->split != !p->cuts)
        err_set(err, ST_USAGE,
                "--split and --cuts go together: the number of pictures in a photo, and the folder for them.");
    if (!err->status && !check_out(folder, "--out", p->out, err) && !check_out(folder, "--cuts", p->cuts, err))
        check_out(folder, "--frames", p->frames, err);
    if (!err->status) take_frames(&folder, p->photos, p->frames, &left, params, err);
    const bool framed = folder == p->frames;
    if (!err->status && p->split) cut(folder, p->split, p->cuts, &left, params, err);
    if (!err->status) photo_scan_folder(scan, p->split ? p->cuts : folder, err);
    scan->cut = p->split;
    scan->references = p->like;
    scan->single = p->single;
    scan->gain_maps = !strcmp(params->gain_map, "yes");
    if (!err->status) {
        exclude_photos(scan, &left);
        if (!framed) leave_clips_out(scan, err);
        if (!err->status && !photo_scan_check(scan, p->out, err) && !(p->depth && take_depth(scan, p->depth, err)))
            import(scan, p->scene, p->like, &left, p->out, params, err);
    }
    report_scan(scan);
    free(left.used);
    return err->status;
}

int main(int argc, char **argv)
{
    struct cli_list photos = {0}, exclude = {0};
    struct places at = {.photos = &photos};
    struct photo_params params = PHOTO_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Checks the photographs of a folder, gives them ids and records their properties."),
        CLI_LIST("photos", &photos, CLI_REQUIRED,
                 "folder of photos (JPEG, PNG, TIFF, HEIC, AVIF, WebP, JPEG XL, EXR, raw) and clips (MP4, QuickTime, "
                 "Matroska, AVI), without its subfolders; or clips, each with the option"),
        CLI_STR("scene", &at.scene, CLI_OPTIONAL, "folder that may contain brackets.txt and exposures.txt"),
        CLI_STR("like", &at.like, CLI_OPTIONAL,
                "folder of a scene's records: the photos become its lighting reference images, on its scale"),
        CLI_LIST("exclude", &exclude, CLI_OPTIONAL,
                 "photo or view to leave out: file name, with or without extension, or id"),
        CLI_STR("split", &at.split, CLI_OPTIONAL,
                "CxR: each photo contains C columns and R rows of pictures of a multi-lens camera, which become the "
                "photos"),
        CLI_STR("cuts", &at.cuts, CLI_OPTIONAL, "folder to write these pictures to"),
        CLI_STR("frames", &at.frames, CLI_OPTIONAL, "folder to write frames of clips to"),
        CLI_STR("depth", &at.depth, CLI_OPTIONAL,
                "folder to write the depth to that the only photo, a portrait, carries"),
        CLI_FLAG("single", &at.single, "one photo is enough: its depth is given"),
        CLI_STR("out", &at.out, CLI_REQUIRED, "folder to write the records to"),
        CLI_PARAMS(photo_param_table, &params, photo_params_check),
        CLI_END,
    };
    struct provenance prov = {0};
    struct photo_scan scan = {0};
    struct err err = ERR_INIT;

    switch (cli_parse(argc, argv, "import_photos", opts, &prov, &err)) {
    case CLI_RUN:
        run(&scan, &at, &exclude, &params, &err);
        err_report(&err);
        break;
    case CLI_DONE:
        break;
    case CLI_FAILED:
        err_report(&err);
        break;
    }
    photo_scan_release(&scan);
    cli_list_release(&photos);
    cli_list_release(&exclude);
    provenance_release(&prov);
    return err_exit_code(&err);
}
