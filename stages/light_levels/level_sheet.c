/* level_sheet.c - see level_sheet.h.
 *
 * Intervals. The mean of an area has two errors, taken as independent and lognormal: those of level_interval.h, by the
 * scale and the metre, and that of the light (level_spread.h): of lamps, sky and sun by their shares, of the model, its
 * textures and the rays, [light_levels] error, and of skies that were not photographed, sky_error. The interval is 95 %
 * of their product. Where a metre is a guess, the work plane's interval holds those of planes at both ends of the
 * guess. Figures of a year are counted again in rooms that are darker and brighter by the model's error; the interval
 * reaches from the least to the most of them. The weather is taken as it is. */
#include "stages/light_levels/level_sheet.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/product/product.h"
#include "stages/light_levels/level_interval.h"
#include "stages/light_levels/level_plan.h"
#include "stages/light_levels/level_spread.h"
#include "stages/light_levels/level_year.h"

/* How a state's two sums become values. */
struct reading {
    const char *name, *unit;
    double factors[2];
    double variance[2]; /* of the logarithm, by the scale and the metre, to both sides */
    const struct state_weights *weights;
    double (*ends)[2]; /* of each area: the ends of its mean's interval, once it is known; owned; NULL: of a year */
};

static bool begin_reading(struct reading *r, const struct levels_job *j, const struct light_state *state,
                          const struct state_weights *w)
{
    const struct lux_interval *scale = &j->scale.is;
    const bool scaled = scale->scale > 0;
    if (!scaled && w->has_relative && w->has_absolute) return false;
    *r = (struct reading){
        state->name, scaled || !w->has_relative ? "lx" : "relative", {scaled ? scale->scale : 1, 1}, {0, 0}, w, NULL};
    level_interval_variance(r->variance, (struct level_origin){w->has_relative, w->has_planned}, scale,
                            &j->scene.metre);
    return true;
}

/* ------------------------------------------------------------------------------------------------------------ areas */

static double mean_of(const double *values, const struct sensor_area *a)
{
    double sum = 0;
    for (int i = 0; i < a->count; i++) sum += values[a->first + i];
    return sum / a->count;
}

/* Planes that stand for the ends of a guess have no rows. */
static bool is_hidden(const struct sensor_area *a)
{
    return a->kind == SENSOR_WORK_PLANE_LOW || a->kind == SENSOR_WORK_PLANE_HIGH;
}

/* Widens the range [low, high] of an area's mean to those of the planes at the ends of the guess. */
static void widen(double ends[2], const struct levels_job *j, int area, const double *values, double low, double high)
{
    const struct sensor_area *a = &j->sensors.areas[area];
    if (a->kind != SENSOR_WORK_PLANE) return;
    for (int i = area + 1; i < j->sensors.area_count && is_hidden(&j->sensors.areas[i]); i++) {
        const double mean = mean_of(values, &j->sensors.areas[i]);
        ends[0] = fmin(ends[0], low * mean);
        ends[1] = fmax(ends[1], high * mean);
    }
}

static enum status add_areas(struct levels_job *j, const struct reading *r, const double *values, struct err *err)
{
    struct level_spread spread = {0};
    level_spread_init(&spread, &j->errors, err);
    for (int i = 0; !err->status && i < j->sensors.area_count; i++) {
        const struct sensor_area *a = &j->sensors.areas[i];
        const double mean = mean_of(values, a);
        double factors[2], ends[2];
        if (is_hidden(a)) continue;
        level_spread_clear(&spread);
        for (int k = 0; k < a->count; k++)
            level_spread_add_point(&spread, &j->levels, a->first + k, &j->light.groups, r->weights, r->factors,
                                   1.0 / a->count);
        level_spread_ends(factors, &spread, mean, &j->errors, &j->light.groups, r->weights, &j->params, r->variance);
        for (int k = 0; k < 2; k++) ends[k] = factors[k] * mean;
        widen(ends, j, i, values, factors[0], factors[1]);
        for (int k = 0; k < 2; k++) r->ends[i][k] = ends[k];
        const struct sheet_values of = {values + a->first, NULL, a->count, 0, 0, ends};
        sheet_add(&j->sheet, r->name, sensor_kind_word(a->kind), a->name, r->unit, &of, err);
    }
    level_spread_release(&spread);
    return err->status;
}

