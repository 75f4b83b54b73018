/* script.h - reads model scripts: walls, rooms, openings and boxes as a person writes them, and edits of a model.
 *
 * scenes/NAME/model.txt and scenes/NAME/edits/E.txt; docs/model-script.md describes the language. This is the syntax
 * alone, plan.h has its meaning. A PLACE is a position: two opposite corners, by coordinates (`from A B to C D`) or as
 * two pixels of a photograph as it is stored (`in VIEW X0 Y0 X1 Y1`). */
#ifndef REMODEL_BUILD_MODEL_SCRIPT_H
#define REMODEL_BUILD_MODEL_SCRIPT_H

#include <stdbool.h>

#include "common/base/err.h"

enum verb {
    VERB_SET,
    VERB_WALL,
    VERB_ROOM,
    VERB_SLOPE,
    VERB_DOOR,
    VERB_PASSAGE,
    VERB_WINDOW,
    VERB_BOX,
    VERB_JOIN,
    VERB_EXTEND,
    VERB_SPLIT,
    VERB_ADJUST,
    VERB_MOVE,
    VERB_OPEN,
    VERB_CLOSE,
    VERB_REMOVE,
    VERB_COUNT,
};

enum place_kind { PLACE_NONE, PLACE_COORDINATES, PLACE_VIEW };

struct script_place {
    enum place_kind kind;
    const char *view; /* PLACE_VIEW */
    double a[4];      /* as written: A B C D, or X0 Y0 X1 Y1 */
};

enum option { /* a word of that name, then a number */
              OPTION_THICKNESS,
              OPTION_FOOT,
              OPTION_TOP,
              OPTION_FLOOR,
              OPTION_CEILING,
              OPTION_TURN,
              OPTION_AT,
              OPTION_COUNT,
};

enum { END_START, END_END, END_NONE };

struct statement {
    enum verb verb;
    int line;
    const char *name;   /* what it makes or changes; set: the quantity; join: NULL */
    const char *other;  /* door, passage, window: the wall; extend: the wall to reach, or NULL; split: the new wall */
    const char **names; /* join, room: walls in order; slope: the two walls */
    int name_count;
    struct script_place place;
    int end;          /* extend: END_START or END_END */
    double values[2]; /* set: the value; extend: where; split: from, to; slope: two heights; move: by */
    int value_count;
    double options[OPTION_COUNT];
    bool has_option[OPTION_COUNT];
    bool angled, interior, closed, open; /* flags: words without a value */
};

struct script {
    char *path;  /* as messages name it; owned */
    char *words; /* all names; owned */
    struct statement *statements;
    int count;
};

const char *verb_name(enum verb verb);

/* The caller releases the script, which a failure leaves empty. ST_DATA with file and line for an invalid
 * statement: an unknown word (with a guess at what was meant), a name with characters other than letters, digits, `_`
 * and `-`, a number beyond 1e6, a rectangle without area, an option that the statement does not have or has twice. */
enum status script_read(struct script *script, const char *path, struct err *err);
void script_release(struct script *script);

#endif
