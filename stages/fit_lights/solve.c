/* solve.c - see solve.h.
 *
 * Beta comes first, because a lit point counts only inside of the cone: from the steps along lines, with the lamp's
 * radiance unknown. Then all lamps' radiances, exponents and the materials are fitted together; then beta again, with
 * the radiance known and the other lamps' light added; then the radiances again. What unsaturated views show of a lamp
 * itself is compared with that and, if it agrees, counts in a last fit. A lamp without lit points is measured where
 * views show it: where it saturates, its radiance is only a lower bound. */
#include "stages/fit_lights/solve.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/textfile.h"
#include "common/math/numbers.h"
#include "common/math/weighted.h"
#include "common/product/product.h"
#include "stages/fit_lights/fit.h"
#include "stages/fit_lights/lines.h"

enum { PLACE_SIZE = 512, LINE_STRIDE = 8 /* of a line's points, one in so many is fitted */ };
#define CONFIDENCE 1.96 /* standard errors of an interval of 95 % */

static const char *const source_words[] = {"given", "fitted", "measured", "bound"};

void solve_release(struct solved_lights *s)
{
    for (int i = 0; i < s->point_count; i++) free((char *)s->points[i].place);
    free(s->lamps);
    free(s->materials);
    free(s->points);
    free(s->point_notes);
    *s = (struct solved_lights){0};
}

static const struct annotation *note_of_lamp(const struct solve_inputs *in, int lamp)
{
    return &in->notes->items[in->scene->lamp_notes[lamp]];
}

/* ------------------------------------------------------------------------------------------- lamps seen themselves */

static void measure_lamp(struct lamp_result *r, const struct solve_inputs *in, int lamp)
{
    const struct lamp *l = &in->scene->lights.lamps[lamp];
    const struct observations *o = in->seen;
    struct weighted *values = calloc((size_t)o->sight_count + 1, sizeof *values);
    if (!values) return; /* a check less */
    for (int i = 0; i < o->sight_count; i++)
        if (o->sights[i].lamp == lamp && o->sights[i].angle < l->beta) r->saturated += o->sights[i].saturated;
    for (int c = 0; c < 3; c++) {
        size_t n = 0;
        double most = 0;
        for (int i = 0; i < o->sight_count; i++) {
            const struct lamp_sight *s = &o->sights[i];
            if (s->lamp != lamp || s->angle >= l->beta) continue;
            const double towards_normal = s->radiance[c] / fmax(pow(cos(s->angle), l->exponent), 1e-3);
            if (s->saturated)
                most = fmax(most, s->radiance[c]);
            else
                values[n++] = (struct weighted){towards_normal, 1};
        }
        r->unsaturated = (int)n;
        r->seen[c] = n ? weighted_percentile(values, n, 0.5) : most;
        for (size_t i = 0; i < n; i++) values[i].value = fabs(values[i].value - r->seen[c]);
        r->seen_error[c] = n ? weighted_percentile(values, n, 0.5) / 0.6745 / sqrt((double)n) : 0;
    }
    free(values);
}

/* Says where the fit and the lamp's own picture disagree. */
static void compare(struct lamp_result *r, const struct lamp *l)
{
    const double s[3] = {l->radiance.r, l->radiance.g, l->radiance.b};
    for (int c = 0; c < 3; c++) {
        const double interval = CONFIDENCE * hypot(r->radiance_error[c], r->seen_error[c]), off = r->seen[c] - s[c];
        if (r->unsaturated ? fabs(off) <= interval : off <= interval) continue;
        r->disagrees = true;
        log_warn("the lamp %s: its fitted radiance of %.4g +- %.2g disagrees with %s %.4g that views show of the lamp "
                 "(colour %d); check its points, its cone and the indirect light.",
                 l->name, s[c], CONFIDENCE * r->radiance_error[c], r->unsaturated ? "the" : "the lower bound of",
                 r->seen[c], c + 1);
        return;
    }
}

/* ---------------------------------------------------------------------------------------------- the points of a fit */

