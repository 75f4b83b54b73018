/* script.c - reads model scripts.
 *
 * A table holds each verb's usage line, options and flags; read_statement() reads the verb's fixed words and names,
 * then read_options() the rest of the line. All names are copied to one buffer of the file's size. */
#include "stages/build_model/script.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"

enum { MAX_STATEMENTS = 200000, MAX_NAME = 64 };
#define MAX_NUMBER 1e6

struct grammar {
    const char *verb, *usage;
    unsigned options;  /* the verb's options: bits of enum option */
    const char *flags; /* the verb's flags, each between blanks */
};

#define BIT(o) (1u << OPTION_##o)

static const struct grammar GRAMMAR[VERB_COUNT] = {
    [VERB_SET] = {"set", "set thickness|slab|glass|leaf|floor|ceiling NUMBER | set colour R G B", 0, ""},
    [VERB_WALL] =
        {"wall",
         "wall NAME in VIEW X0 Y0 X1 Y1 | wall NAME from X Y to X Y | wall NAME parallel to WALL by D between "
         "WALL WALL, then options",
         BIT(THICKNESS) | BIT(FOOT) | BIT(TOP), " angled "},
    [VERB_ROOM] = {"room", "room NAME WALL WALL WALL ... [floor Z] [ceiling Z]", BIT(FLOOR) | BIT(CEILING), ""},
    [VERB_SLOPE] = {"slope", "slope ROOM from WALL Z to WALL Z", 0, ""},
    [VERB_GABLE] = {"gable", "gable ROOM from WALL Z to WALL Z ridge Z [at D]", BIT(AT), ""},
    [VERB_DOOR] = {"door", "door NAME on WALL PLACE [closed]", 0, " closed "},
    [VERB_PASSAGE] = {"passage", "passage NAME on WALL PLACE", 0, ""},
    [VERB_WINDOW] = {"window", "window NAME on WALL PLACE [interior] [open]", 0, " interior open "},
    [VERB_SKYLIGHT] = {"skylight", "skylight NAME on ROOM PLACE [open]", 0, " open "},
    [VERB_HATCH] = {"hatch", "hatch NAME on ROOM PLACE [closed]", 0, " closed "},
    [VERB_BOX] = {"box", "box NAME from X Y to X Y | box NAME in VIEW X0 Y0 X1 Y1, then options",
                  BIT(FOOT) | BIT(TOP) | BIT(TURN) | BIT(AT), ""},
    [VERB_JOIN] = {"join", "join WALL WALL ...", 0, ""},
    [VERB_EXTEND] = {"extend", "extend WALL start|end to WALL | extend WALL start|end to NUMBER", 0, ""},
    [VERB_SPLIT] = {"split", "split WALL from S to S into NEW", 0, ""},
    [VERB_ADJUST] = {"adjust", "adjust NAME PLACE", 0, ""},
    [VERB_MOVE] = {"move", "move WALL by D | move OPENING by D [UP] | move BOX by DX DY [UP]", 0, ""},
    [VERB_CHANGE] = {"change",
                     "change WALL [thickness T] [foot Z] [top Z] | change BOX [foot Z] [top Z] [turn DEGREES] | change "
                     "ROOM ceiling Z",
                     BIT(THICKNESS) | BIT(FOOT) | BIT(TOP) | BIT(TURN) | BIT(CEILING), ""},
    [VERB_RESIZE] = {"resize",
                     "resize OPENING [left D] [right D] [bottom D] [top D] | resize SKYLIGHT [left D] [right D] [front "
                     "D] [back D]",
                     BIT(LEFT) | BIT(RIGHT) | BIT(FRONT) | BIT(BACK) | BIT(BOTTOM) | BIT(TOP), ""},
    [VERB_OPEN] = {"open", "open NAME", 0, ""},
    [VERB_CLOSE] = {"close", "close NAME", 0, ""},
    [VERB_FILL] = {"fill", "fill NAME with leaf|glass|wall|nothing", 0, ""},
    [VERB_REMOVE] = {"remove", "remove NAME", 0, ""},
    [VERB_TEXTURE] = {"texture", "texture NAME stretch|crop", 0, ""},
    [VERB_COPY] = {"copy", "copy texture FACE PLACE to FACE [PLACE]", 0, ""},
    [VERB_COLOUR] = {"colour", "colour FACE R G B", 0, ""},
    [VERB_CLEAR] = {"clear", "clear ROOM | clear all | clear PLACE [foot Z] [top Z]", BIT(FOOT) | BIT(TOP), ""},
    [VERB_KEEP] = {"keep", "keep PLACE [foot Z] [top Z]", BIT(FOOT) | BIT(TOP), ""},
    [VERB_BASE] = {"base", "base EDIT", 0, ""},
};

