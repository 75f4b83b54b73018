/* placed_things.c - where an edit puts things, and whether they fit there; see placed_things.h.
 *
 * A zone that is cleared takes whole things: those of which it holds more than half. The others stay whole, too.
 *
 * A thing does not stand in another one, either (thing_overlap.c).
 *
 * A thing is rigid and its support stays what it is: what stood on the floor must stand on the floor again, what hung
 * on a wall must have a wall as near. Only its box is tested, shrunk a little, since depth at outlines is off. */
#include "common/relight/placed_things.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/scan.h"
#include "common/light/model_clearance.h"
#include "common/product/product.h"
#include "common/relight/thing_overlap.h"

#define SHRUNK     0.9  /* of the box's sides: what may not be in a wall */
#define MAX_STEP   0.03 /* of the model's height: between points of a box that are tested */
#define FLAT_SLACK 0.5  /* voxels: what is so near to the face that a thing lies on is of the thing */
#define SURFACE    0.4f /* distance, of its band, up to which a voxel is on the surface */
#define OFF_SIDE   0.03 /* of the model's height: change of the gap between a thing and its support that is none */

enum { MIN_STEPS = 3, MAX_STEPS = 24 }; /* points along each side of a box that are tested */

void placed_things_release(struct placed_things *t)
{
    if (!t) return;
    thing_list_release(&t->list);
    thing_volume_release(&t->volume);
    free(t->fate);
    for (int i = 0; i < t->placed_count; i++) free(t->placed[i].name);
    free(t->placed);
    free(t->points);
    *t = (struct placed_things){0};
}

struct thing_shape placed_things_shape(const struct placed_things *t, uint32_t id)
{
    return (struct thing_shape){id, &t->volume, &t->points[id], &t->list.things[id - 1].outline};
}

const struct flat_outline *placed_things_outline(const struct placed_things *t, uint32_t id)
{
    if (!id || id > (uint32_t)t->list.count || !t->list.things[id - 1].outline.count) return NULL;
    return &t->list.things[id - 1].outline;
}

/* Whether a thing that lies flat has a point of its face. */
static bool lies_at(const struct placed_things *t, const struct flat_outline *o, struct vec3 p)
{
    return fabs(flat_outline_height(o, p)) <= FLAT_SLACK * t->volume.grid.voxel && flat_outline_holds(o, p);
}

uint32_t placed_things_flat_at(const struct placed_things *t, struct vec3 p, enum thing_fate fate)
{
    for (int i = 0; i < t->list.count; i++)
        if (t->fate[i + 1] == fate && lies_at(t, &t->list.things[i].outline, p)) return (uint32_t)i + 1;
    return 0;
}

bool placed_thing_holds(const struct placed_things *t, const struct placed_thing *p, struct vec3 was)
{
    const struct flat_outline *flat = placed_things_outline(t, p->id);
    return flat ? lies_at(t, flat, was) : thing_volume_at(&t->volume, was) == p->id;
}

/* ---------------------------------------------------------------------------------------------------------- checks */

/* An error of a statement about a thing. */
static enum status PRINTF_LIKE(3, 4) edit_error(struct err *err, const struct texture_thing *edit, const char *fmt, ...)
{
    char text[1500];
    va_list args;
    va_start(args, fmt);
    vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    return err_set(err, ST_DATA, "%s:%d: %s", edit->script, edit->line, text);
}

/* A point of the box, from -1 to 1 in each direction. */
static struct vec3 box_point(const struct thing *t, double x, double y, double z)
{
    const struct vec3 middle = vec3_scale(vec3_add(t->low, t->high), 0.5);
    return vec3_make(middle.x + 0.5 * x * (t->high.x - t->low.x), middle.y + 0.5 * y * (t->high.y - t->low.y),
                     middle.z + 0.5 * z * (t->high.z - t->low.z));
}

/* How far the next surface is, below 0 from inside of a solid: how far the last one is behind. */
static double signed_gap(const struct model_rays *m, struct vec3 from, struct vec3 direction)
{
    bool front = true;
    const double ahead = model_rays_gap(m, from, direction, &front);
    return front ? ahead : -model_rays_gap(m, from, vec3_scale(direction, -1), NULL);
}

