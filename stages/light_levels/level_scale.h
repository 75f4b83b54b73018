/* level_scale.h - the colours of all pictures of light levels, their isolines and their key.
 *
 * A unit has one range, so that a colour means the same on plans and photographs, in each state,
 * before and after an edit. Colours are those of colour_of_ramp(), whose lightness grows: they can be read without
 * seeing hues. */
#ifndef REMODEL_LEVEL_SCALE_H
#define REMODEL_LEVEL_SCALE_H

#include <stdio.h>

enum { LEVEL_LINES = 13 };

struct level_scale {
    const char *unit;
    double low, high;
    double lines[LEVEL_LINES]; /* of isolines: 1, 2, 3, 5 times powers of ten, rising */
    int line_count;
};

/* unit: lx, relative or %; in % of the hours of a year if `annual`. */
struct level_scale level_scale_of(const char *unit, int annual);
/* 0 at `low` or below, 1 at `high` or above, by the logarithm. */
double level_scale_place(const struct level_scale *s, double value);
void level_scale_colour(const struct level_scale *s, double value, unsigned char rgb[3]);

/* Three digits, without an exponent from 1000 on. */
const char *level_scale_number(char text[32], double value);

/* A bar of the colours with numbers and the unit, as SVG; x, y: its upper left corner, px. Numbers are written in the
 * locale of the caller. */
void level_scale_put_key(const struct level_scale *s, FILE *to, double x, double y, double width);
/* Styles of isolines, their numbers and the key. */
#define LEVEL_STYLES                                                                                       \
    "rect{shape-rendering:crispEdges}.level{fill:none;stroke:#fff;stroke-width:1.5;stroke-linejoin:round}" \
    ".under{fill:none;stroke:#000;stroke-opacity:.55;stroke-width:3.2;stroke-linejoin:round}"              \
    ".number,.place{paint-order:stroke;stroke:#fff;stroke-width:3px;font-size:13px}"                       \
    ".place{font-weight:600}.key{font-size:13px}"

#endif
