/* texture_wishes.c - statements about textures as rules; see texture_wishes.h.
 *
 * A patch that is copied keeps its scale and is repeated over the place that gets it, from the lower left corner: one
 * limited rule for each copy. Stretched texture goes from the bounding rectangle of the face to that of its own place
 * in the base, in the axes of its plane. */
#include "stages/build_model/texture/texture_wishes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"

enum { MAX_COPIES = 4096 };

enum status texture_face_add(struct texture_face *face, struct texture_rule rule, struct err *err)
{
    if (array_append(&face->rules, (size_t)face->rule_count, sizeof *face->rules, "rules", err)) return err->status;
    face->rules[face->rule_count++] = rule;
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------- names of faces */

static bool is_face_or_part(const char *face, const char *wished)
{
    const size_t length = strlen(wished);
    return !strncmp(face, wished, length) && (!face[length] || face[length] == '/');
}

bool texture_face_is_of(const char *face, const char *item)
{
    const char *slash = strchr(face, '/');
    return slash && is_face_or_part(slash + 1, item);
}

/* The first face of a name; -1: none. */
static int find_face(const struct solid_mesh *mesh, const char *name)
{
    for (int i = 0; i < mesh->face_count; i++)
        if (!strcmp(solid_face_name(mesh, i), name)) return i;
    return -1;
}

static const char *nth_face(const void *ctx, int i)
{
    const struct solid_mesh *mesh = ctx;
    return i < mesh->name_count ? mesh->names[i].name : NULL;
}

static enum status unknown_face(const struct plan_wish *w, const struct solid_mesh *mesh, const char *name,
                                const char *model, struct err *err)
{
    const char *near = scan_nearest(name, nth_face, mesh);
    if (near)
        return err_set(err, ST_DATA, "%s:%d: the %s model has no face %s; did you mean %s?", w->path, w->line, model,
                       name, near);
    return err_set(err, ST_DATA,
                   "%s:%d: the %s model has no face %s. It may have become part of another: see merged.txt.", w->path,
                   w->line, model, name);
}

/* Whether statements of this kind are about one face, not about all whose names begin so. */
static bool is_about_one_face(const struct plan_wish *w)
{
    return w->kind == WISH_COPY || (w->kind == WISH_COLOUR && !w->whole);
}

/* Whether a statement is about the face of this name in the edited model. */
static bool wish_is_about(const struct plan_wish *w, const char *face)
{
    if (w->kind == WISH_STRETCH || w->kind == WISH_CROP) return texture_face_is_of(face, w->face);
    return is_about_one_face(w) ? !strcmp(face, w->face) : is_face_or_part(face, w->face);
}

static enum status check_wish(const struct texture_models *m, const struct plan_wish *w, struct err *err)
{
    bool found = false;
    for (int i = 0; i < m->edited->name_count && !found; i++) found = wish_is_about(w, m->edited->names[i].name);
    if (!found) return unknown_face(w, m->edited, w->face, "edited", err);
    if (w->kind != WISH_COPY || find_face(m->base, w->from) >= 0) return ST_OK;
    return unknown_face(w, m->base, w->from, "unedited", err);
}

enum status texture_wishes_check(const struct texture_models *m, struct err *err)
{
    for (int i = 0; !err->status && i < m->plan->wish_count; i++) check_wish(m, &m->plan->wishes[i], err);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------ rectangles */

/* A corner of a place: by S and Z on a wall, by X and Y on a floor or ceiling, which may slope. */
static struct vec3 place_corner(const struct plan_wall *wall, double a, double b, const struct solid_face *f)
{
    double p[2];
    if (!wall) return vec3_make(a, b, (f->offset - f->normal.x * a - f->normal.y * b) / f->normal.z);
    plan_wall_point(wall, a, 0, p);
    return vec3_make(p[0], p[1], b);
}

/* The wall that a face belongs to; NULL if it belongs to none. */
static const struct plan_wall *wall_of(const struct solid_mesh *mesh, int face, const struct plan *plan)
{
    const char *name = solid_face_name(mesh, face);
    const struct plan_wall *wall = NULL;
    for (int i = 0; !wall && !strncmp(name, "wall/", 5) && i < plan->wall_count; i++)
        if (texture_face_is_of(name, plan->walls[i].name)) wall = &plan->walls[i];
    return wall;
}

static struct plane_rect place_rect(const double place[4], const struct solid_mesh *mesh, int face,
                                    const struct plan *plan, const struct plane_axes *axes)
{
    const struct plan_wall *wall = wall_of(mesh, face, plan);
    const struct solid_face *f = &mesh->faces[face];
    return plane_rect_of(axes, place_corner(wall, place[0], place[1], f), place_corner(wall, place[2], place[3], f));
}

/* The face of the base from which a patch is copied: of a ceiling with several planes, the lowest in the patch's
 * middle.
 */
static int copy_source(const struct texture_models *m, const struct plan_wish *w)
{
    const double x = 0.5 * (w->patch[0] + w->patch[2]), y = 0.5 * (w->patch[1] + w->patch[3]);
    int best = find_face(m->base, w->from);
    if (strncmp(w->from, "ceiling/", 8)) return best;
    double least = INFINITY;
    for (int i = 0; i < m->base->face_count; i++) {
        const struct solid_face *f = &m->base->faces[i];
        const double z = place_corner(NULL, x, y, f).z;
        if (strcmp(solid_face_name(m->base, i), w->from) || z >= least) continue;
        least = z;
        best = i;
    }
    return best;
}

/* The map that takes `from` in one plane to `to` in another. */
static void set_matrix(double m[3][4], const struct plane_axes *a, const struct plane_rect *from,
                       const struct plane_axes *b, const struct plane_rect *to)
{
    const double su = (to->u[1] - to->u[0]) / (from->u[1] - from->u[0]);
    const double sv = (to->v[1] - to->v[0]) / (from->v[1] - from->v[0]);
    const struct vec3 at = plane_axes_point(b, to->u[0] - su * from->u[0], to->v[0] - sv * from->v[0]);
    const double bu[3] = {b->u.x, b->u.y, b->u.z}, bv[3] = {b->v.x, b->v.y, b->v.z}, origin[3] = {at.x, at.y, at.z};
    const double au[3] = {a->u.x, a->u.y, a->u.z}, av[3] = {a->v.x, a->v.y, a->v.z};
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) m[i][k] = su * bu[i] * au[k] + sv * bv[i] * av[k] + 0.0;
        m[i][3] = origin[i] + 0.0;
    }
}

