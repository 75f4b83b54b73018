/* script_statements.c - the fixed words and names of each statement. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/scan.h"
#include "common/light/object_list.h"
#include "stages/build_model/script_internal.h"

/* An albedo. */
static enum status read_rgb(struct script_reader *r, struct statement *s)
{
    static const char *const what[] = {"a share of red light", "a share of green light", "a share of blue light"};
    for (int i = 0; i < 3; i++) {
        if (script_read_number(r, what[i], &s->values[i])) return r->err->status;
        if (!(s->values[i] >= 0 && s->values[i] <= 1))
            return textfile_wrong_number(&r->t, s->values[i], "a share of light, from 0 to 1", r->err);
    }
    s->value_count = 3;
    return ST_OK;
}

static enum status read_set(struct script_reader *r, struct statement *s)
{
    char *word;
    int i = 0;
    if (textfile_word(&r->t, "a quantity", &word, r->err)) return r->err->status;
    while (script_quantities[i] && strcmp(script_quantities[i], word)) i++;
    if (!script_quantities[i]) return script_usage_error(r, word, s->verb);
    s->name = script_quantities[i];
    if (!strcmp(s->name, "colour")) return read_rgb(r, s);
    s->value_count = 1;
    return script_read_number(r, s->name, &s->values[0]);
}

static enum status read_slope(struct script_reader *r, struct statement *s)
{
    s->names = calloc(2, sizeof *s->names);
    if (!s->names) return err_nomem(r->err, "names of walls", 2 * sizeof *s->names);
    s->name_count = s->value_count = 2;
    if (script_read_name(r, "a room", &s->name) || script_expect(r, "from", s->verb) ||
        script_read_name(r, "a wall", &s->names[0]) || script_read_number(r, "the height there", &s->values[0]) ||
        script_expect(r, "to", s->verb) || script_read_name(r, "a wall", &s->names[1]) ||
        script_read_number(r, "the height there", &s->values[1]))
        return r->err->status;
    if (s->verb == VERB_SLOPE) return ST_OK;
    s->value_count = 3;
    return script_expect(r, "ridge", s->verb) || script_read_number(r, "the ridge's height", &s->values[2])
               ? r->err->status
               : ST_OK;
}

static enum status read_extend(struct script_reader *r, struct statement *s)
{
    char *word;
    if (script_read_name(r, "a wall", &s->name)) return r->err->status;
    if (!textfile_more(&r->t)) return script_usage_error(r, NULL, s->verb);
    if (textfile_word(&r->t, "\"start\" or \"end\"", &word, r->err)) return r->err->status;
    s->end = !strcmp(word, "start") ? END_START : !strcmp(word, "end") ? END_END : END_NONE;
    if (s->end == END_NONE)
        return textfile_error(&r->t, r->err, word, "\"start\" or \"end\", in a line \"%s\"",
                              script_grammar[s->verb].usage);
    if (script_expect(r, "to", s->verb) || textfile_word(&r->t, "a wall or a coordinate", &word, r->err))
        return r->err->status;
    if (scan_double(word, &s->values[0])) {
        s->value_count = 1;
        if (fabs(s->values[0]) <= MAX_NUMBER) return ST_OK;
        return textfile_error(&r->t, r->err, word, "a coordinate within 1e6");
    }
    if (!script_is_name(word)) return textfile_error(&r->t, r->err, word, "the name of a wall, or a coordinate");
    s->other = script_keep_word(r, word);
    return ST_OK;
}

static enum status read_split(struct script_reader *r, struct statement *s)
{
    s->value_count = 2;
    if (script_read_name(r, "a wall", &s->name) || script_expect(r, "from", s->verb) ||
        script_read_number(r, "where the gap begins", &s->values[0]) || script_expect(r, "to", s->verb) ||
        script_read_number(r, "where the gap ends", &s->values[1]) || script_expect(r, "into", s->verb) ||
        script_read_name(r, "a new name", &s->other))
        return r->err->status;
    return ST_OK;
}