/* How far a point in a solid is from the nearest side of it. */
static double depth_in(const struct model_rays *m, struct vec3 p)
{
    static const struct vec3 ways[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    double least = INFINITY;
    for (int k = 0; k < 6; k++) least = fmin(least, model_rays_gap(m, p, ways[k], NULL));
    return least;
}

/* Points along a side of a box, so that none is far from the next. */
static int steps_along(double side, double height)
{
    const double steps = ceil(SHRUNK * side / (MAX_STEP * height)) + 1;
    return steps < MIN_STEPS ? MIN_STEPS : steps > MAX_STEPS ? MAX_STEPS : (int)steps;
}

/* Points of the box that were in a solid of the photographed room do not count: there its outline is off. */
static enum status check_walls(const struct texture_thing *edit, const struct thing *t, const struct placed_thing *p,
                               const struct model_rays *before, const struct model_rays *after, double height,
                               struct err *err)
{
    const int nx = steps_along(t->high.x - t->low.x, height), ny = steps_along(t->high.y - t->low.y, height),
              nz = steps_along(t->high.z - t->low.z, height);
    double deepest = -1;
    for (int i = 0; i < nx * ny * nz; i++) {
        const double x = 2.0 * (i % nx) / (nx - 1) - 1, y = 2.0 * (i / nx % ny) / (ny - 1) - 1,
                     z = 2.0 * (i / nx / ny) / (nz - 1) - 1;
        const struct vec3 was = box_point(t, SHRUNK * x, SHRUNK * y, SHRUNK * z), at = placed_thing_place(p, was);
        if (model_rays_inside(after, at, 0) && !model_rays_inside(before, was, 0))
            deepest = fmax(deepest, depth_in(after, at));
    }
    if (deepest < 0) return ST_OK;
    return edit_error(err, edit, "%s would stand at least %.2g deep in a wall, a box or a floor. Move it elsewhere.",
                      edit->name, deepest);
}

/* The direction from a thing to what supports it, in the room of the photographs, and the gap between them. */
static double support_gap(struct vec3 *direction, struct vec3 *from, const struct thing *t, const struct model_rays *m)
{
    double least = INFINITY;
    *direction = vec3_make(0, 0, t->support == THING_ON_CEILING ? 1 : -1);
    *from = box_point(t, 0, 0, 0);
    if (t->support != THING_ON_WALL) return model_rays_gap(m, *from, *direction, NULL);
    for (int k = 0; k < 4; k++) {
        const double sign = k & 1 ? -1 : 1;
        const struct vec3 to = k & 2 ? vec3_make(0, sign, 0) : vec3_make(sign, 0, 0);
        const double g = model_rays_gap(m, *from, to, NULL);
        if (!(g < least)) continue;
        least = g;
        *direction = to;
    }
    return least;
}

static enum status check_support(const struct texture_thing *edit, const struct thing *t, const struct placed_thing *p,
                                 const struct model_rays *before, const struct model_rays *after, double height,
                                 struct err *err)
{
    struct vec3 direction, from;
    if (t->support == THING_ON_NONE) return ST_OK;
    const double was = support_gap(&direction, &from, t, before);
    const double is = signed_gap(after, placed_thing_place(p, from), mat3_apply(p->turn, direction));
    if (!isfinite(was) || fabs(is - was) <= OFF_SIDE * height) return ST_OK;
    const char *support = thing_support_word(t->support);
    if (!isfinite(is))
        return edit_error(err, edit, "%s %s the %s, but there is no %s at its new place.", edit->name,
                          t->support == THING_ON_FLOOR ? "stood on" : "hung on", support, support);
    return edit_error(err, edit, "%s would be %.2g %s the %s that it %s on. Move it by that much less, or more.",
                      edit->name, fabs(is - was), is > was ? "away from" : "too far into", support,
                      t->support == THING_ON_FLOOR ? "stands" : "hangs");
}

/* --------------------------------------------------------------------------------------------------------- placing */

static const char *nth_name(const void *ctx, int i)
{
    const struct thing_list *list = ctx;
    return i < list->count ? list->things[i].name : NULL;
}

static enum status find_thing(int *at, const struct placed_things *t, const struct texture_thing *edit, struct err *err)
{
    *at = thing_list_find(&t->list, edit->from);
    if (*at >= 0) return ST_OK;
    const char *near = scan_nearest(edit->from, nth_name, &t->list);
    return edit_error(err, edit,
                      "the edit changes %s, but no thing of that name was found%s%s. Mark it elsewhere in things.txt; "
                      "make things shows what was found.",
                      edit->from, near ? "; the nearest is " : "", near ? near : "");
}

static struct placed_thing placement(const struct texture_thing *edit, const struct thing *t, uint32_t id,
                                     const struct model_rays *before)
{
    const double turn = edit->turn * M_PI / 180, c = cos(turn), s = sin(turn);
    struct placed_thing p = {.id = id, .turn = {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}}};
    const struct vec3 middle = box_point(t, 0, 0, 0);
    struct vec3 to = vec3_make(middle.x + edit->by[0], middle.y + edit->by[1], middle.z + edit->by[2]);
    if (edit->kind == TEXTURE_THING_PLACE) {
        const double below = model_rays_gap(before, middle, vec3_make(0, 0, -1), NULL);
        to = vec3_make(edit->by[0], edit->by[1], isfinite(below) ? edit->by[2] + below : middle.z);
    }
    p.shift = vec3_sub(to, mat3_apply(p.turn, middle));
    return p;
}

