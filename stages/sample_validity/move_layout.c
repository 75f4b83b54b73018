/* move_layout.c - the setup of a scene's moves.
 *
 * As in [Colburn 2014, 3.4.2], the reference frame has its origin at the centremost view's centre and the normal of the
 * plane fitted to the views' centres as z axis, and the centroid is the median position of the segments in the middle
 * of the central views' pictures. What differs: only central views that face about the same way as the centremost one
 * vote for the centroid, since indoors others show what is behind it; and if the plane does not face the scene, as for
 * views in a line towards it, the axes are the centremost view's. Up is the mean of the views' upright directions, f
 * their mean focal length (common/film/film_lens.h). */
#include "stages/sample_validity/move_layout.h"

#include <stdlib.h>

#include "common/capture/central_views.h"
#include "common/film/film_lens.h"
#include "common/math/weighted.h"

#define CENTRAL_VIEWS   5    /* number of views whose segments vote for the centroid */
#define MIN_AXIS_COSINE 0.5  /* between directions that face about the same way */
#define NEAR_PERCENTILE 0.02 /* of the depths: the near depth */
#define NEAR_FRACTION   0.5  /* near limit, in units of the near depth */
#define MIN_BOX         0.02 /* smallest side of the bounding box of the centres, in median depths */

struct layout_search {
    struct shot_setup *shot;
    const struct layer_scene *scene;
    const struct scene_points *points;
    const struct validity_params *params;
    int center;
    struct weighted *scratch; /* one per point */
};

static const struct view *center_view(const struct layout_search *l) { return &l->scene->set->views[l->center]; }

static enum status find_center_view(struct layout_search *l, struct err *err)
{
    int *order = malloc(((size_t)l->scene->set->view_count + 1) * sizeof *order);
    if (!order) return err_nomem(err, "views", sizeof *order);
    if (!central_views(order, l->scene->set, err)) l->center = order[0];
    free(order);
    return err->status;
}

/* Median of a coordinate of the points of the views in use, in the centremost view's camera. central: only of points in
 * the middle of their view. false: there are none. */
static bool median_coordinate(const struct layout_search *l, const bool *use, bool central, int axis, double *value)
{
    const struct view *v = center_view(l);
    const struct vec3 row = mat3_row(v->cam_from_world, axis);
    const double shift = axis == 0 ? v->translation.x : axis == 1 ? v->translation.y : v->translation.z;
    size_t n = 0;
    for (size_t i = 0; i < l->points->count; i++) {
        const struct scene_point *p = &l->points->points[i];
        if (use[p->view] && (p->central || !central))
            l->scratch[n++] = (struct weighted){vec3_dot(row, p->position) + shift, p->weight};
    }
    *value = weighted_percentile(l->scratch, n, 0.5);
    return n > 0;
}

/* Marks the CENTRAL_VIEWS views nearest to the centremost one among those that face about the same way. */
static void choose_voters(const struct layout_search *l, bool *use)
{
    const struct camera_set *set = l->scene->set;
    const struct vec3 axis = mat3_row(center_view(l)->cam_from_world, 2);
    for (int k = 0; k < CENTRAL_VIEWS && k < set->view_count; k++) {
        int best = -1;
        double nearest = HUGE_VAL;
        for (int i = 0; i < set->view_count; i++) {
            const double d = vec3_length(vec3_sub(set->views[i].center, center_view(l)->center));
            if (vec3_dot(mat3_row(set->views[i].cam_from_world, 2), axis) < MIN_AXIS_COSINE) continue;
            if (!use[i] && d < nearest) nearest = d, best = i;
        }
        if (best >= 0) use[best] = true;
    }
}

