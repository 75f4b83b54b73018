/* made_room.h - a furnished room that is drawn from a seed: its shape, openings, furniture, pictures and photos.
 *
 * Metres; x east, y north, z up; the floor is z = 0. Lengths are whole centimetres. */
#ifndef REMODEL_BENCH_MADE_ROOM_H
#define REMODEL_BENCH_MADE_ROOM_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "common/base/rng.h"
#include "common/math/vec.h"

enum {
    MADE_NAME = 24,
    MADE_AREAS = 2,
    MADE_WALLS = 6,
    MADE_OPENINGS = 24, /* a corridor has many */
    MADE_LAMPS = 2,
    MADE_PIECES = 9,
    MADE_PICTURES = 12,
    MADE_RUGS = 2,
    MADE_PHOTOS = 96, /* of a room of a house; rooms alone have 20 to 26 */
    MADE_MARKS = 3,   /* most marks of a thing or of a point */
    MADE_LIT = 6,     /* most squares that a lamp lights */
};

/* --------------------------------------------------------------------------------------------------------- numbers */

/* Random numbers of one purpose, in the order in which they are drawn. */
struct dice {
    struct rng rng;
    uint64_t attempt, drawn;
};

static inline struct dice dice_make(int seed, const char *purpose, int attempt)
{
    return (struct dice){rng_make((uint64_t)seed, "made_room", purpose), (uint64_t)attempt, 0};
}
static inline double dice_between(struct dice *d, double low, double high)
{
    return low + (high - low) * rng_uniform(&d->rng, d->attempt, d->drawn++);
}
/* Whole centimetres. */
static inline double dice_length(struct dice *d, double low, double high)
{
    return round(100 * dice_between(d, low, high)) / 100;
}
static inline int dice_choose(struct dice *d, int count) { return (int)dice_between(d, 0, count); }
static inline bool dice_chance(struct dice *d, double chance) { return dice_between(d, 0, 1) < chance; }

/* ------------------------------------------------------------------------------------------------------------ shape */

enum made_shape { SHAPE_RECTANGLE, SHAPE_L, SHAPE_TWO_ROOMS, SHAPE_COUNT };

struct rect {
    double x0, y0, x1, y1;
};

static inline bool rect_holds(struct rect r, double x, double y, double margin)
{
    return x >= r.x0 + margin && x <= r.x1 - margin && y >= r.y0 + margin && y <= r.y1 - margin;
}

/* Looks of surfaces, each a texture and a material of the same name. */
enum made_look {
    LOOK_FLOOR,
    LOOK_FLOOR2,
    LOOK_CEILING,
    LOOK_WALL,
    LOOK_WALL2,
    LOOK_ACCENT,
    LOOK_WOOD,
    LOOK_WOOD2,
    LOOK_CLOTH,
    LOOK_CLOTH2,
    LOOK_LINEN,
    LOOK_DARK,
    LOOK_CLAY,
    LOOK_BOOKS,
    LOOK_PATTERN,
    LOOK_COUNT,
};

const char *made_look_name(enum made_look look);

/* A wall by its centre line; the room from which it is seen is on the left of its direction. */
struct made_wall {
    const char *name;
    double x0, y0, x1, y1, thickness;
    enum made_look look;
};

/* A window, or the doorway between two rooms: from s0 to s1 along the wall's centre line. */
struct made_opening {
    char name[MADE_NAME];
    int wall;
    bool window;
    double s0, s1, z0, z1;
};

struct made_lamp {
    double x, y, side; /* its corner nearest to the origin */
    double radiance[3];
};

/* -------------------------------------------------------------------------------------------------------- furniture */

/* A piece of furniture: the middle of its footprint, its turn about it (counter-clockwise from above; at 0 its back
 * faces north), and its size: along its back, from front to back, its height. */
struct made_piece {
    char name[MADE_NAME];
    int kind;
    double x, y, turn;
    double wide, deep, high;
    enum made_look wood, cloth;
};

/* A picture on a wall: s, z of its lower left corner for a viewer in the room. */
struct made_picture {
    int wall;
    double s, z, wide, high;
    int seed;
};

/* ----------------------------------------------------------------------------------------------------------- photos */

struct made_photo {
    struct vec3 at, look_at;
    struct mat3 cam_from_world;
};

/* Pixels of a photo. */
struct made_mark {
    int photo;
    double x0, y0, x1, y1;
};
/* Two pixels of the line where a wall meets the floor or the ceiling. */
struct made_line {
    bool is, top;
    struct made_mark mark;
};
struct made_marks {
    struct made_mark list[MADE_MARKS];
    int count;
};
/* Squares in photos, each on one wall that a lamp lights. */
struct made_lit {
    struct made_mark list[MADE_LIT];
    int walls[MADE_LIT];
    int count;
};

/* ------------------------------------------------------------------------------------------------------------- room */

