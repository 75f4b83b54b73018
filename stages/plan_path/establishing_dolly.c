/* establishing_dolly.c - the establishing dolly in its thin form.
 *
 * The camera always points at the scene's centroid, the median of the segments in the middle of the central views'
 * pictures; its focal length is the views' mean, its roll none against their mean up. It moves along a line through
 * the centremost view in the plane of the view mesh: in a few directions the ends are put as far out as the views'
 * spread (extent) and the angle that the ends subtend at the centroid (max_angle: what a picture shows must be seen
 * by neighbouring views) allow, symmetric about the centremost view as far as there are views on both sides. Then the
 * reach is shrunk by bisection until, at the ends, the quarters and the middle, the holes are few enough, the frame
 * stays within the pictures of the views that it blends, and nothing of the scene is too near.
 *
 * Zooming in hides holes and the photos' borders: each 5 % of focal length is tried; what counts is length / zoom^4:
 * zooming in gives up what the photos frame. Of the directions the one wins that has most length for this and for its
 * distance to the views.
 *
 * What differs from the thesis: no grid of viewpoints, holes by their area and not by H. */
#include "stages/plan_path/establishing_dolly.h"

#include <stdlib.h>
#include <string.h>

#define PARAM_STRUCT struct plan_params
const struct param plan_param_table[] = {PLAN_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

#define CENTRAL_VIEWS    5   /* whose segments vote for the centroid */
#define SAME_WAY         0.5 /* cosine of the angle between their axes and the centremost view's, at least */
#define CENTRAL_PART     0.5 /* of width and height */
#define ZOOM_STEP        0.05
#define ZOOM_COST        4
#define NEAR_PERCENTILE  0.02 /* depths that stand for near and far */
#define FAR_PERCENTILE   0.98
#define NEAR_FRACTION    0.5   /* of the near depth in the middle: nearer than this is within the scene */
#define NEAR_TOLERANCE   0.005 /* of the picture */
#define SLACK            1.2   /* over what the centremost view leaves, where that is too much already */
#define LONE_REACH       0.05  /* of the distance: how far views at one place let the camera go */
#define OTHER_WAY_WEIGHT 0.8   /* of directions other than the main axis */
#define OUTSIDE_SIDE     64    /* of the picture in which what is outside is counted */
#define PLACES           5     /* where holes are counted */
#define SEARCH_STEPS     4     /* of a bisection while zooms and directions are compared */
#define FINAL_STEPS      8

enum status plan_params_check(const void *values, struct err *err)
{
    const struct plan_params *p = values;
    if (p->seconds * p->fps >= 1.5) return ST_OK;
    return err_set(err, ST_USAGE,
                   "seconds = %g at fps = %g make fewer than two frames: a film needs at least two; raise seconds.",
                   p->seconds, p->fps);
}

/* ------------------------------------------------------------------------------------------------- weighted samples */

struct sample {
    double value, weight;
};

static int compare_samples(const void *a, const void *b)
{
    double x = ((const struct sample *)a)->value, y = ((const struct sample *)b)->value;
    return x < y ? -1 : x > y;
}

/* Of a part of the weight; sorts the samples. */
static double percentile(struct sample *s, size_t count, double part)
{
    double total = 0, sum = 0;
    qsort(s, count, sizeof *s, compare_samples);
    for (size_t i = 0; i < count; i++) total += s[i].weight;
    for (size_t i = 0; i < count; i++) {
        sum += s[i].weight;
        if (sum >= part * total) return s[i].value;
    }
    return count ? s[count - 1].value : 0;
}

/* A segment's centre in the world, with its pixels. */
struct blob {
    struct vec3 position;
    double weight;
    int view;
    bool central; /* in the middle of its view's picture */
};

/* ----------------------------------------------------------------------------------------------------------- a plan */

struct plan {
    const struct layer_scene *scene;
    const struct plan_params *params;
    int center; /* the centremost view */
    struct vec3 centroid, up;
    struct blob *blobs;
    size_t blob_count;
    struct sample *scratch; /* blob_count of them */
    struct view lens;       /* size, focal length and principal point of the film; the focal length without zoom */
    double near_limit, hole_limit, outside_limit;
    double near_depth, far_depth; /* of what the film's middle shows */
    struct rendered_frame coverage;
};

struct way { /* a line through the centremost view's centre */
    struct vec3 direction;
    double low, high;   /* the views' extent along it; low <= 0 <= high */
    double reach, zoom; /* found */
    double merit;
};

static const struct view *center_view(const struct plan *p) { return &p->scene->set->views[p->center]; }

static struct vec3 row_of(struct mat3 m, int row) { return vec3_make(m.m[row][0], m.m[row][1], m.m[row][2]); }

/* The view nearest the middle of all; of several views of one photo, the one that looks where most views look. */
static void find_center_view(struct plan *p)
{
    const struct camera_set *set = p->scene->set;
    struct vec3 gaze = {0};
    double best = HUGE_VAL, best_gaze = 0;
    for (int i = 0; i < set->view_count; i++) gaze = vec3_add(gaze, row_of(set->views[i].cam_from_world, 2));
    for (int i = 0; i < set->view_count; i++) {
        const double d = vec3_length(vec3_sub(set->views[i].center, p->scene->mesh.centroid));
        const double g = vec3_dot(row_of(set->views[i].cam_from_world, 2), gaze);
        if (d < best * (1 - 1e-9) || (d <= best * (1 + 1e-9) && g > best_gaze)) best = d, best_gaze = g, p->center = i;
    }
}

static enum status collect_blobs(struct plan *p, struct err *err)
{
    const struct layer_scene *s = p->scene;
    size_t most = 1;
    for (int i = 0; i < s->set->view_count; i++) most += (size_t)s->depths[i].segment_count;
    p->blobs = malloc(most * sizeof *p->blobs);
    p->scratch = malloc(most * sizeof *p->scratch);
    if (!p->blobs || !p->scratch) return err_nomem(err, "the segments' places", most * sizeof *p->blobs);
    for (int i = 0; i < s->set->view_count; i++)
        for (int k = 0; k < s->depths[i].segment_count; k++) {
            const struct view *v = &s->set->views[i];
            const struct segment_shape *shape = &s->views[i].shapes[k];
            const double *plane = s->depths[i].segments[k].plane;
            double inverse = plane[0] * shape->u + plane[1] * shape->v + plane[2];
            if (!(inverse > 0) || !(shape->pixels > 0)) continue;
            double across = fabs(2 * shape->u / v->width - 1), down = fabs(2 * shape->v / v->height - 1);
            p->blobs[p->blob_count++] = (struct blob){view_unproject(v, shape->u, shape->v, 1 / inverse), shape->pixels,
                                                      i, across <= CENTRAL_PART && down <= CENTRAL_PART};
        }
    if (p->blob_count) return ST_OK;
    return err_set(err, ST_DATA, "none of the %d depth maps has a segment with a depth: there is no scene to move in.",
                   s->set->view_count);
}

/* Median of a coordinate of the blobs of some views, in the centremost view's camera. */
static bool median_coordinate(const struct plan *p, const bool *use, bool central, int axis, double *value)
{
    const struct view *v = center_view(p);
    struct vec3 row = row_of(v->cam_from_world, axis);
    double shift = axis == 0 ? v->translation.x : axis == 1 ? v->translation.y : v->translation.z;
    size_t n = 0;
    for (size_t i = 0; i < p->blob_count; i++)
        if (use[p->blobs[i].view] && (p->blobs[i].central || !central))
            p->scratch[n++] = (struct sample){vec3_dot(row, p->blobs[i].position) + shift, p->blobs[i].weight};
    *value = percentile(p->scratch, n, 0.5);
    return n > 0;
}

/* Of the central views those vote that look about the same way as the centremost one: indoors others show what is
 * behind it. */
static enum status find_centroid(struct plan *p, struct err *err)
{
    const struct camera_set *set = p->scene->set;
    const struct vec3 gaze = row_of(center_view(p)->cam_from_world, 2);
    bool *use = calloc((size_t)set->view_count, sizeof *use);
    if (!use) return err_nomem(err, "a list of views", (size_t)set->view_count);
    for (int k = 0; k < CENTRAL_VIEWS && k < set->view_count; k++) {
        int best = -1;
        double nearest = HUGE_VAL;
        for (int i = 0; i < set->view_count; i++) {
            double d = vec3_length(vec3_sub(set->views[i].center, center_view(p)->center));
            if (vec3_dot(row_of(set->views[i].cam_from_world, 2), gaze) < SAME_WAY) continue;
            if (!use[i] && d < nearest) nearest = d, best = i;
        }
        if (best >= 0) use[best] = true;
    }
    double c[3];
    bool central = median_coordinate(p, use, true, 0, &c[0]);
    if (!central) /* nothing in the middle of the central views: everything then */
        for (int i = 0; i < set->view_count; i++) use[i] = true;
    for (int axis = 0; axis < 3; axis++) median_coordinate(p, use, central, axis, &c[axis]);
    free(use);
    const struct view *v = center_view(p);
    if (!(c[2] > 0))
        return err_set(err, ST_DATA,
                       "the scene's centroid lies behind the centremost view %s: its depth maps do not agree.",
                       v->name);
    struct vec3 in_view = vec3_sub(vec3_make(c[0], c[1], c[2]), v->translation);
    p->centroid = mat3_apply(mat3_transpose(v->cam_from_world), in_view);
    return ST_OK;
}

/* The mean of the views' upright directions, and the film's size and focal length. */
static void find_lens(struct plan *p, const struct vec3 *ups)
{
    const struct camera_set *set = p->scene->set;
    const struct plan_params *par = p->params;
    const struct view *c = center_view(p);
    struct vec3 upright = {0, -1, 0}, sum = {0}, center_up;
    double focal = 0; /* of the longer side */
    for (int i = 0; i < set->view_count; i++) {
        const struct view *v = &set->views[i];
        struct vec3 up = ups ? ups[i] : upright;
        sum = vec3_add(sum, mat3_apply(mat3_transpose(v->cam_from_world), up));
        focal += sqrt(v->fx * v->fy) / (v->width > v->height ? v->width : v->height) / set->view_count;
    }
    center_up = ups ? ups[p->center] : upright;
    if (vec3_length(sum) < 0.1 * set->view_count) sum = mat3_apply(mat3_transpose(c->cam_from_world), center_up);
    p->up = vec3_normalize(sum);

    bool turned = fabs(center_up.x) > fabs(center_up.y);
    double w = turned ? c->height : c->width, h = turned ? c->width : c->height;
    double shrink = fmin(1, par->max_side / fmax(w, h));
    double width = par->width ? par->width : par->height ? par->height * w / h : w * shrink;
    double height = par->height ? par->height : par->width ? par->width * h / w : h * shrink;
    p->lens.width = (int)fmax(2, 2 * round(width / 2));
    p->lens.height = (int)fmax(2, 2 * round(height / 2));
    p->lens.cx = p->lens.width / 2.0;
    p->lens.cy = p->lens.height / 2.0;
    /* the film's picture lies within that of a photo of the centremost view's shape */
    p->lens.fx = p->lens.fy = focal * fmax(w, h) * fmax(p->lens.width / w, p->lens.height / h);
}

/* The film's camera at a place. */
static struct view aim(const struct plan *p, struct vec3 at, double zoom)
{
    struct view v = p->lens;
    struct vec3 z = vec3_normalize(vec3_sub(p->centroid, at));
    struct vec3 x = vec3_cross(z, p->up);
    if (vec3_length(x) < 0.01) x = row_of(center_view(p)->cam_from_world, 0); /* straight up or down */
    struct vec3 y = vec3_normalize(vec3_cross(z, x));
    x = vec3_cross(y, z);
    v.fx *= zoom;
    v.fy *= zoom;
    v.cam_from_world = (struct mat3){{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}}};
    v.center = at;
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, at), -1);
    return v;
}

