/* level_lattice.h - the points of a room's work plane by column and row. */
#ifndef REMODEL_LEVEL_LATTICE_H
#define REMODEL_LEVEL_LATTICE_H

#include "stages/light_levels/sensors.h"

/* {0} is the empty state. */
struct level_lattice {
    double x, y, step; /* of the lowest point */
    int width, height;
    int *point; /* row-major; -1: none. Owned */
};

/* The caller releases l in each case. ST_NOMEM. */
enum status level_lattice_make(struct level_lattice *l, const struct sensors *s, const struct sensor_area *a,
                               struct err *err);
void level_lattice_release(struct level_lattice *l);

#endif
