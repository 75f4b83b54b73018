/* room.h - shared by the tests of trace_ids: models of boxes, and views of them. The scene's frame is the model's. */
#ifndef REMODEL_TESTS_ROOM_H
#define REMODEL_TESTS_ROOM_H

#include "tests/unit/scratch.h"

#include "stages/trace_ids/view_trace.h"

enum { MAX_BOXES = 16 };

struct box {
    const char *body, *name; /* faces are NAME/0 ... NAME/5: -x +x -y +y -z +z */
    struct vec3 low, high;
    bool cavity; /* the inner surface of a room: normals point into the box */
};

static inline double vec3_axis(struct vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/* A solid of boxes; those of a body are contiguous. */
static inline struct solid_mesh make_boxes(const struct box *boxes, int count)
{
    static const int around[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    struct vec3 vertices[8 * MAX_BOXES];
    struct solid_polygon polygons[6 * MAX_BOXES];
    int corners[24 * MAX_BOXES], sizes[6 * MAX_BOXES];
    char names[6 * MAX_BOXES][64];
    struct solid_mesh mesh = {0};
    struct err err = ERR_INIT;
    assert_true(count <= MAX_BOXES);
    for (int b = 0; b < count; b++) {
        const struct vec3 *end[2] = {&boxes[b].low, &boxes[b].high};
        for (int k = 0; k < 8; k++) vertices[8 * b + k] = vec3_make(end[k & 1]->x, end[k >> 1 & 1]->y, end[k >> 2]->z);
        for (int side = 0; side < 6; side++) {
            const int axis = side / 2, at = 6 * b + side, u = (axis + 1) % 3, v = (axis + 2) % 3;
            const bool reversed = (side % 2 == 0) != boxes[b].cavity;
            for (int k = 0; k < 4; k++) {
                const int *c = around[reversed ? 3 - k : k];
                corners[4 * at + k] = 8 * b + (side % 2 << axis) + (c[0] << u) + (c[1] << v);
            }
            double normal[3] = {0};
            normal[axis] = reversed ? -1 : 1;
            const double place = vec3_axis(*end[side % 2], axis);
            snprintf(names[at], sizeof names[at], "%s/%d", boxes[b].name, side);
            sizes[at] = 4;
            polygons[at] = (struct solid_polygon){names[at],
                                                  boxes[b].body,
                                                  vec3_make(normal[0], normal[1], normal[2]),
                                                  normal[axis] * place,
                                                  corners + 4 * at,
                                                  sizes + at,
                                                  1};
        }
    }
    assert_ok(solid_mesh_make(&mesh, vertices, 8 * count, polygons, 6 * count, NULL, &err), err);
    return mesh;
}

static inline struct model_rays make_rays(const struct box *boxes, int count)
{
    struct model_rays m = {.mesh = make_boxes(boxes, count)};
    struct err err = ERR_INIT;
    assert_ok(model_rays_build(&m, MODEL_WITH_GLASS, &err), err);
    return m;
}

/* A room of 4 x 4 x 4 about the origin, with walls 1 thick. */
#define ROOM_OUTSIDE                                   \
    {                                                  \
        "walls", "out", {-3, -3, -3}, {3, 3, 3}, false \
    }
#define ROOM_INSIDE                                  \
    {                                                \
        "walls", "in", {-2, -2, -2}, {2, 2, 2}, true \
    }

static const struct model_axes same_frame = {.rotation = {1, 0, 0, 0}, .scale = 1};

/* A camera at p that looks along +z, turned by `turn` radians about its y axis, and by `nod` about its x axis before. */
static inline struct view view_at(struct vec3 p, double turn, double nod, int width, int height, double focal)
{
    const double c = cos(turn), s = sin(turn), d = cos(nod), e = sin(nod);
    const struct mat3 yaw = {{{c, 0, -s}, {0, 1, 0}, {s, 0, c}}}, pitch = {{{1, 0, 0}, {0, d, -e}, {0, e, d}}};
    struct view v = {"v",       width, height, focal, focal, width / 2.0, height / 2.0, mat3_multiply(pitch, yaw),
                     {0, 0, 0}, p};
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, p), -1);
    return v;
}

struct seen {
    struct view_trace trace;
    struct view_ids ids;
    struct layered_depth depth;
};

/* Traces a view; its depth has one segment of confidence 1 that is everywhere z (0: where the model is). */
static inline struct seen see(const struct model_rays *m, const struct view *view, double z)
{
    const struct trace_params params = TRACE_PARAMS_DEFAULT;
    struct seen s = {0};
    struct err err = ERR_INIT;
    assert_ok(view_trace(&s.trace, m, &same_frame, view, &err), err);
    assert_ok(view_ids_init(&s.ids, view->width, view->height, &err), err);
    view_trace_ids(&s.ids, &s.trace);
    assert_ok(layered_depth_init(&s.depth, view->width, view->height, &err), err);
    s.depth.segments = calloc(3, sizeof *s.depth.segments);
    s.depth.segment_count = 3;
    for (int i = 0; i < 3; i++)
        s.depth.segments[i] = (struct depth_segment){.id = (uint32_t)i + 1, .sigma = 0.02, .confidence = 1};
    for (int i = 0; i < view->width * view->height; i++) {
        s.depth.interior.id[i] = 1;
        s.depth.interior.z[i] = z > 0 ? (float)z : s.ids.z[i];
    }
    assert_ok(find_jumps(&s.ids, &s.trace, &s.depth, &params, &err), err);
    assert_ok(find_clutter(&s.ids, &s.trace, &s.depth, 1, &params, &err), err);
    return s;
}

static inline void see_release(struct seen *s)
{
    view_trace_release(&s->trace);
    view_ids_release(&s->ids);
    layered_depth_release(&s->depth);
}

static inline int id_of(const struct model_rays *m, const char *name)
{
    for (int i = 0; i < m->mesh.name_count; i++)
        if (!strcmp(m->mesh.names[i].name, name)) return m->mesh.names[i].id;
    fail_msg("no face %s", name);
    return 0;
}

#endif
