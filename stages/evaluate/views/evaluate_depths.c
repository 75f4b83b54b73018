/* evaluate_depths.c - depth maps against true depths: depth.*; the definitions are in docs/evaluation.md.
 *
 * Overview. A depth map states one depth a pixel here: that of the layer with more alpha. It is brought into the
 * unit of the truth by the scale of the similarity of the cameras, and compared with the true depth at the same
 * pixel. The errors of a view go into the table under its name, and into the totals of the scene.
 *
 * True depths belong to photographs, depth maps to rectified views. The points of a photo are computed once and used
 * for all its views: true_depth_in_view() projects them through the photo's lens into each.
 *
 * A point is occluded if no other kept photo sees it (true_depth.h). Stereo can only guess its depth, so the metrics
 * with the ending _visible leave it out. The other photos are tried from the nearest one on, because a neighbour
 * most likely sees the point.
 *
 * Disparity. bad1 and bad2 count pixels whose disparity f B / z is wrong by more than 1 or 2 px. A set of photos has
 * no one baseline, so B is the median over the photos of the true distance to the nearest other one, and f is that
 * of a picture with a long side of [evaluate] disparity_side: results do not depend on the size of the pictures.
 *
 * Stated uncertainties are judged by the share of pixels within 1, 2 and 3 standard deviations, and by the factor
 * that would bring 68.27 % within one (sigma_error.h); and by the shares in each fifth of the pixels, from the smallest
 * deviations to the largest (sigma_bins.h).
 *
 * Memory: the points of one photo and the planes of one view. Quantiles come from histograms (quantiles.h). */
#include "stages/evaluate/views/views_metrics.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/progress.h"
#include "common/base/sort.h"
#include "common/capture/view_image.h"
#include "common/image/exr.h"
#include "common/layers/layered_depth.h"
#include "stages/evaluate/views/depth_error.h"
#include "stages/evaluate/views/sigma_bins.h"
#include "stages/evaluate/views/sigma_error.h"

/* kept[i]: photo i has a view and a true camera. */
static void mark_kept(const struct evaluation *e, bool *kept)
{
    for (int i = 0; i < e->views.cameras.view_count; i++) {
        int photo = evaluation_photo(e, &e->views, i);
        kept[photo] = e->truth.photos[photo].lens.width > 0;
    }
}

/* e->baseline: the parameter, or else the median over kept photos of the true distance to the nearest other one. */
static enum status find_baseline(struct evaluation *e, const bool *kept, struct err *err)
{
    double *distances = malloc(((size_t)e->photos.count + 1) * sizeof *distances);
    int count = 0;
    if (!distances) return err_nomem(err, "distances", (size_t)e->photos.count * sizeof *distances);
    for (int i = 0; i < e->photos.count; i++) {
        double nearest = INFINITY;
        for (int j = 0; kept[i] && j < e->photos.count; j++)
            if (j != i && kept[j])
                nearest = fmin(nearest, vec3_length(vec3_sub(pose_center(&e->truth.photos[i].pose),
                                                             pose_center(&e->truth.photos[j].pose))));
        if (nearest > 0 && nearest < INFINITY) distances[count++] = nearest;
    }
    e->baseline = e->params->baseline > 0 ? e->params->baseline : count ? sort_median(distances, (size_t)count) : 0;
    free(distances);
    return ST_OK;
}

struct neighbour {
    const struct true_photo *photo;
    double distance;
    int idx;
};

static int compare_neighbours(const void *a, const void *b)
{
    const struct neighbour *x = a, *y = b;
    if (x->distance != y->distance) return x->distance < y->distance ? -1 : 1;
    return x->idx - y->idx;
}

static enum status occlusion_of(const struct evaluation *e, int photo, const bool *kept, const struct vec3 *points,
                                uint8_t *occluded, struct err *err)
{
    const struct true_photo *self = &e->truth.photos[photo];
    const size_t capacity = (size_t)e->photos.count + 1;
    struct neighbour *list = malloc(capacity * sizeof *list);
    const struct true_photo **others = malloc(capacity * sizeof *others);
    int count = 0;
    if (!list || !others) err_nomem(err, "neighbours", capacity * sizeof *list);
    for (int j = 0; !err->status && j < e->photos.count; j++) {
        const struct true_photo *p = &e->truth.photos[j];
        if (j != photo && kept[j])
            list[count++] =
                (struct neighbour){p, vec3_length(vec3_sub(pose_center(&p->pose), pose_center(&self->pose))), j};
    }
    if (!err->status) {
        qsort(list, (size_t)count, sizeof *list, compare_neighbours);
        for (int j = 0; j < count; j++) others[j] = list[j].photo;
        true_occlusion(occluded, self, points, others, count, err);
    }
    free(list);
    free(others);
    return err->status;
}