static bool is_placed(const struct texture_thing *edit)
{
    return edit->kind == TEXTURE_THING_MOVE || edit->kind == TEXTURE_THING_PLACE;
}

static enum status apply(struct placed_things *t, const struct texture_thing *edit, const struct model_rays *before,
                         const struct model_rays *after, struct err *err)
{
    int at;
    if (find_thing(&at, t, edit, err)) return err->status;
    const struct thing *thing = &t->list.things[at];
    const uint32_t id = (uint32_t)at + 1;
    if (edit->kind == TEXTURE_THING_KEEP) t->fate[id] = THING_IS_KEPT;
    if (edit->kind == TEXTURE_THING_KEEP) return ST_OK;
    if (!strcmp(edit->name, edit->from)) t->fate[id] = THING_IS_GONE;
    if (edit->kind == TEXTURE_THING_CLEAR) return ST_OK;
    struct placed_thing p = placement(edit, thing, id, before);
    const double height = model_rays_height(before);
    if (check_support(edit, thing, &p, before, after, height, err) ||
        check_walls(edit, thing, &p, before, after, height, err))
        return err->status;
    if (!(p.name = strdup(edit->name))) return err_nomem(err, "a name", strlen(edit->name));
    t->placed[t->placed_count++] = p;
    return ST_OK;
}

/* Refuses a placed thing that stands in another one. what: the name of that. */
static enum status check_overlap(const struct placed_things *t, const struct texture_thing *edit,
                                 const struct placed_thing *a, const struct placed_thing *b, uint32_t other,
                                 const char *what, struct err *err)
{
    double depth;
    if (placed_things_outline(t, a->id) || placed_things_outline(t, other)) return ST_OK; /* flat: not solid */
    if (thing_overlap_depth(&depth, &t->volume, a, b, other, err) || !(depth > 0)) return err->status;
    return edit_error(err, edit,
                      "%s would stand %.2g deep in %s. Move it by that much or more, or clear %s or move it away, too.",
                      edit->name, depth, what, what);
}

/* When all things of an edit have their places: what stays, and what was placed before, must not be in their way. */
static enum status check_overlaps(const struct placed_things *t, const struct texture_map *map, struct err *err)
{
    for (int i = 0, k = 0; !err->status && i < map->thing_count; i++) {
        if (!is_placed(&map->things[i])) continue;
        const struct placed_thing *a = &t->placed[k];
        for (int n = 0; !err->status && n < t->list.count; n++)
            if (t->fate[n + 1] != THING_IS_GONE)
                check_overlap(t, &map->things[i], a, NULL, (uint32_t)n + 1, t->list.things[n].name, err);
        for (int n = 0; !err->status && n < k; n++)
            check_overlap(t, &map->things[i], a, &t->placed[n], t->placed[n].id, t->placed[n].name, err);
        k++;
    }
    return err->status;
}

static bool is_surface(const struct thing_volume *v, size_t i) { return v->id[i] && fabsf(v->distance[i]) < SURFACE; }

static void grow_box(struct thing_points *t, struct vec3 p)
{
    t->low = vec3_make(fmin(t->low.x, p.x), fmin(t->low.y, p.y), fmin(t->low.z, p.z));
    t->high = vec3_make(fmax(t->high.x, p.x), fmax(t->high.y, p.y), fmax(t->high.z, p.z));
}

/* An outline is exact, where the voxels of what lies flat are coarse, and may be missing. */
static void add_outline(struct thing_points *t, const struct flat_outline *o)
{
    const bool none = !t->count;
    for (int i = 0; i < o->count; i++) {
        const struct vec3 corner = flat_outline_corner(o, i);
        grow_box(t, corner);
        if (none && t->count < THING_POINTS) t->at[t->count++] = corner;
    }
}

