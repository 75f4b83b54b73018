/* wall_plan.h - the walls of a model and of a truth, to be compared: faces of walls that are visible in a room,
 * openings.
 *
 * A face runs along the foot of a wall with its room on the left. Sources:
 *   model/plan.txt      edges of the rooms (docs/formats.md); openings are on the inner face of their wall
 *   TRUTH/scene.txt     both sides of each wall, whose line is its middle (docs/scenes.md); openings are on the middle;
 *                       an edit: `base FILE` first, then `drop NAME ...` and what it adds; items between
 *                       `furniture on` and `furniture off` are furniture
 *   TRUTH/scene-truth.txt, in the frame of the rooms:
 *     NAME X0 Y0 Z0 X1 Y1 Z1                    a room: its four walls
 *     partition x|y A B                         a wall between rooms; its faces are those of the rooms
 *     door x|y S0 S1 top Z                      through the partition, from the floor
 *     window_SIDE x|y S0 S1 z Z0 Z1             SIDE: south or north (min or max y), west or east (min or max x)
 * Other lines are ignored. */
#ifndef REMODEL_WALL_PLAN_H
#define REMODEL_WALL_PLAN_H

#include "common/base/err.h"
#include "common/math/vec.h"

struct measured_part {
    char name[64];     /* cut at 63 bytes */
    char wall[64];     /* of an opening of a described scene; "" for others */
    struct vec3 at[2]; /* the ends of a face; the lower corner of an opening, and the opposite upper one */
};

struct measured_parts {
    struct measured_part *parts;
    int count;
};

struct measured_plan {
    struct measured_parts faces, openings;
    /* of a truth: the lower corner of a room and the opposite upper one; of a model: its middle on floor and ceiling */
    struct measured_parts rooms;
    struct measured_parts furniture; /* of a described scene: its names */
};

enum measured_plan_kind { PLAN_FROM_MODEL, PLAN_FROM_SCENE, PLAN_FROM_SCENE_TRUTH };

/* plan is overwritten, and empty after an error. ST_DATA with file and line. */
enum status wall_plan_read(struct measured_plan *plan, const char *path, enum measured_plan_kind kind, struct err *err);
void wall_plan_release(struct measured_plan *plan);
/* Whether a true face belongs to one of the parts: "NAME.left" to a part called NAME. */
bool wall_plan_has(const struct measured_parts *list, const char *face);

struct part_errors {
    double *errors; /* sorted; owned */
    int count;
    char worst[64]; /* name of the part with the largest error */
};

struct wall_errors {
    struct part_errors faces, openings; /* of the model */
    int extra;                          /* faces and openings of the model that the truth lacks */
    int missing;                        /* openings of the truth that the model lacks */
};

/* Both plans are in one frame, z up, in the unit of the truth. A face belongs to the nearest true face that runs the
 * same way within 10 degrees, overlaps it and is within max_distance; its error is the larger distance of its ends
 * from that face's plane. An opening belongs to the true opening in a wall of the same direction whose corners are
 * nearest and within max_distance; its error is the largest difference of a side, sill or head. ST_NOMEM. */
enum status wall_errors_find(struct wall_errors *e, const struct measured_plan *model,
                             const struct measured_plan *truth, double max_distance, struct err *err);
void wall_errors_release(struct wall_errors *e);

#endif
