/* level_factors.c - see level_factors.h.
 *
 * A measurement in a state is a sum over groups: their light at the place, as photographed, times the scale to lx,
 * times a factor that the fit finds (group_fit.h). Its error is twice [light_levels] error, since a place is less
 * certain than an area, and the meter's. Planned lamps and computed skies are in lx, and are taken as they are. Without
 * a scale, the median of what the measurements say with all factors 1 is the scale. Photos in other light
 * (other_light.h) say how groups compare; a patch of them is as uncertain as a place. */
#include "stages/light_levels/level_factors.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"
#include "common/math/weighted.h"
#include "common/product/product.h"

static const double NORMAL_95 = 1.959964, SPREAD = 0.5, SHARED = 0.05, OFF = 3; /* SHARED: error of all meters alike */
static const double UNLIKE = 0.3; /* misfit of a photo that was taken in another state */
static const double PLACE = 2;    /* a place is that much less certain than the mean of an area */

void level_factors_release(struct level_factors *f)
{
    free(f->list);
    free(f->of_groups);
    *f = (struct level_factors){.count = 0};
}

static int count_of(const struct light_groups *g) { return g->rest + 1 + g->windows_count; }

/* The kind and the name of a factor; "": the rest. */
static const char *word_of(const struct light_groups *g, int factor, const char **name)
{
    *name = factor < g->rest ? g->field->lights.lamps[factor].name : "";
    if (factor <= g->rest) return factor < g->rest ? "lamp" : "rest";
    *name = g->windows[factor - g->rest - 1].name;
    return "window";
}

static enum status allocate(struct level_factors *f, const struct light_groups *g, struct err *err)
{
    f->count = count_of(g);
    f->list = calloc((size_t)f->count + 1, sizeof *f->list);
    f->of_groups = calloc((size_t)g->count + 1, sizeof *f->of_groups);
    if (!f->list || !f->of_groups) return err_nomem(err, "groups of light", (size_t)f->count * sizeof *f->list);
    for (int i = 0; i < f->count; i++) f->list[i] = (struct group_factor){1, 0, 0, 0};
    return ST_OK;
}

static void spread_out(const struct level_factors *f, const struct light_groups *g)
{
    for (int i = 0; i <= g->rest; i++) f->of_groups[i] = f->list[i].factor;
    for (int v = 0; v < g->windows_count; v++)
        f->of_groups[g->sky + v] = f->of_groups[g->sun + v] = f->list[g->rest + 1 + v].factor;
}

/* ----------------------------------------------------------------------------------------------------- measurements */

static const struct sensor_area *find_place(const struct sensors *s, const char *name)
{
    for (int k = 0; k < s->area_count; k++)
        if (s->areas[k].kind == SENSOR_PLACE && !strcmp(s->areas[k].name, name)) return &s->areas[k];
    return NULL;
}

/* The light of each factor at an area in a state, in the photographs' unit, and all that is in lx. */
static void add_light(struct group_measurement *m, const struct factor_sources *from, const struct sensor_area *a,
                      const struct state_weights *w)
{
    const struct light_groups *g = &from->light->groups;
    for (int i = a->first; i < a->first + a->count; i++) {
        const float *own = from->points->whole + (size_t)i * (size_t)from->points->groups;
        double sums[2];
        for (int k = 0; k <= g->rest; k++) m->light[k] += w->relative[k] * (double)own[k] / a->count;
        for (int v = 0; v < g->windows_count; v++)
            m->light[g->rest + 1 + v] += (w->relative[g->sky + v] * (double)own[g->sky + v] +
                                          w->relative[g->sun + v] * (double)own[g->sun + v]) /
                                         a->count;
        level_points_sum(sums, from->points, i, w, g->field);
        m->other += sums[1] / a->count;
    }
}