/* The boxes of the things, and every so many of the voxels of each one's surface. */
static enum status list_points(struct placed_things *t, struct err *err)
{
    const size_t things = (size_t)t->list.count + 1, voxels = voxel_count(&t->volume.grid);
    int64_t *all = calloc(2 * things, sizeof *all), *seen = all + things;
    t->points = calloc(things, sizeof *t->points);
    if (!all || !t->points) {
        free(all);
        return err_nomem(err, "things", things * sizeof *t->points);
    }
    for (size_t id = 0; id < things; id++) {
        t->points[id].low = vec3_make(INFINITY, INFINITY, INFINITY);
        t->points[id].high = vec3_make(-INFINITY, -INFINITY, -INFINITY);
    }
    for (size_t i = 0; i < voxels; i++) {
        const uint32_t id = t->volume.id[i];
        if (!id) continue;
        grow_box(&t->points[id], thing_voxel_centre(&t->volume.grid, (int64_t)i));
        if (is_surface(&t->volume, i)) all[id]++;
    }
    for (size_t i = 0; i < voxels; i++) {
        if (!is_surface(&t->volume, i)) continue;
        const uint32_t id = t->volume.id[i];
        struct thing_points *p = &t->points[id];
        const int64_t step = all[id] / THING_POINTS + 1;
        if (seen[id]++ % step == 0) p->at[p->count++] = thing_voxel_centre(&t->volume.grid, (int64_t)i);
    }
    free(all);
    for (int k = 0; k < t->list.count; k++) add_outline(&t->points[k + 1], &t->list.things[k].outline);
    return ST_OK;
}

/* Things that zones clear. Lamps and beams at the ceiling are the room's own. */
static enum status apply_zones(struct placed_things *t, const struct texture_map *map, struct err *err)
{
    const size_t things = (size_t)t->list.count + 1;
    int64_t *held = calloc(2 * things, sizeof *held), *all = held + things;
    if (!held) return err_nomem(err, "things", 2 * things * sizeof *held);
    for (int64_t i = 0; i < (int64_t)voxel_count(&t->volume.grid); i++) {
        const uint32_t id = t->volume.id[i];
        if (!id || !(t->volume.distance[i] < SURFACE)) continue; /* in a corner, what is around it lies in walls */
        all[id]++;
        held[id] += texture_map_clears(map, thing_voxel_centre(&t->volume.grid, i));
    }
    for (size_t id = 1; id < things; id++)
        if (held[id])
            t->fate[id] = 2 * held[id] > all[id] && t->list.things[id - 1].support != THING_ON_CEILING ? THING_IS_GONE
                                                                                                       : THING_IS_KEPT;
    free(held);
    return ST_OK;
}

enum status placed_things_read(struct placed_things *t, const char *folder, const struct texture_map *map,
                               const struct model_rays *before, const struct model_rays *after, struct provenance *prov,
                               struct err *err)
{
    char path[FILE_PATH];
    *t = (struct placed_things){0};
    if (!folder && !(map && map->thing_count)) return ST_OK;
    if (!folder)
        return err_set(err, ST_USAGE, "the edit changes the thing %s, but --things is missing; see --help.",
                       map->things[0].from);
    if (!product_path_in(path, folder, PRODUCT_THINGS, NULL, err) && !thing_list_read(&t->list, path, prov, err) &&
        !product_path_in(path, folder, PRODUCT_THING_VOLUME, NULL, err))
        thing_volume_read(&t->volume, path, (uint32_t)t->list.count, prov, err);
    if (!err->status) {
        t->fate = calloc((size_t)t->list.count + 1, sizeof *t->fate);
        t->placed = calloc(map ? (size_t)map->thing_count + 1 : 1, sizeof *t->placed);
        if (!t->fate || !t->placed) err_nomem(err, "things", (size_t)t->list.count * sizeof *t->placed);
    }
    if (!err->status) list_points(t, err);
    if (!err->status && map && map->zone_count) apply_zones(t, map, err);
    for (int i = 0; !err->status && map && i < map->thing_count; i++) apply(t, &map->things[i], before, after, err);
    if (!err->status && map) check_overlaps(t, map, err);
    if (err->status) placed_things_release(t);
    return err->status;
}