/* What a depth map states of each pixel, by the layer with more alpha. */
struct stated_depth {
    float *z;         /* 0: none; in scene units, then in those of the truth */
    float *sigma;     /* depth_sigma() */
    uint8_t *classes; /* enum depth_class */
};

static enum status stated_depth_init(struct stated_depth *s, size_t pixels, struct err *err)
{
    s->z = malloc(pixels * sizeof *s->z);
    s->sigma = malloc(pixels * sizeof *s->sigma);
    s->classes = malloc(pixels);
    return s->z && s->sigma && s->classes ? ST_OK : err_nomem(err, "a depth map", pixels * 9);
}

static void stated_depth_release(struct stated_depth *s)
{
    free(s->z);
    free(s->sigma);
    free(s->classes);
}

/* Adds the view's pixels to *pixels, those with a depth to *known. */
static void visible_depth(struct stated_depth *s, const struct layered_depth *d, uint64_t *pixels, uint64_t *known)
{
    for (size_t i = 0; i < (size_t)d->width * (size_t)d->height; i++) {
        const float a = d->interior.rgba[4 * i + 3], b = d->boundary.rgba[4 * i + 3];
        const struct layer *layer = a >= b ? &d->interior : &d->boundary;
        const uint32_t id = layer->id[i];
        s->z[i] = a + b > 0 ? layer->z[i] : 0;
        s->sigma[i] = id ? (float)depth_sigma(&d->segments[id - 1]) : 0;
        s->classes[i] = id ? (uint8_t)depth_class(d->segments[id - 1].confidence) : DEPTH_CLASSES;
        *pixels += a + b > 0;
        *known += s->z[i] > 0;
    }
}

static double percent(uint64_t part, uint64_t whole) { return 100 * (double)part / (double)whole; }

static enum status add_tally(struct metric_table *t, const char *view, const struct depth_tally *d, const char *suffix,
                             bool disparity, struct err *err)
{
    static const double PARTS[3] = {0.50, 0.90, 0.95};
    char name[64];
    snprintf(name, sizeof name, "depth.bad1%s", suffix);
    if (disparity && metric_add(t, view, name, percent(d->bad1, d->pixels), err)) return err->status;
    snprintf(name, sizeof name, "depth.bad2%s", suffix);
    if (disparity && metric_add(t, view, name, percent(d->bad2, d->pixels), err)) return err->status;
    for (int k = 0; k < 3 && d->known; k++) {
        snprintf(name, sizeof name, "depth.error%.0f%s", 100 * PARTS[k], suffix);
        if (metric_add(t, view, name, 100 * quantiles_get(&d->errors, PARTS[k]), err)) return err->status;
    }
    snprintf(name, sizeof name, "depth.within2%s", suffix);
    if (d->known && metric_add(t, view, name, percent(d->within2, d->known), err)) return err->status;
    return ST_OK;
}

static enum status add_depth_errors(struct evaluation *e, const char *view, const struct depth_errors *d,
                                    struct err *err)
{
    struct metric_table *t = &e->table;
    if (!d->all.pixels) return ST_OK;
    if (add_tally(t, view, &d->all, "", e->baseline > 0, err) ||
        metric_add(t, view, "depth.occluded", percent(d->all.pixels - d->visible.pixels, d->all.pixels), err))
        return err->status;
    return d->visible.pixels ? add_tally(t, view, &d->visible, "_visible", e->baseline > 0, err) : ST_OK;
}

