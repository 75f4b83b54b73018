/* light_things.c - see light_things.h. */
#include "common/relight/light_things.h"

#include <stdlib.h>

#include "common/base/array.h"
#include "common/model/thing_mesh.h"

static enum status add(struct thing_surfaces *s, const struct thing_mesh *m, const struct placed_thing *place,
                       const struct thing *thing, uint32_t id, struct err *err)
{
    for (int i = 0; i < m->triangle_count; i++) {
        if (array_append(&s->triangles, (size_t)s->count, sizeof *s->triangles, "triangles", err) ||
            array_append(&s->radiance, (size_t)s->count, sizeof *s->radiance, "triangles", err) ||
            array_append(&s->thing, (size_t)s->count, sizeof *s->thing, "triangles", err))
            return err->status;
        const struct vec3 p[3] = {m->vertices[m->triangles[i][0]], m->vertices[m->triangles[i][1]],
                                  m->vertices[m->triangles[i][2]]};
        const struct vec3 side =
            thing_radiance_of_side(thing, vec3_normalize(vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]))));
        for (int k = 0; k < 3; k++) s->triangles[s->count][k] = place ? placed_thing_place(place, p[k]) : p[k];
        s->radiance[s->count][0] = s->radiance[s->count][1] = rgb_make(side.x, side.y, side.z);
        s->thing[s->count++] = (int)id;
    }
    return ST_OK;
}

static enum status add_before(struct light_things *t, const struct thing_mesh *m, const struct thing *thing,
                              uint32_t id, bool stays, struct err *err)
{
    const size_t first = (size_t)t->before.count, count = first + (size_t)m->triangle_count;
    bool *grown = realloc(t->stays, (count + 1) * sizeof *grown);
    if (!grown) return err_nomem(err, "triangles", count * sizeof *grown);
    t->stays = grown;
    for (size_t i = first; i < count; i++) t->stays[i] = stays;
    return add(&t->before, m, NULL, thing, id, err);
}

static enum status add_thing(struct light_things *t, uint32_t id, struct err *err)
{
    const struct thing *thing = &t->placed.list.things[id - 1];
    const bool stays = t->placed.fate[id] != THING_IS_GONE;
    struct thing_mesh mesh = {0};
    if (!thing_mesh_make(&mesh, &t->placed.volume, id, err) && !add_before(t, &mesh, thing, id, stays, err) && stays)
        add(&t->after, &mesh, NULL, thing, id, err);
    for (int k = 0; !err->status && k < t->placed.placed_count; k++)
        if (t->placed.placed[k].id == id) add(&t->after, &mesh, &t->placed.placed[k], thing, id, err);
    thing_mesh_release(&mesh);
    return err->status;
}

enum status light_things_read(struct light_things *t, const char *folder, const struct texture_map *map, bool always,
                              const char *before, const char *after, struct provenance *prov, struct err *err)
{
    struct model_rays models[2] = {{.ids = 0}};
    *t = (struct light_things){0};
    if (!folder || (!always && !map->thing_count && !map->zone_count)) return ST_OK;
    if (!model_rays_read(&models[0], before, MODEL_WITH_GLASS, NULL, err) &&
        !model_rays_read(&models[1], after, MODEL_WITH_GLASS, NULL, err))
        placed_things_read(&t->placed, folder, map, &models[0], &models[1], prov, err);
    for (int k = 0; k < 2; k++) model_rays_release(&models[k]);
    const struct placed_things *p = &t->placed;
    t->changes = always || p->placed_count > 0;
    for (int i = 1; !err->status && i <= p->list.count; i++) t->changes |= p->fate[i] == THING_IS_GONE;
    for (int i = 1; !err->status && t->changes && i <= p->list.count; i++)
        if (p->list.things[i - 1].support != THING_ON_CEILING) add_thing(t, (uint32_t)i, err);
    return err->status;
}

void thing_surfaces_release(struct thing_surfaces *s)
{
    free(s->triangles);
    free(s->radiance);
    free(s->thing);
    *s = (struct thing_surfaces){0};
}

enum status thing_surfaces_read(struct thing_surfaces *s, const char *folder, struct provenance *prov, struct err *err)
{
    struct placed_things all = {0};
    *s = (struct thing_surfaces){0};
    placed_things_read(&all, folder, NULL, NULL, NULL, prov, err);
    for (int i = 1; !err->status && i <= all.list.count; i++) {
        struct thing_mesh mesh = {0};
        if (all.list.things[i - 1].support == THING_ON_CEILING) continue;
        if (!thing_mesh_make(&mesh, &all.volume, (uint32_t)i, err))
            add(s, &mesh, NULL, &all.list.things[i - 1], (uint32_t)i, err);
        thing_mesh_release(&mesh);
    }
    placed_things_release(&all);
    return err->status;
}

struct field_surfaces thing_surfaces_of_field(const struct thing_surfaces *s)
{
    return (struct field_surfaces){{(const struct vec3(*)[3])s->triangles, s->count},
                                   (const struct rgb(*)[2])s->radiance};
}

void light_things_release(struct light_things *t)
{
    placed_things_release(&t->placed);
    thing_surfaces_release(&t->before);
    thing_surfaces_release(&t->after);
    free(t->stays);
    *t = (struct light_things){0};
}

const struct placed_thing *light_things_moved(struct vec3 *was, const struct light_things *t, struct vec3 at)
{
    for (int k = 0; k < t->placed.placed_count; k++) {
        const struct placed_thing *p = &t->placed.placed[k];
        *was = placed_thing_origin(p, at);
        if (placed_thing_holds(&t->placed, p, *was)) return p;
    }
    return NULL;
}
