/* cone.h - the half angle of a lamp's cone, from radiance along lines across its edge. */
#ifndef REMODEL_FIT_LIGHTS_CONE_H
#define REMODEL_FIT_LIGHTS_CONE_H

#include <stdbool.h>

#include "common/base/err.h"

/* Places on a line, evenly spaced, all on one surface. */
struct cone_line {
    int places;
    const double *angle;         /* of each place from the lamp's normal, radians */
    const double (*indirect)[3]; /* irradiance without this lamp */
    const char *place;           /* for errors: "FILE:LINE" */
};

/* What one photo shows of a line. */
struct cone_trace {
    int line;
    const double (*radiance)[3]; /* of each place; 0: the photo does not show it */
    const double *sigma;         /* relative noise of each place */
};

struct cone_fit {
    const char *lamp; /* its name */
    const struct cone_line *lines;
    const struct cone_trace *traces;
    int line_count, trace_count;
    /* irradiance at a place of a line from the lamp with radiance 1 and the cone beta */
    double (*direct)(const void *ctx, int line, int place, double beta);
    const void *ctx;
    double texture; /* relative deviation of reflectance along a line */
    bool has_radiance;
    double radiance[3]; /* of the lamp, if known */
    double reach;       /* half the range of angles to search, about beta; 0: all angles of the lines */

    double beta, error; /* radians; beta on entry: the middle of the range, if reach > 0 */
};

/* ST_DATA with the reason: no line crosses the edge, or none shows a step; beta would be 0 or 90 degrees. */
enum status cone_fit_solve(struct cone_fit *f, struct err *err);

#endif
