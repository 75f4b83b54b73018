/* camera_set.c - the rectified views of a scene. */
#include "common/capture/camera_set.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/sort.h"

#define BELOW 0.05 /* of a point's depth */

static const char suffix[] = ".exr";

static enum status make_view(struct view *v, const struct sfm_model *m, const struct sfm_image *im, const char *folder,
                             struct err *err)
{
    const struct camera *c = &m->cameras[im->camera_idx].camera;
    size_t length = strlen(im->name), tail = sizeof suffix - 1;
    if (length <= tail || strcmp(im->name + length - tail, suffix))
        return err_set(err, ST_DATA, "%s/images.txt: found image \"%s\", wanted a name like VIEW.exr.", folder,
                       im->name);
    if (c->model != CAMERA_PINHOLE && c->model != CAMERA_SIMPLE_PINHOLE)
        return err_set(err, ST_DATA,
                       "%s/cameras.txt: found a %s camera for image \"%s\", wanted PINHOLE or SIMPLE_PINHOLE, the "
                       "cameras of rectified views.",
                       folder, camera_model_name(c->model), im->name);
    v->name = strndup(im->name, length - tail);
    if (!v->name) return err_nomem(err, "a view's name", length);
    v->width = c->width;
    v->height = c->height;
    camera_focal(c, &v->fx, &v->fy, &v->cx, &v->cy);
    v->cam_from_world = mat3_from_quat(im->cam_from_world.rotation);
    v->translation = im->cam_from_world.translation;
    v->center = pose_center(&im->cam_from_world);
    return ST_OK;
}

struct view_entry {
    struct view view;
    struct sfm_image image;
    int idx;
};

static int compare_entries(const void *a, const void *b)
{
    return strcmp(((const struct view_entry *)a)->view.name, ((const struct view_entry *)b)->view.name);
}

/* The model is in order of "VIEW.exr", which differs from the order of VIEW if one name is the beginning of another. */
static enum status sort_views(struct camera_set *set, struct err *err)
{
    struct sfm_model *m = &set->model;
    size_t n = (size_t)set->view_count;
    struct view_entry *entries = calloc(n, sizeof *entries);
    int *new_idx = calloc(n, sizeof *new_idx);
    if (!entries || !new_idx) {
        err_nomem(err, "views", n * sizeof *entries);
    } else {
        for (size_t i = 0; i < n; i++) entries[i] = (struct view_entry){set->views[i], m->images[i], (int)i};
        qsort(entries, n, sizeof *entries, compare_entries);
        for (size_t i = 0; i < n; i++) {
            set->views[i] = entries[i].view;
            m->images[i] = entries[i].image;
            new_idx[entries[i].idx] = (int)i;
        }
        for (int i = 0; i < m->point_count; i++)
            for (int k = 0; k < m->points[i].track_count; k++)
                m->points[i].track[k].image_idx = new_idx[m->points[i].track[k].image_idx];
    }
    free(entries);
    free(new_idx);
    return err->status;
}

/* The views of set->model; the set is released if that fails. */
static enum status make_views(struct camera_set *set, const char *folder, struct err *err)
{
    set->views = calloc((size_t)set->model.image_count, sizeof *set->views);
    if (!set->views) err_nomem(err, "views", (size_t)set->model.image_count * sizeof *set->views);
    for (int i = 0; !err->status && i < set->model.image_count; i++)
        if (!make_view(&set->views[i], &set->model, &set->model.images[i], folder, err)) set->view_count++;
    if (!err->status) sort_views(set, err);
    if (err->status) camera_set_release(set);
    return err->status;
}

enum status camera_set_read(struct camera_set *set, const char *folder, struct provenance *prov, struct err *err)
{
    *set = (struct camera_set){0};
    if (sfm_model_read_text(&set->model, folder, prov, err)) return err->status;
    return make_views(set, folder, err);
}

enum status camera_set_read_cameras(struct camera_set *set, const char *folder, struct provenance *prov,
                                    struct err *err)
{
    *set = (struct camera_set){0};
    if (sfm_model_read_cameras(&set->model, folder, prov, err)) return err->status;
    return make_views(set, folder, err);
}

/* Drops the views that go (-1 in new_idx) from a point's track; returns the number of those that stay. */
static int keep_tracks(struct sfm_point *p, const int *new_idx)
{
    int kept = 0;
    for (int k = 0; k < p->track_count; k++) {
        const struct sfm_track t = p->track[k];
        if (new_idx[t.image_idx] >= 0) p->track[kept++] = (struct sfm_track){new_idx[t.image_idx], t.observation_idx};
    }
    return p->track_count = kept;
}

static void keep_points(struct sfm_model *m, const int *new_idx)
{
    int kept = 0;
    for (int i = 0; i < m->point_count; i++) {
        if (keep_tracks(&m->points[i], new_idx))
            m->points[kept++] = m->points[i];
        else
            free(m->points[i].track);
    }
    m->point_count = kept;
}

enum status camera_set_keep(struct camera_set *set, const bool *keep, struct err *err)
{
    struct sfm_model *m = &set->model;
    int *new_idx = malloc(((size_t)set->view_count + 1) * sizeof *new_idx), kept = 0;
    if (!new_idx) return err_nomem(err, "views", (size_t)set->view_count * sizeof *new_idx);
    for (int i = 0; i < set->view_count; i++) {
        new_idx[i] = keep[i] ? kept : -1;
        if (keep[i]) {
            set->views[kept] = set->views[i];
            m->images[kept++] = m->images[i];
        } else {
            free((char *)set->views[i].name);
            free(m->images[i].name);
            free(m->images[i].observations);
        }
    }
    set->view_count = m->image_count = kept;
    keep_points(m, new_idx);
    free(new_idx);
    return ST_OK;
}

static bool is_before(const void *view, const void *name)
{
    return strcmp(((const struct view *)view)->name, name) < 0;
}

int camera_set_find(const struct camera_set *set, const char *name)
{
    const int at = (int)sort_place(set->views, (size_t)set->view_count, sizeof *set->views, is_before, name);
    return at < set->view_count && !strcmp(set->views[at].name, name) ? at : -1;
}

bool camera_set_shows_below(const struct camera_set *set, struct vec3 point, struct vec3 down)
{
    int views = 0;
    for (int i = 0; i < set->view_count && views < 2; i++) {
        const struct view *v = &set->views[i];
        double x, y;
        const double z = view_project(v, point, &x, &y);
        if (!(z > 0) || !(x >= 0 && y >= 0 && x < v->width && y < v->height)) continue;
        if (!(view_project(v, vec3_add(point, vec3_scale(down, BELOW * z)), &x, &y) > 0)) continue;
        views += x >= 0 && y >= 0 && x < v->width && y < v->height;
    }
    return views == 2;
}

void camera_set_release(struct camera_set *set)
{
    if (!set) return;
    for (int i = 0; i < set->view_count; i++) free((char *)set->views[i].name);
    free(set->views);
    sfm_model_release(&set->model);
    *set = (struct camera_set){0};
}