struct made_room {
    int seed;
    char prefix[8]; /* of all names, where it is a room of a house; otherwise "" */
    bool blank;     /* walls without a texture that features match on */
    double scale;   /* size of the photos, of the size in cameras.txt */
    enum made_shape shape;
    double wide, deep; /* of the rectangle around the outer walls' centre lines */
    double divide;     /* two rooms: y of the wall between them */
    double ceiling;
    struct rect areas[MADE_AREAS]; /* between the inner faces of walls; those of an L overlap */
    int area_count;
    struct made_wall walls[MADE_WALLS];
    int wall_count;
    struct made_opening openings[MADE_OPENINGS]; /* the doorway first, if there are two rooms */
    int opening_count;
    struct made_lamp lamps[MADE_LAMPS];
    int lamp_count;
    double sun_azimuth, sun_elevation; /* degrees */

    struct made_piece pieces[MADE_PIECES];
    int piece_count;
    int cleared, moved;      /* pieces: one that an edit clears, one that it moves */
    struct made_piece after; /* the moved piece at its new place */
    double turned;           /* by the edit, degrees */
    struct made_picture pictures[MADE_PICTURES];
    int picture_count;
    struct rect rugs[MADE_RUGS];
    int rug_count;
    int widened;                /* opening: the window that an edit makes larger */
    struct made_opening larger; /* that window after it */

    struct made_photo photos[MADE_PHOTOS];
    int photo_count;

    struct made_mark wall_marks[MADE_WALLS], opening_marks[MADE_OPENINGS];
    struct made_line wall_lines[MADE_WALLS];    /* of small photos, instead of these marks where `is` */
    struct made_mark lamp_marks[MADE_LAMPS][2]; /* x0 y0 x1 y1: two corners each, in order; photo -1: none */
    struct made_marks cleared_marks, moved_marks, picture_marks[MADE_PICTURES];
    struct made_lit lit[MADE_LAMPS];
};

/* Each draws its part from the seed, after those above it. False: this attempt does not lead to a room. */
bool made_outline(struct made_room *r, int attempt);
bool made_furniture(struct made_room *r, int attempt);
bool made_pictures(struct made_room *r, int attempt);
bool made_photos(struct made_room *r, int attempt);
/* Photos of a rectangle: at most `wanted`, `apart` m from each other unless they look elsewhere; how many were found.
 * They are neither in order nor need they overlap. */
int made_photos_of_area(struct made_room *r, int wanted, double apart);
/* The window that the edit `window` makes larger: the first, through which the sun shines. */
void made_larger_window(struct made_room *r);
/* Whether a place on a wall, s along it and z above the floor, is on a picture or less than `margin` from one. */
bool made_on_picture(const struct made_room *r, int wall, double s, double z, double margin);
bool made_marks(struct made_room *r);
/* Fewer and smaller photos of a finished room, with new marks in them. */
void made_small(struct made_room *r);

/* ------------------------------------------------------------------------------------------------------------ walls */

double made_wall_length(const struct made_wall *w);
/* The place at s along a wall, `before` its centre line, towards the room; z = 0. */
struct vec3 made_wall_place(const struct made_wall *w, double s, double before);
struct vec3 made_wall_normal(const struct made_wall *w); /* into the room */
/* Index of an area that holds the place by a margin; -1: none. */
int made_area_of(const struct made_room *r, double x, double y, double margin);

/* -------------------------------------------------------------------------------------------------------- furniture */

/* A box of a piece: its middle, half of its size, its turn in degrees. */
struct made_box {
    const char *name; /* of the part */
    struct vec3 middle, half;
    double turn;
    enum made_look look;
};

int made_box_count(const struct made_piece *p);
struct made_box made_box_of(const struct made_piece *p, int k);
/* Whether the footprint of a piece, enlarged by a margin, meets a place. */
bool made_piece_near(const struct made_piece *p, double x, double y, double margin);

/* ------------------------------------------------------------------------------------------------------------ texts */

#define MADE_SCALE  0.5 /* size of the photos in which pixels are marked, of the size in cameras.txt */
#define MADE_SMALL  0.3
#define MADE_WIDTH  480
#define MADE_HEIGHT 320
#define MADE_FOCAL  (640.0 / 3)

/* Parts of a scene; the sky needs no room. */
void made_write_materials(const struct made_room *r, FILE *to);
void made_write_pieces(const struct made_room *r, FILE *to);
void made_write_pictures(const struct made_room *r, FILE *to); /* and rugs */
void made_write_lamps(const struct made_room *r, FILE *to);
void made_write_sky(int seed, double azimuth, double elevation, FILE *to);

void made_write_scene(const struct made_room *r, FILE *to);
void made_write_bare(const struct made_room *r, FILE *to);
void made_write_moved(const struct made_room *r, FILE *to);
void made_write_window(const struct made_room *r, FILE *to);
void made_write_cameras(const struct made_room *r, FILE *to);
void made_write_model(const struct made_room *r, FILE *to);
void made_write_scale(const struct made_room *r, FILE *to);
void made_write_things(const struct made_room *r, FILE *to);
void made_write_lights(const struct made_room *r, FILE *to);
void made_write_edit_bare(const struct made_room *r, FILE *to);
void made_write_edit_moved(const struct made_room *r, FILE *to);
void made_write_edit_window(const struct made_room *r, FILE *to);

#endif
