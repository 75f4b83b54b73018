/* plan_textures.c - statements about textures, colours, gloss and clutter. What they mean for faces is found when the
 * model has been built (texture_rules.c). */
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "stages/build_model/plan_internal.h"

#define ABOVE_ALL 1e4 /* model units: heights without a limit */

void plan_wishes_release(struct plan *plan)
{
    for (int i = 0; i < plan->wish_count; i++) {
        free(plan->wishes[i].path);
        free(plan->wishes[i].face);
        free(plan->wishes[i].from);
    }
    free(plan->wishes);
    free(plan->zones);
}

/* Adds a wish, of which the strings are copied. */
static enum status add_wish(struct plan_context *c, struct plan_wish wish, const char *face, const char *from)
{
    struct plan *p = c->plan;
    if (array_append(&p->wishes, (size_t)p->wish_count, sizeof *p->wishes, "textures", c->err)) return c->err->status;
    wish.path = strdup(c->path);
    wish.line = c->s->line;
    wish.face = strdup(face);
    wish.from = from ? strdup(from) : NULL;
    p->wishes[p->wish_count++] = wish;
    if (wish.path && wish.face && (wish.from || !from)) return ST_OK;
    return err_nomem(c->err, "a texture", strlen(c->path) + strlen(face));
}

enum status apply_texture(struct plan_context *c)
{
    enum name_kind kind;
    int at;
    if (find_named(c, c->s->name, ~0u, "a wall, an opening, a box or a room", &kind, &at)) return c->err->status;
    const bool stretch = !strcmp(c->s->other, "stretch");
    return add_wish(c, (struct plan_wish){.kind = stretch ? WISH_STRETCH : WISH_CROP}, c->s->name, NULL);
}

enum status apply_material(struct plan_context *c)
{
    return add_wish(c, (struct plan_wish){.kind = WISH_GLOSS, .gloss = c->s->gloss}, c->s->name, NULL);
}

/* ------------------------------------------------------------------------------------------------------ places */

/* The name between a face's first two slashes, or after the first; false: it is too long. */
static bool item_of(char item[80], const char *face)
{
    const char *begin = strchr(face, '/') + 1;
    const size_t length = strcspn(begin, "/");
    if (length >= 80) return false;
    memcpy(item, begin, length);
    item[length] = '\0';
    return true;
}

/* Places are on a wall's in or out face, on a floor or a ceiling. */
static bool has_places(const char *face)
{
    const char *part = strchr(strchr(face, '/') + 1, '/');
    if (!strncmp(face, "wall/", 5)) return part && (!strcmp(part, "/in") || !strcmp(part, "/out"));
    return !part && (!strncmp(face, "floor/", 6) || !strncmp(face, "ceiling/", 8));
}

/* The rectangle of a place on a face: S and Z on a wall, X and Y on a floor or ceiling. plan: the edited or the
 * unedited one. */
static enum status place_on_face(struct plan_context *c, struct plan *plan, const char *face,
                                 const struct script_place *place, double rect[4])
{
    struct statement moved = *c->s;
    struct plan_context at = *c;
    char item[80];
    int index;
    moved.place = *place;
    at.s = &moved;
    at.plan = plan;
    if (!item_of(item, face)) return statement_error(c, "%s is no face.", face);
    moved.name = item;
    if (!has_places(face))
        return statement_error(
            c,
            "a place on %s cannot be given: only wall/NAME/in and out (S and Z), floor/NAME and ceiling/NAME (X and Y) "
            "have places. Leave the %s out: the whole face gets the %s.",
            face, c->s->verb == VERB_COPY ? "second place" : "place", c->s->verb == VERB_COPY ? "texture" : "colour");
    if (!strncmp(face, "wall/", 5)) {
        double s[2], z[2];
        if (find_wall(&at, item, &index) || place_on_wall(&at, index, s, z)) return c->err->status;
        memcpy(rect, (const double[]){s[0], z[0], s[1], z[1]}, 4 * sizeof *rect);
        return ST_OK;
    }
    const enum verb verb = !strncmp(face, "floor/", 6) ? VERB_HATCH : VERB_SKYLIGHT;
    double low[2], high[2];
    if (find_room(&at, item, &index) || place_in_room(&at, &plan->rooms[index], verb, low, high)) return c->err->status;
    memcpy(rect, (const double[]){low[0], low[1], high[0], high[1]}, 4 * sizeof *rect);
    return ST_OK;
}

