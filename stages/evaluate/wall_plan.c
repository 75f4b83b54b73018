/* wall_plan.c - see wall_plan.h.
 *
 * A face's error is the larger of the distances of its two ends from the line of a true face, in plan. Candidates run
 * the same way within 10 degrees, overlap the face along the line, and are within max_distance; the nearest one counts.
 * An opening's error is the largest difference of its two sides along the wall, its sill and its head; a candidate's
 * corners must be within max_distance across the wall too, because farther ones are in another wall. */
#include "stages/evaluate/wall_plan.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/base/sort.h"
#include "common/base/textfile.h"

#define MIN_COSINE 0.98480775301220802 /* cos 10 degrees */

void measured_plan_release(struct measured_plan *plan)
{
    if (!plan) return;
    free(plan->faces.parts);
    free(plan->openings.parts);
    *plan = (struct measured_plan){0};
}

static enum status add_part(struct measured_parts *list, const char *name, struct vec3 a, struct vec3 b,
                            struct err *err)
{
    if (array_append(&list->parts, (size_t)list->count, sizeof *list->parts, "walls to compare", err))
        return err->status;
    struct measured_part *p = &list->parts[list->count++];
    *p = (struct measured_part){.at = {a, b}};
    snprintf(p->name, sizeof p->name, "%s", name);
    return ST_OK;
}

struct reader {
    struct measured_plan *plan;
    struct textfile t;
    struct measured_parts lines; /* of walls; at: the point where S of an opening is 0, and the direction of S */
    /* scene-truth.txt */
    double low[2], high[2]; /* bounds of the rooms */
    int partition;          /* the axis across the partition, 0 or 1; -1: there is none */
    double middle;          /* of the partition, along that axis */
};

static enum status numbers(struct reader *r, const char *const fields[], double *v, int count, struct err *err)
{
    for (int i = 0; i < count; i++)
        if (textfile_double(&r->t, fields[i], &v[i], err)) return err->status;
    return ST_OK;
}

/* NULL: not found. */
static const struct measured_part *line_named(const struct reader *r, const char *name)
{
    for (int i = 0; i < r->lines.count; i++)
        if (!strncmp(r->lines.parts[i].name, name, sizeof r->lines.parts[i].name - 1)) return &r->lines.parts[i];
    return NULL;
}

static enum status add_opening(struct reader *r, const char *name, struct vec3 origin, struct vec3 along,
                               const double s[2], const double z[2], struct err *err)
{
    struct vec3 c[2];
    for (int k = 0; k < 2; k++) {
        c[k] = vec3_add(origin, vec3_scale(along, s[k]));
        c[k].z = z[k];
    }
    return add_part(&r->plan->openings, name, c[0], c[1], err);
}

/* -------------------------------------------------------------------------------------------------- model/plan.txt */

static enum status model_wall(struct reader *r, struct err *err)
{
    static const char *const direction[] = {"x of the normal", "y of the normal"};
    char *name;
    double n[2], c;
    if (textfile_word(&r->t, "a wall's name", &name, err) || textfile_expect(&r->t, "normal", err) ||
        numbers(r, direction, n, 2, err) || textfile_expect(&r->t, "at", err) ||
        textfile_double(&r->t, "the wall's offset", &c, err))
        return err->status;
    /* S is x or y; on an angled wall it begins at a point that the plan does not hold */
    if (fmin(fabs(n[0]), fabs(n[1])) > 1e-9) return ST_OK;
    const struct vec3 along = fabs(n[0]) > 0.5 ? vec3_make(0, 1, 0) : vec3_make(1, 0, 0);
    return add_part(&r->lines, name, vec3_make(n[0] * c, n[1] * c, 0), along, err);
}

static enum status model_opening(struct reader *r, struct err *err)
{
    char *name, *wall;
    double a[2], b[2];
    static const char *const from[] = {"its start", "its sill"}, *const to[] = {"its end", "its head"};
    if (textfile_word(&r->t, "an opening's name", &name, err) || textfile_expect(&r->t, "on", err) ||
        textfile_word(&r->t, "a wall's name", &wall, err) || textfile_expect(&r->t, "from", err) ||
        numbers(r, from, a, 2, err) || textfile_expect(&r->t, "to", err) || numbers(r, to, b, 2, err))
        return err->status;
    const struct measured_part *l = line_named(r, wall);
    if (!l) return ST_OK; /* on an angled wall */
    return add_opening(r, name, l->at[0], l->at[1], (double[]){a[0], b[0]}, (double[]){a[1], b[1]}, err);
}

