/* wall_faces.h - faces of walls: lines in plan on which points concentrate, and what speaks for and against each
 * place. */
#ifndef REMODEL_WALL_FACES_H
#define REMODEL_WALL_FACES_H

#include "common/math/numbers.h"
#include "stages/suggest_model/sights.h"
#include "stages/suggest_model/suggest_params.h"

struct wall_face {
    struct wall_line line;
    bool angled;         /* not along an axis of the model */
    double area;         /* of its cells with points, squares of the ceiling's height */
    double first;        /* S where its first column begins */
    int columns;         /* as wide as the parameter `cell` */
    signed char *cells;  /* owned; columns x up: +1 solid, -1 seen through, 0 unknown */
    float *solid;        /* owned; of each column: how much speaks for a wall there, 0 .. 1 */
    float *open;         /* owned; of each column: fraction of its known cells that are seen through */
    signed char *lintel; /* owned; of each column, near the ceiling: +1 solid, -1 seen through, 0 unknown */
    float flat;          /* of the points around the face: fraction that lie on it */
};
struct face_list {
    struct wall_face *faces; /* owned */
    int count;
    int up;                 /* cells in a column */
    double cell, height;    /* edge of a cell, height of the ceiling */
    double low[2], high[2]; /* bounds of the plan */
};

/* Fills list->faces, empty on entry; the other members are given. The caller releases it. */
enum status faces_find(struct face_list *list, const struct sights *sights, const struct suggest_params *params,
                       struct err *err);
void face_list_release(struct face_list *list);

/* Means over the columns from begin to end; 0 where the face has none. */
double face_solid(const struct face_list *list, const struct wall_face *face, double begin, double end);
double face_open(const struct face_list *list, const struct wall_face *face, double begin, double end);
double face_lintel(const struct face_list *list, const struct wall_face *face, double begin, double end);

#endif
