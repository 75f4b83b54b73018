/* lines.c - see lines.h. */
#include "stages/fit_lights/lines.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/math/numbers.h"
#include "stages/fit_lights/cone.h"

#define REACH (3 * DEGREE) /* of the second search about the first */
enum { MIN_PLACES = 20 /* that a photo must show of a line */ };

static bool begins_line(const struct lit_scene *s, int i, int lamp)
{
    return s->points[i].kind == NOTE_LINE && s->points[i].lamp == lamp && s->points[i].along <= 0;
}

int lines_of_lamp(const struct lit_scene *s, int lamp)
{
    int count = 0;
    for (int i = 0; i < s->point_count; i++) count += begins_line(s, i, lamp);
    return count;
}

struct line_set {
    const struct solve_inputs *in;
    int lamp;
    int *first; /* point of the scene at which each line begins */
    struct cone_line *lines;
    struct cone_trace *traces;
    int line_count, trace_count;
    double *angle, (*indirect)[3]; /* per point of the scene */
    double (*radiance)[3], *sigma; /* per trace and place */
    int places;                    /* of each line */
    char place[512];
};

static void release(struct line_set *s)
{
    free(s->first);
    free(s->lines);
    free(s->traces);
    free(s->angle);
    free(s->indirect);
    free(s->radiance);
    free(s->sigma);
}

static double direct_at(const void *ctx, int line, int place, double beta)
{
    const struct line_set *s = ctx;
    return direct_light_at(s->in->direct, s->lamp, s->first[line] + place, beta,
                           s->in->scene->lights.lamps[s->lamp].exponent);
}

/* The light at a point without the lamp; that of the others is added. */
static void set_point(struct line_set *s, int i)
{
    const struct light_list *list = &s->in->scene->lights;
    const struct lit_point *p = &s->in->scene->points[i];
    const struct lamp *l = &list->lamps[s->lamp];
    const struct vec3 to = vec3_sub(p->at, l->centre);
    s->angle[i] = acos(clamp(vec3_dot(l->normal, vec3_normalize(to)), -1, 1));
    for (int c = 0; c < 3; c++) s->indirect[i][c] = s->in->indirect[i][c];
    for (int k = 0; k < list->lamp_count; k++) {
        const struct lamp *o = &list->lamps[k];
        if (k == s->lamp || !(rgb_max(o->radiance) > 0)) continue;
        const double d = direct_light_at(s->in->direct, k, i, o->beta, o->exponent);
        s->indirect[i][0] += d * o->radiance.r;
        s->indirect[i][1] += d * o->radiance.g;
        s->indirect[i][2] += d * o->radiance.b;
    }
}

static void list_lines(struct line_set *s)
{
    const struct lit_scene *scene = s->in->scene;
    for (int i = 0; i < scene->point_count; i++) {
        if (!begins_line(scene, i, s->lamp)) continue;
        s->first[s->line_count] = i;
        s->places = 1;
        while (i + s->places < scene->point_count && scene->points[i + s->places].note == scene->points[i].note)
            s->places++;
        for (int k = 0; k < s->places; k++) set_point(s, i + k);
        s->lines[s->line_count++] =
            (struct cone_line){s->places, s->angle + i, (const double(*)[3])s->indirect + i, s->place};
    }
    const struct annotation *a = &s->in->notes->items[scene->points[s->first[0]].note];
    snprintf(s->place, sizeof s->place, "%s:%d", s->in->notes->path, a->line);
}

static int line_of(const struct line_set *s, int point)
{
    for (int k = 0; k < s->line_count; k++)
        if (point >= s->first[k] && point < s->first[k] + s->places) return k;
    return -1;
}

/* The trace of a photo along a line, made on demand. photos: of the traces. */
static int trace_of(struct line_set *s, int *photos, int line, int photo)
{
    for (int t = 0; t < s->trace_count; t++)
        if (s->traces[t].line == line && photos[t] == photo) return t;
    const size_t at = (size_t)s->trace_count * (size_t)s->places;
    photos[s->trace_count] = photo;
    s->traces[s->trace_count] = (struct cone_trace){line, (const double(*)[3])s->radiance + at, s->sigma + at};
    return s->trace_count++;
}