/* The median colour over the photos that show a point. False: none does. */
static bool summarize(struct fit_point *p, const struct observations *o, int point, int *next)
{
    struct weighted values[3][64];
    double sigma = 0;
    int n = 0;
    for (; *next < o->count && o->items[*next].point <= point; ++*next) {
        const struct observation *s = &o->items[*next];
        if (s->point < point || n == 64) continue;
        if (!(fmin(s->radiance[0], fmin(s->radiance[1], s->radiance[2])) > 0)) continue;
        for (int c = 0; c < 3; c++) values[c][n] = (struct weighted){s->radiance[c], 1};
        sigma += s->sigma;
        n++;
    }
    for (int c = 0; n && c < 3; c++) p->radiance[c] = weighted_percentile(values[c], (size_t)n, 0.5);
    p->sigma = n ? sigma / n / sqrt(n) : 0;
    return n > 0;
}

static enum status refuse_saturated(const struct solve_inputs *in, struct err *err)
{
    for (int k = 0; k < in->notes->count; k++) {
        const struct annotation *a = &in->notes->items[k];
        int clipped = 0, seen = 0;
        if (a->kind != NOTE_LIT && a->kind != NOTE_UNLIT) continue;
        for (int i = 0; i < in->scene->point_count; i++)
            if (in->scene->points[i].note == k) clipped += in->seen->clipped_points[i];
        for (int i = 0; i < in->seen->count; i++) seen += in->scene->points[in->seen->items[i].point].note == k;
        if (!seen && clipped)
            return err_set(
                err, ST_DATA,
                "%s:%d: all views are saturated or dark at the points of %s; choose points that some exposure "
                "measures.",
                in->notes->path, a->line, a->name);
        if (!seen)
            return err_set(err, ST_DATA, "%s:%d: no view shows the points of %s; choose points that no view loses.",
                           in->notes->path, a->line, a->name);
    }
    return ST_OK;
}

/* The name of what a lamp's points are of. */
static const char *material_name(const struct solve_inputs *in, int lamp)
{
    for (int i = 0; i < in->scene->point_count; i++) {
        const struct lit_point *p = &in->scene->points[i];
        if (p->lamp == lamp && p->kind != NOTE_LINE && in->notes->items[p->note].material)
            return in->notes->items[p->note].material;
    }
    return in->scene->lights.lamps[lamp].name;
}

/* The index of a lamp's material, which is added if it is new. There are no more materials than lamps. */
static int material_of(struct solved_lights *s, const struct solve_inputs *in, int lamp)
{
    const char *name = material_name(in, lamp);
    for (int m = 0; m < s->material_count; m++)
        if (!strcmp(s->materials[m].name, name)) return m;
    s->materials[s->material_count] = (struct fit_material){.name = name};
    return s->material_count++;
}

static bool has_points(const struct solve_inputs *in, int lamp)
{
    bool found = false;
    for (int i = 0; i < in->scene->point_count; i++)
        found |= in->scene->points[i].lamp == lamp && in->scene->points[i].kind != NOTE_LINE;
    return found;
}

static bool is_fitted(const struct solve_inputs *in, int lamp)
{
    return !note_of_lamp(in, lamp)->has_radiance && has_points(in, lamp);
}

static enum fit_point_kind point_kind(const struct lit_point *p)
{
    if (p->kind == NOTE_LINE) return POINT_ACROSS;
    return p->kind == NOTE_LIT ? POINT_LIT : POINT_UNLIT;
}

static enum status list_points(struct solved_lights *s, const struct solve_inputs *in, struct err *err)
{
    const size_t most = (size_t)in->scene->point_count + 1;
    int next = 0;
    s->points = calloc(most, sizeof *s->points);
    s->point_notes = calloc(most, sizeof *s->point_notes);
    if (!s->points || !s->point_notes) return err_nomem(err, "points", most * sizeof *s->points);
    for (int i = 0; i < in->scene->point_count; i++) {
        const struct lit_point *p = &in->scene->points[i];
        struct fit_point *q = &s->points[s->point_count];
        if (p->kind == NOTE_LINE && (!is_fitted(in, p->lamp) || i % LINE_STRIDE)) continue;
        *q = (struct fit_point){
            .material = material_of(s, in, p->lamp), .lamp = p->lamp, .kind = point_kind(p), .at = p->at};
        if (!summarize(q, in->seen, i, &next)) continue;
        char place[PLACE_SIZE];
        snprintf(place, sizeof place, "%s:%d", in->notes->path, in->notes->items[p->note].line);
        q->place = strdup(place);
        if (!q->place) return err_nomem(err, "a place", sizeof place);
        memcpy(q->indirect, in->indirect[i], sizeof q->indirect);
        s->point_notes[s->point_count++] = i;
    }
    return refuse_saturated(in, err);
}