/* The weight of the blobs in the picture; `near` gets that of those nearer than `limit`. Their depths go to
 * p->scratch. */
static size_t blobs_in_picture(const struct plan *p, const struct view *v, double limit, double *near, double *total)
{
    size_t n = 0;
    *near = *total = 0;
    for (size_t i = 0; i < p->blob_count; i++) {
        double u = -1, t = -1, z = view_project(v, p->blobs[i].position, &u, &t);
        if (z <= 0 || u < 0 || u > v->width || t < 0 || t > v->height) continue;
        *total += p->blobs[i].weight;
        if (z < limit) *near += p->blobs[i].weight;
        p->scratch[n++] = (struct sample){z, p->blobs[i].weight};
    }
    return n;
}

static enum status count_holes(struct plan *p, const struct view *v, double *holes, struct err *err)
{
    int side = v->width > v->height ? v->width : v->height;
    double scale = fmin(1, (double)p->params->check_side / side);
    if (layer_coverage(&p->coverage, p->scene, v, scale, err)) return err->status;
    *holes = p->coverage.hole_fraction;
    return ST_OK;
}

/* The part of the picture, at the centroid's depth, that lies beyond the borders of the views that the mesh names:
 * each pixel counts by the weight of the views that do not contain it. Other views may show it, but with a seam. */
