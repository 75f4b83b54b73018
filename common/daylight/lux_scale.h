/* lux_scale.h - how many cd/m2 a radiance of 1 of a scene's views is: out/SCENE/lux/scale.txt, written by
 * calibrate_light. The same number turns irradiance of the scene's unit into lx.
 *
 *   remodel-lux-scale 1
 *   scale 413.2                       cd/m2
 *   interval 360.1 474.2              95 %
 *   from measurements                 or: exposure; unknown, with scale and interval 0
 *   exposure 24 389.1 194.6 778.2     photos whose exposure is known, and scale and interval by it; 0 0 0 0: none
 *   measurement NAME illuminance 420 1.017 0.09 -0.02 used
 *                                     what was measured, lx or cd/m2; the same in the scene's unit; the deviations, as
 *                                     logarithms, expected of their quotient and found of the scale; used or off */
#ifndef REMODEL_LUX_SCALE_H
#define REMODEL_LUX_SCALE_H

#include <stdbool.h>

#include "common/base/provenance.h"

enum lux_source { LUX_UNKNOWN, LUX_EXPOSURE, LUX_MEASUREMENTS };
enum lux_kind { LUX_ILLUMINANCE, LUX_LUMINANCE };

struct lux_measurement {
    char *name; /* owned */
    enum lux_kind kind;
    double value, light;        /* lx or cd/m2; in the scene's unit */
    double expected, deviation; /* logarithms */
    bool off;                   /* disagrees with the others, and counts little */
};

struct lux_interval {
    double scale, low, high; /* cd/m2; 95 % */
};

/* {0} is the empty state; everything is owned. */
struct lux_scale {
    struct lux_interval is; /* 0: unknown */
    enum lux_source from;
    int photos;                      /* whose exposure is known */
    struct lux_interval by_exposure; /* 0 without them */
    struct lux_measurement *measurements;
    int count;
};

/* ST_DATA with file and line: a damaged line, a scale outside of its interval, or of 0 that is not unknown. */
enum status lux_scale_read(struct lux_scale *s, const char *path, struct provenance *prov, struct err *err);
enum status lux_scale_write(const struct lux_scale *s, const char *path, const struct provenance *prov,
                            struct err *err);
void lux_scale_release(struct lux_scale *s);

#endif
