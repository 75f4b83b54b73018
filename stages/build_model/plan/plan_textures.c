/* plan_textures.c - statements about textures, colours, gloss and clutter. What they mean for faces is found when the
 * model has been built (texture_rules.c). */
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "stages/build_model/plan/plan_internal.h"
#include "stages/build_model/script/script_words.h"

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

enum status plan_read_texture(struct script_reader *r, struct statement *s)
{
    char *word;
    if (script_read_name(r, "a wall, an opening, a box or a room", &s->name)) return r->err->status;
    if (textfile_word(&r->t, "\"stretch\" or \"crop\"", &word, r->err)) return r->err->status;
    if (strcmp(word, "stretch") && strcmp(word, "crop"))
        return textfile_error(&r->t, r->err, word, "\"stretch\" or \"crop\"");
    s->other = script_keep_word(r, word);
    return ST_OK;
}

enum status plan_apply_texture(struct plan_context *c)
{
    enum name_kind kind;
    int at;
    if (plan_find_named(c, c->s->name, ~(1u << NAMED_THING), "a wall, an opening, a box or a room", &kind, &at))
        return c->err->status;
    const bool stretch = !strcmp(c->s->other, "stretch");
    return add_wish(c, (struct plan_wish){.kind = stretch ? WISH_STRETCH : WISH_CROP}, c->s->name, NULL);
}

enum status plan_read_material(struct script_reader *r, struct statement *s)
{
    return script_read_face(r, &s->name) || gloss_read(&s->gloss, &r->t, r->err) ||
                   gloss_check(&s->gloss, 0, &r->t, r->err)
               ? r->err->status
               : ST_OK;
}

enum status plan_apply_material(struct plan_context *c)
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
 * unedited one. copied: the place is for a copy, not for a colour. */
static enum status place_on_face(struct plan_context *c, struct plan *plan, const char *face,
                                 const struct script_place *place, bool copied, double rect[4])
{
    struct statement moved = *c->s;
    struct plan_context at = *c;
    char item[80];
    int index;
    moved.place = *place;
    at.s = &moved;
    at.plan = plan;
    if (!item_of(item, face)) return plan_statement_error(c, "%s is no face.", face);
    moved.name = item;
    if (!has_places(face))
        return plan_statement_error(
            c,
            "a place on %s cannot be given: only wall/NAME/in and out (S and Z), floor/NAME and ceiling/NAME (X and Y) "
            "have places. Leave the %s out: the whole face gets the %s.",
            face, copied ? "second place" : "place", copied ? "texture" : "colour");
    if (!strncmp(face, "wall/", 5)) {
        double s[2], z[2];
        if (plan_find_wall(&at, item, &index) || plan_place_on_wall(&at, index, s, z)) return c->err->status;
        memcpy(rect, (const double[]){s[0], z[0], s[1], z[1]}, 4 * sizeof *rect);
        return ST_OK;
    }
    const enum opening_kind kind = !strncmp(face, "floor/", 6) ? OPENING_HATCH : OPENING_SKYLIGHT;
    double low[2], high[2];
    if (plan_find_room(&at, item, &index) || plan_place_in_room(&at, &plan->rooms[index], kind, low, high))
        return c->err->status;
    memcpy(rect, (const double[]){low[0], low[1], high[0], high[1]}, 4 * sizeof *rect);
    return ST_OK;
}

static enum status check_rectangle(struct plan_context *c, const char *face, const double rect[4])
{
    if (rect[2] - rect[0] >= MIN_SIZE && rect[3] - rect[1] >= MIN_SIZE) return ST_OK;
    return plan_statement_error(c, "the place on %s is %.9g wide and %.9g high, wanted %g or more.", face,
                                rect[2] - rect[0], rect[3] - rect[1], MIN_SIZE);
}

enum status plan_read_colour(struct script_reader *r, struct statement *s)
{
    return script_read_face(r, &s->name) || script_read_colour(r, s) ? r->err->status : ST_OK;
}

enum status plan_read_paint(struct script_reader *r, struct statement *s)
{
    if (script_read_face(r, &s->name)) return r->err->status;
    if ((script_next_is(r, "from") || script_next_is(r, "in") || script_next_is(r, "at")) &&
        script_read_place(r, &s->place, 1u << PLACE_FROM_END))
        return r->err->status;
    return script_read_colour(r, s);
}

/* colour, paint */
enum status plan_apply_colour(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan_wish wish = {.kind = WISH_COLOUR, .whole = s->place.kind == PLACE_NONE};
    memcpy(wish.colour, s->values, sizeof wish.colour);
    if (!wish.whole &&
        (place_on_face(c, c->plan, s->name, &s->place, false, wish.target) || check_rectangle(c, s->name, wish.target)))
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
    if (!item_of(item, face) || !plan_find_named(&unedited, item, ~0u, "", &kind, &at)) return ST_OK;
    if (plan_find_named(&edited, item, ~0u, "", &kind, &at)) return ST_OK;
    return plan_statement_error(c, "%s is not in the unedited model, whose texture is copied.", item);
}