static const char *face_of_patch(const struct light_patches *p, int patch)
{
    return solid_face_name(&p->field->model.mesh, p->list[patch].face);
}

static bool is_named_before(const struct light_patches *p, int patch, const char *name)
{
    for (int i = 0; i < patch; i++)
        if (!strcmp(face_of_patch(p, i), name)) return true;
    return false;
}

/* Patches of faces of one name, and their light. */
struct face_values {
    double (*sums)[2];      /* of all patches */
    double *values, *areas; /* of this face's */
    float *whole, *direct;  /* of one patch, by groups */
    struct level_spread spread;
};

static void face_values_release(struct face_values *f)
{
    free(f->sums);
    free(f->values);
    free(f->whole);
    level_spread_release(&f->spread);
}

static enum status face_values_make(struct face_values *f, const struct levels_job *j, const struct reading *r,
                                    struct err *err)
{
    const size_t count = (size_t)j->light.patches.count + 1, groups = (size_t)j->errors.count + 1;
    f->sums = malloc(count * sizeof *f->sums);
    f->values = malloc(2 * count * sizeof *f->values);
    f->whole = malloc(2 * groups * sizeof *f->whole);
    if (!f->sums || !f->values || !f->whole) return err_nomem(err, "patches", count * sizeof *f->sums);
    f->areas = f->values + count;
    f->direct = f->whole + groups;
    return level_spread_init(&f->spread, &j->errors, err) ? err->status
                                                          : level_patches_sum(f->sums, &j->light, r->weights, err);
}

/* Adds a patch to a face's value and to its spread. */
static void add_patch(struct face_values *f, const struct levels_job *j, const struct reading *r, int patch, int at)
{
    const double *sums = f->sums[patch], area = j->light.patches.list[patch].area;
    struct spread_place place = {f->whole, f->direct, 0};
    double direct[2];
    f->values[at] = r->factors[0] * sums[0] + r->factors[1] * sums[1];
    f->areas[at] = area;
    level_patch_groups(f->whole, f->direct, &j->light, patch, j->errors.count);
    level_patch_direct(direct, &j->light, patch, r->weights);
    for (int k = 0; k < 2; k++) place.reflected += r->factors[k] * fmax(0, sums[k] - direct[k]);
    level_spread_add(&f->spread, &place, r->weights, r->factors[0], area);
}

/* Faces of one name, such as a wall's in two rooms, are one row. */
static enum status add_faces(struct levels_job *j, const struct reading *r, struct err *err)
{
    const struct light_patches *p = &j->light.patches;
    struct face_values f = {0};
    face_values_make(&f, j, r, err);
    for (int i = 0; !err->status && i < p->face_patches; i++) {
        const char *name = face_of_patch(p, i);
        double sum = 0, ends[2];
        int count = 0;
        if ((i > 0 && p->list[i].face == p->list[i - 1].face) || is_named_before(p, i, name)) continue;
        level_spread_clear(&f.spread);
        for (int k = i; k < p->face_patches; k++)
            if (!strcmp(face_of_patch(p, k), name)) add_patch(&f, j, r, k, count++);
        for (int k = 0; k < count; k++) sum += f.areas[k] * f.values[k];
        level_spread_ends(ends, &f.spread, sum, &j->errors, &j->light.groups, r->weights, &j->params, r->variance);
        const struct sheet_values of = {f.values, f.areas, count, ends[0], ends[1], NULL};
        sheet_add(&j->sheet, r->name, "face", name, r->unit, &of, err);
    }
    face_values_release(&f);
    return err->status;
}

