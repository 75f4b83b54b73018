/* planned_lamps.h - lamps that somebody thinks of, with their makers' photometry: lines of scenes/NAME/states.txt.
 *
 *   lamp NAME ies FILE.ies at X Y Z [aim DX DY DZ] [turn DEGREES] [colour R G B]
 *
 * FILE.ies is beside states.txt. X Y Z is the middle of the luminous opening in the model's frame. `aim` is where the
 * vertical angle 0 of the file points, straight down without it. `turn` turns the luminaire about that axis,
 * counter-clockwise from above (of a level axis from behind); without it the horizontal angle 0 lies along x, or as
 * near to x as the axis allows, and along z where the axis is x. */
#ifndef REMODEL_PLANNED_LAMPS_H
#define REMODEL_PLANNED_LAMPS_H

#include "common/daylight/photometry.h"
#include "common/light/colour.h"

struct textfile;

struct planned_lamp {
    char *name; /* owned */
    struct photometry web;
    struct vec3 at, down, along; /* unit directions of the vertical and the horizontal angle 0 */
    struct rgb colour;           /* of luminance 1, times factors of an edit */
    bool on;                     /* an edit's: it shines where lamps do */
    int line;
};

/* {0} is the empty state; everything is owned. */
struct planned_lamps {
    struct planned_lamp *list;
    int count;
    char *path; /* of the file with the lines; NULL without lamps */
};

/* Reads what follows `lamp` in a line. ST_DATA with file and line, of the IES file for what is wrong with that. */
enum status planned_lamps_read(struct planned_lamps *l, struct textfile *t, struct provenance *prov, struct err *err);
/* An edit's lamp, with the file in a folder. ST_DATA: a name that is taken, a damaged file. */
struct texture_planned;
enum status planned_lamps_add(struct planned_lamps *l, const struct texture_planned *of, const char *folder,
                              struct provenance *prov, struct err *err);
void planned_lamps_release(struct planned_lamps *l);
int planned_lamps_find(const struct planned_lamps *l, const char *name); /* -1: not found */

/* Whether light comes from more than one place. */
bool planned_lamp_is_wide(const struct planned_lamp *l);
/* A place of the luminous opening, u and v of 0 to 1; metre: model units of one. */
struct vec3 planned_lamp_place(const struct planned_lamp *l, const double u[2], double metre);
/* Whether a point of the opening's plane is in it; its area in square metres. Of a lamp that is wide. */
bool planned_lamp_covers(const struct planned_lamp *l, struct vec3 point, double metre);
double planned_lamp_area(const struct planned_lamp *l);
/* The corners of the opening in order, of a round one of its outline; narrower sides than `least` metres are that wide.
 * Returns their number. */
enum { PLANNED_LAMP_CORNERS = 24 };
int planned_lamp_outline(struct vec3 corners[PLANNED_LAMP_CORNERS], const struct planned_lamp *l, double least,
                         double metre);
/* Illuminance in lx of a point from all of the lamp's light, sent out at one place that nothing hides. */
double planned_lamp_illuminance(const struct planned_lamp *l, struct vec3 place, struct vec3 point, struct vec3 normal,
                                double metre);

#endif
