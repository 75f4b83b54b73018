/* plan_sheet.h - the plan of a model as SVG, seen from above, for pictures that draw more on it.
 *
 *   struct plan_sheet s = {0};
 *   plan_sheet_fit(&s, plan);
 *   plan_sheet_hold(&s, x, y);                       what else must be on the sheet
 *   plan_sheet_begin(&s, to, "The tour", styles);
 *   plan_sheet_put_plan(&s, plan);
 *   ...
 *   plan_sheet_end(&s);
 *
 * Coordinates are of the model's frame: x to the right, y up. */
#ifndef REMODEL_PLAN_SHEET_H
#define REMODEL_PLAN_SHEET_H

#include <locale.h>
#include <stdio.h>

#include "common/model/model_plan.h"

struct plan_sheet {
    FILE *to;
    double low[2], high[2], scale; /* x px = scale (x - low[0]), y px = scale (high[1] - y) */
    locale_t before;               /* of the caller: numbers are written in the C locale */
};

/* Makes the sheet large enough for all rooms; without rooms, for all walls. */
void plan_sheet_fit(struct plan_sheet *s, const struct model_plan *plan);
void plan_sheet_hold(struct plan_sheet *s, double x, double y);

/* label: of the picture, without special characters; styles: rules of CSS for what the caller draws. */
void plan_sheet_begin(struct plan_sheet *s, FILE *to, const char *label, const char *styles);
void plan_sheet_end(struct plan_sheet *s);

double plan_sheet_x(const struct plan_sheet *s, double x); /* px */
double plan_sheet_y(const struct plan_sheet *s, double y);
void plan_sheet_put_polygon(const struct plan_sheet *s, double (*p)[2], int count, const char *class);
/* Escapes the text. x, y: the middle of its base line. */
void plan_sheet_put_text(const struct plan_sheet *s, double x, double y, const char *class, const char *text);

/* A circle with a cross at x, y px, the sign of a lamp on electrical plans. In the C locale. */
void plan_sheet_lamp_sign(FILE *to, double x, double y);
/* The same in the model's frame, with a name below it, whose class is `place`. */
void plan_sheet_put_lamp(const struct plan_sheet *s, double x, double y, const char *name);

/* Rooms with their names, walls, openings and boxes. Walls that are parallel to no axis are shown by their rooms. */
void plan_sheet_put_plan(const struct plan_sheet *s, const struct model_plan *plan);

#endif
