/* weather.c - the hours of an EnergyPlus weather file.
 *
 * A file has lines of fields with commas between them [EnergyPlus 2019, chapter 2]: LOCATION with the place, some more
 * of a header, DATA PERIODS with the number of records an hour, then the records. Hour 1 of a record is that from 0:00
 * to 1:00, without summer time; irradiances are sums over it, so that the sun's place in its middle belongs to them. A
 * field that is not known has a large number: 9999 for irradiances, 99.9 for the dew point. */
#include "common/daylight/weather.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"

enum { FIELDS = 16, LOCATION_FIELDS = 10, HOURS_MAX = 8784 };
enum { YEAR, MONTH, DAY, HOUR, DEW_POINT = 7, DIRECT_NORMAL = 14, DIFFUSE_HORIZONTAL };

static const double NO_IRRADIANCE = 9999, NO_DEW_POINT = 99.9;

/* Cuts the line at its commas; the fields' blanks are dropped. Returns how many there are, at most `most`. */
static int cut_fields(char *line, char **fields, int most)
{
    int count = 0;
    for (char *p = line; p && count < most; count++) {
        char *comma = strchr(p, ',');
        if (comma) *comma = '\0';
        while (*p == ' ' || *p == '\t') p++;
        for (char *end = p + strlen(p); end > p && (end[-1] == ' ' || end[-1] == '\t');) *--end = '\0';
        fields[count] = p;
        p = comma ? comma + 1 : NULL;
    }
    return count;
}

static enum status read_location(struct weather *w, struct textfile *t, struct err *err)
{
    char *f[LOCATION_FIELDS];
    static const char wanted[] = "a line LOCATION,CITY,STATE,COUNTRY,SOURCE,NUMBER,LATITUDE,LONGITUDE,TIME ZONE,"
                                 "ELEVATION, with which an EnergyPlus weather file (.epw) begins";
    if (!textfile_next(t)) return textfile_error(t, err, NULL, wanted);
    const int count = cut_fields(t->cursor, f, LOCATION_FIELDS);
    if (strcmp(f[0], "LOCATION")) return textfile_error(t, err, f[0], wanted);
    if (count < LOCATION_FIELDS) return textfile_error(t, err, NULL, wanted);
    if (textfile_number_of(t, f[6], "the latitude in degrees", -90, 90, &w->at.latitude, err) ||
        textfile_number_of(t, f[7], "the longitude in degrees, positive in the east", -180, 180, &w->at.longitude,
                           err) ||
        textfile_number_of(t, f[8], "the time zone in hours ahead of UTC", -12, 14, &w->at.time_zone, err) ||
        textfile_number_of(t, f[9], "the elevation in metres", -1000, 9999.9, &w->elevation, err))
        return err->status;
    const size_t size = strlen(f[1]) + strlen(f[3]) + 3;
    if (!(w->place = malloc(size))) return err_nomem(err, "a place", size);
    snprintf(w->place, size, "%s%s%s", f[1], *f[1] && *f[3] ? ", " : "", f[3]);
    return ST_OK;
}

/* Skips the header up to its last line. */
static enum status read_periods(struct textfile *t, struct err *err)
{
    static const char wanted[] = "a line DATA PERIODS,NUMBER,RECORDS AN HOUR, after which the hours follow";
    char *f[3];
    double per_hour;
    while (textfile_next(t)) {
        const int count = cut_fields(t->cursor, f, 3);
        if (strcmp(f[0], "DATA PERIODS")) continue;
        if (count < 3) return textfile_error(t, err, NULL, wanted);
        if (textfile_number_of(t, f[2], "the number of records an hour", 1, 60, &per_hour, err)) return err->status;
        return per_hour > 1 ? textfile_error(t, err, f[2], "1 record an hour; convert the file to hours") : ST_OK;
    }
    return textfile_error(t, err, NULL, wanted);
}

static enum status whole_number(struct textfile *t, const char *word, const char *what, int min, int max, int *value,
                                struct err *err)
{
    int64_t v;
    if (!scan_int(word, &v) || v < min || v > max)
        return textfile_error(t, err, word, "%s, an integer from %d to %d", what, min, max);
    *value = (int)v;
    return ST_OK;
}

/* An irradiance; 0 and missing if the file has none. */
static enum status irradiance(struct textfile *t, const char *word, const char *what, double *value, bool *missing,
                              struct err *err)
{
    if (!*word) {
        *value = NO_IRRADIANCE;
    } else if (textfile_number_of(t, word, what, -9999, 1e6, value, err)) {
        return err->status;
    }
    if (*value >= 0 && *value < NO_IRRADIANCE) return ST_OK;
    *missing = true;
    *value = 0;
    return ST_OK;
}

static enum status read_hour(struct weather *w, struct textfile *t, struct err *err)
{
    char *f[FIELDS];
    struct weather_hour h = {.sky.dew_point = DEW_POINT_TYPICAL};
    int hour = 0;
    bool missing = false;
    if (cut_fields(t->cursor, f, FIELDS) < FIELDS)
        return textfile_error(t, err, NULL,
                              "a record of at least 16 fields: YEAR,MONTH,DAY,HOUR,MINUTE,FLAGS, then ten measured "
                              "values, the last of them direct normal and diffuse horizontal irradiance");
    if (w->count == HOURS_MAX)
        return textfile_error(t, err, f[0], "at most 8784 hours, one year; keep one year of the file");
    if (whole_number(t, f[YEAR], "the year", 1, 9999, &h.middle.year, err) ||
        whole_number(t, f[MONTH], "the month", 1, 12, &h.middle.month, err) ||
        whole_number(t, f[DAY], "the day of the month", 1, 31, &h.middle.day, err) ||
        whole_number(t, f[HOUR], "the hour", 1, 24, &hour, err) ||
        irradiance(t, f[DIRECT_NORMAL], "the direct normal irradiance in W/m2 (field 15)", &h.sky.direct_normal,
                   &missing, err) ||
        irradiance(t, f[DIFFUSE_HORIZONTAL], "the diffuse horizontal irradiance in W/m2 (field 16)",
                   &h.sky.diffuse_horizontal, &missing, err))
        return err->status;
    if (*f[DEW_POINT]) {
        double dew_point;
        if (textfile_number_of(t, f[DEW_POINT], "the dew point in degrees Celsius (field 8)", -99, 9999, &dew_point,
                               err))
            return err->status;
        if (dew_point < NO_DEW_POINT) h.sky.dew_point = dew_point;
    }
    h.middle.hour = hour - 0.5;
    w->missing += missing;
    if (array_append(&w->hours, (size_t)w->count, sizeof *w->hours, "hours", err)) return err->status;
    w->hours[w->count++] = h;
    return ST_OK;
}

enum status weather_read(struct weather *w, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    *w = (struct weather){0};
    if (!provenance_open(prov, "weather", &t, path, err) && !read_location(w, &t, err)) read_periods(&t, err);
    while (!err->status && textfile_next(&t)) read_hour(w, &t, err);
    if (!err->status && !w->count) textfile_error(&t, err, NULL, "a record of an hour");
    if (!err->status && w->missing == w->count)
        err_set(err, ST_DATA,
                "%s: none of its %d hours has direct normal and diffuse horizontal irradiance; take a file that has "
                "them.",
                path, w->count);
    textfile_release(&t);
    if (err->status) weather_release(w);
    return err->status;
}

void weather_release(struct weather *w)
{
    free(w->place);
    free(w->hours);
    *w = (struct weather){0};
}
