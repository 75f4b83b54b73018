/* gradient_system.h - the normal equations of a gradient problem.
 *
 * Unknowns are the free pixels in row-major order. Matrix A has links, -weight between unknown neighbours, and
 *     A[i][i] = excess[i] + the weights of its links,
 * so excess[i] >= 0 is what data and fixed neighbours add. Sums of positive numbers only: the matrix in this form has no
 * cancellation, and A v is evaluated from differences. 3 right-hand sides, padded to 4. */
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
    uint8_t *determined; /* of each part: 1: by data or a fixed pixel */
};

/* Checks the problem and sets up its equations; s is empty on entry. ST_DATA, ST_NOMEM: s is empty. */
enum status gradient_system_init(struct gradient_system *s, const struct gradient_problem *p, struct err *err);
void gradient_system_release(struct gradient_system *s);

/* r = b - A v */
void gradient_system_residual(double (*r)[4], const struct gradient_system *s, const double (*v)[4]);
/* Largest |r|, over the largest |b|, or over 1 if b = 0. */
double gradient_system_relative(const struct gradient_system *s, const double (*r)[4]);
/* v: the unknowns' values in p. */
void gradient_system_start(double (*v)[4], const struct gradient_system *s, const struct gradient_problem *p);
/* Gives undetermined parts the mean of their start, stores v in p->value and fills the report but iterations. r is
 * scratch memory. */
enum status gradient_system_finish(const struct gradient_system *s, const struct gradient_problem *p, double (*v)[4],
                                   double (*r)[4], struct gradient_report *report, struct err *err);

#endif
