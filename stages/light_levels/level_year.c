/* level_year.c - see level_year.h.
 *
 * Each hour has the sky of its irradiances [Perez 1993] and the sun where it is in the middle of the hour. What the sky
 * and reflected sun bring is a sum over groups; the sun's direct light is a ray from the point. Blinds are not
 * drawn.
 *
 * Years of rooms that are brighter and darker by the error of the model are counted beside it. That error is mostly
 * one for a whole room, a wall too dark or a window too large, so all hours and points are multiplied by the same
 * factor. */
#include "stages/light_levels/level_year.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/parallel.h"

enum { DAY = 24 };

/* The record of each hour of a year of 365 days; -1: none. */
static void index_hours(int of_hour[DAYLIGHT_DAYS * DAY], const struct weather *w)
{
    for (int i = 0; i < DAYLIGHT_DAYS * DAY; i++) of_hour[i] = -1;
    for (int i = 0; i < w->count; i++) {
        const struct sun_time *t = &w->hours[i].middle;
        if (t->hour < 0 || t->hour >= DAY || (t->month == 2 && t->day == 29)) continue;
        of_hour[(sun_day_of_year(t->month, t->day) - 1) * DAY + (int)t->hour] = i;
    }
}

const double level_year_sigmas[LEVEL_YEARS] = {0, -1.959964, -1, 1, 1.959964};

struct hour_job {
    const struct level_points *points;
    const struct level_light *light;
    const struct state_weights *w;
    struct daylight_point *counts;
    double factors[LEVEL_YEARS];
};

static void count_some(void *ctx, size_t begin, size_t end, int thread)
{
    const struct hour_job *j = ctx;
    const struct model_field *field = j->light->groups.field;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        const struct gather_point p = j->points->points[i];
        double sums[2], sun = 0;
        level_points_sum(sums, j->points, (int)i, j->w, NULL);
        if (j->w->sun > 0 && rows_sees_sun(field, p, j->w->to_sun)) sun = j->w->sun * vec3_dot(p.normal, j->w->to_sun);
        for (int k = 0; k < LEVEL_YEARS; k++)
            daylight_point_add(&j->counts[(size_t)k * (size_t)j->points->count + i], j->factors[k] * (sums[1] + sun),
                               j->factors[k] * sun);
    }
}

enum status level_year_count(struct daylight_point *counts, int *hours, const struct level_points *points,
                             const struct level_light *light, const struct weather *weather, double north,
                             const struct levels_params *params, struct err *err)
{
    int of_hour[DAYLIGHT_DAYS * DAY];
    struct state_weights w = {0};
    const size_t size = (size_t)light->groups.count * sizeof *w.absolute;
    *hours = 0;
    memset(counts, 0, LEVEL_YEARS * (size_t)points->count * sizeof *counts);
    index_hours(of_hour, weather);
    level_weights_init(&w, &light->groups, err);
    for (int k = 0; !err->status && k < DAYLIGHT_HOURS; k++) {
        const struct daylight_hour hour = daylight_hour(k);
        const int record = of_hour[(sun_day_of_year(hour.month, hour.day) - 1) * DAY + (int)hour.middle];
        struct hour_job j = {points, light, &w, counts, {0}};
        struct sun_position sun;
        if (record < 0) continue;
        for (int i = 0; i < LEVEL_YEARS; i++)
            j.factors[i] = exp(level_year_sigmas[i] * hypot(params->error, params->sky_error));
        memset(w.absolute, 0, size);
        sun_position_find(&sun, &weather->at, &weather->hours[record].middle);
        const struct sky_luminance sky = sky_from_weather(&weather->hours[record].sky, &sun, north, params->ground);
        level_weights_add_sky(&w, &sky, &light->groups, params);
        parallel_for((size_t)points->count, 16, count_some, &j);
        ++*hours;
    }
    level_weights_release(&w);
    if (!err->status && !*hours)
        err_set(err, ST_DATA, "the weather file has no hour from %d to %d o'clock; give one of a whole year.",
                DAYLIGHT_FROM, DAYLIGHT_TO);
    return err->status;
}