/* ----------------------------------------------------------------------------------------------------------- rules */

static enum status add_copies(struct texture_face *to, const struct texture_models *m, const struct plan_wish *w,
                              int face, struct err *err)
{
    const int source = copy_source(m, w);
    const struct plane_axes a = plane_axes_of(&m->edited->faces[face]), b = plane_axes_of(&m->base->faces[source]);
    const struct plane_rect patch = place_rect(w->patch, m->base, source, m->before, &b);
    const struct plane_rect target =
        w->whole ? plane_rect_of_surface(m->edited, face, &a) : place_rect(w->target, m->edited, face, m->plan, &a);
    const double width = patch.u[1] - patch.u[0], height = patch.v[1] - patch.v[0];
    const double columns = ceil((target.u[1] - target.u[0]) / width - 1e-6);
    const double rows = ceil((target.v[1] - target.v[0]) / height - 1e-6);
    if (!(columns * rows <= MAX_COPIES))
        return err_set(err, ST_DATA, "%s:%d: the patch would be repeated %.0f times; copy a larger one (at most %d).",
                       w->path, w->line, columns * rows, (int)MAX_COPIES);
    for (int i = 0; !err->status && i < (int)(columns * rows); i++) {
        const double u = target.u[0] + width * (i % (int)columns), v = target.v[0] + height * (i / (int)columns);
        const struct plane_rect cell = {{u, u + width}, {v, v + height}};
        const double right = fmin(u + width, target.u[1]), upper = fmin(v + height, target.v[1]);
        struct texture_rule rule = {
            .kind = TEXTURE_PLACE, .from = solid_face_id(m->base, source), .limited = !w->whole || columns * rows > 1};
        set_matrix(rule.matrix, &a, &cell, &b, &patch);
        rule.within[0] = plane_axes_point(&a, u, v);
        rule.within[1] = plane_axes_point(&a, right, v);
        rule.within[2] = plane_axes_point(&a, right, upper);
        rule.within[3] = plane_axes_point(&a, u, upper);
        texture_face_add(to, rule, err);
    }
    return err->status;
}

void texture_place_quad(struct vec3 corners[4], const struct texture_models *m, const double place[4], int face)
{
    const struct solid_face *f = &m->edited->faces[face];
    const struct plan_wall *wall = wall_of(m->edited, face, m->plan);
    for (int i = 0; i < 4; i++) {
        const struct vec3 p = place_corner(wall, place[i == 1 || i == 2 ? 2 : 0], place[i >= 2 ? 3 : 1], f);
        corners[i] = vec3_add(p, vec3_scale(f->normal, f->offset - vec3_dot(f->normal, p)));
    }
}

