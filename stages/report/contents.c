#include "stages/report/contents.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

#include "common/base/parallel.h"
#include "common/base/scan.h"
#include "common/base/sort.h"
#include "common/image/photo.h"

static enum status add_note(struct contents *c, struct err *err, const char *fmt, ...) PRINTF_LIKE(3, 4);
static enum status add_note(struct contents *c, struct err *err, const char *fmt, ...)
{
    size_t bytes = ((size_t)c->note_count + 1) * sizeof *c->notes;
    char(*grown)[NOTE_SIZE] = realloc(c->notes, bytes);
    va_list args;
    if (!grown) return err_nomem(err, "notes", bytes);
    c->notes = grown;
    va_start(args, fmt);
    vsnprintf(grown[c->note_count++], NOTE_SIZE, fmt, args);
    va_end(args);
    return ST_OK;
}

static bool is_folder(const char *path)
{
    struct stat s;
    return !stat(path, &s) && S_ISDIR(s.st_mode);
}

static bool is_file(const char *path)
{
    struct stat s;
    return !stat(path, &s) && S_ISREG(s.st_mode);
}

static bool same_folder(const char *a, const char *b)
{
    struct stat x, y;
    return !stat(a, &x) && !stat(b, &y) && x.st_dev == y.st_dev && x.st_ino == y.st_ino;
}

/* -------------------------------------------------------------------------------------------------- photographs */

static bool looks_like_photo(const char *name)
{
    const char *dot = strrchr(name, '.');
    return name[0] != '.' && dot && (!strcasecmp(dot, ".jpg") || !strcasecmp(dot, ".jpeg") || !strcasecmp(dot, ".png"));
}

static enum status find_left_out(struct contents *c, const char *folder, struct err *err)
{
    struct dirent **names = NULL;
    int count = scandir(folder, &names, NULL, alphasort);
    enum status st = ST_OK;

    if (count < 0)
        return add_note(c, err, "The folder of photographs cannot be read (%s): no thumbnails.", strerror(errno));
    for (int i = 0; i < count; i++) {
        const char *name = names[i]->d_name;
        if (!st && looks_like_photo(name) && photo_list_find_file(&c->photos, name) < 0) {
            size_t bytes = ((size_t)c->left_out_count + 1) * sizeof *c->left_out;
            char(*grown)[256] = realloc(c->left_out, bytes);
            if (grown) {
                c->left_out = grown;
                snprintf(grown[c->left_out_count++], sizeof *grown, "%s", name);
            } else
                st = err_nomem(err, "names of photos", bytes);
        }
        free(names[i]);
    }
    free(names);
    return st;
}

struct photo_job {
    struct contents *c;
    const char *folder;
};

static void make_photo_cards(void *ctx, size_t begin, size_t end, int thread)
{
    const struct photo_job *job = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct photo_card *card = &job->c->photo_cards[i];
        struct photo photo = {0};
        struct err err = ERR_INIT;
        char path[4096];
        snprintf(path, sizeof path, "%s/%s", job->folder, card->record->file);
        if (photo_read(&photo, path, &err) || picture_from_photo(&card->picture, &photo, PICTURE_HEIGHT, &err))
            snprintf(card->trouble, sizeof card->trouble, "%.*s", NOTE_SIZE - 1, err.text);
        photo_release(&photo);
    }
}

static enum status read_photos(struct contents *c, const char *shared, const char *folder, struct err *err)
{
    char path[4096];
    struct err trouble = ERR_INIT;
    snprintf(path, sizeof path, "%s/photos", shared);
    if (photo_list_read(&c->photos, path, &trouble))
        return add_note(c, err, "There is no list of photographs. %s", trouble.text);
    c->has_photos = true;
    c->photo_cards = calloc((size_t)c->photos.count + 1, sizeof *c->photo_cards);
    if (!c->photo_cards) return err_nomem(err, "photos", (size_t)c->photos.count * sizeof *c->photo_cards);
    for (int i = 0; i < c->photos.count; i++) c->photo_cards[i].record = &c->photos.photos[i];
    struct photo_job job = {c, folder};
    if (is_folder(folder)) parallel_for((size_t)c->photos.count, 1, make_photo_cards, &job);
    return find_left_out(c, folder, err);
}

/* -------------------------------------------------------------------------------------------------------- views */

