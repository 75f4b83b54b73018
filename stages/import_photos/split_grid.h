/* split_grid.h - the layout of the pictures of a multi-lens camera in its photograph.
 *
 * COLUMNS x ROWS pictures of equal size; columns count from the left, rows from the top of the photograph as stored.
 * Without dark lines the photo inside its border is divided evenly, with a gap between pictures; remainder pixels are
 * spread among the gaps. With dark lines each picture lies between two of them; all have the size of the smallest and
 * are centred between their lines.
 *
 * A dark line is a run of columns (rows) in which at most one sample in 50 is brighter than `dark`. The line between
 * two pictures is the widest one within an eighth of a picture of the position that an even division gives. */
#ifndef REMODEL_SPLIT_GRID_H
#define REMODEL_SPLIT_GRID_H

#include "common/capture/split_name.h"
#include "common/image/photo.h"
#include "stages/import_photos/import_params.h"

enum { MIN_SPLIT_SIDE = 16 }; /* pixels per side of a picture */

struct split_grid {
    int columns, rows;
    int border, gap, dark; /* [import_photos] split_* */
};

struct split_layout {
    int width, height;              /* of each picture */
    int x[MAX_SPLIT], y[MAX_SPLIT]; /* their first columns and rows */
    int over_width, over_height;    /* remainder pixels of an even division */
};

/* Parses "3x2". ST_USAGE. */
enum status split_grid_parse(struct split_grid *g, const char *text, const struct photo_params *params,
                             struct err *err);

/* name: of the photo, for errors. ST_DATA: a side of the pictures would be below MIN_SPLIT_SIDE; an expected dark line
 * is missing; the pictures between the lines differ in size by more than a sixteenth. */
enum status split_layout_find(struct split_layout *l, const struct split_grid *g, const struct photo *p,
                              const char *name, struct err *err);

#endif
