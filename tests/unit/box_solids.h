/* box_solids.h - shared by tests: solids made of boxes, and cameras that look at them. */
#ifndef REMODEL_TESTS_BOX_SOLIDS_H
#define REMODEL_TESTS_BOX_SOLIDS_H

#include "tests/unit/scratch.h"

#include "common/capture/camera_set.h"
#include "common/light/model_rays.h"
#include "common/model/solid_mesh.h"

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

/* The caller releases it. */
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

/* A camera at p that looks along +z, turned by `turn` radians about its y axis, and by `nod` about its x axis
 * before. */
static inline struct view view_at(struct vec3 p, double turn, double nod, int width, int height, double focal)
{
    const double c = cos(turn), s = sin(turn), d = cos(nod), e = sin(nod);
    const struct mat3 yaw = {{{c, 0, -s}, {0, 1, 0}, {s, 0, c}}}, pitch = {{{1, 0, 0}, {0, d, -e}, {0, e, d}}};
    struct view v = {"v",       width, height, focal, focal, width / 2.0, height / 2.0, mat3_multiply(pitch, yaw),
                     {0, 0, 0}, p};
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, p), -1);
    return v;
}

#endif
