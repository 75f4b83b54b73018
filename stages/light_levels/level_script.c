/* level_script.c - see level_script.h.
 *
 * Points of floors are left out, and of large rooms every second or third point of a row and of a column is kept, so
 * that a variant has about MOST_POINTS. Light is kept as the logarithm between the least and the most of its kind, in
 * steps of 16 bits, which is exact to a thousandth. */
#include "stages/light_levels/level_script.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/base64.h"
#include "common/base/outfile.h"
#include "common/base/scan.h"
#include "common/image/false_colour.h"
#include "common/product/product.h"
#include "stages/light_levels/level_scale.h"

enum { MOST_POINTS = 1500, RAMP = 64, PER_HOUR = 2, LEVELS = 65535 };
static const double SPAN = 1e7; /* of light: what is less counts as none */

struct writing {
    const struct level_script *s;
    FILE *to;
    int *chosen; /* points; owned */
    int count, stride;
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
static bool is_kept(const struct writing *w, const struct sensor_area *a, int point)
{
    if (a->kind == SENSOR_PLACE || w->stride == 1) return true;
    const struct vec3 first = w->s->sensors->points[a->first].at, at = w->s->sensors->points[point].at;
    const long x = lround((at.x - first.x) / a->step), y = lround((at.y - first.y) / a->step);
    return x % w->stride == 0 && y % w->stride == 0;
}

static enum status choose_points(struct writing *w, struct err *err)
{
    const struct sensors *s = w->s->sensors;
    int shown = 0;
    for (int k = 0; k < s->area_count; k++) shown += is_shown(&s->areas[k]) ? s->areas[k].count : 0;
    w->stride = (int)ceil(sqrt((double)shown / MOST_POINTS));
    if (w->stride < 1) w->stride = 1;
    w->chosen = malloc(((size_t)s->count + 1) * sizeof *w->chosen);
    return w->chosen ? ST_OK : err_nomem(err, "points", (size_t)s->count * sizeof *w->chosen);
}

static void put_areas(struct writing *w)
{
    const struct sensors *s = w->s->sensors;
    bool first = true;
    fputs("\"areas\":[", w->to);
    for (int k = 0; k < s->area_count; k++) {
        const struct sensor_area *a = &s->areas[k];
        const int before = w->count;
        if (!is_shown(a)) continue;
        for (int i = a->first; i < a->first + a->count; i++)
            if (is_kept(w, a, i)) w->chosen[w->count++] = i;
        fprintf(w->to, "%s{\"kind\":\"%s\",\"name\":", first ? "" : ",", sensor_kind_word(a->kind));
        put_text(w->to, a->name);
        fprintf(w->to, ",\"first\":%d,\"count\":%d,\"step\":%.6g}", before, w->count - before,
                a->step * (a->kind == SENSOR_PLACE ? 1 : w->stride));
        first = false;
    }
    fputs("],\n\"points\":[", w->to);
    for (int i = 0; i < w->count; i++)
        fprintf(w->to, "%s%.2f,%.2f", i ? "," : "", s->points[w->chosen[i]].at.x, s->points[w->chosen[i]].at.y);
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

/* {"low":..,"high":..,"data":".."}: 0 is none, n is low (high / low)^((n - 1) / (LEVELS - 1)). */
static enum status put_light(FILE *to, const float *values, size_t count, struct err *err)
{
    unsigned char *bytes = malloc(2 * count + 1);
    double high = 0;
    if (!bytes) return err_nomem(err, "light", 2 * count);
    for (size_t i = 0; i < count; i++) high = fmax(high, (double)values[i]);
    const double low = high / SPAN;
    for (size_t i = 0; i < count; i++) {
        const double v = (double)values[i];
        const long n = v > low ? 1 + lround((LEVELS - 1) * log(v / low) / log(SPAN)) : 0;
        bytes[2 * i] = (unsigned char)(n & 255);
        bytes[2 * i + 1] = (unsigned char)(n >> 8);
    }
    fprintf(to, "{\"low\":%.8g,\"high\":%.8g,\"data\":\"", low, high);
    base64_write(to, bytes, 2 * count);
    fputs("\"}", to);
    free(bytes);
    return ST_OK;
}

/* The light of a state at the chosen points, in the unit of the photographs (unit 0) or in lx (1). */
static enum status put_weighted(const struct writing *w, const struct state_weights *weights, int unit, struct err *err)
{
    float *values = malloc(((size_t)w->count + 1) * sizeof *values);
    if (!values) return err_nomem(err, "light", (size_t)w->count * sizeof *values);
    for (int i = 0; i < w->count; i++) {
        double sums[2];
        level_points_sum(sums, w->s->points, w->chosen[i], weights, w->s->light->groups.field);
        values[i] = (float)sums[unit];
    }
    put_light(w->to, values, (size_t)w->count, err);
    free(values);
    return err->status;
}

static enum status put_lamps(const struct writing *w, struct err *err)
{
    const struct light_groups *g = &w->s->light->groups;
    struct state_weights weights = {0};
    if (!level_weights_init(&weights, g, err)) fputs("\"lamps\":[", w->to);
    for (int i = 0; !err->status && i <= g->rest; i++) {
        fputs(i ? ",\n{\"name\":" : "{\"name\":", w->to);
        put_text(w->to, i < g->rest ? g->field->lights.lamps[i].name : "");
        fputs(",\"light\":", w->to);
        weights.relative[i] = 1;
        put_weighted(w, &weights, 0, err);
        weights.relative[i] = 0;
        fputs("}", w->to);
    }
    for (int i = 0; !err->status && i < g->count - g->planned; i++) {
        fputs(",\n{\"planned\":true,\"name\":", w->to);
        put_text(w->to, g->planned_lamps->list[i].name);
        fputs(",\"light\":", w->to);
        weights.absolute[g->planned + i] = 1;
        put_weighted(w, &weights, 1, err);
        weights.absolute[g->planned + i] = 0;
        fputs("}", w->to);
    }
    if (!err->status) fputs("],\n", w->to);
    level_weights_release(&weights);
    return err->status;
}

static enum status put_skies(const struct writing *w, struct err *err)
{
    static const char *const keys[] = {"photographed", "overcast"};
    const struct level_script *s = w->s;
    static const struct light_state skies[] = {{.sky = STATE_SKY_PHOTOGRAPHED},
                                               {.sky = STATE_SKY_OVERCAST, .horizontal = STATE_OVERCAST_LUX}};
    for (int i = 0; !err->status && i < 2; i++) {
        struct state_weights weights = {0};
        fprintf(w->to, "\"%s\":", keys[i]);
        if (!level_weights_make(&weights, &skies[i], s->states, &s->light->groups, s->params, err))
            put_weighted(w, &weights, i, err);
        level_weights_release(&weights);
        fputs(",\n", w->to);
    }
    return err->status;
}

static enum status put_days(const struct writing *w, struct err *err)
{
    const struct level_script *s = w->s;
    struct level_days d = {.day_count = 0};
    float *values = NULL;
    if (!level_days_make(&d, s->states, s->day, PER_HOUR, err)) {
        const size_t count = (size_t)d.hour_count * LEVEL_COVERS * (size_t)w->count;
        values = malloc((count + 1) * sizeof *values);
        if (!values) err_nomem(err, "light of days", count * sizeof *values);
        if (!err->status)
            level_days_light(values, &d, s->points, w->chosen, w->count, s->light, s->states, s->params, err);
    }
    if (!err->status) fputs("\"days\":[", w->to);
    for (int i = 0; !err->status && i < d.day_count; i++) {
        const struct level_day *day = &d.days[i];
        fprintf(w->to, "%s{\"date\":\"%02d-%02d\",\"hours\":[", i ? ",\n" : "", day->month, day->day);
        for (int k = day->first; k < day->first + day->count; k++)
            fprintf(w->to, "%s%g", k > day->first ? "," : "", d.hours[k].time.hour);
        fputs("],\"altitudes\":[", w->to);
        for (int k = day->first; k < day->first + day->count; k++)
            fprintf(w->to, "%s%.0f", k > day->first ? "," : "", d.hours[k].sun.altitude);
        fputs("],\"light\":", w->to);
        put_light(w->to, values + (size_t)day->first * LEVEL_COVERS * (size_t)w->count,
                  (size_t)day->count * LEVEL_COVERS * (size_t)w->count, err);
        fputs("}", w->to);
    }
    if (!err->status) fputs("],\n", w->to);
    free(values);
    level_days_release(&d);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------- file */

static void put_head(const struct writing *w)
{
    const struct level_script *s = w->s;
    fprintf(w->to, "remodelLevels({\"version\":1,\"metric\":%s,\"scale\":%.6g,\"scaleLow\":%.6g,\"scaleHigh\":%.6g,\n",
            s->metric ? "true" : "false", s->scale->is.scale, s->scale->is.low, s->scale->is.high);
    fprintf(w->to, "\"workPlane\":%g,\"stride\":%d,\"overcastLux\":%g,\"ramp\":\"", s->params->work_plane, w->stride,
            STATE_OVERCAST_LUX);
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
    struct writing w = {.s = s, .stride = 1};
    struct outfile f = {0};
    if (!choose_points(&w, err) && !outfile_open(&f, path, err)) {
        const locale_t was = uselocale(scan_c_locale());
        w.to = f.fp;
        put_head(&w);
        put_areas(&w);
        put_plan(&w);
        if (!put_lamps(&w, err) && !put_skies(&w, err) && !put_days(&w, err)) put_site(&w);
        uselocale(was);
        if (!err->status) outfile_commit(&f, err);
    }
    outfile_discard(&f);
    free(w.chosen);
    return err->status;
}
