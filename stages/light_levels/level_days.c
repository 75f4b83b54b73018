/* level_days.c - see level_days.h. */
#include "stages/light_levels/level_days.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"

enum { YEAR = 2025, DAY = 24 };

enum status level_date_read(struct sun_time *date, const char *text, struct err *err)
{
    int known_month = 0, known_day = 0, end = 0;
    *date = (struct sun_time){.year = YEAR};
    if (sscanf(text, "%4d-%2d-%2d%n", &date->year, &date->month, &date->day, &end) != 3 || text[end]) {
        date->year = YEAR;
        if (sscanf(text, "%2d-%2d%n", &date->month, &date->day, &end) != 2 || text[end]) date->month = 0;
    }
    if (date->month >= 1 && date->month <= 12 && date->day >= 1 && date->day <= 31)
        sun_date_of_day(sun_day_of_year(date->month, date->day), &known_month, &known_day);
    if (!known_month || (known_day != date->day && !(date->month == 2 && date->day == 29)))
        return err_set(err, ST_USAGE, "--day %s: wanted a date such as 2026-12-21 or 12-21.", text);
    return ST_OK;
}

static bool has_day(const struct level_days *d, int month, int day)
{
    for (int i = 0; i < d->day_count; i++)
        if (d->days[i].month == month && d->days[i].day == day) return true;
    return false;
}

static enum status add_day(struct level_days *d, const struct state_list *states, const struct sun_time *date,
                           int per_hour, struct err *err)
{
    struct level_day *day = &d->days[d->day_count];
    if (has_day(d, date->month, date->day)) return ST_OK;
    *day = (struct level_day){date->month, date->day, d->hour_count, 0};
    for (int i = 0; i <= DAY * per_hour; i++) {
        struct level_hour hour = {.time = *date};
        hour.time.hour = (double)i / per_hour;
        sun_position_find(&hour.sun, &states->site, &hour.time);
        if (!(hour.sun.altitude > 0)) continue;
        if (array_append(&d->hours, (size_t)d->hour_count, sizeof *d->hours, "hours", err)) return err->status;
        d->hours[d->hour_count++] = hour;
    }
    day->count = d->hour_count - day->first;
    d->day_count++;
    return ST_OK;
}

enum status level_days_make(struct level_days *d, const struct state_list *states, const struct sun_time *more,
                            int per_hour, struct err *err)
{
    static const int dates[][2] = {{12, 21}, {3, 21}, {6, 21}};
    *d = (struct level_days){.day_count = 0};
    if (!states->has_site) return ST_OK;
    if (more && add_day(d, states, more, per_hour, err)) return err->status;
    for (int i = 0; !err->status && i < 3; i++) {
        const struct sun_time date = {.year = more ? more->year : YEAR, .month = dates[i][0], .day = dates[i][1]};
        add_day(d, states, &date, per_hour, err);
    }
    return err->status;
}

void level_days_release(struct level_days *d)
{
    free(d->hours);
    *d = (struct level_days){.day_count = 0};
}
