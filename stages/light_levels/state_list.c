/* state_list.c - see state_list.h. */
#include "stages/light_levels/state_list.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"

static const double BRIGHTEST = 1e6, LEAST_LUX = 0.01, MOST_FACTOR = 1000; /* lx */
static const double USUAL_WITHIN = 0.05, LEAST_EXPOSED = 1e-6; /* of a lux-meter; of a photo beside others */
enum { YEAR = 2025 };                                          /* of times, which have none: no leap year */

static void release_state(struct light_state *s)
{
    for (int i = 0; i < s->named_count; i++) free(s->named[i].name);
    for (int i = 0; i < s->blind_count; i++) free(s->blinds[i].name);
    free(s->named);
    free(s->blinds);
    free(s->name);
}

void state_list_release(struct state_list *l)
{
    for (int i = 0; i < l->count; i++) release_state(&l->items[i]);
    for (int i = 0; i < l->measured_count; i++) free(l->measured[i].place);
    for (int i = 0; i < l->photo_count; i++) free(l->photos[i].name);
    free(l->photos);
    planned_lamps_release(&l->planned);
    free(l->measured);
    free(l->items);
    free(l->path);
    *l = (struct state_list){0};
}

/* ------------------------------------------------------------------------------------------------------- statements */

static enum status read_site(struct state_list *l, struct textfile *t, struct err *err)
{
    if (textfile_number(t, "a latitude in degrees", -90, 90, &l->site.latitude, err) ||
        textfile_number(t, "a longitude in degrees", -180, 180, &l->site.longitude, err) ||
        textfile_number(t, "hours ahead of UTC", -14, 14, &l->site.time_zone, err))
        return err->status;
    l->has_site = true;
    if (!textfile_more(t)) return ST_OK;
    if (textfile_expect(t, "north", err)) return err->status;
    return textfile_number(t, "the azimuth of north in degrees", -360, 360, &l->north, err);
}

/* A name and a factor up to `most`. */
static enum status read_factor(struct state_factor **list, int *count, struct textfile *t, const char *what,
                               double most, struct err *err)
{
    char *word;
    if (textfile_word(t, what, &word, err) || array_append(list, (size_t)*count, sizeof **list, "factors", err))
        return err->status;
    struct state_factor *f = &(*list)[*count];
    f->name = strdup(word);
    if (!f->name) return err_nomem(err, "a name", strlen(word));
    ++*count;
    return textfile_number(t, "a factor", 0, most, &f->factor, err);
}

static enum status read_time(struct light_state *s, const struct state_list *l, struct textfile *t, struct err *err)
{
    int64_t month, day;
    if (!l->has_site && s->sky != STATE_SKY_WEATHER)
        return textfile_error(t, err, "a sky at a time",
                              "the line `site LATITUDE LONGITUDE ZONE` above it, which says where the sun is");
    if (textfile_int(t, "a month", 1, 12, &month, err) || textfile_int(t, "a day", 1, 31, &day, err) ||
        textfile_number(t, "an hour", 0, 24, &s->time.hour, err))
        return err->status;
    int known_month, known_day;
    sun_date_of_day(sun_day_of_year((int)month, (int)day), &known_month, &known_day);
    if (known_month != month || known_day != day)
        return textfile_wrong_number(t, (double)day, "a day that this month has", err);
    s->time.year = YEAR;
    s->time.month = (int)month;
    s->time.day = (int)day;
    return ST_OK;
}

static enum status read_sky(struct light_state *s, const struct state_list *l, struct textfile *t, struct err *err)
{
    static const char *const covers[] = {
        [SKY_COVER_CLEAR] = "clear", [SKY_COVER_PARTLY] = "partly", [SKY_COVER_OVERCAST] = "cloudy"};
    char *word;
    if (textfile_word(t, "a sky", &word, err)) return err->status;
    s->sky = STATE_SKY_NONE;
    if (!strcmp(word, "none")) return ST_OK;
    if (!strcmp(word, "photographed")) {
        s->sky = STATE_SKY_PHOTOGRAPHED;
        return ST_OK;
    }
    if (!strcmp(word, "overcast")) {
        s->sky = STATE_SKY_OVERCAST;
        return textfile_number(t, "an illuminance in lx", 0, BRIGHTEST, &s->horizontal, err);
    }
    for (int i = 0; i < 3; i++)
        if (!strcmp(word, covers[i])) {
            s->sky = STATE_SKY_TIME;
            s->cover = (enum sky_cover)i;
            return read_time(s, l, t, err);
        }
    if (!strcmp(word, "weather")) {
        s->sky = STATE_SKY_WEATHER;
        return read_time(s, l, t, err);
    }
    return textfile_error(t, err, word,
                          "none, photographed, overcast LUX, or clear, partly, cloudy or weather with MONTH DAY HOUR");
}

static enum status read_lamps(struct light_state *s, struct textfile *t, struct err *err)
{
    char *word;
    if (textfile_word(t, "on or off", &word, err)) return err->status;
    s->lamps = !strcmp(word, "on");
    return s->lamps || !strcmp(word, "off") ? ST_OK : textfile_error(t, err, word, "on or off");
}

