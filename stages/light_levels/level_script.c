/* level_script.c - see level_script.h.
 *
 * Points of floors are left out, and of large rooms every second or third point of a row and of a column is kept, so
 * that a variant has about MOST_POINTS. Light is that of relit_light.h, in 16 bits (light_codes.h). */
#include "stages/light_levels/level_script.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/outfile.h"
#include "common/base/scan.h"
#include "common/image/false_colour.h"
#include "common/product/product.h"
#include "stages/light_levels/level_interval.h"
#include "stages/light_levels/level_scale.h"
#include "stages/light_levels/light_codes.h"

enum { MOST_POINTS = 1500, RAMP = 64 };

struct writing {
    const struct level_script *s;
    FILE *to;
};

static void put_text(FILE *to, const char *text)
{
    fputc('"', to);
    for (const unsigned char *c = (const unsigned char *)text; *c; c++)
        if (*c < 0x20 || *c == '"' || *c == '\\' || *c == '<')
            fprintf(to, "\\u%04x", *c);
        else
            fputc(*c, to);
    fputc('"', to);
}

/* ----------------------------------------------------------------------------------------------------------- points */

static bool is_shown(const struct sensor_area *a) { return a->kind == SENSOR_WORK_PLANE || a->kind == SENSOR_PLACE; }

/* Keeps a point of a room by its row and column. */
static bool is_kept(const struct sensors *s, const struct sensor_area *a, int point, int stride)
{
    if (a->kind == SENSOR_PLACE || stride == 1) return true;
    const struct vec3 first = s->points[a->first].at, at = s->points[point].at;
    const long x = lround((at.x - first.x) / a->step), y = lround((at.y - first.y) / a->step);
    return x % stride == 0 && y % stride == 0;
}

enum status level_script_choose(struct script_points *p, const struct sensors *s, struct err *err)
{
    int shown = 0;
    for (int k = 0; k < s->area_count; k++) shown += is_shown(&s->areas[k]) ? s->areas[k].count : 0;
    *p = (struct script_points){malloc(((size_t)s->count + 1) * sizeof *p->chosen), 0, 1};
    if (!p->chosen) return err_nomem(err, "points", (size_t)s->count * sizeof *p->chosen);
    p->stride = (int)fmax(1, ceil(sqrt((double)shown / MOST_POINTS)));
    for (int k = 0; k < s->area_count; k++)
        for (int i = s->areas[k].first; is_shown(&s->areas[k]) && i < s->areas[k].first + s->areas[k].count; i++)
            if (is_kept(s, &s->areas[k], i, p->stride)) p->chosen[p->count++] = i;
    return ST_OK;
}

static void put_areas(const struct writing *w)
{
    const struct sensors *s = w->s->sensors;
    const struct script_points *p = w->s->chosen;
    int at = 0;
    fputs("\"areas\":[", w->to);
    for (int k = 0; k < s->area_count; k++) {
        const struct sensor_area *a = &s->areas[k];
        const int first = at;
        if (!is_shown(a)) continue;
        while (at < p->count && p->chosen[at] < a->first + a->count) at++;
        fprintf(w->to, "%s{\"kind\":\"%s\",\"name\":", first ? "," : "", sensor_kind_word(a->kind));
        put_text(w->to, a->name);
        fprintf(w->to, ",\"first\":%d,\"count\":%d,\"step\":%.6g}", first, at - first,
                a->step * (a->kind == SENSOR_PLACE ? 1 : p->stride));
    }
    fputs("],\n\"points\":[", w->to);
    for (int i = 0; i < p->count; i++)
        fprintf(w->to, "%s%.2f,%.2f", i ? "," : "", s->points[p->chosen[i]].at.x, s->points[p->chosen[i]].at.y);
    fputs("],\n", w->to);
}