static double outside(const struct plan *p, const struct view *v)
{
    const struct camera_set *set = p->scene->set;
    struct view_weights row[OUTSIDE_SIDE];
    struct view_mesh_camera mc;
    struct view small = *v;
    double scale = (double)OUTSIDE_SIDE / (v->width > v->height ? v->width : v->height), sum = 0, x, y;
    double depth = view_project(v, p->centroid, &x, &y);
    view_resize(&small, (int)fmax(1, floor(v->width * scale)), (int)fmax(1, floor(v->height * scale)));
    view_mesh_prepare(&mc, &p->scene->mesh, &small);
    for (int j = 0; j < small.height; j++) {
        view_mesh_row(&mc, j, row);
        for (int i = 0; i < small.width; i++) {
            struct vec3 point = view_unproject(&small, i + 0.5, j + 0.5, depth);
            for (int k = 0; k < row[i].count; k++) {
                const struct view *of = &set->views[row[i].view[k]];
                double u = -1, t = -1;
                if (!(view_project(of, point, &u, &t) > 0) || u < 0 || u > of->width || t < 0 || t > of->height)
                    sum += (double)row[i].weight[k];
            }
        }
    }
    return sum / (small.width * small.height);
}

/* -------------------------------------------------------------------------------------------------------- the ends */