static enum status draw(const struct levels_job *j, const struct reading *r, const double *values, struct err *err)
{
    char path[FILE_PATH];
    const struct light_groups *groups = &j->light.groups;
    const struct level_picture picture = {.title = r->name,
                                          .unit = r->unit,
                                          .values = values,
                                          .annual = !strncmp(r->name, "year-", 5),
                                          .ends = (const double(*)[2])r->ends,
                                          .lamps = r->weights ? groups->planned_lamps : NULL,
                                          .shines = r->weights ? r->weights->absolute + groups->planned : NULL};
    if (!j->sensors.count ||
        product_path_in(path, j->out, PRODUCT_LIGHT_PLAN, &(struct product_key){.name = r->name}, err))
        return err->status;
    return level_plan_write(&picture, &j->sensors, &j->plan, path, err);
}

static enum status draw_views(const struct levels_job *j, const struct reading *r, const struct state_weights *w,
                              struct err *err)
{
    const struct level_views_state state = {r->name, r->unit, {r->factors[0], r->factors[1]}, w};
    return level_views_draw(&j->views, &j->light, &state, j->out, err);
}

/* ----------------------------------------------------------------------------------------------------------- states */

static enum status add_daylight_factor(struct levels_job *j, const struct reading *overcast,
                                       const struct state_weights *w, double *values, struct err *err)
{
    struct reading r = *overcast;
    r.name = "daylight-factor";
    r.unit = "%";
    for (int k = 0; k < 2; k++) r.factors[k] = daylight_factor(r.factors[k], STATE_OVERCAST_LUX);
    for (int i = 0; i < j->sensors.count; i++) values[i] = daylight_factor(values[i], STATE_OVERCAST_LUX);
    if (add_areas(j, &r, values, err) || draw(j, &r, values, err)) return err->status;
    return draw_views(j, &r, w, err);
}