/* ---------------------------------------------------------------------------------------------------------- the fit */

struct fit_ctx {
    const struct solve_inputs *in;
    const int *points; /* of the scene, for each of the fit */
};

static double direct_at(const void *ctx, int lamp, int point, double exponent)
{
    const struct fit_ctx *c = ctx;
    return direct_light_at(c->in->direct, lamp, c->points[point], c->in->scene->lights.lamps[lamp].beta, exponent);
}

/* What unsaturated views show of a lamp itself, unless it disagrees: they may show something else there. The exponent
 * of a lamp, if that is fitted, would have to be known. */
static void add_seen(struct fit_lamp *l, const struct lamp_result *r, const struct solve_inputs *in)
{
    for (int c = 0; r->unsaturated && !r->disagrees && !l->fit_exponent && c < 3; c++) {
        if (!(r->seen[c] > 0)) return;
        l->seen[c] = r->seen[c];
        l->seen_error[c] = hypot(r->seen_error[c] / r->seen[c], in->params->seen_error);
    }
}

/* Before beta is known well, points near a cone's edge may seem to be of another material. */
enum pass { PASS_PROVISIONAL, PASS_POINTS, PASS_POINTS_AND_PICTURES };

static enum status fit_radiances(struct solved_lights *s, const struct solve_inputs *in, enum pass pass,
                                 struct err *err)
{
    struct light_list *list = &in->scene->lights;
    struct fit_lamp *lamps = calloc((size_t)list->lamp_count + 1, sizeof *lamps);
    const struct fit_ctx ctx = {in, s->point_notes};
    if (!lamps) return err_nomem(err, "lamps", (size_t)list->lamp_count * sizeof *lamps);
    for (int i = 0; i < list->lamp_count; i++) {
        const struct lamp *l = &list->lamps[i];
        const bool fit = is_fitted(in, i);
        lamps[i] = (struct fit_lamp){.name = l->name,
                                     .material = fit ? material_of(s, in, i) : -1,
                                     .fit = fit,
                                     .fit_exponent = fit && note_of_lamp(in, i)->has_exponent == QUANTITY_FIT,
                                     .radiance = {l->radiance.r, l->radiance.g, l->radiance.b},
                                     .exponent = l->exponent};
        if (pass == PASS_POINTS_AND_PICTURES) add_seen(&lamps[i], &s->lamps[i], in);
    }
    struct light_fit f = {s->points,
                          lamps,
                          s->materials,
                          s->point_count,
                          list->lamp_count,
                          s->material_count,
                          direct_at,
                          &ctx,
                          in->params->texture,
                          pass == PASS_PROVISIONAL ? INFINITY : in->params->max_spread,
                          in->params->irradiance_error};
    fit_solve(&f, err);
    for (int i = 0; !err->status && i < list->lamp_count; i++) {
        struct lamp *l = &list->lamps[i];
        if (!lamps[i].fit) continue;
        l->radiance = rgb_make(lamps[i].radiance[0], lamps[i].radiance[1], lamps[i].radiance[2]);
        l->exponent = lamps[i].exponent;
        memcpy(s->lamps[i].radiance_error, lamps[i].radiance_error, sizeof lamps[i].radiance_error);
        s->lamps[i].exponent_error = lamps[i].exponent_error;
        s->lamps[i].source = LAMP_FITTED;
    }
    free(lamps);
    return err->status;
}