static struct vec3 place(const struct plan *p, const struct way *w, double s)
{
    return vec3_add(center_view(p)->center, vec3_scale(w->direction, s));
}

/* The ends for a reach: symmetric where the views' extent allows it. */
static double low_end(const struct way *w, double reach) { return fmax(w->low, -reach); }
static double high_end(const struct way *w, double reach) { return fmin(w->high, reach); }

static double angle_at_centroid(const struct plan *p, const struct way *w, double reach)
{
    struct vec3 a = vec3_sub(place(p, w, low_end(w, reach)), p->centroid);
    struct vec3 b = vec3_sub(place(p, w, high_end(w, reach)), p->centroid);
    return atan2(vec3_length(vec3_cross(a, b)), vec3_dot(a, b)) * 180 / M_PI;
}

/* The largest reach within the views' extent and max_angle. */
static double angle_reach(const struct plan *p, const struct way *w)
{
    double good = 0, bad = fmax(-w->low, w->high);
    if (angle_at_centroid(p, w, bad) <= p->params->max_angle) return bad;
    for (int i = 0; i < 40; i++) {
        double middle = (good + bad) / 2;
        if (angle_at_centroid(p, w, middle) <= p->params->max_angle)
            good = middle;
        else
            bad = middle;
    }
    return good;
}

