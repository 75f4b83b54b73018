/* ball_thing.h - shared by tests of relighting: the products of find_things for one thing, a ball. */
#ifndef REMODEL_TESTS_BALL_THING_H
#define REMODEL_TESTS_BALL_THING_H

#include "tests/unit/scratch.h"

#include "common/model/thing_list.h"
#include "common/model/thing_volume.h"
#include "common/texture/texture_map.h"

enum { BALL = 1, BALL_SIDE = 40 };

/* A ball of the name "ball" in the room of 4 x 4 x 4 about the origin, which touches nothing: voxels of 0.1, seen from
 * all sides. Its radiance is that of a grey. The result is the folder of things, in scratch. */
static inline const char *write_ball(struct vec3 middle, double radius, double radiance)
{
    static uint32_t id[BALL_SIDE * BALL_SIDE * BALL_SIDE];
    static float distance[BALL_SIDE * BALL_SIDE * BALL_SIDE];
    static char folder[PATH_MAX];
    const struct thing_volume v = {{{-2, -2, -2}, 0.1, {BALL_SIDE, BALL_SIDE, BALL_SIDE}}, id, distance};
    const struct provenance no_inputs = {.stage = "test", .version = "1"};
    const struct vec3 half = vec3_make(radius, radius, radius);
    struct thing thing = {.name = (char *)"ball",
                          .support = THING_ON_NONE,
                          .low = vec3_sub(middle, half),
                          .high = vec3_add(middle, half),
                          .voxels = 10,
                          .views = 1,
                          .view = (char *)"a",
                          .radiance = {radiance, radiance, radiance}};
    for (int k = 0; k < THING_SIDES; k++) memcpy(thing.sides[k], thing.radiance, sizeof thing.sides[k]);
    const struct thing_list list = {&thing, 1};
    struct err err = ERR_INIT;
    for (int64_t i = 0; i < (int64_t)voxel_count(&v.grid); i++) {
        const double d = vec3_length(vec3_sub(thing_voxel_centre(&v.grid, i), middle)) - radius;
        id[i] = d < 0.2 ? BALL : 0;
        distance[i] = id[i] ? (float)fmax(-1, d / 0.2) : THING_UNSEEN;
    }
    snprintf(folder, sizeof folder, "%s/things", scratch);
    mkdir(folder, 0777);
    assert_ok(thing_list_write(&list, scratch_path("things/things.txt"), &no_inputs, &err), err);
    assert_ok(thing_volume_write(&v, scratch_path("things/volume.exr"), &no_inputs, &err), err);
    return folder;
}

static inline struct texture_thing edit_ball(enum texture_thing_kind kind, double x, double y, double turn)
{
    return (struct texture_thing){kind, (char *)"ball", (char *)"ball", {x, y, 0}, turn, (char *)"e.txt", 2};
}

#endif