/* The name of each wall, and the corner at its end; the last corner is also the start of the first wall. */
static enum status model_room(struct reader *r, struct err *err)
{
    static const char *const ceiling[] = {"height", "slope along x", "slope along y"}, *const corner[] = {"x", "y"};
    const int first = r->plan->faces.count;
    char *name;
    double floor, c[3], p[2];
    if (textfile_word(&r->t, "a room's name", &name, err) || textfile_expect(&r->t, "floor", err) ||
        textfile_double(&r->t, "the floor's height", &floor, err) || textfile_expect(&r->t, "ceiling", err) ||
        numbers(r, ceiling, c, 3, err))
        return err->status;
    do {
        if (textfile_word(&r->t, "a wall's name", &name, err) || numbers(r, corner, p, 2, err) ||
            add_part(&r->plan->faces, name, vec3_make(0, 0, floor), vec3_make(p[0], p[1], floor), err))
            return err->status;
    } while (textfile_more(&r->t));
    struct measured_part *f = r->plan->faces.parts;
    for (int i = first, last = r->plan->faces.count - 1; i <= last; i++)
        f[i].at[0] = f[i == first ? last : i - 1].at[1];
    return ST_OK;
}

static enum status model_statement(struct reader *r, const char *verb, struct err *err)
{
    if (!strcmp(verb, "wall")) return model_wall(r, err);
    if (!strcmp(verb, "room")) return model_room(r, err);
    if (!strcmp(verb, "door") || !strcmp(verb, "passage") || !strcmp(verb, "window")) return model_opening(r, err);
    return ST_OK;
}

/* ----------------------------------------------------------------------------------- scene.txt and scene-truth.txt */

static enum status described_wall(struct reader *r, struct err *err)
{
    static const char *const fields[] = {"x0", "y0", "x1", "y1", "z0", "z1", "thickness"};
    char *name;
    double v[7];
    if (textfile_word(&r->t, "a wall's name", &name, err) || numbers(r, fields, v, 7, err)) return err->status;
    const struct vec3 a = vec3_make(v[0], v[1], v[4]), b = vec3_make(v[2], v[3], v[4]);
    if (!(vec3_length(vec3_sub(b, a)) > 0)) return textfile_error(&r->t, err, name, "a wall with a length");
    const struct vec3 d = vec3_normalize(vec3_sub(b, a)), off = vec3_scale(vec3_make(-d.y, d.x, 0), 0.5 * v[6]);
    if (add_part(&r->plan->faces, name, vec3_add(a, off), vec3_add(b, off), err) ||
        add_part(&r->plan->faces, name, vec3_sub(b, off), vec3_sub(a, off), err))
        return err->status;
    return add_part(&r->lines, name, a, d, err);
}

static enum status described_opening(struct reader *r, struct err *err)
{
    static const char *const fields[] = {"s0", "s1", "z0", "z1"};
    char *name, *wall;
    double v[4];
    if (textfile_word(&r->t, "an opening's name", &name, err) || textfile_word(&r->t, "a wall's name", &wall, err) ||
        numbers(r, fields, v, 4, err))
        return err->status;
    const struct measured_part *l = line_named(r, wall);
    if (!l) return textfile_error(&r->t, err, wall, "the name of a wall on a line above");
    return add_opening(r, name, l->at[0], l->at[1], v, v + 2, err);
}

static enum status described_statement(struct reader *r, const char *verb, struct err *err)
{
    if (!strcmp(verb, "wall")) return described_wall(r, err);
    if (!strcmp(verb, "opening") || !strcmp(verb, "window")) return described_opening(r, err);
    return ST_OK;
}

static enum status axis_of(struct reader *r, int *axis, struct err *err)
{
    char *name;
    if (textfile_word(&r->t, "x or y", &name, err)) return err->status;
    if (strcmp(name, "x") && strcmp(name, "y")) return textfile_error(&r->t, err, name, "x or y");
    *axis = name[0] == 'y';
    return ST_OK;
}

/* An opening along `axis`, with the other coordinate `at`. */
static enum status framed_opening(struct reader *r, const char *name, int axis, double at, const double s[2],
                                  const double z[2], struct err *err)
{
    return add_opening(r, name, axis ? vec3_make(at, 0, 0) : vec3_make(0, at, 0),
                       axis ? vec3_make(0, 1, 0) : vec3_make(1, 0, 0), s, z, err);
}

