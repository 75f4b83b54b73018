/* explained_walls.c - see explained_walls.h.
 *
 * If the lines of a wall lie on one in front of it, their heights there are one height, whatever the distances of the
 * cameras; if they are its own, their distances agree as well or better. Feet and heads may both lie on a wall in
 * front, but then at two heights that fit each other by chance: a wall that shows both along a part of it is sure. */
#include "stages/find_frame/explained_walls.h"

#include <math.h>
#include <stdlib.h>

#include "stages/find_frame/wall_grid.h"

#define SAME_HEIGHT 0.02 /* of the cameras above the floor: what heights of one line differ by */

/* Root mean square of the distance from the mean. */
struct spread {
    double n, sum, square;
};

static void spread_add(struct spread *s, double x)
{
    s->n++;
    s->sum += x;
    s->square += x * x;
}

static double spread_of(const struct spread *s)
{
    return s->n > 0 ? sqrt(fmax(s->square / s->n - s->sum / s->n * (s->sum / s->n), 0)) : 0;
}

/* Whether the lines of wall b may lie on wall a, which is in front of it: at one height of it, as well as at the foot
 * of b. Heights are measured in those of the cameras above the floor. */
static bool is_on(const struct foot_lines *lines, const struct frame_wall *a, const struct frame_wall *b, double size)
{
    const double overlap = fmin(a->to, b->to) - fmax(a->from, b->from);
    struct spread front = {0}, behind = {0};
    if (a->heading != b->heading || a->side != b->side || !(a->side * (a->offset - b->offset) > 0)) return false;
    if (!(overlap > 0.5 * (b->to - b->from)) || 2 * a->support < b->support) return false;
    for (int i = 0; i < lines->count; i++) {
        const struct foot_line *l = &lines->lines[i];
        if (l->heading != b->heading || foot_line_side(l) != b->side ||
            fabs(l->offset - b->offset) > 2 * WALL_ROW * size || !(l->to > b->from && l->from < b->to))
            continue;
        const double near = a->side * (l->eye - a->offset), far = a->side * (l->eye - b->offset),
                     own = a->side * (l->eye - l->offset);
        if (!(near > 0)) return false; /* somebody stands between the two */
        spread_add(&front, near / own);
        spread_add(&behind, far / own);
    }
    return front.n > 0 && spread_of(&front) <= spread_of(&behind) + SAME_HEIGHT;
}

enum status explained_walls_drop(struct room_frame *f, const bool *sure, const struct foot_lines *lines, double size,
                                 struct err *err)
{
    bool *dropped = calloc((size_t)f->wall_count + 1, sizeof *dropped);
    int kept = 0;
    if (!dropped) return err_nomem(err, "walls", (size_t)f->wall_count);
    for (int b = 0; b < f->wall_count; b++)
        for (int a = 0; a < f->wall_count && !dropped[b]; a++)
            dropped[b] = a != b && !sure[b] && !dropped[a] && is_on(lines, &f->walls[a], &f->walls[b], size);
    for (int k = 0; k < f->wall_count; k++)
        if (!dropped[k]) f->walls[kept++] = f->walls[k];
    f->wall_count = kept;
    free(dropped);
    return ST_OK;
}
