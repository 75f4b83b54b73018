/* exact.h - planes with integer coefficients, the points and lines in which they meet, and exact predicates.
 *
 * Lattice units (SOLID_STEP). A plane is n . p = d with |n| <= 2^22 in each component and |d| < 2^54; the point of
 * three planes has reduced homogeneous coordinates of at most 100 bits, so that every sign computed here fits into 127
 * bits (docs/decisions/0015). Equal planes, points and lines have equal indices, so equality is one comparison.
 * Predicates are evaluated in doubles with an error bound first, and in integers where that does not decide. */
#ifndef REMODEL_BUILD_MODEL_EXACT_H
#define REMODEL_BUILD_MODEL_EXACT_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/err.h"

__extension__ typedef __int128 wide;

#define EXACT_NORMAL (1 << 22) /* the greatest component of a normal */

struct exact_plane {
    int64_t n[3], d; /* n has no common factor; its first nonzero component is positive */
    int axis;        /* 0, 1, 2 where n is along an axis, or -1 */
};

struct exact_point {
    wide h[4];   /* the point is h[0..2] / h[3]; no common factor, h[3] > 0 */
    double p[3]; /* the same, rounded */
};

struct exact_line {
    int64_t d[3]; /* direction; the first nonzero component is positive */
    wide m[3];    /* p x d of its points; with d no common factor: these six numbers identify the line */
    int plane[2]; /* two planes that meet in it */
    int axis;     /* of the largest component of d */
};

struct exact_table { /* hash table of indices, open addressing */
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

/* Grows *items to hold at least `need` items of `size` bytes, and *capacity with it. */
enum status exact_grow(void *items, int *capacity, int need, size_t size, struct err *err);

/* Adds the plane n . p = d; n and d are *side (1 or -1) times the stored ones. */
enum status exact_plane_add(struct exact_space *s, const int64_t n[3], int64_t d, int *plane, int *side,
                            struct err *err);

/* The point in which three planes meet; -1: they do not meet in one point. */
enum status exact_meet(struct exact_space *s, int plane0, int plane1, int plane2, int *point, struct err *err);

/* The line in which two planes meet, which are not parallel (asserted). */
enum status exact_line_add(struct exact_space *s, int plane0, int plane1, int *line, struct err *err);

bool exact_parallel(const struct exact_space *s, int plane0, int plane1);

/* -1, 0, 1: n . p < d, = d, > d. */
int exact_side(const struct exact_space *s, int point, int plane);

/* -1, 0, 1: a's coordinate is less than, equal to, greater than b's. */
int exact_compare(const struct exact_space *s, int a, int b, int axis);

/* The same along the direction of a line, for points on it. */
static inline int exact_compare_along(const struct exact_space *s, const struct exact_line *line, int a, int b)
{
    const int c = exact_compare(s, a, b, line->axis);
    return line->d[line->axis] < 0 ? -c : c;
}

/* Sign of (a x b) . n. */
int exact_turn(const int64_t a[3], const int64_t b[3], const int64_t n[3]);

/* Turning counter-clockwise about n from direction r, a comes before b. All three are perpendicular to n; a direction
 * equal to r comes first. */
bool exact_before(const int64_t r[3], const int64_t a[3], const int64_t b[3], const int64_t n[3]);

#endif