static enum status add_state(struct levels_job *j, int number, double *values, struct err *err)
{
    const struct light_state *state = &j->states.items[number];
    struct state_weights w = {0};
    struct reading r;
    if (!level_weights_make(&w, state, &j->states, &j->light.groups, &j->params, err)) {
        if (!begin_reading(&r, j, state, &w)) {
            log_warn(
                "the state %s has lamps of the photographs and a sky or a lamp that was not photographed; their sum "
                "needs lux/scale.txt, and is left out. Measure a point (lux.txt), or say `lamps off`.",
                state->name);
        } else {
            for (int i = 0; i < j->sensors.count; i++) {
                double sums[2];
                level_points_sum(sums, &j->levels, i, &w, j->light.groups.field);
                values[i] = r.factors[0] * sums[0] + r.factors[1] * sums[1];
            }
            if (!(r.ends = malloc(((size_t)j->sensors.area_count + 1) * sizeof *r.ends)))
                err_nomem(err, "areas", (size_t)j->sensors.area_count * sizeof *r.ends);
            if (!err->status && !add_areas(j, &r, values, err) && !add_faces(j, &r, err) && !draw(j, &r, values, err))
                draw_views(j, &r, &w, err);
            /* without rooms the sky shines in where floors and ceilings should be */
            if (!err->status && number == STATE_OVERCAST && j->plan.room_count)
                add_daylight_factor(j, &r, &w, values, err);
            free(r.ends);
        }
    }
    level_weights_release(&w);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------- year */

/* The figures of a year. Each point has one, and an area has the mean of its points. */
static const struct annual {
    const char *name, *unit;
} annual[] = {{"year-sda", "%"},
              {"year-ase", "%"},
              {"year-autonomy", "%"},
              {"year-udi-short", "%"},
              {"year-udi-supplementary", "%"},
              {"year-udi-autonomous", "%"},
              {"year-udi-exceeds", "%"},
              {"year-sun", "h"}};
enum { ANNUAL = sizeof annual / sizeof *annual };

static double annual_value(int which, const struct daylight_point *p)
{
    const double hours = p->hours > 0 ? p->hours : 1;
    switch (which) {
    case 0:
        return p->enough >= DAYLIGHT_SHARE * hours ? 100 : 0;
    case 1:
        return p->sunlit > DAYLIGHT_SUN_HOURS ? 100 : 0;
    case 2:
        return 100 * p->enough / hours;
    case 7:
        return p->sun;
    default:
        return 100 * p->use[which - 3] / hours;
    }
}

enum { SUN_HOURS = ANNUAL - 1 }; /* how bright the room is does not change them */

/* Rows of one figure. values: of the points, scratch. */
static enum status add_annual(struct levels_job *j, int which, const struct daylight_point *counts, double *values,
                              struct err *err)
{
    const int points = j->sensors.count, areas = j->sensors.area_count;
    double(*ends)[2] = malloc(((size_t)areas + 1) * sizeof *ends);
    if (!ends) return err_nomem(err, "areas", (size_t)areas * sizeof *ends);
    for (int level = LEVEL_YEARS - 1; level >= 0; level--) { /* the last one is that of the room as it is */
        for (int i = 0; i < points; i++)
            values[i] = annual_value(which, &counts[(size_t)level * (size_t)points + (size_t)i]);
        for (int i = 0; i < areas; i++) {
            const double mean = mean_of(values, &j->sensors.areas[i]);
            if (level == LEVEL_YEARS - 1) ends[i][0] = ends[i][1] = mean;
            ends[i][0] = fmin(ends[i][0], mean);
            ends[i][1] = fmax(ends[i][1], mean);
            widen(ends[i], j, i, values, 1, 1);
        }
    }
    for (int i = 0; !err->status && i < areas; i++) {
        const struct sensor_area *a = &j->sensors.areas[i];
        const struct sheet_values of = {values + a->first, NULL, a->count, 0, 0, which == SUN_HOURS ? NULL : ends[i]};
        if (!is_hidden(a))
            sheet_add(&j->sheet, annual[which].name, sensor_kind_word(a->kind), a->name, annual[which].unit, &of, err);
    }
    free(ends);
    return err->status;
}

static enum status add_year(struct levels_job *j, double *values, struct err *err)
{
    const size_t size = LEVEL_YEARS * (size_t)j->sensors.count;
    struct daylight_point *counts = calloc(size + 1, sizeof *counts);
    int hours;
    if (!counts) return err_nomem(err, "points", size * sizeof *counts);
    level_year_count(counts, &hours, &j->levels, &j->light, &j->weather, j->states.north, &j->params, err);
    if (!err->status && hours < DAYLIGHT_HOURS)
        log_warn("%s has %d of the %d hours from %d to %d o'clock; the figures of the year are those of these.",
                 j->files.weather, hours, DAYLIGHT_HOURS, DAYLIGHT_FROM, DAYLIGHT_TO);
    for (int k = 0; !err->status && k < ANNUAL; k++) {
        const struct reading r = {annual[k].name, annual[k].unit, {0, 0}, {0, 0}, NULL, NULL};
        if (!add_annual(j, k, counts, values, err) && k == 2) draw(j, &r, values, err);
    }
    free(counts);
    return err->status;
}

enum status level_sheet_make(struct levels_job *j, struct err *err)
{
    const struct model_metre *metre = &j->scene.metre;
    char path[FILE_PATH];
    double *values = malloc(((size_t)j->sensors.count + 1) * sizeof *values);
    if (!values) return err_nomem(err, "points", (size_t)j->sensors.count * sizeof *values);
    for (int i = 0; !err->status && i < j->states.count; i++) add_state(j, i, values, err);
    if (!err->status && j->files.weather) add_year(j, values, err);
    free(values);
    if (metre->guessed)
        snprintf(j->sheet.note, sizeof j->sheet.note,
                 "no scale is known: a metre is a guess, %.3g units of the model (%.3g to %.3g), by rooms %g m high "
                 "(%g to %g); it sets the work plane and the distances of points",
                 metre->units, metre->low, metre->high, j->params.room_height, model_metre_heights[0],
                 model_metre_heights[1]);
    if (err->status || product_path_in(path, j->out, PRODUCT_LIGHT_SHEET, &(struct product_key){0}, err))
        return err->status;
    return sheet_write(&j->sheet, j->files.before ? &j->before : NULL, path, &j->prov, err);
}
