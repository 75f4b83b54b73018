/* light_errors.h - how far the light of groups may be off: of lamps as their fit says, of the sun and the sky as they
 * were found. */
#ifndef REMODEL_LEVELS_LIGHT_ERRORS_H
#define REMODEL_LEVELS_LIGHT_ERRORS_H

#include "stages/light_levels/groups.h"

#define LIGHT_NORMAL_95 1.959964 /* standard deviations to either side of an interval */

/* Standard errors of the logarithm of a group's light, by which it may be darker and brighter. */
struct group_error {
    double dark, bright;
};

/* {0} is the empty state; everything is owned. */
struct light_errors {
    struct group_error *of; /* of lamps, rest, and windows' sky and sun */
    int count;
};

/* fit: fit.txt of the lamps; NULL: they are exact, but for lower bounds. sky: sky.txt; NULL: sky and sun are exact. The
 * caller releases e in each case. ST_DATA with file and line: a damaged file, a lamp that the scene does not have. */
enum status light_errors_read(struct light_errors *e, const char *fit, const char *sky, const struct light_groups *g,
                              struct provenance *prov, struct err *err);
void light_errors_release(struct light_errors *e);

#endif
