/* texture_map.c - reads and writes texture.txt: where the faces of an edited model take their texture from.
 *
 * Look-ups. Faces in different planes may share an id, so a look-up by id is a binary search over the faces, sorted
 * by id, and among those of the id the plane nearest to the point. A rule holds at a point if the point is within
 * its quadrilateral: on one side of all four edges. Then an affine map, 3 x 4, leads from the point of the edited
 * model to that of the unedited one whose texture it shows.
 *
 * Clutter. A point is cleared if a `clear` zone holds it and no `keep` zone does, in whatever order they stand. A
 * zone is a prism: a polygon in plan, tested by the parity of crossings, and a range of heights.
 *
 * Numbers that make places have 17 digits, so that the map is the same to the bit after reading; colours have 9, the
 * precision of a float. Everything is checked as it is read: faces in order of id, corners of a zone, triangles of
 * new surfaces. */
#include "common/texture/texture_map.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/base/sort.h"
#include "common/base/textfile.h"
#include "common/math/polygon.h"
#include "common/product/product.h"

#define NO_BASE "none"

enum { NAME_SIZE = 1024, MAX_CORNERS = 100000 };
static const double FARTHEST = 1e6;

static void face_release(struct texture_face *face)
{
    for (int i = 0; i < face->rule_count; i++) free(face->rules[i].lit);
    free(face->rules);
    free(face->added);
    free(face->name);
}

void texture_map_release(struct texture_map *map)
{
    if (!map) return;
    for (int i = 0; i < map->face_count; i++) face_release(&map->faces[i]);
    for (int i = 0; i < map->zone_count; i++) {
        free(map->zones[i].name);
        free(map->zones[i].corners);
    }
    for (int i = 0; i < map->lamp_count; i++) free(map->lamps[i].name);
    for (int i = 0; i < map->planned_count; i++) {
        free(map->planned[i].name);
        free(map->planned[i].file);
    }
    for (int i = 0; i < map->thing_count; i++) {
        free(map->things[i].name);
        free(map->things[i].from);
        free(map->things[i].script);
    }
    free(map->things);
    free(map->lamps);
    free(map->planned);
    free(map->faces);
    free(map->zones);
    free(map->base);
    *map = (struct texture_map){0};
}

enum status texture_map_add_thing(struct texture_map *map, const struct texture_thing *thing, struct err *err)
{
    if (array_append(&map->things, (size_t)map->thing_count, sizeof *map->things, "things", err)) return err->status;
    struct texture_thing *to = &map->things[map->thing_count++];
    *to = *thing;
    to->name = strdup(thing->name);
    to->from = strdup(thing->from);
    to->script = strdup(thing->script);
    return to->name && to->from && to->script ? ST_OK : err_nomem(err, "a thing", strlen(thing->name));
}

/* --------------------------------------------------------------------------------------------------------- look-ups */

static bool face_is_below(const void *face, const void *id)
{
    return ((const struct texture_face *)face)->id < *(const int *)id;
}

const struct texture_face *texture_map_find(const struct texture_map *map, int id, struct vec3 p)
{
    const struct texture_face *best = NULL;
    double least = INFINITY;
    const size_t first = sort_place(map->faces, (size_t)map->face_count, sizeof *map->faces, face_is_below, &id);
    for (int i = (int)first; i < map->face_count && map->faces[i].id == id; i++) {
        const double off = fabs(vec3_dot(map->faces[i].normal, p) - map->faces[i].offset);
        if (off < least) {
            least = off;
            best = &map->faces[i];
        }
    }
    return best;
}

const double *texture_map_lamp(const struct texture_map *map, const char *name)
{
    for (int i = 0; i < map->lamp_count; i++)
        if (!strcmp(map->lamps[i].name, name)) return map->lamps[i].scale;
    return NULL;
}