static enum status framed_window(struct reader *r, const char *name, struct err *err)
{
    static const char *const sides[] = {"window_west", "window_south", "window_east", "window_north"};
    static const char *const fields[] = {"its start", "its end", "its sill", "its head"};
    double v[4];
    int axis = 0, side = 0;
    while (side < 4 && strcmp(name, sides[side])) side++;
    if (side == 4) return textfile_error(&r->t, err, name, "window_south, window_north, window_west or window_east");
    if (r->low[0] > r->high[0]) return textfile_error(&r->t, err, name, "a room on a line above");
    if (axis_of(r, &axis, err) || numbers(r, fields, v, 2, err) || textfile_expect(&r->t, "z", err) ||
        numbers(r, fields + 2, v + 2, 2, err))
        return err->status;
    if (axis == side % 2) return textfile_error(&r->t, err, axis ? "y" : "x", "the axis along its wall");
    return framed_opening(r, name, axis, (side < 2 ? r->low : r->high)[side % 2], v, v + 2, err);
}

static enum status framed_statement(struct reader *r, const char *verb, struct err *err)
{
    static const char *const fields[] = {"x0", "y0", "z0", "x1", "y1", "z1"};
    double v[6], top;
    int axis = 0;
    char *next;
    if (!strcmp(verb, "partition")) {
        if (axis_of(r, &r->partition, err) || numbers(r, fields, v, 2, err)) return err->status;
        r->middle = 0.5 * (v[0] + v[1]);
        return ST_OK;
    }
    if (!strcmp(verb, "door")) {
        if (r->partition < 0) return textfile_error(&r->t, err, verb, "a partition on a line above");
        if (axis_of(r, &axis, err) || numbers(r, fields, v, 2, err) || textfile_expect(&r->t, "top", err) ||
            textfile_double(&r->t, "its head", &top, err))
            return err->status;
        if (axis == r->partition) return textfile_error(&r->t, err, axis ? "y" : "x", "the axis along the partition");
        return framed_opening(r, verb, axis, r->middle, v, (double[]){0, top}, err);
    }
    if (!strncmp(verb, "window_", 7)) return framed_window(r, verb, err);
    for (int i = 0; i < 6; i++)
        if (!textfile_more(&r->t) || textfile_word(&r->t, fields[i], &next, err) || !scan_double(next, &v[i]))
            return err->status; /* another line */
    if (textfile_more(&r->t)) return ST_OK;
    if (!(v[3] > v[0] && v[4] > v[1])) return textfile_error(&r->t, err, verb, "a room with x0 < x1 and y0 < y1");
    for (int k = 0; k < 2; k++) {
        r->low[k] = fmin(r->low[k], v[k]);
        r->high[k] = fmax(r->high[k], v[3 + k]);
    }
    static const int corners[5][2] = {{0, 1}, {3, 1}, {3, 4}, {0, 4}, {0, 1}};
    for (int i = 0; i < 4; i++)
        if (add_part(&r->plan->faces, verb, vec3_make(v[corners[i][0]], v[corners[i][1]], v[2]),
                     vec3_make(v[corners[i + 1][0]], v[corners[i + 1][1]], v[2]), err))
            return err->status;
    return ST_OK;
}

enum status measured_plan_read(struct measured_plan *plan, const char *path, enum measured_plan_kind kind,
                               struct err *err)
{
    static enum status (*const statements[])(struct reader *, const char *,
                                             struct err *) = {[PLAN_FROM_MODEL] = model_statement,
                                                              [PLAN_FROM_SCENE] = described_statement,
                                                              [PLAN_FROM_SCENE_TRUTH] = framed_statement};
    struct reader r = {.plan = plan, .partition = -1, .low = {INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY}};
    *plan = (struct measured_plan){0};
    enum status st = textfile_open(&r.t, path, err);
    while (!st && textfile_next(&r.t)) {
        char *verb;
        st = textfile_word(&r.t, "a word", &verb, err);
        if (!st) st = statements[kind](&r, verb, err);
    }
    textfile_release(&r.t);
    free(r.lines.parts);
    if (st) measured_plan_release(plan);
    return st;
}

/* ---------------------------------------------------------------------------------------------------------- errors */

