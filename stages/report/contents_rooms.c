/* contents_rooms.c - reads what the photographs show after each change.
 *
 * Records. Of each view and each change there may be a record of the picture in the old light (O/remodel/E/pictures)
 * and one of the picture in the new light (O/relight/E). They are read first, since they say how much of a view changes
 * and how much of that is known.
 *
 * Which photos are shown. Changes take turns in choosing the photo that shows them best, until ROOMS_SHOWN are chosen:
 * what changed and is known, not guessed, times the share of this in what changed; new light counts less. A photo that
 * most changes alter comes first. All changes that one sees in a photo can be chosen for it; what alters less than
 * LEAST percent of it is left out.
 *
 * How large they are. BUDGET bytes hold all pictures of a page: their number says how many pixels each may have, at the
 * BYTES_A_PIXEL that rooms take as JPEG.
 *
 * A picture of a whole photo is put together from those of its views. A view that a change leaves alone has no picture
 * of it: there the view itself stands. */
#include "stages/report/contents_rooms.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/parallel.h"
#include "common/base/sort.h"
#include "common/base/textfile.h"
#include "common/capture/camera_set.h"
#include "common/capture/lens_list.h"
#include "common/capture/photo_list.h"
#include "common/math/numbers.h"
#include "common/texture/picture_made.h"
#include "common/texture/picture_record.h"
#include "stages/report/contents_parts.h"
#include "stages/report/contents_relit.h"
#include "stages/report/whole_photo.h"

enum { HIGHEST = 720, LOWEST = 300, BUDGET = 5000000 };
static const double BYTES_A_PIXEL = 0.13, LEAST = 0.5, LIGHT_WORTH = 0.3, COVERED = 0.9;
static const double NEAR = 0.25, TURN = 20, LIKENESS = 0.1; /* of the spread; degrees; worth of one like another */
static const double SIDE_SHARE = 0.25;                      /* of a picture's area: pictures of origins and of ratios */

struct view_change { /* of a view after a change */
    bool drawn, lit;
    bool unlit;                 /* drawn by relight alone, among its own pictures */
    struct picture_record file; /* of drawn */
    struct relit_record light;  /* of lit */
};

struct source_photo {
    char photo[256];
    const struct lens *lenses; /* of its views, which follow each other */
    int first, count;          /* of the list of lenses */
    bool chosen;
};

struct rooms_reading {
    struct rooms *rooms;
    const struct rooms_sources *from;
    struct lens_list lenses;
    struct view *views; /* the cameras of the lenses' views; owned */
    struct camera_set cameras;
    struct source_photo *photos; /* owned */
    int photo_count;
    double spread;             /* the median distance of two photos */
    struct view_change *table; /* change_count rows of lenses.count; owned */
};

static enum status note(struct rooms *rooms, const char *what, const struct err *problem, struct err *err)
{
    if (problem->status == ST_NOMEM) return err_set(err, ST_NOMEM, "%s", problem->text);
    if (array_append(&rooms->notes, (size_t)rooms->note_count, sizeof *rooms->notes, "notes", err)) return err->status;
    snprintf(rooms->notes[rooms->note_count++], sizeof *rooms->notes, "%.100s: %.800s", what, problem->text);
    return ST_OK;
}

static struct view_change *change_of(const struct rooms_reading *r, int change, int lens)
{
    return &r->table[(size_t)change * (size_t)r->lenses.count + (size_t)lens];
}

/* ---------------------------------------------------------------------------------------------------------- changes */

/* The comment at the beginning of a script, in one line. */
static enum status read_about(char **about, const char *scripts, const char *edit, struct err *err)
{
    char path[FILE_PATH], text[2048] = "";
    struct textfile t = {0};
    struct err none = ERR_INIT; /* an edit without a script has no comment */
    bool begun = false;
    if (scripts && !file_path(path, scripts, edit, ".txt", &none) && !textfile_open(&t, path, &none)) {
        while (textfile_next_raw(&t)) {
            const char *line = t.cursor + strspn(t.cursor, " \t");
            if (*line != '#' && begun) break;
            if (*line != '#') continue;
            begun = true;
            line += strspn(line, "# \t");
            const size_t length = strlen(text);
            snprintf(text + length, sizeof text - length, "%s%s", length ? " " : "", line);
        }
        textfile_release(&t);
    }
    *about = strdup(text);
    return *about ? ST_OK : err_nomem(err, "a comment", strlen(text));
}

