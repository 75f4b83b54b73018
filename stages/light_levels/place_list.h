/* place_list.h - scenes/NAME/places.txt: places of a room by name, at which light matters.
 *
 *   remodel-places 1
 *   place NAME at X Y|in PHOTO U V [height H] [size W D [turn DEGREES]]
 *
 * Model frame, metres: X Y is the middle, or the pixel U V of a photo shows it, at its height. H is the height above
 * the floor of the room (without it that of the work plane), W and D are the sides of a rectangle along x and y, turned
 * counter-clockwise; without `size` a place is one point. */
#ifndef REMODEL_LEVELS_PLACE_LIST_H
#define REMODEL_LEVELS_PLACE_LIST_H

#include "common/base/provenance.h"

struct light_place_mark {
    char *name;  /* owned */
    char *photo; /* that shows it (place_marks.h); owned; NULL: `at` was given */
    double pixel[2];
    double at[2], size[2], turn;
    double height; /* below 0: that of the work plane */
    int line;
};

/* {0} is the empty state; everything is owned. */
struct place_list {
    char *path;
    struct light_place_mark *items;
    int count;
};

/* ST_DATA with file and line. A failure leaves the list empty. */
enum status place_list_read(struct place_list *l, const char *path, struct provenance *prov, struct err *err);
void place_list_release(struct place_list *l);

#endif