static bool has_name(const struct state_list *l, const char *name)
{
    for (int i = 0; i < l->count; i++)
        if (!strcmp(l->items[i].name, name)) return true;
    return false;
}

static enum status begin_state(struct state_list *l, const char *name, struct err *err)
{
    if (array_append(&l->items, (size_t)l->count, sizeof *l->items, "states", err)) return err->status;
    l->items[l->count] = (struct light_state){.name = strdup(name), .lamps = true};
    if (!l->items[l->count].name) return err_nomem(err, "a name", strlen(name));
    l->count++;
    return ST_OK;
}

/* Of the last state. */
static enum status read_options(struct state_list *l, struct textfile *t, struct err *err)
{
    struct light_state *s = &l->items[l->count - 1];
    char *word;
    s->line = t->line;
    while (!err->status && textfile_more(t)) {
        if (textfile_word(t, "an option", &word, err)) break;
        if (!strcmp(word, "lamps"))
            read_lamps(s, t, err);
        else if (!strcmp(word, "lamp"))
            read_factor(&s->named, &s->named_count, t, "a lamp's name", MOST_FACTOR, err);
        else if (!strcmp(word, "sky"))
            read_sky(s, l, t, err);
        else if (!strcmp(word, "blind"))
            read_factor(&s->blinds, &s->blind_count, t, "a window's name", 1, err);
        else
            textfile_error(t, err, word, "lamps on|off, lamp NAME FACTOR, sky SKY or blind WINDOW PART");
    }
    return err->status;
}

static enum status read_state(struct state_list *l, struct textfile *t, struct err *err)
{
    char *word;
    if (textfile_word(t, "a state's name", &word, err)) return err->status;
    if (!scan_is_name(word))
        return textfile_error(t, err, word, "a name of letters, digits, _ and -, which does not begin with -");
    if (has_name(l, word)) return textfile_error(t, err, word, "a name that no other state has");
    return begin_state(l, word, err) ? err->status : read_options(l, t, err);
}

/* The number of a state that stands above. */
static enum status read_state_name(int *state, const struct state_list *l, struct textfile *t, struct err *err)
{
    char *word;
    *state = 0;
    if (textfile_expect(t, "in", err) || textfile_word(t, "a state's name", &word, err)) return err->status;
    while (*state < l->count && strcmp(l->items[*state].name, word) != 0) ++*state;
    return *state < l->count ? ST_OK : textfile_error(t, err, word, "a state of every scene or of a line above");
}

static enum status read_photo(struct state_list *l, struct textfile *t, struct err *err)
{
    char *word;
    if (array_append(&l->photos, (size_t)l->photo_count, sizeof *l->photos, "photos", err)) return err->status;
    struct state_photo *p = &l->photos[l->photo_count++];
    *p = (struct state_photo){.line = t->line};
    if (textfile_word(t, "a photo's name", &word, err)) return err->status;
    if (!(p->name = strdup(word))) return err_nomem(err, "a name", strlen(word));
    if (!scan_is_photo_name(word))
        return textfile_error(t, err, word, "the name of a photo, without the ending of its file");
    for (int i = 0; i + 1 < l->photo_count; i++)
        if (!strcmp(l->photos[i].name, word)) return textfile_error(t, err, word, "a photo that no line above names");
    if (read_state_name(&p->state, l, t, err) || !textfile_more(t)) return err->status;
    if (textfile_expect(t, "exposed", err) || textfile_number(t, "how often as bright it is exposed as the others",
                                                              LEAST_EXPOSED, 1 / LEAST_EXPOSED, &p->exposed, err))
        return err->status;
    return textfile_end(t, err);
}

static enum status read_measured(struct state_list *l, struct textfile *t, struct err *err)
{
    char *word;
    if (array_append(&l->measured, (size_t)l->measured_count, sizeof *l->measured, "measurements", err))
        return err->status;
    struct state_measured *m = &l->measured[l->measured_count++];
    *m = (struct state_measured){.within = USUAL_WITHIN, .line = t->line};
    if (textfile_number(t, "an illuminance in lx", LEAST_LUX, BRIGHTEST, &m->lux, err) ||
        textfile_expect(t, "at", err) || textfile_word(t, "a place of places.txt", &word, err))
        return err->status;
    if (!(m->place = strdup(word))) return err_nomem(err, "a name", strlen(word));
    if (read_state_name(&m->state, l, t, err)) return err->status;
    if (!textfile_more(t)) return ST_OK;
    if (textfile_expect(t, "within", err) || textfile_number(t, "per cent", 0.1, 100, &m->within, err))
        return err->status;
    m->within /= 100;
    return textfile_end(t, err);
}

static enum status read_line(struct state_list *l, struct textfile *t, struct provenance *prov, struct err *err)
{
    char *word;
    if (textfile_word(t, "a statement", &word, err)) return err->status;
    if (!strcmp(word, "site")) {
        if (!read_site(l, t, err)) textfile_end(t, err);
        return err->status;
    }
    if (!strcmp(word, "lamp")) return planned_lamps_read(&l->planned, t, prov, err);
    if (!strcmp(word, "measured")) return read_measured(l, t, err);
    if (!strcmp(word, "photo")) return read_photo(l, t, err);
    if (strcmp(word, "state") != 0) return textfile_error(t, err, word, "site, lamp, state, measured or photo");
    return read_state(l, t, err);
}