static enum status find_centroid(struct layout_search *l, struct err *err)
{
    const struct camera_set *set = l->scene->set;
    bool *use = calloc((size_t)set->view_count, sizeof *use);
    if (!use) return err_nomem(err, "a list of views", (size_t)set->view_count);
    choose_voters(l, use);
    double c[3];
    const bool central = median_coordinate(l, use, true, 0, &c[0]);
    if (!central) /* the middle of the central views is empty: use all points of all views */
        for (int i = 0; i < set->view_count; i++) use[i] = true;
    for (int axis = 0; axis < 3; axis++) median_coordinate(l, use, central, axis, &c[axis]);
    free(use);
    const struct view *v = center_view(l);
    if (!(c[2] > 0))
        return err_set(
            err, ST_DATA,
            "the scene's centroid is behind the centremost view %s: the depth maps contradict each other; check them.",
            v->name);
    const struct vec3 in_view = vec3_sub(vec3_make(c[0], c[1], c[2]), v->translation);
    l->shot->centroid = mat3_apply(mat3_transpose(v->cam_from_world), in_view);
    return ST_OK;
}

/* Depths seen from the origin by a camera that points at the centroid. */
static enum status measure_depths(struct layout_search *l, struct err *err)
{
    const struct view v = shot_aim(l->shot, l->shot->origin, l->shot->centroid, l->shot->lens.fx);
    size_t n = 0;
    for (size_t i = 0; i < l->points->count; i++) {
        const struct scene_point *p = &l->points->points[i];
        double u = -1, t = -1;
        const double z = view_project(&v, p->position, &u, &t);
        if (z <= 0 || u < 0 || u > v.width || t < 0 || t > v.height) continue;
        l->scratch[n++] = (struct weighted){z, p->weight};
    }
    if (!n)
        return err_set(err, ST_DATA, "the centremost view %s shows nothing that has a depth; check its depth map.",
                       center_view(l)->name);
    l->shot->near_limit = NEAR_FRACTION * weighted_percentile(l->scratch, n, NEAR_PERCENTILE);
    l->shot->median_depth = weighted_percentile(l->scratch, n, 0.5);
    return ST_OK;
}

static void find_frame(struct layout_search *l)
{
    const struct view_mesh *mesh = &l->scene->mesh;
    const struct view *c = center_view(l);
    struct shot_setup *s = l->shot;
    s->origin = c->center;
    s->axis_x = mesh->axis_x;
    s->axis_y = mesh->axis_y;
    s->axis_z = mesh->normal;
    if (vec3_dot(s->axis_z, mat3_row(c->cam_from_world, 2)) >= MIN_AXIS_COSINE) return;
    s->axis_x = mat3_row(c->cam_from_world, 0);
    s->axis_y = mat3_row(c->cam_from_world, 1);
    s->axis_z = mat3_row(c->cam_from_world, 2);
}

static void find_box(struct layout_search *l)
{
    const struct camera_set *set = l->scene->set;
    struct shot_setup *s = l->shot;
    const double min_side = MIN_BOX * s->median_depth;
    for (int i = 0; i < set->view_count; i++) {
        const struct vec3 c = shot_from_world(s, set->views[i].center);
        const double at[2] = {c.x, c.y};
        for (int k = 0; k < 2; k++) {
            if (!i || at[k] < s->low[k]) s->low[k] = at[k];
            if (!i || at[k] > s->high[k]) s->high[k] = at[k];
        }
    }
    for (int k = 0; k < 2; k++) {
        const double missing = min_side - (s->high[k] - s->low[k]);
        if (!(missing > 0)) continue;
        s->low[k] -= missing / 2;
        s->high[k] += missing / 2;
    }
}

enum status layout_find(struct shot_setup *shot, int *view_idx, const struct layer_scene *scene,
                        const struct scene_points *points, const struct vec3 *ups, const struct validity_params *params,
                        struct err *err)
{
    struct layout_search l = {.shot = shot, .scene = scene, .points = points, .params = params};
    *shot = (struct shot_setup){0};
    l.scratch = malloc((points->count + 1) * sizeof *l.scratch);
    if (!l.scratch) return err_nomem(err, "depths", points->count * sizeof *l.scratch);
    if (!find_center_view(&l, err)) {
        const struct film_size size = {params->width, params->height, params->max_side};
        find_frame(&l);
        film_lens(&shot->lens, &shot->up, scene->set, l.center, ups, &size);
        find_centroid(&l, err);
    }
    if (!err->status && !measure_depths(&l, err)) find_box(&l);
    *view_idx = l.center;
    free(l.scratch);
    return err->status;
}
