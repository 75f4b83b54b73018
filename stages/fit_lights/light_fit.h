/* light_fit.h - points, lamps and materials of a scene: what is known of them, and what a fit finds (fit.h). */
#ifndef REMODEL_FIT_LIGHTS_LIGHT_FIT_H
#define REMODEL_FIT_LIGHTS_LIGHT_FIT_H

#include <stdbool.h>

#include "common/math/vec.h"

enum fit_point_kind { POINT_LIT, POINT_UNLIT, POINT_ACROSS };

/* A point of a material with what is known of it. */
struct fit_point {
    int material, lamp, mark; /* lamp: that it is annotated for */
    int wall;                 /* points of a lamp on one plane: one factor is the error of their indirect irradiance */
    enum fit_point_kind kind; /* whether that lamp lights it; POINT_ACROSS: of a line across the edge of its cone */
    struct vec3 at;
    double indirect[3]; /* irradiance without any lamp */
    double radiance[3]; /* observed; above 0 */
    double sigma;       /* relative standard deviation of the radiance */
};

/* The points of one line of the annotations, or of one patch of a face. They may be of another material than the line
 * says, in shade or in the sun: all of them are then brighter or darker by one factor. */
struct fit_mark {
    double off, off_error; /* logarithm of that factor, the mean of the colours; its standard deviation */
    double variance;       /* of the factor's logarithm, as far as the fit counts the mark */
};

struct fit_lamp {
    const char *name;
    bool fit, fit_exponent;
    double radiance[3], exponent;             /* given, or to be found */
    double radiance_error[3], exponent_error; /* standard errors; 0: given */
    double low[3], high[3];                   /* interval of 95 % of the radiance */
    double middle[2][3];                      /* and of its middle half */
    double seen[3], seen_error[3]; /* radiance that views show of the lamp itself; relative standard errors, 0: none */
    bool seen_is_bound;            /* the lamp saturates there: it is at least as bright */
    double lit[3], lit_error[3];   /* radiance that all faces tell; standard errors of its logarithm, 0: none */
};

struct fit_material {
    const char *name;
    double k_d[3], k_d_error[3];
    double spread;                   /* relative deviation of the points' reflectance */
    double deviation, length, grain; /* how it varies: see fit_texture.c; length in the unit of points, 0: at random */
    int lit, unlit;
};

struct light_fit {
    struct fit_point *points;
    struct fit_lamp *lamps;
    struct fit_material *materials;
    struct fit_mark *marks;
    int point_count, lamp_count, material_count, mark_count;
    /* irradiance at a point from a lamp of radiance 1 */
    double (*direct)(const void *ctx, int lamp, int point, double exponent);
    const void *ctx;
    double texture, irradiance_error; /* as the parameters */
    double wall_variance;             /* of the logarithms of walls' factors; the fit sets it */
    int draws; /* of solutions, for intervals, errors and offsets of marks; 0: none of these are wanted */
};

#endif