static enum status read_move(struct script_reader *r, struct statement *s)
{
    if (script_read_name(r, "a name", &s->name) || script_expect(r, "by", s->verb) ||
        script_read_number(r, "a distance", &s->values[s->value_count++]))
        return r->err->status;
    while (s->value_count < 3 && textfile_more(&r->t))
        if (script_read_number(r, "a distance", &s->values[s->value_count++])) return r->err->status;
    return ST_OK;
}

static enum status read_fill(struct script_reader *r, struct statement *s)
{
    char *word;
    int f = 0;
    if (script_read_name(r, "a name", &s->name) || script_expect(r, "with", s->verb) ||
        textfile_word(&r->t, "leaf, glass, wall or nothing", &word, r->err))
        return r->err->status;
    while (f < FILL_COUNT && strcmp(filling_name((enum filling)f), word)) f++;
    if (f == FILL_COUNT) return script_usage_error(r, word, s->verb);
    s->filling = (enum filling)f;
    return ST_OK;
}

/* A face's name, such as wall/south/in, or the first part of several: box/chest. */
static enum status read_face(struct script_reader *r, const char **name)
{
    static const char wanted[] = "a face, such as wall/south/in (docs/model-script.md lists their names)";
    char *word;
    if (textfile_word(&r->t, wanted, &word, r->err)) return r->err->status;
    for (const char *c = word; *c; c++)
        if ((unsigned char)*c <= ' ' || *c == '#' || *c == '"') return textfile_error(&r->t, r->err, word, wanted);
    if (strlen(word) > 2 * MAX_NAME || !strchr(word, '/')) return textfile_error(&r->t, r->err, word, wanted);
    *name = script_keep_word(r, word);
    return ST_OK;
}

static enum status read_texture(struct script_reader *r, struct statement *s)
{
    char *word;
    if (script_read_name(r, "a wall, an opening, a box or a room", &s->name)) return r->err->status;
    if (textfile_word(&r->t, "\"stretch\" or \"crop\"", &word, r->err)) return r->err->status;
    if (strcmp(word, "stretch") && strcmp(word, "crop"))
        return textfile_error(&r->t, r->err, word, "\"stretch\" or \"crop\"");
    s->other = script_keep_word(r, word);
    return ST_OK;
}

static enum status read_copy(struct script_reader *r, struct statement *s)
{
    if (script_expect(r, "texture", s->verb) || read_face(r, &s->name) || script_read_place(r, &s->place, s->verb) ||
        script_expect(r, "to", s->verb) || read_face(r, &s->other))
        return r->err->status;
    return textfile_more(&r->t) ? script_read_place(r, &s->target, s->verb) : ST_OK;
}

static const char *next_word(const struct script_reader *r) { return r->t.cursor + strspn(r->t.cursor, " \t"); }

static bool next_is(const struct script_reader *r, const char *word)
{
    const char *next = next_word(r);
    const size_t length = strlen(word);
    return !strncmp(next, word, length) && (!next[length] || strchr(" \t\r", next[length]));
}

static enum status read_paint(struct script_reader *r, struct statement *s)
{
    if (read_face(r, &s->name)) return r->err->status;
    if ((next_is(r, "from") || next_is(r, "in") || next_is(r, "at")) && script_read_place(r, &s->place, s->verb))
        return r->err->status;
    return read_rgb(r, s);
}

/* Lamps have the names of lights.txt: any word. */
static enum status read_lamp(struct script_reader *r, struct statement *s)
{
    enum { MAX_LAMP_NAME = 255 };
    char *word;
    if (textfile_word(&r->t, "the name of a lamp", &word, r->err)) return r->err->status;
    if (!word[0] || strlen(word) > MAX_LAMP_NAME || strchr(word, '\r'))
        return textfile_error(&r->t, r->err, word, "the name of a lamp of lights.txt");
    s->name = script_keep_word(r, word);
    s->value_count = 3;
    if (!textfile_more(&r->t)) return script_usage_error(r, NULL, s->verb);
    if (textfile_word(&r->t, "off or scale", &word, r->err)) return r->err->status;
    if (!strcmp(word, "off")) return ST_OK;
    if (strcmp(word, "scale")) return script_usage_error(r, word, s->verb);
    for (int c = 0; c < 3; c++) {
        if (script_read_number(r, "a factor of 0 or more", &s->values[c])) return r->err->status;
        if (s->values[c] < 0) return textfile_wrong_number(&r->t, s->values[c], "a factor of 0 or more", r->err);
    }
    return ST_OK;
}