static enum status measure_points(struct contents *c, struct err *err)
{
    const struct sfm_model *m = &c->views.model;
    size_t total = 0, n = 0;
    double squares = 0;
    for (int i = 0; i < m->point_count; i++) total += (size_t)m->points[i].track_count;
    double *errors = malloc((total + 1) * sizeof *errors);
    if (!errors) return err_nomem(err, "reprojection errors", total * sizeof *errors);
    for (int i = 0; i < m->point_count; i++)
        for (int k = 0; k < m->points[i].track_count; k++) {
            const struct sfm_track *t = &m->points[i].track[k];
            const struct sfm_observation *o = &m->images[t->image_idx].observations[t->observation_idx];
            double u, v;
            if (!(view_project(&c->views.views[t->image_idx], m->points[i].position, &u, &v) > 0)) continue;
            errors[n++] = hypot(u - o->u, v - o->v);
            squares += errors[n - 1] * errors[n - 1];
        }
    if (n) {
        sort_doubles(errors, n);
        c->error_median = errors[n / 2];
        c->error_rms = sqrt(squares / (double)n);
        c->track_mean = (double)total / m->point_count;
    }
    free(errors);
    return ST_OK;
}

struct view_job {
    struct contents *c;
    const char *folder;
};

static double share(const char *text)
{
    char *end;
    double value = text ? strtod(text, &end) : -1;
    return text && end != text && !*end && value >= 0 && value <= 1 ? value : -1;
}

static enum status read_depth(struct view_card *card, const char *path, int orientation, struct err *err)
{
    static const char *const NAMES[] = {"interior.Z", "interior.id", "boundary.id"};
    struct exr_image im = {0};
    if (!exr_read(&im, path, NAMES, 3, err)) {
        const struct exr_plane *z = exr_find(&im, NAMES[0]);
        for (int k = 1; k < 3; k++) { /* ids count from 1 */
            const struct exr_plane *id = exr_find(&im, NAMES[k]);
            for (size_t i = 0; id->u && i < (size_t)im.width * (size_t)im.height; i++)
                if (id->u[i] > card->segments) card->segments = id->u[i];
        }
        if (z->f)
            depth_thumb_make(&card->depth, z->f, im.width, im.height, orientation, PICTURE_HEIGHT, err);
        else
            err_set(err, ST_DATA, "%s: interior.Z holds no floats.", path);
        card->inherited = share(exr_attribute(&im, "remodel:inherited"));
    }
    exr_image_release(&im);
    return err->status;
}

static void read_truth(struct view_card *card, const char *path, int orientation, struct err *err)
{
    static const char *const NAMES[] = {"Z"};
    struct exr_image im = {0};
    if (!exr_read(&im, path, NAMES, 1, err)) {
        const struct exr_plane *z = exr_find(&im, NAMES[0]);
        if (z->f)
            depth_thumb_make(&card->truth, z->f, im.width, im.height, orientation, PICTURE_HEIGHT, err);
        else
            err_set(err, ST_DATA, "%s: Z holds no floats.", path);
    }
    exr_image_release(&im);
}

static void make_view_cards(void *ctx, size_t begin, size_t end, int thread)
{
    static const char *const NAMES[] = {"R", "G", "B"};
    const struct view_job *job = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct view_card *card = &job->c->view_cards[i];
        int orientation = card->photo ? card->photo->info.orientation : 1;
        struct exr_image im = {0};
        struct err err = ERR_INIT;
        char path[4096];

        snprintf(path, sizeof path, "%s/views/%s.exr", job->folder, card->view->name);
        if (is_file(path) && !exr_read(&im, path, NAMES, 3, &err))
            picture_from_exr(&card->picture, &im, orientation, PICTURE_HEIGHT, &err);
        exr_image_release(&im);

        snprintf(path, sizeof path, "%s/depth/%s.exr", job->folder, card->view->name);
        if (is_file(path)) read_depth(card, path, orientation, &err);

        snprintf(path, sizeof path, "%s/evaluate/truth/%s.exr", job->folder, card->view->name);
        if (metric_rows_find(&job->c->view_metrics, card->view->name, "depth.occluded") && is_file(path))
            read_truth(card, path, orientation, &err);
        if (err.status) snprintf(card->trouble, sizeof card->trouble, "%.*s", NOTE_SIZE - 1, err.text);
    }
}