static void put_plan(const struct writing *w)
{
    const struct model_plan *plan = w->s->plan;
    const char *comma = "";
    fputs("\"rooms\":[", w->to);
    for (int i = 0; i < plan->room_count; i++) {
        const struct model_room *r = &plan->rooms[i];
        fprintf(w->to, "%s{\"name\":", i ? "," : "");
        put_text(w->to, r->name);
        fputs(",\"outline\":[", w->to);
        for (int k = 0; k < r->corner_count; k++)
            fprintf(w->to, "%s%.3f,%.3f", k ? "," : "", r->corners[k].x, r->corners[k].y);
        fputs("]}", w->to);
    }
    fputs("],\n\"openings\":[", w->to);
    for (int i = 0; i < plan->opening_count; i++) {
        struct vec3 c[2];
        if (!model_opening_corners(plan, i, c)) continue;
        fprintf(w->to, "%s{\"kind\":\"%s\",\"at\":[%.3f,%.3f,%.3f,%.3f]}", comma,
                plan->openings[i].kind == MODEL_WINDOW ? "window" : "door", c[0].x, c[0].y, c[1].x, c[1].y);
        comma = ",";
    }
    fputs("],\n", w->to);
}

/* ------------------------------------------------------------------------------------------------------------ light */

static enum status put_field(const struct writing *w, const struct relit_field *f, struct err *err)
{
    const float *values = f->values + 3 * w->s->relit->places;
    const size_t count = (size_t)w->s->relit->points;
    if (f->kind == RELIT_PART) {
        const double most = light_codes_most(values, count);
        fprintf(w->to, "{\"most\":%.8g,\"data\":\"", most);
        light_codes_put_signed(w->to, values, count, most, err);
    } else {
        const double high = light_codes_highest(values, count);
        fprintf(w->to, "{\"low\":%.8g,\"high\":%.8g,\"data\":\"", light_codes_low(high), high);
        light_codes_put(w->to, values, count, high, err);
    }
    fputs("\"}", w->to);
    return err->status;
}

static enum status put_lamps(const struct writing *w, struct err *err)
{
    const struct relit_light *r = w->s->relit;
    const char *comma = "";
    fputs("\"lamps\":[", w->to);
    for (int i = 0; !err->status && i < r->field_count; i++) {
        if (r->fields[i].kind != RELIT_LAMP) continue;
        const struct relit_lamp *lamp = &r->lamps[r->fields[i].of];
        fprintf(w->to, "%s{%s\"name\":", comma,
                lamp->kind != RELIT_PLANNED ? ""
                : lamp->on                  ? "\"planned\":true,\"on\":true,"
                                            : "\"planned\":true,");
        put_text(w->to, lamp->name);
        fputs(",\"light\":", w->to);
        put_field(w, &r->fields[i], err);
        fputs("}", w->to);
        comma = ",\n";
    }
    fputs("],\n", w->to);
    return err->status;
}

static enum status put_windows(const struct writing *w, struct err *err)
{
    const struct relit_light *r = w->s->relit;
    fputs("\"windows\":[", w->to);
    for (int v = 0; v < r->window_count; v++) {
        fputs(v ? ",\n{\"name\":" : "{\"name\":", w->to);
        put_text(w->to, v + 1 < r->window_count ? r->windows[v] : "");
        const char *comma = "";
        bool has_level = false;
        for (int i = 0; !err->status && i < r->field_count; i++) {
            const struct relit_field *f = &r->fields[i];
            if (f->of != v || f->kind == RELIT_LAMP || f->kind == RELIT_TEXTURE) continue;
            if (f->kind == RELIT_WINDOW) fputs(",\"photographed\":", w->to);
            if (f->kind == RELIT_LEVEL) fputs(",\"level\":", w->to);
            if (f->kind == RELIT_PART) fputs(*comma ? comma : ",\"parts\":[", w->to), comma = ",\n";
            has_level |= f->kind == RELIT_PART;
            put_field(w, f, err);
        }
        fputs(has_level ? "]}" : "}", w->to);
    }
    fputs("],\n", w->to);
    return err->status;
}

static enum status put_skies(const struct writing *w, struct err *err)
{
    const struct relit_light *r = w->s->relit;
    fputs("\"skies\":[", w->to);
    for (int i = 0; i < r->sky_count; i++) {
        const struct relit_sky *s = &r->skies[i];
        fprintf(w->to, "%s{\"sun\":%.6g,\"shade\":%d,\"mixes\":[", i ? ",\n" : "", s->sun * fmax(0, s->to_sun.z),
                s->shade);
        for (int k = 0; k < r->part_count; k++) fprintf(w->to, "%s%.6g", k ? "," : "", s->mixes[k]);
        fputs("]}", w->to);
    }
    fputs("],\n\"suns\":[", w->to);
    for (int k = 0; !err->status && k < r->shade_count; k++) {
        fputs(k ? ",\"" : "\"", w->to);
        light_codes_put_runs(w->to, r->shades[k], (size_t)r->points, err);
        fputs("\"", w->to);
    }
    fputs("],\n", w->to);
    return err->status;
}