static enum status read_material(struct script_reader *r, struct statement *s)
{
    return read_face(r, &s->name) || gloss_read(&s->gloss, &r->t, r->err) || gloss_check(&s->gloss, 0, &r->t, r->err)
               ? r->err->status
               : ST_OK;
}

/* One factor, or one for each axis. */
static enum status read_scale(struct script_reader *r, double scale[3])
{
    for (int k = 0; k < 3; k++) {
        const char *next = next_word(r);
        if (k == 1 && (!*next || !strchr("+-.0123456789", *next))) {
            scale[1] = scale[2] = scale[0];
            return ST_OK;
        }
        if (script_read_number(r, "a scale", &scale[k])) return r->err->status;
        if (!(scale[k] >= 1e-6)) return textfile_wrong_number(&r->t, scale[k], "a scale from 1e-6 to 1e6", r->err);
    }
    return ST_OK;
}

static enum status read_mesh_file(struct script_reader *r, const char **file)
{
    char *word;
    if (textfile_word(&r->t, "a mesh, FILE.obj", &word, r->err)) return r->err->status;
    if (!object_file_is_valid(word))
        return textfile_error(&r->t, r->err, word,
                              "a mesh in the scene's folder, FILE.obj or FOLDER/FILE.obj, of letters, digits, _, - and "
                              ".");
    *file = script_keep_word(r, word);
    return ST_OK;
}

static enum status read_object(struct script_reader *r, struct statement *s)
{
    struct script_object *o = &s->object;
    bool turned = false, scaled = false;
    for (int k = 0; k < 3; k++) o->scale[k] = 1;
    if (script_read_name(r, "a name", &s->name) || read_mesh_file(r, &s->other) || script_expect(r, "at", s->verb) ||
        script_read_number(r, "X", &o->at[0]) || script_read_number(r, "Y", &o->at[1]) ||
        script_read_number(r, "Z", &o->at[2]))
        return r->err->status;
    while (next_is(r, "turn") || next_is(r, "scale")) {
        const bool turn = next_is(r, "turn");
        bool *had = turn ? &turned : &scaled;
        if (script_expect(r, turn ? "turn" : "scale", s->verb)) return r->err->status;
        if (*had) return textfile_error(&r->t, r->err, turn ? "turn" : "scale", "each option once");
        *had = true;
        if (turn ? script_read_number(r, "an angle in degrees", &o->turn) : read_scale(r, o->scale))
            return r->err->status;
    }
    if (!textfile_more(&r->t)) return script_usage_error(r, NULL, s->verb);
    if (next_is(r, "matt") || next_is(r, "phong") || next_is(r, "ward")) return brdf_read(&o->brdf, &r->t, r->err);
    char *word;
    return textfile_word(&r->t, "a material", &word, r->err) ? r->err->status : script_usage_error(r, word, s->verb);
}

static enum status read_remove(struct script_reader *r, struct statement *s)
{
    if (script_read_name(r, "a name", &s->name)) return r->err->status;
    if (strcmp(s->name, "object") || !textfile_more(&r->t)) return ST_OK;
    s->of_object = true;
    return script_read_name(r, "the name of an object", &s->name);
}

/* A place, the space before an opening, or for `clear` a room or all of them. */
static enum status read_zone(struct script_reader *r, struct statement *s)
{
    const char *next = next_word(r);
    if (!strncmp(next, "before ", 7)) {
        s->value_count = 1;
        return script_expect(r, "before", s->verb) || script_read_name(r, "a door, passage or window", &s->other) ||
                       script_expect(r, "by", s->verb) ||
                       script_read_number(r, "a distance from the wall", &s->values[0])
                   ? r->err->status
                   : ST_OK;
    }
    if (s->verb == VERB_KEEP || !strncmp(next, "in ", 3) || !strncmp(next, "from ", 5))
        return script_read_place(r, &s->place, s->verb);
    return script_read_name(r, "a room, \"all\", \"in VIEW\", \"from\" or \"before\"", &s->name);
}

