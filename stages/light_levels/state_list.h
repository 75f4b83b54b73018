/* state_list.h - scenes/NAME/states.txt: states of lamps and sky for which light is computed, and planned lamps.
 *
 *   remodel-states 1
 *   site LATITUDE LONGITUDE ZONE [north DEGREES]     before states that need the sun
 *   lamp NAME ies FILE.ies at X Y Z ...              a planned lamp (planned_lamps.h), before states that name it
 *   measured LUX at PLACE in STATE [within PERCENT]  a lux-meter at a place of places.txt, in a state above
 *   photo PHOTO in STATE [exposed FACTOR]            the photo was taken in that state, not as the others
 *   state NAME [lamps on|off] [lamp NAME FACTOR]... [sky SKY] [blind WINDOW PART]...
 *
 * ZONE: hours that clocks are ahead of UTC. DEGREES: the azimuth of north in the model's frame, from x towards y (90
 * without it: the y axis points north). SKY is
 *   none                                it is night (also without `sky`)
 *   photographed                        as in the photographs
 *   overcast LUX                        the overcast sky of daylight factors, with this horizontal illuminance
 *   clear|partly|cloudy MONTH DAY HOUR  the usual sky at that time, by the clock of the zone
 *   weather MONTH DAY HOUR              that of the weather file in the hour that this time is in
 * Lamps of the photographs are on unless a state says otherwise, planned ones off; `lamp` multiplies one by FACTOR.
 * `blind` multiplies what comes through a window, sky and sun, by PART of 0 to 1. */
#ifndef REMODEL_LEVELS_STATE_LIST_H
#define REMODEL_LEVELS_STATE_LIST_H

#include "common/base/provenance.h"
#include "common/daylight/sky_luminance.h"
#include "common/daylight/weather.h"
#include "common/relight/planned_lamps.h"

enum state_sky { STATE_SKY_NONE, STATE_SKY_PHOTOGRAPHED, STATE_SKY_OVERCAST, STATE_SKY_TIME, STATE_SKY_WEATHER };

struct state_factor {
    char *name; /* owned */
    double factor;
};

struct light_state {
    char *name; /* owned */
    bool lamps; /* those that are not named */
    struct state_factor *named;
    int named_count;
    struct state_factor *blinds; /* of windows */
    int blind_count;
    enum state_sky sky;
    double horizontal;    /* lx, of STATE_SKY_OVERCAST */
    enum sky_cover cover; /* of STATE_SKY_TIME */
    struct sun_time time;
    struct sky_weather weather; /* of STATE_SKY_WEATHER, once state_list_take_weather() found it */
    struct sun_place place;
    int line; /* 0: not from a file */
};

/* What somebody measured in a state of switches. */
struct state_measured {
    char *place;        /* owned */
    int state;          /* its number */
    double lux, within; /* within: relative, of 95 % */
    int line;
};

/* A photo that was taken in a state of switches. */
struct state_photo {
    char *name;     /* owned */
    int state;      /* its number */
    double exposed; /* times as the others; 0: unknown */
    int line;
};

/* {0} is the empty state; everything is owned. */
struct state_list {
    char *path; /* NULL: those that every scene has */
    struct light_state *items;
    int count;
    bool has_site;
    struct sun_place site;
    double north; /* degrees in the model's frame */
    struct planned_lamps planned;
    struct state_measured *measured;
    int measured_count;
    struct state_photo *photos;
    int photo_count;
};

/* The states that every scene has, and those of a file; path NULL: no file. The first four are photographed, lamps,
 * daylight and overcast. ST_DATA with file and line. A failure leaves the list empty. */
enum { STATE_OVERCAST = 3, STATES_OF_EVERY_SCENE = 4 };
#define STATE_OVERCAST_LUX 10000.0
enum status state_list_read(struct state_list *l, const char *path, struct provenance *prov, struct err *err);
/* The states that every scene has, and a last one by the words that follow `state NAME`, which may be of an hour
 * without a site. ST_DATA: other words. */
enum status state_list_read_words(struct state_list *l, const char *words, struct err *err);
/* Adds the state `edit-lamps`, in which the lamps of an edit shine alone. */
enum status state_list_add_edit_lamps(struct state_list *l, struct err *err);
const struct light_state *state_list_find(const struct state_list *l, const char *name); /* NULL: not found */
void state_list_release(struct state_list *l);

/* Gives states their weather; weather may be NULL. ST_DATA with file and line: a state whose hour it does not have. */
enum status state_list_take_weather(struct state_list *l, const struct weather *weather, struct err *err);

#endif
