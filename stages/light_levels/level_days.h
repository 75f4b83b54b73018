/* level_days.h - the hours of some days, with the sun at each. */
#ifndef REMODEL_LEVEL_DAYS_H
#define REMODEL_LEVEL_DAYS_H

#include "stages/light_levels/level_sums.h"

enum { LEVEL_COVERS = 3, LEVEL_DAYS_MOST = 4 }; /* covers: enum sky_cover */

struct level_hour {
    struct sun_time time;
    struct sun_position sun; /* above the horizon */
};

/* {0} is the empty state; everything is owned. */
struct level_days {
    struct level_day {
        int month, day, first, count; /* of its hours */
    } days[LEVEL_DAYS_MOST];
    struct level_hour *hours; /* with the sun above the horizon */
    int day_count, hour_count;
};

/* A date, YYYY-MM-DD or MM-DD. ST_USAGE: another text, or a day that the month does not have. */
enum status level_date_read(struct sun_time *date, const char *text, struct err *err);

/* The solstices, the equinox of March and `more` (NULL: none), every 60 / per_hour minutes. Without a site there are
 * none. The caller releases d in each case. ST_NOMEM. */
enum status level_days_make(struct level_days *d, const struct state_list *states, const struct sun_time *more,
                            int per_hour, struct err *err);
void level_days_release(struct level_days *d);

#endif