/* In plan: the distance of p from the line of a face; *along: its position on the face, 0 to 1. */
static double distance_to_face(const struct measured_part *f, struct vec3 p, double *along)
{
    const double dx = f->at[1].x - f->at[0].x, dy = f->at[1].y - f->at[0].y, length = hypot(dx, dy);
    const double x = p.x - f->at[0].x, y = p.y - f->at[0].y;
    if (!(length > 0)) {
        *along = 0;
        return hypot(x, y);
    }
    *along = (x * dx + y * dy) / (length * length);
    return fabs(x * dy - y * dx) / length;
}

static double face_error(const struct measured_part *found, const struct measured_part *truth, double max_distance)
{
    const double ax = found->at[1].x - found->at[0].x, ay = found->at[1].y - found->at[0].y;
    const double bx = truth->at[1].x - truth->at[0].x, by = truth->at[1].y - truth->at[0].y;
    double s[2], d[2];
    if (!(ax * bx + ay * by > MIN_COSINE * hypot(ax, ay) * hypot(bx, by))) return INFINITY;
    for (int k = 0; k < 2; k++) d[k] = distance_to_face(truth, found->at[k], &s[k]);
    const double error = fmax(d[0], d[1]);
    return s[1] > 0 && s[0] < 1 && error <= max_distance ? error : INFINITY;
}

static double opening_error(const struct measured_part *found, const struct measured_part *truth, double max_distance)
{
    const struct vec3 a = vec3_sub(found->at[1], found->at[0]);
    const struct vec3 b = vec3_sub(truth->at[1], truth->at[0]);
    const double width = hypot(b.x, b.y), dot = a.x * b.x + a.y * b.y;
    if (!(width > 0) || !(fabs(dot) > MIN_COSINE * hypot(a.x, a.y) * width)) return INFINITY;
    double error = 0;
    for (int k = 0; k < 2; k++) {
        const struct vec3 off = vec3_sub(found->at[dot < 0 ? 1 - k : k], truth->at[k]);
        if (hypot(off.x, off.y) > max_distance) return INFINITY; /* also across the wall: it may be another wall */
        error = fmax(error, fabs(off.x * b.x + off.y * b.y) / width);
        error = fmax(error, fabs(found->at[k].z - truth->at[k].z));
    }
    return error <= max_distance ? error : INFINITY;
}

/* INFINITY: they do not belong together. */
typedef double part_error(const struct measured_part *found, const struct measured_part *truth, double max_distance);

static double nearest(const struct measured_part *found, const struct measured_parts *truth, part_error *error,
                      double max_distance)
{
    double min = INFINITY;
    for (int k = 0; k < truth->count; k++) min = fmin(min, error(found, &truth->parts[k], max_distance));
    return min;
}

/* Adds to *extra the parts of the model without a true one. */
static enum status find_errors(struct part_errors *e, const struct measured_parts *model,
                               const struct measured_parts *truth, part_error *error, double max_distance, int *extra,
                               struct err *err)
{
    double worst = -1;
    e->errors = calloc((size_t)model->count + 1, sizeof *e->errors);
    if (!e->errors) return err_nomem(err, "errors of walls", (size_t)model->count * sizeof *e->errors);
    for (int i = 0; i < model->count; i++) {
        const double min = nearest(&model->parts[i], truth, error, max_distance);
        *extra += !isfinite(min);
        if (!isfinite(min)) continue;
        e->errors[e->count++] = min;
        if (!(min > worst)) continue;
        worst = min;
        memcpy(e->worst, model->parts[i].name, sizeof e->worst);
    }
    sort_doubles(e->errors, (size_t)e->count);
    return ST_OK;
}

enum status wall_errors_find(struct wall_errors *e, const struct measured_plan *model,
                             const struct measured_plan *truth, double max_distance, struct err *err)
{
    *e = (struct wall_errors){0};
    if (find_errors(&e->faces, &model->faces, &truth->faces, face_error, max_distance, &e->extra, err) ||
        find_errors(&e->openings, &model->openings, &truth->openings, opening_error, max_distance, &e->extra, err)) {
        wall_errors_release(e);
        return err->status;
    }
    for (int k = 0; k < truth->openings.count; k++) {
        bool found = false;
        for (int i = 0; i < model->openings.count && !found; i++)
            found = isfinite(opening_error(&model->openings.parts[i], &truth->openings.parts[k], max_distance));
        e->missing += !found;
    }
    return ST_OK;
}

void wall_errors_release(struct wall_errors *e)
{
    if (!e) return;
    free(e->faces.errors);
    free(e->openings.errors);
    *e = (struct wall_errors){0};
}
