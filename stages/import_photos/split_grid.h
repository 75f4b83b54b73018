/* split_grid.h - where the pictures of a multi-lens camera lie in its photograph.
 *
 * COLUMNS x ROWS pictures of equal size, counted as the photograph is stored: columns from the left, rows from the top.
 * Without dark lines the photo inside its border is divided evenly, and each picture ends a gap before the next begins;
 * pixels that are over are spread among the gaps. With dark lines every picture lies between two of them, all as large as the
 * smallest, each in the middle of its place.
 *
 * A dark line is a run of columns (rows) in which at most one sample in 50 is brighter than `dark`; between two pictures
 * it is the widest of those within an eighth of a picture of where an even division puts it. */
#ifndef REMODEL_SPLIT_GRID_H
#define REMODEL_SPLIT_GRID_H

#include "common/image/photo.h"
#include "stages/import_photos/import_params.h"

enum { SPLIT_MOST = 99, SPLIT_SIDE_LEAST = 16 }; /* pictures along a side; pixels along a picture's side */

struct split_grid {
    int columns, rows;
    int border, gap, dark; /* [import_photos] split_* */
};

struct split_layout {
    int width, height;                /* of each picture */
    int x[SPLIT_MOST], y[SPLIT_MOST]; /* their first columns and rows */
    int over_width,
        over_height; /* pixels in no picture, border and gaps or dark lines, and what is beside, not counted */
};

/* "3x2". ST_USAGE. */
enum status split_grid_parse(struct split_grid *g, const char *text, const struct import_params *params,
                             struct err *err);

/* name: of the photo, for errors. ST_DATA: pictures would have less than SPLIT_SIDE_LEAST pixels on a side; there is no
 * dark line where one must be; between the lines pictures differ by more than a sixteenth in size. */
enum status split_layout_find(struct split_layout *l, const struct split_grid *g, const struct photo *p,
                              const char *name, struct err *err);

#endif
