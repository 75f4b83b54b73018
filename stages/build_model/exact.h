/* exact.h - planes with whole coefficients, and the points and lines in which they meet, decided exactly.
 *
 * Lattice units (SOLID_STEP). A plane is n . p = d with |n| <= 2^22 in each component and |d| < 2^54; a point that
 * three planes share has homogeneous coordinates, reduced, of at most 100 bits, so that each sign asked for here fits
 * into 127 bits (docs/decisions/0015). Equal planes, points and lines have equal indices: "the same" is one comparison.
 * Doubles are looked at first, with a bound of their error; whole numbers decide where they do not. */
#ifndef REMODEL_BUILD_MODEL_EXACT_H
#define REMODEL_BUILD_MODEL_EXACT_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/err.h"

__extension__ typedef __int128 wide;

#define EXACT_NORMAL (1 << 22) /* the greatest component of a normal */

struct exact_plane {
    int64_t n[3], d; /* no common factor in n; the first component that is not 0 is positive */
    int axis;        /* 0, 1, 2 where n is along an axis, or -1 */
};

struct exact_point {
    wide h[4];   /* the point is h[0..2] / h[3]; no common factor, h[3] > 0 */
    double p[3]; /* the same, rounded */
};

struct exact_line {
    int64_t d[3]; /* direction; the first component that is not 0 is positive */
    wide m[3];    /* p x d of its points; with d no common factor: these six numbers are the line */
    int plane[2]; /* two that meet in it */
    int axis;     /* of the largest component of d */
};

struct exact_table { /* indices by hash; open addressing */
    int *slots;
    int size; /* a power of two */
};

struct exact_space {
    struct exact_plane *planes; /* all owned */
    struct exact_point *points;
    struct exact_line *lines;
    int plane_count, plane_capacity, point_count, point_capacity, line_count, line_capacity;
    struct exact_table plane_table, point_table, line_table;
};

void exact_release(struct exact_space *s);

/* *items holds at least `need` items of `size` bytes; *capacity follows. */
enum status exact_grow(void *items, int *capacity, int need, size_t size, struct err *err);

/* The plane n . p = d, n and d being those of *side (+1 or -1) times its own. */
enum status exact_plane_add(struct exact_space *s, const int64_t n[3], int64_t d, int *plane, int *side,
                            struct err *err);

/* Where three planes meet; *point -1 if that is not one point. */
enum status exact_meet(struct exact_space *s, int plane0, int plane1, int plane2, int *point, struct err *err);

/* Where two planes meet that are not parallel (asserted). */
enum status exact_line_add(struct exact_space *s, int plane0, int plane1, int *line, struct err *err);

bool exact_parallel(const struct exact_space *s, int plane0, int plane1);

/* -1, 0, 1: n . p < d, = d, > d. */
int exact_side(const struct exact_space *s, int point, int plane);

/* -1, 0, 1 as a's coordinate is less, the same or more than b's. */
int exact_compare(const struct exact_space *s, int a, int b, int axis);

/* The same along a line's direction, of points on it. */
static inline int exact_compare_along(const struct exact_space *s, const struct exact_line *line, int a, int b)
{
    const int c = exact_compare(s, a, b, line->axis);
    return line->d[line->axis] < 0 ? -c : c;
}

/* Sign of (a x b) . n, and of a . b. */
int exact_turn(const int64_t a[3], const int64_t b[3], const int64_t n[3]);
int exact_dot(const int64_t a[3], const int64_t b[3]);

/* Turning counter-clockwise about n, all vectors at a right angle to it, from direction r: a is met before b. A
 * direction equal to r is met at once. */
bool exact_before(const int64_t r[3], const int64_t a[3], const int64_t b[3], const int64_t n[3]);

#endif
