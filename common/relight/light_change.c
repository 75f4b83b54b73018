/* light_change.c - see light_change.h.
 *
 * New areas. Where an edit removes a wall, floor appears that no photograph shows; the bake filled it from the floor
 * around it, hence under the light of that floor. So its light before the edit is that of the nearest old floor, a
 * little away from the rim, where the wall's own shadow was. In the unedited model the place itself is inside the wall,
 * and dark.
 *
 * Emitters. Those of the edited model that the unedited one lacks are added to both, and the other way round. An
 * emitter adds no light: it says where rays go. */
#include "common/relight/light_change.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/relight/thing_light.h"

static const double INSET = 0.005; /* of the model's size: 5 cm of 10 m */
static const double PART = 0.02;   /* of the model's size: what of furniture sends out alike */
static const double ELEMENT = 0.1; /* model units: width of the objects' elements */

/* --------------------------------------------------------------------------------------------------------- emitters */

static bool same_emitter(const struct emitter *a, const struct emitter *b)
{
    const struct vec3 d[4] = {vec3_sub(a->centre, b->centre), vec3_sub(a->x, b->x), vec3_sub(a->y, b->y),
                              vec3_sub(a->normal, b->normal)};
    for (int i = 0; i < 4; i++)
        if (d[i].x != 0 || d[i].y != 0 || d[i].z != 0) return false;
    return a->kind == b->kind && a->cone == b->cone && a->beta == b->beta && a->exponent == b->exponent;
}

static void add_emitters(struct emitter *list, int *count, const struct light_field *f)
{
    for (int i = 0; i < f->emitter_count; i++) {
        int k = 0;
        while (k < *count && !same_emitter(&list[k], &f->emitters[i])) k++;
        if (k == *count)
            list[(*count)++] = f->emitters[i];
        else
            list[k].luminance = fmax(list[k].luminance, f->emitters[i].luminance);
    }
}

static enum status unite_emitters(struct light_change *c, struct err *err)
{
    const size_t most = (size_t)c->before.field.emitter_count + (size_t)c->after.field.emitter_count + 1;
    int count = 0;
    c->emitters = calloc(most, sizeof *c->emitters);
    if (!c->emitters) return err_nomem(err, "emitters", most * sizeof *c->emitters);
    add_emitters(c->emitters, &count, &c->before.field);
    add_emitters(c->emitters, &count, &c->after.field);
    c->before.field.emitters = c->after.field.emitters = c->emitters;
    c->before.field.emitter_count = c->after.field.emitter_count = count;
    c->before.plain.emitters = c->after.plain.emitters = c->emitters;
    c->before.plain.emitter_count = c->after.plain.emitter_count = count;
    return ST_OK;
}

/* ---------------------------------------------------------------------------------------------------------- reading */

static enum status read_fields(struct light_change *c, const struct light_change_files *files, struct provenance *prov,
                               struct err *err)
{
    const struct model_field_files before = {files->base, files->vita, files->outdoors, files->lights,
                                             c->things.before.count ? &c->old_things : NULL};
    const struct model_field_files after = {files->edited, files->edited_vita ? files->edited_vita : files->vita,
                                            files->outdoors, files->lights, c->added.count ? &c->surfaces : NULL};
    if (model_field_read(&c->before, &before, prov, err) || model_field_read(&c->after, &after, prov, err))
        return err->status;
    for (int i = 0; i < c->map.lamp_count; i++)
        model_field_scale_lamp(&c->after, c->map.lamps[i].name, c->map.lamps[i].scale);
    model_field_add_changed_panes(&c->after, &c->before);
    if (!files->references) return ST_OK;
    if (model_field_read_references(&c->before, files->references, &c->axes, prov, err) ||
        model_field_read_references(&c->after, files->references, &c->axes, prov, err))
        return err->status;
    return ST_OK;
}

static enum status read_objects(struct light_change *c, const struct light_change_files *files, struct provenance *prov,
                                struct err *err)
{
    struct light_objects *o = &c->objects;
    if (light_objects_read(o, files->objects, files->scene, ELEMENT, prov, err)) return err->status;
    if (!o->count || !files->object_light) return ST_OK;
    return light_objects_read_light(o, files->object_light, prov, err);
}

/* The surfaces of both fields. */
static enum status add_surfaces(struct light_change *c, struct err *err)
{
    const struct light_objects *o = &c->objects;
    const struct thing_surfaces *t = &c->things.after;
    struct thing_surfaces *all = &c->added;
    const size_t count = (size_t)o->count + (size_t)t->count;
    all->triangles = malloc((count + 1) * sizeof *all->triangles);
    all->thing = calloc(count + 1, sizeof *all->thing);
    all->radiance = malloc((count + 1) * sizeof *all->radiance);
    if (!all->triangles || !all->radiance || !all->thing)
        return err_nomem(err, "triangles", count * sizeof *all->triangles);
    if (o->count) memcpy(all->triangles, o->triangles, (size_t)o->count * sizeof *all->triangles);
    if (o->count) memcpy(all->radiance, o->radiance, (size_t)o->count * sizeof *all->radiance);
    if (t->count) memcpy(all->triangles + o->count, t->triangles, (size_t)t->count * sizeof *all->triangles);
    if (t->count) memcpy(all->radiance + o->count, t->radiance, (size_t)t->count * sizeof *all->radiance);
    if (t->count) memcpy(all->thing + o->count, t->thing, (size_t)t->count * sizeof *all->thing);
    all->count = (int)count;
    c->surfaces = thing_surfaces_of_field(all);
    c->old_things = thing_surfaces_of_field(&c->things.before);
    return ST_OK;
}

