/* borders.h - finds the borders of a union's surface in each plane: from planes to lines to intervals. */
#ifndef REMODEL_BUILD_MODEL_BORDERS_H
#define REMODEL_BUILD_MODEL_BORDERS_H

#include "stages/build_model/solid/convex.h"

/* A maximal segment of a line along which the surface in one plane ends, or another room's surface begins. Seen from
 * outside, the surface is to the left of the direction from `from` to `to`. */
struct border {
    int plane, side; /* the outward normal is side times the plane's */
    int room;        /* of the surface; -1: of none */
    int line, from, to;
    bool forward; /* along the line's direction */
};

struct border_name { /* a facet of this name is part of the surface at the border */
    int border, name;
};

struct line_point {
    int line, point;
};

struct border_set {
    struct border *borders; /* all owned */
    struct border_name *names;
    struct line_point *points; /* on lines of borders: where polygons of the plane begin or end on the line */
    int *inner;                /* facets (polygons) that are part of the surface but touch no border */
    int border_count, border_capacity, name_count, name_capacity, point_count, point_capacity, inner_count;
    int inner_capacity;
};

/* borders is empty on entry; the caller releases it, also after a failure. Adds sections, lines and points to set.
 * rooms: of each name's rank the room that its faces belong to, or -1. Where faces of several rooms coincide, the
 * surface belongs to the lowest. */
enum status borders_find(struct border_set *borders, struct convex_set *set, const int *rooms, struct err *err);

void border_set_release(struct border_set *borders);

#endif