/* The ends first: they fail most. */
static const double places_in_order[PLACES] = {0, 1, 0.25, 0.75, 0.5};

static struct view camera_at(const struct plan *p, const struct way *w, double part)
{
    double low = low_end(w, w->reach), high = high_end(w, w->reach);
    return aim(p, place(p, w, low + part * (high - low)), w->zoom);
}

static enum status keeps_limits(struct plan *p, const struct way *w, bool *good, struct err *err)
{
    *good = true;
    for (int i = 0; i < PLACES && *good; i++) {
        struct view v = camera_at(p, w, places_in_order[i]);
        double near, total, holes = 0;
        blobs_in_picture(p, &v, p->near_limit, &near, &total);
        *good = near <= NEAR_TOLERANCE * total && outside(p, &v) <= p->outside_limit;
        if (!*good) break;
        if (count_holes(p, &v, &holes, err)) return err->status;
        *good = holes <= p->hole_limit;
    }
    return ST_OK;
}

/* Sets w->reach to the largest up to `most` that keeps the limits at w->zoom; the middle is known to keep them. */
static enum status find_reach(struct plan *p, struct way *w, double most, int steps, struct err *err)
{
    double good = 0, bad = most;
    bool keeps;
    w->reach = most;
    if (keeps_limits(p, w, &keeps, err)) return err->status;
    if (keeps) return ST_OK;
    for (int i = 0; i < steps; i++) {
        w->reach = (good + bad) / 2;
        if (keeps_limits(p, w, &keeps, err)) return err->status;
        if (keeps)
            good = w->reach;
        else
            bad = w->reach;
    }
    w->reach = good;
    return ST_OK;
}

/* The mean distance of a line's places to their nearest views, in units of the views' spacing. */
static double distance_to_views(const struct plan *p, const struct way *w)
{
    const struct camera_set *set = p->scene->set;
    double sum = 0;
    const int samples = 9;
    for (int i = 0; i < samples; i++) {
        struct vec3 at = camera_at(p, w, i / (samples - 1.0)).center;
        double nearest = HUGE_VAL;
        for (int k = 0; k < set->view_count; k++)
            nearest = fmin(nearest, vec3_length(vec3_sub(set->views[k].center, at)));
        sum += nearest / samples;
    }
    return p->scene->mesh.spacing > 0 ? sum / p->scene->mesh.spacing : 0;
}

static double length_of(const struct way *w) { return high_end(w, w->reach) - low_end(w, w->reach); }

static void find_extent(const struct plan *p, struct way *w)
{
    const struct camera_set *set = p->scene->set;
    struct vec3 center = center_view(p)->center;
    for (int i = 0; i < set->view_count; i++) {
        double s = p->params->extent * vec3_dot(w->direction, vec3_sub(set->views[i].center, center));
        w->low = fmin(w->low, s);
        w->high = fmax(w->high, s);
    }
    if (p->scene->mesh.rank == 0) {
        double reach = LONE_REACH * p->params->extent * vec3_length(vec3_sub(p->centroid, center));
        w->low = -reach;
        w->high = reach;
    }
}

/* Sets reach, zoom and merit of a direction, as far as its merit times `weight` can beat the best there is, which it
 * then replaces. min_zoom: from which the middle keeps the limits. */
