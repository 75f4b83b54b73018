/* script.c - reads model scripts.
 *
 * A table holds each verb's usage line, options and flags. script_statements.c reads the verb's fixed words and names,
 * then script_words.c the rest of the line. All names are copied to one buffer of the file's size. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "stages/build_model/script_internal.h"

enum { MAX_STATEMENTS = 200000 };

#define BIT(o) (1u << OPTION_##o)

const struct script_grammar_row script_grammar[VERB_COUNT] = {
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
    [VERB_REMOVE] = {"remove", "remove NAME | remove object NAME", 0, ""},
    [VERB_TEXTURE] = {"texture", "texture NAME stretch|crop", 0, ""},
    [VERB_COPY] = {"copy", "copy texture FACE PLACE to FACE [PLACE]", 0, ""},
    [VERB_COLOUR] = {"colour", "colour FACE R G B", 0, ""},
    [VERB_PAINT] = {"paint", "paint FACE [PLACE] R G B", 0, ""},
    [VERB_LAMP] = {"lamp", "lamp NAME off | lamp NAME scale R G B", 0, ""},
    [VERB_MATERIAL] = {"material", "material FACE matt | material FACE phong KS N | material FACE ward KS ALPHA", 0,
                       ""},
    [VERB_OBJECT] = {"object",
                     "object NAME FILE.obj at X Y Z [turn DEGREES] [scale S | scale SX SY SZ], then matt R G B | phong "
                     "R G B KS N | ward R G B KS ALPHA",
                     0, ""},
    [VERB_CLEAR] =
        {"clear", "clear ROOM | clear all | clear PLACE [foot Z] [top Z] | clear before OPENING by D [foot Z] [top Z]",
         BIT(FOOT) | BIT(TOP), ""},
    [VERB_KEEP] = {"keep", "keep PLACE [foot Z] [top Z] | keep before OPENING by D [foot Z] [top Z]",
                   BIT(FOOT) | BIT(TOP), ""},
    [VERB_BASE] = {"base", "base EDIT", 0, ""},
};

static const char *const OPTIONS[OPTION_COUNT] = {"thickness", "foot", "top",   "floor", "ceiling", "turn",
                                                  "at",        "left", "right", "front", "back",    "bottom"};
const char *const script_quantities[] = {"thickness", "slab", "glass", "leaf", "floor", "ceiling", "colour", NULL};

static const char *const FILLINGS[FILL_COUNT] = {"nothing", "leaf", "glass", "wall"};

const char *verb_name(enum verb verb) { return script_grammar[verb].verb; }

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

/* ------------------------------------------------------------------------------------------------------------ files */

static enum status read_header(struct script_reader *r)
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
static enum status take_base(struct script *script, struct script_reader *r)
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
    struct script_reader r = {.err = err};
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
        st = script_read_statement(&r, s);
        if (!st && s->verb == VERB_BASE) st = take_base(script, &r);
    }
    textfile_release(&r.t);
    if (st) script_release(script);
    return st;
}
