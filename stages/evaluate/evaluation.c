/* evaluation.c - see evaluation.h. */
#include "stages/evaluate/evaluation.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/base/progress.h"
#include "common/capture/view_image.h"
#include "common/image/exr.h"
#include "common/layers/layered_depth.h"
#include "common/model/model_axes.h"
#include "stages/evaluate/alignment.h"
#include "stages/evaluate/axes_error.h"
#include "stages/evaluate/depth_error.h"
#include "stages/evaluate/metric_table.h"
#include "stages/evaluate/picture_error.h"
#include "stages/evaluate/true_room.h"
#include "stages/evaluate/truth.h"
#include "stages/evaluate/wall_plan.h"

#define PARAM_STRUCT struct evaluate_params
const struct param evaluate_param_table[] = {EVALUATE_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

struct view_set { /* cameras and lenses of views, or of those that are held out */
    struct camera_set cameras;
    struct lens_list lenses;
};

struct evaluation {
    const char *folder;
    const struct evaluate_params *params;
    struct provenance *prov;
    int shared_inputs; /* of prov: cameras and truth, not one view's files */
    struct photo_list photos;
    struct view_set views, held;
    bool has_held, has_truth, aligned;
    struct truth truth;
    struct similarity truth_from_scene;
    double baseline; /* 0: there is none */
    struct metric_table table;
};

static bool is_file(const char *path)
{
    struct stat info;
    return !stat(path, &info) && S_ISREG(info.st_mode);
}

/* folder/WHERE/FILESUFFIX in `path`; the file's hash goes into the provenance as WHERE/FILESUFFIX. */
static enum status input(struct evaluation *e, char path[FILE_PATH], const char *where, const char *file,
                         const char *suffix, struct err *err)
{
    char name[FILE_PATH];
    if (file_path(name, where, file, suffix, err) || file_path(path, e->folder, name, "", err)) return err->status;
    return provenance_add_file(e->prov, name, path, err);
}

static enum status read_views(struct evaluation *e, struct view_set *set, const char *where, struct err *err)
{
    char path[FILE_PATH], folder[FILE_PATH];
    enum status st = file_path(folder, e->folder, where, "", err);
    if (!st) st = camera_set_read(&set->cameras, folder, err);
    if (!st) st = input(e, path, where, "cameras.txt", "", err);
    if (!st) st = input(e, path, where, "images.txt", "", err);
    if (!st) st = input(e, path, where, "lenses.txt", "", err);
    if (!st) st = lens_list_read(&set->lenses, path, err);
    for (int i = 0; !st && i < set->cameras.view_count; i++) {
        const char *view = set->cameras.views[i].name;
        int lens = lens_list_find(&set->lenses, view);
        if (lens < 0)
            st = err_set(err, ST_DATA, "%s has no line for view %s of images.txt; import the model again.", path, view);
        else if (photo_list_find_id(&e->photos, set->lenses.lenses[lens].photo) < 0)
            st = err_set(err, ST_DATA, "%s: there is no record of photo %s; import photos and model again.", path,
                         set->lenses.lenses[lens].photo);
    }
    return st;
}

static const struct lens *lens_of(const struct view_set *set, int view)
{
    return &set->lenses.lenses[lens_list_find(&set->lenses, set->cameras.views[view].name)];
}

static int photo_of(const struct evaluation *e, const struct view_set *set, int view)
{
    return photo_list_find_id(&e->photos, lens_of(set, view)->photo);
}

/* ------------------------------------------------------------------------------------------------------ cameras */

/* The first view's pose, turned back into the photo's axes. */
static struct pose photo_pose(const struct view_set *set, int view)
{
    struct mat3 photo_from_view = mat3_transpose(mat3_from_quat(lens_of(set, view)->view_from_photo));
    const struct view *v = &set->cameras.views[view];
    return (struct pose){quat_from_mat3(mat3_multiply(photo_from_view, v->cam_from_world)),
                         mat3_apply(photo_from_view, v->translation)};
}

/* Poses of the photos that both know, in order of photo. */
static int common_poses(const struct evaluation *e, struct pose *found, struct pose *truth)
{
    int count = 0;
    for (int p = 0; p < e->photos.count; p++) {
        const struct view_set *sets[2] = {&e->views, &e->held};
        bool done = !e->truth.photos[p].lens.width;
        for (int k = 0; k < 2; k++)
            for (int i = 0; i < sets[k]->cameras.view_count && !done; i++) {
                if (photo_of(e, sets[k], i) != p) continue;
                found[count] = photo_pose(sets[k], i);
                truth[count++] = e->truth.photos[p].pose;
                done = true;
            }
    }
    return count;
}

static enum status evaluate_cameras(struct evaluation *e, struct err *err)
{
    struct metric_table *t = &e->table;
    size_t room = (size_t)e->photos.count + 1;
    struct pose *found = malloc(room * sizeof *found), *truth = malloc(room * sizeof *truth);
    struct err why = ERR_INIT;
    struct camera_errors errors;
    enum status st = found && truth ? ST_OK : err_nomem(err, "poses", room * sizeof *found);
    int known = e->truth.images - e->truth.strangers, count = st ? 0 : common_poses(e, found, truth);
    if (!st && e->truth.strangers)
        st = metric_note(t, err, "note: %d of %d images of the truth are none of the photos", e->truth.strangers,
                         e->truth.images);
    if (!st && known) st = metric_add(t, NULL, "camera.placed", 100.0 * count / known, "%", "higher", err);
    if (!st && align_cameras(&e->truth_from_scene, found, truth, count, &why)) {
        st = metric_note(t, err, "skipped camera errors and depth errors: %s", why.text);
    } else if (!st) {
        e->aligned = true;
        st = measure_cameras(&errors, &e->truth_from_scene, found, truth, count, err) ||
             metric_add(t, NULL, "camera.center_median", errors.center_median, "m", "lower", err) ||
             metric_add(t, NULL, "camera.center_max", errors.center_max, "m", "lower", err) ||
             metric_add(t, NULL, "camera.rotation_median", errors.rotation_median, "degrees", "lower", err) ||
             metric_add(t, NULL, "camera.rotation_max", errors.rotation_max, "degrees", "lower", err) ||
             metric_add(t, NULL, "camera.scale", e->truth_from_scene.scale, "m", "none", err);
    }
    free(found);
    free(truth);
    return st ? err->status : ST_OK;
}

/* --------------------------------------------------------------------------------------------------------- axes */

/* The room as found and as it is, in the truth's world moved to the mean of its cameras: heights are compared where they
 * are, not at a far origin that a small tilt moves much. */
static void rooms_to_compare(struct room_axes *found, struct room_axes *truth, const struct evaluation *e,
                             const struct model_axes *a, const struct true_room *room)
{
    const struct similarity *s = &e->truth_from_scene;
    struct vec3 middle = {0};
    int cameras = 0;
    for (int p = 0; p < e->photos.count; p++) {
        if (!e->truth.photos[p].lens.width) continue;
        middle = vec3_add(middle, pose_center(&e->truth.photos[p].pose));
        cameras++;
    }
    middle = vec3_scale(middle, 1.0 / cameras);
    /* both floors below the middle, along their own axes up */
    const struct vec3 scene =
        vec3_scale(mat3_apply(mat3_transpose(s->rotation), vec3_sub(middle, s->translation)), 1 / s->scale);
    const double unit = s->scale / a->scale; /* metres of one model unit, by the cameras */
    found->axes = mat3_multiply(mat3_from_quat(a->rotation), mat3_transpose(s->rotation));
    found->floor = -model_from_world_point(a, scene).z * unit;
    found->ceiling = found->floor + a->ceiling * unit;
    truth->axes = room->room_from_world;
    const double above = mat3_apply(room->room_from_world, vec3_sub(middle, room->origin)).z;
    truth->floor = room->floor - above;
    truth->ceiling = room->ceiling - above;
}

static enum status evaluate_axes(struct evaluation *e, const char *truth, struct err *err)
{
    struct metric_table *t = &e->table;
    struct model_axes axes;
    struct true_room room = {0};
    struct room_axes found, wanted;
    char path[FILE_PATH];
    if (file_path(path, e->folder, "model/axes.txt", "", err)) return err->status;
    if (!is_file(path)) return metric_note(t, err, "skipped axes and heights: there is no model/axes.txt");
    if (!truth) return metric_note(t, err, "skipped axes and heights: no TRUTH is given");
    if (!e->aligned) return metric_note(t, err, "skipped axes and heights: the cameras do not tell where the truth is");
    if (true_room_read(&room, truth, e->prov, err)) return err->status;
    if (!room.known)
        return metric_note(t, err, "skipped axes and heights: the truth holds neither scene.txt nor scene-truth.txt");
    if (input(e, path, "model", "axes.txt", "", err) || model_axes_read(&axes, path, err)) return err->status;
    rooms_to_compare(&found, &wanted, e, &axes, &room);
    const struct axes_errors errors = axes_errors(&found, &wanted);
    if (metric_add(t, NULL, "axes.angle", errors.all, "degrees", "lower", err) ||
        metric_add(t, NULL, "axes.up", errors.up, "degrees", "lower", err) ||
        metric_add(t, NULL, "axes.floor", errors.floor, "m", "lower", err))
        return err->status;
    if (axes.ceiling > 0 && metric_add(t, NULL, "axes.ceiling", errors.ceiling, "m", "lower", err)) return err->status;
    if (axes.metric &&
        metric_add(t, NULL, "axes.scale", 100 * fabs(axes.scale / e->truth_from_scene.scale - 1), "%", "lower", err))
        return err->status;
    return axes.ceiling > 0 ? ST_OK : metric_note(t, err, "skipped the ceiling: none was found");
}

/* A place of the model in the frame of the truth's rooms. */
static struct vec3 room_from_model(const struct evaluation *e, const struct model_axes *axes,
                                   const struct true_room *room, struct vec3 p)
{
    const struct similarity *s = &e->truth_from_scene;
    const struct vec3 scene = world_from_model_point(axes, p);
    const struct vec3 world = vec3_add(vec3_scale(mat3_apply(s->rotation, scene), s->scale), s->translation);
    return mat3_apply(room->room_from_world, vec3_sub(world, room->origin));
}

static enum status add_parts(struct metric_table *t, const char *name, const struct part_errors *p, struct err *err)
{
    char middle[64];
    snprintf(middle, sizeof middle, "%s_median", name);
    if (!p->count) return ST_OK;
    if (metric_add(t, NULL, name, p->errors[p->count - 1], "m", "lower", err) ||
        metric_add(t, NULL, middle, median(p->errors, p->count), "m", "lower", err))
        return err->status;
    return metric_note(t, err, "note: %s is that of %s", name, p->worst);
}

static enum status add_walls(struct metric_table *t, const struct wall_errors *w, struct err *err)
{
    if (add_parts(t, "model.walls", &w->faces, err) || add_parts(t, "model.openings", &w->openings, err) ||
        metric_add(t, NULL, "model.strange", w->strange, "1", "lower", err))
        return err->status;
    return metric_add(t, NULL, "model.missing", w->missing, "1", "lower", err);
}

static void parts_to_room(struct part_list *list, const struct evaluation *e, const struct model_axes *axes,
                          const struct true_room *room)
{
    for (int i = 0; i < list->count; i++)
        for (int k = 0; k < 2; k++) list->parts[i].at[k] = room_from_model(e, axes, room, list->parts[i].at[k]);
}

static enum status evaluate_walls(struct evaluation *e, const char *truth, struct err *err)
{
    const double reach = 0.5; /* m: farther is another wall */
    struct metric_table *t = &e->table;
    struct model_axes axes;
    struct true_room room = {0};
    struct wall_plan model = {0}, wanted = {0};
    struct wall_errors errors = {0};
    char path[FILE_PATH];
    if (file_path(path, e->folder, "model/plan.txt", "", err)) return err->status;
    if (!is_file(path)) return metric_note(t, err, "skipped walls: there is no model/plan.txt");
    if (!truth) return metric_note(t, err, "skipped walls: no TRUTH is given");
    if (!e->aligned) return metric_note(t, err, "skipped walls: the cameras do not tell where the truth is");
    struct provenance known = {0}; /* evaluate_axes() named these files already */
    enum status st = true_room_read(&room, truth, &known, err);
    provenance_release(&known);
    if (!st && !room.known)
        return metric_note(t, err, "skipped walls: the truth holds neither scene.txt nor scene-truth.txt");
    if (!st) st = input(e, path, "model", "plan.txt", "", err);
    if (!st) st = wall_plan_read(&model, path, PLAN_OF_MODEL, err);
    if (!st) st = file_path(path, e->folder, "model/axes.txt", "", err);
    if (!st) st = model_axes_read(&axes, path, err);
    if (!st) st = file_path(path, truth, room.framed ? "scene-truth.txt" : "scene.txt", "", err);
    if (!st) st = wall_plan_read(&wanted, path, room.framed ? PLAN_FRAMED : PLAN_DESCRIBED, err);
    if (!st) {
        parts_to_room(&model.faces, e, &axes, &room);
        parts_to_room(&model.openings, e, &axes, &room);
        st = wall_errors_find(&errors, &model, &wanted, reach, err);
    }
    if (!st) st = add_walls(t, &errors, err);
    wall_errors_release(&errors);
    wall_plan_release(&wanted);
    wall_plan_release(&model);
    return st;
}

/* -------------------------------------------------------------------------------------------------------- depth */

static void mark_kept(const struct evaluation *e, bool *kept)
{
    for (int i = 0; i < e->views.cameras.view_count; i++) {
        int photo = photo_of(e, &e->views, i);
        kept[photo] = e->truth.photos[photo].lens.width > 0;
    }
}

/* Median, over photos with a view, of the distance to the nearest other one's true place; 0 if there is none. */
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
    e->baseline = e->params->baseline > 0 ? e->params->baseline : count ? median(distances, count) : 0;
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
    size_t room = (size_t)e->photos.count + 1;
    struct neighbour *list = malloc(room * sizeof *list);
    const struct true_photo **others = malloc(room * sizeof *others);
    int count = 0;
    enum status st = list && others ? ST_OK : err_nomem(err, "neighbours", room * sizeof *list);
    for (int j = 0; !st && j < e->photos.count; j++) {
        const struct true_photo *p = &e->truth.photos[j];
        if (j != photo && kept[j])
            list[count++] =
                (struct neighbour){p, vec3_length(vec3_sub(pose_center(&p->pose), pose_center(&self->pose))), j};
    }
    if (!st) {
        qsort(list, (size_t)count, sizeof *list, compare_neighbours);
        for (int j = 0; j < count; j++) others[j] = list[j].photo;
        st = true_occlusion(occluded, self, points, others, count, err);
    }
    free(list);
    free(others);
    return st;
}