/* Which photograph each view was made from: as lenses.txt says. */
static void match_photos(struct contents *c)
{
    for (int i = 0; i < c->views.view_count; i++) {
        struct view_card *card = &c->view_cards[i];
        card->view = &c->views.views[i];
        int lens = lens_list_find(&c->lenses, card->view->name);
        int photo = lens < 0 ? -1 : photo_list_find_id(&c->photos, c->lenses.lenses[lens].photo);
        if (photo < 0) continue;
        card->photo = &c->photos.photos[photo];
        c->photo_cards[photo].views++;
    }
}

static enum status colour_depths(struct contents *c, struct err *err)
{
    for (int i = 0; i < c->views.view_count; i++) {
        struct view_card *card = &c->view_cards[i];
        if (!card->depth.z) continue;
        c->depth_count++;
        c->known += card->depth.known;
        c->inherited = c->inherited < 0 || card->inherited < 0 ? -1 : c->inherited + card->inherited;
        c->segments += card->segments;
        bool known = (card->truth.z && depth_range(&card->truth, 0.02, &card->near, &card->far)) ||
                     depth_range(&card->depth, 0.02, &card->near, &card->far);
        if (known && picture_from_depth(&card->depth_picture, &card->depth, card->near, card->far, err))
            return err->status;
        if (known && card->truth.z &&
            picture_from_depth(&card->truth_picture, &card->truth, card->near, card->far, err))
            return err->status;
    }
    if (c->depth_count) c->known /= c->depth_count;
    if (c->depth_count && c->inherited > 0) c->inherited /= c->depth_count;
    return ST_OK;
}

static enum status read_views(struct contents *c, const char *folder, struct err *err)
{
    char path[4096];
    struct err trouble = ERR_INIT;
    snprintf(path, sizeof path, "%s/views", folder);
    if (camera_set_read(&c->views, path, &trouble)) return add_note(c, err, "There are no views yet. %s", trouble.text);
    c->has_views = true;
    snprintf(path, sizeof path, "%s/views/lenses.txt", folder);
    if (lens_list_read(&c->lenses, path, &trouble) &&
        add_note(c, err, "Which photograph a view comes from is not known. %s", trouble.text))
        return err->status;
    c->view_cards = calloc((size_t)c->views.view_count + 1, sizeof *c->view_cards);
    if (!c->view_cards) return err_nomem(err, "views", (size_t)c->views.view_count * sizeof *c->view_cards);
    match_photos(c);
    struct view_job job = {c, folder};
    parallel_for((size_t)c->views.view_count, 1, make_view_cards, &job);

    int pictures = 0;
    for (int i = 0; i < c->views.view_count; i++) pictures += c->view_cards[i].picture.rgb != NULL;
    if (colour_depths(c, err) || measure_points(c, err)) return err->status;
    if (pictures < c->views.view_count && add_note(c, err, "%d of %d views have no rectified picture yet.",
                                                   c->views.view_count - pictures, c->views.view_count))
        return err->status;
    if (c->depth_count < c->views.view_count && add_note(c, err, "%d of %d views have no depth map yet.",
                                                         c->views.view_count - c->depth_count, c->views.view_count))
        return err->status;
    return ST_OK;
}

/* --------------------------------------------------------------------------------------------------- evaluation */

struct held_job {
    struct contents *c;
    const char *folder;
};

static void make_held_cards(void *ctx, size_t begin, size_t end, int thread)
{
    static const char *const NAMES[] = {"R", "G", "B"};
    const struct held_job *job = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct held_card *card = &job->c->held_cards[i];
        int lens = lens_list_find(&job->c->held_lenses, card->view->name);
        int photo = lens < 0 ? -1 : photo_list_find_id(&job->c->photos, job->c->held_lenses.lenses[lens].photo);
        int orientation = photo < 0 ? 1 : job->c->photos.photos[photo].info.orientation;
        struct err err = ERR_INIT;
        for (int k = 0; k < 2; k++) {
            struct exr_image im = {0};
            char path[4096];
            snprintf(path, sizeof path, "%s/holdout/%s/%s.exr", job->folder, k ? "frames" : "views", card->view->name);
            if (is_file(path) && !exr_read(&im, path, NAMES, 3, &err))
                picture_from_exr(k ? &card->frame : &card->picture, &im, orientation, HELD_HEIGHT, &err);
            exr_image_release(&im);
        }
        if (err.status) snprintf(card->trouble, sizeof card->trouble, "%.*s", NOTE_SIZE - 1, err.text);
    }
}

