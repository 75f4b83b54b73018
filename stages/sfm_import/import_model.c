/* import_model.c - see import_model.h.
 *
 * Overview: images are matched to photos by name; cameras are brought to the photos' size; every observation's
 * reprojection error is computed anew and outliers are dropped; each photo's lens becomes one pinhole view or several
 * (view_cameras.h); the remaining observations are taken through the lens to the views that see them; points that two
 * different photos still see are kept. */
#include "stages/sfm_import/import_model.h"

#include <float.h>
#include <inttypes.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/base/sort.h"
#include "common/base/textfile.h"
#include "common/capture/photo_match.h"
#include "stages/sfm_import/view_cameras.h"

#define PARAM_STRUCT struct import_params
const struct param import_param_table[] = {IMPORT_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

enum { FEW_POINTS = 10 };

static char *joined(const char *folder, const char *file, struct err *err)
{
    size_t size = strlen(folder) + strlen(file) + 2;
    char *path = malloc(size);
    if (!path)
        err_nomem(err, "a file name", size);
    else
        snprintf(path, size, "%s/%s", folder, file);
    return path;
}

/* Names on as many lines of the log as they need. */
struct name_lines {
    const char *before;
    char text[1024];
    size_t used;
};

static void name_lines_end(struct name_lines *l)
{
    if (l->used) log_note("%s: %s", l->before, l->text);
    l->used = 0;
}

static void name_lines_add(struct name_lines *l, const char *name)
{
    if (l->used && l->used + strlen(name) + 3 > sizeof l->text) name_lines_end(l);
    int n = snprintf(l->text + l->used, sizeof l->text - l->used, "%s%s", l->used ? ", " : "", name);
    l->used += (size_t)n < sizeof l->text - l->used ? (size_t)n : sizeof l->text - l->used - 1;
}

/* ------------------------------------------------------------------------------------------------- which model */

static int images_of_photos(const struct sfm_model *m, const struct photo_list *photos)
{
    int n = 0;
    for (int i = 0; i < m->image_count; i++) n += photo_list_match(photos, m->images[i].name) >= 0;
    return n;
}

enum status import_choose(struct sfm_model *model, char **name, const char *sfm, const struct photo_list *photos,
                          struct err *err)
{
    struct textfile t = {0};
    char *path = joined(sfm, "models.txt", err), *word = NULL;
    int64_t version = 0;
    int count = 0, best = -1;
    *model = (struct sfm_model){0};
    *name = NULL;
    enum status st = path ? textfile_open(&t, path, err) : err->status;
    if (!st && !textfile_next(&t)) st = textfile_error(&t, err, NULL, "\"remodel-sfm 1\"");
    if (!st) st = textfile_word(&t, "\"remodel-sfm\"", &word, err);
    if (!st && strcmp(word, "remodel-sfm")) st = textfile_error(&t, err, word, "\"remodel-sfm\"");
    if (!st) st = textfile_int(&t, "version", 1, 1, &version, err);
    if (!st) st = textfile_end(&t, err);
    while (!st && textfile_next(&t)) {
        struct sfm_model m = {0};
        char *folder = NULL, *format = NULL, *from = NULL;
        st = textfile_word(&t, "folder of a model", &folder, err);
        if (!st) st = textfile_word(&t, "its format", &format, err);
        if (!st) st = textfile_end(&t, err);
        if (!st && strcmp(format, "colmap")) st = textfile_error(&t, err, format, "\"colmap\"");
        if (!st && !(from = joined(sfm, folder, err))) st = err->status;
        if (!st) st = sfm_model_read_text(&m, from, err);
        free(from);
        if (st) break;
        int n = images_of_photos(&m, photos);
        log_note("model %s: %d images, %d of them photos of this scene, %d points", folder, m.image_count, n,
                 m.point_count);
        count++;
        if (n > best || (n == best && m.point_count > model->point_count)) {
            sfm_model_release(model);
            free(*name);
            *model = m;
            best = n;
            if (!(*name = strdup(folder))) st = err_nomem(err, "a name", strlen(folder) + 1);
        } else {
            sfm_model_release(&m);
        }
    }
    if (!st && !count) st = textfile_error(&t, err, NULL, "a line for each model");
    if (!st && count > 1) log_note("model %s is the largest of %d: it is used, the others are not", *name, count);
    textfile_release(&t);
    free(path);
    if (st) {
        sfm_model_release(model);
        free(*name);
        *name = NULL;
    }
    return st;
}

enum status import_check_photos(const char *sfm, const struct photo_list *photos, struct err *err)
{
    struct textfile t = {0};
    struct name_lines changed = {.before = "changed since structure from motion ran"};
    struct name_lines added = {.before = "new since structure from motion ran"};
    bool any = false;
    char *path = joined(sfm, "photos.txt", err);
    char *seen = calloc((size_t)photos->count + 1, 1);
    enum status st = path && seen ? ST_OK : err_nomem(err, "marks", (size_t)photos->count);
    if (!st) st = textfile_open(&t, path, err);
    while (!st && textfile_next(&t)) {
        char *id = NULL, *hash = NULL;
        st = textfile_word(&t, "id of a photo", &id, err);
        if (!st) st = textfile_word(&t, "hash of a photo", &hash, err);
        if (!st) st = textfile_end(&t, err);
        int at = st ? -1 : photo_list_find_id(photos, id);
        if (at < 0) continue;
        seen[at] = 1;
        if (!strcmp(hash, photos->photos[at].hash)) continue;
        name_lines_add(&changed, photos->photos[at].file);
        any = true;
    }
    for (int i = 0; !st && i < photos->count; i++)
        if (!seen[i]) {
            name_lines_add(&added, photos->photos[i].file);
            any = true;
        }
    if (!st && any) log_warn("cameras were found from other photos than there are now; make resfm finds them anew");
    if (!st) name_lines_end(&changed);
    if (!st) name_lines_end(&added);
    textfile_release(&t);
    free(path);
    free(seen);
    return st;
}

/* --------------------------------------------------------------------------------------------- images and photos */

struct input_image {
    int photo;               /* -1: not one of the scene's */
    struct camera lens;      /* at the photo's size */
    double scale_u, scale_v; /* of observations */
    struct mat3 cam_from_world;
    struct vec3 translation;
    int views[MOST_PARTS], view_count; /* into importer.views */
};

struct output_view {
    char *name;
    int image, photo;
    struct photo_view view;
    double fx, fy, cx, cy;
    struct mat3 view_from_photo;
    int observation_room;
};

struct importer {
    const struct sfm_model *in;
    const struct photo_list *photos;
    const struct import_params *params;
    struct input_image *images;
    struct output_view *views;
    int view_count;
    double *errors; /* of each track entry, in order; INFINITY: behind the camera or outside its lens; -1: no photo */
};

static enum status match_photos(struct importer *imp, struct import_stats *stats, struct err *err)
{
    const struct photo_list *photos = imp->photos;
    int *image_of = malloc(((size_t)photos->count + 1) * sizeof *image_of);
    struct name_lines strangers = {.before = "images of the model that are none of the photos, left out"};
    struct name_lines missing = {.before = "not placed"};
    enum status st = ST_OK;
    if (!image_of) return err_nomem(err, "photos", (size_t)photos->count * sizeof *image_of);
    for (int i = 0; i < photos->count; i++) image_of[i] = -1;
    for (int i = 0; !st && i < imp->in->image_count; i++) {
        int photo = imp->images[i].photo = photo_list_match(photos, imp->in->images[i].name);
        if (photo < 0) {
            name_lines_add(&strangers, imp->in->images[i].name);
            stats->strangers++;
        } else if (image_of[photo] >= 0) {
            st = err_set(err, ST_DATA,
                         "images \"%s\" and \"%s\" of the model are both named like photo \"%s\"; give photos of "
                         "different folders different names, in the model too.",
                         imp->in->images[image_of[photo]].name, imp->in->images[i].name, photos->photos[photo].file);
        } else {
            image_of[photo] = i;
            stats->registered++;
        }
    }
    for (int i = 0; i < photos->count; i++)
        if (image_of[i] < 0) name_lines_add(&missing, photos->photos[i].file);
    stats->unregistered = photos->count - stats->registered;
    if (!st) {
        name_lines_end(&strangers);
        log_note("%d of %d photos are placed", stats->registered, photos->count);
        if (stats->unregistered && stats->registered) {
            name_lines_end(&missing);
            log_note("what is not placed shares too little with the other photos: it overlaps too little with them, is "
                     "blurred, or shows little texture; photos taken in between help");
        }
    }
    if (!st && stats->registered == 0)
        st = err_set(err, ST_DATA,
                     "none of the model's %d images, \"%s\" the first, is named like a photo of the scene, \"%s\" the "
                     "first; give "
                     "the model of these photos.",
                     imp->in->image_count, imp->in->images[0].name, photos->count ? photos->photos[0].file : "");
    if (!st && stats->registered < 2)
        st =
            err_set(err, ST_DATA,
                    "the model places only %d of %d photos, and depth needs at least 2; take more photos, each showing "
                    "most of what its neighbours show, from places a step apart.",
                    stats->registered, photos->count);
    free(image_of);
    return st;
}

/* Model and photo may differ by one ratio of both sides, to the half pixel (of the smaller) that rounding leaves. */
static bool same_shape(const struct camera *c, int width, int height)
{
    double ratio = (double)width / c->width, other = (double)height / c->height;
    bool shrunk = ratio < 1;
    double off = shrunk ? fmin(fabs(c->height * ratio - height), fabs(c->width * other - width))
                        : fmin(fabs(height / ratio - c->height), fabs(width / other - c->width));
    return off <= 0.5;
}

static enum status fit_lens(struct input_image *im, const struct camera *c, const struct photo_record *photo,
                            struct err *err)
{
    int w = photo->info.width, h = photo->info.height;
    im->lens = *c;
    im->scale_u = im->scale_v = 1;
    if (c->width == w && c->height == h) return ST_OK;
    if (!same_shape(c, w, h))
        return err_set(
            err, ST_DATA,
            "the model's camera for photo \"%s\" is %d x %d px, but the photo is %d x %d px; the model must be of the "
            "photos as they are stored (not cropped, undistorted or turned).",
            photo->file, c->width, c->height, w, h);
    im->scale_u = (double)w / c->width;
    im->scale_v = (double)h / c->height;
    double *p = im->lens.params, both = sqrt(im->scale_u * im->scale_v), fx, fy, cx, cy;
    bool single = camera_model_params(c->model) < 6 && c->model != CAMERA_PINHOLE;
    camera_focal(c, &fx, &fy, &cx, &cy);
    p[0] = fx * (single ? both : im->scale_u);
    if (!single) p[1] = fy * im->scale_v;
    p[single ? 1 : 2] = cx * im->scale_u;
    p[single ? 2 : 3] = cy * im->scale_v;
    im->lens.width = w;
    im->lens.height = h;
    return ST_OK;
}

static enum status fit_lenses(struct importer *imp, struct err *err)
{
    int scaled = 0, last = 0;
    for (int i = 0; i < imp->in->image_count; i++) {
        struct input_image *im = &imp->images[i];
        const struct sfm_image *from = &imp->in->images[i];
        im->cam_from_world = mat3_from_quat(from->cam_from_world.rotation);
        im->translation = from->cam_from_world.translation;
        if (im->photo < 0) continue;
        if (fit_lens(im, &imp->in->cameras[from->camera_idx].camera, &imp->photos->photos[im->photo], err))
            return err->status;
        if (im->scale_u != 1 || im->scale_v != 1) {
            scaled++;
            last = i;
        }
    }
    if (scaled)
        log_note("the model is of %s pictures: cameras and observations of %d photos are scaled (\"%s\" by %.6g)",
                 imp->images[last].scale_u > 1 ? "smaller" : "larger", scaled,
                 imp->photos->photos[imp->images[last].photo].file, imp->images[last].scale_u);
    return ST_OK;
}

/* --------------------------------------------------------------------------------------------- reprojection errors */

static double reprojection_error(const struct input_image *im, const struct sfm_observation *o, struct vec3 world)
{
    struct vec3 p = vec3_add(mat3_apply(im->cam_from_world, world), im->translation);
    double u, v;
    if (!camera_project(&im->lens, p, &u, &v)) return INFINITY;
    return hypot(u - o->u * im->scale_u, v - o->v * im->scale_v);
}

static enum status check_errors(struct importer *imp, struct import_stats *stats, struct err *err)
{
    const struct sfm_model *m = imp->in;
    long long total = 0, finite = 0, at = 0;
    double sum = 0, model_sum = 0, stated = 0, stated_weight = 0;
    for (int i = 0; i < m->point_count; i++) total += m->points[i].track_count;
    imp->errors = malloc(((size_t)total + 1) * sizeof *imp->errors);
    double *sorted = malloc(((size_t)total + 1) * sizeof *sorted);
    if (!imp->errors || !sorted) {
        free(sorted);
        return err_nomem(err, "reprojection errors", (size_t)total * sizeof *sorted);
    }
    for (int i = 0; i < m->point_count; i++) {
        const struct sfm_point *p = &m->points[i];
        for (int k = 0; k < p->track_count; k++, at++) {
            const struct input_image *im = &imp->images[p->track[k].image_idx];
            const struct sfm_observation *o =
                &m->images[p->track[k].image_idx].observations[p->track[k].observation_idx];
            double e = im->photo < 0 ? -1 : reprojection_error(im, o, p->position);
            imp->errors[at] = e;
            if (e < 0) continue;
            stats->observations++;
            if (e > imp->params->max_error) stats->dropped++;
            if (e < INFINITY) {
                sorted[finite++] = e;
                sum += e;
                model_sum += e / sqrt(im->scale_u * im->scale_v);
            }
        }
        if (p->error >= 0 && p->track_count) {
            stated += p->error * p->track_count;
            stated_weight += p->track_count;
        }
    }
    if (finite) {
        sort_doubles(sorted, (size_t)finite);
        stats->mean_error = sum / (double)finite;
        stats->median_error = (sorted[(finite - 1) / 2] + sorted[finite / 2]) / 2;
    }
    stats->stated_error = stated_weight > 0 ? stated / stated_weight : -1;
    if (model_sum > 0 && stated_weight > 0) stats->stated_error *= sum / model_sum; /* to pixels of the photos */
    free(sorted);
    return ST_OK;
}

static enum status judge_errors(const struct import_stats *stats, const struct import_params *params, struct err *err)
{
    if (!stats->observations) {
        log_warn("the model has no point that these photos see; depth will have nothing to start from");
        return ST_OK;
    }
    if (stats->dropped == stats->observations)
        return err_set(
            err, ST_DATA,
            "none of the model's %lld observations lies within %g px of where its cameras see the point; cameras and "
            "points do not belong together, or follow other conventions than COLMAP's.",
            stats->observations, params->max_error);
    log_note("reprojection error, computed anew: mean %.3f px, median %.3f px over %lld observations",
             stats->mean_error, stats->median_error, stats->observations);
    if (stats->dropped)
        log_note("%lld observations are dropped: behind their camera, outside its lens or more than %g px off",
                 stats->dropped, params->max_error);
    if (stats->stated_error > 0 &&
        (stats->mean_error > 2 * stats->stated_error || 2 * stats->mean_error < stats->stated_error))
        log_warn(
            "the model states a mean reprojection error of %.3f px, but it is %.3f px; was it made by another program, "
            "or changed by hand?",
            stats->stated_error, stats->mean_error);
    if (2 * stats->dropped > stats->observations)
        log_warn("more than half of the observations are dropped: the model fits these photos badly");
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------ the views */

static int compare_views(const void *a, const void *b)
{
    return strcmp(((const struct output_view *)a)->name, ((const struct output_view *)b)->name);
}

static enum status make_views(struct importer *imp, struct err *err)
{
    size_t most = (size_t)imp->in->image_count * MOST_PARTS;
    int wide = 0;
    imp->views = calloc(most + 1, sizeof *imp->views);
    if (!imp->views) return err_nomem(err, "views", most * sizeof *imp->views);
    for (int i = 0; i < imp->in->image_count; i++) {
        const struct input_image *im = &imp->images[i];
        struct photo_view parts[MOST_PARTS];
        int count = 0;
        if (im->photo < 0) continue;
        const struct photo_record *photo = &imp->photos->photos[im->photo];
        if (photo_views(parts, &count, &im->lens, imp->params->max_megapixels, imp->params->max_field, err))
            return err_context(err, "photo \"%s\"", photo->file);
        wide += parts[0].part >= 0;
        for (int k = 0; k < count; k++) {
            struct output_view *v = &imp->views[imp->view_count++];
            size_t size = strlen(photo->id) + 4;
            *v = (struct output_view){.image = i, .photo = im->photo, .view = parts[k]};
            camera_focal(&v->view.camera, &v->fx, &v->fy, &v->cx, &v->cy);
            v->view_from_photo = mat3_from_quat(v->view.view_from_photo);
            if (!(v->name = malloc(size))) return err_nomem(err, "a view's name", size);
            if (parts[k].part < 0)
                snprintf(v->name, size, "%s", photo->id);
            else
                snprintf(v->name, size, "%s@%d", photo->id, parts[k].part);
        }
    }
    qsort(imp->views, (size_t)imp->view_count, sizeof *imp->views, compare_views);
    for (int i = 0; i < imp->view_count; i++) {
        struct input_image *im = &imp->images[imp->views[i].image];
        im->views[im->view_count++] = i;
    }
    if (wide)
        log_note("%d photos have a field of view of more than %g degrees and become several views each", wide,
                 imp->params->max_field);
    return ST_OK;
}

static struct quat quat_multiply(struct quat a, struct quat b)
{
    return (struct quat){a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                         a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

static enum status make_cameras(const struct importer *imp, struct imported *out, struct err *err)
{
    size_t n = (size_t)imp->view_count;
    struct sfm_model *m = &out->model;
    m->cameras = calloc(n, sizeof *m->cameras);
    m->images = calloc(n, sizeof *m->images);
    out->lenses.lenses = calloc(n, sizeof *out->lenses.lenses);
    if (!m->cameras || !m->images || !out->lenses.lenses) return err_nomem(err, "views", n * sizeof *m->images);
    for (int i = 0; i < imp->view_count; i++) {
        const struct output_view *v = &imp->views[i];
        const struct pose *photo = &imp->in->images[v->image].cam_from_world;
        struct sfm_image *im = &m->images[m->image_count++];
        struct lens *l = &out->lenses.lenses[out->lenses.count++];
        size_t size = strlen(v->name) + 5;
        m->cameras[m->camera_count++] = (struct sfm_camera){i + 1, v->view.camera};
        im->id = i + 1;
        im->camera_idx = i;
        im->cam_from_world = *photo;
        if (v->view.part > 0) {
            im->cam_from_world.rotation = quat_multiply(v->view.view_from_photo, photo->rotation);
            im->cam_from_world.translation = mat3_apply(v->view_from_photo, photo->translation);
        }
        l->camera = imp->images[v->image].lens;
        l->view_from_photo = v->view.view_from_photo;
        im->name = malloc(size);
        l->view = strdup(v->name);
        l->photo = strdup(imp->photos->photos[v->photo].id);
        if (!im->name || !l->view || !l->photo) return err_nomem(err, "names", size);
        snprintf(im->name, size, "%s.exr", v->name);
    }
    return ST_OK;
}

/* ----------------------------------------------------------------------------------------------------- the points */

struct sighting { /* of one point in one view, in rectified pixels */
    int view, image;
    double u, v;
};

static int compare_sightings(const void *a, const void *b)
{
    const struct sighting *x = a, *y = b;
    if (x->view != y->view) return x->view < y->view ? -1 : 1;
    if (x->u != y->u) return x->u < y->u ? -1 : 1;
    return (x->v > y->v) - (x->v < y->v);
}

static bool same_camera(const struct camera *a, const struct camera *b)
{
    return a->model == b->model && a->width == b->width && a->height == b->height &&
           !memcmp(a->params, b->params, (size_t)camera_model_params(a->model) * sizeof *a->params);
}

/* Takes an observation of a photo to a pixel of one of its views. False: the view does not show it. */
static bool rectify_observation(const struct importer *imp, const struct sfm_observation *o, int view,
                                struct sighting *s)
{
    const struct output_view *out = &imp->views[view];
    const struct input_image *im = &imp->images[out->image];
    const struct camera *c = &out->view.camera;
    double u = o->u * im->scale_u, v = o->v * im->scale_v;
    struct vec3 ray;
    if (out->view.part > 0 || !same_camera(c, &im->lens)) {
        if (!camera_unproject(&im->lens, u, v, &ray)) return false;
        ray = mat3_apply(out->view_from_photo, ray);
        if (!(ray.z > 0)) return false;
        u = out->fx * (ray.x / ray.z) + out->cx;
        v = out->fy * (ray.y / ray.z) + out->cy;
    }
    *s = (struct sighting){view, out->image, u, v};
    return u >= 0 && v >= 0 && u <= c->width && v <= c->height;
}

static enum status add_observation(struct importer *imp, struct sfm_model *m, const struct sighting *s, int64_t id,
                                   struct err *err)
{
    struct sfm_image *im = &m->images[s->view];
    int *room = &imp->views[s->view].observation_room;
    if (im->observation_count == *room) {
        int more = *room ? *room + *room / 2 : 64;
        void *p = realloc(im->observations, (size_t)more * sizeof *im->observations);
        if (!p) return err_nomem(err, "observations", (size_t)more * sizeof *im->observations);
        im->observations = p;
        *room = more;
    }
    im->observations[im->observation_count++] = (struct sfm_observation){s->u, s->v, id};
    return ST_OK;
}

static enum status add_point(struct importer *imp, struct sfm_model *m, const struct sfm_point *p,
                             const struct sighting *sightings, int count, double error, struct err *err)
{
    struct sfm_point *out = &m->points[m->point_count];
    *out = *p;
    out->error = error;
    out->track_count = 0;
    out->track = malloc((size_t)count * sizeof *out->track);
    if (!out->track) return err_nomem(err, "a track", (size_t)count * sizeof *out->track);
    m->point_count++;
    for (int i = 0; i < count; i++) {
        if (add_observation(imp, m, &sightings[i], p->id, err)) return err->status;
        out->track[out->track_count++] =
            (struct sfm_track){sightings[i].view, m->images[sightings[i].view].observation_count - 1};
    }
    return ST_OK;
}

static enum status make_points(struct importer *imp, struct imported *out, struct err *err)
{
    const struct sfm_model *in = imp->in;
    struct sighting *sightings = NULL;
    int longest = 0;
    for (int i = 0; i < in->point_count; i++)
        if (in->points[i].track_count > longest) longest = in->points[i].track_count;
    if (!longest) return ST_OK;
    sightings = malloc((size_t)longest * MOST_PARTS * sizeof *sightings);
    out->model.points = malloc((size_t)in->point_count * sizeof *out->model.points);
    enum status st = ST_OK;
    if (!sightings || !out->model.points)
        st = err_nomem(err, "points", (size_t)in->point_count * sizeof *out->model.points);
    const double *error = imp->errors;
    for (int i = 0; !st && i < in->point_count; i++) {
        const struct sfm_point *p = &in->points[i];
        double sum = 0;
        int kept = 0, count = 0;
        for (int k = 0; k < p->track_count; k++, error++) {
            const struct sfm_track *t = &p->track[k];
            const struct input_image *im = &imp->images[t->image_idx];
            if (*error < 0 || *error > imp->params->max_error) continue;
            sum += *error;
            kept++;
            for (int j = 0; j < im->view_count; j++)
                count += rectify_observation(imp, &in->images[t->image_idx].observations[t->observation_idx],
                                             im->views[j], &sightings[count]);
        }
        bool two_photos = false;
        for (int k = 1; k < count; k++) two_photos |= sightings[k].image != sightings[0].image;
        if (!two_photos) continue;
        qsort(sightings, (size_t)count, sizeof *sightings, compare_sightings);
        st = add_point(imp, &out->model, p, sightings, count, sum / kept, err);
    }
    free(sightings);
    return st;
}

static void warn_of_few_points(const struct importer *imp, const struct sfm_model *m)
{
    for (int i = 0; i < imp->in->image_count && m->point_count; i++) {
        const struct input_image *im = &imp->images[i];
        int seen = 0;
        for (int k = 0; k < im->view_count; k++) seen += m->images[im->views[k]].observation_count;
        if (im->view_count && seen < FEW_POINTS)
            log_warn("photo \"%s\" sees only %d points of the model; its depth may be poor",
                     imp->photos->photos[im->photo].file, seen);
    }
}

enum status import_model(struct imported *out, const struct sfm_model *model, const struct photo_list *photos,
                         const struct import_params *params, struct err *err)
{
    struct importer imp = {.in = model, .photos = photos, .params = params};
    struct import_stats *stats = &out->stats;
    *out = (struct imported){0};
    enum status st = ST_OK;
    imp.images = calloc((size_t)model->image_count + 1, sizeof *imp.images);
    if (!imp.images) st = err_nomem(err, "images", (size_t)model->image_count * sizeof *imp.images);
    if (!st) st = match_photos(&imp, stats, err);
    if (!st) st = fit_lenses(&imp, err);
    if (!st) st = check_errors(&imp, stats, err);
    if (!st) st = judge_errors(stats, params, err);
    if (!st) st = make_views(&imp, err);
    if (!st) st = make_cameras(&imp, out, err);
    if (!st) st = make_points(&imp, out, err);
    if (!st) {
        stats->points = out->model.point_count;
        stats->points_dropped = model->point_count - out->model.point_count;
        warn_of_few_points(&imp, &out->model);
        log_note("%d views of %d photos, %d points (%d that fewer than two photos still see are left out)",
                 imp.view_count, stats->registered, stats->points, stats->points_dropped);
    }
    for (int i = 0; i < imp.view_count; i++) free(imp.views[i].name);
    free(imp.views);
    free(imp.images);
    free(imp.errors);
    if (st) imported_release(out);
    return st;
}

/* -------------------------------------------------------------------------------------------------------- writing */

static enum status write_views_mk(const struct imported *in, const char *path, struct err *err)
{
    struct outfile f = {0};
    enum status st = outfile_open(&f, path, err);
    if (!st) {
        fputs("VIEWS :=", f.fp);
        for (int i = 0; i < in->lenses.count; i++) fprintf(f.fp, " %s", in->lenses.lenses[i].view);
        fputc('\n', f.fp);
        st = outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return st;
}

enum status imported_write(const struct imported *in, const char *folder, const struct provenance *prov,
                           struct err *err)
{
    char *lenses = joined(folder, "lenses.txt", err), *views = joined(folder, "views.mk", err);
    enum status st = lenses && views ? ST_OK : err->status;
    if (!st) st = sfm_model_write_text(&in->model, folder, prov, err);
    if (!st) st = lens_list_write(&in->lenses, lenses, prov, err);
    if (!st) st = write_views_mk(in, views, err);
    free(lenses);
    free(views);
    return st;
}

void imported_release(struct imported *in)
{
    if (!in) return;
    sfm_model_release(&in->model);
    lens_list_release(&in->lenses);
    *in = (struct imported){0};
}
