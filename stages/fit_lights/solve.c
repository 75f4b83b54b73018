/* solve.c - see solve.h.
 *
 * Beta comes first, because a lit point counts only inside of the cone: from the steps along lines, with the lamp's
 * radiance unknown. Then all lamps' radiances, exponents and the materials are fitted together; then beta again, with
 * the radiance known and the other lamps' light added; then the radiances again. What unsaturated views show of a lamp
 * itself is compared with that and, if it agrees, counts in a last fit; where the lamp saturates, as a lower bound. A
 * lamp without marks is measured where views show it; where it saturates, its radiance is fitted to the light that it
 * casts on the faces about it (lit_scene.c).
 *
 * Counted once. The irradiance without the lamps is gathered from the room as it was photographed, with the lamps'
 * own light in everything that they light, and only what the lamps show themselves is left out (field_atlas.c). So E
 * holds all reflections of the lamps' light, and S D what comes straight from them.
 *
 * Nothing stops the fit. Marks that no photo measures or that the others contradict, and cones whose edge is not found,
 * are named in warnings. A lamp of which nothing is known stays as photographed. */
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
#include "stages/fit_lights/fit_problem.h"
#include "stages/fit_lights/lines.h"

enum { NAME_SIZE = 600, LINE_STRIDE = 8 /* of a line's points, one in so many is fitted */ };
#define CONFIDENCE  1.96 /* standard errors of an interval of 95 % */
#define UNKNOWN     30.0 /* a radiance whose interval spans this factor is not known */
#define SAME_PLANE  0.02 /* of the model's height: points of a wall are so near to one plane, */
#define SAME_NORMAL 0.98 /* and the cosine between their normals is at least this */
#define LEAST_OFF   0.15 /* of its radiance, by which a mark is off before it is named, */
#define SURE_OFF    2.5  /* and standard errors */
#define TOLD        0.25 /* standard error of what all faces tell of a lamp, below which its marks do not count */

static const char *const source_words[] = {"given", "fitted", "measured", "bound", "unknown"};

void solve_release(struct solved_lights *s)
{
    for (int i = 0; i < s->material_count; i++) free((char *)s->materials[i].name);
    free(s->lamps);
    free(s->materials);
    free(s->marks);
    free(s->points);
    free(s->point_notes);
    *s = (struct solved_lights){0};
}

static const struct annotation *note_of_lamp(const struct solve_inputs *in, int lamp)
{
    return &in->notes->items[in->scene->lamp_notes[lamp]];
}

/* Whether all faces tell of a lamp. A cone is a spot on a face or two, which may be of another material there: marks on
 * both sides of its edge tell more. A fitted exponent would have to be known. */
static bool has_faces(const struct solve_inputs *in, int lamp)
{
    const struct annotation *a = note_of_lamp(in, lamp);
    const bool is_cone = in->scene->lights.lamps[lamp].beta < 0.5 * PI;
    return in->faces && in->faces[lamp].is_known && !a->has_radiance && a->has_exponent != QUANTITY_FIT && !is_cone;
}

/* Whether they tell of it so well that its marks, which lie on faces, would only count twice. If views measure the
 * lamp, all evidence counts together. */
static bool is_told(const struct solved_lights *s, const struct solve_inputs *in, int lamp)
{
    bool told = has_faces(in, lamp) && !s->lamps[lamp].unsaturated;
    for (int c = 0; told && c < 3; c++) told = in->faces[lamp].error[c] < TOLD;
    return told;
}

/* ------------------------------------------------------------------------------------------- lamps seen themselves */

static bool is_of(const struct lamp_sight *s, const struct lamp *l, int lamp)
{
    return s->lamp == lamp && s->angle < l->beta;
}

static double towards_normal(const struct lamp_sight *s, const struct lamp *l, int colour)
{
    return s->radiance[colour] / fmax(pow(cos(s->angle), l->exponent), 1e-3);
}

/* Whether most views of the lamp are saturated. Then one that shows less than half of what the brightest of them
 * shows at least does not show the lamp: something hides it there. */
