/* plan_checks.h - what the checks of a plan share. */
#ifndef REMODEL_BUILD_MODEL_PLAN_CHECKS_H
#define REMODEL_BUILD_MODEL_PLAN_CHECKS_H

#include "stages/build_model/plan/plan_internal.h"

struct plan_checker {
    struct plan *plan;
    const char *path;
    int line; /* of the edit's statement, which is blamed for any error; 0: the line that made the item is named */
    struct err *err;
};

/* Sets ST_DATA with file and line; own: line of the faulty item. */
enum status plan_error(struct plan_checker *c, int own, const char *fmt, ...) PRINTF_LIKE(3, 4);

/* The segments from a to b and from x to y have a point in common. */
bool plan_segments_meet(const double a[2], const double b[2], const double x[2], const double y[2]);

/* Derives all that plan_room holds as of the last check. */
enum status plan_check_rooms(struct plan_checker *c);

#endif