static enum status explore(struct plan *p, struct vec3 direction, double weight, double min_zoom, struct way *best,
                           struct err *err)
{
    struct way w = {.direction = direction, .zoom = min_zoom};
    find_extent(p, &w);
    w.reach = angle_reach(p, &w);
    const double most = w.reach, promise = weight * length_of(&w) / (1 + distance_to_views(p, &w));
    for (int i = 0; most > 0; i++) {
        w.zoom = min_zoom + ZOOM_STEP * i;
        if (w.zoom > p->params->max_zoom + 1e-9 || promise / pow(w.zoom, ZOOM_COST) <= best->merit) break;
        if (find_reach(p, &w, most, SEARCH_STEPS, err)) return err->status;
        w.merit = weight * length_of(&w) / (pow(w.zoom, ZOOM_COST) * (1 + distance_to_views(p, &w)));
        if (w.merit > best->merit) *best = w;
    }
    return ST_OK;
}

/* The smallest zoom at which the centremost view's place keeps max_holes and max_outside; where none does, the
 * largest, and what is not kept is allowed as it is there, and a little more. */
static enum status find_min_zoom(struct plan *p, double *zoom, struct err *err)
{
    const double max_holes = p->params->max_holes, max_outside = p->params->max_outside;
    double holes = 0, beyond = 0;
    for (int i = 0;; i++) {
        *zoom = fmin(1 + ZOOM_STEP * i, p->params->max_zoom);
        struct view v = aim(p, center_view(p)->center, *zoom);
        beyond = outside(p, &v);
        if (count_holes(p, &v, &holes, err)) return err->status;
        if (holes <= max_holes && beyond <= max_outside) return ST_OK;
        if (*zoom >= p->params->max_zoom) break;
    }
    if (holes > max_holes) p->hole_limit = SLACK * holes;
    if (beyond > max_outside) p->outside_limit = SLACK * beyond;
    return ST_OK;
}

static enum status find_way(struct plan *p, struct way *best, struct err *err)
{
    const struct view_mesh *mesh = &p->scene->mesh;
    const double slope = sqrt(0.5);
    struct vec3 x = mesh->axis_x, y = mesh->axis_y;
    const struct vec3 directions[] = {x, y, vec3_scale(vec3_add(x, y), slope), vec3_scale(vec3_sub(x, y), slope)};
    double min_zoom;
    if (find_min_zoom(p, &min_zoom, err)) return err->status;
    *best = (struct way){.direction = x, .zoom = min_zoom};
    for (int i = 0; i < (mesh->rank == 2 ? 4 : 1); i++)
        if (explore(p, directions[i], i ? OTHER_WAY_WEIGHT : 1, min_zoom, best, err)) return err->status;
    if (best->reach > 0 && find_reach(p, best, angle_reach(p, best), FINAL_STEPS, err)) return err->status;
    return ST_OK;
}

/* --------------------------------------------------------------------------------------------------- the path */

/* How far a point on the middle camera's axis moves in the picture from one end to the other. */
static void displacement(const struct view *first, const struct view *middle, const struct view *last, double depth,
                         double d[2])
{
    struct vec3 point = view_unproject(middle, middle->cx, middle->cy, depth);
    double u[2] = {0}, v[2] = {0};
    view_project(first, point, &u[0], &v[0]);
    view_project(last, point, &u[1], &v[1]);
    d[0] = u[1] - u[0];
    d[1] = v[1] - v[0];
}

