/* photometry.h - how a luminaire shines: intensities by direction from an IES file (LM-63), in candela.
 *
 * Type C: vertical angles count from straight down (0) to straight up (180), horizontal angles around that axis. */
#ifndef REMODEL_PHOTOMETRY_H
#define REMODEL_PHOTOMETRY_H

#include "common/base/provenance.h"
#include "common/math/vec.h"

enum photometry_format { LM63_1986, LM63_1991, LM63_1995, LM63_2002 }; /* 2002 and later */

/* {0} is the empty state; everything is owned. */
struct photometry {
    enum photometry_format format;
    char *name; /* [LUMINAIRE], else [LUMCAT], else the first line of a label; "" */
    int vertical_count, horizontal_count;
    double *vertical, *horizontal;        /* degrees, ascending; horizontal without what symmetry repeats */
    double *candela;                      /* of horizontal angle h and vertical angle v: [h * vertical_count + v] */
    double mirror;                        /* plane of symmetry: 0 or 90 degrees; -1: none */
    double turn;                          /* of symmetry: horizontal angles repeat after it; 360: none */
    double width, length, height;         /* of the luminous opening, m; as in the file, negative for round shapes */
    double lamps, lumens_per_lamp, watts; /* as declared; lumens -1: absolute photometry */
    int tilt_count;                       /* 0: lamps shine alike in any position */
    double *tilt_angle, *tilt_factor;     /* degrees from the untilted position; factor of all intensities */
    int tilt_geometry;                    /* 1 lamp vertical; 2 horizontal, stays so; 3 horizontal, tilts along */
};

/* ST_DATA with file and line: no LM-63 file, photometry of type A or B, angles that do not ascend or whose range has no
 * meaning, a negative or damaged number, tilt factors in a file of their own. */
enum status photometry_read(struct photometry *p, const char *path, struct provenance *prov, struct err *err);
void photometry_release(struct photometry *p);

/* Intensity at a vertical and a horizontal angle in degrees, untilted; 0 outside of the file's vertical angles. Linear
 * in both angles. */
double photometry_intensity(const struct photometry *p, double vertical, double horizontal);
/* Factor of all intensities of a luminaire that is tilted by an angle, 0 to 180 degrees. */
double photometry_tilt(const struct photometry *p, double degrees);
/* Intensity towards a unit direction of the model, z up, of a luminaire whose vertical angle 0 points along `down` and
 * whose horizontal angle 0 along `along` (unit, at a right angle); angles turn from there towards down x along. Lamps
 * that shine less in tilted luminaires do. */
double photometry_candela(const struct photometry *p, struct vec3 direction, struct vec3 down, struct vec3 along);

/* All light of the untilted luminaire in lm: the integral of intensity over all directions. */
double photometry_lumens(const struct photometry *p);

#endif
