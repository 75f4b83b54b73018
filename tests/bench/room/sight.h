/* sight.h - what can be seen in a made room: rays against its walls and furniture, and pixels of its photos. */
#ifndef REMODEL_BENCH_SIGHT_H
#define REMODEL_BENCH_SIGHT_H

#include "tests/bench/room/made_room.h"

enum { SIGHT_SOLIDS = 128, SIGHT_NOTHING = -1, SIGHT_FLOOR = 0, SIGHT_CEILING, SIGHT_WALL = 10, SIGHT_PIECE = 100 };

struct sight_solid {
    struct vec3 middle, half;
    double c, s; /* of its turn */
    int owner;   /* SIGHT_FLOOR, SIGHT_CEILING, SIGHT_WALL + wall, SIGHT_PIECE + piece */
};

struct sight {
    struct sight_solid solids[SIGHT_SOLIDS];
    int count;
};

struct sight_hit {
    int owner; /* SIGHT_NOTHING: the ray leaves through a window */
    double distance;
    struct vec3 normal;
};

void sight_build(struct sight *s, const struct made_room *r);
/* The nearest solid along a unit direction. */
struct sight_hit sight_cast(const struct sight *s, struct vec3 from, struct vec3 direction);
/* Whether nothing is between a place and 1 cm before another. */
bool sight_clear(const struct sight *s, struct vec3 from, struct vec3 to);

struct made_photo photo_looking(struct vec3 at, struct vec3 look_at);
/* The pixel of a point; false: outside the picture, or within `margin` px of its edge. */
bool photo_project(const struct made_photo *photo, struct vec3 p, double margin, double *u, double *v);
/* The direction that a pixel shows. */
struct vec3 photo_ray(const struct made_photo *photo, double u, double v);

#endif