/* The quadrilateral is convex; its corners run in either direction. */
bool texture_rule_holds(const struct texture_rule *rule, struct vec3 normal, struct vec3 p)
{
    bool left = true, right = true;
    for (int i = 0; rule->limited && i < 4; i++) {
        const struct vec3 a = rule->within[i], b = rule->within[(i + 1) % 4];
        const double side = vec3_dot(vec3_cross(vec3_sub(b, a), vec3_sub(p, a)), normal);
        left = left && side >= 0;
        right = right && side <= 0;
    }
    return left || right;
}

struct vec3 texture_rule_place(const struct texture_rule *rule, struct vec3 p)
{
    double to[3];
    for (int i = 0; i < 3; i++) {
        const double *m = rule->matrix[i];
        to[i] = m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3];
    }
    return vec3_make(to[0], to[1], to[2]);
}

/* The first rule that holds counts, as where a face is drawn. */
bool texture_map_keeps(const struct texture_map *map, int id, struct vec3 p, double slack)
{
    const struct texture_face *face = texture_map_find(map, id, p);
    int k = 0;
    if (!face) return true;
    while (k < face->rule_count && !texture_rule_holds(&face->rules[k], face->normal, p)) k++;
    const struct texture_rule *rule = k < face->rule_count ? &face->rules[k] : NULL;
    if (!rule || rule->kind == TEXTURE_OUTDOORS) return true;
    return rule->kind != TEXTURE_COLOUR && rule->from == id &&
           vec3_length(vec3_sub(texture_rule_place(rule, p), p)) <= slack;
}

static bool zone_holds(const struct texture_zone *zone, struct vec3 p)
{
    return p.z >= zone->low && p.z <= zone->high &&
           polygon_holds((const double(*)[2])zone->corners, zone->corner_count, p.x, p.y);
}

bool texture_map_clears(const struct texture_map *map, struct vec3 p)
{
    bool clear = false;
    for (int i = 0; i < map->zone_count; i++) {
        if (!zone_holds(&map->zones[i], p)) continue;
        if (map->zones[i].keep) return false;
        clear = true;
    }
    return clear;
}

/* ---------------------------------------------------------------------------------------------------------- writing */

static void print_point(FILE *to, struct vec3 p) { fprintf(to, " %.17g %.17g %.17g", p.x, p.y, p.z); }

static void print_rule(FILE *to, const struct texture_rule *r)
{
    switch (r->kind) {
    case TEXTURE_PLACE:
    case TEXTURE_EDGE:
        fprintf(to, "%s %d", r->kind == TEXTURE_PLACE ? "place" : "edge", r->from);
        for (int i = 0; i < 12; i++) fprintf(to, " %.17g", r->matrix[i / 4][i % 4]);
        break;
    case TEXTURE_OUTDOORS:
        fprintf(to, "outdoors");
        break;
    case TEXTURE_COLOUR:
        fprintf(to, "colour %.9g %.9g %.9g lit", r->albedo[0], r->albedo[1], r->albedo[2]);
        for (int i = 0; i < r->lit_count; i++) fprintf(to, " %d", r->lit[i]);
        break;
    }
    if (r->limited) fprintf(to, " within");
    for (int i = 0; r->limited && i < 4; i++) print_point(to, r->within[i]);
    fputc('\n', to);
}

static enum status print_face(FILE *to, const struct texture_face *face, struct err *err)
{
    char name[NAME_SIZE];
    if (textfile_quote(face->name, name, sizeof name, err)) return err->status;
    fprintf(to, "face %d", face->id);
    print_point(to, face->normal);
    fprintf(to, " %.17g %s\n", face->offset, name);
    if (face->has_gloss) {
        fputs("gloss ", to);
        gloss_print(&face->gloss, to);
        fputc('\n', to);
    }
    for (int i = 0; i < face->rule_count; i++) print_rule(to, &face->rules[i]);
    if (face->added_count) fprintf(to, "new %d\n", face->added_count);
    for (int i = 0; i < face->added_count; i++) {
        fprintf(to, "triangle");
        for (int k = 0; k < 3; k++) print_point(to, face->added[i][k]);
        fputc('\n', to);
    }
    return ST_OK;
}

