/* export_things.c - see export_things.h. */
#include "stages/export_model/export_things.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/log.h"
#include "common/relight/placed_things.h"

static enum status read_placed(struct placed_things *placed, const struct export_thing_files *files,
                               const struct texture_map *map, struct provenance *prov, struct err *err)
{
    static const struct texture_map unedited = {0};
    struct model_rays before = {.ids = 0}, after = {.ids = 0};
    if (map && map->thing_count && !files->base)
        return err_set(err, ST_USAGE, "%s: the edit changes the thing %s, but --base is missing; see --help.",
                       files->map, map->things[0].from);
    if (!map || !map->thing_count)
        placed_things_read(placed, files->folder, map ? map : &unedited, NULL, NULL, prov, err);
    else if (!model_rays_read(&before, files->base, MODEL_WITH_GLASS, prov, err) &&
             !model_rays_read(&after, files->model, MODEL_WITH_GLASS, NULL, err))
        placed_things_read(placed, files->folder, map, &before, &after, prov, err);
    model_rays_release(&before);
    model_rays_release(&after);
    return err->status;
}

static enum status check_name(const struct export_things *t, const char *name, const char *from, const char *map,
                              struct err *err)
{
    for (int i = 0; i < t->count; i++)
        if (!strcmp(t->things[i].name, name))
            return err_set(err, ST_DATA,
                           "%s: a copy of %s has the name %s, which another thing has, too. Give the copy another name "
                           "in the edit.",
                           map, from, name);
    return ST_OK;
}

/* place NULL: where it was photographed. */
static enum status add(struct export_things *t, const struct placed_things *placed, uint32_t id,
                       const struct placed_thing *place, const char *map, struct err *err)
{
    const struct thing *thing = &placed->list.things[id - 1];
    const char *name = place ? place->name : thing->name;
    struct export_thing made = {.name = strdup(name)};
    memcpy(made.radiance, thing->radiance, sizeof made.radiance);
    if (!made.name) err_nomem(err, "a name", strlen(name));
    if (!err->status && !check_name(t, name, thing->name, map, err))
        thing_mesh_make(&made.mesh, &placed->volume, id, err);
    for (int i = 0; place && i < made.mesh.vertex_count; i++)
        made.mesh.vertices[i] = placed_thing_place(place, made.mesh.vertices[i]);
    if (!err->status && !made.mesh.triangle_count)
        log_warn("%s is left out, because volume.exr has no surface of it.", name);
    else if (!err->status && !array_append(&t->things, (size_t)t->count, sizeof *t->things, "things", err)) {
        t->things[t->count++] = made;
        return ST_OK;
    }
    free(made.name);
    thing_mesh_release(&made.mesh);
    return err->status;
}

enum status export_things_read(struct export_things *t, const struct export_thing_files *files,
                               const struct texture_map *map, struct provenance *prov, struct err *err)
{
    struct placed_things placed = {.placed_count = 0};
    *t = (struct export_things){0};
    if (!files->folder) return ST_OK;
    read_placed(&placed, files, map, prov, err);
    for (int i = 1; !err->status && i <= placed.list.count; i++)
        if (placed.fate[i] != THING_IS_GONE) add(t, &placed, (uint32_t)i, NULL, files->map, err);
    for (int k = 0; !err->status && k < placed.placed_count; k++)
        add(t, &placed, placed.placed[k].id, &placed.placed[k], files->map, err);
    placed_things_release(&placed);
    return err->status;
}

void export_things_release(struct export_things *t)
{
    for (int i = 0; i < t->count; i++) {
        free(t->things[i].name);
        thing_mesh_release(&t->things[i].mesh);
    }
    free(t->things);
    *t = (struct export_things){0};
}

void export_thing_colour(double colour[3], const struct export_thing *t, double exposure)
{
    for (int k = 0; k < 3; k++) colour[k] = fmin(1, exposure * t->radiance[k]);
}
