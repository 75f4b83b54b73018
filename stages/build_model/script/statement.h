/* statement.h - a statement of a model script, as it is written; plan.h has its meaning.
 *
 * A PLACE is a position: two opposite corners, by coordinates (`from A B to C D`) or as two pixels of a photograph as
 * it is stored (`in VIEW X0 Y0 X1 Y1`); relative to walls, `at left|right D width W from Z to Z` for an opening and
 * `parallel to WALL by D between WALL WALL` for a wall; for a wall also two pixels on the line where it meets the floor
 * or the ceiling (`foot in VIEW X0 Y0 X1 Y1`, `top in VIEW ...`). */
#ifndef REMODEL_BUILD_MODEL_STATEMENT_H
#define REMODEL_BUILD_MODEL_STATEMENT_H

#include <stdbool.h>

#include "common/light/gloss.h"

enum place_kind {
    PLACE_NONE,
    PLACE_COORDINATES,
    PLACE_VIEW,
    PLACE_FROM_END,
    PLACE_PARALLEL,
    PLACE_FOOT,
    PLACE_TOP,
};

struct script_place {
    enum place_kind kind;
    const char *view;       /* PLACE_VIEW, PLACE_FOOT, PLACE_TOP */
    const char *along;      /* the same, of a wall: its direction, "x", "y" or a wall; NULL: not given */
    const char *wall;       /* PLACE_PARALLEL: the wall that it is parallel to */
    const char *between[2]; /* PLACE_PARALLEL: the walls at its ends */
    bool right;             /* PLACE_FROM_END: measured from the wall's right end, else its left end */
    double a[4];            /* as written: A B C D, X0 Y0 X1 Y1, D W Z0 Z1, or D */
};

/* A corner of a room's floor in a photograph. */
struct script_corner {
    const char *view;
    double x, y; /* px */
};

/* A word of that name, then a number; from OPTION_ANGLED on a word alone. */
enum option {
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
    OPTION_ANGLED,
    OPTION_INTERIOR,
    OPTION_CLOSED,
    OPTION_OPEN,
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

/* A lamp with its maker's photometry: the middle of its opening, where the file's vertical angle 0 points, a turn about
 * that direction in degrees, and the colour of its light. */
struct script_lamp {
    double at[3], aim[3], turn, colour[3];
};

struct verb; /* verbs.h */

struct statement {
    const struct verb *verb;
    int line;
    const char *name;  /* what it makes or changes; set: the quantity; join: NULL */
    const char *other; /* openings: the wall or room; extend: the wall to reach, or NULL; split: the new wall; copy: the
                           face that gets the texture; texture: "stretch" or "crop"; clear, keep: the opening */
    const char *mesh;  /* object, planned lamp: its file in the scene's folder; else NULL */
    bool by_points;    /* wall, adjust: the place is found by points, since it is a rectangle in a view */
    const char **names; /* join, room, walls: walls in order; slope, gable: the two walls */
    int name_count;
    struct script_corner *corners; /* walls */
    int corner_count;
    struct script_place place, target; /* target: of copy; PLACE_NONE of either: the whole face */
    int end;                           /* extend: END_START or END_END */
    enum filling filling;              /* fill */
    /* set: the value, or a colour; colour, paint: R G B; lamp: factors; extend: where; split: from, to; move: by;
     * slope: two heights; gable: also the ridge's */
    double values[3];
    int value_count;
    double options[OPTION_COUNT];
    bool has_option[OPTION_COUNT];
    bool of_object;              /* remove: the name is that of an object */
    struct gloss gloss;          /* material */
    struct script_object object; /* object */
    struct script_lamp lamp;     /* a planned lamp */
};

#endif
