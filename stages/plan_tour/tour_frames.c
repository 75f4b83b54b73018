/* tour_frames.c - the frames of a tour; see tour_frames.h.
 *
 * On a leg from one stop to the next the camera walks from viewpoint to viewpoint at a constant speed. It begins with
 * the axis of the first photo and looks along the way one second later; each inner viewpoint looks towards the next
 * one; half a second before the end it begins to turn to the axis of the last photo. At each stop it rests a moment.
 *
 * [Colburn 2014, 4.7.1] interpolates axes linearly. Here their azimuth and elevation are, because vectors that point in
 * opposite directions have nothing between them. No turn is faster than `turn`: one second and half a second become
 * longer where the camera turns farther, and a way takes at least as long as the turns on it, so that two photographs
 * from one place do not make a jump. */
#include "stages/plan_tour/tour_frames.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/light/model_clearance.h"

static const double ease_out = 1, ease_in = 0.5; /* seconds */
static const double same_place = 1e-9;           /* model units */
static const double STEEPEST = 20;               /* degrees: of a look up or down */

struct keys {
    struct tour_key **list;
    int *count;
    const struct tour_graph *g;
    const struct tour_params *params;
    const struct tour_stop *from, *to; /* of the leg */
    struct err *err;
};

static double azimuth_of(struct vec3 axis) { return atan2(axis.y, axis.x); }

static double elevation_of(struct vec3 axis) { return atan2(axis.z, hypot(axis.x, axis.y)); }

static enum status add_key(const struct keys *k, double time, struct vec3 at, double azimuth, double elevation,
                           int node)
{
    if (array_append(k->list, (size_t)*k->count, sizeof **k->list, "places of a tour", k->err)) return k->err->status;
    const struct tour_key *last = *k->count ? &(*k->list)[*k->count - 1] : NULL;
    if (last) azimuth = last->azimuth + remainder(azimuth - last->azimuth, 2 * M_PI);
    (*k->list)[(*k->count)++] = (struct tour_key){time, at, azimuth, elevation, node};
    return ST_OK;
}

static enum status add_axis(const struct keys *k, double time, struct vec3 at, struct vec3 axis, int node)
{
    return add_key(k, time, at, azimuth_of(axis), elevation_of(axis), node);
}

/* Towards the place that a stop looks at, from a node; not far up or down, which people rarely look. */
static struct vec3 gaze(const struct tour_node *node, const struct tour_stop *stop)
{
    const struct vec3 way = vec3_sub(stop->look, node->centre);
    const double level = hypot(way.x, way.y), steepest = level * tan(STEEPEST * M_PI / 180);
    return vec3_normalize(vec3_make(way.x, way.y, fmax(-steepest, fmin(steepest, way.z))));
}

static struct vec3 stop_axis(const struct tour_graph *g, const struct tour_stop *stop)
{
    return stop->looks ? gaze(&g->nodes[stop->node], stop) : g->nodes[stop->node].axis;
}

/* Whether the eyes stay on one place from stop to stop. */
static bool keeps_looking(const struct keys *k)
{
    return k->from->looks && k->to->looks && vec3_length(vec3_sub(k->from->look, k->to->look)) <= same_place;
}

/* The axis that a node of a leg has: its stop's at the ends; between them towards what both look at, else towards the
 * next node, or its own photo's if that is here. */
static struct vec3 node_axis(const struct keys *k, const int *leg, int count, int i)
{
    const struct tour_graph *g = k->g;
    if (i == 0 || i == count - 1) return stop_axis(g, i ? k->to : k->from);
    if (keeps_looking(k)) return gaze(&g->nodes[leg[i]], k->to);
    const struct vec3 ahead = vec3_sub(g->nodes[leg[i + 1]].centre, g->nodes[leg[i]].centre);
    return vec3_length(ahead) > same_place ? vec3_normalize(ahead) : g->nodes[leg[i]].axis;
}

/* How far the camera turns from one axis to another: about the vertical plus up or down, which the axis itself does not
 * exceed. */
static double way_turn(struct vec3 a, struct vec3 b)
{
    return fabs(remainder(azimuth_of(b) - azimuth_of(a), 2 * M_PI)) + fabs(elevation_of(b) - elevation_of(a));
}

/* Seconds of a way between two nodes of a leg: on the whole, of easing out of the first photo's axis (0: this is not
 * the leg's first way), and of easing into the last one's. */
