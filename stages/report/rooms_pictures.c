/* rooms_pictures.c - pictures of photos before and after changes.
 *
 * BUDGET bytes hold all pictures of a page: their number says how many pixels each may have, at the BYTES_A_PIXEL that
 * rooms take as JPEG.
 *
 * A picture of a whole photo is put together from those of its views. A view that a change leaves alone has no picture
 * of it: there the view itself stands. What no view shows, as the corners of a fisheye, comes from the photo. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/capture/photo_list.h"
#include "common/texture/picture_made.h"
#include "stages/report/contents_parts.h"
#include "stages/report/rooms_parts.h"
#include "stages/report/whole_photo.h"

enum { HIGHEST = 720, LOWEST = 300, BUDGET = 5000000 };
static const double BYTES_A_PIXEL = 0.13;
static const double SIDE_SHARE = 0.25; /* of a picture's area: pictures of origins and of ratios */

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
            const struct view_change *v = rooms_change_of(r, e, i);
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
    const struct view_change *v = rooms_change_of(r, change, lens);
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
        rooms_look_release(&look);
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

enum status rooms_make_pictures(struct rooms_reading *r, struct err *err)
{
    struct rooms *rooms = r->rooms;
    struct room_job j = {r, choose_height(r), calloc((size_t)rooms->photo_count + 1, sizeof *j.errors)};
    if (!j.errors) return err_nomem(err, "photos", (size_t)rooms->photo_count * sizeof *j.errors);
    parallel_for((size_t)rooms->photo_count, 1, make_rooms, &j);
    int kept = 0;
    for (int i = 0; i < rooms->photo_count; i++) {
        struct room_photo p = rooms->photos[i];
        if (j.errors[i].status) rooms_note(rooms, "a picture is left out", &j.errors[i], err);
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