static enum status print_lamp(FILE *to, const struct texture_lamp *lamp, struct err *err)
{
    char name[NAME_SIZE];
    if (textfile_quote(lamp->name, name, sizeof name, err)) return err->status;
    fprintf(to, "lamp %s %.17g %.17g %.17g\n", name, lamp->scale[0], lamp->scale[1], lamp->scale[2]);
    return ST_OK;
}

static enum status print_planned(FILE *to, const struct texture_planned *l, struct err *err)
{
    char name[NAME_SIZE], file[NAME_SIZE];
    if (textfile_quote(l->name, name, sizeof name, err) || textfile_quote(l->file, file, sizeof file, err))
        return err->status;
    fprintf(to, "planned %s %s", name, file);
    for (int k = 0; k < 3; k++) fprintf(to, " %.17g", l->at[k]);
    for (int k = 0; k < 3; k++) fprintf(to, " %.17g", l->aim[k]);
    fprintf(to, " %.17g", l->turn);
    for (int k = 0; k < 3; k++) fprintf(to, " %.17g", l->colour[k]);
    for (int k = 0; k < 3; k++) fprintf(to, " %.17g", l->scale[k]);
    fputc('\n', to);
    return ST_OK;
}

static enum status print_zone(FILE *to, const struct texture_zone *zone, struct err *err)
{
    char name[NAME_SIZE];
    if (textfile_quote(zone->name, name, sizeof name, err)) return err->status;
    fprintf(to, "%s %s %.17g %.17g %d", zone->keep ? "keep" : "clear", name, zone->low, zone->high, zone->corner_count);
    for (int i = 0; i < zone->corner_count; i++) fprintf(to, " %.17g %.17g", zone->corners[i][0], zone->corners[i][1]);
    fputc('\n', to);
    return ST_OK;
}

static const char *const thing_words[] = {"clear", "keep", "move", "place"};

static enum status print_thing(FILE *to, const struct texture_thing *thing, struct err *err)
{
    char name[NAME_SIZE], from[NAME_SIZE], script[NAME_SIZE];
    if (textfile_quote(thing->name, name, sizeof name, err) || textfile_quote(thing->from, from, sizeof from, err) ||
        textfile_quote(thing->script, script, sizeof script, err))
        return err->status;
    fprintf(to, "thing %s %s", name, thing_words[thing->kind]);
    if (thing->kind == TEXTURE_THING_MOVE || thing->kind == TEXTURE_THING_PLACE)
        fprintf(to, " %s %.17g %.17g %.17g %.17g", from, thing->by[0], thing->by[1], thing->by[2], thing->turn);
    fprintf(to, " %s %d\n", script, thing->line);
    return ST_OK;
}

/* What the reader would refuse, or read as something else. */
static enum status check_map(const struct texture_map *map, const char *path, struct err *err)
{
    if (map->base && !strcmp(map->base, NO_BASE))
        return err_set(err, ST_DATA,
                       "%s: the edit stands on an edit named \"" NO_BASE "\", the word for no edit; give that edit "
                       "another name.",
                       path);
    for (int i = 0; i < 3 * map->lamp_count; i++)
        if (!(map->lamps[i / 3].scale[i % 3] >= 0 && isfinite(map->lamps[i / 3].scale[i % 3])))
            return err_set(err, ST_DATA, "%s: found a factor of %g for the lamp %s, wanted 0 or more.", path,
                           map->lamps[i / 3].scale[i % 3], map->lamps[i / 3].name);
    for (int i = 0; i < map->face_count; i++)
        if (map->faces[i].added_count > MAX_CORNERS)
            return err_set(
                err, ST_DATA,
                "%s: the face %s has %d triangles of new area, wanted at most %d; split the wall or the room "
                "that it belongs to.",
                path, map->faces[i].name, map->faces[i].added_count, (int)MAX_CORNERS);
    for (int i = 0; i < map->thing_count; i++) {
        const struct texture_thing *t = &map->things[i];
        if (!isfinite(t->by[0]) || !isfinite(t->by[1]) || !isfinite(t->by[2]) || !isfinite(t->turn))
            return err_set(err, ST_DATA, "%s: the place of the thing %s is not finite.", path, t->name);
    }
    for (int i = 0; i < map->zone_count; i++)
        if (map->zones[i].corner_count < 3 || map->zones[i].corner_count > MAX_CORNERS)
            return err_set(err, ST_DATA, "%s: the footprint of %s has %d corners, wanted 3 to %d.", path,
                           map->zones[i].name, map->zones[i].corner_count, (int)MAX_CORNERS);
    return ST_OK;
}

