/* level_scene.c - see level_scene.h.
 *
 * Overview. The unedited room's patches get their reflectance from the photographs. For an edit that is done first,
 * without other skies; then the edited room's patches take theirs from it, and light is passed between these. */
#include "stages/light_levels/level_scene.h"

#include <stdlib.h>

#include "common/base/log.h"

enum { DIRECTIONS = 6 };
enum { KEY_PATCHES = 1 << 28, KEY_POINTS = 1 << 29 };

/* ---------------------------------------------------------------------------------------------------------- reading */

static enum status read_alone(struct level_scene *s, const struct light_change_files *files, struct provenance *prov,
                              struct err *err)
{
    struct model_field_files own = {files->base, files->vita, files->outdoors, files->lights, NULL};
    if (files->things && thing_surfaces_read(&s->furniture, files->things, prov, err)) return err->status;
    s->surfaces = thing_surfaces_of_field(&s->furniture);
    if (s->furniture.count) own.surfaces = &s->surfaces;
    if (model_field_read(&s->alone, &own, prov, err) || model_axes_read(&s->axes, files->axes, prov, err))
        return err->status;
    if (files->references) model_field_read_references(&s->alone, files->references, &s->axes, prov, err);
    return err->status;
}

enum status level_scene_read(struct level_scene *s, const struct light_change_files *files, struct provenance *prov,
                             struct err *err)
{
    struct light_change_files all = *files;
    *s = (struct level_scene){.edited = files->edited != NULL};
    if (!s->edited) return read_alone(s, files, prov, err);
    all.all_things = true;
    if (!light_change_read(&s->change, &all, prov, err)) s->axes = s->change.axes;
    return err->status;
}

void level_scene_release(struct level_scene *s)
{
    light_change_release(&s->change);
    model_field_release(&s->alone);
    thing_surfaces_release(&s->furniture);
    *s = (struct level_scene){0};
}

const struct model_field *level_scene_field(const struct level_scene *s)
{
    return s->edited ? &s->change.after : &s->alone;
}

bool level_scene_inside(const struct model_field *f, struct vec3 at)
{
    static const struct vec3 ways[DIRECTIONS] = {{1, 0.01, 0.02},  {-1, 0.02, 0.01}, {0.01, 1, 0.02},
                                                 {0.02, -1, 0.01}, {0.01, 0.02, 1},  {0.02, 0.01, -1}};
    int backs = 0;
    for (int i = 0; i < DIRECTIONS; i++) {
        struct ray_hit hit;
        backs += ray_scene_hit(&f->model.rays, at, ways[i], &hit) && !hit.front;
    }
    return 2 * backs > DIRECTIONS;
}

/* A lamp may lie in the surface that it hangs from, as deep as photographed ones. */
static enum status check_planned(const struct level_scene *s, const struct model_field *field, struct err *err)
{
    for (int i = 0; s->planned && i < s->planned->count; i++) {
        const struct planned_lamp *l = &s->planned->list[i];
        const struct vec3 at = vec3_add(l->at, vec3_scale(l->down, 2 * field->reach));
        if (!model_rays_near(&field->model, l->at) || level_scene_inside(field, at))
            return err_set(err, ST_DATA,
                           "%s:%d: the lamp %s at %g %g %g lies inside of a wall or outdoors; give another place, in "
                           "the frame of the plan.",
                           l->on ? "the edit" : s->planned->path, l->line, l->name, l->at.x, l->at.y, l->at.z);
    }
    return ST_OK;
}

/* ---------------------------------------------------------------------------------------------------------- patches */

static struct patch_owner old_owner(const void *ctx, int triangle)
{
    const struct thing_surfaces *furniture = ctx;
    return (struct patch_owner){OWNER_THING + furniture->thing[triangle], false};
}

static struct patch_owner new_owner(const void *ctx, int triangle)
{
    const struct light_change *c = ctx;
    if (triangle < c->objects.count) return (struct patch_owner){c->objects.object[triangle], true};
    return (struct patch_owner){OWNER_THING + c->added.thing[triangle], false};
}

static enum status trace_patches(struct light_rows *rows, const struct light_groups *g, const struct light_patches *p,
                                 const struct levels_params *params, const char *what, struct err *err)
{
    struct row_place *places = malloc(((size_t)p->count + 1) * sizeof *places);
    if (!places) return err_nomem(err, "patches", (size_t)p->count * sizeof *places);
    for (int i = 0; i < p->count; i++) places[i] = (struct row_place){p->list[i].origins, p->list[i].origin_count};
    rows_trace(rows, g, p, places, p->count, params->rays, KEY_PATCHES, what, err);
    free(places);
    return err->status;
}

