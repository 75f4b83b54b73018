/* contents_effects.c - camera moves: paths, frames, videos. */
#include "stages/report/contents_parts.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common/base/scan.h"

static enum status read_frames(struct contents *c, struct effect_card *e, const char *folder, struct err *err)
{
    static const char *const NAMES[] = {"R", "G", "B"};
    char problem_text[NOTE_SIZE] = "";
    e->holes = malloc((size_t)e->path.frame_count * sizeof *e->holes);
    e->unfilled = malloc((size_t)e->path.frame_count * sizeof *e->unfilled);
    if (!e->holes || !e->unfilled)
        return err_nomem(err, "holes a frame", (size_t)e->path.frame_count * sizeof *e->holes);

    for (int i = 0; i < e->path.frame_count; i++) {
        struct exr_image im = {0};
        struct err problem = ERR_INIT;
        char path[PATH_SIZE];
        e->holes[i] = e->unfilled[i] = -1;
        snprintf(path, sizeof path, "%s/frames/%s.exr", folder, e->path.frames[i].camera.name);
        if (!path_is_file(path)) continue;
        if (!exr_read(&im, path, NAMES, i == 0 ? 3 : 0, &problem)) { /* attributes only, except for the first frame */
            e->frames_found++;
            e->holes[i] = share_from_text(exr_attribute(&im, "remodel:holes"));
            e->unfilled[i] = share_from_text(exr_attribute(&im, "remodel:unfilled"));
            if (i == 0) picture_from_exr(&e->poster, &im, 1, 720, &problem);
        }
        if (problem.status) snprintf(problem_text, sizeof problem_text, "%.*s", NOTE_SIZE - 1, problem.text);
        exr_image_release(&im);
    }
    if (problem_text[0] && contents_note(c, err, "A frame of %s cannot be read. %.800s", e->name, problem_text))
        return err->status;
    if (e->frames_found < e->path.frame_count)
        return contents_note(c, err, "%d of %d frames of %s are missing.", e->path.frame_count - e->frames_found,
                             e->path.frame_count, e->name);
    return ST_OK;
}

/* The first (end 0) or last frame (end 1): its attributes name the photograph and the misfit. */
static enum status read_pan_frame(struct contents *c, struct effect_card *e, const char *folder, int end,
                                  struct err *err)
{
    static const char *const NAMES[] = {"R", "G", "B"};
    struct exr_image im = {0};
    struct err problem = ERR_INIT;
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/pan_scan/frames/%s.exr", folder,
             e->path.frames[end ? e->path.frame_count - 1 : 0].camera.name);
    if (!exr_read(&im, path, NAMES, end ? 0 : 3, &problem)) {
        const char *view = exr_attribute(&im, "remodel:view"), *misfit = exr_attribute(&im, "remodel:misfit");
        if (view) snprintf(e->pan.view, sizeof e->pan.view, "%s", view);
        if (!misfit || !scan_double(misfit, &e->pan.misfit[end]) || !(e->pan.misfit[end] >= 0)) e->pan.misfit[end] = -1;
        if (!end) picture_from_exr(&e->pan.poster, &im, 1, 720, &problem);
    }
    exr_image_release(&im);
    if (problem.status) return contents_note(c, err, "A 2D frame of %s cannot be read. %.800s", e->name, problem.text);
    return ST_OK;
}

/* Made on request, so that its absence is not noted. */
static enum status read_pan(struct contents *c, struct effect_card *e, const char *folder, struct err *err)
{
    char path[PATH_SIZE];
    struct stat s;
    e->pan.misfit[0] = e->pan.misfit[1] = -1;
    snprintf(path, sizeof path, "%s/pan_scan/video.mp4", folder);
    if (stat(path, &s) || !S_ISREG(s.st_mode) || s.st_size == 0) return ST_OK;
    e->pan.video_bytes = s.st_size;
    if (!(e->pan.video = strdup(path))) return err_nomem(err, "a file name", strlen(path));
    return read_pan_frame(c, e, folder, 0, err) || read_pan_frame(c, e, folder, 1, err) ? err->status : ST_OK;
}

static enum status read_effect(struct contents *c, struct effect_card *e, const char *folder, struct err *err)
{
    char path[PATH_SIZE];
    struct err problem = ERR_INIT;
    struct stat s;

    snprintf(path, sizeof path, "%s/video.mp4", folder);
    if (stat(path, &s) || !S_ISREG(s.st_mode) || s.st_size == 0) {
        if (contents_note(c, err, "There is no video of %s yet.", e->name)) return err->status;
    } else {
        e->video_bytes = s.st_size;
        if (!(e->video = strdup(path))) return err_nomem(err, "a file name", strlen(path));
    }
    if (camera_path_read(&e->path, folder, NULL, &problem))
        return contents_note(c, err, "There is no camera path of %s. %s", e->name, problem.text);
    return read_frames(c, e, folder, err) || read_pan(c, e, folder, err) ? err->status : ST_OK;
}

/* The effects of a move share its valid viewpoints. */
static enum status find_validity(struct effect_card *e, const char *folder, struct err *err)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/parallax/%.*s/validity.png", folder, (int)strcspn(e->name, "+"), e->name);
    if (!path_is_file(path)) return ST_OK;
    return (e->validity = strdup(path)) ? ST_OK : err_nomem(err, "a file name", strlen(path));
}

/* False for the folder of a move that holds only the valid viewpoints that its effects share. */
static bool is_effect_folder(const char *folder)
{
    char path[PATH_SIZE], validity[PATH_SIZE];
    snprintf(path, sizeof path, "%s/path.txt", folder);
    snprintf(validity, sizeof validity, "%s/validity.txt", folder);
    return path_is_folder(folder) && (path_is_file(path) || !path_is_file(validity));
}

enum status contents_read_effects(struct contents *c, const char *folder, struct err *err)
{
    struct dirent **names = NULL;
    char path[FILE_PATH];
    snprintf(path, sizeof path, "%s/parallax", folder);
    int count = scandir(path, &names, NULL, alphasort);
    enum status st = ST_OK;

    c->effects = calloc((size_t)(count > 0 ? count : 0) + 1, sizeof *c->effects);
    if (!c->effects) st = err_nomem(err, "effects", (size_t)count * sizeof *c->effects);
    for (int i = 0; i < count; i++) {
        snprintf(path, sizeof path, "%s/parallax/%s", folder, names[i]->d_name);
        if (!st && names[i]->d_name[0] != '.' && is_effect_folder(path)) {
            struct effect_card *e = &c->effects[c->effect_count++];
            snprintf(e->name, sizeof e->name, "%s", names[i]->d_name);
            st = read_effect(c, e, path, err);
            if (!st) st = find_validity(e, folder, err);
        }
        free(names[i]);
    }
    free(names);
    if (!st && !c->effect_count)
        st = contents_note(c, err, "No camera move has been planned yet, so there is no video.");
    return st;
}

void effect_card_release(struct effect_card *e)
{
    camera_path_release(&e->path);
    picture_release(&e->poster);
    picture_release(&e->pan.poster);
    free(e->video);
    free(e->pan.video);
    free(e->validity);
    free(e->holes);
    free(e->unfilled);
}