enum status plan_read_copy(struct script_reader *r, struct statement *s)
{
    if (!script_next_is(r, "texture")) return plan_read_thing_copy(r, s);
    if (script_expect(r, "texture") || script_read_face(r, &s->name) ||
        script_read_place(r, &s->place, 1u << PLACE_FROM_END) || script_expect(r, "to") ||
        script_read_face(r, &s->other))
        return r->err->status;
    return textfile_more(&r->t) ? script_read_place(r, &s->target, 1u << PLACE_FROM_END) : ST_OK;
}

/* The patch lies where the unedited model has it, also if the edit moved or removed that wall. */
enum status plan_apply_copy(struct plan_context *c)
{
    const struct statement *s = c->s;
    struct plan_wish wish = {.kind = WISH_COPY, .whole = s->target.kind == PLACE_NONE};
    if (s->value_count) return plan_apply_thing_copy(c);
    if (s->has_option[OPTION_TURN]) return plan_statement_error(c, "a texture is not turned; leave out \"turn\".");
    if (check_source(c, s->name) || place_on_face(c, c->plan->unedited, s->name, &s->place, true, wish.patch) ||
        check_rectangle(c, s->name, wish.patch))
        return c->err->status;
    if (!wish.whole && (place_on_face(c, c->plan, s->other, &s->target, true, wish.target) ||
                        check_rectangle(c, s->other, wish.target)))
        return c->err->status;
    return add_wish(c, wish, s->other, s->name);
}

/* ------------------------------------------------------------------------------------------------------ clutter */

/* A place, or the space before an opening; `named`: also a room, or all of them. */
static enum status read_zone(struct script_reader *r, struct statement *s, bool named)
{
    const char *next = script_next_word(r);
    if (!strncmp(next, "before ", 7)) {
        s->value_count = 1;
        return script_expect(r, "before") || script_read_name(r, "a door, passage or window", &s->other) ||
                       script_expect(r, "by") || script_read_number(r, "a distance from the wall", &s->values[0])
                   ? r->err->status
                   : ST_OK;
    }
    if (!strncmp(next, "in ", 3) || !strncmp(next, "from ", 5)) return script_read_place(r, &s->place, 0);
    return script_read_name(r,
                            named ? "a room, a thing, \"all\", \"in VIEW\", \"from\" or \"before\""
                                  : "a thing, \"in VIEW\", \"from\" or \"before\"",
                            &s->name);
}

enum status plan_read_clear(struct script_reader *r, struct statement *s) { return read_zone(r, s, true); }

enum status plan_read_keep(struct script_reader *r, struct statement *s) { return read_zone(r, s, false); }

static enum status add_zone(struct plan_context *c, bool keep)
{
    const struct statement *s = c->s;
    struct plan *p = c->plan;
    struct plan_zone zone = {.keep = keep, .room = -1, .opening = -1};
    int thing;
    if (s->name && plan_is_thing(p, s->name, &thing)) return plan_apply_thing_clear(c, thing, keep);
    if (s->name && keep)
        return plan_statement_error(c, "found %s, wanted a thing of things.txt, \"in VIEW\" or \"from\".", s->name);
    zone.low[2] = s->has_option[OPTION_FOOT] ? s->options[OPTION_FOOT] : -ABOVE_ALL;
    zone.high[2] = s->has_option[OPTION_TOP] ? s->options[OPTION_TOP] : ABOVE_ALL;
    if (!(zone.low[2] < zone.high[2]))
        return plan_statement_error(c, "found foot %.9g and top %.9g, wanted a top above the foot.", zone.low[2],
                                    zone.high[2]);
    zone.all = s->name && !strcmp(s->name, "all");
    if (zone.all && !p->room_count)
        return plan_statement_error(c,
                                    "the model has no rooms that could be cleared; state them with \"room\", or clear "
                                    "a place, such as \"clear from 0 0 to 4 3\".");
    enum name_kind kind;
    if (s->name && !zone.all &&
        plan_find_named(c, s->name, 1u << NAMED_ROOM, "a room, or a thing of things.txt", &kind, &zone.room))
        return c->err->status;
    if (s->other) {
        zone.before = s->values[0];
        if (plan_find_named(c, s->other, 1u << NAMED_OPENING, "a door, passage or window", &kind, &zone.opening))
            return c->err->status;
        if (!(zone.before >= MIN_SIZE))
            return plan_statement_error(c, "found a distance of %.9g from the wall, wanted %g or more.", zone.before,
                                        MIN_SIZE);
    } else if (!s->name) {
        const double at = s->has_option[OPTION_FOOT] ? s->options[OPTION_FOOT] : 0;
        if (plan_place_footprint(c, at, zone.low, zone.high)) return c->err->status;
    }
    if (array_append(&p->zones, (size_t)p->zone_count, sizeof *p->zones, "places to clear", c->err))
        return c->err->status;
    p->zones[p->zone_count++] = zone;
    return ST_OK;
}

enum status plan_apply_clear(struct plan_context *c) { return add_zone(c, false); }

enum status plan_apply_keep(struct plan_context *c) { return add_zone(c, true); }
