/* wall_plan.h - what of a building's walls is compared: the faces that rooms show, and openings; of a model and of a truth.
 *
 * A face runs along the foot of a wall so that its room lies on the left. It is read from
 *   model/plan.txt      edges of the rooms (docs/formats.md); openings lie on the inner face of their wall
 *   TRUTH/scene.txt     both sides of each wall, whose line is its middle (docs/scenes.md); openings lie on the middle
 *   TRUTH/scene-truth.txt, in the rooms' frame:
 *     NAME X0 Y0 Z0 X1 Y1 Z1                    a room: its four walls
 *     partition x|y A B                         a wall between rooms, of which faces are known by the rooms
 *     door x|y S0 S1 top Z                      through the partition, from the floor
 *     window_SIDE x|y S0 S1 z Z0 Z1             SIDE: south or north (least or largest y), west or east (of x)
 * Other lines are left to who understands them. */
#ifndef REMODEL_WALL_PLAN_H
#define REMODEL_WALL_PLAN_H

#include "common/base/err.h"
#include "common/math/vec.h"

struct plan_part {
    char name[64];     /* cut where it is longer */
    struct vec3 at[2]; /* a face's ends; an opening's lower corner, and the upper one across from it */
};

struct part_list {
    struct plan_part *parts;
    int count, room;
};

struct wall_plan {
    struct part_list faces, openings;
};

enum wall_plan_kind { PLAN_OF_MODEL, PLAN_DESCRIBED, PLAN_FRAMED };

/* plan is empty on entry, and after an error. ST_DATA with file and line. */
enum status wall_plan_read(struct wall_plan *plan, const char *path, enum wall_plan_kind kind, struct err *err);
void wall_plan_release(struct wall_plan *plan);

struct part_errors {
    double *errors; /* sorted; owned */
    int count;
    char worst[64]; /* whose the largest is */
};

struct wall_errors {
    struct part_errors faces, openings; /* of the model */
    int strange;                        /* faces and openings of the model that the truth does not have */
    int missing;                        /* openings of the truth that the model does not have */
};

/* Both in one frame, z up, unit of the truth. A face belongs to the nearest true one that looks the same way within 10
 * degrees, lies beside it and is within `reach`; its error is the larger distance of its ends from that one's plane. An
 * opening belongs to the true one, of a wall of the same direction, whose corners are nearest and within reach; its error
 * is the largest difference of a side, sill or head. */
enum status wall_errors_find(struct wall_errors *e, const struct wall_plan *model, const struct wall_plan *truth,
                             double reach, struct err *err);
void wall_errors_release(struct wall_errors *e);

#endif