/* The visible layer's depth where the view has a pixel, 0 elsewhere; *pixels of the view, *known with a depth. */
static void visible_depth(float *z, const struct layered_depth *d, uint64_t *pixels, uint64_t *known)
{
    for (size_t i = 0; i < (size_t)d->width * (size_t)d->height; i++) {
        float a = d->interior.rgba[4 * i + 3], b = d->boundary.rgba[4 * i + 3];
        z[i] = a + b > 0 ? (a >= b ? d->interior.z[i] : d->boundary.z[i]) : 0;
        *pixels += a + b > 0;
        *known += z[i] > 0;
    }
}

static double percent(uint64_t part, uint64_t whole) { return 100 * (double)part / (double)whole; }

static enum status add_tally(struct metric_table *t, const char *view, const struct depth_tally *y, const char *suffix,
                             bool disparity, struct err *err)
{
    static const double PARTS[3] = {0.50, 0.90, 0.95};
    char name[64];
    snprintf(name, sizeof name, "depth.bad1%s", suffix);
    if (disparity && metric_add(t, view, name, percent(y->bad1, y->pixels), "%", "lower", err)) return err->status;
    snprintf(name, sizeof name, "depth.bad2%s", suffix);
    if (disparity && metric_add(t, view, name, percent(y->bad2, y->pixels), "%", "lower", err)) return err->status;
    for (int k = 0; k < 3 && y->known; k++) {
        snprintf(name, sizeof name, "depth.error%.0f%s", 100 * PARTS[k], suffix);
        if (metric_add(t, view, name, 100 * quantiles_get(&y->errors, PARTS[k]), "%", "lower", err)) return err->status;
    }
    snprintf(name, sizeof name, "depth.within2%s", suffix);
    if (y->known && metric_add(t, view, name, percent(y->within2, y->known), "%", "higher", err)) return err->status;
    return ST_OK;
}

