/* wall_joins.h - how the walls of a suggestion are joined, so that build_model can build them. */
#ifndef REMODEL_WALL_JOINS_H
#define REMODEL_WALL_JOINS_H

#include "stages/suggest_model/suggest.h"

/* A face of a wall: side 0 is its inside, 1 its other face. */
struct wall_side {
    int wall, side;
};

struct wall_line wall_side_line(const struct suggested_wall *w, int side);

/* Joins two walls whose faces follow each other round a room, where their lines cross near an end of each. */
void wall_joins_add(struct suggestion *s, const struct wall_side *x, const struct wall_side *y);
bool wall_joins_has(const struct suggestion *s, int a, int b);

/* Makes walls beside short ones thinner, until these have a length between the corners; joins of walls for which that
 * does not help are undone. thickness: of walls of which one face was seen. */
void wall_joins_fit(struct suggestion *s, double thickness);

/* Moves ends that are joined to nothing to where the wall was seen, and undoes where a wall would then meet another
 * beyond that one's end, which build_model refuses. thickness: as above. */
void wall_joins_drop_unmet(struct suggestion *s, double thickness);

/* Cuts the openings to their walls between corners and walls that meet them; removes those that remain too small, and
 * of two that overlap the smaller. */
void wall_joins_cut_openings(struct suggestion *s, double thickness, double min_side);

#endif