static const char *const OPTIONS[OPTION_COUNT] = {"thickness", "foot", "top",   "floor", "ceiling", "turn",
                                                  "at",        "left", "right", "front", "back",    "bottom"};
static const char *const QUANTITIES[] = {"thickness", "slab", "glass", "leaf", "floor", "ceiling", "colour", NULL};

static const char *const FILLINGS[FILL_COUNT] = {"nothing", "leaf", "glass", "wall"};

const char *verb_name(enum verb verb) { return GRAMMAR[verb].verb; }

const char *option_name(enum option option) { return OPTIONS[option]; }

const char *filling_name(enum filling filling) { return FILLINGS[filling]; }

void script_release(struct script *script)
{
    if (!script) return;
    for (int i = 0; i < script->count; i++) free(script->statements[i].names);
    free(script->statements);
    free(script->words);
    free(script->path);
    *script = (struct script){0};
}

/* ------------------------------------------------------------------------------------------------------------ words */

struct reader {
    struct textfile t;
    char *words; /* buffer for all words of the file */
    size_t used;
    struct err *err;
};

static enum status usage_error(struct reader *r, const char *found, enum verb verb)
{
    return textfile_error(&r->t, r->err, found, "%s, in a line \"%s\"", found ? "something else" : "more words",
                          GRAMMAR[verb].usage);
}

static const char *keep_word(struct reader *r, const char *word)
{
    const size_t size = strlen(word) + 1;
    char *kept = r->words + r->used;
    memcpy(kept, word, size);
    r->used += size;
    return kept;
}

static bool is_name(const char *word)
{
    const size_t length = strlen(word);
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
    double number;
    return length && length <= MAX_NAME && word[0] != '-' && strspn(word, letters) == length &&
           !scan_double(word, &number);
}

static enum status read_name(struct reader *r, const char *what, const char **name)
{
    char *word;
    if (textfile_word(&r->t, what, &word, r->err)) return r->err->status;
    if (!is_name(word))
        return textfile_error(&r->t, r->err, word, "%s: a name of at most %d letters, digits, _ and -, not a number",
                              what, MAX_NAME);
    *name = keep_word(r, word);
    return ST_OK;
}

static enum status read_number(struct reader *r, const char *what, double *value)
{
    if (textfile_double(&r->t, what, value, r->err)) return r->err->status;
    if (fabs(*value) <= MAX_NUMBER) return ST_OK;
    char text[32];
    snprintf(text, sizeof text, "%.9g", *value);
    return textfile_error(&r->t, r->err, text, "%s within 1e6", what);
}

/* Reads the word that must come next. */
static enum status expect(struct reader *r, const char *wanted, enum verb verb)
{
    char *word;
    if (!textfile_more(&r->t)) return usage_error(r, NULL, verb);
    if (textfile_word(&r->t, wanted, &word, r->err)) return r->err->status;
    if (!strcmp(word, wanted)) return ST_OK;
    return textfile_error(&r->t, r->err, word, "\"%s\", in a line \"%s\"", wanted, GRAMMAR[verb].usage);
}

/* ------------------------------------------------------------------------------------------------------------ parts */

static enum status read_rectangle(struct reader *r, struct script_place *p)
{
    static const char *const what[] = {"x0", "y0", "x1", "y1"};
    char *view;
    if (textfile_word(&r->t, "a photo or view", &view, r->err)) return r->err->status;
    p->kind = PLACE_VIEW;
    p->view = keep_word(r, view);
    for (int i = 0; i < 4; i++)
        if (read_number(r, what[i], &p->a[i])) return r->err->status;
    if (p->a[2] > p->a[0] && p->a[3] > p->a[1]) return ST_OK;
    return err_set(r->err, ST_DATA,
                   "%s:%d: found the rectangle %.9g %.9g %.9g %.9g, wanted X0 Y0 its upper left corner and X1 Y1 its "
                   "lower right one, in pixels of the photo as it is stored.",
                   r->t.path, r->t.line, p->a[0], p->a[1], p->a[2], p->a[3]);
}