static enum status read_change(struct rooms_reading *r, const char *name, struct err *err)
{
    struct rooms *rooms = r->rooms;
    char model[FILE_PATH], path[FILE_PATH];
    if (file_path(model, "remodel", name, "", err)) return err->status;
    if (!contents_product(path, r->from->folder, PRODUCT_MODEL, &(struct product_key){.model = model})) return ST_OK;
    if (array_append(&rooms->changes, (size_t)rooms->change_count, sizeof *rooms->changes, "changes", err))
        return err->status;
    struct room_change *change = &rooms->changes[rooms->change_count++];
    *change = (struct room_change){.photos = 0};
    snprintf(change->name, sizeof change->name, "%s", name);
    return read_about(&change->about, r->from->scripts, name, err);
}

static enum status list_changes(struct rooms_reading *r, struct err *err)
{
    struct dirent **names = NULL;
    char path[FILE_PATH];
    if (file_path(path, r->from->folder, "remodel", "", err)) return err->status;
    const int count = scandir(path, &names, NULL, alphasort);
    for (int i = 0; i < count; i++) {
        if (!err->status && names[i]->d_name[0] != '.') read_change(r, names[i]->d_name, err);
        free(names[i]);
    }
    free(names);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------- views, photos */

static enum status add_photo(struct rooms_reading *r, int lens, struct err *err)
{
    const char *name = r->lenses.lenses[lens].photo;
    struct source_photo *last = r->photo_count ? &r->photos[r->photo_count - 1] : NULL;
    if (last && !strcmp(last->photo, name)) {
        last->count++;
        return ST_OK;
    }
    if (array_append(&r->photos, (size_t)r->photo_count, sizeof *r->photos, "photos", err)) return err->status;
    struct source_photo *p = &r->photos[r->photo_count++];
    *p = (struct source_photo){.lenses = &r->lenses.lenses[lens], .first = lens, .count = 1};
    snprintf(p->photo, sizeof p->photo, "%s", name);
    return ST_OK;
}

/* Cameras and photos of the views. False: there are none, which is noted. */
static bool read_views(struct rooms_reading *r, struct err *err)
{
    char path[FILE_PATH], folder[FILE_PATH];
    struct err problem = ERR_INIT;
    if (file_path(folder, r->from->folder, "views", "", err)) return false;
    if (product_path_below(path, r->from->folder, PRODUCT_LENSES, NULL, &problem) ||
        lens_list_read(&r->lenses, path, NULL, &problem) ||
        camera_set_read_cameras(&r->cameras, folder, NULL, &problem)) {
        note(r->rooms, "the changes cannot be shown", &problem, err);
        return false;
    }
    r->views = calloc((size_t)r->lenses.count + 1, sizeof *r->views);
    if (!r->views) err_nomem(err, "views", (size_t)r->lenses.count * sizeof *r->views);
    for (int i = 0; !err->status && i < r->lenses.count; i++) {
        const int at = camera_set_find(&r->cameras, r->lenses.lenses[i].view);
        if (at < 0) {
            err_set(&problem, ST_DATA, "%s: view %s has no camera; import the cameras again.", path,
                    r->lenses.lenses[i].view);
            note(r->rooms, "the changes cannot be shown", &problem, err);
            return false;
        }
        r->views[i] = r->cameras.views[at];
        add_photo(r, i, err);
    }
    return !err->status;
}

static enum status read_view_change(struct rooms_reading *r, int change, int lens, struct err *err)
{
    struct view_change *v = change_of(r, change, lens);
    const char *scene = r->from->folder, *edit = r->rooms->changes[change].name;
    char pictures[FILE_PATH], relit[FILE_PATH], path[FILE_PATH];
    struct err problem = ERR_INIT;
    const struct product_key key = {.name = r->lenses.lenses[lens].view, .pictures = pictures, .relit = relit};
    snprintf(relit, sizeof relit, "relight/%s", edit);
    snprintf(pictures, sizeof pictures, "remodel/%s/pictures", edit);
    v->drawn = contents_product(path, scene, PRODUCT_PICTURE_RECORD, &key);
    if (!v->drawn) {
        snprintf(pictures, sizeof pictures, "relight/%s/unlit", edit);
        v->drawn = v->unlit = contents_product(path, scene, PRODUCT_PICTURE_RECORD, &key);
    }
    if (v->drawn && picture_record_read(&v->file, path, NULL, &problem)) {
        v->drawn = false;
        if (note(r->rooms, "a picture is left out", &problem, err)) return err->status;
    }
    if (!contents_product(path, scene, PRODUCT_RELIT_RECORD, &key)) return ST_OK;
    problem = (struct err)ERR_INIT;
    if (relit_record_read(&v->light, path, &problem))
        return note(r->rooms, "a relit picture is left out", &problem, err);
    v->lit = true;
    return ST_OK;
}

static enum status read_table(struct rooms_reading *r, struct err *err)
{
    const size_t size = (size_t)r->rooms->change_count * (size_t)r->lenses.count;
    r->table = calloc(size + 1, sizeof *r->table);
    if (!r->table) return err_nomem(err, "records of pictures", size * sizeof *r->table);
    for (int e = 0; e < r->rooms->change_count; e++)
        for (int i = 0; i < r->lenses.count; i++) {
            if (read_view_change(r, e, i, err)) return err->status;
            r->rooms->changes[e].has_records |= change_of(r, e, i)->drawn || change_of(r, e, i)->lit;
        }
    return ST_OK;
}

/* ----------------------------------------------------------------------------------------------- what a photo shows */

/* Shares of the photo: those of its views by the pixels that they know. */
static struct room_look measure_look(const struct rooms_reading *r, const struct source_photo *p, int change)
{
    struct room_look look = {.change = change};
    double all = 0, light = 0;
    for (int i = p->first; i < p->first + p->count; i++) {
        const struct view_change *v = change_of(r, change, i);
        const double pixels = (double)r->views[i].width * r->views[i].height;
        const double weight = pixels * fmax(1, 100 - v->file.shares[MADE_NOTHING]);
        if (v->drawn) {
            all += weight;
            look.changed += weight * v->file.changed;
            for (int k = 0; k < MADE_COUNT; k++) look.shares[k] += weight * v->file.shares[k];
        }
        if (!v->lit) continue;
        light += weight;
        look.light += weight * v->light.changed;
        look.bounded += weight * v->light.bounded;
        look.kept += weight * v->light.kept;
    }
    all = fmax(all, 1e-300), light = fmax(light, 1e-300);
    look.changed /= all;
    for (int k = 0; k < MADE_COUNT; k++) look.shares[k] /= all;
    look.light /= light, look.bounded /= light, look.kept /= light;
    return look;
}

/* A photo of which little is left, such as one that looks straight at a new wall, tells less. */
static double worth(const struct room_look *look)
{
    const double guessed = look->shares[MADE_SYNTHESISED] + look->shares[MADE_UNSURE];
    const double known = look->changed > guessed ? (look->changed - guessed) / look->changed : 0;
    const double sure = look->light > look->bounded ? (look->light - look->bounded) / look->light : 0;
    const double telling = look->changed * (1 - COVERED * look->changed / 100);
    return known * known * telling + 1e-3 * look->changed + LIGHT_WORTH * sure * look->light;
}

static bool is_seen(const struct room_look *look) { return look->changed >= LEAST || look->light >= LEAST; }

/* The distance that half of the photos' pairs exceed; of many photos some pairs stand for all. */
static double find_spread(const struct rooms_reading *r)
{
    enum { PAIRS = 4096 };
    double *distances = malloc(PAIRS * sizeof *distances), spread = 0;
    size_t n = 0;
    const int step = r->photo_count / 64 + 1;
    for (int i = 0; distances && i < r->photo_count; i += step)
        for (int k = 0; k < i && n < PAIRS; k += step)
            distances[n++] =
                vec3_length(vec3_sub(r->views[r->photos[i].first].center, r->views[r->photos[k].first].center));
    if (n) {
        sort_doubles(distances, n);
        spread = distances[n / 2];
    }
    free(distances);
    return spread;
}

/* Whether two photos were taken from about the same place in about the same direction. */
static bool are_alike(const struct rooms_reading *r, const struct source_photo *a, const struct source_photo *b)
{
    const struct view *p = &r->views[a->first], *q = &r->views[b->first];
    return vec3_length(vec3_sub(p->center, q->center)) < NEAR * r->spread &&
           vec3_dot(mat3_row(p->cam_from_world, 2), mat3_row(q->cam_from_world, 2)) > cos(TURN * DEGREE);
}

static bool is_like_chosen(const struct rooms_reading *r, const struct source_photo *p)
{
    for (int i = 0; i < r->photo_count; i++)
        if (r->photos[i].chosen && are_alike(r, p, &r->photos[i])) return true;
    return false;
}

/* The photo not yet chosen that shows a change best; NULL: none shows it. One like another that was chosen comes after
 * those that are not. */
static struct source_photo *best_photo(const struct rooms_reading *r, int change)
{
    struct source_photo *best = NULL;
    double most = 0;
    for (int i = 0; i < r->photo_count; i++) {
        const struct room_look look = measure_look(r, &r->photos[i], change);
        if (r->photos[i].chosen || !is_seen(&look)) continue;
        const double value = worth(&look) * (is_like_chosen(r, &r->photos[i]) ? LIKENESS : 1);
        if (!(value > most)) continue;
        most = value;
        best = &r->photos[i];
    }
    return best;
}

static void count_photos(struct rooms_reading *r)
{
    for (int i = 0; i < r->photo_count; i++) {
        bool changed = false;
        for (int e = 0; e < r->rooms->change_count; e++) {
            const struct room_look look = measure_look(r, &r->photos[i], e);
            r->rooms->changes[e].photos += is_seen(&look);
            changed |= is_seen(&look);
        }
        r->rooms->photos_changed += changed;
    }
}

static int choose_photos(struct rooms_reading *r)
{
    int chosen = 0;
    for (bool any = true; any && chosen < ROOMS_SHOWN;) {
        any = false;
        for (int e = 0; e < r->rooms->change_count && chosen < ROOMS_SHOWN; e++) {
            struct source_photo *p = best_photo(r, e);
            if (!p) continue;
            p->chosen = any = true;
            chosen++;
        }
    }
    return chosen;
}

static int compare_looks(const void *a, const void *b)
{
    const struct room_look *p = a, *q = b;
    if (worth(p) != worth(q)) return worth(p) < worth(q) ? 1 : -1;
    return (p->change > q->change) - (p->change < q->change);
}

static enum status add_room(struct rooms_reading *r, const struct source_photo *p, struct err *err)
{
    struct rooms *rooms = r->rooms;
    struct room_photo *to = &rooms->photos[rooms->photo_count++];
    memcpy(to->photo, p->photo, sizeof to->photo);
    to->looks = calloc((size_t)rooms->change_count + 1, sizeof *to->looks);
    if (!to->looks) return err_nomem(err, "changes of a photo", (size_t)rooms->change_count * sizeof *to->looks);
    for (int e = 0; e < rooms->change_count; e++) {
        const struct room_look look = measure_look(r, p, e);
        if (is_seen(&look)) to->looks[to->look_count++] = look;
    }
    qsort(to->looks, (size_t)to->look_count, sizeof *to->looks, compare_looks);
    return ST_OK;
}

static double worth_of_photo(const struct room_photo *p)
{
    double sum = 0;
    for (int i = 0; i < p->look_count; i++) sum += sqrt(worth(&p->looks[i]));
    return sum;
}

static int compare_photos(const void *a, const void *b)
{
    const struct room_photo *p = a, *q = b;
    const double x = worth_of_photo(p), y = worth_of_photo(q);
    if (x != y) return x < y ? 1 : -1;
    return strcmp(p->photo, q->photo);
}

/* --------------------------------------------------------------------------------------------------------- pictures */

struct room_job {
    struct rooms_reading *r;
    int height;
    struct err *errors; /* of each photo */
};

/* What is known of a photo while its pictures are made. */
struct room_work {
    const struct rooms_reading *r;
    const struct source_photo *from;
    int orientation;
    double exposure;
    struct whole_photo whole, small;
    struct image *before;   /* radiance of its views times the exposure */
    unsigned char *covered; /* whether a view shows the pixel */
    struct picture rest;    /* the photo itself, for pixels that no view shows; empty: it cannot be read */
    double gain[3];         /* from it to the views */
};

static void layers_clear(struct image *images, int count)
{
    for (int i = 0; images && i < count; i++) image_release(&images[i]);
}

static enum status read_radiance(struct image *im, const char *path, const struct view *view, double exposure,
                                 struct err *err)
{
    static const char *const names[] = {"R", "G", "B"};
    struct exr_image exr = {0};
    if (!exr_read(&exr, path, names, 3, err) && (exr.width != view->width || exr.height != view->height))
        err_set(err, ST_DATA, "%s: found %d x %d px, wanted %d x %d as its camera has; rectify the view again.", path,
                exr.width, exr.height, view->width, view->height);
    if (!err->status) image_init(im, exr.width, exr.height, 3, err);
    for (int c = 0; !err->status && c < 3; c++) {
        const struct exr_plane *plane = exr_find(&exr, names[c]);
        if (!plane || !plane->f) {
            err_set(err, ST_DATA, "%s: found no channel %s of floats, wanted R, G and B.", path, names[c]);
            break;
        }
        for (size_t i = 0; i < (size_t)exr.width * (size_t)exr.height; i++)
            im->data[3 * i + (size_t)c] = (float)exposure * plane->f[i];
    }
    exr_image_release(&exr);
    return err->status;
}

/* A JPEG or PNG of a view, linear; scale: of its exposure to that of the page. */
static enum status read_layer(struct image *im, const char *path, const struct view *view, double scale,
                              struct err *err)
{
    struct photo photo = {0};
    if (photo_read(&photo, path, err) || photo_to_linear(im, &photo, err)) {
        photo_release(&photo);
        return err->status;
    }
    photo_release(&photo);
    if (im->width != view->width || im->height != view->height)
        return err_set(err, ST_DATA, "%s: found %d x %d px, wanted %d x %d as the view has; make the picture again.",
                       path, im->width, im->height, view->width, view->height);
    for (size_t i = 0; scale != 1 && i < 3 * (size_t)im->width * (size_t)im->height; i++) im->data[i] *= (float)scale;
    return ST_OK;
}

/* The exposure of the photo's pictures: that of the first that is drawn; 0: none is. */
static double find_exposure(const struct rooms_reading *r, const struct source_photo *p)
{
    for (int e = 0; e < r->rooms->change_count; e++)
        for (int i = p->first; i < p->first + p->count; i++) {
            const struct view_change *v = change_of(r, e, i);
            if (v->drawn) return v->file.exposure;
            if (v->lit) return v->light.exposure;
        }
    return 0;
}

enum layer_kind { LAYER_AFTER, LAYER_RELIT, LAYER_MADE, LAYER_RATIO };

/* The file of a layer, and what its exposure is to be multiplied by. False: there is none. */
static bool find_layer(char path[FILE_PATH], double *scale, const struct rooms_reading *r, int change, int lens,
                       enum layer_kind kind, double exposure)
{
    static const enum product_id ids[] = {PRODUCT_PICTURE_JPEG, PRODUCT_RELIT_JPEG, PRODUCT_PICTURE_SOURCES,
                                          PRODUCT_RELIT_RATIO_PICTURE};
    const struct view_change *v = change_of(r, change, lens);
    const char *edit = r->rooms->changes[change].name;
    char pictures[FILE_PATH], relit[FILE_PATH];
    const struct product_key key = {.name = r->lenses.lenses[lens].view, .pictures = pictures, .relit = relit};
    const bool light = kind == LAYER_RELIT || kind == LAYER_RATIO;
    snprintf(relit, sizeof relit, "relight/%s", edit);
    snprintf(pictures, sizeof pictures, v->unlit ? "relight/%s/unlit" : "remodel/%s/pictures", edit);
    *scale = kind == LAYER_AFTER && v->file.exposure > 0    ? exposure / v->file.exposure
             : kind == LAYER_RELIT && v->light.exposure > 0 ? exposure / v->light.exposure
                                                            : 1;
    if (light ? !v->lit : !v->drawn || !(v->file.changed > 0)) return false;
    return contents_product(path, r->from->folder, ids[kind], &key);
}

/* Puts a picture of the photo together. A view that has no layer of its own is shown as it is, or, of a picture of
 * codes, in the colour `fallback`. p stays empty if no view has one. */
static enum status make_layer(struct picture *p, const struct room_work *w, int change, enum layer_kind kind,
                              const float *fallback, struct err *err)
{
    const int count = w->from->count;
    struct image *layers = calloc((size_t)count, sizeof *layers), *shown = calloc((size_t)count, sizeof *shown);
    char path[FILE_PATH];
    double scale;
    bool any = false;
    if (!layers || !shown) err_nomem(err, "layers", (size_t)count * sizeof *layers);
    for (int i = 0; !err->status && i < count; i++) {
        const int lens = w->from->first + i;
        bool found = find_layer(path, &scale, w->r, change, lens, kind, w->exposure);
        any |= found;
        if (!found && kind == LAYER_RELIT)
            found = find_layer(path, &scale, w->r, change, lens, LAYER_AFTER, w->exposure);
        if (found) read_layer(&layers[i], path, &w->r->views[lens], scale, err);
        shown[i] = layers[i].data || fallback ? layers[i] : w->before[i];
    }
    if (!err->status && any &&
        !whole_photo_picture(p, fallback ? &w->small : &w->whole, shown, w->before, fallback, !fallback, NULL, err) &&
        !fallback && w->rest.rgb)
        whole_photo_fill(p, w->covered, &w->rest, w->gain);
    layers_clear(layers, count);
    free(layers);
    free(shown);
    return err->status;
}

static void colour_to_linear(float linear[3], const uint8_t rgb[3])
{
    for (int c = 0; c < 3; c++) linear[c] = linear_from_srgb((float)rgb[c] / 255);
}

static enum status make_look(struct room_look *look, const struct room_work *w, struct err *err)
{
    static const uint8_t grey[3] = {128, 128, 128};
    float photo[3], same[3];
    colour_to_linear(photo, picture_made_kind(MADE_PHOTO)->rgb);
    colour_to_linear(same, grey);
    if (make_layer(&look->after, w, look->change, LAYER_AFTER, NULL, err) ||
        make_layer(&look->relit, w, look->change, LAYER_RELIT, NULL, err) ||
        make_layer(&look->made, w, look->change, LAYER_MADE, photo, err))
        return err->status;
    return make_layer(&look->ratio, w, look->change, LAYER_RATIO, same, err);
}

static const struct source_photo *source_of(const struct rooms_reading *r, const char *photo)
{
    for (int i = 0; i < r->photo_count; i++)
        if (!strcmp(r->photos[i].photo, photo)) return &r->photos[i];
    return NULL;
}

static void look_release(struct room_look *look)
{
    picture_release(&look->after);
    picture_release(&look->relit);
    picture_release(&look->made);
    picture_release(&look->ratio);
}

static enum status read_before(struct room_work *w, struct err *err)
{
    for (int i = 0; !err->status && i < w->from->count; i++) {
        const int lens = w->from->first + i;
        char path[FILE_PATH];
        if (!product_path_below(path, w->r->from->folder, PRODUCT_VIEW,
                                &(struct product_key){.view = w->r->lenses.lenses[lens].view}, err))
            read_radiance(&w->before[i], path, &w->r->views[lens], w->exposure, err);
    }
    return err->status;
}

/* The photo itself, if it can be read: its merged exposures, or the file that people gave. */
static void read_rest(struct room_work *w, const struct photo_record *record, int height)
{
    const struct rooms_sources *from = w->r->from;
    char path[FILE_PATH];
    struct err none = ERR_INIT;
    struct photo photo = {0};
    if (contents_product(path, from->shared, PRODUCT_HDR, &(struct product_key){.photo = w->from->photo})) {
        relit_read_radiance(&w->rest, from->shared, PRODUCT_HDR, &(struct product_key){.photo = w->from->photo},
                            w->exposure, w->orientation, height, &none);
    } else if (from->photos && record->file && !file_path(path, from->photos, record->file, "", &none) &&
               !photo_read(&photo, path, &none)) {
        photo.info.orientation = w->orientation;
        picture_from_photo(&w->rest, &photo, height, &none);
    }
    photo_release(&photo);
    if (w->rest.width != w->whole.width || w->rest.height != w->whole.height) picture_release(&w->rest);
}

/* The photo before the change. What no view shows of it comes from the photo itself. */
static enum status make_before(struct picture *p, struct room_work *w, const struct photo_record *record,
                               struct err *err)
{
    bool all = true;
    w->covered = malloc((size_t)w->whole.width * (size_t)w->whole.height);
    if (!w->covered) return err_nomem(err, "a picture", (size_t)w->whole.width * (size_t)w->whole.height);
    if (whole_photo_picture(p, &w->whole, w->before, w->before, NULL, true, w->covered, err)) return err->status;
    for (size_t i = 0; i < (size_t)p->width * (size_t)p->height; i++) all &= w->covered[i];
    if (all) return ST_OK;
    read_rest(w, record, w->whole.height);
    if (!w->rest.rgb) return ST_OK;
    whole_photo_find_gain(w->gain, p, w->covered, &w->rest);
    whole_photo_fill(p, w->covered, &w->rest, w->gain);
    return ST_OK;
}

static enum status begin_room(struct picture *before, struct room_work *w, int height, struct err *err)
{
    const struct source_photo *from = w->from;
    const struct view *views = w->r->views + from->first;
    struct photo_record record = {0};
    struct err unknown = ERR_INIT; /* then the picture is upright as it is */
    char records[FILE_PATH];
    if (file_path(records, w->r->from->shared, "photos", "", err)) return err->status;
    w->orientation = 1;
    if (!photo_record_read(&record, records, from->photo, NULL, &unknown) && record.info.orientation > 1)
        w->orientation = record.info.orientation;
    w->before = calloc((size_t)from->count, sizeof *w->before);
    if (!w->before) err_nomem(err, "layers", (size_t)from->count * sizeof *w->before);
    if (!err->status && !read_before(w, err) &&
        !whole_photo_init(&w->whole, from->lenses, views, from->count, w->orientation, height, err) &&
        !whole_photo_init(&w->small, from->lenses, views, from->count, w->orientation,
                          (int)(sqrt(SIDE_SHARE) * w->whole.height), err))
        make_before(before, w, &record, err);
    photo_record_release(&record);
    return err->status;
}

static void room_work_release(struct room_work *w)
{
    layers_clear(w->before, w->from->count);
    free(w->before);
    free(w->covered);
    picture_release(&w->rest);
    whole_photo_release(&w->whole);
    whole_photo_release(&w->small);
}

/* The pictures of a photo. A change whose pictures cannot be read is left out; *problem says why. */
static void make_room(struct room_photo *p, const struct room_job *j, struct err *problem)
{
    struct room_work w = {.r = j->r, .from = source_of(j->r, p->photo)};
    int kept = 0;
    w.exposure = find_exposure(w.r, w.from);
    begin_room(&p->before, &w, j->height, problem);
    for (int k = 0; p->before.rgb && k < p->look_count; k++) {
        struct err failed = ERR_INIT;
        struct room_look look = p->looks[k];
        if (!make_look(&look, &w, &failed) && (look.after.rgb || look.relit.rgb)) {
            p->looks[kept++] = look;
            continue;
        }
        look_release(&look);
        if (failed.status) *problem = failed;
    }
    p->look_count = kept;
    room_work_release(&w);
}

static void make_rooms(void *ctx, size_t begin, size_t end, int thread)
{
    struct room_job *j = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) make_room(&j->r->rooms->photos[i], j, &j->errors[i]);
}

