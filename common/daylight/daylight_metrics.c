/* daylight_metrics.c - what planners ask of daylight.
 *
 * [IES 2012]: spatial daylight autonomy, sDA 300/50%, is the part of an area that has at least 300 lx in at least half
 * of the hours from 8 to 18 o'clock; annual sunlight exposure, ASE 1000/250h, the part that has at least 1000 lx of
 * direct sunlight, without any reflection, in more than 250 of them. [Mardaljevic 2012]: useful daylight illuminance,
 * the hours by what their light is good for. Counts are kept by point, so that a year needs no memory of its hours.
 *
 * What differs from the source: clocks keep the time zone's standard time all year, and blinds stay open. */
#include "common/daylight/daylight_metrics.h"

#include <math.h>

enum { HOURS_A_DAY = DAYLIGHT_TO - DAYLIGHT_FROM };

struct daylight_hour daylight_hour(int number)
{
    struct daylight_hour h = {.middle = DAYLIGHT_FROM + number % HOURS_A_DAY + 0.5};
    sun_date_of_day(number / HOURS_A_DAY + 1, &h.month, &h.day);
    return h;
}

int daylight_hour_of_year(int number) { return number / HOURS_A_DAY * 24 + DAYLIGHT_FROM + number % HOURS_A_DAY; }

void daylight_point_add(struct daylight_point *p, double illuminance, double sun)
{
    p->hours++;
    p->enough += illuminance >= DAYLIGHT_ENOUGH;
    p->sunlit += sun >= DAYLIGHT_SUNLIT;
    p->sun += sun > 0;
    p->use[illuminance < DAYLIGHT_TOO_LITTLE  ? USE_FALLS_SHORT
           : illuminance < DAYLIGHT_ENOUGH    ? USE_SUPPLEMENTARY
           : illuminance <= DAYLIGHT_TOO_MUCH ? USE_AUTONOMOUS
                                              : USE_EXCEEDS]++;
    p->sum += illuminance;
}

void daylight_sum(struct daylight_sum *s, const struct daylight_point *points, const double *areas, int count)
{
    double whole = 0;
    *s = (struct daylight_sum){0};
    for (int i = 0; i < count; i++) {
        const struct daylight_point *p = &points[i];
        if (!p->hours) continue;
        const double area = areas ? areas[i] : 1;
        whole += area;
        s->sda += area * (p->enough >= DAYLIGHT_SHARE * p->hours);
        s->ase += area * (p->sunlit > DAYLIGHT_SUN_HOURS);
        s->autonomy += area * p->enough / p->hours;
        s->sun_hours += area * p->sun;
        for (int k = 0; k < DAYLIGHT_USES; k++) s->use[k] += area * p->use[k] / p->hours;
    }
    if (!(whole > 0)) return;
    s->sda /= whole;
    s->ase /= whole;
    s->autonomy /= whole;
    s->sun_hours /= whole;
    for (int k = 0; k < DAYLIGHT_USES; k++) s->use[k] /= whole;
}

void daylight_spread(struct daylight_spread *s, const double *illuminance, const double *areas, int count)
{
    double whole = 0, sum = 0;
    *s = (struct daylight_spread){0};
    for (int i = 0; i < count; i++) {
        const double area = areas ? areas[i] : 1;
        whole += area;
        sum += area * illuminance[i];
        s->min = i ? fmin(s->min, illuminance[i]) : illuminance[i];
        s->max = fmax(s->max, illuminance[i]);
    }
    s->mean = whole > 0 ? sum / whole : 0;
    s->uniformity = s->mean > 0 ? s->min / s->mean : 0;
}

double daylight_factor(double indoors, double outdoors) { return outdoors > 0 ? 100 * indoors / outdoors : 0; }