static enum status check_rectangle(struct plan_context *c, const char *face, const double rect[4])
{
    if (rect[2] - rect[0] >= MIN_SIZE && rect[3] - rect[1] >= MIN_SIZE) return ST_OK;
    return statement_error(c, "the place on %s is %.9g wide and %.9g high, wanted %g or more.", face, rect[2] - rect[0],
                           rect[3] - rect[1], MIN_SIZE);
}

/* colour, paint */
enum status apply_colour(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan_wish wish = {.kind = WISH_COLOUR, .whole = s->place.kind == PLACE_NONE};
    memcpy(wish.colour, s->values, sizeof wish.colour);
    if (!wish.whole &&
        (place_on_face(c, c->plan, s->name, &s->place, wish.target) || check_rectangle(c, s->name, wish.target)))
        return c->err->status;
    return add_wish(c, wish, s->name, NULL);
}

/* ------------------------------------------------------------------------------------------------------ copies */

/* Texture cannot be copied from what the edit made. */
static enum status check_source(struct plan_context *c, const char *face)
{
    struct err none = ERR_INIT;
    struct plan_context edited = *c, unedited = *c;
    char item[80];
    enum name_kind kind;
    int at;
    unedited.plan = c->plan->unedited;
    unedited.err = edited.err = &none;
    if (!item_of(item, face) || !find_named(&unedited, item, ~0u, "", &kind, &at)) return ST_OK;
    if (find_named(&edited, item, ~0u, "", &kind, &at)) return ST_OK;
    return statement_error(c, "%s is not in the unedited model, whose texture is copied.", item);
}

/* The patch lies where the unedited model has it, also if the edit moved or removed that wall. */
enum status apply_copy(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan_wish wish = {.kind = WISH_COPY, .whole = s->target.kind == PLACE_NONE};
    if (check_source(c, s->name) || place_on_face(c, c->plan->unedited, s->name, &s->place, wish.patch) ||
        check_rectangle(c, s->name, wish.patch))
        return c->err->status;
    if (!wish.whole &&
        (place_on_face(c, c->plan, s->other, &s->target, wish.target) || check_rectangle(c, s->other, wish.target)))
        return c->err->status;
    return add_wish(c, wish, s->other, s->name);
}

/* ------------------------------------------------------------------------------------------------------ clutter */

enum status apply_zone(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan *p = c->plan;
    struct plan_zone zone = {.keep = s->verb == VERB_KEEP, .room = -1, .opening = -1};
    zone.low[2] = s->has_option[OPTION_FOOT] ? s->options[OPTION_FOOT] : -ABOVE_ALL;
    zone.high[2] = s->has_option[OPTION_TOP] ? s->options[OPTION_TOP] : ABOVE_ALL;
    if (!(zone.low[2] < zone.high[2]))
        return statement_error(c, "found foot %.9g and top %.9g, wanted a top above the foot.", zone.low[2],
                               zone.high[2]);
    zone.all = s->name && !strcmp(s->name, "all");
    if (s->name && !zone.all && find_room(c, s->name, &zone.room)) return c->err->status;
    if (s->other) {
        enum name_kind kind;
        zone.before = s->values[0];
        if (find_named(c, s->other, 1u << NAMED_OPENING, "a door, passage or window", &kind, &zone.opening))
            return c->err->status;
        if (!(zone.before >= MIN_SIZE))
            return statement_error(c, "found a distance of %.9g from the wall, wanted %g or more.", zone.before,
                                   MIN_SIZE);
    } else if (!s->name) {
        const double at = s->has_option[OPTION_FOOT] ? s->options[OPTION_FOOT] : 0;
        if (place_footprint(c, at, zone.low, zone.high)) return c->err->status;
    }
    if (array_append(&p->zones, (size_t)p->zone_count, sizeof *p->zones, "places to clear", c->err))
        return c->err->status;
    p->zones[p->zone_count++] = zone;
    return ST_OK;
}