static enum status read_held(struct contents *c, const char *folder, struct err *err)
{
    char path[4096];
    struct err trouble = ERR_INIT;
    snprintf(path, sizeof path, "%s/holdout/views/lenses.txt", folder);
    if (!is_file(path)) return ST_OK;
    if (lens_list_read(&c->held_lenses, path, &trouble))
        return add_note(c, err, "What is held out is not known. %s", trouble.text);
    snprintf(path, sizeof path, "%s/holdout/views", folder);
    if (camera_set_read(&c->held, path, &trouble))
        return add_note(c, err, "What is held out is not known. %s", trouble.text);
    c->held_cards = calloc((size_t)c->held.view_count + 1, sizeof *c->held_cards);
    if (!c->held_cards) return err_nomem(err, "held-out views", (size_t)c->held.view_count * sizeof *c->held_cards);
    for (int i = 0; i < c->held.view_count; i++) {
        int lens = lens_list_find(&c->held_lenses, c->held.views[i].name);
        int photo = lens < 0 ? -1 : photo_list_find_id(&c->photos, c->held_lenses.lenses[lens].photo);
        c->held_cards[i].view = &c->held.views[i];
        if (photo >= 0) c->photo_cards[photo].held_out = true;
    }
    struct held_job job = {c, folder};
    parallel_for((size_t)c->held.view_count, 1, make_held_cards, &job);
    return ST_OK;
}

static enum status read_metrics(struct contents *c, const char *folder, struct err *err)
{
    char path[4096];
    struct err trouble = ERR_INIT;
    snprintf(path, sizeof path, "%s/metrics.tsv", folder);
    if (!is_file(path)) return ST_OK;
    if (metric_rows_read(&c->metrics, path, false, &trouble))
        return add_note(c, err, "What was measured cannot be read. %s", trouble.text);
    c->has_metrics = true;
    snprintf(path, sizeof path, "%s/evaluate/views.tsv", folder);
    if (metric_rows_read(&c->view_metrics, path, true, &trouble))
        return add_note(c, err, "What was measured of the views cannot be read. %s", trouble.text);
    return ST_OK;
}

/* The table is made with the page only where there is a truth or a hold-out; otherwise it may be of an older run. */
static enum status check_age(struct contents *c, const char *folder, struct err *err)
{
    struct stat table, map;
    char path[4096];
    snprintf(path, sizeof path, "%s/metrics.tsv", folder);
    if (!c->has_metrics || stat(path, &table)) return ST_OK;
    for (int i = 0; i < c->views.view_count; i++) {
        snprintf(path, sizeof path, "%s/depth/%s.exr", folder, c->views.views[i].name);
        if (stat(path, &map) || map.st_mtime <= table.st_mtime) continue;
        return add_note(c, err, "What is shown as measured is older than the depth maps; make evaluate measures anew.");
    }
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------- effects */

enum { PATH_SIZE = 4096 + 512 }; /* holds a folder's path and a file in it */

static enum status read_frames(struct contents *c, struct effect_card *e, const char *folder, struct err *err)
{
    static const char *const NAMES[] = {"R", "G", "B"};
    char trouble_text[NOTE_SIZE] = "";
    e->holes = malloc((size_t)e->path.frame_count * sizeof *e->holes);
    e->unfilled = malloc((size_t)e->path.frame_count * sizeof *e->unfilled);
    if (!e->holes || !e->unfilled)
        return err_nomem(err, "holes a frame", (size_t)e->path.frame_count * sizeof *e->holes);

