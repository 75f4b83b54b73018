/* level_room.h - shared by tests of light_levels: rooms of boxes, with a lamp or a sky, and their light. */
#ifndef REMODEL_TESTS_LEVEL_ROOM_H
#define REMODEL_TESTS_LEVEL_ROOM_H

#include "tests/unit/box_solids.h"

#include "common/math/numbers.h"
#include "stages/light_levels/radiosity.h"

/* A room of 4 x 4 x 3 m whose walls are 2 mm thick, with a hole of 2 x 1.5 m in the wall y = 0. */
#define THIN 0.002
enum { ROOM_BOXES = 9 };
static const struct box room_with_hole[] = {
    {"walls", "floor", {-THIN, -THIN, -THIN}, {4 + THIN, 4 + THIN, 0}, false},
    {"walls", "ceiling", {-THIN, -THIN, 3}, {4 + THIN, 4 + THIN, 3 + THIN}, false},
    {"walls", "west", {-THIN, -THIN, 0}, {0, 4 + THIN, 3}, false},
    {"walls", "east", {4, -THIN, 0}, {4 + THIN, 4 + THIN, 3}, false},
    {"walls", "north", {0, 4, 0}, {4, 4 + THIN, 3}, false},
    {"walls", "below", {0, -THIN, 0}, {4, 0, 1}, false},
    {"walls", "above", {0, -THIN, 2.5}, {4, 0, 3}, false},
    {"walls", "left", {0, -THIN, 1}, {1, 0, 2.5}, false},
    {"walls", "right", {3, -THIN, 1}, {4, 0, 2.5}, false},
};
static const struct box closed_room[] = {ROOM_OUTSIDE, ROOM_INSIDE};

static inline void assert_near(double found, double wanted, double tolerance)
{
    if (!(fabs(found - wanted) <= tolerance)) fail_msg("found %.9g, wanted %.9g +- %g", found, wanted, tolerance);
}

struct room {
    struct model_field field;
    struct lamp lamp;
    struct field_lamp ready;
    struct daylight opening;
    struct light_groups groups;
    struct light_patches patches;
    struct light_rows rows;
    struct patch_colour *colours;
    struct radiosity light;
};

static char window_name[] = "hole", lamp_name[] = "spot";

static inline void start(struct room *r, const struct box *list, int count)
{
    *r = (struct room){.field.model = make_rays(list, count)};
    struct model_field *f = &r->field;
    f->atlas.ids = f->model.ids;
    f->atlas.first = calloc((size_t)f->model.ids + 1, sizeof *f->atlas.first);
    f->reach = 0.01;
}

/* A lamp of radiance 100 in the ceiling of the closed room. */
static inline void add_lamp(struct room *r)
{
    r->lamp = (struct lamp){.name = lamp_name,
                            .shape = LAMP_DISK,
                            .centre = {0.5, 0.3, 2},
                            .normal = {0, 0, -1},
                            .x = {0.3, 0, 0},
                            .y = {0, 0.3, 0},
                            .radius = 0.3,
                            .radiance = {100, 100, 100},
                            .beta = PI / 2};
    r->ready = (struct field_lamp){.lamp = &r->lamp};
    r->field.lights = (struct light_list){.lamps = &r->lamp, .lamp_count = 1};
    r->field.lamps = &r->ready;
}

/* A sky of radiance 1 on all sides, seen through the hole. */
static inline void add_sky(struct room *r)
{
    struct err err = ERR_INIT;
    r->opening = (struct daylight){
        .name = window_name, .centre = {2, 0, 1.75}, .x = {1, 0, 0}, .y = {0, 0, 0.75}, .normal = {0, 1, 0}};
    r->field.lights = (struct light_list){.openings = &r->opening, .opening_count = 1};
    assert_ok(outdoors_init(&r->field.outdoors, 16, &err), err);
    for (int i = 0; i < 3 * 16 * 32; i++) r->field.outdoors.rgb[i] = 1;
    assert_ok(field_sky_find(&r->field.sky, &r->field.outdoors, &err), err);
}

static inline void trace_with(struct room *r, int patches, int rays, double reflectance, uint64_t key, bool hours)
{
    struct err err = ERR_INIT;
    assert_ok(groups_make(&r->groups, &r->field, hours, &err), err);
    assert_ok(patches_make(&r->patches, &r->field, patches, NULL, NULL, &err), err);
    struct row_place *places = calloc((size_t)r->patches.count, sizeof *places);
    for (int i = 0; i < r->patches.count; i++)
        places[i] = (struct row_place){r->patches.list[i].origins, r->patches.list[i].origin_count};
    assert_ok(rows_trace(&r->rows, &r->groups, &r->patches, places, r->patches.count, rays, key, "patches", &err), err);
    free(places);
    r->colours = calloc((size_t)r->patches.count, sizeof *r->colours);
    for (int i = 0; i < r->patches.count; i++) r->colours[i].reflectance = rgb_grey(reflectance);
}

static inline void trace(struct room *r, int patches, int rays, double reflectance)
{
    trace_with(r, patches, rays, reflectance, 1, true);
}

static inline void solve(struct room *r)
{
    struct err err = ERR_INIT;
    radiosity_release(&r->light);
    assert_ok(radiosity_solve(&r->light, &r->rows, r->colours, r->groups.rest, 1e-6, &err), err);
}

static inline void release(struct room *r)
{
    radiosity_release(&r->light);
    rows_release(&r->rows);
    patches_release(&r->patches);
    groups_release(&r->groups);
    free(r->colours);
    free(r->field.atlas.first);
    outdoors_release(&r->field.outdoors);
    model_rays_release(&r->field.model);
}

/* Irradiance at a row from all groups of [first, end), green. */
static inline double sum_groups(const struct room *r, const struct light_rows *at, int row, int first, int end)
{
    float *found = calloc(3 * (size_t)at->groups, sizeof *found);
    double sum = 0;
    radiosity_gather(found, at, row, &r->light);
    for (int g = first; g < end; g++) sum += (double)found[3 * g + 1];
    free(found);
    return sum;
}

static inline struct light_rows rows_with(const struct room *r, const struct gather_point *points, int count, int rays,
                                          uint64_t key)
{
    struct row_place places[8];
    struct light_rows rows;
    struct err err = ERR_INIT;
    for (int i = 0; i < count; i++) places[i] = (struct row_place){&points[i], 1};
    assert_ok(rows_trace(&rows, &r->groups, &r->patches, places, count, rays, key, "points", &err), err);
    return rows;
}

static inline struct light_rows rows_at(const struct room *r, const struct gather_point *points, int count, int rays)
{
    return rows_with(r, points, count, rays, 1000000);
}

#endif