static void put_days(const struct writing *w)
{
    const struct level_days *d = w->s->days;
    fputs("\"days\":[", w->to);
    for (int i = 0; i < d->day_count; i++) {
        const struct level_day *day = &d->days[i];
        fprintf(w->to, "%s{\"date\":\"%02d-%02d\",\"hours\":[", i ? ",\n" : "", day->month, day->day);
        for (int k = day->first; k < day->first + day->count; k++)
            fprintf(w->to, "%s%g", k > day->first ? "," : "", d->hours[k].time.hour);
        fputs("],\"altitudes\":[", w->to);
        for (int k = day->first; k < day->first + day->count; k++)
            fprintf(w->to, "%s%.0f", k > day->first ? "," : "", d->hours[k].sun.altitude);
        fputs("],\"skies\":[", w->to);
        for (int k = day->first; k < day->first + day->count; k++)
            for (int cover = 0; cover < LEVEL_COVERS; cover++) {
                const struct light_state state = {
                    .sky = STATE_SKY_TIME, .cover = (enum sky_cover)cover, .time = d->hours[k].time};
                fprintf(w->to, "%s%d", k > day->first || cover ? "," : "", relit_light_find_sky(w->s->relit, &state));
            }
        fputs("]}", w->to);
    }
    fputs("],\n", w->to);
}

/* ------------------------------------------------------------------------------------------------------------- file */

static void put_head(const struct writing *w)
{
    const struct level_script *s = w->s;
    fprintf(w->to, "remodelLevels({\"version\":2,\"metric\":%s,\"scale\":%.6g,\"scaleLow\":%.6g,\"scaleHigh\":%.6g,\n",
            s->metric ? "true" : "false", s->scale->is.scale, s->scale->is.low, s->scale->is.high);
    fprintf(w->to, "\"workPlane\":%g,\"stride\":%d,\"overcastLux\":%g,\"ramp\":\"", s->params->work_plane,
            s->chosen->stride, STATE_OVERCAST_LUX);
    for (int i = 0; i < RAMP; i++) {
        unsigned char c[3];
        colour_of_ramp((double)i / (RAMP - 1), c);
        fprintf(w->to, "%02x%02x%02x", c[0], c[1], c[2]);
    }
    fputs("\",\n\"ranges\":{", w->to);
    static const char *const units[] = {"lx", "relative", "%"};
    for (int i = 0; i < 3; i++) {
        const struct level_scale scale = level_scale_of(units[i], 0);
        fprintf(w->to, "%s\"%s\":[%g,%g]", i ? "," : "", units[i], scale.low, scale.high);
    }
    fputs("},\n", w->to);
}

/* Of computed light, with light of the photographs, with planned lamps, with both. */
static void put_intervals(const struct writing *w)
{
    fputs("\"intervals\":[", w->to);
    for (int k = 0; k < 4; k++) {
        double ends[2];
        level_interval(ends, (struct level_origin){k & 1, k >> 1}, w->s->params, w->s->errors, &w->s->scale->is,
                       w->s->metre);
        fprintf(w->to, "%s[%.6g,%.6g]", k ? "," : "", ends[0], ends[1]);
    }
    fputs("],\n", w->to);
}

static void put_site(const struct writing *w)
{
    const struct state_list *s = w->s->states;
    fputs("\"site\":", w->to);
    if (s->has_site)
        fprintf(w->to, "[%g,%g,%g]", s->site.latitude, s->site.longitude, s->site.time_zone);
    else
        fputs("null", w->to);
    fputs("});\n", w->to);
}

enum status level_script_write(const struct level_script *s, const char *path, struct err *err)
{
    struct writing w = {.s = s};
    struct outfile f = {0};
    if (!outfile_open(&f, path, err)) {
        const locale_t was = uselocale(scan_c_locale());
        w.to = f.fp;
        put_head(&w);
        put_areas(&w);
        put_plan(&w);
        if (!put_lamps(&w, err) && !put_windows(&w, err) && !put_skies(&w, err)) {
            put_days(&w);
            put_intervals(&w);
            put_site(&w);
        }
        uselocale(was);
        if (!err->status) outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}