/* What the annotations give, and where a fit begins. */
static void begin_lamps(struct solved_lights *s, const struct solve_inputs *in)
{
    for (int i = 0; i < in->scene->lights.lamp_count; i++) {
        const struct annotation *a = note_of_lamp(in, i);
        struct lamp *l = &in->scene->lights.lamps[i];
        s->lamps[i].source = LAMP_GIVEN;
        if (a->has_radiance) l->radiance = rgb_make(a->radiance[0], a->radiance[1], a->radiance[2]);
        if (a->has_exponent == QUANTITY_FIT) l->exponent = 1;
    }
}

/* Lamps without points have the radiance that views show. */
static enum status take_seen(struct solved_lights *s, const struct solve_inputs *in, struct err *err)
{
    for (int i = 0; i < in->scene->lights.lamp_count; i++) {
        struct lamp_result *r = &s->lamps[i];
        struct lamp *l = &in->scene->lights.lamps[i];
        const struct annotation *a = note_of_lamp(in, i);
        measure_lamp(r, in, i);
        if (a->has_radiance || is_fitted(in, i)) continue;
        if (!r->unsaturated && !r->saturated)
            return err_set(
                err, ST_DATA,
                "%s:%d: nothing says how bright the lamp %s is: it has no lit and unlit points, and no view shows it "
                "large enough%s; add lit and unlit points, or radiance R G B.",
                in->notes->path, a->line, a->name, l->beta < 1.5 ? " within its cone" : "");
        l->radiance = rgb_make(r->seen[0], r->seen[1], r->seen[2]);
        l->bound = !r->unsaturated;
        r->source = l->bound ? LAMP_BOUND : LAMP_MEASURED;
        memcpy(r->radiance_error, r->seen_error, sizeof r->seen_error);
        if (l->bound)
            log_warn("the lamp %s is saturated in all %d views that show it, so its radiance of %.4g %.4g %.4g is a "
                     "lower bound; "
                     "annotate lit and unlit points.",
                     l->name, r->saturated, r->seen[0], r->seen[1], r->seen[2]);
    }
    return ST_OK;
}

static enum status fit_cones(struct solved_lights *s, const struct solve_inputs *in, bool known, struct err *err)
{
    for (int i = 0; i < in->scene->lights.lamp_count; i++) {
        const struct annotation *a = note_of_lamp(in, i);
        const bool wanted = lines_of_lamp(in->scene, i) > 0;
        if (!wanted && a->has_beta == QUANTITY_FIT)
            return err_set(err, ST_DATA,
                           "%s:%d: the beta of the lamp %s is to be fitted, but it has no line; add \"line %s in VIEW "
                           "X Y X Y\" across the edge of its cone.",
                           in->notes->path, a->line, a->name, a->name);
        if (wanted && lines_fit_beta(&s->lamps[i].beta_error, in, i, known, err)) return err->status;
    }
    return ST_OK;
}

enum status solve_lights(struct solved_lights *s, const struct solve_inputs *in, struct err *err)
{
    const int lamps = in->scene->lights.lamp_count;
    *s = (struct solved_lights){.lamps = calloc((size_t)lamps + 1, sizeof *s->lamps),
                                .materials = calloc((size_t)lamps + 1, sizeof *s->materials),
                                .lamp_count = lamps};
    if (!s->lamps || !s->materials) return err_nomem(err, "lamps", (size_t)lamps * sizeof *s->lamps);
    begin_lamps(s, in);
    if (list_points(s, in, err) || fit_cones(s, in, false, err) || take_seen(s, in, err) ||
        fit_radiances(s, in, PASS_PROVISIONAL, err) || fit_cones(s, in, true, err) ||
        fit_radiances(s, in, PASS_POINTS, err))
        return err->status;
    bool seen = false;
    for (int i = 0; i < lamps; i++) {
        if (s->lamps[i].source != LAMP_FITTED) continue;
        compare(&s->lamps[i], &in->scene->lights.lamps[i]);
        seen |= s->lamps[i].unsaturated > 0 && !s->lamps[i].disagrees;
    }
    return seen ? fit_radiances(s, in, PASS_POINTS_AND_PICTURES, err) : ST_OK;
}

/* ---------------------------------------------------------------------------------------------------------- fit.txt */