/* ------------------------------------------------------------------------------------------------------------- list */

static enum status add_usual(struct state_list *l, struct err *err)
{
    static const struct usual {
        const char *name;
        bool lamps;
        enum state_sky sky;
    } usual[STATES_OF_EVERY_SCENE] = {{"photographed", true, STATE_SKY_PHOTOGRAPHED},
                                      {"lamps", true, STATE_SKY_NONE},
                                      {"daylight", false, STATE_SKY_PHOTOGRAPHED},
                                      {"overcast", false, STATE_SKY_OVERCAST}};
    for (int i = 0; !err->status && i < STATES_OF_EVERY_SCENE; i++) {
        if (begin_state(l, usual[i].name, err)) break;
        l->items[i].lamps = usual[i].lamps;
        l->items[i].sky = usual[i].sky;
        l->items[i].horizontal = STATE_OVERCAST_LUX;
    }
    return err->status;
}

enum status state_list_read(struct state_list *l, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    int64_t version;
    *l = (struct state_list){.north = 90};
    add_usual(l, err);
    if (!err->status && path && !provenance_open(prov, "states.txt", &t, path, err)) {
        l->path = strdup(path);
        if (!l->path) err_nomem(err, "a path", strlen(path));
        if (!err->status && !textfile_expect_line(&t, "remodel-states", err) &&
            !textfile_int(&t, "version", 1, 1, &version, err))
            textfile_end(&t, err);
        while (!err->status && textfile_next(&t)) read_line(l, &t, prov, err);
    }
    textfile_release(&t);
    if (err->status) state_list_release(l);
    return err->status;
}

const struct light_state *state_list_find(const struct state_list *l, const char *name)
{
    for (int i = 0; i < l->count; i++)
        if (!strcmp(l->items[i].name, name)) return &l->items[i];
    return NULL;
}

enum status state_list_read_words(struct state_list *l, const char *words, struct err *err)
{
    static const char head[] = "state -- "; /* a name that no other state has */
    struct textfile t = {0};
    struct file_bytes bytes = {malloc(sizeof head + strlen(words)), sizeof head - 1 + strlen(words)};
    if (!bytes.bytes) return err_nomem(err, "a state", bytes.size);
    strcpy(bytes.bytes, head);
    strcat(bytes.bytes, words);
    if (!state_list_read(l, NULL, NULL, err) && !textfile_take(&t, &bytes, "--state", err)) {
        l->has_site = true;
        if (!textfile_next(&t) || strchr(words, '\n'))
            err_set(err, ST_USAGE, "--state: wanted one line.");
        else if (!begin_state(l, "--", err) && !textfile_expect(&t, "state", err) && !textfile_expect(&t, "--", err))
            read_options(l, &t, err);
    }
    file_bytes_release(&bytes);
    textfile_release(&t);
    if (err->status) state_list_release(l);
    return err->status;
}

enum status state_list_add_edit_lamps(struct state_list *l, struct err *err)
{
    static const char name[] = "edit-lamps";
    if (has_name(l, name) || begin_state(l, name, err)) return err->status;
    struct light_state *s = &l->items[l->count - 1];
    s->lamps = false;
    for (int i = 0; i < l->planned.count; i++) {
        if (!l->planned.list[i].on) continue;
        if (array_append(&s->named, (size_t)s->named_count, sizeof *s->named, "lamps", err)) return err->status;
        s->named[s->named_count] = (struct state_factor){strdup(l->planned.list[i].name), 1};
        if (!s->named[s->named_count].name) return err_nomem(err, "a name", strlen(l->planned.list[i].name));
        s->named_count++;
    }
    return ST_OK;
}

/* The record of the hour that a time is in; NULL: none. */
static const struct weather_hour *find_hour(const struct weather *w, const struct sun_time *time)
{
    for (int i = 0; w && i < w->count; i++) {
        const struct sun_time *m = &w->hours[i].middle;
        if (m->month == time->month && m->day == time->day && fabs(m->hour - time->hour) <= 0.5) return &w->hours[i];
    }
    return NULL;
}

enum status state_list_take_weather(struct state_list *l, const struct weather *weather, struct err *err)
{
    for (int i = 0; i < l->count; i++) {
        struct light_state *s = &l->items[i];
        if (s->sky != STATE_SKY_WEATHER) continue;
        const struct weather_hour *hour = find_hour(weather, &s->time);
        if (!hour)
            return err_set(err, ST_DATA, "%s:%d: the state %s wants the weather of %d %d, %g o'clock; %s.", l->path,
                           s->line, s->name, s->time.month, s->time.day, s->time.hour,
                           weather ? "the weather file has no such hour" : "give a weather file, WEATHER=FILE");
        s->weather = hour->sky;
        s->time = hour->middle;
        s->place = weather->at;
    }
    return ST_OK;
}
