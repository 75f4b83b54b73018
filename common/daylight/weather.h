/* weather.h - the hours of an EnergyPlus weather file (EPW): sun and sky at a place over a year. */
#ifndef REMODEL_WEATHER_H
#define REMODEL_WEATHER_H

#include "common/base/provenance.h"
#include "common/daylight/sky_luminance.h"

struct weather_hour {
    struct sun_time middle; /* of the hour that the record describes, by the clock of the place */
    struct sky_weather sky; /* irradiances are 0 where the file has none */
};

/* {0} is the empty state; everything is owned. */
struct weather {
    char *place; /* city and country */
    struct sun_place at;
    double elevation; /* m above the sea */
    struct weather_hour *hours;
    int count;
    int missing; /* hours without one of their irradiances */
};

/* Reads a file with one record an hour; a year has 8760, but fewer are allowed. ST_DATA with file and line: no weather
 * file, a damaged field, several records an hour, no irradiance at all. */
enum status weather_read(struct weather *w, const char *path, struct provenance *prov, struct err *err);
void weather_release(struct weather *w);

#endif
