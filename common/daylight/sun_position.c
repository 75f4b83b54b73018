/* sun_position.c - where the sun is.
 *
 * Overview. The sun's longitude on the ecliptic follows from its mean longitude and the ellipse of the earth's orbit.
 * Obliquity turns it into right ascension and declination, and the sidereal time of the place into altitude and
 * azimuth.
 *
 * Mathematics. [Meeus 1998]: chapter 7, the number of the day; chapter 12, mean sidereal time (12.4); chapter 25, the
 * sun's coordinates with low accuracy, 0.01 degrees, nutation and aberration included; chapter 13, altitude and
 * azimuth.
 *
 * What differs from the source: dynamical time is taken as UTC, a difference of about a minute, in which the sun moves
 * by 0.0008 degrees in declination; parallax, at most 0.0024 degrees, and refraction, half a degree at the horizon, are
 * left out. */
#include "common/daylight/sun_position.h"

#include <math.h>

#include "common/math/numbers.h"

static double wrapped(double degrees) { return degrees - 360 * floor(degrees / 360); }

double sun_days(const struct sun_time *t)
{
    const int y = t->month > 2 ? t->year : t->year - 1, m = t->month > 2 ? t->month : t->month + 12;
    const double century = floor(y / 100.0), gregorian = 2 - century + floor(century / 4);
    return floor(365.25 * (y + 4716)) + floor(30.6001 * (m + 1)) + t->day + gregorian - 1524.5 + t->hour / 24 - 2451545;
}

void sun_coordinates(double days, double *right_ascension, double *declination, double *distance)
{
    const double t = days / 36525; /* centuries */
    const double mean_longitude = 280.46646 + t * (36000.76983 + t * 0.0003032);
    const double anomaly = (357.52911 + t * (35999.05029 - t * 0.0001537)) * DEGREE;
    const double eccentricity = 0.016708634 - t * (0.000042037 + t * 0.0000001267);
    const double centre = (1.914602 - t * (0.004817 + t * 0.000014)) * sin(anomaly) +
                          (0.019993 - t * 0.000101) * sin(2 * anomaly) + 0.000289 * sin(3 * anomaly);
    const double true_anomaly = anomaly + centre * DEGREE;
    const double node = (125.04 - 1934.136 * t) * DEGREE;
    const double longitude = (mean_longitude + centre - 0.00569 - 0.00478 * sin(node)) * DEGREE;
    const double mean_obliquity = 23.4392911 - t * (0.0130041667 + t * (1.639e-7 - t * 5.036e-7));
    const double obliquity = (mean_obliquity + 0.00256 * cos(node)) * DEGREE;
    *right_ascension = wrapped(atan2(cos(obliquity) * sin(longitude), cos(longitude)) / DEGREE);
    *declination = asin(sin(obliquity) * sin(longitude)) / DEGREE;
    *distance = 1.000001018 * (1 - eccentricity * eccentricity) / (1 + eccentricity * cos(true_anomaly));
}

void sun_position_find(struct sun_position *sun, const struct sun_place *place, const struct sun_time *time)
{
    const double days = sun_days(time) - place->time_zone / 24, t = days / 36525;
    const double sidereal = 280.46061837 + 360.98564736629 * days + t * t * (0.000387933 - t / 38710000);
    double right_ascension, declination;
    sun_coordinates(days, &right_ascension, &declination, &sun->distance);
    const double hour = wrapped(sidereal + place->longitude - right_ascension) * DEGREE;
    const double north = place->latitude * DEGREE, d = declination * DEGREE;
    sun->altitude = asin(clamp(sin(north) * sin(d) + cos(north) * cos(d) * cos(hour), -1, 1)) / DEGREE;
    sun->azimuth =
        wrapped(180 + atan2(sin(hour) * cos(d), cos(hour) * cos(d) * sin(north) - sin(d) * cos(north)) / DEGREE);
}

static const int before_month[13] = {0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334, 365};

int sun_day_of_year(int month, int day) { return before_month[month - 1] + day; }

void sun_date_of_day(int day_of_year, int *month, int *day)
{
    const int over = (day_of_year - 1) % 365, from0 = over < 0 ? over + 365 : over;
    *month = 1;
    while (before_month[*month] <= from0) ++*month;
    *day = from0 - before_month[*month - 1] + 1;
}
