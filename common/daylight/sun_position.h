/* sun_position.h - where the sun is in the sky, by place, date and time. */
#ifndef REMODEL_SUN_POSITION_H
#define REMODEL_SUN_POSITION_H

#define SUN_ANGULAR_RADIUS 0.2665 /* degrees, on average over the year */

struct sun_place {
    double latitude, longitude; /* degrees, positive in the north and in the east */
    double time_zone;           /* hours that clocks are ahead of UTC, without summer time */
};

struct sun_time {
    int year, month, day; /* Gregorian; month and day from 1 */
    double hour;          /* by the clock of the time zone; may be below 0 or beyond 24 */
};

struct sun_position {
    double altitude; /* of its centre, degrees, without refraction; negative at night */
    double azimuth;  /* degrees from north towards east, 0 to 360 */
    double distance; /* astronomical units */
};

/* To 0.02 degrees from 1950 to 2050. */
void sun_position_find(struct sun_position *sun, const struct sun_place *place, const struct sun_time *time);

/* Apparent geocentric coordinates in degrees, at a number of days since 2000-01-01 12:00 UTC. */
void sun_coordinates(double days, double *right_ascension, double *declination, double *distance);
/* Days since 2000-01-01 12:00 of a time in UTC. */
double sun_days(const struct sun_time *time);
/* The day's number in a year of 365 days, from 1; of February 29 that of March 1. */
int sun_day_of_year(int month, int day);
/* The date in a year of 365 days of a day's number, which may be any integer: it counts on around the year. */
void sun_date_of_day(int day_of_year, int *month, int *day);

#endif