/* The height of the pictures, px: so that all of them fit in the budget. */
static int choose_height(const struct rooms_reading *r)
{
    double count = 0, aspect = 0;
    for (int i = 0; i < r->rooms->photo_count; i++) {
        const struct room_photo *p = &r->rooms->photos[i];
        const struct camera *camera = &source_of(r, p->photo)->lenses[0].camera;
        aspect += (double)camera->width / camera->height;
        count += 1;
        for (int k = 0; k < p->look_count; k++) {
            const struct room_look *look = &p->looks[k];
            count += (look->changed > 0) * (1 + SIDE_SHARE / 2) + (look->light > 0) * (1 + SIDE_SHARE);
        }
    }
    const double pixels = BUDGET / BYTES_A_PIXEL / fmax(count, 1);
    const double height = sqrt(pixels * fmax(r->rooms->photo_count, 1) / fmax(aspect, 1e-9));
    return (int)fmin(HIGHEST, fmax(LOWEST, height));
}

static enum status make_pictures(struct rooms_reading *r, struct err *err)
{
    struct rooms *rooms = r->rooms;
    struct room_job j = {r, choose_height(r), calloc((size_t)rooms->photo_count + 1, sizeof *j.errors)};
    if (!j.errors) return err_nomem(err, "photos", (size_t)rooms->photo_count * sizeof *j.errors);
    parallel_for((size_t)rooms->photo_count, 1, make_rooms, &j);
    int kept = 0;
    for (int i = 0; i < rooms->photo_count; i++) {
        struct room_photo p = rooms->photos[i];
        if (j.errors[i].status) note(rooms, "a picture is left out", &j.errors[i], err);
        if (p.before.rgb && p.look_count) {
            rooms->photos[kept++] = p;
            continue;
        }
        picture_release(&p.before);
        free(p.looks);
    }
    rooms->photo_count = kept;
    free(j.errors);
    return err->status;
}

