/* suggest.h - suggests a plan of walls, rooms and openings from oriented points and lines of sight.
 *
 * Everything is in the model's frame (common/model/model_axes.h). Nothing that is missing is an error: what was not
 * found is not in the plan, or is a doubt. */
#ifndef REMODEL_SUGGEST_H
#define REMODEL_SUGGEST_H

#include "stages/suggest_model/wall_faces.h"

/* Assumed thickness of a wall of which one face was seen, as a fraction of the ceiling's height. */
#define WALL_THICKNESS 0.06

/* Edge of the cubes that keep one point, likewise. */
#define SUGGEST_CUBE 0.02

static inline double suggested_thickness(double measured, double height)
{
    return measured > 0 ? measured : WALL_THICKNESS * height;
}

enum wall_join { JOIN_NONE, JOIN_CORNER, JOIN_MEETS }; /* of a wall's end; meets: the other wall goes on */

struct suggested_wall {
    struct wall_line line; /* of the face that is its inside */
    bool angled;           /* not along an axis */
    double begin, end;     /* S */
    double seen[2];        /* S of the first and the last part that was seen */
    double thickness;      /* 0: only one face was seen, from the rooms that it bounds */
    bool between;          /* rooms, or parts of one, on both sides */
    bool guessed;          /* of a wall between rooms: its thickness is assumed */
    double covered;        /* fraction of its length that points and lines of sight show */
    double confidence;     /* 0 .. 1 */
    enum wall_join joins[2];
    int others[2]; /* what its ends are joined to */
};
struct suggested_opening {
    int wall;
    double begin, end, foot, top;
    bool window;   /* does not reach the floor */
    bool doubtful; /* a bright area without depth: a window, or a patch of light */
};
enum doubt_kind { DOUBT_BORDER, DOUBT_FACE, DOUBT_STRETCH };
struct suggested_doubt {  /* where a wall may be */
    enum doubt_kind kind; /* the border of what was seen; a face that bounds no room; a part of a wall */
    double a[2], b[2];
    int wall;         /* of a part of a wall, else -1 */
    double covered;   /* as of a wall */
    int views_beyond; /* of the border of what was seen: views whose cameras stand behind it */
};
struct suggested_room {
    int first, count; /* in room_walls */
    bool closed;      /* each wall is joined to the next, and the outline can be built */
    double middle[2], area;
};
struct suggestion {
    double ceiling;
    struct suggested_wall *walls; /* all owned */
    struct suggested_opening *openings;
    struct suggested_room *rooms;
    struct suggested_doubt *doubts;
    int *room_walls;
    int wall_count, opening_count, room_count, doubt_count, room_wall_count;
};

void suggest_release(struct suggestion *s);

/* s is empty on entry, and again after a failure; the caller releases it. sights: thinned points of the cloud, and
 * lines of sight to them, in the model's frame. height: of the ceiling, > 0. thickness: of outer walls; 0: unknown. */
enum status suggest_plan(struct suggestion *s, const struct sights *sights, double height, double thickness,
                         const struct suggest_params *params, struct err *err);

#endif
