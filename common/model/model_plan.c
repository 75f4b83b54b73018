/* model_plan.c - reads plan.txt: walls, openings and rooms by name, with their positions.
 *
 * model.txt has the solids, and plan.txt what they were made from; stages that need to know what a wall or a window
 * is read it here. The order of the file is walls, openings, rooms, slots: a line may name only what stands above
 * it, so names become indices as they are read.
 *
 * A wall is the set of points p with n p = offset in plan, n its normal into the room, and spans an interval along
 * itself; an opening is an interval of that and one of z. A ceiling is the lowest of one or two planes z = a + b x +
 * c y, which covers level ceilings, slopes and gables.
 *
 * Corners of openings are given only for walls along an axis, where the position along the wall is a coordinate. */
#include "common/model/model_plan.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/product/product.h"

static enum status numbers(struct textfile *t, const char *const fields[], double *v, int count, struct err *err)
{
    for (int i = 0; i < count; i++)
        if (textfile_double(t, fields[i], &v[i], err)) return err->status;
    return ST_OK;
}

/* The next word of the line, owned by the caller. */
static enum status owned_word(struct textfile *t, const char *what, char **to, struct err *err)
{
    char *word;
    if (textfile_word(t, what, &word, err)) return err->status;
    *to = strdup(word);
    return *to ? ST_OK : err_nomem(err, "a name", strlen(word));
}

int model_plan_find_wall(const struct model_plan *plan, const char *name)
{
    for (int i = 0; i < plan->wall_count; i++)
        if (!strcmp(plan->walls[i].name, name)) return i;
    return -1;
}

int model_plan_find_room(const struct model_plan *plan, const char *name)
{
    for (int i = 0; i < plan->room_count; i++)
        if (!strcmp(plan->rooms[i].name, name)) return i;
    return -1;
}

double model_room_ceiling(const struct model_room *room, double x, double y)
{
    double z = INFINITY;
    for (int k = 0; k < room->ceilings; k++)
        z = fmin(z, room->ceiling[k][0] + room->ceiling[k][1] * x + room->ceiling[k][2] * y);
    return z;
}

static enum status known_room(const struct model_plan *plan, struct textfile *t, int *room, struct err *err)
{
    char *name;
    if (textfile_word(t, "a room's name", &name, err)) return err->status;
    *room = model_plan_find_room(plan, name);
    return *room < 0 ? textfile_error(t, err, name, "the name of a room on a line above") : ST_OK;
}

/* *closed: the next word is "closed", not "open". */
static enum status open_or_closed(struct textfile *t, bool *closed, struct err *err)
{
    char *state;
    if (textfile_word(t, "open or closed", &state, err)) return err->status;
    *closed = !strcmp(state, "closed");
    return *closed || !strcmp(state, "open") ? ST_OK : textfile_error(t, err, state, "open or closed");
}

static enum status known_wall(const struct model_plan *plan, struct textfile *t, int *wall, struct err *err)
{
    char *name;
    if (textfile_word(t, "a wall's name", &name, err)) return err->status;
    *wall = model_plan_find_wall(plan, name);
    return *wall < 0 ? textfile_error(t, err, name, "the name of a wall on a line above") : ST_OK;
}

static enum status wall_end(struct model_wall *w, int end, struct textfile *t, struct err *err)
{
    static const char *const kinds[] = {"free", "corner", "meets"};
    char *kind;
    int k = 0;
    if (textfile_expect(t, end ? "end" : "start", err) || textfile_word(t, "the kind of its end", &kind, err))
        return err->status;
    while (k < 3 && strcmp(kind, kinds[k])) k++;
    if (k == 3) return textfile_error(t, err, kind, "free, corner or meets");
    w->ends[end] = (enum model_wall_end)k;
    return k ? owned_word(t, "a wall's name", &w->neighbours[end], err) : ST_OK;
}