static enum status read_one(struct group_measurement *m, const struct factor_sources *from, int which, struct err *err)
{
    const struct state_measured *is = &from->states->measured[which];
    const struct sensor_area *area = find_place(from->sensors, is->place);
    struct state_weights w = {0};
    double sum = 0;
    if (!area)
        return err_set(err, ST_DATA, "%s:%d: found a measurement at %s, wanted a place of places.txt.",
                       from->states->path, is->line, is->place);
    if (!level_weights_make(&w, &from->states->items[is->state], from->states, &from->light->groups, from->params, err))
        add_light(m, from, area, &w);
    level_weights_release(&w);
    for (int k = 0; k < count_of(&from->light->groups); k++) sum += m->light[k];
    if (!err->status && !(sum > 0))
        return err_set(err, ST_DATA,
                       "%s:%d: in the state %s no lamp and no window of the photographs brings light to %s; measure in "
                       "a state with some.",
                       from->states->path, is->line, from->states->items[is->state].name, is->place);
    const double meter = is->within / NORMAL_95, model = PLACE * from->params->error;
    m->lux = is->lux;
    m->error = sqrt(meter * meter + model * model);
    return err->status;
}

static double sum_of(const struct group_measurement *m, int groups)
{
    double sum = 0;
    for (int k = 0; k < groups; k++) sum += m->light[k];
    return sum;
}

/* The median of what each measurement says. */
static enum status find_scale(struct lux_interval *scale, const struct group_measurement *m, int count, int groups,
                              struct err *err)
{
    struct weighted *room = malloc(((size_t)count + 1) * sizeof *room);
    double error = 0;
    size_t n = 0;
    if (!room) return err_nomem(err, "measurements", (size_t)count * sizeof *room);
    for (int i = 0; i < count; i++) {
        error = fmax(error, m[i].error);
        if (m[i].lux > m[i].other) room[n++] = (struct weighted){(m[i].lux - m[i].other) / sum_of(&m[i], groups), 1};
    }
    if (n) {
        const double away = exp(NORMAL_95 * sqrt(error * error / (double)n + SHARED * SHARED));
        scale->scale = weighted_percentile(room, n, 0.5);
        scale->low = scale->scale / away;
        scale->high = scale->scale * away;
    }
    free(room);
    return n ? ST_OK
             : err_set(err, ST_DATA, "no measurement has more light than computed skies and planned lamps give.");
}

static void report_photo(const struct factor_sources *from, int which)
{
    const struct group_photo *photo = &from->photos->photos[which];
    const struct state_photo *is = &from->states->photos[which];
    const char *state = from->states->items[is->state].name;
    log_note("photo %s in %s: %d patches, exposed %.3g times as the others, off by %.2g %% (median)", is->name, state,
             photo->count, photo->exposure, 100 * photo->misfit);
    if (photo->misfit > UNLIKE)
        log_warn("%s:%d: the photo %s does not show the light of %s: its patches are off by %.2g %% in the median; "
                 "check the state.",
                 from->states->path, is->line, is->name, state, 100 * photo->misfit);
}

static void report(const struct level_factors *f, const struct factor_sources *from, const struct group_measurement *m)
{
    for (int i = 0; i < f->count; i++) {
        const struct group_factor *is = &f->list[i];
        const char *name, *word = word_of(&from->light->groups, i, &name);
        if (is->measurements)
            log_note("%s %s: %.3g (%.3g to %.3g) times as photographed, by %d measurement%s", word, name, is->factor,
                     is->low, is->high, is->measurements, is->measurements == 1 ? "" : "s");
    }
    for (int k = 0; k < from->photos->count; k++) report_photo(from, k);
    for (int k = 0; k < from->states->measured_count; k++) {
        const struct state_measured *is = &from->states->measured[k];
        if (fabs(m[k].deviation) > OFF)
            log_warn("%s:%d: %g lx at %s are %.1f standard errors from what the lamps and windows can give; check the "
                     "place and the state.",
                     from->states->path, is->line, is->lux, is->place, m[k].deviation);
    }
}

