/* wall_plan.c - the walls of a model and of a truth, read from their files and compared.
 *
 * Three kinds of file become one list of faces, openings and rooms, in plan with heights: model/plan.txt, a scene in
 * the language of described scenes (with its bases and what it drops), and the simpler scene-truth.txt of boxes with
 * partitions. A face has a direction, which says which side of its wall it is.
 *
 * Errors. A face's error is the larger of the distances of its two ends from the line of a true face, in plan.
 * Candidates run the same way within 10 degrees, overlap the face along the line, and are within max_distance; the
 * nearest one counts. An opening's error is the largest difference of its two sides along the wall, its sill and its
 * head; a candidate's corners must be within max_distance across the wall too, because farther ones are in another
 * wall.
 *
 * A model may split a wall into several faces or leave one out, so faces are not paired one to one: each face of the
 * model is measured alone. Parts of the model without a true one are counted; of the truth only the openings that
 * the model lacks, since a photograph need not show every wall.
 *
 * A room's height is taken at the centroid of its outline, where a sloping ceiling has a height that can be
 * compared.
 *
 * O(faces of the model x faces of the truth). */
#include "stages/evaluate/truth/wall_plan.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/file_path.h"
#include "common/base/scan.h"
#include "common/base/sort.h"
#include "common/base/textfile.h"
#include "common/model/model_plan.h"

enum { MAX_BASES = 4 };
#define MIN_COSINE 0.98480775301220802 /* cos 10 degrees */