    for (int i = 0; i < e->path.frame_count; i++) {
        struct exr_image im = {0};
        struct err trouble = ERR_INIT;
        char path[PATH_SIZE];
        e->holes[i] = e->unfilled[i] = -1;
        snprintf(path, sizeof path, "%s/frames/%s.exr", folder, e->path.frames[i].camera.name);
        if (!is_file(path)) continue;
        if (!exr_read(&im, path, NAMES, i == 0 ? 3 : 0, &trouble)) { /* attributes alone, but for the first frame */
            e->frames_found++;
            e->holes[i] = share(exr_attribute(&im, "remodel:holes"));
            e->unfilled[i] = share(exr_attribute(&im, "remodel:unfilled"));
            if (i == 0) picture_from_exr(&e->poster, &im, 1, 720, &trouble);
        }
        if (trouble.status) snprintf(trouble_text, sizeof trouble_text, "%.*s", NOTE_SIZE - 1, trouble.text);
        exr_image_release(&im);
    }
    if (trouble_text[0] && add_note(c, err, "A frame of %s cannot be read. %.800s", e->name, trouble_text))
        return err->status;
    if (e->frames_found < e->path.frame_count)
        return add_note(c, err, "%d of %d frames of %s are not there.", e->path.frame_count - e->frames_found,
                        e->path.frame_count, e->name);
    return ST_OK;
}

/* The first and the last frame tell which photograph is shown, and how well. */
static enum status read_pan_frame(struct contents *c, struct effect_card *e, const char *folder, int end,
                                  struct err *err)
{
    static const char *const NAMES[] = {"R", "G", "B"};
    struct exr_image im = {0};
    struct err trouble = ERR_INIT;
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/pan_scan/frames/%s.exr", folder,
             e->path.frames[end ? e->path.frame_count - 1 : 0].camera.name);
    if (!exr_read(&im, path, NAMES, end ? 0 : 3, &trouble)) {
        const char *view = exr_attribute(&im, "remodel:view"), *misfit = exr_attribute(&im, "remodel:misfit");
        if (view) snprintf(e->pan.view, sizeof e->pan.view, "%s", view);
        if (!misfit || !scan_double(misfit, &e->pan.misfit[end]) || !(e->pan.misfit[end] >= 0)) e->pan.misfit[end] = -1;
        if (!end) picture_from_exr(&e->pan.poster, &im, 1, 720, &trouble);
    }
    exr_image_release(&im);
    if (trouble.status) return add_note(c, err, "A frame of %s in 2D cannot be read. %.800s", e->name, trouble.text);
    return ST_OK;
}

/* Made on request: nothing is said where it is not there. */
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
    struct err trouble = ERR_INIT;
    struct stat s;

    snprintf(path, sizeof path, "%s/video.mp4", folder);
    if (stat(path, &s) || !S_ISREG(s.st_mode) || s.st_size == 0) {
        if (add_note(c, err, "There is no video of %s yet.", e->name)) return err->status;
    } else {
        e->video_bytes = s.st_size;
        if (!(e->video = strdup(path))) return err_nomem(err, "a file name", strlen(path));
    }
    if (camera_path_read(&e->path, folder, &trouble))
        return add_note(c, err, "There is no camera path of %s. %s", e->name, trouble.text);
    return read_frames(c, e, folder, err) || read_pan(c, e, folder, err) ? err->status : ST_OK;
}

/* All effects of a move share its valid viewpoints. */
static enum status find_validity(struct effect_card *e, const char *folder, struct err *err)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/parallax/%.*s/validity.png", folder, (int)strcspn(e->name, "+"), e->name);
    if (!is_file(path)) return ST_OK;
    return (e->validity = strdup(path)) ? ST_OK : err_nomem(err, "a file name", strlen(path));
}

/* A move of which only other films were made has a folder for what they share. */
static bool is_film(const char *folder)
{
    char path[PATH_SIZE], validity[PATH_SIZE];
    snprintf(path, sizeof path, "%s/path.txt", folder);
    snprintf(validity, sizeof validity, "%s/validity.txt", folder);
    return is_folder(folder) && (is_file(path) || !is_file(validity));
}

static enum status read_effects(struct contents *c, const char *folder, struct err *err)
{
    struct dirent **names = NULL;
    char path[4096];
    snprintf(path, sizeof path, "%s/parallax", folder);
    int count = scandir(path, &names, NULL, alphasort);
    enum status st = ST_OK;

    c->effects = calloc((size_t)(count > 0 ? count : 0) + 1, sizeof *c->effects);
    if (!c->effects) st = err_nomem(err, "effects", (size_t)count * sizeof *c->effects);
    for (int i = 0; i < count; i++) {
        snprintf(path, sizeof path, "%s/parallax/%s", folder, names[i]->d_name);
        if (!st && names[i]->d_name[0] != '.' && is_film(path)) {
            struct effect_card *e = &c->effects[c->effect_count++];
            snprintf(e->name, sizeof e->name, "%s", names[i]->d_name);
            st = read_effect(c, e, path, err);
            if (!st) st = find_validity(e, folder, err);
        }
        free(names[i]);
    }
    free(names);
    if (!st && !c->effect_count) st = add_note(c, err, "No camera move was planned yet: there is no video.");
    return st;
}

/* ---------------------------------------------------------------------------------------------------------- axes */