static void write_lamp(const struct solved_lights *s, const struct solve_inputs *in, int i, FILE *to)
{
    const struct lamp *l = &in->scene->lights.lamps[i];
    const struct lamp_result *r = &s->lamps[i];
    char name[600];
    struct err ignored = ERR_INIT;
    if (textfile_quote(l->name, name, sizeof name, &ignored)) return; /* as the reader took it, it fits */
    fprintf(to, "lamp %s %s %.9g %.9g %.9g %.4g %.4g %.4g beta %.9g %.4g exponent %.9g %.4g\n", name,
            source_words[r->source], l->radiance.r, l->radiance.g, l->radiance.b, CONFIDENCE * r->radiance_error[0],
            CONFIDENCE * r->radiance_error[1], CONFIDENCE * r->radiance_error[2], l->beta / DEGREE,
            CONFIDENCE * r->beta_error / DEGREE, l->exponent, CONFIDENCE * r->exponent_error);
    if (r->unsaturated || r->saturated)
        fprintf(to, "seen %s %.9g %.9g %.9g %.4g %.4g %.4g unsaturated %d saturated %d%s\n", name, r->seen[0],
                r->seen[1], r->seen[2], CONFIDENCE * r->seen_error[0], CONFIDENCE * r->seen_error[1],
                CONFIDENCE * r->seen_error[2], r->unsaturated, r->saturated, r->disagrees ? " disagrees" : "");
}

static void write_material(const struct fit_material *m, FILE *to)
{
    char name[600];
    struct err ignored = ERR_INIT;
    if (textfile_quote(m->name, name, sizeof name, &ignored)) return;
    fprintf(to, "material %s %.9g %.9g %.9g %.4g %.4g %.4g spread %.4g lit %d unlit %d\n", name, m->k_d[0], m->k_d[1],
            m->k_d[2], CONFIDENCE * m->k_d_error[0], CONFIDENCE * m->k_d_error[1], CONFIDENCE * m->k_d_error[2],
            m->spread, m->lit, m->unlit);
}

/* The observed radiance and the one that the fit explains. */
static void write_point(const struct solved_lights *s, const struct solve_inputs *in, int i, FILE *to)
{
    const struct fit_point *p = &s->points[i];
    const struct light_list *list = &in->scene->lights;
    const int point = s->point_notes[i];
    const struct vec3 at = in->scene->points[point].at;
    double e[3];
    memcpy(e, p->indirect, sizeof e);
    for (int l = 0; l < list->lamp_count; l++) {
        const double d = direct_light_at(in->direct, l, point, list->lamps[l].beta, list->lamps[l].exponent);
        e[0] += d * list->lamps[l].radiance.r;
        e[1] += d * list->lamps[l].radiance.g;
        e[2] += d * list->lamps[l].radiance.b;
    }
    const double *k = s->materials[p->material].k_d;
    char name[600];
    struct err ignored = ERR_INIT;
    if (textfile_quote(list->lamps[p->lamp].name, name, sizeof name, &ignored)) return;
    fprintf(to,
            "point %d %s %.6g %.6g %.6g radiance %.6g %.6g %.6g explained %.6g %.6g %.6g "
            "indirect %.6g %.6g %.6g lamp %s\n",
            in->notes->items[in->scene->points[point].note].line, p->kind == POINT_LIT ? "lit" : "unlit", at.x, at.y,
            at.z, p->radiance[0], p->radiance[1], p->radiance[2], k[0] * e[0], k[1] * e[1], k[2] * e[2], p->indirect[0],
            p->indirect[1], p->indirect[2], name);
}

enum status solve_write(const struct solved_lights *s, const struct solve_inputs *in, const char *path,
                        const struct provenance *prov, struct err *err)
{
    struct outfile f = {0};
    product_begin(&f, PRODUCT_LIGHT_FIT, path, prov, err);
    for (int i = 0; !err->status && i < s->lamp_count; i++) write_lamp(s, in, i, f.fp);
    for (int i = 0; !err->status && i < s->material_count; i++) write_material(&s->materials[i], f.fp);
    for (int i = 0; !err->status && i < s->point_count; i++)
        if (s->points[i].kind != POINT_ACROSS) write_point(s, in, i, f.fp);
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}