void wall_plan_release(struct measured_plan *plan)
{
    if (!plan) return;
    free(plan->faces.parts);
    free(plan->openings.parts);
    free(plan->rooms.parts);
    free(plan->furniture.parts);
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

bool wall_plan_has(const struct measured_parts *list, const char *face)
{
    for (int i = 0; i < list->count; i++) {
        const size_t length = strlen(list->parts[i].name);
        if (!strncmp(list->parts[i].name, face, length) && face[length] == '.') return true;
    }
    return false;
}

struct reader {
    struct measured_plan *plan;
    struct textfile t;
    bool furniture;              /* what follows is furniture */
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

/* The middle of a room on its floor, and above it on the ceiling. */
static enum status add_model_heights(struct measured_plan *plan, const struct model_room *r, struct err *err)
{
    double x = 0, y = 0, area = 0;
    for (int i = 0; i < r->corner_count; i++) {
        const struct model_room_corner *a = &r->corners[i], *b = &r->corners[(i + 1) % r->corner_count];
        const double cross = a->x * b->y - b->x * a->y;
        x += (a->x + b->x) * cross / 3;
        y += (a->y + b->y) * cross / 3;
        area += cross;
    }
    if (!(area > 0)) return ST_OK;
    x /= area;
    y /= area;
    const double ceiling = model_room_ceiling(r, x, y);
    return add_part(&plan->rooms, r->name, vec3_make(x, y, r->floor), vec3_make(x, y, ceiling), err);
}

static enum status add_model_room(struct measured_plan *plan, const struct model_plan *model, int room, struct err *err)
{
    const struct model_room *r = &model->rooms[room];
    for (int i = 0; i < r->corner_count; i++) {
        const struct model_room_corner *a = &r->corners[(i + r->corner_count - 1) % r->corner_count],
                                       *b = &r->corners[i];
        if (b->wall < 0) continue; /* a removed wall has no face */
        if (add_part(&plan->faces, b->wall_name, vec3_make(a->x, a->y, r->floor), vec3_make(b->x, b->y, r->floor), err))
            return err->status;
    }
    return add_model_heights(plan, r, err);
}

static enum status read_model(struct measured_plan *plan, const char *path, struct err *err)
{
    struct model_plan model = {0};
    struct vec3 corners[2];
    model_plan_read(&model, path, NULL, err);
    for (int i = 0; !err->status && i < model.room_count; i++) add_model_room(plan, &model, i, err);
    for (int i = 0; !err->status && i < model.opening_count; i++)
        if (model_opening_corners(&model, i, corners))
            add_part(&plan->openings, model.openings[i].name, corners[0], corners[1], err);
    model_plan_release(&model);
    return err->status;
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
    if (add_opening(r, name, l->at[0], l->at[1], v, v + 2, err)) return err->status;
    struct measured_part *o = &r->plan->openings.parts[r->plan->openings.count - 1];
    memcpy(o->wall, l->name, sizeof o->wall);
    return ST_OK;
}

static enum status described_room(struct reader *r, struct err *err)
{
    static const char *const fields[] = {"x0", "y0", "x1", "y1", "z0", "z1"};
    char *name;
    double v[6];
    if (textfile_word(&r->t, "a room's name", &name, err) || numbers(r, fields, v, 6, err)) return err->status;
    return add_part(&r->plan->rooms, name, vec3_make(v[0], v[1], v[4]), vec3_make(v[2], v[3], v[5]), err);
}

static void drop_named(struct measured_parts *list, const char *name)
{
    int kept = 0;
    for (int i = 0; i < list->count; i++)
        if (strncmp(list->parts[i].name, name, sizeof list->parts[i].name - 1) &&
            strncmp(list->parts[i].wall, name, sizeof list->parts[i].wall - 1))
            list->parts[kept++] = list->parts[i];
    list->count = kept;
}

/* An item of the scene that an edit leaves out; a wall goes with its openings. */
static enum status described_drop(struct reader *r, struct err *err)
{
    char *name;
    do {
        if (textfile_word(&r->t, "the name of an item", &name, err)) return err->status;
        drop_named(&r->plan->faces, name);
        drop_named(&r->plan->openings, name);
        drop_named(&r->plan->rooms, name);
        drop_named(&r->plan->furniture, name);
        drop_named(&r->lines, name);
    } while (textfile_more(&r->t));
    return ST_OK;
}

static enum status read_described(struct reader *r, const char *path, int depth, struct err *err);

/* The scene that an edited one differs from: beside its file, or in the folder above. */
static enum status described_base(struct reader *r, int depth, struct err *err)
{
    char *name, folder[FILE_PATH], path[FILE_PATH], above[FILE_PATH];
    if (textfile_word(&r->t, "a file", &name, err)) return err->status;
    if (strchr(name, '/')) return textfile_error(&r->t, err, name, "the name of a file without its folder");
    snprintf(folder, sizeof folder, "%s", r->t.path);
    char *slash = strrchr(folder, '/');
    if (slash)
        *slash = 0;
    else
        snprintf(folder, sizeof folder, ".");
    if (depth >= MAX_BASES) return textfile_error(&r->t, err, name, "at most %d bases in a row", MAX_BASES);
    if (file_path(path, folder, name, "", err) || file_path(above, folder, "..", "", err)) return err->status;
    const bool same = !strcmp(path, r->t.path);
    if ((same || !path_is_file(path)) && file_path(path, above, name, "", err)) return err->status;
    const struct textfile t = r->t;
    struct err why = ERR_INIT;
    r->t = (struct textfile){0};
    read_described(r, path, depth + 1, &why);
    textfile_release(&r->t);
    r->t = t;
    if (!why.status) return ST_OK;
    return err_set(err, why.status == ST_NOMEM ? ST_NOMEM : ST_DATA, "%s:%d: its base: %s", t.path, t.line, why.text);
}

static enum status described_item(struct reader *r, struct err *err)
{
    const struct vec3 nowhere = {0, 0, 0};
    char *name;
    if (textfile_word(&r->t, "an item's name", &name, err)) return err->status;
    return add_part(&r->plan->furniture, name, nowhere, nowhere, err);
}

static enum status described_switch(struct reader *r, struct err *err)
{
    char *word;
    if (textfile_word(&r->t, "on or off", &word, err)) return err->status;
    r->furniture = !strcmp(word, "on");
    return ST_OK;
}

static enum status described_statement(struct reader *r, const char *verb, int depth, struct err *err)
{
    if (!strcmp(verb, "base")) return described_base(r, depth, err);
    if (!strcmp(verb, "drop")) return described_drop(r, err);
    if (!strcmp(verb, "room")) return described_room(r, err);
    if (!strcmp(verb, "wall")) return described_wall(r, err);
    if (!strcmp(verb, "opening") || !strcmp(verb, "window")) return described_opening(r, err);
    if (!strcmp(verb, "furniture")) return described_switch(r, err);
    return r->furniture ? described_item(r, err) : ST_OK;
}

static enum status read_described(struct reader *r, const char *path, int depth, struct err *err)
{
    textfile_open(&r->t, path, err);
    while (!err->status && textfile_next(&r->t)) {
        char *verb;
        if (!textfile_word(&r->t, "a word", &verb, err)) described_statement(r, verb, depth, err);
    }
    return err->status;
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
    if (add_part(&r->plan->rooms, verb, vec3_make(v[0], v[1], v[2]), vec3_make(v[3], v[4], v[5]), err))
        return err->status;
    static const int corners[5][2] = {{0, 1}, {3, 1}, {3, 4}, {0, 4}, {0, 1}};
    for (int i = 0; i < 4; i++)
        if (add_part(&r->plan->faces, verb, vec3_make(v[corners[i][0]], v[corners[i][1]], v[2]),
                     vec3_make(v[corners[i + 1][0]], v[corners[i + 1][1]], v[2]), err))
            return err->status;
    return ST_OK;
}

static enum status read_framed(struct reader *r, const char *path, struct err *err)
{
    textfile_open(&r->t, path, err);
    while (!err->status && textfile_next(&r->t)) {
        char *verb;
        if (!textfile_word(&r->t, "a word", &verb, err)) framed_statement(r, verb, err);
    }
    return err->status;
}

enum status wall_plan_read(struct measured_plan *plan, const char *path, enum measured_plan_kind kind, struct err *err)
{
    struct reader r = {.plan = plan, .partition = -1, .low = {INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY}};
    *plan = (struct measured_plan){0};
    if (kind == PLAN_FROM_MODEL)
        read_model(plan, path, err);
    else if (kind == PLAN_FROM_SCENE)
        read_described(&r, path, 0, err);
    else
        read_framed(&r, path, err);
    textfile_release(&r.t);
    free(r.lines.parts);
    if (err->status) wall_plan_release(plan);
    return err->status;
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