/* The true depth for the page: Z in scene units, and the mask of occluded pixels. */
static enum status write_truth(const struct evaluation *e, const struct view *view, const float *truth,
                               const uint8_t *occluded, struct err *err)
{
    struct exr_image im = {0};
    struct exr_plane *z = NULL, *o = NULL;
    char path[FILE_PATH];
    size_t pixels = (size_t)view->width * (size_t)view->height;
    if (evaluation_path(path, e, PRODUCT_TRUTH_DEPTH, &(struct product_key){.view = view->name}, err) ||
        exr_image_init(&im, view->width, view->height, err) || exr_add_plane(&im, "Z", EXR_FLOAT, &z, err) ||
        exr_add_plane(&im, "occluded", EXR_UINT, &o, err)) {
        exr_image_release(&im);
        return err->status;
    }
    z = exr_find(&im, "Z");
    for (size_t i = 0; i < pixels; i++) {
        z->f[i] = (float)(truth[i] / e->truth_from_scene.scale);
        o->u[i] = occluded[i];
    }
    view_image_set_camera(&im, view);
    struct provenance prov = *e->prov; /* shares its arrays with e->prov */
    prov.count = e->shared_inputs;
    exr_write(&im, path, &prov, err);
    exr_image_release(&im);
    return err->status;
}

struct photo_truth { /* true points of a photo, which all its views use */
    int photo;
    struct vec3 *points;
    uint8_t *occluded;
};

static void photo_truth_release(struct photo_truth *v)
{
    free(v->points);
    free(v->occluded);
    *v = (struct photo_truth){.photo = -1};
}

static enum status photo_truth_make(struct photo_truth *v, const struct evaluation *e, int photo, const bool *kept,
                                    struct err *err)
{
    const struct true_photo *p = &e->truth.photos[photo];
    size_t pixels = (size_t)p->lens.width * (size_t)p->lens.height;
    if (v->photo == photo) return ST_OK;
    photo_truth_release(v);
    v->points = malloc(pixels * sizeof *v->points);
    v->occluded = malloc(pixels);
    if (!v->points || !v->occluded) return err_nomem(err, "true points", pixels * sizeof *v->points);
    true_points(v->points, p);
    v->photo = photo;
    return occlusion_of(e, photo, kept, v->points, v->occluded, err);
}

struct scene_errors { /* of all views */
    struct depth_errors depths, model_depths;
    struct sigma_errors sigmas;
    struct sigma_bins bins, model_bins;
    uint64_t pixels, known;
};

/* Adds the relative errors of inverse depth. s->z is in the units of the truth. */
static void add_to_bins(struct sigma_bins *bins, const struct stated_depth *s, const float *truth, size_t pixels)
{
    for (size_t k = 0; k < pixels; k++)
        if (truth[k] > 0 && s->z[k] > 0 && s->classes[k] < DEPTH_CLASSES)
            sigma_bins_add(bins, (double)s->sigma[k], fabs(1 - (double)s->z[k] / (double)truth[k]));
}

/* Adds the errors of the view's depth from the round that knows the model, if there is one. s: room for it. */
static enum status compare_model_depth(struct evaluation *e, const struct view *view, struct stated_depth *s,
                                       const float *truth, const uint8_t *occluded, double focal_baseline,
                                       struct scene_errors *scene, struct err *err)
{
    const size_t pixels = (size_t)view->width * (size_t)view->height;
    struct layered_depth d = {0};
    uint64_t here = 0, known = 0;
    char path[FILE_PATH];
    evaluation_path(path, e, PRODUCT_DEPTH, &(struct product_key){.depth = MODEL_DEPTH, .view = view->name}, err);
    if (err->status || !path_is_file(path)) return err->status;
    if (!layered_depth_read(&d, path, e->prov, err) && d.width == view->width && d.height == view->height) {
        visible_depth(s, &d, &here, &known);
        for (size_t k = 0; k < pixels; k++) s->z[k] = (float)(s->z[k] * e->truth_from_scene.scale);
        depth_errors_add(&scene->model_depths, s->z, truth, occluded, pixels, focal_baseline);
        add_to_bins(&scene->model_bins, s, truth, pixels);
    }
    layered_depth_release(&d);
    return err->status;
}

