/* numbers.h - constants, and clamping. */
#ifndef REMODEL_NUMBERS_H
#define REMODEL_NUMBERS_H

#define PI     3.14159265358979323846
#define DEGREE (PI / 180) /* radians */

/* x limited to [min, max]. clamp(NaN) is min. */
static inline double clamp(double x, double min, double max) { return x > min ? (x < max ? x : max) : min; }
static inline int clamp_int(int x, int min, int max) { return x > min ? (x < max ? x : max) : min; }

#endif
