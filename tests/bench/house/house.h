/* house.h - a furnished house that is drawn from a seed: rooms around corridors, doors and windows of all kinds, bays,
 * sloping ceilings, furniture, lamps, and photos.
 *
 * Metres; x east, y north, z up; the floor is z = 0. Each room is one of tests/bench/room, with a prefix before its
 * names. One storey: stairs are left out. */
#ifndef REMODEL_BENCH_HOUSE_H
#define REMODEL_BENCH_HOUSE_H

#include "tests/bench/room/made_room.h"

enum { HOUSE_ROOMS = 30, HOUSE_WALLS = 160, HOUSE_DOORS = 80, HOUSE_WINDOWS = 80, HOUSE_BAYS = 8, HOUSE_SLOPES = 16 };

/* A wall between rooms, or around them: the line x = at or y = at, from `from` to `to`. */
struct house_wall {
    bool upright; /* x = at */
    double at, from, to, thickness;
    bool outer;
};

enum door_kind { DOOR_WIDE, DOOR_OPEN, DOOR_AJAR, DOOR_CLOSED, DOOR_KINDS };

struct house_door {
    enum door_kind kind;
    int wall, rooms[2]; /* the second is -1 for the door of the house */
    double from, to, high;
};

struct house_window {
    int wall, room;
    double from, to, z0, z1;
};

/* Three walls with windows before an opening of an outer wall. */
struct house_bay {
    int wall, room;
    double from, to, depth;
    int out; /* the direction outwards along the wall's normal: 1 or -1 */
};

/* A ceiling that slopes down to an outer wall. */
struct house_slope {
    int room;
    enum made_side { SIDE_SOUTH, SIDE_EAST, SIDE_NORTH, SIDE_WEST } side;
    double knee, deep; /* height at the wall; how far from it the ceiling is level again */
};

struct house {
    int seed, room_count, wall_count, door_count, window_count, bay_count, slope_count;
    double wide, deep, ceiling;
    struct rect cells[HOUSE_ROOMS]; /* between the centre lines of walls */
    bool corridor[HOUSE_ROOMS];
    struct house_wall walls[HOUSE_WALLS];
    struct house_door doors[HOUSE_DOORS];
    struct house_window windows[HOUSE_WINDOWS];
    struct house_bay bays[HOUSE_BAYS];
    struct house_slope slopes[HOUSE_SLOPES];
    struct made_room *rooms; /* with furniture, pictures, lamps and photos; owned by the caller */
};

/* Rooms, walls and openings; false: the attempt leads to a room that is too narrow. */
bool house_plan(struct house *h, int rooms, int attempt);
/* Furniture, pictures, lamps and at most `views` photos; how many photos there are. */
int house_furnish(struct house *h, int views);

struct house_camera {
    int width, height, exposures;
};
void house_write_scene(const struct house *h, FILE *to);
void house_write_cameras(const struct house *h, const struct house_camera *camera, FILE *to);
/* What a suggestion of the plan is scored against: lines "room", "wall", "door", "window" in metres. */
void house_write_plan(const struct house *h, FILE *to);

#endif