/* Adds the errors of a view's depth map to the table and to `scene`. s->z is overwritten. */
static enum status compare_depth(struct evaluation *e, int i, struct photo_truth *tv, struct stated_depth *s,
                                 struct scene_errors *scene, struct err *err)
{
    const struct view *view = &e->views.cameras.views[i];
    size_t pixels = (size_t)view->width * (size_t)view->height;
    struct depth_errors errors = {0};
    float *truth = malloc(pixels * sizeof *truth);
    uint8_t *occluded = malloc(pixels);
    if (truth && occluded)
        depth_errors_init(&errors, err);
    else
        err_nomem(err, "true depths", pixels);
    if (!err->status) {
        int side = view->width > view->height ? view->width : view->height;
        double ratio = e->params->disparity_side ? (double)e->params->disparity_side / side : 1;
        true_depth_in_view(truth, occluded, view, photo_lens_of_view(&e->views.cameras, &e->views.lenses, i),
                           &e->truth.photos[tv->photo], tv->points, tv->occluded);
        for (size_t k = 0; k < pixels; k++) s->z[k] = (float)(s->z[k] * e->truth_from_scene.scale);
        sigma_errors_add(&scene->sigmas, s->z, truth, s->sigma, s->classes, pixels);
        add_to_bins(&scene->bins, s, truth, pixels);
        depth_errors_add(&errors, s->z, truth, occluded, pixels, view->fx * ratio * e->baseline);
        compare_model_depth(e, view, s, truth, occluded, view->fx * ratio * e->baseline, scene, err);
        depth_errors_merge(&scene->depths, &errors);
        if (!err->status) add_depth_errors(e, view->name, &errors, err);
        if (!err->status && errors.all.pixels) write_truth(e, view, truth, occluded, err);
    }
    depth_errors_release(&errors);
    free(truth);
    free(occluded);
    return err->status;
}

static enum status evaluate_view(struct evaluation *e, int i, const bool *kept, struct photo_truth *tv,
                                 struct scene_errors *scene, struct err *err)
{
    const struct view *view = &e->views.cameras.views[i];
    int photo = evaluation_photo(e, &e->views, i);
    struct layered_depth d = {0};
    uint64_t here = 0, known_here = 0;
    char path[FILE_PATH];
    struct stated_depth stated = {0};
    if (!stated_depth_init(&stated, (size_t)view->width * (size_t)view->height, err) &&
        !evaluation_path(path, e, PRODUCT_DEPTH, &(struct product_key){.view = view->name}, err))
        layered_depth_read(&d, path, e->prov, err);
    if (!err->status && (d.width != view->width || d.height != view->height))
        err_set(err, ST_DATA, "%s is %d x %d px, but its view is %d x %d px; make the depth map again.", path, d.width,
                d.height, view->width, view->height);
    if (!err->status) {
        visible_depth(&stated, &d, &here, &known_here);
        scene->pixels += here;
        scene->known += known_here;
    }
    layered_depth_release(&d);
    if (!err->status && here) metric_add(&e->table, view->name, "depth.known", percent(known_here, here), err);
    if (!err->status && e->aligned && e->truth.photos[photo].depth && !photo_truth_make(tv, e, photo, kept, err))
        compare_depth(e, i, tv, &stated, scene, err);
    stated_depth_release(&stated);
    return err->status;
}

/* The shares within 1, 2 and 3 stated standard deviations, and the factor by which these would have to be multiplied so
 * that 68.27 % of the pixels are within one. */
static enum status add_sigma_tally(struct metric_table *t, const struct sigma_tally *s, const char *suffix,
                                   struct err *err)
{
    char name[64];
    const uint64_t pixels = s->errors.count;
    if (!pixels) return ST_OK;
    for (int k = 0; k < 3; k++) {
        snprintf(name, sizeof name, "depth.sigma%d%s", k + 1, suffix);
        if (metric_add(t, NULL, name, percent(s->within[k], pixels), err)) return err->status;
    }
    snprintf(name, sizeof name, "depth.sigma_factor%s", suffix);
    return metric_add(t, NULL, name, quantiles_get(&s->errors, 0.6827), err);
}

/* Overwrites the tally of the first class by that of all. */
static enum status add_sigma_errors(struct metric_table *t, struct sigma_errors *s, struct err *err)
{
    uint64_t pixels = 0;
    for (int c = 0; c < DEPTH_CLASSES; c++) pixels += s->classes[c].errors.count;
    for (int c = 0; c < DEPTH_CLASSES && pixels; c++) {
        char suffix[32], name[64];
        snprintf(suffix, sizeof suffix, "_%s", depth_class_name((enum depth_class)c));
        snprintf(name, sizeof name, "depth.share%s", suffix);
        if (metric_add(t, NULL, name, percent(s->classes[c].errors.count, pixels), err) ||
            add_sigma_tally(t, &s->classes[c], suffix, err))
            return err->status;
    }
    for (int c = 1; c < DEPTH_CLASSES; c++) sigma_tally_merge(&s->classes[0], &s->classes[c]);
    return add_sigma_tally(t, &s->classes[0], "", err);
}

