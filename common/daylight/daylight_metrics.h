/* daylight_metrics.h - what planners ask of daylight, from the illuminance of points in hour after hour of a year.
 *
 *   for (int k = 0; k < DAYLIGHT_HOURS; k++) {
 *       const struct daylight_hour hour = daylight_hour(k);   // sun, sky and illuminances of it
 *       for (int i = 0; i < count; i++) daylight_point_add(&points[i], total[i], direct[i]);
 *   }
 *   daylight_sum(&sum, points, areas, count);
 *
 * Illuminances are in lx. Hours are those of [IES 2012]: 8 to 18 o'clock of all 365 days, 3650 in a year, each by its
 * middle; clocks have no summer time. */
#ifndef REMODEL_DAYLIGHT_METRICS_H
#define REMODEL_DAYLIGHT_METRICS_H

#include "common/daylight/sun_position.h"

enum { DAYLIGHT_FROM = 8, DAYLIGHT_TO = 18, DAYLIGHT_DAYS = 365, DAYLIGHT_HOURS = 3650 };

#define DAYLIGHT_ENOUGH     300.0  /* lx: spatial daylight autonomy, sDA 300/50% */
#define DAYLIGHT_SHARE      0.5    /* of the hours */
#define DAYLIGHT_SUNLIT     1000.0 /* lx of direct sunlight: annual sunlight exposure, ASE 1000/250h */
#define DAYLIGHT_SUN_HOURS  250
#define DAYLIGHT_TOO_LITTLE 100.0 /* lx: useful daylight illuminance [Mardaljevic 2012] is between these two */
#define DAYLIGHT_TOO_MUCH   3000.0

/* Useful daylight illuminance: below 100 lx; 100 to 300, supplementary; 300 to 3000, autonomous; above. */
enum daylight_use { USE_FALLS_SHORT, USE_SUPPLEMENTARY, USE_AUTONOMOUS, USE_EXCEEDS, DAYLIGHT_USES };

/* One of the hours, by its number from 0; a year without a leap day. */
struct daylight_hour {
    int month, day;
    double middle; /* 8.5 to 17.5 */
};
struct daylight_hour daylight_hour(int number);
/* The same hour as a record of a weather file of 8760 hours that begins with January 1, 0 to 1 o'clock. */
int daylight_hour_of_year(int number);

/* The counts of a point; {0} is the empty state. */
struct daylight_point {
    int hours;  /* added */
    int enough; /* with at least DAYLIGHT_ENOUGH */
    int sunlit; /* with at least DAYLIGHT_SUNLIT of the sun alone */
    int sun;    /* with any light of the sun alone */
    int use[DAYLIGHT_USES];
    double sum; /* of illuminances: lx x hours */
};

/* An hour of a point: all its light, and what comes from the sun's disk without reflection. */
void daylight_point_add(struct daylight_point *p, double illuminance, double sun);

/* Of points that stand for areas; all are 0 without points or hours. */
struct daylight_sum {
    double sda;                /* part of the area with enough daylight in half of the hours */
    double ase;                /* part of the area with too much sun in more than 250 hours */
    double use[DAYLIGHT_USES]; /* mean part of the hours; they sum to 1 */
    double autonomy;           /* mean part of the hours with enough daylight */
    double sun_hours;          /* mean hours of sun of a year; as many as were added */
};
void daylight_sum(struct daylight_sum *s, const struct daylight_point *points, const double *areas, int count);

/* Illuminances of points at one time. */
struct daylight_spread {
    double mean, min, max;
    double uniformity; /* min / mean; 0 in the dark */
};
void daylight_spread(struct daylight_spread *s, const double *illuminance, const double *areas, int count);

/* The daylight factor in per cent: of a point below an overcast sky, and the horizontal illuminance outdoors. */
double daylight_factor(double indoors, double outdoors);

#endif