static enum status read_wall(struct model_plan *plan, struct textfile *t, struct err *err)
{
    static const char *const direction[] = {"x of the normal", "y of the normal"};
    if (array_append(&plan->walls, (size_t)plan->wall_count, sizeof *plan->walls, "walls", err)) return err->status;
    struct model_wall *w = &plan->walls[plan->wall_count++];
    *w = (struct model_wall){0};
    if (owned_word(t, "a wall's name", &w->name, err) || textfile_expect(t, "normal", err) ||
        numbers(t, direction, w->normal, 2, err) || textfile_expect(t, "at", err) ||
        textfile_double(t, "the wall's offset", &w->offset, err) || textfile_expect(t, "thickness", err) ||
        textfile_double(t, "its thickness", &w->thickness, err) || textfile_expect(t, "from", err) ||
        textfile_double(t, "its start", &w->span[0], err) || textfile_expect(t, "to", err) ||
        textfile_double(t, "its end", &w->span[1], err) || textfile_expect(t, "foot", err) ||
        textfile_double(t, "its foot", &w->foot, err) || textfile_expect(t, "top", err) ||
        textfile_double(t, "its top", &w->top, err) || wall_end(w, 0, t, err) || wall_end(w, 1, t, err))
        return err->status;
    if (!(fabs(hypot(w->normal[0], w->normal[1]) - 1) < 1e-6))
        return textfile_error(t, err, w->name, "a wall with a normal of length 1");
    return ST_OK;
}

static enum status read_opening(struct model_plan *plan, struct textfile *t, enum model_opening_kind kind,
                                struct err *err)
{
    static const char *const from[] = {"its start", "its sill"}, *const to[] = {"its end", "its head"};
    double a[2], b[2];
    if (array_append(&plan->openings, (size_t)plan->opening_count, sizeof *plan->openings, "openings", err))
        return err->status;
    struct model_opening *o = &plan->openings[plan->opening_count++];
    *o = (struct model_opening){.kind = kind};
    if (owned_word(t, "an opening's name", &o->name, err) || textfile_expect(t, "on", err) ||
        known_wall(plan, t, &o->wall, err) || textfile_expect(t, "from", err) || numbers(t, from, a, 2, err) ||
        textfile_expect(t, "to", err) || numbers(t, to, b, 2, err) || open_or_closed(t, &o->closed, err))
        return err->status;
    for (int k = 0; k < 2; k++) {
        o->s[k] = k ? b[0] : a[0];
        o->z[k] = k ? b[1] : a[1];
    }
    return ST_OK;
}

static const char *const ceiling_fields[] = {"height", "slope along x", "slope along y"};

static enum status read_room(struct model_plan *plan, struct textfile *t, struct err *err)
{
    static const char *const at[] = {"x", "y"};
    if (array_append(&plan->rooms, (size_t)plan->room_count, sizeof *plan->rooms, "rooms", err)) return err->status;
    struct model_room *r = &plan->rooms[plan->room_count++];
    *r = (struct model_room){.ceilings = 1};
    if (owned_word(t, "a room's name", &r->name, err) || textfile_expect(t, "floor", err) ||
        textfile_double(t, "the floor's height", &r->floor, err) || textfile_expect(t, "ceiling", err) ||
        numbers(t, ceiling_fields, r->ceiling[0], 3, err))
        return err->status;
    do {
        double p[2];
        if (array_append(&r->corners, (size_t)r->corner_count, sizeof *r->corners, "corners", err)) return err->status;
        struct model_room_corner *c = &r->corners[r->corner_count++];
        *c = (struct model_room_corner){.wall = -1};
        if (owned_word(t, "a wall's name", &c->wall_name, err) || numbers(t, at, p, 2, err)) return err->status;
        c->wall = model_plan_find_wall(plan, c->wall_name);
        c->x = p[0];
        c->y = p[1];
    } while (textfile_more(t));
    return r->corner_count < 3 ? textfile_error(t, err, r->name, "a room of three corners or more") : ST_OK;
}

static enum status read_gable(struct model_plan *plan, struct textfile *t, struct err *err)
{
    int room;
    if (known_room(plan, t, &room, err) || textfile_expect(t, "ceiling", err)) return err->status;
    struct model_room *r = &plan->rooms[room];
    if (r->ceilings == 2) return textfile_error(t, err, r->name, "a room without a gable on a line above");
    if (numbers(t, ceiling_fields, r->ceiling[1], 3, err)) return err->status;
    r->ceilings = 2;
    return ST_OK;
}

