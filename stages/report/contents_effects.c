/* contents_effects.c - camera moves: paths, frames, videos; films of walks through the rooms. */
#include "stages/report/contents_parts.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "stages/report/film_flicker.h"
#include "stages/report/passing.h"

enum { POSTER_HEIGHT = 540 };

/* film: "parallax/EFFECT" */
static enum status read_frames(struct contents *c, struct effect_card *e, const char *folder, const char *film,
                               struct err *err)
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
        const struct product_key key = {.film = film, .frame = e->path.frames[i].camera.name};
        char path[FILE_PATH];
        e->holes[i] = e->unfilled[i] = -1;
        if (!contents_product(path, folder, PRODUCT_FRAME, &key)) continue;
        if (!exr_read(&im, path, NAMES, i == 0 ? 3 : 0, &problem)) { /* attributes only, except for the first frame */
            e->frames_found++;
            e->holes[i] = share_from_text(exr_attribute(&im, "remodel:holes"));
            e->unfilled[i] = share_from_text(exr_attribute(&im, "remodel:unfilled"));
            if (i == 0) picture_from_exr(&e->poster, &im, 1, POSTER_HEIGHT, &problem);
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
static enum status read_pan_frame(struct contents *c, struct effect_card *e, const char *folder, const char *film,
                                  int end, struct err *err)
{
    static const char *const NAMES[] = {"R", "G", "B"};
    struct exr_image im = {0};
    struct err problem = ERR_INIT;
    const char *frame = e->path.frames[end ? e->path.frame_count - 1 : 0].camera.name;
    const struct product_key key = {.film = film, .frame = frame};
    char path[FILE_PATH];
    if (!product_path_below(path, folder, PRODUCT_PAN_SCAN_FRAME, &key, &problem) &&
        !exr_read(&im, path, NAMES, end ? 0 : 3, &problem)) {
        const char *view = exr_attribute(&im, "remodel:view"), *misfit = exr_attribute(&im, "remodel:misfit");
        if (view) snprintf(e->pan.view, sizeof e->pan.view, "%s", view);
        if (!misfit || !scan_double(misfit, &e->pan.misfit[end]) || !(e->pan.misfit[end] >= 0)) e->pan.misfit[end] = -1;
        if (!end) picture_from_exr(&e->pan.poster, &im, 1, POSTER_HEIGHT, &problem);
    }
    exr_image_release(&im);
    if (problem.status) return contents_note(c, err, "A 2D frame of %s cannot be read. %.800s", e->name, problem.text);
    return ST_OK;
}

/* *video stays NULL if there is none, or an empty one. */
static enum status find_video(char **video, long long *bytes, const char *folder, enum product_id id, const char *film,
                              struct err *err)
{
    char path[FILE_PATH];
    struct stat s;
    if (!contents_product(path, folder, id, &(struct product_key){.film = film})) return ST_OK;
    if (stat(path, &s) || s.st_size == 0) return ST_OK;
    *bytes = s.st_size;
    return (*video = strdup(path)) ? ST_OK : err_nomem(err, "a file name", strlen(path));
}

/* Adds a file "video-NAME.mp4" or ".mov"; others are left out. */
static enum status add_kind(struct effect_card *e, const char *folder, const char *film, const char *file,
                            struct err *err)
{
    struct film_kind kind = {.bytes = 0};
    char path[PATH_SIZE];
    struct stat s;
    const char *dot = strrchr(file, '.');
    const size_t length = dot ? (size_t)(dot - file) : 0;
    if (strncmp(file, "video-", 6) || !dot || (strcmp(dot, ".mp4") && strcmp(dot, ".mov")) ||
        length - 6 >= sizeof kind.name)
        return ST_OK;
    snprintf(path, sizeof path, "%s/%s/%s", folder, film, file);
    if (stat(path, &s) || !S_ISREG(s.st_mode) || s.st_size == 0) return ST_OK;
    memcpy(kind.name, file + 6, length - 6);
    kind.bytes = s.st_size;
    if (!(kind.file = strdup(path))) return err_nomem(err, "a file name", strlen(path));
    if (array_append(&e->kinds, (size_t)e->kind_count, sizeof *e->kinds, "films", err))
        free(kind.file);
    else
        e->kinds[e->kind_count++] = kind;
    return err->status;
}

static enum status read_kinds(struct effect_card *e, const char *folder, const char *film, struct err *err)
{
    struct dirent **names = NULL;
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", folder, film);
    const int count = scandir(path, &names, NULL, alphasort);
    if (count < 0 && errno != ENOENT && errno != ENOTDIR) err_errno(err, "list", path);
    for (int i = 0; i < count; i++) {
        if (!err->status) add_kind(e, folder, film, names[i]->d_name, err);
        free(names[i]);
    }
    free(names);
    return err->status;
}

/* Made on request, so that its absence is not noted. */
static enum status read_pan(struct contents *c, struct effect_card *e, const char *folder, const char *film,
                            struct err *err)
{
    e->pan.misfit[0] = e->pan.misfit[1] = -1;
    find_video(&e->pan.video, &e->pan.video_bytes, folder, PRODUCT_PAN_SCAN_VIDEO, film, err);
    if (err->status || !e->pan.video || read_pan_frame(c, e, folder, film, 0, err)) return err->status;
    return read_pan_frame(c, e, folder, film, 1, err);
}

static enum status read_effect(struct contents *c, struct effect_card *e, const char *folder, const char *film,
                               struct err *err)
{
    struct err problem = ERR_INIT;
    char path[PATH_SIZE];

    if (find_video(&e->video, &e->video_bytes, folder, PRODUCT_VIDEO, film, err) || read_kinds(e, folder, film, err))
        return err->status;
    if (!e->video && contents_note(c, err, "There is no video of %s yet.", e->name)) return err->status;
    snprintf(path, sizeof path, "%s/%s", folder, film);
    if (camera_path_read(&e->path, path, NULL, &problem))
        return contents_note(c, err, "There is no camera path of %s. %s", e->name, problem.text);
    if (read_frames(c, e, folder, film, err) ||
        film_flicker_measure(&e->flicker.middle, &e->flicker.high, &e->flicker.known, &e->path, folder, film, err))
        return err->status;
    return read_pan(c, e, folder, film, err);
}

/* The effects of a move share its valid viewpoints. */
static enum status find_validity(struct effect_card *e, const char *folder, struct err *err)
{
    char path[FILE_PATH], move[FILE_PATH];
    snprintf(move, sizeof move, "%.*s", (int)strcspn(e->name, "+"), e->name);
    if (!contents_product(path, folder, PRODUCT_VALIDITY_PICTURE, &(struct product_key){.move = move})) return ST_OK;
    return (e->validity = strdup(path)) ? ST_OK : err_nomem(err, "a file name", strlen(path));
}

/* False for the folder of a move that holds only the valid viewpoints that its effects share. */
static bool is_effect_folder(const char *folder, const char *film, const char *name)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", folder, film);
    return path_is_folder(path) &&
           (contents_product(path, folder, PRODUCT_PATH, &(struct product_key){.film = film}) ||
            !contents_product(path, folder, PRODUCT_VALIDITY, &(struct product_key){.move = name}));
}