static enum status read_from_end(struct reader *r, struct script_place *p, enum verb verb)
{
    char *side;
    p->kind = PLACE_FROM_END;
    if (textfile_word(&r->t, "\"left\" or \"right\"", &side, r->err)) return r->err->status;
    p->right = !strcmp(side, "right");
    if (!p->right && strcmp(side, "left"))
        return textfile_error(&r->t, r->err, side, "\"left\" or \"right\": the end of the wall to measure from");
    if (read_number(r, "the distance from that end", &p->a[0]) || expect(r, "width", verb) ||
        read_number(r, "the width", &p->a[1]) || expect(r, "from", verb) ||
        read_number(r, "the height of the sill", &p->a[2]) || expect(r, "to", verb) ||
        read_number(r, "the height of the head", &p->a[3]))
        return r->err->status;
    return ST_OK;
}

static enum status read_parallel(struct reader *r, struct script_place *p, enum verb verb)
{
    p->kind = PLACE_PARALLEL;
    if (expect(r, "to", verb) || read_name(r, "a wall", &p->wall) || expect(r, "by", verb) ||
        read_number(r, "the distance from that wall", &p->a[0]) || expect(r, "between", verb) ||
        read_name(r, "the wall at one end", &p->between[0]) ||
        read_name(r, "the wall at the other end", &p->between[1]))
        return r->err->status;
    return ST_OK;
}

static enum status read_place(struct reader *r, struct script_place *p, enum verb verb)
{
    char *word;
    if (!textfile_more(&r->t)) return usage_error(r, NULL, verb);
    if (textfile_word(&r->t, "\"in\" or \"from\"", &word, r->err)) return r->err->status;
    if (!strcmp(word, "in")) return read_rectangle(r, p);
    if (!strcmp(word, "at") && verb != VERB_WALL && verb != VERB_BOX && verb != VERB_CLEAR && verb != VERB_KEEP)
        return read_from_end(r, p, verb);
    if (!strcmp(word, "parallel") && verb == VERB_WALL) return read_parallel(r, p, verb);
    if (strcmp(word, "from"))
        return textfile_error(&r->t, r->err, word, "\"in VIEW\" or \"from\", in a line \"%s\"", GRAMMAR[verb].usage);
    p->kind = PLACE_COORDINATES;
    if (read_number(r, "a coordinate", &p->a[0]) || read_number(r, "a coordinate", &p->a[1]) || expect(r, "to", verb) ||
        read_number(r, "a coordinate", &p->a[2]) || read_number(r, "a coordinate", &p->a[3]))
        return r->err->status;
    return ST_OK;
}

/* Reads names until an option or the end of the line. */
static enum status read_list(struct reader *r, struct statement *s, int min_count, unsigned options)
{
    while (textfile_more(&r->t)) {
        char *before = r->t.cursor;
        for (int o = 0; o < OPTION_COUNT; o++) {
            const size_t length = strlen(OPTIONS[o]);
            const char *at = before + strspn(before, " \t");
            if (options & (1u << o) && !strncmp(at, OPTIONS[o], length) && (at[length] == ' ' || at[length] == '\t'))
                goto done;
        }
        if (array_append(&s->names, (size_t)s->name_count, sizeof *s->names, "names of walls", r->err) ||
            read_name(r, "a wall", &s->names[s->name_count]))
            return r->err->status;
        s->name_count++;
    }
done:
    return s->name_count < min_count ? usage_error(r, NULL, s->verb) : ST_OK;
}

static const char *known_flag_or_option(const void *ctx, int i)
{
    static const char *const flags[] = {"angled", "interior", "closed", "open", NULL};
    const struct grammar *g = ctx;
    int n = 0;
    for (int o = 0; o < OPTION_COUNT; o++)
        if (g->options & (1u << o) && n++ == i) return OPTIONS[o];
    for (int f = 0; flags[f]; f++)
        if (strstr(g->flags, flags[f]) && n++ == i) return flags[f];
    return NULL;
}

