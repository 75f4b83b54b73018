/* gradient_solve.c - which solver a gradient problem gets: the direct one. */
#include "common/math/gradient_solve.h"

enum status gradient_solve(const struct gradient_problem *p, struct gradient_report *report, struct err *err)
{
    return gradient_solve_direct(p, report, err);
}
