/* sheet.h - the sheet of light levels: mean, least and most of each area in each state. */
#ifndef REMODEL_LEVELS_SHEET_H
#define REMODEL_LEVELS_SHEET_H

#include "stages/light_levels/level_sums.h"
#include "stages/light_levels/sensors.h"

/* A row of sheet.tsv. */
struct sheet_row {
    char *state, *kind, *place, *unit; /* owned */
    int points;
    double mean, low, high; /* low, high: the 95 % interval of the mean */
    bool has_interval;
    double least, most;
};

/* Values of an area's points, and what they stand for; weights NULL: all the same. */
struct sheet_values {
    const double *values, *weights;
    int count;
    double low, high;   /* the ends of the interval, as factors of the mean; high 0: there is none */
    const double *ends; /* or the ends themselves; NULL: by the factors */
};

/* {0} is the empty state; everything is owned. */
struct light_sheet {
    struct sheet_row *rows;
    int count;
    char note[300]; /* a comment above the rows; "": none */
};

/* Copies the texts. ST_NOMEM. */
enum status sheet_add(struct light_sheet *s, const char *state, const char *kind, const char *place, const char *unit,
                      const struct sheet_values *of, struct err *err);
void sheet_release(struct light_sheet *s);

/* Reads a sheet.tsv that was written before. ST_DATA with file and line. */
enum status sheet_read(struct light_sheet *s, const char *path, struct provenance *prov, struct err *err);
/* before: of the unedited room, NULL: there are no columns for it. */
enum status sheet_write(const struct light_sheet *s, const struct light_sheet *before, const char *path,
                        const struct provenance *prov, struct err *err);

#endif
