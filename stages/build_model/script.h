/* script.h - reads model scripts: walls, rooms, openings and boxes as a person writes them, and edits of a model.
 *
 * scenes/NAME/model.txt and scenes/NAME/edits/E.txt; docs/model-script.md describes the language. This is the syntax
 * alone, plan.h has its meaning. A PLACE is a position: two opposite corners, by coordinates (`from A B to C D`) or as
 * two pixels of a photograph as it is stored (`in VIEW X0 Y0 X1 Y1`); relative to walls, `at left|right D width W
 * from Z to Z` for an opening and `parallel to WALL by D between WALL WALL` for a wall. */
#ifndef REMODEL_BUILD_MODEL_SCRIPT_H
#define REMODEL_BUILD_MODEL_SCRIPT_H

#include <stdbool.h>

#include "common/light/gloss.h"

enum verb {
    VERB_SET,
    VERB_WALL,
    VERB_ROOM,
    VERB_SLOPE,
    VERB_GABLE,
    VERB_DOOR,
    VERB_PASSAGE,
    VERB_WINDOW,
    VERB_SKYLIGHT,
    VERB_HATCH,
    VERB_BOX,
    VERB_JOIN,
    VERB_EXTEND,
    VERB_SPLIT,
    VERB_ADJUST,
    VERB_MOVE,
    VERB_CHANGE,
    VERB_RESIZE,
    VERB_OPEN,
    VERB_CLOSE,
    VERB_FILL,
    VERB_REMOVE,
    VERB_TEXTURE,
    VERB_COPY,
    VERB_COLOUR,
    VERB_PAINT,
    VERB_LAMP,
    VERB_MATERIAL,
    VERB_OBJECT,
    VERB_CLEAR,
    VERB_KEEP,
    VERB_BASE,
    VERB_COUNT,
};

enum place_kind { PLACE_NONE, PLACE_COORDINATES, PLACE_VIEW, PLACE_FROM_END, PLACE_PARALLEL };

struct script_place {
    enum place_kind kind;
    const char *view;       /* PLACE_VIEW */
    const char *wall;       /* PLACE_PARALLEL: the wall that it is parallel to */
    const char *between[2]; /* PLACE_PARALLEL: the walls at its ends */
    bool right;             /* PLACE_FROM_END: measured from the wall's right end, else its left end */
    double a[4];            /* as written: A B C D, X0 Y0 X1 Y1, D W Z0 Z1, or D */
};

enum option { /* a word of that name, then a number */
              OPTION_THICKNESS,
              OPTION_FOOT,
              OPTION_TOP,
              OPTION_FLOOR,
              OPTION_CEILING,
              OPTION_TURN,
              OPTION_AT,
              OPTION_LEFT,
              OPTION_RIGHT,
              OPTION_FRONT,
              OPTION_BACK,
              OPTION_BOTTOM,
              OPTION_COUNT,
};

/* What closes an opening. FILL_WALL: it is walled up. */
enum filling { FILL_NOTHING, FILL_LEAF, FILL_GLASS, FILL_WALL, FILL_COUNT };

enum { END_START, END_END, END_NONE };

/* Where a synthetic object stands, in the model's frame: scaled, then turned about z, then moved. */
struct script_object {
    double at[3], turn, scale[3]; /* turn: degrees */
    struct brdf brdf;
};

struct statement {
    enum verb verb;
    int line;
    const char *name;  /* what it makes or changes; set: the quantity; join: NULL */
    const char *other; /* openings: the wall or room; extend: the wall to reach, or NULL; split: the new wall; copy: the
                           face that gets the texture; texture: "stretch" or "crop"; clear, keep: the opening; object:
                           its mesh */
    const char **names; /* join, room: walls in order; slope, gable: the two walls */
    int name_count;
    struct script_place place, target; /* target: of copy; PLACE_NONE of either: the whole face */
    int end;                           /* extend: END_START or END_END */
    enum filling filling;              /* fill */
    /* set: the value, or a colour; colour, paint: R G B; lamp: factors; extend: where; split: from, to;
     * move: by; slope: two heights; gable: also the ridge's */
    double values[3];
    int value_count;
    double options[OPTION_COUNT];
    bool has_option[OPTION_COUNT];
    bool angled, interior, closed, open; /* flags: words without a value */
    bool of_object;                      /* remove: the name is that of an object */
    struct gloss gloss;                  /* material */
    struct script_object object;         /* object */
};

struct script {
    char *path;       /* as messages name it; owned */
    const char *base; /* the edit that this one stands on; NULL: none */
    int base_line;
    char *words; /* all names; owned */
    struct statement *statements;
    int count;
};

const char *verb_name(enum verb verb);
const char *option_name(enum option option);
const char *filling_name(enum filling filling); /* "nothing", "leaf", "glass", "wall" */

/* The caller releases the script, which a failure leaves empty. ST_DATA with file and line for an invalid
 * statement: an unknown word (with a guess at what was meant), a name with characters other than letters, digits, `_`
 * and `-`, a number beyond 1e6, a rectangle without area, an option that the statement does not have or has twice. */
enum status script_read(struct script *script, const char *path, struct err *err);
void script_release(struct script *script);

#endif