static enum status read_options(struct reader *r, struct statement *s)
{
    const struct grammar *g = &GRAMMAR[s->verb];
    while (textfile_more(&r->t)) {
        char *word, padded[32];
        if (textfile_word(&r->t, "an option", &word, r->err)) return r->err->status;
        int o = 0;
        while (o < OPTION_COUNT && !(g->options & (1u << o) && !strcmp(word, OPTIONS[o]))) o++;
        if (o < OPTION_COUNT) {
            if (s->has_option[o]) return textfile_error(&r->t, r->err, word, "each option once");
            if (read_number(r, OPTIONS[o], &s->options[o])) return r->err->status;
            s->has_option[o] = true;
            continue;
        }
        bool *flag = NULL;
        snprintf(padded, sizeof padded, " %.20s ", word);
        if (word[0] && strstr(g->flags, padded))
            flag = !strcmp(word, "angled")     ? &s->angled
                   : !strcmp(word, "interior") ? &s->interior
                   : !strcmp(word, "closed")   ? &s->closed
                                               : &s->open;
        if (!flag) {
            const char *near = scan_nearest(word, known_flag_or_option, g);
            if (near)
                return textfile_error(&r->t, r->err, word,
                                      "the end of the line or an option; did you mean %s? The line is \"%s\"", near,
                                      g->usage);
            return textfile_error(&r->t, r->err, word, "the end of the line or an option, in a line \"%s\"", g->usage);
        }
        if (*flag) return textfile_error(&r->t, r->err, word, "each option once");
        *flag = true;
    }
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------- statements */

/* An albedo. */
static enum status read_rgb(struct reader *r, struct statement *s)
{
    static const char *const what[] = {"a share of red light", "a share of green light", "a share of blue light"};
    for (int i = 0; i < 3; i++) {
        if (read_number(r, what[i], &s->values[i])) return r->err->status;
        if (!(s->values[i] >= 0 && s->values[i] <= 1))
            return textfile_wrong_number(&r->t, s->values[i], "a share of light, from 0 to 1", r->err);
    }
    s->value_count = 3;
    return ST_OK;
}

static enum status read_set(struct reader *r, struct statement *s)
{
    char *word;
    int i = 0;
    if (textfile_word(&r->t, "a quantity", &word, r->err)) return r->err->status;
    while (QUANTITIES[i] && strcmp(QUANTITIES[i], word)) i++;
    if (!QUANTITIES[i]) return usage_error(r, word, s->verb);
    s->name = QUANTITIES[i];
    if (!strcmp(s->name, "colour")) return read_rgb(r, s);
    s->value_count = 1;
    return read_number(r, s->name, &s->values[0]);
}

static enum status read_slope(struct reader *r, struct statement *s)
{
    s->names = calloc(2, sizeof *s->names);
    if (!s->names) return err_nomem(r->err, "names of walls", 2 * sizeof *s->names);
    s->name_count = s->value_count = 2;
    if (read_name(r, "a room", &s->name) || expect(r, "from", s->verb) || read_name(r, "a wall", &s->names[0]) ||
        read_number(r, "the height there", &s->values[0]) || expect(r, "to", s->verb) ||
        read_name(r, "a wall", &s->names[1]) || read_number(r, "the height there", &s->values[1]))
        return r->err->status;
    if (s->verb == VERB_SLOPE) return ST_OK;
    s->value_count = 3;
    return expect(r, "ridge", s->verb) || read_number(r, "the ridge's height", &s->values[2]) ? r->err->status : ST_OK;
}

static enum status read_extend(struct reader *r, struct statement *s)
{
    char *word;
    if (read_name(r, "a wall", &s->name)) return r->err->status;
    if (!textfile_more(&r->t)) return usage_error(r, NULL, s->verb);
    if (textfile_word(&r->t, "\"start\" or \"end\"", &word, r->err)) return r->err->status;
    s->end = !strcmp(word, "start") ? END_START : !strcmp(word, "end") ? END_END : END_NONE;
    if (s->end == END_NONE)
        return textfile_error(&r->t, r->err, word, "\"start\" or \"end\", in a line \"%s\"", GRAMMAR[s->verb].usage);
    if (expect(r, "to", s->verb) || textfile_word(&r->t, "a wall or a coordinate", &word, r->err))
        return r->err->status;
    if (scan_double(word, &s->values[0])) {
        s->value_count = 1;
        if (fabs(s->values[0]) <= MAX_NUMBER) return ST_OK;
        return textfile_error(&r->t, r->err, word, "a coordinate within 1e6");
    }
    if (!is_name(word)) return textfile_error(&r->t, r->err, word, "the name of a wall, or a coordinate");
    s->other = keep_word(r, word);
    return ST_OK;
}

static enum status read_split(struct reader *r, struct statement *s)
{
    s->value_count = 2;
    if (read_name(r, "a wall", &s->name) || expect(r, "from", s->verb) ||
        read_number(r, "where the gap begins", &s->values[0]) || expect(r, "to", s->verb) ||
        read_number(r, "where the gap ends", &s->values[1]) || expect(r, "into", s->verb) ||
        read_name(r, "a new name", &s->other))
        return r->err->status;
    return ST_OK;
}

static enum status read_move(struct reader *r, struct statement *s)
{
    if (read_name(r, "a name", &s->name) || expect(r, "by", s->verb) ||
        read_number(r, "a distance", &s->values[s->value_count++]))
        return r->err->status;
    while (s->value_count < 3 && textfile_more(&r->t))
        if (read_number(r, "a distance", &s->values[s->value_count++])) return r->err->status;
    return ST_OK;
}

static enum status read_fill(struct reader *r, struct statement *s)
{
    char *word;
    int f = 0;
    if (read_name(r, "a name", &s->name) || expect(r, "with", s->verb) ||
        textfile_word(&r->t, "leaf, glass, wall or nothing", &word, r->err))
        return r->err->status;
    while (f < FILL_COUNT && strcmp(FILLINGS[f], word)) f++;
    if (f == FILL_COUNT) return usage_error(r, word, s->verb);
    s->filling = (enum filling)f;
    return ST_OK;
}

/* A face's name, such as wall/south/in, or the first part of several: box/chest. */
static enum status read_face(struct reader *r, const char **name)
{
    static const char wanted[] = "a face, such as wall/south/in (docs/model-script.md lists their names)";
    char *word;
    if (textfile_word(&r->t, wanted, &word, r->err)) return r->err->status;
    for (const char *c = word; *c; c++)
        if ((unsigned char)*c <= ' ' || *c == '#' || *c == '"') return textfile_error(&r->t, r->err, word, wanted);
    if (strlen(word) > 2 * MAX_NAME || !strchr(word, '/')) return textfile_error(&r->t, r->err, word, wanted);
    *name = keep_word(r, word);
    return ST_OK;
}

static enum status read_texture(struct reader *r, struct statement *s)
{
    char *word;
    if (read_name(r, "a wall, an opening, a box or a room", &s->name)) return r->err->status;
    if (textfile_word(&r->t, "\"stretch\" or \"crop\"", &word, r->err)) return r->err->status;
    if (strcmp(word, "stretch") && strcmp(word, "crop"))
        return textfile_error(&r->t, r->err, word, "\"stretch\" or \"crop\"");
    s->other = keep_word(r, word);
    return ST_OK;
}

static enum status read_copy(struct reader *r, struct statement *s)
{
    if (expect(r, "texture", s->verb) || read_face(r, &s->name) || read_place(r, &s->place, s->verb) ||
        expect(r, "to", s->verb) || read_face(r, &s->other))
        return r->err->status;
    return textfile_more(&r->t) ? read_place(r, &s->target, s->verb) : ST_OK;
}

/* A place, or for `clear` a room or all of them. */
static enum status read_zone(struct reader *r, struct statement *s)
{
    const char *next = r->t.cursor + strspn(r->t.cursor, " \t");
    if (s->verb == VERB_KEEP || !strncmp(next, "in ", 3) || !strncmp(next, "from ", 5))
        return read_place(r, &s->place, s->verb);
    return read_name(r, "a room, \"all\", \"in VIEW\" or \"from\"", &s->name);
}

/* A statement that has nothing but options must have one. */
static enum status read_changes(struct reader *r, struct statement *s)
{
    if (read_name(r, "a name", &s->name)) return r->err->status;
    return textfile_more(&r->t) ? ST_OK : usage_error(r, NULL, s->verb);
}

static const char *known_verb(const void *ctx, int i)
{
    (void)ctx;
    return i < VERB_COUNT ? GRAMMAR[i].verb : NULL;
}

static enum status read_statement(struct reader *r, struct statement *s)
{
    char *word;
    int v = 0;
    if (textfile_word(&r->t, "a statement", &word, r->err)) return r->err->status;
    while (v < VERB_COUNT && strcmp(GRAMMAR[v].verb, word)) v++;
    if (v == VERB_COUNT) {
        const char *near = scan_nearest(word, known_verb, NULL);
        if (near) return textfile_error(&r->t, r->err, word, "a statement; did you mean %s?", near);
        return textfile_error(
            &r->t, r->err, word,
            "a statement: set, wall, room, slope, gable, door, passage, window, skylight, hatch, "
            "box, join, extend, split, adjust, move, change, resize, open, close, fill, remove, texture, "
            "copy, colour, clear, keep or base");
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
        if (read_name(r, "a name", &s->name) || read_place(r, &s->place, s->verb)) return r->err->status;
        break;
    case VERB_DOOR:
    case VERB_PASSAGE:
    case VERB_WINDOW:
    case VERB_SKYLIGHT:
    case VERB_HATCH:
        if (read_name(r, "a name", &s->name) || expect(r, "on", s->verb) ||
            read_name(r, s->verb == VERB_SKYLIGHT || s->verb == VERB_HATCH ? "a room" : "a wall", &s->other) ||
            read_place(r, &s->place, s->verb))
            return r->err->status;
        break;
    case VERB_ROOM:
        if (read_name(r, "a name", &s->name) || read_list(r, s, 3, GRAMMAR[v].options)) return r->err->status;
        break;
    case VERB_JOIN:
        if (read_list(r, s, 2, 0)) return r->err->status;
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
    case VERB_CLEAR:
    case VERB_KEEP:
        if (read_zone(r, s)) return r->err->status;
        break;
    default:
        if (read_name(r, "a name", &s->name)) return r->err->status;
    }
    return read_options(r, s);
}

static enum status read_header(struct reader *r)
{
    char *word;
    int64_t version;
    if (!textfile_next(&r->t)) return textfile_error(&r->t, r->err, NULL, "the first line \"remodel-script 1\"");
    if (textfile_word(&r->t, "\"remodel-script\"", &word, r->err)) return r->err->status;
    if (strcmp(word, "remodel-script"))
        return textfile_error(&r->t, r->err, word, "the first line \"remodel-script 1\"");
    if (textfile_int(&r->t, "version 1", 1, 1, &version, r->err)) return r->err->status;
    return textfile_end(&r->t, r->err);
}

/* `base` is no statement of the plan, but must be the first. */
static enum status take_base(struct script *script, struct reader *r)
{
    const struct statement *s = &script->statements[script->count - 1];
    if (script->count > 1 || script->base)
        return textfile_error(&r->t, r->err, "base", "\"base EDIT\" as the first statement, once");
    if (!strcmp(s->name, "none"))
        return textfile_error(&r->t, r->err, "none", "the name of another edit: \"none\" is the word for no edit");
    script->base = s->name;
    script->base_line = s->line;
    script->count = 0;
    return ST_OK;
}

enum status script_read(struct script *script, const char *path, struct err *err)
{
    struct reader r = {.err = err};
    *script = (struct script){0};
    enum status st = textfile_open(&r.t, path, err);
    if (!st) {
        script->path = strdup(path);
        /* a word and its terminating zero need no more than the word and the blank after it */
        r.words = script->words = malloc(r.t.size + 2);
        if (!script->path || !script->words) st = err_nomem(err, "a script", r.t.size);
    }
    if (!st) st = read_header(&r);
    while (!st && textfile_next(&r.t)) {
        if (script->count == MAX_STATEMENTS) {
            st = err_set(err, ST_DATA, "%s:%d: found more than %d statements.", path, r.t.line, MAX_STATEMENTS);
            break;
        }
        st = array_append(&script->statements, (size_t)script->count, sizeof *script->statements, "statements", err);
        if (st) break;
        struct statement *s = &script->statements[script->count++];
        *s = (struct statement){0};
        st = read_statement(&r, s);
        if (!st && s->verb == VERB_BASE) st = take_base(script, &r);
    }
    textfile_release(&r.t);
    if (st) script_release(script);
    return st;
}