/* The number of pairs of a line and a photo. */
static int count_pairs(const struct line_set *s)
{
    int photos = 0;
    for (int i = 0; i < s->in->seen->count; i++)
        photos = s->in->seen->items[i].photo >= photos ? s->in->seen->items[i].photo + 1 : photos;
    return photos * s->line_count;
}

static enum status list_traces(struct line_set *s, struct err *err)
{
    const struct observations *o = s->in->seen;
    const size_t pairs = (size_t)count_pairs(s) + 1, places = (size_t)s->places;
    int *photos = calloc(pairs, sizeof *photos), *shown = calloc(pairs, sizeof *shown);
    s->traces = calloc(pairs, sizeof *s->traces);
    s->radiance = calloc(pairs * places, sizeof *s->radiance);
    s->sigma = calloc(pairs * places, sizeof *s->sigma);
    if (!photos || !shown || !s->traces || !s->radiance || !s->sigma)
        err_nomem(err, "lines in photos", pairs * places * sizeof *s->radiance);
    for (int i = 0; !err->status && i < o->count; i++) {
        const struct observation *q = &o->items[i];
        const int line = line_of(s, q->point);
        if (line < 0 || !(fmin(q->radiance[0], fmin(q->radiance[1], q->radiance[2])) > 0)) continue;
        const int t = trace_of(s, photos, line, q->photo), place = q->point - s->first[line];
        for (int c = 0; c < 3; c++) s->radiance[(size_t)t * places + (size_t)place][c] = q->radiance[c];
        s->sigma[(size_t)t * places + (size_t)place] = q->sigma;
        shown[t]++;
    }
    int kept = 0;
    for (int t = 0; !err->status && t < s->trace_count; t++)
        if (shown[t] >= MIN_PLACES) s->traces[kept++] = s->traces[t];
    s->trace_count = kept;
    free(photos);
    free(shown);
    return err->status;
}

/* How much an error of the marked centre turns the edge, as seen from the lamp. */
static double click_error(const struct line_set *s)
{
    const struct annotation *a = &s->in->notes->items[s->in->scene->lamp_notes[s->lamp]];
    const struct lamp *l = &s->in->scene->lights.lamps[s->lamp];
    const double pixels = hypot(a->pixel[2] - a->pixel[0], a->pixel[3] - a->pixel[1]);
    double nearest = INFINITY;
    for (int k = 0; k < s->line_count; k++)
        nearest = fmin(nearest, vec3_length(vec3_sub(s->in->scene->points[s->first[k]].at, l->centre)));
    return pixels > 0 && nearest > 0 ? s->in->params->click * l->radius / pixels / nearest : 0;
}

enum status lines_fit_beta(double *error, const struct solve_inputs *in, int lamp, bool known, struct err *err)
{
    const size_t points = (size_t)in->scene->point_count, lines = (size_t)lines_of_lamp(in->scene, lamp);
    struct line_set s = {.in = in, .lamp = lamp};
    struct lamp *l = &in->scene->lights.lamps[lamp];
    s.first = calloc(lines + 1, sizeof *s.first);
    s.lines = calloc(lines + 1, sizeof *s.lines);
    s.angle = calloc(points, sizeof *s.angle);
    s.indirect = calloc(points, sizeof *s.indirect);
    if (!s.first || !s.lines || !s.angle || !s.indirect) err_nomem(err, "lines", points * sizeof *s.indirect);
    if (!err->status) {
        list_lines(&s);
        list_traces(&s, err);
    }
    struct cone_fit f = {.lamp = l->name,
                         .lines = s.lines,
                         .traces = s.traces,
                         .line_count = s.line_count,
                         .trace_count = s.trace_count,
                         .direct = direct_at,
                         .ctx = &s,
                         .texture = in->params->texture,
                         .has_radiance = known && rgb_max(l->radiance) > 0,
                         .radiance = {l->radiance.r, l->radiance.g, l->radiance.b},
                         .reach = known ? REACH : 0,
                         .beta = l->beta};
    if (!err->status && !cone_fit_solve(&f, err)) {
        l->beta = f.beta;
        *error = hypot(f.error, click_error(&s));
    }
    release(&s);
    return err->status;
}