enum status level_factors_make(struct level_factors *f, const struct factor_sources *from, struct err *err)
{
    const struct light_groups *g = &from->light->groups;
    const int count = from->states->measured_count, groups = count_of(g);
    *f = (struct level_factors){.count = 0};
    if (!count && !from->photos->count) return ST_OK;
    struct group_measurement *m = calloc((size_t)count + 1, sizeof *m);
    double *light = calloc((size_t)count * (size_t)groups + 1, sizeof *light);
    if (!m || !light) err_nomem(err, "measurements", (size_t)count * (size_t)groups * sizeof *light);
    for (int k = 0; !err->status && k < count; k++) {
        m[k].light = light + (size_t)k * (size_t)groups;
        read_one(&m[k], from, k, err);
    }
    f->scale = from->scale;
    if (!err->status && count && !(f->scale.scale > 0)) find_scale(&f->scale, m, count, groups, err);
    for (int i = 0; !err->status && i < count * groups; i++) light[i] *= f->scale.scale;
    if (!err->status && !allocate(f, g, err) &&
        !group_fit_photos(f->list, groups, m, count, from->photos->photos, from->photos->count,
                          PLACE * from->params->error, SPREAD, err)) {
        spread_out(f, g);
        report(f, from, m);
    }
    free(light);
    free(m);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------- file */

enum status level_factors_write(const struct level_factors *f, const struct light_groups *groups, const char *path,
                                const struct provenance *prov, struct err *err)
{
    struct outfile file = {0};
    if (product_begin(&file, PRODUCT_LIGHT_FACTORS, path, prov, err)) return err->status;
    const locale_t was = uselocale(scan_c_locale());
    fprintf(file.fp, "scale %.9g %.9g %.9g\n", f->count ? f->scale.scale : 0, f->count ? f->scale.low : 0,
            f->count ? f->scale.high : 0);
    for (int i = 0; !err->status && i < f->count; i++) {
        const char *name, *word = word_of(groups, i, &name);
        char quoted[1024] = "";
        if (i != groups->rest && textfile_quote(name, quoted, sizeof quoted, err)) break;
        fprintf(file.fp, "%s %s%s%.9g %.9g %.9g %d\n", word, quoted, *quoted ? " " : "", f->list[i].factor,
                f->list[i].low, f->list[i].high, f->list[i].measurements);
    }
    uselocale(was);
    if (!err->status) outfile_commit(&file, err);
    outfile_discard(&file);
    return err->status;
}

static int find_factor(const struct light_groups *g, const char *word, const char *name)
{
    for (int i = 0; i < count_of(g); i++) {
        const char *own, *is = word_of(g, i, &own);
        if (!strcmp(is, word) && !strcmp(own, name)) return i;
    }
    return -1;
}

static enum status read_line(struct level_factors *f, const struct light_groups *g, struct textfile *t, struct err *err)
{
    char *word, *name = NULL;
    struct group_factor is;
    int64_t count;
    if (textfile_word(t, "lamp, rest or window", &word, err)) return err->status;
    if (strcmp(word, "rest") != 0 && textfile_word(t, "a name", &name, err)) return err->status;
    if (textfile_number(t, "a factor", 0, INFINITY, &is.factor, err) ||
        textfile_number(t, "an end of an interval", 0, INFINITY, &is.low, err) ||
        textfile_number(t, "an end of an interval", is.low, INFINITY, &is.high, err) ||
        textfile_int(t, "a count", 0, INT32_MAX, &count, err))
        return err->status;
    const int at = find_factor(g, word, name ? name : "");
    is.measurements = (int)count;
    if (at >= 0) f->list[at] = is;
    return textfile_end(t, err);
}

enum status level_factors_read(struct level_factors *f, const struct light_groups *groups, const char *path,
                               struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    *f = (struct level_factors){.count = 0};
    if (!product_open(&t, NULL, PRODUCT_LIGHT_FACTORS, path, prov, err) && !allocate(f, groups, err) &&
        !textfile_expect_line(&t, "scale", err) && !textfile_number(&t, "a scale", 0, INFINITY, &f->scale.scale, err) &&
        !textfile_number(&t, "an end of an interval", 0, INFINITY, &f->scale.low, err))
        textfile_number(&t, "an end of an interval", 0, INFINITY, &f->scale.high, err);
    bool any = false;
    while (!err->status && textfile_next(&t)) any = !read_line(f, groups, &t, err);
    textfile_release(&t);
    if (err->status || !any)
        level_factors_release(f);
    else
        spread_out(f, groups);
    return err->status;
}
