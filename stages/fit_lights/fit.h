/* fit.h - radiance of lamps and reflectance of materials, from the radiance of points that lamps light and do not
 * light. */
#ifndef REMODEL_FIT_LIGHTS_FIT_H
#define REMODEL_FIT_LIGHTS_FIT_H

#include <stdbool.h>

#include "common/base/err.h"
#include "common/math/vec.h"

enum fit_point_kind { POINT_LIT, POINT_UNLIT, POINT_ACROSS };

/* A point of a material with what is known of it. */
struct fit_point {
    int material, lamp;       /* lamp: that it is annotated for */
    enum fit_point_kind kind; /* whether that lamp lights it; POINT_ACROSS: of a line across the edge of its cone */
    struct vec3 at;
    double indirect[3]; /* irradiance without any lamp */
    double radiance[3]; /* observed; above 0 */
    double sigma;       /* relative standard deviation of the radiance */
    const char *place;  /* for errors: "FILE:LINE" */
};

struct fit_lamp {
    const char *name;
    int material; /* of its points */
    bool fit, fit_exponent;
    double radiance[3], exponent;             /* given, or to be found */
    double radiance_error[3], exponent_error; /* standard errors; 0: given */
    double seen[3], seen_error[3]; /* radiance that views show of the lamp itself; relative standard errors, 0: none */
};

/* The points of a lamp are of one material; several lamps may light the same one. */
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
    int point_count, lamp_count, material_count;
    /* irradiance at a point from a lamp of radiance 1 */
    double (*direct)(const void *ctx, int lamp, int point, double exponent);
    const void *ctx;
    double texture, max_spread, irradiance_error; /* as the parameters */
};

/* Fills what is to be found. ST_DATA with the reason: no indirect light, points that are lit alike, points of different
 * materials, too few points. */
enum status light_fit_solve(struct light_fit *f, struct err *err);

#endif