static enum status add_scores(struct camera_path *path, struct plan *p, const struct way *w, struct err *err)
{
    struct view first = camera_at(p, w, 0), middle = camera_at(p, w, 0.5), last = camera_at(p, w, 1);
    double near[2], far[2];
    displacement(&first, &middle, &last, p->near_depth, near);
    displacement(&first, &middle, &last, p->far_depth, far);
    if (camera_path_add_score(path, "length", vec3_length(vec3_sub(last.center, first.center)), "scene units", err) ||
        camera_path_add_score(path, "angle", angle_at_centroid(p, w, w->reach), "degrees", err) ||
        camera_path_add_score(path, "zoom", w->zoom, "", err) ||
        camera_path_add_score(path, "near_depth", p->near_depth, "scene units", err) ||
        camera_path_add_score(path, "far_depth", p->far_depth, "scene units", err) ||
        camera_path_add_score(path, "near_motion", hypot(near[0], near[1]), "px", err) ||
        camera_path_add_score(path, "far_motion", hypot(far[0], far[1]), "px", err) ||
        camera_path_add_score(path, "parallax", hypot(near[0] - far[0], near[1] - far[1]), "px", err) ||
        camera_path_add_score(path, "hole_limit", p->hole_limit, "", err) ||
        camera_path_add_score(path, "outside_limit", p->outside_limit, "", err))
        return err->status;
    for (int i = 0; i < PLACES; i++) {
        double part = i / (PLACES - 1.0), holes = 0;
        struct view v = camera_at(p, w, part);
        char name[32];
        snprintf(name, sizeof name, "holes_at_%g", part);
        if (count_holes(p, &v, &holes, err) || camera_path_add_score(path, name, holes, "", err)) return err->status;
        snprintf(name, sizeof name, "outside_at_%g", part);
        if (camera_path_add_score(path, name, outside(p, &v), "", err)) return err->status;
    }
    return ST_OK;
}

static void fill_frames(struct camera_path *path, const struct plan *p, const struct way *w)
{
    for (int i = 0; i < path->frame_count; i++) {
        double t = i / (path->frame_count - 1.0);
        if (!strcmp(p->params->ease, "smooth")) t = t * t * (3 - 2 * t);
        const char *name = path->frames[i].camera.name;
        path->frames[i].camera = camera_at(p, w, t);
        path->frames[i].camera.name = name;
    }
}

/* Near and far depth of what the film's middle shows, and the depth within which nothing may come. */
static enum status measure_depths(struct plan *p, struct err *err)
{
    struct view v = aim(p, center_view(p)->center, 1);
    double near, total;
    size_t n = blobs_in_picture(p, &v, 0, &near, &total);
    if (!n)
        return err_set(err, ST_DATA, "the centremost view %s shows nothing that has a depth.", center_view(p)->name);
    p->near_depth = percentile(p->scratch, n, NEAR_PERCENTILE);
    p->far_depth = percentile(p->scratch, n, FAR_PERCENTILE);
    p->near_limit = NEAR_FRACTION * p->near_depth;
    return ST_OK;
}

enum status plan_establishing_dolly(struct camera_path *path, struct dolly_notes *notes,
                                    const struct layer_scene *scene, const struct vec3 *ups,
                                    const struct plan_params *params, struct err *err)
{
    struct plan p = {
        .scene = scene, .params = params, .hole_limit = params->max_holes, .outside_limit = params->max_outside};
    struct way w = {0};
    *notes = (struct dolly_notes){0};
    if (plan_params_check(params, err)) return err->status;
    find_center_view(&p);
    enum status st = collect_blobs(&p, err);
    if (!st) st = find_centroid(&p, err);
    if (!st) {
        find_lens(&p, ups);
        st = measure_depths(&p, err);
    }
    if (!st) st = find_way(&p, &w, err);
    if (!st) {
        struct view middle = aim(&p, center_view(&p)->center, 1); /* to the right, or upwards */
        double right = vec3_dot(w.direction, row_of(middle.cam_from_world, 0));
        double upward = vec3_dot(w.direction, p.up);
        if (fabs(right) > 0.1 ? right < 0 : upward < 0) {
            double low = w.low;
            w.direction = vec3_scale(w.direction, -1);
            w.low = -w.high;
            w.high = -low;
        }
        st = camera_path_init(path, "establishing_dolly", params->fps, (int)round(params->seconds * params->fps), err);
    }
    if (!st) {
        fill_frames(path, &p, &w);
        st = add_scores(path, &p, &w, err);
        *notes =
            (struct dolly_notes){center_view(&p)->name, w.zoom, p.hole_limit, p.outside_limit, !(length_of(&w) > 0)};
    }
    rendered_frame_release(&p.coverage);
    free(p.blobs);
    free(p.scratch);
    if (st) camera_path_release(path);
    return st;
}