/* For each fifth of the pixels by stated deviation: the shares within 1 and 2, and the largest. */
static enum status add_sigma_bins(struct metric_table *t, const struct sigma_bins *b, const char *suffix,
                                  struct err *err)
{
    struct sigma_bin bins[SIGMA_BINS];
    if (!b->pixels) return ST_OK;
    sigma_bins_get(b, bins);
    for (int i = 0; i < SIGMA_BINS; i++) {
        char name[64];
        for (int k = 0; k < 2; k++) {
            snprintf(name, sizeof name, "depth.sigma%d_fifth%d%s", k + 1, i + 1, suffix);
            if (metric_add(t, NULL, name, 100 * bins[i].within[k], err)) return err->status;
        }
        snprintf(name, sizeof name, "depth.sigma_most_fifth%d%s", i + 1, suffix);
        if (metric_add(t, NULL, name, 100 * bins[i].most, err)) return err->status;
    }
    return ST_OK;
}

enum status evaluate_depths(struct evaluation *e, struct err *err)
{
    const struct camera_set *views = &e->views.cameras;
    struct scene_errors scene = {0};
    struct photo_truth tv = {.photo = -1};
    struct progress progress;
    int missing = 0;
    bool *kept = calloc((size_t)e->photos.count + 1, sizeof *kept);
    if (kept && !depth_errors_init(&scene.depths, err))
        depth_errors_init(&scene.model_depths, err);
    else if (!kept)
        err_nomem(err, "marks", (size_t)e->photos.count);
    if (!err->status && !sigma_errors_init(&scene.sigmas, err) && !sigma_bins_init(&scene.bins, err))
        sigma_bins_init(&scene.model_bins, err);
    if (!err->status && e->truth_folder) {
        mark_kept(e, kept);
        find_baseline(e, kept, err);
    }
    progress_start(&progress, "depth maps", views->view_count, "views");
    for (int i = 0; !err->status && i < views->view_count; i++) {
        char path[FILE_PATH];
        evaluation_path(path, e, PRODUCT_DEPTH, &(struct product_key){.view = views->views[i].name}, err);
        if (!err->status && path_is_file(path))
            evaluate_view(e, i, kept, &tv, &scene, err);
        else if (!err->status)
            missing++;
        progress_add(&progress, 1);
    }
    progress_end(&progress);
    if (!err->status && missing)
        metric_note(&e->table, err, "skipped %d of %d views: they have no depth map", missing, views->view_count);
    if (!err->status && scene.pixels)
        metric_add(&e->table, NULL, "depth.known", percent(scene.known, scene.pixels), err);
    if (!err->status && scene.depths.all.pixels) {
        if (!add_depth_errors(e, NULL, &scene.depths, err) && !add_sigma_errors(&e->table, &scene.sigmas, err) &&
            !add_sigma_bins(&e->table, &scene.bins, "", err))
            add_sigma_bins(&e->table, &scene.model_bins, "_model", err);
        if (!err->status && scene.model_depths.all.pixels)
            add_tally(&e->table, NULL, &scene.model_depths.all, "_model", e->baseline > 0, err);
        if (!err->status && e->baseline > 0)
            metric_add(&e->table, NULL, "depth.baseline", e->baseline, err);
        else if (!err->status)
            metric_note(&e->table, err,
                        "skipped depth.bad1 and bad2: the truth places fewer than two of the kept photos apart; "
                        "a baseline can be given");
    } else if (!err->status && e->truth_folder && e->aligned) {
        metric_note(&e->table, err, "skipped depth errors: %s",
                    e->truth.depths ? "no view with a depth map is of a photo with a true depth"
                                    : "the truth has no depth of these photos");
    }
    depth_errors_release(&scene.depths);
    depth_errors_release(&scene.model_depths);
    sigma_errors_release(&scene.sigmas);
    sigma_bins_release(&scene.bins);
    sigma_bins_release(&scene.model_bins);
    photo_truth_release(&tv);
    free(kept);
    return err->status;
}