enum status texture_map_write(const struct texture_map *map, const char *path, const struct provenance *prov,
                              struct err *err)
{
    struct outfile file = {0};
    char base[NAME_SIZE];
    if (!check_map(map, path, err) && !textfile_quote(map->base ? map->base : NO_BASE, base, sizeof base, err) &&
        !outfile_open(&file, path, err)) {
        fprintf(file.fp, "%s\n", products[PRODUCT_TEXTURE_MAP].head);
        if (prov) provenance_print(prov, file.fp);
        fprintf(file.fp, "base %s\n", base);
    }
    for (int i = 0; !err->status && i < map->lamp_count; i++) print_lamp(file.fp, &map->lamps[i], err);
    for (int i = 0; !err->status && i < map->planned_count; i++) print_planned(file.fp, &map->planned[i], err);
    for (int i = 0; !err->status && i < map->face_count; i++) print_face(file.fp, &map->faces[i], err);
    for (int i = 0; !err->status && i < map->zone_count; i++) print_zone(file.fp, &map->zones[i], err);
    for (int i = 0; !err->status && i < map->thing_count; i++) print_thing(file.fp, &map->things[i], err);
    if (!err->status) outfile_commit(&file, err);
    outfile_discard(&file);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- reading */

static enum status read_point(struct textfile *t, struct vec3 *p, struct err *err)
{
    return textfile_double(t, "X", &p->x, err) || textfile_double(t, "Y", &p->y, err) ||
                   textfile_double(t, "Z", &p->z, err)
               ? err->status
               : ST_OK;
}

static enum status copy_word(char **to, struct textfile *t, const char *what, struct err *err)
{
    char *word;
    if (textfile_word(t, what, &word, err)) return err->status;
    *to = strdup(word);
    return *to ? ST_OK : err_nomem(err, "a name", strlen(word) + 1);
}

static enum status read_count(struct textfile *t, const char *what, int least, int *count, struct err *err)
{
    int64_t value;
    if (textfile_int(t, what, least, MAX_CORNERS, &value, err)) return err->status;
    *count = (int)value;
    return ST_OK;
}

/* The limits of a rule, if `word` begins them, and the end of the line. */
static enum status read_limits(struct texture_rule *rule, struct textfile *t, const char *word, struct err *err)
{
    if (word && strcmp(word, "within")) return textfile_error(t, err, word, "\"within\", or the end of the line");
    rule->limited = word != NULL;
    for (int i = 0; !err->status && rule->limited && i < 4; i++) read_point(t, &rule->within[i], err);
    const struct vec3 *w = rule->within;
    if (!err->status && rule->limited && !(vec3_length(vec3_cross(vec3_sub(w[2], w[0]), vec3_sub(w[3], w[1]))) > 0))
        return textfile_error(t, err, "within", "four corners around an area");
    if (!err->status) textfile_end(t, err);
    return err->status;
}

static enum status read_place(struct texture_rule *rule, struct textfile *t, struct err *err)
{
    int64_t from;
    char *word = NULL;
    textfile_int(t, "the id of a face", 1, INT_MAX, &from, err);
    for (int i = 0; !err->status && i < 12; i++) textfile_double(t, "a number of M", &rule->matrix[i / 4][i % 4], err);
    if (!err->status) rule->from = (int)from;
    if (!err->status && textfile_more(t)) textfile_word(t, "within", &word, err);
    if (!err->status) read_limits(rule, t, word, err);
    return err->status;
}

static enum status read_colour(struct texture_rule *rule, struct textfile *t, struct err *err)
{
    char *word = NULL;
    for (int c = 0; !err->status && c < 3; c++) {
        double value;
        if (!textfile_number(t, "a share of light", 0, 1, &value, err)) rule->albedo[c] = (float)value;
    }
    if (!err->status) textfile_expect(t, "lit", err);
    while (!err->status && textfile_more(t)) {
        int64_t id;
        if (textfile_word(t, "the id of a face", &word, err) || !strcmp(word, "within")) break;
        if (!scan_int(word, &id) || id < 1 || id > INT_MAX)
            return textfile_error(t, err, word, "the id of a face, or \"within\"");
        if (!array_append(&rule->lit, (size_t)rule->lit_count, sizeof *rule->lit, "faces", err))
            rule->lit[rule->lit_count++] = (int)id;
        word = NULL;
    }
    if (!err->status) read_limits(rule, t, word, err);
    return err->status;
}

static enum status read_rule(struct texture_face *face, struct textfile *t, const char *word, struct err *err)
{
    if (array_append(&face->rules, (size_t)face->rule_count, sizeof *face->rules, "rules", err)) return err->status;
    struct texture_rule *rule = &face->rules[face->rule_count++];
    *rule = (struct texture_rule){0};
    if (!strcmp(word, "outdoors")) {
        rule->kind = TEXTURE_OUTDOORS;
        return textfile_end(t, err);
    }
    if (!strcmp(word, "colour")) {
        rule->kind = TEXTURE_COLOUR;
        return read_colour(rule, t, err);
    }
    rule->kind = !strcmp(word, "edge") ? TEXTURE_EDGE : TEXTURE_PLACE;
    return read_place(rule, t, err);
}

static enum status read_gloss(struct texture_face *face, struct textfile *t, struct err *err)
{
    if (face->has_gloss || face->rule_count || face->added)
        return textfile_error(t, err, "gloss", "one line \"gloss\" right after the face's line");
    face->has_gloss = true;
    return gloss_read(&face->gloss, t, err) ? err->status : textfile_end(t, err);
}

static enum status read_lamp(struct texture_map *map, struct textfile *t, struct err *err)
{
    if (map->face_count || map->zone_count) return textfile_error(t, err, "lamp", "lamps before the lines \"face\"");
    if (array_append(&map->lamps, (size_t)map->lamp_count, sizeof *map->lamps, "lamps", err)) return err->status;
    struct texture_lamp *lamp = &map->lamps[map->lamp_count];
    *lamp = (struct texture_lamp){0};
    if (copy_word(&lamp->name, t, "the name of a lamp", err)) return err->status;
    const bool twice = texture_map_lamp(map, lamp->name) != NULL;
    map->lamp_count++;
    if (twice) return textfile_error(t, err, lamp->name, "a lamp that no line above has");
    for (int c = 0; c < 3; c++)
        if (textfile_number(t, "a factor", 0, INFINITY, &lamp->scale[c], err)) return err->status;
    return textfile_end(t, err);
}

static enum status read_numbers(double *to, int count, double min, double max, struct textfile *t, struct err *err)
{
    for (int k = 0; k < count; k++)
        if (textfile_number(t, "a number", min, max, &to[k], err)) return err->status;
    return ST_OK;
}

static enum status read_planned(struct texture_map *map, struct textfile *t, struct err *err)
{
    if (map->face_count || map->zone_count) return textfile_error(t, err, "planned", "lamps before the lines \"face\"");
    if (array_append(&map->planned, (size_t)map->planned_count, sizeof *map->planned, "lamps", err)) return err->status;
    struct texture_planned *l = &map->planned[map->planned_count++];
    *l = (struct texture_planned){.turn = 0};
    if (copy_word(&l->name, t, "the name of a lamp", err) || copy_word(&l->file, t, "an IES file", err))
        return err->status;
    for (int i = 0; i + 1 < map->planned_count; i++)
        if (!strcmp(map->planned[i].name, l->name))
            return textfile_error(t, err, l->name, "a lamp that no line above has");
    if (read_numbers(l->at, 3, -FARTHEST, FARTHEST, t, err) || read_numbers(l->aim, 3, -FARTHEST, FARTHEST, t, err) ||
        read_numbers(&l->turn, 1, -FARTHEST, FARTHEST, t, err) || read_numbers(l->colour, 3, 0, INFINITY, t, err) ||
        read_numbers(l->scale, 3, 0, INFINITY, t, err))
        return err->status;
    return textfile_end(t, err);
}

static enum status read_added(struct texture_face *face, struct textfile *t, struct err *err)
{
    int count = 0;
    if (face->added) return textfile_error(t, err, "new", "one line \"new\" in a face");
    if (!read_count(t, "a number of triangles", 1, &count, err)) textfile_end(t, err);
    for (int i = 0; !err->status && i < count; i++) {
        if (textfile_expect_line(t, "triangle", err) ||
            array_append(&face->added, (size_t)face->added_count, sizeof *face->added, "triangles", err))
            break;
        for (int k = 0; !err->status && k < 3; k++) read_point(t, &face->added[face->added_count][k], err);
        if (!err->status) {
            face->added_count++;
            textfile_end(t, err);
        }
    }
    return err->status;
}

static enum status read_face(struct texture_map *map, struct textfile *t, struct err *err)
{
    int64_t id;
    if (map->zone_count) return textfile_error(t, err, "face", "faces before the lines \"clear\" and \"keep\"");
    if (array_append(&map->faces, (size_t)map->face_count, sizeof *map->faces, "faces", err)) return err->status;
    struct texture_face *face = &map->faces[map->face_count++];
    *face = (struct texture_face){0};
    if (textfile_int(t, "the id of a face", 1, INT_MAX, &id, err) || read_point(t, &face->normal, err) ||
        textfile_double(t, "an offset", &face->offset, err) || copy_word(&face->name, t, "a name", err))
        return err->status;
    face->id = (int)id;
    const double length = vec3_length(face->normal);
    if (fabs(length - 1) > 1e-6) return textfile_wrong_number(t, length, "a normal of length 1", err);
    if (map->face_count > 1 && face[-1].id > face->id)
        return textfile_wrong_number(t, face->id, "an id that is not below the one before: faces are in order", err);
    return textfile_end(t, err);
}

static enum status read_zone(struct texture_map *map, struct textfile *t, bool keep, struct err *err)
{
    int count = 0;
    if (array_append(&map->zones, (size_t)map->zone_count, sizeof *map->zones, "zones", err)) return err->status;
    struct texture_zone *zone = &map->zones[map->zone_count++];
    *zone = (struct texture_zone){.keep = keep};
    if (!copy_word(&zone->name, t, "a name", err) && !textfile_double(t, "the lowest height", &zone->low, err))
        textfile_double(t, "the greatest height", &zone->high, err);
    if (!err->status && zone->high < zone->low) textfile_wrong_number(t, zone->high, "a height above the lowest", err);
    if (!err->status) read_count(t, "a number of corners", 3, &count, err);
    for (int i = 0; !err->status && i < count; i++)
        if (!array_append(&zone->corners, (size_t)i, sizeof *zone->corners, "corners", err) &&
            !textfile_double(t, "X", &zone->corners[i][0], err) && !textfile_double(t, "Y", &zone->corners[i][1], err))
            zone->corner_count = i + 1;
    if (!err->status) textfile_end(t, err);
    return err->status;
}

/* Where the edit says so. */
static enum status read_statement(struct texture_thing *thing, struct textfile *t, struct err *err)
{
    int64_t line = 0;
    if (copy_word(&thing->script, t, "the name of a script", err) ||
        textfile_int(t, "a line of the script", 1, INT_MAX, &line, err))
        return err->status;
    thing->line = (int)line;
    return textfile_end(t, err);
}

static enum status read_thing_line(struct texture_thing *thing, const struct texture_map *map, struct textfile *t,
                                   struct err *err)
{
    char *word;
    int kind = 0;
    if (copy_word(&thing->name, t, "the name of a thing", err)) return err->status;
    for (int i = 0; i < map->thing_count; i++)
        if (!strcmp(map->things[i].name, thing->name))
            return textfile_error(t, err, thing->name, "a thing that no line above has");
    if (textfile_word(t, "what happens to it", &word, err)) return err->status;
    while (kind <= TEXTURE_THING_PLACE && strcmp(word, thing_words[kind])) kind++;
    if (kind > TEXTURE_THING_PLACE) return textfile_error(t, err, word, "clear, keep, move or place");
    thing->kind = (enum texture_thing_kind)kind;
    if (kind < TEXTURE_THING_MOVE) {
        thing->from = strdup(thing->name);
        return thing->from ? read_statement(thing, t, err) : err_nomem(err, "a thing", strlen(thing->name));
    }
    if (copy_word(&thing->from, t, "the name of a thing", err)) return err->status;
    for (int k = 0; k < 3; k++)
        if (textfile_double(t, "a coordinate", &thing->by[k], err)) return err->status;
    return textfile_double(t, "a turn", &thing->turn, err) ? err->status : read_statement(thing, t, err);
}

static enum status read_thing(struct texture_map *map, struct textfile *t, struct err *err)
{
    struct texture_thing thing = {0};
    if (!read_thing_line(&thing, map, t, err)) texture_map_add_thing(map, &thing, err);
    free(thing.name);
    free(thing.from);
    free(thing.script);
    return err->status;
}

static enum status read_line(struct texture_map *map, struct textfile *t, struct err *err)
{
    static const char wanted[] = "lamp, planned, face, gloss, place, edge, outdoors, colour, new, clear, keep or thing";
    char *word;
    if (textfile_word(t, wanted, &word, err)) return err->status;
    if (map->thing_count && strcmp(word, "thing")) return textfile_error(t, err, word, "lines \"thing\" at the end");
    if (!strcmp(word, "lamp")) return read_lamp(map, t, err);
    if (!strcmp(word, "planned")) return read_planned(map, t, err);
    if (!strcmp(word, "face")) return read_face(map, t, err);
    if (!strcmp(word, "thing")) return read_thing(map, t, err);
    if (!strcmp(word, "clear") || !strcmp(word, "keep")) return read_zone(map, t, !strcmp(word, "keep"), err);
    struct texture_face *face = map->face_count && !map->zone_count ? &map->faces[map->face_count - 1] : NULL;
    const bool rule =
        !strcmp(word, "place") || !strcmp(word, "edge") || !strcmp(word, "outdoors") || !strcmp(word, "colour");
    const bool gloss = !strcmp(word, "gloss");
    if (!rule && !gloss && strcmp(word, "new")) return textfile_error(t, err, word, "%s", wanted);
    if (!face) return textfile_error(t, err, word, "a line \"face\" before it");
    if (gloss) return read_gloss(face, t, err);
    return rule ? read_rule(face, t, word, err) : read_added(face, t, err);
}

enum status texture_map_read(struct texture_map *map, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    char *base = NULL;
    int version = 0;
    *map = (struct texture_map){0};
    product_open(&t, &version, PRODUCT_TEXTURE_MAP, path, prov, err);
    if (!err->status && version != 3) textfile_wrong_number(&t, version, "version 3", err);
    if (!err->status && !textfile_expect_line(&t, "base", err) && !copy_word(&base, &t, "an edit or \"none\"", err))
        textfile_end(&t, err);
    if (!err->status && strcmp(base, NO_BASE))
        map->base = base;
    else
        free(base);
    while (!err->status && textfile_next(&t)) read_line(map, &t, err);
    if (err->status) texture_map_release(map);
    textfile_release(&t);
    return err->status;
}