static int count_bounded(const struct photographed_patch *found, const struct light_patches *p)
{
    int bounded = 0;
    for (int i = 0; i < p->face_patches; i++) bounded += !found[i].known;
    return bounded;
}

/* ----------------------------------------------------------------------------------------------------------- making */

static enum status colour_alone(struct level_light *l, struct err *err)
{
    struct photographed_patch *found = calloc((size_t)l->patches.count + 1, sizeof *found);
    if (!found) return err_nomem(err, "patches", (size_t)l->patches.count * sizeof *found);
    colours_of_photographs(found, &l->patches, &l->rows, &l->groups, err);
    for (int i = 0; i < l->patches.count; i++) l->colours[i] = found[i].colour;
    l->bounded = count_bounded(found, &l->patches);
    free(found);
    return err->status;
}

/* The unedited room tells what an edit's patches reflect. */
static enum status colour_edit(struct level_light *l, const struct level_scene *s, const struct levels_params *params,
                               struct err *err)
{
    struct level_light was = {.bounded = 0};
    struct photographed_patch *found = NULL;
    const struct model_field *before = &s->change.before;
    if (!groups_make(&was.groups, before, false, err) &&
        !patches_make(&was.patches, before, params->patches, old_owner, &s->change.things.before, err) &&
        !trace_patches(&was.rows, &was.groups, &was.patches, params, "the light of the photographs", err)) {
        found = calloc((size_t)was.patches.count + 1, sizeof *found);
        if (!found) err_nomem(err, "patches", (size_t)was.patches.count * sizeof *found);
    }
    if (!err->status && !colours_of_photographs(found, &was.patches, &was.rows, &was.groups, err)) {
        colours_of_edit(l->colours, &l->patches, &s->change, &was.patches, found);
        l->bounded = count_bounded(found, &was.patches);
    }
    free(found);
    level_light_release(&was);
    return err->status;
}

enum status level_light_make(struct level_light *l, const struct level_scene *s, bool hours,
                             const struct levels_params *params, struct err *err)
{
    const struct model_field *field = level_scene_field(s);
    patch_owner_fn *owner = s->edited ? new_owner : old_owner;
    const void *ctx = s->edited ? (const void *)&s->change : &s->furniture;
    *l = (struct level_light){.bounded = 0};
    if (groups_make(&l->groups, field, hours, err)) return err->status;
    if (s->planned) groups_add_planned(&l->groups, s->planned, s->metre.units);
    if (check_planned(s, field, err) || patches_make(&l->patches, field, params->patches, owner, ctx, err) ||
        trace_patches(&l->rows, &l->groups, &l->patches, params, "light of patches", err))
        return err->status;
    l->colours = calloc((size_t)l->patches.count + 1, sizeof *l->colours);
    if (!l->colours) return err_nomem(err, "patches", (size_t)l->patches.count * sizeof *l->colours);
    if (s->edited ? colour_edit(l, s, params, err) : colour_alone(l, err)) return err->status;
    if (radiosity_solve(&l->radiosity, &l->rows, l->colours, l->groups.rest, params->tolerance, err))
        return err->status;
    log_note("%d patches, %d of them with the reflectance of their face; %d groups of light; %d rounds",
             l->patches.count, l->bounded, l->groups.count, l->radiosity.rounds);
    return ST_OK;
}

void level_light_release(struct level_light *l)
{
    radiosity_release(&l->radiosity);
    free(l->colours);
    rows_release(&l->rows);
    patches_release(&l->patches);
    groups_release(&l->groups);
    *l = (struct level_light){.bounded = 0};
}

enum status level_light_at(float **found, struct light_rows *direct, const struct level_light *l,
                           const struct gather_point *points, int count, const struct levels_params *params,
                           struct err *err)
{
    const size_t columns = 3 * (size_t)l->groups.count;
    struct row_place *places = malloc(((size_t)count + 1) * sizeof *places);
    *found = calloc((size_t)count * columns + 1, sizeof **found);
    *direct = (struct light_rows){.count = 0};
    if (!places || !*found) err_nomem(err, "points", (size_t)count * columns * sizeof **found);
    for (int i = 0; !err->status && i < count; i++) places[i] = (struct row_place){&points[i], 1};
    if (!err->status)
        rows_trace(direct, &l->groups, &l->patches, places, count, params->point_rays, KEY_POINTS, "light at points",
                   err);
    for (int i = 0; !err->status && i < count; i++)
        radiosity_gather(*found + columns * (size_t)i, direct, i, &l->radiosity);
    free(places);
    return err->status;
}