static enum status read_axes_card(struct contents *c, const char *path, const char *view, struct err *err)
{
    struct photo photo = {0};
    struct err trouble = ERR_INIT;
    struct axes_card *card = &c->axes[c->axes_count];
    if (photo_read(&photo, path, &trouble))
        return add_note(c, err, "A picture of the axes cannot be shown. %s", trouble.text);
    snprintf(card->view, sizeof card->view, "%s", view);
    const int at = camera_set_find(&c->views, view);
    if (at >= 0 && c->view_cards[at].photo) photo.info.orientation = c->view_cards[at].photo->info.orientation;
    const enum status st = picture_from_photo(&card->picture, &photo, AXES_HEIGHT, err);
    c->axes_count += !st;
    photo_release(&photo);
    return st;
}

/* model/axes/VIEW.png, where the axes were found */
static enum status read_axes(struct contents *c, const char *folder, struct err *err)
{
    struct dirent **names = NULL;
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/model/axes.txt", folder);
    if (!is_file(path)) return ST_OK;
    snprintf(path, sizeof path, "%s/model/axes", folder);
    int count = scandir(path, &names, NULL, alphasort);
    enum status st = ST_OK;
    c->axes = calloc((size_t)(count > 0 ? count : 0) + 1, sizeof *c->axes);
    if (!c->axes) st = err_nomem(err, "pictures of axes", (size_t)count * sizeof *c->axes);
    for (int i = 0; i < count; i++) {
        char *name = names[i]->d_name, *dot = strrchr(name, '.');
        snprintf(path, sizeof path, "%s/model/axes/%s", folder, name);
        if (!st && dot && dot != name && name[0] != '.' && !strcmp(dot, ".png")) {
            *dot = '\0';
            st = read_axes_card(c, path, name, err);
        }
        free(names[i]);
    }
    free(names);
    return st;
}

/* -------------------------------------------------------------------------------------------------------- models */

