/* model_plan.h - reads plan.txt: the walls, openings, rooms and boxes of a solid model, as build_model placed them
 * (docs/formats.md). Model frame: z up, the floor at 0, model units.
 *
 * A wall's inner face is normal . (x, y) = offset; its body lies behind the face. S runs along the wall: it is x or y
 * where the face is parallel to an axis. */
#ifndef REMODEL_MODEL_PLAN_H
#define REMODEL_MODEL_PLAN_H

#include <stdbool.h>

#include "common/base/provenance.h"
#include "common/math/vec.h"

enum model_wall_end { MODEL_WALL_FREE, MODEL_WALL_CORNER, MODEL_WALL_MEETS };

struct model_wall {
    char *name; /* owned */
    double normal[2], offset, thickness;
    double span[2]; /* S of its ends */
    double foot, top;
    enum model_wall_end ends[2];
    char *neighbours[2]; /* the wall at each end; owned; NULL at a free end */
};

enum model_opening_kind { MODEL_DOOR, MODEL_PASSAGE, MODEL_WINDOW };

struct model_opening {
    char *name; /* owned */
    enum model_opening_kind kind;
    int wall;
    double s[2], z[2];
    bool closed; /* by a leaf or a pane */
};

struct model_room_corner {
    char *wall_name; /* of the wall that ends here; owned */
    int wall;        /* -1: it was removed, and the plan has no line of it */
    double x, y;     /* counter-clockwise */
};

struct model_room {
    char *name; /* owned */
    double floor;
    double ceiling[2][3]; /* z = ceiling[k][0] + ceiling[k][1] x + ceiling[k][2] y */
    int ceilings;         /* 1; 2 under a gable, where the lower one counts */
    struct model_room_corner *corners;
    int corner_count;
};

struct model_slot { /* an opening in a ceiling (skylight) or a floor (hatch), by its footprint */
    char *name;     /* owned */
    bool skylight;
    int room;
    double low[2], high[2];
    bool closed;
};

struct model_box {
    char *name; /* owned */
    struct vec3 low, high;
    double turn; /* degrees, about the vertical through its middle */
};

struct model_plan {
    struct model_wall *walls;
    struct model_opening *openings;
    struct model_room *rooms;
    struct model_slot *slots;
    struct model_box *boxes;
    int wall_count, opening_count, room_count, slot_count, box_count;
};

/* Versions only add statements, so statements of later versions are left out. plan is overwritten, and empty after an
 * error. ST_DATA with file and line: another file, a damaged line, a wall without a direction, an opening on a
 * wall, or a gable or slot of a room, that is on no line above. */
enum status model_plan_read(struct model_plan *plan, const char *path, struct provenance *prov, struct err *err);
void model_plan_release(struct model_plan *plan);

int model_plan_find_wall(const struct model_plan *plan, const char *name); /* -1: not found */
int model_plan_find_room(const struct model_plan *plan, const char *name); /* -1: not found */

double model_room_ceiling(const struct model_room *room, double x, double y); /* its height there */

/* The lower corner of an opening and the opposite upper one, on the wall's inner face. False: the wall is parallel to
 * no axis, so that S begins at a point that the plan does not hold. */
bool model_opening_corners(const struct model_plan *plan, int opening, struct vec3 corners[2]);

#endif
