/* gradient_system.h - the normal equations of a gradient problem.
 *
 * Unknowns are the free pixels in row-major order. Matrix A has links, -weight between unknown neighbours, and
 *     A[i][i] = excess[i] + the weights of its links,
 * so excess[i] >= 0 is what data and fixed neighbours add. Sums of positive numbers only: the matrix in this form has
 * no cancellation, and A v is evaluated from differences. 3 right-hand sides, padded to 4. */
#ifndef REMODEL_GRADIENT_SYSTEM_H
#define REMODEL_GRADIENT_SYSTEM_H

#include "common/math/gradient_solve.h"

struct gradient_system {
    int count;      /* unknowns */
    int *pixel;     /* of each unknown */
    int (*next)[2]; /* unknowns to the right and below; -1: no link. Links have weights above 0 */
    float (*weight)[2];
    double *excess;
    double (*rhs)[4];
    int *part; /* of each unknown: connected by links; numbered in order of their first unknown */
    int part_count;
    int *size;           /* of each part: unknowns */
    uint8_t *determined; /* of each part: 1: by data or a fixed pixel */
    double low, high;    /* least and largest value of fixed pixels; INFINITY, -INFINITY if there are none */
};

/* Checks the problem and sets up its equations; s is empty on entry. ST_DATA, ST_NOMEM: s is empty. */
enum status gradient_system_init(struct gradient_system *s, const struct gradient_problem *p, struct err *err);
void gradient_system_release(struct gradient_system *s);

/* r = b - A v */
void gradient_system_residual(double (*r)[4], const struct gradient_system *s, const double (*v)[4]);

/* Solves A v = b from the start v; *iterations: those needed, 0 for a direct method, -1 without convergence. */
typedef enum status gradient_method(const struct gradient_system *s, double (*v)[4], int *iterations, struct err *err);
gradient_method gradient_direct, gradient_multigrid;

#endif