/* A statement that has nothing but options must have one. */
static enum status read_changes(struct script_reader *r, struct statement *s)
{
    if (script_read_name(r, "a name", &s->name)) return r->err->status;
    return textfile_more(&r->t) ? ST_OK : script_usage_error(r, NULL, s->verb);
}

static const char *known_verb(const void *ctx, int i)
{
    (void)ctx;
    return i < VERB_COUNT ? script_grammar[i].verb : NULL;
}

enum status script_read_statement(struct script_reader *r, struct statement *s)
{
    char *word;
    int v = 0;
    if (textfile_word(&r->t, "a statement", &word, r->err)) return r->err->status;
    while (v < VERB_COUNT && strcmp(script_grammar[v].verb, word)) v++;
    if (v == VERB_COUNT) {
        const char *near = scan_nearest(word, known_verb, NULL);
        if (near) return textfile_error(&r->t, r->err, word, "a statement; did you mean %s?", near);
        return textfile_error(
            &r->t, r->err, word,
            "a statement: set, wall, room, slope, gable, door, passage, window, skylight, hatch, "
            "box, join, extend, split, adjust, move, change, resize, open, close, fill, remove, texture, "
            "copy, colour, paint, lamp, material, object, clear, keep or base");
    }
    s->verb = (enum verb)v;
    s->line = r->t.line;
    s->end = END_NONE;
    switch (s->verb) {
    case VERB_SET:
        if (read_set(r, s)) return r->err->status;
        break;
    case VERB_WALL:
    case VERB_BOX:
    case VERB_ADJUST:
        if (script_read_name(r, "a name", &s->name) || script_read_place(r, &s->place, s->verb)) return r->err->status;
        break;
    case VERB_DOOR:
    case VERB_PASSAGE:
    case VERB_WINDOW:
    case VERB_SKYLIGHT:
    case VERB_HATCH:
        if (script_read_name(r, "a name", &s->name) || script_expect(r, "on", s->verb) ||
            script_read_name(r, s->verb == VERB_SKYLIGHT || s->verb == VERB_HATCH ? "a room" : "a wall", &s->other) ||
            script_read_place(r, &s->place, s->verb))
            return r->err->status;
        break;
    case VERB_ROOM:
        if (script_read_name(r, "a name", &s->name) || script_read_list(r, s, 3, script_grammar[v].options))
            return r->err->status;
        break;
    case VERB_JOIN:
        if (script_read_list(r, s, 2, 0)) return r->err->status;
        break;
    case VERB_SLOPE:
    case VERB_GABLE:
        if (read_slope(r, s)) return r->err->status;
        break;
    case VERB_EXTEND:
        if (read_extend(r, s)) return r->err->status;
        break;
    case VERB_SPLIT:
        if (read_split(r, s)) return r->err->status;
        break;
    case VERB_MOVE:
        if (read_move(r, s)) return r->err->status;
        break;
    case VERB_CHANGE:
    case VERB_RESIZE:
        if (read_changes(r, s)) return r->err->status;
        break;
    case VERB_FILL:
        if (read_fill(r, s)) return r->err->status;
        break;
    case VERB_TEXTURE:
        if (read_texture(r, s)) return r->err->status;
        break;
    case VERB_COPY:
        if (read_copy(r, s)) return r->err->status;
        break;
    case VERB_COLOUR:
        if (read_face(r, &s->name) || read_rgb(r, s)) return r->err->status;
        break;
    case VERB_PAINT:
        if (read_paint(r, s)) return r->err->status;
        break;
    case VERB_LAMP:
        if (read_lamp(r, s)) return r->err->status;
        break;
    case VERB_MATERIAL:
        if (read_material(r, s)) return r->err->status;
        break;
    case VERB_OBJECT:
        if (read_object(r, s)) return r->err->status;
        break;
    case VERB_REMOVE:
        if (read_remove(r, s)) return r->err->status;
        break;
    case VERB_CLEAR:
    case VERB_KEEP:
        if (read_zone(r, s)) return r->err->status;
        break;
    default:
        if (script_read_name(r, "a name", &s->name)) return r->err->status;
    }
    return script_read_options(r, s);
}