static enum status add_depth_errors(struct evaluation *e, const char *view, const struct depth_errors *d,
                                    struct err *err)
{
    struct metric_table *t = &e->table;
    if (!d->all.pixels) return ST_OK;
    if (add_tally(t, view, &d->all, "", e->baseline > 0, err) ||
        metric_add(t, view, "depth.occluded", percent(d->all.pixels - d->visible.pixels, d->all.pixels), "%", "none",
                   err))
        return err->status;
    return d->visible.pixels ? add_tally(t, view, &d->visible, "_visible", e->baseline > 0, err) : ST_OK;
}

/* The truth as the page shows it beside the result: Z in scene units, occluded. */
static enum status write_truth(const struct evaluation *e, const struct view *view, const float *truth,
                               const uint8_t *occluded, struct err *err)
{
    struct exr_image im = {0};
    struct exr_plane *z = NULL, *o = NULL;
    char folder[FILE_PATH], path[FILE_PATH];
    size_t pixels = (size_t)view->width * (size_t)view->height;
    if (file_path(folder, e->folder, "evaluate/truth", "", err) || file_path(path, folder, view->name, ".exr", err) ||
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
    exr_set_camera(&im, view);
    struct provenance prov = *e->prov; /* not owned */
    prov.count = e->shared_inputs;
    const enum status st = exr_write(&im, path, &prov, err);
    exr_image_release(&im);
    return st;
}

struct true_view { /* what the views of one photo share */
    int photo;
    struct vec3 *points;
    uint8_t *occluded;
};

static void true_view_release(struct true_view *v)
{
    free(v->points);
    free(v->occluded);
    *v = (struct true_view){.photo = -1};
}

static enum status true_view_make(struct true_view *v, const struct evaluation *e, int photo, const bool *kept,
                                  struct err *err)
{
    const struct true_photo *p = &e->truth.photos[photo];
    size_t pixels = (size_t)p->lens.width * (size_t)p->lens.height;
    if (v->photo == photo) return ST_OK;
    true_view_release(v);
    v->points = malloc(pixels * sizeof *v->points);
    v->occluded = malloc(pixels);
    if (!v->points || !v->occluded) return err_nomem(err, "true points", pixels * sizeof *v->points);
    true_points(v->points, p);
    v->photo = photo;
    return occlusion_of(e, photo, kept, v->points, v->occluded, err);
}

/* Adds what the view's depth map is off to `scene`; z is used up. */
static enum status compare_depth(struct evaluation *e, int i, struct true_view *tv, float *z,
                                 struct depth_errors *scene, struct err *err)
{
    const struct view *view = &e->views.cameras.views[i];
    size_t pixels = (size_t)view->width * (size_t)view->height;
    struct depth_errors errors = {0};
    float *truth = malloc(pixels * sizeof *truth);
    uint8_t *occluded = malloc(pixels);
    enum status st = truth && occluded ? depth_errors_init(&errors, err) : err_nomem(err, "true depths", pixels);
    if (!st) {
        int side = view->width > view->height ? view->width : view->height;
        double ratio = e->params->disparity_side ? (double)e->params->disparity_side / side : 1;
        true_depth_in_view(truth, occluded, view, lens_of(&e->views, i), &e->truth.photos[tv->photo], tv->points,
                           tv->occluded);
        for (size_t k = 0; k < pixels; k++) z[k] = (float)(z[k] * e->truth_from_scene.scale);
        depth_errors_add(&errors, z, truth, occluded, pixels, view->fx * ratio * e->baseline);
        depth_errors_merge(scene, &errors);
        st = add_depth_errors(e, view->name, &errors, err);
        if (!st && errors.all.pixels) st = write_truth(e, view, truth, occluded, err);
    }
    depth_errors_release(&errors);
    free(truth);
    free(occluded);
    return st;
}

static enum status evaluate_view(struct evaluation *e, int i, const bool *kept, struct true_view *tv,
                                 struct depth_errors *scene, uint64_t *pixels, uint64_t *known, struct err *err)
{
    const struct view *view = &e->views.cameras.views[i];
    int photo = photo_of(e, &e->views, i);
    struct layered_depth d = {0};
    uint64_t here = 0, known_here = 0;
    char path[FILE_PATH];
    float *z = malloc((size_t)view->width * (size_t)view->height * sizeof *z);
    enum status st = z ? ST_OK : err_nomem(err, "a depth map", (size_t)view->width * (size_t)view->height);
    if (!st) st = input(e, path, "depth", view->name, ".exr", err);
    if (!st) st = layered_depth_read(&d, path, err);
    if (!st && (d.width != view->width || d.height != view->height))
        st = err_set(err, ST_DATA, "%s is %d x %d px, but its view is %d x %d px; make the depth map again.", path,
                     d.width, d.height, view->width, view->height);
    if (!st) {
        visible_depth(z, &d, &here, &known_here);
        *pixels += here;
        *known += known_here;
    }
    layered_depth_release(&d);
    if (!st && here)
        st = metric_add(&e->table, view->name, "depth.known", percent(known_here, here), "%", "higher", err);
    if (!st && e->aligned && e->truth.photos[photo].depth) {
        st = true_view_make(tv, e, photo, kept, err);
        if (!st) st = compare_depth(e, i, tv, z, scene, err);
    }
    free(z);
    return st;
}

static enum status evaluate_depths(struct evaluation *e, struct err *err)
{
    const struct camera_set *views = &e->views.cameras;
    struct depth_errors scene = {0};
    struct true_view tv = {.photo = -1};
    struct progress progress;
    uint64_t pixels = 0, known = 0;
    int missing = 0;
    bool *kept = calloc((size_t)e->photos.count + 1, sizeof *kept);
    enum status st = kept ? depth_errors_init(&scene, err) : err_nomem(err, "marks", (size_t)e->photos.count);
    if (!st && e->has_truth) {
        mark_kept(e, kept);
        st = find_baseline(e, kept, err);
    }
    progress_start(&progress, "depth maps", views->view_count, "views");
    for (int i = 0; !st && i < views->view_count; i++) {
        char path[FILE_PATH];
        snprintf(path, sizeof path, "%s/depth/%s.exr", e->folder, views->views[i].name);
        if (is_file(path))
            st = evaluate_view(e, i, kept, &tv, &scene, &pixels, &known, err);
        else
            missing++;
        progress_add(&progress, 1);
    }
    progress_end(&progress);
    if (!st && missing)
        st = metric_note(&e->table, err, "skipped %d of %d views: they have no depth map", missing, views->view_count);
    if (!st && pixels) st = metric_add(&e->table, NULL, "depth.known", percent(known, pixels), "%", "higher", err);
    if (!st && scene.all.pixels) {
        st = add_depth_errors(e, NULL, &scene, err);
        if (!st && e->baseline > 0)
            st = metric_add(&e->table, NULL, "depth.baseline", e->baseline, "m", "none", err);
        else if (!st)
            st = metric_note(&e->table, err,
                             "skipped depth.bad1 and bad2: the truth places fewer than two of the kept photos apart; "
                             "a baseline can be given");
    } else if (!st && e->has_truth && e->aligned) {
        st = metric_note(&e->table, err, "skipped depth errors: %s",
                         e->truth.depths ? "no view with a depth map is of a photo with a true depth"
                                         : "the truth has no depth of these photos");
    }
    depth_errors_release(&scene);
    true_view_release(&tv);
    free(kept);
    return st;
}

/* ----------------------------------------------------------------------------------------------- held-out pictures */

struct picture_sums {
    double psnr, ssim, psnr_covered, ssim_covered, holes;
    int pictures, with_ssim, covered, with_ssim_covered;
    int least[2], most[2]; /* sizes */
};

static enum status add_picture(struct evaluation *e, const struct view *view, const struct picture_errors *p,
                               struct picture_sums *s, struct err *err)
{
    struct metric_table *t = &e->table;
    s->psnr += p->psnr;
    s->holes += p->holes;
    s->pictures++;
    enum status st = metric_add(t, view->name, "holdout.psnr", p->psnr, "dB", "higher", err) ||
                     metric_add(t, view->name, "holdout.holes", 100 * p->holes, "%", "lower", err);
    if (!st && p->has_ssim) {
        s->ssim += p->ssim;
        s->with_ssim++;
        st = metric_add(t, view->name, "holdout.ssim", p->ssim, "1", "higher", err);
    }
    if (!st && p->has_covered) {
        s->psnr_covered += p->psnr_covered;
        s->covered++;
        st = metric_add(t, view->name, "holdout.psnr_covered", p->psnr_covered, "dB", "higher", err);
    }
    if (!st && p->has_ssim_covered) {
        s->ssim_covered += p->ssim_covered;
        s->with_ssim_covered++;
        st = metric_add(t, view->name, "holdout.ssim_covered", p->ssim_covered, "1", "higher", err);
    }
    return st ? err->status : ST_OK;
}

/* 8-bit sRGB of photo and frame, and the two masks. */
struct pictures {
    uint8_t *photo, *frame, *inside, *hole;
};

static enum status read_pictures(struct evaluation *e, const struct view *view, struct pictures *p, struct err *err)
{
    static const char *const NAMES[] = {"R", "G", "B", "hole"};
    size_t pixels = (size_t)view->width * (size_t)view->height;
    struct image photo = {0}, frame = {0};
    struct exr_image im = {0};
    char path[FILE_PATH], folder[FILE_PATH];
    p->photo = malloc(3 * pixels);
    p->frame = malloc(3 * pixels);
    p->inside = malloc(pixels);
    p->hole = malloc(pixels);
    enum status st = p->photo && p->frame && p->inside && p->hole ? ST_OK : err_nomem(err, "pictures", 8 * pixels);
    if (!st) st = file_path(folder, e->folder, "holdout/views", "", err);
    if (!st) st = input(e, path, "holdout/views", view->name, ".exr", err);
    if (!st) st = view_image_read(&photo, folder, view, err);
    if (!st) st = input(e, path, "holdout/frames", view->name, ".exr", err);
    if (!st) st = exr_read(&im, path, NAMES, 4, err);
    if (!st && (im.width != view->width || im.height != view->height))
        st = err_set(err, ST_DATA, "%s is %d x %d px, but its view is %d x %d px; render it again.", path, im.width,
                     im.height, view->width, view->height);
    if (!st) st = image_init(&frame, im.width, im.height, 3, err);
    for (int c = 0; !st && c < 4; c++) {
        const struct exr_plane *plane = exr_find(&im, NAMES[c]);
        if (!plane->f)
            st = err_set(err, ST_DATA, "%s: the channel %s holds no floats; render it again.", path, NAMES[c]);
        for (size_t i = 0; !st && i < pixels; i++)
            if (c < 3)
                frame.data[3 * i + (size_t)c] = plane->f[i];
            else
                p->hole[i] = plane->f[i] > 0.5f;
    }
    if (!st) {
        image_to_srgb8(&photo, p->photo);
        image_to_srgb8(&frame, p->frame);
        for (size_t i = 0; i < pixels; i++) p->inside[i] = photo.data[4 * i + 3] > 0;
    }
    exr_image_release(&im);
    image_release(&photo);
    image_release(&frame);
    return st;
}

static enum status evaluate_picture(struct evaluation *e, const struct view *view, struct picture_sums *s,
                                    struct err *err)
{
    struct pictures p = {0};
    struct picture_errors errors;
    struct err why = ERR_INIT;
    enum status st = read_pictures(e, view, &p, err);
    if (!st) {
        st = picture_errors(&errors, p.photo, p.frame, p.inside, p.hole, view->width, view->height, &why);
        if (st == ST_DATA)
            st = metric_note(&e->table, err, "skipped the held-out view %s: %s", view->name, why.text);
        else if (st)
            err_set(err, st, "%s", why.text);
        else
            st = add_picture(e, view, &errors, s, err);
    }
    int size[2] = {view->width, view->height};
    for (int k = 0; k < 2; k++) {
        if (!s->least[k] || size[k] < s->least[k]) s->least[k] = size[k];
        if (size[k] > s->most[k]) s->most[k] = size[k];
    }
    free(p.photo);
    free(p.frame);
    free(p.inside);
    free(p.hole);
    return st;
}

static enum status evaluate_pictures(struct evaluation *e, struct err *err)
{
    const struct camera_set *held = &e->held.cameras;
    struct metric_table *t = &e->table;
    struct picture_sums s = {0};
    int missing = 0;
    enum status st = ST_OK;
    for (int i = 0; !st && i < held->view_count; i++) {
        char path[FILE_PATH];
        snprintf(path, sizeof path, "%s/holdout/frames/%s.exr", e->folder, held->views[i].name);
        if (is_file(path))
            st = evaluate_picture(e, &held->views[i], &s, err);
        else
            missing++;
    }
    if (!st && missing)
        st = metric_note(t, err, "skipped %d of %d held-out views: they were not rendered", missing, held->view_count);
    if (st || !s.pictures) return st;
    if (s.least[0] == s.most[0] && s.least[1] == s.most[1])
        st = metric_note(t, err, "note: held-out pictures are compared at their own size, %d x %d px", s.most[0],
                         s.most[1]);
    else
        st = metric_note(t, err, "note: held-out pictures are compared at their own sizes, %d x %d to %d x %d px",
                         s.least[0], s.least[1], s.most[0], s.most[1]);
    st = st || metric_add(t, NULL, "holdout.pictures", s.pictures, "1", "none", err) ||
         metric_add(t, NULL, "holdout.psnr", s.psnr / s.pictures, "dB", "higher", err) ||
         metric_add(t, NULL, "holdout.holes", 100 * s.holes / s.pictures, "%", "lower", err) ||
         (s.with_ssim && metric_add(t, NULL, "holdout.ssim", s.ssim / s.with_ssim, "1", "higher", err)) ||
         (s.covered && metric_add(t, NULL, "holdout.psnr_covered", s.psnr_covered / s.covered, "dB", "higher", err)) ||
         (s.with_ssim_covered &&
          metric_add(t, NULL, "holdout.ssim_covered", s.ssim_covered / s.with_ssim_covered, "1", "higher", err));
    return st ? err->status : ST_OK;
}

/* -------------------------------------------------------------------------------------------------------- whole */

static enum status note_missing(struct evaluation *e, struct err *err)
{
    struct metric_table *t = &e->table;
    enum status st = ST_OK;
    if (!e->has_truth) st = metric_note(t, err, "skipped camera and depth errors: no TRUTH is given");
    if (!st && !e->has_held) st = metric_note(t, err, "skipped PSNR, SSIM and holes: no photo is held out (HOLDOUT)");
    if (!st) st = metric_note(t, err, "skipped irradiance: there is no relight/irradiance");
    if (!st) st = metric_note(t, err, "skipped texture errors: there is no vita and no vdta");
    return st;
}

static void evaluation_release(struct evaluation *e)
{
    truth_release(&e->truth);
    metric_table_release(&e->table);
    lens_list_release(&e->held.lenses);
    camera_set_release(&e->held.cameras);
    lens_list_release(&e->views.lenses);
    camera_set_release(&e->views.cameras);
    photo_list_release(&e->photos);
}

enum status evaluate(const char *folder, const char *shared, const char *truth, const char *out,
                     const struct evaluate_params *params, struct provenance *prov, struct err *err)
{
    struct evaluation e = {.folder = folder, .params = params, .prov = prov, .has_truth = truth != NULL};
    char path[FILE_PATH];
    enum status st = file_path(path, shared, "photos", "", err);
    if (!st) st = photo_list_read(&e.photos, path, err);
    if (!st) st = read_views(&e, &e.views, "views", err);
    if (!st) st = file_path(path, folder, "holdout/views/images.txt", "", err);
    e.has_held = !st && is_file(path);
    if (e.has_held) st = read_views(&e, &e.held, "holdout/views", err);
    if (!st && truth) st = truth_read(&e.truth, truth, &e.photos, params->far, prov, err);
    e.shared_inputs = prov->count;
    if (!st) st = note_missing(&e, err);
    if (!st && truth) st = evaluate_cameras(&e, err);
    if (!st) st = evaluate_axes(&e, truth, err);
    if (!st) st = evaluate_walls(&e, truth, err);
    if (!st) st = evaluate_depths(&e, err);
    if (!st && e.has_held) st = evaluate_pictures(&e, err);
    if (!st) st = file_path(path, folder, "evaluate/views.tsv", "", err);
    if (!st) st = metric_table_write(&e.table, true, path, prov, err);
    if (!st) st = metric_table_write(&e.table, false, out, prov, err);
    evaluation_release(&e);
    return st;
}
