/* level_sheet.c - see level_sheet.h.
 *
 * Intervals. The mean of an area has two errors, taken as independent and lognormal: that of the scale from the
 * photographs' unit to cd/m2 (lux_scale.h), which counts for light of the photographs alone, and that of the model, its
 * textures and the rays, [light_levels] error. The interval is 95 % of their product. */
#include "stages/light_levels/level_sheet.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/product/product.h"
#include "stages/light_levels/level_plan.h"
#include "stages/light_levels/level_year.h"

static const double NORMAL_95 = 1.959964; /* standard deviations to either side */

/* How a state's two sums become values. */
struct reading {
    const char *name, *unit;
    double factors[2];
    double low, high; /* of the interval */
};

static bool begin_reading(struct reading *r, const struct levels_job *j, const struct light_state *state,
                          const struct state_weights *w)
{
    const struct lux_interval *scale = &j->scale.is;
    const bool scaled = scale->scale > 0;
    double variance[2] = {j->params.error * j->params.error, j->params.error * j->params.error};
    if (!scaled && w->has_relative && w->has_absolute) return false;
    *r = (struct reading){
        state->name, scaled || !w->has_relative ? "lx" : "relative", {scaled ? scale->scale : 1, 1}, 0, 0};
    for (int k = 0; scaled && w->has_relative && k < 2; k++) {
        const double d = log(k ? scale->high / scale->scale : scale->scale / scale->low) / NORMAL_95;
        variance[k] += d * d;
    }
    r->low = exp(-NORMAL_95 * sqrt(variance[0]));
    r->high = exp(NORMAL_95 * sqrt(variance[1]));
    return true;
}

/* ------------------------------------------------------------------------------------------------------------ areas */

static enum status add_areas(struct levels_job *j, const struct reading *r, const double *values, struct err *err)
{
    for (int i = 0; !err->status && i < j->sensors.area_count; i++) {
        const struct sensor_area *a = &j->sensors.areas[i];
        const struct sheet_values of = {values + a->first, NULL, a->count, r->low, r->high};
        sheet_add(&j->sheet, r->name, sensor_kind_word(a->kind), a->name, r->unit, &of, err);
    }
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

/* Faces of one name, such as a wall's in two rooms, are one row. */
static enum status add_faces(struct levels_job *j, const struct reading *r, const struct state_weights *w,
                             struct err *err)
{
    const struct light_patches *p = &j->light.patches;
    double(*sums)[2] = malloc(((size_t)p->count + 1) * sizeof *sums);
    double *values = malloc(2 * ((size_t)p->count + 1) * sizeof *values), *areas = values ? values + p->count : NULL;
    if (!sums || !values) err_nomem(err, "patches", (size_t)p->count * sizeof *sums);
    if (!err->status) level_patches_sum(sums, &j->light, w, err);
    for (int i = 0; !err->status && i < p->face_patches; i++) {
        const char *name = face_of_patch(p, i);
        int count = 0;
        if ((i > 0 && p->list[i].face == p->list[i - 1].face) || is_named_before(p, i, name)) continue;
        for (int k = i; k < p->face_patches; k++) {
            if (strcmp(face_of_patch(p, k), name) != 0) continue;
            values[count] = r->factors[0] * sums[k][0] + r->factors[1] * sums[k][1];
            areas[count++] = p->list[k].area;
        }
        const struct sheet_values of = {values, areas, count, r->low, r->high};
        sheet_add(&j->sheet, r->name, "face", name, r->unit, &of, err);
    }
    free(sums);
    free(values);
    return err->status;
}

static enum status draw(const struct levels_job *j, const struct reading *r, const double *values, struct err *err)
{
    char path[FILE_PATH];
    const struct level_picture picture = {r->name, r->unit, values};
    if (!j->sensors.count ||
        product_path_in(path, j->out, PRODUCT_LIGHT_PLAN, &(struct product_key){.name = r->name}, err))
        return err->status;
    return level_plan_write(&picture, &j->sensors, &j->plan, path, err);
}

/* ----------------------------------------------------------------------------------------------------------- states */

static enum status add_daylight_factor(struct levels_job *j, const struct reading *overcast, double *values,
                                       struct err *err)
{
    struct reading r = *overcast;
    r.name = "daylight-factor";
    r.unit = "%";
    for (int i = 0; i < j->sensors.count; i++) values[i] = daylight_factor(values[i], STATE_OVERCAST_LUX);
    return add_areas(j, &r, values, err) ? err->status : draw(j, &r, values, err);
}

static enum status add_state(struct levels_job *j, int number, double *values, struct err *err)
{
    const struct light_state *state = &j->states.items[number];
    struct state_weights w = {0};
    struct reading r;
    if (!level_weights_make(&w, state, &j->states, &j->light.groups, &j->params, err)) {
        if (!begin_reading(&r, j, state, &w)) {
            log_warn(
                "the state %s has lamps and a sky that was not photographed; their sum needs lux/scale.txt, and is "
                "left out. Measure a point (lux.txt), or say `lamps off`.",
                state->name);
        } else {
            for (int i = 0; i < j->sensors.count; i++) {
                double sums[2];
                level_points_sum(sums, &j->levels, i, &w, j->light.groups.field);
                values[i] = r.factors[0] * sums[0] + r.factors[1] * sums[1];
            }
            if (!add_areas(j, &r, values, err) && !add_faces(j, &r, &w, err)) draw(j, &r, values, err);
            if (!err->status && number == STATE_OVERCAST) add_daylight_factor(j, &r, values, err);
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

static enum status add_year(struct levels_job *j, double *values, struct err *err)
{
    struct daylight_point *counts = calloc((size_t)j->sensors.count + 1, sizeof *counts);
    int hours;
    if (!counts) return err_nomem(err, "points", (size_t)j->sensors.count * sizeof *counts);
    level_year_count(counts, &hours, &j->levels, &j->light, &j->weather, j->states.north, &j->params, err);
    if (!err->status && hours < DAYLIGHT_HOURS)
        log_warn("%s has %d of the %d hours from %d to %d o'clock; the figures of the year are those of these.",
                 j->files.weather, hours, DAYLIGHT_HOURS, DAYLIGHT_FROM, DAYLIGHT_TO);
    for (int k = 0; !err->status && k < ANNUAL; k++) {
        const struct reading r = {annual[k].name, annual[k].unit, {0, 0}, 0, 0};
        for (int i = 0; i < j->sensors.count; i++) values[i] = annual_value(k, &counts[i]);
        if (!add_areas(j, &r, values, err) && k == 2) draw(j, &r, values, err);
    }
    free(counts);
    return err->status;
}

enum status level_sheet_make(struct levels_job *j, struct err *err)
{
    char path[FILE_PATH];
    double *values = malloc(((size_t)j->sensors.count + 1) * sizeof *values);
    if (!values) return err_nomem(err, "points", (size_t)j->sensors.count * sizeof *values);
    for (int i = 0; !err->status && i < j->states.count; i++) add_state(j, i, values, err);
    if (!err->status && j->files.weather) add_year(j, values, err);
    free(values);
    if (err->status || product_path_in(path, j->out, PRODUCT_LIGHT_SHEET, &(struct product_key){0}, err))
        return err->status;
    return sheet_write(&j->sheet, j->files.before ? &j->before : NULL, path, &j->prov, err);
}
