/* walk.h - shared by the tests of plan_tour: a flat of boxes, viewpoints in it, tours through it. */
#ifndef REMODEL_TESTS_WALK_H
#define REMODEL_TESTS_WALK_H

#include "tests/unit/box_solids.h"

#include <math.h>

#include "common/light/model_clearance.h"
#include "stages/plan_tour/tour_frames.h"
#include "stages/plan_tour/tour_stops.h"

/* A hall of 6 x 4 x 2.5, with walls 0.3 thick; z up, the floor at 0. */
#define HALL_OUTSIDE                                               \
    {                                                              \
        "walls", "out", {-3.3, -2.3, -0.3}, {3.3, 2.3, 2.8}, false \
    }
#define HALL_INSIDE                                   \
    {                                                 \
        "walls", "in", {-3, -2, 0}, {3, 2, 2.5}, true \
    }
/* A partition 2 cm thick at x = 0, from wall to wall or with a gap of 1.2 at the wall y = 2. */
#define PARTITION                                                                          \
    {                                                                                      \
        "wall/partition", "partition", {-0.01, -1.999, 0.001}, {0.01, 1.999, 2.499}, false \
    }
#define PARTITION_WITH_GAP                                                               \
    {                                                                                    \
        "wall/partition", "partition", {-0.01, -1.999, 0.001}, {0.01, 0.8, 2.499}, false \
    }

enum { MAX_PHOTOS = 8 };

struct place {
    const char *photo;
    struct vec3 at;
    double azimuth; /* degrees */
};

/* Everything that a tour is made from. params may be changed before walk_graph(). */
struct walk {
    struct model_rays rays;
    struct view views[MAX_PHOTOS];
    struct lens lenses[MAX_PHOTOS];
    struct camera_set set;
    struct lens_list list;
    struct model_axes axes;
    struct tour_params params;
    struct tour_graph g;
    struct tour_stop *stops;
    int stop_count;
    struct tour_key *keys;
    int key_count;
    struct camera_path path;
    struct viewpoint_pairs pairs;
};

static inline struct view upright_view(const char *name, struct vec3 at, double azimuth)
{
    const double a = azimuth * M_PI / 180;
    struct view v = {.name = name, .width = 64, .height = 48, .fx = 40, .fy = 40, .cx = 32, .cy = 24, .center = at};
    v.cam_from_world = (struct mat3){{{sin(a), -cos(a), 0}, {0, 0, -1}, {cos(a), sin(a), 0}}};
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, at), -1);
    return v;
}

/* places: in order of photo. */
static inline void walk_make(struct walk *w, const struct box *boxes, int box_count, const struct place *places,
                             int count)
{
    struct err err = ERR_INIT;
    *w = (struct walk){.rays = {.mesh = make_boxes(boxes, box_count)},
                       .axes = {.rotation = {1, 0, 0, 0}, .scale = 1, .metric = true},
                       .params = TOUR_PARAMS_DEFAULT};
    assert_ok(model_rays_build(&w->rays, MODEL_WITH_GLASS, &err), err);
    for (int i = 0; i < count; i++) {
        w->views[i] = upright_view(places[i].photo, places[i].at, places[i].azimuth);
        w->lenses[i] = (struct lens){
            .view = (char *)places[i].photo, .photo = (char *)places[i].photo, .view_from_photo = {1, 0, 0, 0}};
    }
    w->set = (struct camera_set){.views = w->views, .view_count = count};
    w->list = (struct lens_list){w->lenses, count};
}

static inline enum status walk_graph(struct walk *w, struct err *err)
{
    return tour_graph_make(&w->g, &w->set, &w->list, &w->axes, &w->rays, &w->params, err);
}

/* A tour over nodes of the graph. */
static inline void walk_along(struct walk *w, const int *nodes, int count)
{
    struct tour_stop stops[MAX_PHOTOS];
    for (int i = 0; i < count; i++) stops[i] = (struct tour_stop){.node = nodes[i], .speed = w->params.speed};
    struct err err = ERR_INIT;
    assert_ok(tour_keys_make(&w->keys, &w->key_count, &w->g, stops, count, &w->params, &err), err);
    assert_ok(tour_frames_make(&w->path, &w->pairs, w->keys, w->key_count, &w->g, &w->axes, &w->rays, &w->params, &err),
              err);
    assert_int_equal(w->pairs.count, w->path.frame_count);
}

static inline void walk_release(struct walk *w)
{
    free(w->stops);
    free(w->keys);
    camera_path_release(&w->path);
    viewpoint_pairs_release(&w->pairs);
    tour_graph_release(&w->g);
    model_rays_release(&w->rays);
}

static inline struct vec3 axis_of(const struct view *v)
{
    return vec3_make(v->cam_from_world.m[2][0], v->cam_from_world.m[2][1], v->cam_from_world.m[2][2]);
}

static inline double angle_between(struct vec3 a, struct vec3 b)
{
    return atan2(vec3_length(vec3_cross(a, b)), vec3_dot(a, b));
}

#endif
