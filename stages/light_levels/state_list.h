/* state_list.h - scenes/NAME/states.txt: states of lamps and sky for which light is computed.
 *
 *   remodel-states 1
 *   site LATITUDE LONGITUDE ZONE [north DEGREES]     before states that need the sun
 *   state NAME [lamps on|off] [lamp NAME FACTOR]... [sky SKY]
 *
 * ZONE: hours that clocks are ahead of UTC. DEGREES: the azimuth of north in the model's frame, from x towards y (90
 * without it: the y axis points north). SKY is
 *   none                                it is night (also without `sky`)
 *   photographed                        as in the photographs
 *   overcast LUX                        the overcast sky of daylight factors, with this horizontal illuminance
 *   clear|partly|cloudy MONTH DAY HOUR  the usual sky at that time, by the clock of the zone
 * Lamps are on unless a state says otherwise; `lamp` multiplies one by FACTOR. */
#ifndef REMODEL_LEVELS_STATE_LIST_H
#define REMODEL_LEVELS_STATE_LIST_H

#include "common/base/provenance.h"
#include "common/daylight/sky_luminance.h"

enum state_sky { STATE_SKY_NONE, STATE_SKY_PHOTOGRAPHED, STATE_SKY_OVERCAST, STATE_SKY_TIME };

struct state_lamp {
    char *name; /* owned */
    double factor;
};

struct light_state {
    char *name; /* owned */
    bool lamps; /* those that are not named */
    struct state_lamp *named;
    int named_count;
    enum state_sky sky;
    double horizontal;    /* lx, of STATE_SKY_OVERCAST */
    enum sky_cover cover; /* of STATE_SKY_TIME */
    struct sun_time time;
    int line; /* 0: not from a file */
};

/* {0} is the empty state; everything is owned. */
struct state_list {
    char *path; /* NULL: those that every scene has */
    struct light_state *items;
    int count;
    bool has_site;
    struct sun_place site;
    double north; /* degrees in the model's frame */
};

/* The states that every scene has, and those of a file; path NULL: no file. The first four are photographed, lamps,
 * daylight and overcast. ST_DATA with file and line. A failure leaves the list empty. */
enum { STATE_OVERCAST = 3, STATES_OF_EVERY_SCENE = 4 };
#define STATE_OVERCAST_LUX 10000.0
enum status state_list_read(struct state_list *l, const char *path, struct provenance *prov, struct err *err);
void state_list_release(struct state_list *l);

#endif