static enum status read_slot(struct model_plan *plan, struct textfile *t, bool skylight, struct err *err)
{
    static const char *const at[] = {"x", "y"};
    if (array_append(&plan->slots, (size_t)plan->slot_count, sizeof *plan->slots, "openings", err)) return err->status;
    struct model_slot *o = &plan->slots[plan->slot_count++];
    *o = (struct model_slot){.skylight = skylight};
    if (owned_word(t, "an opening's name", &o->name, err) || textfile_expect(t, "on", err) ||
        known_room(plan, t, &o->room, err) || textfile_expect(t, "from", err) || numbers(t, at, o->low, 2, err) ||
        textfile_expect(t, "to", err) || numbers(t, at, o->high, 2, err))
        return err->status;
    return open_or_closed(t, &o->closed, err);
}

static enum status read_box(struct model_plan *plan, struct textfile *t, struct err *err)
{
    static const char *const fields[] = {"x0", "y0", "z0", "x1", "y1", "z1"};
    double v[6];
    if (array_append(&plan->boxes, (size_t)plan->box_count, sizeof *plan->boxes, "boxes", err)) return err->status;
    struct model_box *b = &plan->boxes[plan->box_count++];
    *b = (struct model_box){0};
    if (owned_word(t, "a box's name", &b->name, err) || numbers(t, fields, v, 6, err) ||
        textfile_expect(t, "turn", err) || textfile_double(t, "degrees", &b->turn, err))
        return err->status;
    b->low = vec3_make(v[0], v[1], v[2]);
    b->high = vec3_make(v[3], v[4], v[5]);
    return ST_OK;
}

static enum status read_statement(struct model_plan *plan, struct textfile *t, struct err *err)
{
    char *verb;
    if (textfile_word(t, "a statement", &verb, err)) return err->status;
    if (!strcmp(verb, "wall")) return read_wall(plan, t, err);
    if (!strcmp(verb, "door")) return read_opening(plan, t, MODEL_DOOR, err);
    if (!strcmp(verb, "passage")) return read_opening(plan, t, MODEL_PASSAGE, err);
    if (!strcmp(verb, "window")) return read_opening(plan, t, MODEL_WINDOW, err);
    if (!strcmp(verb, "room")) return read_room(plan, t, err);
    if (!strcmp(verb, "gable")) return read_gable(plan, t, err);
    if (!strcmp(verb, "skylight")) return read_slot(plan, t, true, err);
    if (!strcmp(verb, "hatch")) return read_slot(plan, t, false, err);
    if (!strcmp(verb, "box")) return read_box(plan, t, err);
    return ST_OK;
}

enum status model_plan_read(struct model_plan *plan, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    *plan = (struct model_plan){0};
    product_open(&t, NULL, PRODUCT_PLAN, path, prov, err);
    while (!err->status && textfile_next(&t)) read_statement(plan, &t, err);
    textfile_release(&t);
    if (err->status) model_plan_release(plan);
    return err->status;
}

void model_plan_release(struct model_plan *plan)
{
    if (!plan) return;
    for (int i = 0; i < plan->wall_count; i++) {
        free(plan->walls[i].name);
        free(plan->walls[i].neighbours[0]);
        free(plan->walls[i].neighbours[1]);
    }
    for (int i = 0; i < plan->opening_count; i++) free(plan->openings[i].name);
    for (int i = 0; i < plan->room_count; i++) {
        for (int k = 0; k < plan->rooms[i].corner_count; k++) free(plan->rooms[i].corners[k].wall_name);
        free(plan->rooms[i].name);
        free(plan->rooms[i].corners);
    }
    for (int i = 0; i < plan->slot_count; i++) free(plan->slots[i].name);
    for (int i = 0; i < plan->box_count; i++) free(plan->boxes[i].name);
    free(plan->slots);
    free(plan->walls);
    free(plan->openings);
    free(plan->rooms);
    free(plan->boxes);
    *plan = (struct model_plan){0};
}

bool model_opening_corners(const struct model_plan *plan, int opening, struct vec3 corners[2])
{
    const struct model_opening *o = &plan->openings[opening];
    const struct model_wall *w = &plan->walls[o->wall];
    if (fmin(fabs(w->normal[0]), fabs(w->normal[1])) > 1e-9) return false;
    const bool along_y = fabs(w->normal[0]) > 0.5;
    for (int k = 0; k < 2; k++)
        corners[k] = along_y ? vec3_make(w->normal[0] * w->offset, o->s[k], o->z[k])
                             : vec3_make(o->s[k], w->normal[1] * w->offset, o->z[k]);
    return true;
}