struct way_times {
    double whole, out, in;
};

static struct way_times way_times(const struct keys *k, const int *leg, int count, int i)
{
    const struct vec3 a = node_axis(k, leg, count, i), b = node_axis(k, leg, count, i + 1);
    const struct vec3 way = vec3_sub(k->g->nodes[leg[i + 1]].centre, k->g->nodes[leg[i]].centre);
    const double d = vec3_length(way), walk = d / (k->to->speed * k->g->unit), turn = k->params->turn * M_PI / 180;
    const bool first = i == 0, last = i + 2 == count;
    struct way_times t = {0};
    if (d <= same_place || keeps_looking(k)) { /* it only turns, or has its eyes elsewhere than on the way */
        t.whole = fmax(walk, way_turn(a, b) / turn);
        return t;
    }
    if (first) t.out = fmax(ease_out, way_turn(a, way) / turn);
    if (last) t.in = fmax(ease_in, way_turn(way, b) / turn);
    t.whole = fmax(walk, t.out + (last ? t.in : way_turn(way, b) / turn));
    return t;
}

/* A key between two nodes, at a time after the first, which looks along the way. */
static enum status add_ease(const struct keys *k, const int *leg, int i, double start, double after, double whole)
{
    const struct vec3 a = k->g->nodes[leg[i]].centre, b = k->g->nodes[leg[i + 1]].centre, way = vec3_sub(b, a);
    if (vec3_length(way) <= same_place || !(whole > 0)) return ST_OK;
    return add_axis(k, start + after, vec3_add(a, vec3_scale(way, after / whole)), vec3_normalize(way), leg[i]);
}

/* Adds the keys of a leg after its first node. *time: at its first node, then at its last. */
static enum status add_leg(const struct keys *k, const int *leg, int count, double *time)
{
    for (int i = 0; !k->err->status && i + 1 < count; i++) {
        const struct way_times t = way_times(k, leg, count, i);
        if (t.out > 0) add_ease(k, leg, i, *time, t.out, t.whole);
        if (!k->err->status && t.in > 0 && t.whole - t.in > t.out + 1e-9)
            add_ease(k, leg, i, *time, t.whole - t.in, t.whole);
        *time += t.whole;
        if (!k->err->status)
            add_axis(k, *time, k->g->nodes[leg[i + 1]].centre, node_axis(k, leg, count, i + 1), leg[i + 1]);
    }
    return k->err->status;
}

/* The nodes of the shortest way; the caller frees them. */
static enum status find_leg(int **leg, int *count, const struct tour_graph *g, int from, int to, struct err *err)
{
    const size_t n = (size_t)g->count;
    double *costs = malloc((n + 1) * sizeof *costs);
    int *before = malloc((n + 1) * sizeof *before);
    *leg = malloc((n + 1) * sizeof **leg);
    *count = 0;
    if (!costs || !before || !*leg) err_nomem(err, "ways", n * sizeof *costs);
    if (!err->status) tour_shortest(costs, before, g, from, err);
    for (int at = err->status ? -1 : to; at >= 0; at = before[at]) (*leg)[(*count)++] = at;
    for (int i = 0; i < *count / 2; i++) {
        const int swap = (*leg)[i];
        (*leg)[i] = (*leg)[*count - 1 - i];
        (*leg)[*count - 1 - i] = swap;
    }
    free(costs);
    free(before);
    return err->status;
}