static enum status add_colour(struct texture_face *to, const struct texture_models *m, const struct plan_wish *w,
                              int face, const int *lit, int lit_count, struct err *err)
{
    struct texture_rule rule = {.kind = TEXTURE_COLOUR, .lit_count = lit_count, .limited = !w->whole};
    if (rule.limited) texture_place_quad(rule.within, m, w->target, face);
    for (int c = 0; c < 3; c++) rule.albedo[c] = (float)w->colour[c];
    rule.lit = malloc(((size_t)lit_count + 1) * sizeof *rule.lit);
    if (!rule.lit) return err_nomem(err, "faces", (size_t)lit_count * sizeof *rule.lit);
    if (lit_count) memcpy(rule.lit, lit, (size_t)lit_count * sizeof *rule.lit);
    if (texture_face_add(to, rule, err)) free(rule.lit);
    return err->status;
}

static enum status add_own(struct texture_face *to, const struct texture_models *m, const struct plan_wish *w, int face,
                           int base_face, struct vec3 by, struct err *err)
{
    const struct plane_axes a = plane_axes_of(&m->edited->faces[face]), b = plane_axes_of(&m->base->faces[base_face]);
    const struct plane_rect from = plane_rect_of_surface(m->edited, face, &a),
                            stretched = plane_rect_of_surface(m->base, base_face, &b);
    const double u = vec3_dot(b.u, by), v = vec3_dot(b.v, by);
    const struct plane_rect cropped = {{from.u[0] + u, from.u[1] + u}, {from.v[0] + v, from.v[1] + v}};
    struct texture_rule rule = {.kind = TEXTURE_PLACE, .from = solid_face_id(m->base, base_face)};
    set_matrix(rule.matrix, &a, &from, &b, w->kind == WISH_STRETCH ? &stretched : &cropped);
    texture_face_add(to, rule, err);
    rule.kind = TEXTURE_EDGE;
    if (!err->status) texture_face_add(to, rule, err);
    return err->status;
}

enum status texture_wishes_add(struct texture_face *to, bool *covered, const struct texture_models *m, int face,
                               int base_face, struct vec3 by, const int *lit, int lit_count, struct err *err)
{
    const char *name = solid_face_name(m->edited, face);
    *covered = false;
    for (int i = m->plan->wish_count - 1; !err->status && !*covered && i >= 0; i--) {
        const struct plan_wish *w = &m->plan->wishes[i];
        if (!wish_is_about(w, name)) continue;
        if (w->kind == WISH_COPY) {
            add_copies(to, m, w, face, err);
        } else if (w->kind == WISH_COLOUR) {
            add_colour(to, m, w, face, lit, lit_count, err);
            *covered = w->whole;
        } else if ((w->kind == WISH_STRETCH || w->kind == WISH_CROP) && base_face >= 0) {
            add_own(to, m, w, face, base_face, by, err);
            *covered = true;
        }
    }
    return err->status;
}

void texture_wishes_gloss(struct texture_face *to, const struct texture_models *m, int face)
{
    const char *name = solid_face_name(m->edited, face);
    for (int i = 0; i < m->plan->wish_count; i++) {
        const struct plan_wish *w = &m->plan->wishes[i];
        if (w->kind != WISH_GLOSS || !wish_is_about(w, name)) continue;
        to->has_gloss = true;
        to->gloss = w->gloss;
    }
}

/* ------------------------------------------------------------------------------------------------- lamps, zones,
 * things */

/* One that was turned off again is left out; so is one whose factors leave nothing of its colour. */
static enum status add_planned(struct texture_map *map, const struct plan_lamp *l, struct err *err)
{
    double most = 0;
    for (int k = 0; k < 3; k++) most = fmax(most, l->placed.colour[k] * l->scale[k]);
    if (!(most > 0)) return ST_OK;
    if (array_append(&map->planned, (size_t)map->planned_count, sizeof *map->planned, "lamps", err)) return err->status;
    struct texture_planned *to = &map->planned[map->planned_count++];
    *to = (struct texture_planned){.name = strdup(l->name), .file = strdup(l->file), .turn = l->placed.turn + 0.0};
    if (!to->name || !to->file) return err_nomem(err, "a lamp", strlen(l->name) + strlen(l->file));
    for (int k = 0; k < 3; k++) {
        to->at[k] = l->placed.at[k] + 0.0;
        to->aim[k] = l->placed.aim[k] + 0.0;
        to->colour[k] = l->placed.colour[k];
        to->scale[k] = l->scale[k];
    }
    return ST_OK;
}

