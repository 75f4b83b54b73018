/* level_lines.h - isolines of values on a grid, as SVG paths with numbers. */
#ifndef REMODEL_LEVEL_LINES_H
#define REMODEL_LEVEL_LINES_H

#include <stdio.h>

#include "common/base/err.h"

struct level_grid {
    int width, height;
    double step;   /* distance of neighbours, px; the first is at (0, 0) */
    float *values; /* row-major; above 0 */
    int *surface;  /* squares whose corners differ in it, or have -1, have no lines */
};

/* Calls fn with the places of each line of a level, px. A line has its points in order; rings end where they began.
 * ST_NOMEM. */
typedef void level_line_fn(void *ctx, const double (*at)[2], int count);
enum status level_lines_find(const struct level_grid *g, double level, level_line_fn *fn, void *ctx, struct err *err);

/* A line at a level: cuts of squares, joined to paths as long as possible. Long paths bear the level's number.
 * ST_NOMEM. */
enum status level_lines_put(FILE *to, const struct level_grid *g, double level, struct err *err);

#endif
