/* plan.h - the building that a script describes: walls with their joins, rooms, openings and boxes, before they are
 * solids.
 *
 * Model frame: z up, floor at 0, x and y along the walls. In plan a wall is a line from its start to its end, left to
 * right for a viewer inside the room; its in face is on that line, its body behind it. S along a wall is x or y of the
 * model for a wall along an axis, and the distance from its first point for an angled wall.
 *
 * An end is stored as the wall that it is joined to, not as a position, so that a wall that moves takes its neighbours'
 * ends along. */
#ifndef REMODEL_BUILD_MODEL_PLAN_H
#define REMODEL_BUILD_MODEL_PLAN_H

#include "stages/build_model/place/place.h"
#include "stages/build_model/script/script.h"

enum end_kind {
    FREE_END,
    CORNER_END, /* includes the intersection with the other wall: ends at that wall's farther face */
    MEET_END,   /* ends at the nearer face of the other wall */
};

struct wall_end {
    enum end_kind kind;
    double s;  /* FREE_END */
    int other; /* wall */
};

enum { SIDE_IN, SIDE_OUT };

struct plan_wall {
    char *name; /* owned */
    int line;
    bool removed, angled; /* a removed wall keeps its line, where rooms and neighbours still end */
    double d[2];          /* unit, from start to end */
    double c;             /* in face: n p = c with n = (d.y, -d.x), which points into the room */
    int sign;             /* of d along the wall's coordinate: s = sign d p - origin */
    double origin;
    double thickness, foot, top;
    bool has_top; /* set by the script; otherwise the wall goes up to the ceilings */
    struct wall_end ends[2];
};

struct plan_line { /* n p = c, n unit */
    double n[2], c;
};

struct plan_top { /* of walls, or the lower face of a ceiling: the lowest of z = a[i][0] + a[i][1] x + a[i][2] y */
    double a[2][3];
    int count;
};

enum opening_kind { OPENING_DOOR, OPENING_PASSAGE, OPENING_WINDOW, OPENING_SKYLIGHT, OPENING_HATCH };

struct plan_opening { /* in a wall: a door, a passage or a window */
    char *name;
    int line;
    enum opening_kind kind;
    bool removed, interior;
    enum filling fill;
    bool refilled; /* by `fill`: a window has glass also between two rooms */
    double leaf;   /* thickness of the leaf or glass; 0: not set yet */
    int wall;
    double s[2], z[2]; /* ascending */
};

struct plan_slot { /* an opening in a room's ceiling or floor: a skylight or a hatch */
    char *name;
    int line;
    enum opening_kind kind;
    bool removed;
    enum filling fill;
    double leaf; /* as of an opening */
    int room;
    double low[2], high[2];
};

struct plan_box {
    char *name;
    int line;
    bool removed;
    double low[3], high[3], turn; /* degrees, about the vertical through its middle */
};

struct room_edge {              /* consecutive walls on one line are one edge */
    int wall;                   /* the first of them */
    int side;                   /* the side that faces the room */
    double corner[2], outer[2]; /* with the next edge: of the faces, and of the slab's border */
    double border;              /* the slab ends at n p = border of the wall */
    bool shared;                /* there is a room on the other side: the border is in the wall's middle */
};

struct part_corner { /* of a convex polygon in plan, counter-clockwise */
    double p[2];
    struct plan_line line; /* of the side that ends here, n outwards */
    int wall, side;        /* the wall face in that side; wall is one of enum part_side where there is none */
};

enum part_side { PART_CUT = -1, PART_MIDDLE = -2 }; /* a cut, the middle of a wall between two rooms */

struct room_part {
    struct part_corner *corners;
    int count;
};

struct plan_room {
    char *name;
    int line;
    bool removed;
    int *walls;
    int *edge_of; /* of each of walls, as of the last check */
    int wall_count;
    double floor, ceiling, slab; /* slab: thickness of both */
    enum { LEVEL_CEILING, SLOPED_CEILING, GABLE_CEILING } shape;
    int slope_walls[2];
    double slope_heights[3]; /* of the ceiling at slope_walls, and of a gable's ridge */
    double ridge_at;         /* distance of the ridge from the first wall; 0: in the middle */
    /* as of the last check */
    struct plan_top lower;   /* the ceiling's lower face */
    struct room_edge *edges; /* counter-clockwise */
    int edge_count;
    struct room_part *parts; /* the slabs' outline, cut into convex parts */
    int part_count;
};

/* What a script says of textures; resolved when the faces are known (texture_rules.h). */
enum wish_kind { WISH_STRETCH, WISH_CROP, WISH_COLOUR, WISH_COPY, WISH_GLOSS };
struct plan_wish {
    enum wish_kind kind;
    char *path; /* of the script, for messages; owned */
    int line;
    char *face;         /* STRETCH, CROP: the item; COLOUR, GLOSS: face or faces; COPY: what gets texture; owned */
    char *from;         /* COPY: the face that has it; owned */
    double patch[4];    /* COPY: S and Z, or X and Y, of the patch's corners */
    double target[4];   /* COPY, COLOUR: the same of the place that gets it */
    bool whole;         /* COPY, COLOUR: the whole face gets it */
    double colour[3];   /* COLOUR: albedo */
    struct gloss gloss; /* GLOSS */
};

struct plan_lamp {
    char *name;      /* in lights.txt, or of a planned lamp; owned */
    double scale[3]; /* of its radiance */
    char *file;      /* of a planned one, its photometry in the scene's folder; NULL: one of lights.txt; owned */
    int line;        /* of its statement */
    struct script_lamp placed;
};