enum status tour_keys_make(struct tour_key **keys, int *count, const struct tour_graph *g,
                           const struct tour_stop *stops, int stop_count, const struct tour_params *params,
                           struct err *err)
{
    struct keys k = {keys, count, g, params, stops, stops, err};
    double time = params->hold;
    *keys = NULL;
    *count = 0;
    const struct vec3 begin = stop_axis(g, &stops[0]), start = g->nodes[stops[0].node].centre;
    if (!add_axis(&k, 0, start, begin, stops[0].node)) add_axis(&k, time, start, begin, stops[0].node);
    for (int i = 0; !err->status && i + 1 < stop_count; i++) {
        int *leg = NULL, nodes = 0;
        find_leg(&leg, &nodes, g, stops[i].node, stops[i + 1].node, err);
        k.from = &stops[i];
        k.to = &stops[i + 1];
        if (!err->status) add_leg(&k, leg, nodes, &time);
        free(leg);
        if (stops[i + 1].passes) continue;
        time += params->hold;
        if (!err->status)
            add_axis(&k, time, g->nodes[stops[i + 1].node].centre, stop_axis(g, &stops[i + 1]), stops[i + 1].node);
    }
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- frames */

/* The key that begins the interval of a time. */
static int interval_of(const struct tour_key *keys, int count, double time)
{
    int i = 0;
    while (i + 2 < count && keys[i + 1].time <= time) i++;
    return i;
}

static struct view camera_at(const struct tour_key *a, const struct tour_key *b, double t,
                             const struct tour_params *params)
{
    const double azimuth = a->azimuth + t * (b->azimuth - a->azimuth);
    const double elevation = a->elevation + t * (b->elevation - a->elevation);
    const struct vec3 z = {cos(elevation) * cos(azimuth), cos(elevation) * sin(azimuth), sin(elevation)};
    const struct vec3 x = {sin(azimuth), -cos(azimuth), 0}, y = vec3_cross(z, x);
    struct view v = {.width = params->width, .height = params->height};
    v.cam_from_world = (struct mat3){{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}}};
    v.center = vec3_add(a->at, vec3_scale(vec3_sub(b->at, a->at), t));
    v.fx = v.fy = params->width / (2 * tan(params->fov * M_PI / 360));
    v.cx = params->width / 2.0;
    v.cy = params->height / 2.0;
    return v;
}

/* From the model's frame to that of O/views. */
static void move_to_scene(struct view *v, const struct model_axes *axes)
{
    v->cam_from_world = mat3_multiply(v->cam_from_world, mat3_from_quat(axes->rotation));
    v->center = world_from_model_point(axes, v->center);
    v->translation = vec3_scale(mat3_apply(v->cam_from_world, v->center), -1);
}

/* The viewpoints on either side of a key's interval, and how far the camera is between them. */
static enum status add_pair(struct viewpoint_pairs *pairs, const char *frame, const struct tour_graph *g,
                            const struct tour_key *keys, int count, int i, double time, struct vec3 at, struct err *err)
{
    int next = i + 1;
    const int from = keys[i].node;
    while (next + 1 < count && keys[next].node == from) next++;
    const int to = keys[next].node;
    const struct vec3 a = g->nodes[from].centre, b = g->nodes[to].centre;
    const double whole = vec3_length(vec3_sub(b, a)), gone = vec3_length(vec3_sub(at, a));
    double t = 0;
    if (whole > same_place)
        t = gone / whole;
    else if (to != from && i == next - 1 && keys[next].time > keys[i].time) /* in one place the time counts */
        t = (time - keys[i].time) / (keys[next].time - keys[i].time);
    return viewpoint_pairs_add(pairs, frame, g->nodes[from].photo, g->nodes[to].photo, fmin(1, t), err);
}

enum status tour_frames_make(struct camera_path *path, struct viewpoint_pairs *pairs, const struct tour_key *keys,
                             int key_count, const struct tour_graph *g, const struct model_axes *axes,
                             const struct model_rays *model, const struct tour_params *params, struct err *err)
{
    const double end = keys[key_count - 1].time;
    const int frames = 1 + (int)floor(end * params->fps + 1e-9);
    camera_path_init(path, "tour", params->fps, frames, err);
    for (int f = 0; !err->status && f < frames; f++) {
        const double time = f / params->fps;
        const int i = interval_of(keys, key_count, time);
        const double whole = keys[i + 1].time - keys[i].time;
        const double t = whole > 0 ? fmin(1, (time - keys[i].time) / whole) : 1;
        struct view camera = camera_at(&keys[i], &keys[i + 1], t, params);
        const struct vec3 at = camera.center;
        /* a hair less, as a place on a way is rounded */
        if (!model_rays_way_is_free(model, at, at, (1 - 1e-9) * params->clearance))
            return err_set(err, ST_INTERNAL, "frame %d of the tour is nearer to the model than the clearance of %.3g.",
                           f + 1, params->clearance);
        move_to_scene(&camera, axes);
        camera.name = path->frames[f].camera.name;
        path->frames[f].camera = camera;
        add_pair(pairs, camera.name, g, keys, key_count, i, time, at, err);
    }
    return err->status;
}
