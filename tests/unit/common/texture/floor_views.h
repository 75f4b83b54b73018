/* floor_views.h - a floor and cameras that look straight down on it, for tests of textures.
 *
 * The floor is a square of 4 x 4 at z = 0, with id 5. All cameras are at a height of 4, so a pixel is 1/16 wide on
 * it. */
#ifndef REMODEL_TESTS_FLOOR_VIEWS_H
#define REMODEL_TESTS_FLOOR_VIEWS_H

#include "common/texture/bake.h"
#include "tests/unit/scratch.h"

enum { SIZE = 64, ID = 5 };
static const double FOCAL = 64, HEIGHT = 4;

static struct vec3 floor_triangles[2][3] = {{{0, 0, 0}, {4, 0, 0}, {4, 4, 0}}, {{0, 0, 0}, {4, 4, 0}, {0, 4, 0}}};
static struct surface floor_surface = {.id = ID, .normal = {0, 0, 1}, .triangles = 2};
static const struct surfaces floor_only = {&floor_surface, floor_triangles, 1, 2, 4};

/* A view from above (x, y) that shows nothing yet. */
static void floor_view(struct source_view *v, double x, double y)
{
    *v = (struct source_view){
        .camera = {.name = "v", .width = SIZE, .height = SIZE, .fx = FOCAL, .fy = FOCAL, .cx = 32, .cy = 32}};
    struct view *c = &v->camera;
    c->cam_from_world = (struct mat3){{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};
    c->center = vec3_make(x, y, HEIGHT);
    c->translation = vec3_scale(mat3_apply(c->cam_from_world, c->center), -1);
    const double p[3][4] = {
        {FOCAL, 0, -32, -FOCAL * x + 32 * HEIGHT}, {0, -FOCAL, -32, FOCAL * y + 32 * HEIGHT}, {0, 0, -1, HEIGHT}};
    memcpy(v->project, p, sizeof p);
    v->id = calloc(SIZE * SIZE, sizeof *v->id);
    v->state = calloc(SIZE * SIZE, 1);
    v->own = calloc(SIZE * SIZE, 1);
    v->shows = calloc(ID + 1, 1);
    v->shows[ID] = 1;
    v->ids = ID + 1;
    v->level_count = 1;
    v->levels[0] = (struct source_level){SIZE, SIZE, calloc(SIZE * SIZE * 4, sizeof(float))};
}

#endif