struct plan_object { /* a synthetic object */
    char *name;      /* owned */
    char *path;      /* of the script, for messages; owned */
    int line;
    bool removed;
    char *file; /* its mesh, in the scene's folder; owned */
    struct script_object placed;
};

/* Clutter is left out, or kept, in a footprint. */
struct plan_zone {
    bool keep, all;
    int room;      /* its footprint; -1: another one */
    int opening;   /* the space before it, on both sides of its wall; -1: the rectangle, or all rooms */
    double before; /* how far from the wall */
    double low[3], high[3];
};

enum name_kind { NAMED_NONE, NAMED_WALL, NAMED_OPENING, NAMED_BOX, NAMED_ROOM, NAMED_SLOT, NAMED_THING };

/* Furniture that the photographs show, or a copy of it. */
enum plan_thing_state { PLAN_THING_LEFT, PLAN_THING_CLEARED, PLAN_THING_KEPT, PLAN_THING_MOVED, PLAN_THING_PLACED };

struct plan_thing {
    char *name; /* owned */
    int line;   /* of things.txt; of a copy: of its statement */
    int from;   /* index of the thing that it is a copy of; its own: it is none */
    enum plan_thing_state state;
    double by[3]; /* MOVED: the sum of all moves; PLACED: the middle of its footprint, and the floor's height */
    double turn;  /* degrees, counter-clockwise from above, about the middle of its footprint */
    char *script; /* file name of the script that said so last, for messages; NULL: none did; owned */
    int said;     /* line of its statement */
};

struct plan_name {
    const char *name; /* NULL: free slot */
    enum name_kind kind;
    int at;
};

struct plan {
    /* defaults of the statements that follow; 0: unknown */
    double thickness, slab, glass, leaf, floor, ceiling;
    struct plan_wall *walls;
    struct plan_opening *openings;
    struct plan_slot *slots;
    struct plan_box *boxes;
    struct plan_room *rooms;
    int wall_count, opening_count, slot_count, box_count, room_count;
    double colour[3];         /* albedo of faces without a texture; -1: the default one */
    struct plan_wish *wishes; /* in the scripts' order */
    struct plan_zone *zones;
    struct plan_thing *things; /* those of things.txt first */
    int wish_count, zone_count, thing_count;
    struct plan_lamp *lamps;
    struct plan_object *objects;
    int lamp_count, object_count;
    struct plan_name *names; /* a hash table */
    int name_capacity, name_count;
    char *base; /* the edit that the last edit stands on; NULL: none; owned */
    /* A copy from before the first edit, in which texture has its places; NULL: there was no edit. Its names belong to
     * this plan; it has no base, wishes, zones, lamps and objects, and its rooms have no walls, edges and parts. */
    struct plan *unedited;
};

/* Sets a plan's defaults: those of homes, in metres; without a scale they are unknown, except `ceiling` and `thickness`
 * where the axes have them. axes may be NULL: metres. */
void plan_begin(struct plan *plan, const struct model_axes *axes);

/* Applies the statements in order, then checks the whole plan; edit: checks it after every statement, so that the error
 * names the statement that breaks the building, and refuses a statement that changes nothing. placer may be NULL if no
 * statement names a view. ST_DATA with file and line. */
enum status plan_apply(struct plan *plan, const struct script *script, bool edit, const struct placer *placer,
                       struct err *err);
void plan_release(struct plan *plan);

/* For the layout and the pictures. */
struct plan_line plan_wall_face(const struct plan_wall *w, int side); /* n points out of the wall */
/* The line across a wall at one of its ends, n pointing out of the wall. *face_wall, *face_side: the face of another
 * wall that it lies on; *face_wall is -1 for none. */
struct plan_line plan_wall_cap(const struct plan *plan, int wall, int end, int *face_wall, int *face_side);
void plan_wall_point(const struct plan_wall *w, double s, double off, double p[2]); /* off: behind the in face */
bool plan_line_cross(struct plan_line a, struct plan_line b, double p[2]);          /* false: nearly parallel */
/* The part where openings may lie: between the neighbours. */
void plan_wall_span(const struct plan *plan, int wall, double span[2]);
/* From cap to cap: all that the wall's solid may cover, including its corners. */
void plan_wall_reach(const struct plan *plan, int wall, double span[2]);
/* The part of an edge's wall over which the room's ceiling lies. */
void plan_room_span(const struct plan *plan, const struct plan_room *room, int edge, int wall, double span[2]);
/* The edge of the room that contains the wall; -1 for none. */
int plan_room_edge_of(const struct plan_room *room, int wall);
double plan_wall_top(const struct plan *plan, int wall, double s0, double s1); /* the lowest over s0 .. s1 */
const char *plan_opening_word(enum opening_kind kind); /* "door", ...: as in scripts and in the names of faces */
/* The opening is there: neither it nor its wall is removed, and it is not walled up. */
bool plan_opening_is_there(const struct plan *plan, const struct plan_opening *o);
/* The slot is there: neither it nor its room is removed, and it is not walled up. */
bool plan_slot_is_there(const struct plan *plan, const struct plan_slot *slot);
/* The corners of a wall in plan, in order around it: in and out face at its start, out and in face at its end. */
void plan_wall_corners(const struct plan *plan, int wall, double corners[4][2]);
double plan_top_at(const struct plan_top *top, const double p[2]);
struct plan_top plan_level_top(double z);

#endif