static enum status read_lamps(struct light_change *c, const struct light_change_files *files, struct provenance *prov,
                              struct err *err)
{
    const struct edit_lamp_files of = {files->lux_scale, files->edited_plan, files->scene};
    return edit_lamps_read(&c->lamps, &of, &c->map, &c->axes, prov, err);
}

/* Furniture throws shadows in the light of new lamps, wherever it stands. */
static enum status read_things(struct light_change *c, const struct light_change_files *files, struct provenance *prov,
                               struct err *err)
{
    const bool always = files->all_things || c->lamps.planned.count > 0;
    return light_things_read(&c->things, files->things, &c->map, always, files->base, files->edited, prov, err);
}

enum status light_change_read(struct light_change *c, const struct light_change_files *files, struct provenance *prov,
                              struct err *err)
{
    *c = (struct light_change){0};
    if (!model_axes_read(&c->axes, files->axes, prov, err) && !texture_map_read(&c->map, files->map, prov, err) &&
        !read_objects(c, files, prov, err) && !read_lamps(c, files, prov, err) && !read_things(c, files, prov, err) &&
        !add_surfaces(c, err) && !read_fields(c, files, prov, err) &&
        !face_areas_make(&c->old, &c->before.model.mesh, err) && !unite_emitters(c, err) && c->things.before.count &&
        !files->all_things)
        thing_light_find(&c->things.before, &c->before.plain, &c->added, c->objects.count, &c->after.plain,
                         PART * model_rays_size(&c->before.model), err);
    c->inset = INSET * model_rays_size(&c->before.model);
    return err->status;
}

void light_change_release(struct light_change *c)
{
    if (!c) return;
    model_field_release(&c->before);
    model_field_release(&c->after);
    texture_map_release(&c->map);
    light_objects_release(&c->objects);
    light_things_release(&c->things);
    edit_lamps_release(&c->lamps);
    thing_surfaces_release(&c->added);
    face_areas_release(&c->old);
    free(c->emitters);
    *c = (struct light_change){0};
}

/* ----------------------------------------------------------------------------------------------------------- places */

/* Sets where the light on a texel comes from: at the texel, or on the nearest old area, `inset` inside. */
static bool set_before(struct light_place *place, const struct light_change *c)
{
    struct vec3 at = place->texel, inside;
    int face, other;
    bool on, is_inside;
    if (!face_areas_nearest(&c->old, place->face, place->texel, &at, &face, &on)) return false;
    place->is_new = !on;
    if (!on) {
        const struct vec3 way = vec3_normalize(vec3_sub(at, place->texel));
        inside = vec3_add(at, vec3_scale(way, c->inset));
        if (face_areas_nearest(&c->old, place->face, inside, &inside, &other, &is_inside) && is_inside) at = inside;
    }
    place->before = (struct gather_point){at, c->before.model.mesh.faces[face].normal};
    return true;
}

static bool place_texel(struct light_place *place, const struct light_change *c, int from, struct vec3 at)
{
    place->kind = LIGHT_PLACE_TEXTURE;
    place->face = from;
    place->texel = at;
    const struct field_texel texel = field_atlas_look(&c->before.atlas, from, at);
    place->colour = texel.radiance;
    place->source = texel.source;
    return place->source != LIGHT_NONE && set_before(place, c);
}

/* A rule that covers p fills the place. */
static bool apply(struct light_place *place, const struct light_change *c, const struct texture_rule *rule,
                  struct vec3 p)
{
    struct vec3 at = texture_rule_place(rule, p);
    switch (rule->kind) {
    case TEXTURE_PLACE:
        return place_texel(place, c, rule->from, at);
    case TEXTURE_EDGE:
        return field_atlas_nearest(&c->before.atlas, rule->from, at, &at) && place_texel(place, c, rule->from, at);
    case TEXTURE_COLOUR:
        place->kind = LIGHT_PLACE_COLOUR;
        place->colour = rgb_make((double)rule->albedo[0], (double)rule->albedo[1], (double)rule->albedo[2]);
        return true;
    default:
        return false;
    }
}

void light_change_place(struct light_place *place, const struct light_change *c, int face, struct vec3 p)
{
    const struct solid_mesh *mesh = &c->after.model.mesh;
    const int id = solid_face_id(mesh, face);
    const struct texture_face *listed = texture_map_find(&c->map, id, p);
    *place = (struct light_place){.kind = LIGHT_PLACE_NONE};
    if (!listed) {
        if (place_texel(place, c, id, p)) return;
    } else {
        for (int i = 0; i < listed->rule_count; i++)
            if (texture_rule_holds(&listed->rules[i], listed->normal, p) && apply(place, c, &listed->rules[i], p))
                return;
    }
    *place = (struct light_place){.kind = LIGHT_PLACE_NONE};
}