static enum status read_rooms(struct rooms_reading *r, struct err *err)
{
    struct rooms *rooms = r->rooms;
    if (list_changes(r, err) || !rooms->change_count || !read_views(r, err) || read_table(r, err)) return err->status;
    count_photos(r);
    r->spread = find_spread(r);
    const int chosen = choose_photos(r);
    rooms->photos = calloc((size_t)chosen + 1, sizeof *rooms->photos);
    if (!rooms->photos) return err_nomem(err, "photos", (size_t)chosen * sizeof *rooms->photos);
    for (int i = 0; !err->status && i < r->photo_count; i++)
        if (r->photos[i].chosen) add_room(r, &r->photos[i], err);
    if (err->status) return err->status;
    if (chosen) qsort(rooms->photos, (size_t)chosen, sizeof *rooms->photos, compare_photos);
    return make_pictures(r, err);
}

enum status rooms_read(struct rooms *rooms, const struct rooms_sources *from, struct err *err)
{
    struct rooms_reading r = {.rooms = rooms, .from = from};
    read_rooms(&r, err);
    free(r.table);
    free(r.photos);
    free(r.views);
    camera_set_release(&r.cameras);
    lens_list_release(&r.lenses);
    return err->status;
}

void rooms_release(struct rooms *rooms)
{
    for (int i = 0; i < rooms->photo_count; i++) {
        struct room_photo *p = &rooms->photos[i];
        for (int k = 0; k < p->look_count; k++) look_release(&p->looks[k]);
        picture_release(&p->before);
        free(p->looks);
    }
    for (int i = 0; i < rooms->change_count; i++) free(rooms->changes[i].about);
    free(rooms->photos);
    free(rooms->changes);
    free(rooms->notes);
    *rooms = (struct rooms){0};
}