enum status texture_lamps_add(struct texture_map *map, const struct plan *plan, struct err *err)
{
    for (int i = 0; i < plan->lamp_count; i++) {
        const struct plan_lamp *l = &plan->lamps[i];
        if (l->file) {
            if (add_planned(map, l, err)) return err->status;
            continue;
        }
        if (l->scale[0] == 1 && l->scale[1] == 1 && l->scale[2] == 1) continue;
        if (array_append(&map->lamps, (size_t)map->lamp_count, sizeof *map->lamps, "lamps", err)) return err->status;
        struct texture_lamp *to = &map->lamps[map->lamp_count++];
        *to = (struct texture_lamp){.name = strdup(l->name)};
        for (int c = 0; c < 3; c++) to->scale[c] = l->scale[c] + 0.0; /* -0 is 0 */
        if (!to->name) return err_nomem(err, "a lamp", strlen(l->name) + 1);
    }
    return ST_OK;
}

static enum status add_zone(struct texture_map *map, const struct plan_zone *zone, const char *name,
                            const double (*corners)[2], int count, struct err *err)
{
    if (array_append(&map->zones, (size_t)map->zone_count, sizeof *map->zones, "zones", err)) return err->status;
    struct texture_zone *z = &map->zones[map->zone_count++];
    *z = (struct texture_zone){.keep = zone->keep, .low = zone->low[2], .high = zone->high[2]};
    z->name = strdup(name);
    z->corners = malloc((size_t)count * sizeof *z->corners);
    if (!z->name || !z->corners) return err_nomem(err, "a zone", (size_t)count * sizeof *z->corners);
    memcpy(z->corners, corners, (size_t)count * sizeof *z->corners);
    z->corner_count = count;
    return ST_OK;
}

static enum status add_room(struct texture_map *map, const struct plan_zone *zone, const struct plan_room *room,
                            struct err *err)
{
    double(*corners)[2] = malloc(((size_t)room->edge_count + 1) * sizeof *corners);
    if (!corners) return err_nomem(err, "a room's corners", (size_t)room->edge_count * sizeof *corners);
    for (int i = 0; i < room->edge_count; i++) memcpy(corners[i], room->edges[i].corner, sizeof *corners);
    add_zone(map, zone, room->name, corners, room->edge_count, err);
    free(corners);
    return err->status;
}

/* The space before an opening, on both sides of its wall. Things that stand there often reach a little beyond. */
static void corners_before(double corners[4][2], const struct plan *plan, const struct plan_zone *zone)
{
    const struct plan_opening *o = &plan->openings[zone->opening];
    const struct plan_wall *w = &plan->walls[o->wall];
    const double wider = zone->before / 10, from = o->s[0] - wider, to = o->s[1] + wider;
    plan_wall_point(w, from, -zone->before, corners[0]);
    plan_wall_point(w, to, -zone->before, corners[1]);
    plan_wall_point(w, to, w->thickness + zone->before, corners[2]);
    plan_wall_point(w, from, w->thickness + zone->before, corners[3]);
}

enum status texture_zones_add(struct texture_map *map, const struct plan *plan, struct err *err)
{
    for (int i = 0; !err->status && i < plan->zone_count; i++) {
        const struct plan_zone *z = &plan->zones[i];
        double place[4][2] = {
            {z->low[0], z->low[1]}, {z->high[0], z->low[1]}, {z->high[0], z->high[1]}, {z->low[0], z->high[1]}};
        if (z->opening >= 0) corners_before(place, plan, z);
        for (int r = 0; !err->status && r < plan->room_count; r++)
            if (!plan->rooms[r].removed && plan->rooms[r].edge_count > 2 && (z->all || z->room == r))
                add_room(map, z, &plan->rooms[r], err);
        if (!err->status && !z->all && z->room < 0) add_zone(map, z, "place", place, 4, err);
    }
    return err->status;
}

enum status texture_things_add(struct texture_map *map, const struct plan *plan, struct err *err)
{
    static const enum texture_thing_kind kinds[] = {[PLAN_THING_CLEARED] = TEXTURE_THING_CLEAR,
                                                    [PLAN_THING_KEPT] = TEXTURE_THING_KEEP,
                                                    [PLAN_THING_MOVED] = TEXTURE_THING_MOVE,
                                                    [PLAN_THING_PLACED] = TEXTURE_THING_PLACE};
    for (int i = 0; !err->status && i < plan->thing_count; i++) {
        const struct plan_thing *t = &plan->things[i];
        if (t->state == PLAN_THING_LEFT || (t->state == PLAN_THING_CLEARED && t->from != i)) continue;
        struct texture_thing thing = {kinds[t->state], t->name, plan->things[t->from].name, {0}, t->turn + 0.0,
                                      t->script,       t->said};
        for (int k = 0; k < 3; k++) thing.by[k] = t->by[k] + 0.0; /* -0 is 0 */
        texture_map_add_thing(map, &thing, err);
    }
    return err->status;
}