enum status contents_read_effects(struct contents *c, const char *folder, struct err *err)
{
    struct dirent **names = NULL;
    char path[FILE_PATH], film[FILE_PATH];
    snprintf(path, sizeof path, "%s/parallax", folder);
    int count = scandir(path, &names, NULL, alphasort);
    if (count < 0 && errno != ENOENT && errno != ENOTDIR) err_errno(err, "list", path);

    c->effects = calloc((size_t)(count > 0 ? count : 0) + 1, sizeof *c->effects);
    if (!c->effects) err_nomem(err, "effects", (size_t)count * sizeof *c->effects);
    for (int i = 0; i < count; i++) {
        const char *name = names[i]->d_name;
        snprintf(film, sizeof film, "parallax/%s", name);
        if (!err->status && *name != '.' && is_effect_folder(folder, film, name)) {
            struct effect_card *e = &c->effects[c->effect_count++];
            snprintf(e->name, sizeof e->name, "%s", name);
            if (!read_effect(c, e, folder, film, err)) find_validity(e, folder, err);
        }
        free(names[i]);
    }
    free(names);
    if (!err->status && !c->effect_count)
        contents_note(c, err, "No camera move has been planned yet, so there is no video.");
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------ tours */

/* A relit walk follows the path of the same walk in the old light. */
static enum status measure_tour(struct flicker_card *f, const char *folder, const char *film, const char *change,
                                bool relit, struct err *err)
{
    struct camera_path walk = {0};
    struct err why = ERR_INIT;
    char path[PATH_SIZE];
    if (relit)
        snprintf(path, sizeof path, "%s/remodel/%s/tour", folder, change);
    else
        snprintf(path, sizeof path, "%s/%s", folder, film);
    if (camera_path_read(&walk, path, NULL, &why))
        passing_refuse(why.text, err);
    else
        film_flicker_measure(&f->middle, &f->high, &f->known, &walk, folder, film, err);
    camera_path_release(&walk);
    return err->status;
}

/* film: the folder of the tour below the scene's */
static enum status read_tour(struct contents *c, const char *folder, const char *film, const char *change, bool relit,
                             struct err *err)
{
    char path[PATH_SIZE];
    struct tour_card tour = {.relit = relit};
    snprintf(path, sizeof path, "%s/%s", folder, film);
    if (!path_is_folder(path) || find_video(&tour.video, &tour.bytes, folder, PRODUCT_VIDEO, film, err) || !tour.video)
        return err->status;
    snprintf(tour.change, sizeof tour.change, "%s", change);
    if (measure_tour(&tour.flicker, folder, film, change, relit, err)) {
        free(tour.video);
        return err->status;
    }
    if (array_append(&c->tours, (size_t)c->tour_count, sizeof *c->tours, "tours", err))
        free(tour.video);
    else
        c->tours[c->tour_count++] = tour;
    return err->status;
}

enum status contents_read_tours(struct contents *c, const char *folder, struct err *err)
{
    static const char *const below[] = {"remodel", "relight"};
    read_tour(c, folder, "model/tour", "", false, err);
    for (int k = 0; k < 2; k++) {
        struct dirent **names = NULL;
        char path[PATH_SIZE], film[FILE_PATH];
        snprintf(path, sizeof path, "%s/%s", folder, below[k]);
        const int count = scandir(path, &names, NULL, alphasort);
        if (count < 0 && errno != ENOENT && errno != ENOTDIR) err_errno(err, "list", path);
        for (int i = 0; i < count; i++) {
            snprintf(film, sizeof film, "%s/%s/tour", below[k], names[i]->d_name);
            if (!err->status && names[i]->d_name[0] != '.') read_tour(c, folder, film, names[i]->d_name, k == 1, err);
            free(names[i]);
        }
        free(names);
    }
    return err->status;
}

void effect_card_release(struct effect_card *e)
{
    camera_path_release(&e->path);
    picture_release(&e->poster);
    picture_release(&e->pan.poster);
    for (int i = 0; i < e->kind_count; i++) free(e->kinds[i].file);
    free(e->kinds);
    free(e->video);
    free(e->pan.video);
    free(e->validity);
    free(e->holes);
    free(e->unfilled);
}
