/* sun_room.h - the room of atlas_room.h under a sky. */
#ifndef REMODEL_TEST_SUN_ROOM_H
#define REMODEL_TEST_SUN_ROOM_H

#include "stages/bake_outdoors/sun_indoors.h"
#include "tests/unit/atlas_room.h"

/* Irradiance from a sky of radiance 1 in all directions, through the window, at NODES x NODES places of each tile. */
enum { NODES = 40, NODE_RAYS = 1024 };
static double sky_light[TILES][NODES][NODES];

static void uniform_outdoors(struct outdoors *o, float radiance)
{
    struct err err = ERR_INIT;
    assert_ok(outdoors_init(o, 32, &err), err);
    for (int i = 0; i < 3 * o->width * o->height; i++) o->rgb[i] = radiance;
}

static void make_sky_light(void)
{
    const struct field_atlas black = {.ids = 0};
    const struct atlas_scene scene = {&model, &black, planes};
    struct outdoors o = {0};
    uniform_outdoors(&o, 1);
    const struct sun_indoors in = {.scene = &scene, .outdoors = &o};
    const struct light_field field = sun_indoors_field(&in);
    for (int t = 0; t < TILES; t++)
        for (int k = 0; k < NODES * NODES; k++) {
            const struct vec3 right = vec3_scale(insides[t].right, (k % NODES + 0.5) / NODES);
            const struct vec3 down = vec3_scale(insides[t].down, (k / NODES + 0.5) / NODES);
            const struct gather_point p = {vec3_add(insides[t].corner, vec3_add(right, down)), normals[t]};
            struct irradiance e;
            ray_irradiance(&e, &field, p, NODE_RAYS, (uint64_t)(t * NODES * NODES + k));
            sky_light[t][k / NODES][k % NODES] = e.value.g;
        }
    outdoors_release(&o);
}

/* Between the nodes, bilinear. */
static double sky_light_at(int tile, struct vec3 p)
{
    const struct inside *in = &insides[tile];
    const struct vec3 d = vec3_sub(p, in->corner);
    const double u = clamp(vec3_dot(d, in->right) / vec3_dot(in->right, in->right) * NODES - 0.5, 0, NODES - 1.001);
    const double v = clamp(vec3_dot(d, in->down) / vec3_dot(in->down, in->down) * NODES - 0.5, 0, NODES - 1.001);
    const int x = (int)u, y = (int)v;
    const double(*e)[NODES] = (const double(*)[NODES])sky_light[tile] + y;
    const double top = e[0][x] * (1 - u + x) + e[0][x + 1] * (u - x);
    const double bottom = e[1][x] * (1 - u + x) + e[1][x + 1] * (u - x);
    return top * (1 - v + y) + bottom * (v - y);
}

static int make_room(void **state)
{
    const int failed = make_walls(state);
    if (!failed) make_sky_light();
    return failed;
}

#endif