static char *file_if_there(const char *folder, const char *name)
{
    char path[PATH_SIZE + 512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return is_file(path) ? strdup(path) : NULL;
}

static enum status read_model(struct contents *c, const char *folder, const char *name, struct err *err)
{
    struct dirent **names = NULL;
    char path[PATH_SIZE];
    const size_t bytes = ((size_t)c->model_count + 1) * sizeof *c->models;
    snprintf(path, sizeof path, "%s/model.txt", folder);
    if (!is_file(path)) return ST_OK;
    struct model_card *grown = realloc(c->models, bytes);
    if (!grown) return err_nomem(err, "models", bytes);
    c->models = grown;
    struct model_card *m = &grown[c->model_count++];
    *m = (struct model_card){.plan = file_if_there(folder, "plan.svg"), .view = file_if_there(folder, "view.png")};
    snprintf(m->name, sizeof m->name, "%s", name);
    snprintf(path, sizeof path, "%s/overlay", folder);
    const int count = scandir(path, &names, NULL, alphasort);
    enum status st = ST_OK;
    m->overlays = calloc((size_t)(count > 0 ? count : 0) + 1, sizeof *m->overlays);
    m->named = calloc((size_t)(count > 0 ? count : 0) + 1, sizeof *m->named);
    if (!m->overlays || !m->named) st = err_nomem(err, "pictures of a model", (size_t)count * sizeof *m->named);
    for (int i = 0; i < count; i++) {
        const char *file = names[i]->d_name, *dot = strrchr(file, '.');
        if (!st && dot && dot != file && file[0] != '.' && !strcmp(dot, ".jpg")) {
            m->overlays[m->overlay_count] = file_if_there(path, file);
            m->named[m->overlay_count] = strndup(file, (size_t)(dot - file));
            m->overlay_count += m->overlays[m->overlay_count] && m->named[m->overlay_count];
        }
        free(names[i]);
    }
    free(names);
    return st;
}

/* model/, and remodel/EDIT/ of every edit */
static enum status read_models(struct contents *c, const char *folder, struct err *err)
{
    struct dirent **names = NULL;
    char path[PATH_SIZE], below[PATH_SIZE + 256];
    snprintf(path, sizeof path, "%s/model", folder);
    enum status st = read_model(c, path, "", err);
    snprintf(path, sizeof path, "%s/remodel", folder);
    const int count = scandir(path, &names, NULL, alphasort);
    for (int i = 0; i < count; i++) {
        snprintf(below, sizeof below, "%s/%s", path, names[i]->d_name);
        if (!st && names[i]->d_name[0] != '.') st = read_model(c, below, names[i]->d_name, err);
        free(names[i]);
    }
    free(names);
    return st;
}

static void model_card_release(struct model_card *m)
{
    for (int i = 0; m->overlays && m->named && i < m->overlay_count; i++) {
        free(m->overlays[i]);
        free(m->named[i]);
    }
    free(m->overlays);
    free(m->named);
    free(m->plan);
    free(m->view);
}

/* --------------------------------------------------------------------------------------------------------- whole */

/* Logs and slices of the two folders, each once. */
static enum status read_records(struct contents *c, const char *folder, const char *shared, const char *defaults,
                                struct err *err)
{
    const char *folders[2] = {folder,
                              shared}; /* what both hold of parameters, the shared stages ran with the shared ones */
    struct settings usual = {0};
    enum status st = ST_OK;

    for (int i = 0; i < (same_folder(folder, shared) ? 1 : 2) && !st; i++) {
        struct err trouble = ERR_INIT;
        char path[4096];
        snprintf(path, sizeof path, "%s/log", folders[i]);
        if (usage_add_folder(&c->usage, path, "report", &trouble))
            st = add_note(c, err, "Not all logs can be read. %s", trouble.text);
        trouble.status = ST_OK;
        snprintf(path, sizeof path, "%s/slice", folders[i]);
        if (!st && settings_add_folder(&c->settings, path, &trouble))
            st = add_note(c, err, "Not all parameters can be read. %s", trouble.text);
    }
    if (defaults && !st) {
        struct err trouble = ERR_INIT;
        if (settings_add_file(&usual, defaults, &trouble))
            st = add_note(c, err, "The default parameters cannot be read. %s", trouble.text);
        settings_compare(&c->settings, &usual);
    }
    settings_release(&usual);
    return st;
}

enum status contents_read(struct contents *c, const char *folder, const char *shared, const char *photos,
                          const char *defaults, struct err *err)
{
    if (!is_folder(folder))
        return err_set(err, ST_IO, "%s is no folder: there is no scene to report on. Make the scene first.", folder);
    if (read_photos(c, shared, photos, err) || read_metrics(c, folder, err) || read_views(c, folder, err) ||
        read_held(c, folder, err) || check_age(c, folder, err) || read_effects(c, folder, err) ||
        read_axes(c, folder, err) || read_models(c, folder, err))
        return err->status;
    return read_records(c, folder, shared, defaults, err);
}

void contents_release(struct contents *c)
{
    for (int i = 0; c->photo_cards && i < c->photos.count; i++) picture_release(&c->photo_cards[i].picture);
    for (int i = 0; c->view_cards && i < c->views.view_count; i++) {
        picture_release(&c->view_cards[i].picture);
        picture_release(&c->view_cards[i].depth_picture);
        picture_release(&c->view_cards[i].truth_picture);
        depth_thumb_release(&c->view_cards[i].depth);
        depth_thumb_release(&c->view_cards[i].truth);
    }
    for (int i = 0; c->held_cards && i < c->held.view_count; i++) {
        picture_release(&c->held_cards[i].picture);
        picture_release(&c->held_cards[i].frame);
    }
    for (int i = 0; i < c->effect_count; i++) {
        camera_path_release(&c->effects[i].path);
        picture_release(&c->effects[i].poster);
        picture_release(&c->effects[i].pan.poster);
        free(c->effects[i].video);
        free(c->effects[i].pan.video);
        free(c->effects[i].validity);
        free(c->effects[i].holes);
        free(c->effects[i].unfilled);
    }
    for (int i = 0; i < c->axes_count; i++) picture_release(&c->axes[i].picture);
    free(c->axes);
    for (int i = 0; i < c->model_count; i++) model_card_release(&c->models[i]);
    free(c->models);
    free(c->photo_cards);
    free(c->view_cards);
    free(c->held_cards);
    free(c->effects);
    free(c->left_out);
    free(c->notes);
    usage_table_release(&c->usage);
    settings_release(&c->settings);
    metric_rows_release(&c->metrics);
    metric_rows_release(&c->view_metrics);
    lens_list_release(&c->held_lenses);
    camera_set_release(&c->held);
    lens_list_release(&c->lenses);
    camera_set_release(&c->views);
    photo_list_release(&c->photos);
    *c = (struct contents){0};
}