static bool is_bright(const struct solve_inputs *in, int lamp)
{
    const struct observations *o = in->seen;
    int saturated = 0, all = 0;
    for (int i = 0; i < o->sight_count; i++) {
        if (!is_of(&o->sights[i], &in->scene->lights.lamps[lamp], lamp)) continue;
        saturated += o->sights[i].saturated;
        all++;
    }
    return 2 * saturated > all;
}

static bool is_hidden_in(const struct lamp_sight *s, const struct lamp *l, const double bound[3])
{
    bool hidden = !s->saturated;
    for (int c = 0; c < 3; c++) hidden &= 2 * towards_normal(s, l, c) < bound[c];
    return hidden;
}

static void measure_lamp(struct lamp_result *r, const struct solve_inputs *in, int lamp)
{
    const struct lamp *l = &in->scene->lights.lamps[lamp];
    const struct observations *o = in->seen;
    struct weighted *values = calloc((size_t)o->sight_count + 1, sizeof *values);
    double bound[3] = {0};
    if (!values) return; /* a check less */
    r->saturated = r->unsaturated = 0;
    for (int i = 0; i < o->sight_count; i++) {
        if (!is_of(&o->sights[i], l, lamp) || !o->sights[i].saturated) continue;
        for (int c = 0; c < 3; c++) bound[c] = fmax(bound[c], o->sights[i].radiance[c]);
        r->saturated++;
    }
    for (int c = 0; c < 3; c++) {
        size_t n = 0;
        for (int i = 0; i < o->sight_count; i++) {
            const struct lamp_sight *s = &o->sights[i];
            if (!is_of(s, l, lamp) || s->saturated || (is_bright(in, lamp) && is_hidden_in(s, l, bound))) continue;
            values[n++] = (struct weighted){towards_normal(s, l, c), 1};
        }
        r->unsaturated = (int)n;
        r->seen[c] = n ? weighted_percentile(values, n, 0.5) : bound[c];
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
        const double error = CONFIDENCE * r->seen_error[c];
        if (r->seen[c] - error <= r->high[c] && (!r->unsaturated || r->seen[c] + error >= r->low[c])) continue;
        r->disagrees = true;
        log_warn("the lamp %s: its fitted radiance of %.4g (%.4g to %.4g) disagrees with %s %.4g that views show of "
                 "the lamp (colour %d); check its points, its cone and the indirect light.",
                 l->name, s[c], r->low[c], r->high[c], r->unsaturated ? "the" : "the lower bound of", r->seen[c],
                 c + 1);
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

/* Warns of marks that no view measures. */
static void report_unseen(const struct solve_inputs *in)
{
    for (int k = 0; k < in->scene->mark_count; k++) {
        const struct annotation *a = &in->notes->items[in->scene->marks[k].note];
        int clipped = 0, seen = 0, points = 0;
        if (in->scene->marks[k].face >= 0) continue;
        for (int i = 0; i < in->scene->point_count; i++) {
            if (in->scene->points[i].mark != k) continue;
            clipped += in->seen->clipped_points[i];
            points++;
        }
        for (int i = 0; i < in->seen->count; i++) seen += in->scene->points[in->seen->items[i].point].mark == k;
        if (seen || !points || in->is_provisional) continue;
        log_warn("%s:%d: %s this mark (%s %s), so it does not count; choose %s.", in->notes->path, a->line,
                 clipped ? "all views are saturated or dark at" : "no view shows", annotation_word(a->kind), a->name,
                 clipped ? "places that some exposure measures" : "places that nothing hides");
    }
}

static const char *material_of_note(const struct annotation *a)
{
    if (a->material) return a->material;
    return a->kind == NOTE_LINE ? NULL : a->name;
}

/* The material of a line that does not name one: that of the lamp's marks, if they are of one; NULL: they are not. */
static const char *material_of_line(const struct solve_inputs *in, int lamp)
{
    const char *found = NULL;
    for (int i = 0; i < in->scene->mark_count; i++) {
        const struct annotation *a = &in->notes->items[in->scene->marks[i].note];
        const char *name = in->scene->marks[i].face < 0 ? material_of_note(a) : NULL;
        if (!name || a->lamp != in->scene->lamp_notes[lamp]) continue;
        if (found && strcmp(found, name)) return NULL;
        found = name;
    }
    return found;
}

static void name_material(char name[], size_t size, const struct solve_inputs *in, const struct lit_point *p)
{
    const struct lit_mark *m = &in->scene->marks[p->mark];
    const struct annotation *a = &in->notes->items[in->scene->marks[m->like >= 0 ? m->like : p->mark].note];
    if (m->face >= 0 && m->like < 0) {
        snprintf(name, size, "face %s", solid_face_name(&in->rays->mesh, m->face));
        return;
    }
    const char *own = material_of_note(a);
    if (!own) own = material_of_line(in, p->lamp);
    if (own)
        snprintf(name, size, "%s", own);
    else
        snprintf(name, size, "line %d", a->line);
}

/* The index of a point's material, which is added if it is new; -1: no memory. There are no more than marks. */
static int material_of(struct solved_lights *s, const struct solve_inputs *in, const struct lit_point *p)
{
    char name[NAME_SIZE];
    name_material(name, sizeof name, in, p);
    for (int m = 0; m < s->material_count; m++)
        if (!strcmp(s->materials[m].name, name)) return m;
    char *own = strdup(name);
    if (!own) return -1;
    s->materials[s->material_count] = (struct fit_material){.name = own};
    return s->material_count++;
}

/* Whether a mark helps to fit its lamp. Places that nobody marked do not if views measure the lamp itself. */
static bool counts(const struct solved_lights *s, const struct solve_inputs *in, const struct lit_point *p)
{
    return in->scene->marks[p->mark].face < 0 || s->lamps[p->lamp].uses_places;
}

static bool has_points(const struct solved_lights *s, const struct solve_inputs *in, int lamp)
{
    bool found = false;
    for (int i = 0; i < in->scene->point_count; i++) {
        const struct lit_point *p = &in->scene->points[i];
        found |= p->lamp == lamp && p->kind != NOTE_LINE && counts(s, in, p);
    }
    return found;
}

static bool is_fitted(const struct solved_lights *s, const struct solve_inputs *in, int lamp)
{
    if (is_told(s, in, lamp)) return true;
    return !note_of_lamp(in, lamp)->has_radiance && s->lamps[lamp].measured_points > 0;
}

static enum fit_point_kind point_kind(const struct lit_point *p)
{
    if (p->kind == NOTE_LINE) return POINT_ACROSS;
    return p->kind == NOTE_LIT ? POINT_LIT : POINT_UNLIT;
}

/* Keeps points evenly, if there are more than can be fitted. */
static void thin_points(struct solved_lights *s)
{
    const int64_t all = s->point_count;
    int kept = 0;
    for (int64_t i = 0; all > MAX_FIT_POINTS && i < all; i++) {
        if ((i + 1) * MAX_FIT_POINTS / all <= kept) continue;
        s->points[kept] = s->points[i];
        s->point_notes[kept++] = s->point_notes[i];
    }
    if (all > MAX_FIT_POINTS) s->point_count = kept;
}

/* The number of the wall of a point: that of the first point of the fit that is marked for the same lamp on the same
 * plane. */
static int wall_of(const struct solved_lights *s, const struct solve_inputs *in, const struct lit_point *p)
{
    const double off = SAME_PLANE * model_rays_height(in->rays);
    for (int i = 0; i < s->point_count; i++) {
        const struct lit_point *q = &in->scene->points[s->point_notes[i]];
        if (q->lamp == p->lamp && vec3_dot(q->normal, p->normal) > SAME_NORMAL &&
            fabs(vec3_dot(vec3_sub(p->at, q->at), q->normal)) < off)
            return s->points[i].wall;
    }
    return s->point_count;
}

static enum status list_points(struct solved_lights *s, const struct solve_inputs *in, struct err *err)
{
    const size_t most = (size_t)in->scene->point_count + 1, marks = (size_t)in->scene->mark_count + 1;
    int next = 0;
    s->points = calloc(most, sizeof *s->points);
    s->point_notes = calloc(most, sizeof *s->point_notes);
    s->materials = calloc(marks, sizeof *s->materials);
    s->marks = calloc(marks, sizeof *s->marks);
    s->mark_count = in->scene->mark_count;
    if (!s->points || !s->point_notes || !s->materials || !s->marks)
        return err_nomem(err, "points", most * sizeof *s->points);
    for (int i = 0; i < in->scene->point_count; i++) {
        const struct lit_point *p = &in->scene->points[i];
        struct fit_point *q = &s->points[s->point_count];
        if (!counts(s, in, p) || (p->kind == NOTE_LINE && (!has_points(s, in, p->lamp) || i % LINE_STRIDE))) continue;
        *q = (struct fit_point){.lamp = p->lamp, .mark = p->mark, .kind = point_kind(p), .at = p->at};
        if (!summarize(q, in->seen, i, &next)) continue;
        q->material = material_of(s, in, p);
        if (q->material < 0) return err_nomem(err, "a name", NAME_SIZE);
        memcpy(q->indirect, in->indirect[i], sizeof q->indirect);
        q->wall = wall_of(s, in, p);
        s->point_notes[s->point_count++] = i;
        s->lamps[p->lamp].measured_points += p->kind != NOTE_LINE;
    }
    thin_points(s);
    report_unseen(in);
    return ST_OK;
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

/* What views show of a lamp itself, unless it disagrees: they may show something else there. The exponent of a lamp, if
 * that is fitted, would have to be known. */
static void add_seen(struct fit_lamp *l, const struct lamp_result *r, const struct solve_inputs *in)
{
    l->seen_is_bound = !r->unsaturated;
    for (int c = 0; !r->disagrees && !(r->unsaturated && l->fit_exponent) && c < 3; c++) {
        if (!(r->seen[c] > 0)) return;
        l->seen[c] = r->seen[c];
        l->seen_error[c] = hypot(r->seen_error[c] / r->seen[c], in->params->seen_error);
    }
}

static void add_lit(struct fit_lamp *l, const struct solve_inputs *in, int lamp)
{
    if (!has_faces(in, lamp)) return;
    memcpy(l->lit, in->faces[lamp].radiance, sizeof l->lit);
    memcpy(l->lit_error, in->faces[lamp].error, sizeof l->lit_error);
}

/* The lamp has the radiance that all faces tell. All of their indirect light may be off by one factor. */
static void take_told(struct solved_lights *s, const struct solve_inputs *in, int lamp)
{
    const struct face_lamp *f = &in->faces[lamp];
    struct lamp_result *r = &s->lamps[lamp];
    for (int c = 0; c < 3; c++) {
        const double error = hypot(f->error[c], in->params->irradiance_error);
        r->low[c] = f->radiance[c] * exp(-CONFIDENCE * error);
        r->high[c] = f->radiance[c] * exp(CONFIDENCE * error);
        r->radiance_error[c] = (r->high[c] - r->low[c]) / (2 * CONFIDENCE);
    }
    in->scene->lights.lamps[lamp].radiance = rgb_make(f->radiance[0], f->radiance[1], f->radiance[2]);
    r->source = LAMP_FITTED;
}

/* Before beta is known well, points near a cone's edge may seem to be of another material. */
enum pass { PASS_PROVISIONAL, PASS_POINTS, PASS_POINTS_AND_PICTURES };

static enum status fit_radiances(struct solved_lights *s, const struct solve_inputs *in, enum pass pass,
                                 struct err *err)
{
    static const int draws[] = {0, FIT_FEW_DRAWS, FIT_DRAWS};
    struct light_list *list = &in->scene->lights;
    struct fit_lamp *lamps = calloc((size_t)list->lamp_count + 1, sizeof *lamps);
    const struct fit_ctx ctx = {in, s->point_notes};
    if (!lamps) return err_nomem(err, "lamps", (size_t)list->lamp_count * sizeof *lamps);
    for (int i = 0; i < list->lamp_count; i++) {
        const struct lamp *l = &list->lamps[i];
        const bool told = is_told(s, in, i), fit = !told && is_fitted(s, in, i);
        if (told) take_told(s, in, i);
        lamps[i] = (struct fit_lamp){.name = l->name,
                                     .fit = fit,
                                     .fit_exponent = fit && note_of_lamp(in, i)->has_exponent == QUANTITY_FIT,
                                     .radiance = {l->radiance.r, l->radiance.g, l->radiance.b},
                                     .exponent = l->exponent};
        if (pass == PASS_POINTS_AND_PICTURES) add_seen(&lamps[i], &s->lamps[i], in);
        add_lit(&lamps[i], in, i);
    }
    struct light_fit f = {.points = s->points,
                          .lamps = lamps,
                          .materials = s->materials,
                          .marks = s->marks,
                          .point_count = s->point_count,
                          .lamp_count = list->lamp_count,
                          .material_count = s->material_count,
                          .mark_count = s->mark_count,
                          .direct = direct_at,
                          .ctx = &ctx,
                          .texture = in->params->texture,
                          .irradiance_error = in->params->irradiance_error,
                          .draws = draws[pass]};
    fit_solve(&f, err);
    for (int i = 0; !err->status && i < list->lamp_count; i++) {
        struct lamp *l = &list->lamps[i];
        if (!lamps[i].fit) continue;
        l->radiance = rgb_make(lamps[i].radiance[0], lamps[i].radiance[1], lamps[i].radiance[2]);
        l->exponent = lamps[i].exponent;
        memcpy(s->lamps[i].radiance_error, lamps[i].radiance_error, sizeof lamps[i].radiance_error);
        memcpy(s->lamps[i].low, lamps[i].low, sizeof lamps[i].low);
        memcpy(s->lamps[i].high, lamps[i].high, sizeof lamps[i].high);
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

/* A lamp has the radiance that views show of it; if they saturate, that is a lower bound. */
static void take_seen(struct solved_lights *s, const struct solve_inputs *in, int lamp)
{
    struct lamp_result *r = &s->lamps[lamp];
    struct lamp *l = &in->scene->lights.lamps[lamp];
    const struct annotation *a = note_of_lamp(in, lamp);
    const bool seen = r->unsaturated || r->saturated;
    l->radiance = seen ? rgb_make(r->seen[0], r->seen[1], r->seen[2]) : rgb_grey(0);
    l->bound = !r->unsaturated;
    r->source = r->unsaturated ? LAMP_MEASURED : seen ? LAMP_BOUND : LAMP_UNKNOWN;
    memcpy(r->radiance_error, r->seen_error, sizeof r->seen_error);
    if (in->is_provisional) return;
    if (r->source == LAMP_BOUND)
        log_warn("%s:%d: the lamp %s is saturated in all %d views that show it, and nothing says how bright it is, so "
                 "its radiance of %.4g %.4g %.4g is a lower bound; mark lit and unlit points.",
                 in->notes->path, a->line, l->name, r->saturated, r->seen[0], r->seen[1], r->seen[2]);
    if (r->source == LAMP_UNKNOWN)
        log_warn("%s:%d: nothing says how bright the lamp %s is: no mark tells, and no view shows it large enough%s, "
                 "so it stays as photographed; mark lit and unlit points, or give radiance R G B.",
                 in->notes->path, a->line, l->name, l->beta < 1.5 ? " within its cone" : "");
}

static void take_unfitted(struct solved_lights *s, const struct solve_inputs *in)
{
    for (int i = 0; i < in->scene->lights.lamp_count; i++) {
        measure_lamp(&s->lamps[i], in, i);
        if (!note_of_lamp(in, i)->has_radiance && !is_fitted(s, in, i)) take_seen(s, in, i);
    }
}

/* Takes what views show, for lamps whose marks say almost nothing. */
static void drop_unknown(struct solved_lights *s, const struct solve_inputs *in)
{
    for (int i = 0; i < in->scene->lights.lamp_count; i++) {
        const struct lamp_result *r = &s->lamps[i];
        bool known = r->source != LAMP_FITTED;
        for (int c = 0; c < 3; c++) known |= r->high[c] < UNKNOWN * r->low[c];
        if (!known) take_seen(s, in, i);
    }
}

/* Without an edge that photos show, beta lies between the lit and the unlit marks. */
static void guess_cone(struct solved_lights *s, const struct solve_inputs *in, int lamp)
{
    struct lamp *l = &in->scene->lights.lamps[lamp];
    double inside = 0, outside = 0.5 * PI;
    for (int i = 0; i < in->scene->point_count; i++) {
        const struct lit_point *p = &in->scene->points[i];
        const struct vec3 to = vec3_normalize(vec3_sub(p->at, l->centre));
        const double angle = acos(clamp(vec3_dot(to, l->normal), -1, 1));
        if (p->lamp != lamp || in->scene->marks[p->mark].face >= 0) continue;
        if (p->kind == NOTE_LIT) inside = fmax(inside, fmin(angle, 0.5 * PI));
    }
    for (int i = 0; i < in->scene->point_count; i++) {
        const struct lit_point *p = &in->scene->points[i];
        const struct vec3 to = vec3_normalize(vec3_sub(p->at, l->centre));
        const double angle = acos(clamp(vec3_dot(to, l->normal), -1, 1));
        if (p->lamp == lamp && p->kind == NOTE_UNLIT && angle > inside) outside = fmin(outside, angle);
    }
    const bool between = inside > 0 && outside < 0.5 * PI;
    l->beta = between ? 0.5 * (inside + outside) : 0.5 * PI;
    s->lamps[lamp].beta_error = between ? (outside - inside) / sqrt(12) : 0;
    if (in->is_provisional) return;
    log_warn("%s:%d: the edge of the cone of the lamp %s was not found, so its beta is %.1f degrees, %s; add lines "
             "across the edge, or give beta.",
             in->notes->path, note_of_lamp(in, lamp)->line, l->name, l->beta / DEGREE,
             between ? "between its lit and its unlit marks" : "as if it shone to all sides");
}

static enum status fit_cone(struct solved_lights *s, const struct solve_inputs *in, int lamp, bool known,
                            struct err *err)
{
    const bool wanted = lines_of_lamp(in->scene, lamp) > 0;
    if (wanted && !lines_fit_beta(&s->lamps[lamp].beta_error, in, lamp, known, err)) return ST_OK;
    if (err->status && err->status != ST_DATA) return err->status;
    if (err->status && !known && !in->is_provisional) log_warn("%s", err->text);
    *err = (struct err)ERR_INIT;
    if (known) return ST_OK; /* it stays as it was found, or guessed, before */
    if (wanted || note_of_lamp(in, lamp)->has_beta == QUANTITY_FIT) guess_cone(s, in, lamp);
    return ST_OK;
}

static enum status fit_cones(struct solved_lights *s, const struct solve_inputs *in, bool known, struct err *err)
{
    for (int i = 0; i < in->scene->lights.lamp_count; i++)
        if (fit_cone(s, in, i, known, err)) return err->status;
    return ST_OK;
}

static bool is_outlier(const struct fit_mark *m)
{
    return fabs(expm1(m->off)) > LEAST_OFF && fabs(m->off) > SURE_OFF * m->off_error;
}

/* Names the marks that the others do not explain. */
static void report_outliers(const struct solved_lights *s, const struct solve_inputs *in)
{
    for (int k = 0; k < s->mark_count; k++) {
        const struct annotation *a = &in->notes->items[in->scene->marks[k].note];
        const struct fit_mark *m = &s->marks[k];
        if (in->scene->marks[k].face >= 0 || !is_outlier(m)) continue;
        log_warn("%s:%d: this mark (%s %s) is %.0f %% %s than the other marks say, so it counts little: it may be on "
                 "another material, in shade or in the sun.",
                 in->notes->path, a->line, annotation_word(a->kind), a->name, 100 * fabs(expm1(m->off)),
                 m->off > 0 ? "brighter" : "darker");
    }
}

enum status solve_lights(struct solved_lights *s, const struct solve_inputs *in, struct err *err)
{
    const int lamps = in->scene->lights.lamp_count;
    *s = (struct solved_lights){.lamps = calloc((size_t)lamps + 1, sizeof *s->lamps), .lamp_count = lamps};
    if (!s->lamps) return err_nomem(err, "lamps", (size_t)lamps * sizeof *s->lamps);
    begin_lamps(s, in);
    for (int i = 0; i < lamps; i++) {
        measure_lamp(&s->lamps[i], in, i);
        s->lamps[i].uses_places = !s->lamps[i].unsaturated && !is_told(s, in, i);
    }
    if (list_points(s, in, err) || fit_cones(s, in, false, err)) return err->status;
    take_unfitted(s, in);
    if (fit_radiances(s, in, PASS_PROVISIONAL, err) || fit_cones(s, in, true, err)) return err->status;
    if (in->is_provisional) return fit_radiances(s, in, PASS_PROVISIONAL, err);
    if (fit_radiances(s, in, PASS_POINTS, err)) return err->status;
    for (int i = 0; i < lamps; i++) {
        if (s->lamps[i].source != LAMP_FITTED) continue;
        measure_lamp(&s->lamps[i], in, i);
        compare(&s->lamps[i], &in->scene->lights.lamps[i]);
    }
    if (fit_radiances(s, in, PASS_POINTS_AND_PICTURES, err)) return err->status;
    drop_unknown(s, in);
    report_outliers(s, in);
    return ST_OK;
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

/* The interval of a lamp's radiance, which need not have the value in its middle. */
static void write_range(const struct solved_lights *s, const struct solve_inputs *in, int i, FILE *to)
{
    const struct lamp_result *r = &s->lamps[i];
    char name[600];
    struct err ignored = ERR_INIT;
    if (r->source != LAMP_FITTED) return;
    if (textfile_quote(in->scene->lights.lamps[i].name, name, sizeof name, &ignored)) return;
    fprintf(to, "range %s", name);
    for (int c = 0; c < 3; c++) fprintf(to, " %.6g %.6g", r->low[c], r->high[c]);
    fprintf(to, "\n");
}

static void write_mark(const struct solved_lights *s, const struct solve_inputs *in, int k, FILE *to)
{
    const struct fit_mark *m = &s->marks[k];
    const struct lit_mark *mark = &in->scene->marks[k];
    const struct annotation *a = &in->notes->items[mark->note];
    const double usual = MARK_SCALE * in->params->texture;
    int points = 0;
    char name[600];
    struct err ignored = ERR_INIT;
    for (int i = 0; i < s->point_count; i++) points += s->points[i].mark == k;
    if (!points || textfile_quote(a->name, name, sizeof name, &ignored)) return;
    fprintf(to, "mark %d %s %s points %d off %.4g %.4g weight %.4g%s\n", a->line,
            mark->face < 0 ? annotation_word(a->kind) : "place", name, points, expm1(m->off),
            CONFIDENCE * m->off_error * exp(m->off), fmin(1, usual * usual / fmax(m->variance, 1e-30)),
            is_outlier(m) ? " outlier" : "");
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

enum status solve_write(const struct solved_lights *s, const struct solve_inputs *in, const struct unseen_lamps *unseen,
                        const struct lit_model *model, const char *path, const struct provenance *prov, struct err *err)
{
    struct outfile f = {0};
    product_begin(&f, PRODUCT_LIGHT_FIT, path, prov, err);
    for (int i = 0; !err->status && i < s->lamp_count; i++) {
        write_lamp(s, in, i, f.fp);
        write_range(s, in, i, f.fp);
    }
    for (int i = 0; !err->status && i < s->material_count; i++) write_material(&s->materials[i], f.fp);
    for (int k = 0; !err->status && k < s->mark_count; k++) write_mark(s, in, k, f.fp);
    for (int i = 0; !err->status && i < s->point_count; i++)
        if (s->points[i].kind != POINT_ACROSS) write_point(s, in, i, f.fp);
    if (!err->status) unseen_lamps_print(unseen, model, &in->scene->lights, f.fp);
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}
