/* wall_line.h - the line of a wall's face in plan.
 *
 * Everything is in the model's frame. A point's place is S along the line, and a distance across it, positive on the
 * side from which the face is seen: the inside. For a viewer inside who looks at the face, S increases to the right. */
#ifndef REMODEL_WALL_LINE_H
#define REMODEL_WALL_LINE_H

#include <stdbool.h>

struct wall_line {
    double n[2]; /* unit normal, towards the inside */
    double at;   /* n . p of its points p */
};

static inline double line_across(const struct wall_line *l, double x, double y)
{
    return l->n[0] * x + l->n[1] * y - l->at;
}
static inline double line_along(const struct wall_line *l, double x, double y) { return l->n[0] * y - l->n[1] * x; }
static inline void line_point(const struct wall_line *l, double s, double across, double p[2])
{
    p[0] = (l->at + across) * l->n[0] - s * l->n[1];
    p[1] = (l->at + across) * l->n[1] + s * l->n[0];
}
/* Cosine of the angle between the normals. */
static inline double line_cosine(const struct wall_line *a, const struct wall_line *b)
{
    return a->n[0] * b->n[0] + a->n[1] * b->n[1];
}
/* Where two lines cross; false: they are parallel within about three degrees. */
static inline bool line_cross(const struct wall_line *a, const struct wall_line *b, double p[2])
{
    const double sine = a->n[0] * b->n[1] - a->n[1] * b->n[0];
    if (sine * sine < 0.05 * 0.05) return false;
    p[0] = (a->at * b->n[1] - b->at * a->n[1]) / sine;
    p[1] = (b->at * a->n[0] - a->at * b->n[0]) / sine;
    return true;
}

#endif
