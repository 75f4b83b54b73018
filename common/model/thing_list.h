/* thing_list.h - the things of a scene, furniture before its walls: out/SCENE/things/things.txt.
 *
 *   remodel-things 3
 *   thing NAME SUPPORT X0 Y0 Z0 X1 Y1 Z1 VOXELS VIEWS VIEW U0 V0 U1 V1 R G B
 *   sides R G B R G B R G B R G B R G B R G B
 *   flat NX NY NZ OFFSET COUNT U V U V ...
 *
 * One line "thing" for each; its number in the other files is that of its line, from 1, other lines not counted.
 * SUPPORT: floor, wall, ceiling, or none. X0 to Z1: the box around it, model frame. VOXELS: of its surfaces. VIEWS: how
 * many show enough of it to count.
 * VIEW shows it best, in the rectangle U0 V0 U1 V1 (px); "" and a rectangle of no size: none shows it.
 * R G B: the mean radiance of its pixels in all views.
 * sides: of the thing of the line above, the same of what faces east, west, north, south, up, down (+x, -x, +y, -y, +z,
 * -z of the model): a table's top is brighter than its sides under a lamp.
 * flat: the thing of the line above lies flat on a face, on the plane N . P = OFFSET, N of length 1 and into the room.
 * U V: the corners of its outline, in order: two of their coordinates, without the one that N is largest in. */
#ifndef REMODEL_THING_LIST_H
#define REMODEL_THING_LIST_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/provenance.h"
#include "common/math/vec.h"
#include "common/model/flat_outline.h"

enum thing_support { THING_ON_FLOOR, THING_ON_WALL, THING_ON_CEILING, THING_ON_NONE, THING_SUPPORTS };

enum { THING_SIDES = 6 };

struct thing {
    char *name; /* owned */
    enum thing_support support;
    struct vec3 low, high; /* model frame */
    int64_t voxels;
    int views;      /* that show enough of it to count */
    char *view;     /* owned */
    double rect[4]; /* px of the view: left, top, right, bottom */
    double radiance[3];
    double sides[THING_SIDES][3];
    struct flat_outline outline; /* of what lies flat; else empty; owned */
};

/* {0} is the empty state. */
struct thing_list {
    struct thing *things; /* owned */
    int count;
};

/* The radiance of what faces a direction: of the three sides that it faces, by the squares of its coordinates, whose
 * sum is 1 [McTaggart 2004]. normal: of length 1; 0: the mean. */
struct vec3 thing_radiance_of_side(const struct thing *t, struct vec3 normal);
const char *thing_support_word(enum thing_support support);
int thing_list_find(const struct thing_list *list, const char *name); /* -1: not found */
/* Takes ownership of what t owns, on failure too. */
enum status thing_list_add(struct thing_list *list, struct thing *t, struct err *err);
void thing_list_release(struct thing_list *list);
enum status thing_list_write(const struct thing_list *list, const char *path, const struct provenance *prov,
                             struct err *err);
/* ST_DATA with file and line: a name that occurs twice, a box of no size, numbers out of range. A failure leaves the
 * list empty. An outline of fewer than three corners, or of no thing, too. */
enum status thing_list_read(struct thing_list *list, const char *path, struct provenance *prov, struct err *err);

#endif
