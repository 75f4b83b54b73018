/* explained_walls.c - see explained_walls.h.
 *
 * If the lines of a wall lie on one in front of it, their heights there are one height, whatever the distances of the
 * cameras; if they are its own, their distances agree as well or better. Feet and heads may both lie on a wall in
 * front, but then at two heights that fit each other by chance: a wall that shows both along a part of it is sure.
 *
 * A wall of feet alone or of heads alone, such as the heads of a row of doors, need not lie on the wall in front where
 * that one was found: it shows how far that wall goes on. */
#include "stages/find_frame/explained_walls.h"

#include <math.h>
#include <stdlib.h>

#include "stages/find_frame/wall_ends.h"
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

/* The lines of a wall, on another one in front of it. */
struct cast {
    struct spread front, behind; /* of their heights on that wall, and on their own, in those of the cameras */
    bool feet, heads;
    double from, to; /* on the wall in front */
};

/* Casts the lines of wall b on wall a. False: there are none, or somebody stands between the two. */
static bool cast_lines(struct cast *c, const struct foot_lines *lines, const struct frame_wall *a,
                       const struct frame_wall *b, double size)
{
    *c = (struct cast){.from = INFINITY, .to = -INFINITY};
    for (int i = 0; i < lines->count; i++) {
        const struct foot_line *l = &lines->lines[i];
        if (l->heading != b->heading || foot_line_side(l) != b->side ||
            fabs(l->offset - b->offset) > 2 * WALL_ROW * size || !(l->to > b->from && l->from < b->to))
            continue;
        const double near = a->side * (l->eye - a->offset), far = a->side * (l->eye - b->offset),
                     own = a->side * (l->eye - l->offset);
        if (!(near > 0)) return false;
        spread_add(&c->front, near / own);
        spread_add(&c->behind, far / own);
        c->feet |= !l->head;
        c->heads |= l->head;
        c->from = fmin(c->from, l->eye_place + near / own * (fmax(l->from, b->from) - l->eye_place));
        c->to = fmax(c->to, l->eye_place + near / own * (fmin(l->to, b->to) - l->eye_place));
    }
    return c->front.n > 0;
}

/* Whether the lines of wall b may lie on wall a, which is in front of it: at one height of it, as well as at the foot
 * of b. Feet or heads alone may lie on what a continues to, if they touch a. *c: where. */
static bool is_on(struct cast *c, const struct foot_lines *lines, const struct frame_wall *a,
                  const struct frame_wall *b, double size)
{
    const double overlap = fmin(a->to, b->to) - fmax(a->from, b->from);
    if (a->heading != b->heading || a->side != b->side || !(a->side * (a->offset - b->offset) > 0)) return false;
    if (2 * a->support < b->support || !cast_lines(c, lines, a, b, size)) return false;
    const bool touches = c->feet != c->heads && c->from < a->to && c->to > a->from;
    if (!(overlap > 0.5 * (b->to - b->from)) && !touches) return false;
    return spread_of(&c->front) <= spread_of(&c->behind) + SAME_HEIGHT;
}

enum status explained_walls_drop(struct room_frame *f, const bool *sure, const struct foot_lines *lines, double size,
                                 struct err *err)
{
    bool *dropped = calloc((size_t)f->wall_count + 1, sizeof *dropped);
    int kept = 0;
    if (!dropped) return err_nomem(err, "walls", (size_t)f->wall_count);
    for (int b = 0; b < f->wall_count; b++)
        for (int a = 0; a < f->wall_count && !sure[b] && !dropped[b]; a++) {
            struct cast c;
            struct frame_wall *front = &f->walls[a];
            if (a == b || dropped[a] || !is_on(&c, lines, front, &f->walls[b], size)) continue;
            dropped[b] = true;
            if (c.feet == c.heads) continue;
            wall_end_grow(front, -1, c.from, f);
            wall_end_grow(front, 1, c.to, f);
        }
    for (int k = 0; k < f->wall_count; k++)
        if (!dropped[k]) f->walls[kept++] = f->walls[k];
    f->wall_count = kept;
    free(dropped);
    return ST_OK;
}
