/* line_directions.c - vanishing directions of all views at once.
 *
 * Cameras are known, so that all views share their vanishing directions: a line and its camera span a plane, and a
 * direction that the line runs along lies in it [Antone 2000].
 *   1. up is looked for within MAX_TILT of how the cameras were held: the direction with the most length of lines
 *   2. a heading and the one perpendicular to it: the same among level directions
 *   3. the three are turned together, by robust least squares of the angles in the pictures (Tukey's biweight)
 *   4. further headings, of walls at other angles: one after the other, of the lines that are left
 *
 * Standard errors are those of clustered least squares, the lines of a view being one observation: its pose and lens
 * err for all of them alike. With few views, the error is larger by the ratio of Student's t to the normal
 * distribution. */
#include "stages/find_frame/line_directions.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/sort.h"
#include "common/math/numbers.h"
#include "common/math/rotation_fit.h"

#define MAX_TILT     35.0 /* degrees between up and how cameras were held on average */
#define TILT_STEP    3.0  /* degrees, of the search */
#define FINE_STEP    0.75
#define TURN_STEP    0.5
#define AGREES       1.5  /* degrees between a line and its direction, as the picture shows them */
#define MOST_LINES   8000 /* that take part in the search; of more, evenly spaced ones of the list */
#define ITERATIONS   15
#define BIWEIGHT     4.685
#define MAX_HEADINGS 6
#define APART        7.0 /* degrees between headings */

/* How much of a line's length counts for a direction. tangent: of the angle between the two at which it counts no
 * more. */
static double support(const struct world_line *l, struct vec3 d, double tangent)
{
    const double off = world_line_slope(l, d) / tangent;
    return off < 1 ? l->length * (1 - off * off) * (1 - off * off) : 0;
}

struct search {
    const struct world_lines *w;
    int stride;
    const bool *used; /* of each line: it has a direction; NULL: none has */
};

static double total_support(const struct search *s, struct vec3 d, double agrees)
{
    const double tangent = tan(agrees * DEGREE);
    double sum = 0;
    for (int i = 0; i < s->w->count; i += s->stride)
        if (!s->used || !s->used[i]) sum += support(&s->w->lines[i], d, tangent);
    return sum;
}

static double total_length(const struct world_lines *w, int stride)
{
    double sum = 0;
    for (int i = 0; i < w->count; i += stride) sum += w->lines[i].length;
    return sum;
}

/* Two unit vectors across d. */
static void across(struct vec3 d, struct vec3 *a, struct vec3 *b)
{
    *a = vec3_normalize(vec3_cross(d, fabs(d.x) < 0.7 ? vec3_make(1, 0, 0) : vec3_make(0, 1, 0)));
    *b = vec3_cross(d, *a);
}

/* The best direction within `reach` degrees of another, in steps. */
static struct vec3 search_around(const struct search *s, struct vec3 middle, double reach, double step, double agrees,
                                 double *most)
{
    const int steps = (int)(reach / step);
    struct vec3 a, b, best = middle;
    across(middle, &a, &b);
    *most = 0;
    for (int i = -steps; i <= steps; i++)
        for (int j = -steps; j <= steps; j++) {
            if (i * i + j * j > steps * steps) continue;
            const struct vec3 d = vec3_normalize(vec3_add(
                middle, vec3_add(vec3_scale(a, tan(i * step * DEGREE)), vec3_scale(b, tan(j * step * DEGREE)))));
            const double sum = total_support(s, d, agrees);
            if (sum > *most) *most = sum, best = d;
        }
    return best;
}

static struct vec3 find_up(const struct search *s, struct vec3 mean_up, double *most)
{
    const struct vec3 rough = search_around(s, mean_up, MAX_TILT, TILT_STEP, TILT_STEP, most);
    return search_around(s, rough, TILT_STEP, FINE_STEP, AGREES, most);
}

static struct vec3 level_direction(struct vec3 up, double degrees)
{
    struct vec3 a, b;
    across(up, &a, &b);
    return vec3_add(vec3_scale(a, cos(degrees * DEGREE)), vec3_scale(b, sin(degrees * DEGREE)));
}

/* The best level direction; pair: together with the one perpendicular to it. */
static struct vec3 find_heading(const struct search *s, struct vec3 up, bool pair, double *most)
{
    struct vec3 best = level_direction(up, 0);
    *most = 0;
    for (double turn = 0; turn < (pair ? 90 : 180); turn += TURN_STEP) {
        const struct vec3 d = level_direction(up, turn);
        const double sum = total_support(s, d, AGREES) + (pair ? total_support(s, vec3_cross(up, d), AGREES) : 0);
        if (sum > *most) *most = sum, best = d;
    }
    return best;
}

/* ------------------------------------------------------------------------------------------------------- refinement */

/* The axis that a line runs along, and its distance from it in standard errors; -1: none. */
static int axis_of(const struct world_line *l, const struct mat3 *axes, double *off)
{
    int best = -1;
    double least = 2 * AGREES * DEGREE;
    for (int k = 0; k < 3; k++) {
        const double angle = world_line_angle(l, mat3_row(*axes, k));
        if (!(angle < least)) continue;
        least = angle;
        best = k;
    }
    *off = least / l->error;
    return best;
}

struct fit {
    struct mat3 information;
    struct vec3 right;
    double weights[3];
};

/* Adds a line's equation, normal . axis = 0, to the equations of a small rotation w of the axes, in the world. */
static void add_line(struct fit *f, const struct world_line *l, const struct mat3 *axes, int k, double weight)
{
    const struct vec3 axis = mat3_row(*axes, k), lever = vec3_cross(l->normal, axis);
    const double sigma = l->error * fabs(vec3_dot(l->across, axis)), w = weight / (sigma * sigma),
                 off = vec3_dot(l->normal, axis), v[3] = {lever.x, lever.y, lever.z};
    for (int j = 0; j < 9; j++) f->information.m[j / 3][j % 3] += w * v[j / 3] * v[j % 3];
    f->right = vec3_sub(f->right, vec3_scale(lever, w * off));
    f->weights[k] += weight;
}

/* Robust standard deviation of the lines' distances from their axes, in their stated errors. scratch: of all lines. */
static double spread(const struct world_lines *w, const struct mat3 *axes, double *scratch)
{
    size_t count = 0;
    for (int i = 0; i < w->count; i++) {
        double off;
        if (axis_of(&w->lines[i], axes, &off) >= 0) scratch[count++] = off;
    }
    return count ? fmax(sort_median(scratch, count) / 0.6745, 0.05) : 1;
}

static double biweight(double off, double cut)
{
    const double u = off / cut;
    return u < 1 ? (1 - u * u) * (1 - u * u) : 0;
}

/* Derivative of the biweight times the distance: an M-estimator's error is that of its gradient over this slope. */
static double biweight_slope(double off, double cut)
{
    const double u = off / cut;
    return u < 1 ? (1 - u * u) * (1 - 5 * u * u) : 0;
}

static void refine(struct mat3 *axes, const struct world_lines *w, double *scratch)
{
    for (int round = 0; round < ITERATIONS; round++) {
        const double cut = BIWEIGHT * spread(w, axes, scratch);
        struct fit f = {0};
        struct mat3 unknown;
        for (int i = 0; i < w->count; i++) {
            double off;
            const int k = axis_of(&w->lines[i], axes, &off);
            if (k >= 0) add_line(&f, &w->lines[i], axes, k, biweight(off, cut));
        }
        const struct vec3 turn = mat3_apply(rotation_inverse_of_known(f.information, &unknown), f.right);
        const struct vec3 inside = mat3_apply(*axes, turn); /* the same rotation in the axes' frame */
        *axes = rotation_turn(*axes, inside);
    }
}

/* The 97.5 % quantile of Student's t by that of the normal distribution. */
static double student_ratio(int degrees_of_freedom)
{
    static const double known[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228};
    const double z = 1.959964;
    if (degrees_of_freedom < 1) return known[0] / z;
    if (degrees_of_freedom <= 10) return known[degrees_of_freedom - 1] / z;
    return 1 + (z * z + 1) / (4 * degrees_of_freedom); /* the first term of its expansion */
}

/* Standard errors of rotations about the three axes. */
static enum status find_errors(struct vec3 *errors, const struct mat3 *axes, const struct world_lines *w,
                               double *scratch, struct err *err)
{
    const double cut = BIWEIGHT * spread(w, axes, scratch);
    struct vec3 *gradients = calloc((size_t)w->count + 1, sizeof *gradients);
    struct fit f = {0};
    struct mat3 unknown;
    int views = 0;
    if (!gradients) return err_nomem(err, "lines by view", (size_t)w->count * sizeof *gradients);
    for (int i = 0; i < w->count; i++) { /* the lines of a view follow each other */
        double off;
        const int k = axis_of(&w->lines[i], axes, &off);
        if (k < 0 || !(biweight(off, cut) > 0)) continue;
        const bool first = !views || i == 0 || w->lines[i].view != w->lines[i - 1].view;
        struct fit one = {0};
        add_line(&one, &w->lines[i], axes, k, biweight(off, cut));
        add_line(&f, &w->lines[i], axes, k, biweight_slope(off, cut));
        views += first;
        gradients[views - 1] = vec3_add(gradients[views - 1], mat3_apply(*axes, one.right));
    }
    const struct mat3 inside =
        mat3_multiply(mat3_multiply(*axes, f.information), mat3_transpose(*axes)); /* in the axes' frame */
    const double few = views > 1 ? (double)views / (views - 1) : 2;
    *errors = vec3_scale(rotation_sandwich(rotation_inverse_of_known(inside, &unknown), gradients, views),
                         sqrt(few) * student_ratio(views - 1));
    free(gradients);
    return ST_OK;
}

static enum status add_heading(struct room_frame *f, struct vec3 along, double error, double share, struct err *err)
{
    if (!array_append(&f->headings, (size_t)f->heading_count, sizeof *f->headings, "headings", err))
        f->headings[f->heading_count++] = (struct frame_heading){along, error, share};
    return err->status;
}

/* A heading moved to the mean of the lines that agree with it, and its standard error. */
static struct vec3 refine_heading(const struct search *s, struct vec3 up, struct vec3 d, double *error)
{
    double squares = 0, weights = 0, gradient = 0;
    for (int round = 0; round < ITERATIONS; round++) {
        const struct vec3 side = vec3_cross(up, d);
        gradient = squares = weights = 0;
        for (int i = 0; i < s->w->count; i++) {
            const struct world_line *l = &s->w->lines[i];
            const double agree = s->used[i] ? 0 : support(l, d, tan(AGREES * DEGREE));
            if (!(agree > 0)) continue;
            const double sigma = l->error * fabs(vec3_dot(l->across, d)), lever = vec3_dot(l->normal, side),
                         off = vec3_dot(l->normal, d), w = agree / l->length / (sigma * sigma);
            gradient += w * lever * off;
            weights += w * lever * lever;
            squares += w * w * lever * lever * off * off;
        }
        if (!(weights > 0)) break;
        d = vec3_normalize(vec3_sub(d, vec3_scale(side, gradient / weights)));
    }
    *error = weights > 0 ? sqrt(squares) / weights : 1;
    return d;
}

static enum status add_other_headings(struct room_frame *f, struct search *s, double length,
                                      const struct frame_params *params, struct err *err)
{
    bool *used = calloc((size_t)s->w->count + 1, sizeof *used);
    if (!used) return err_nomem(err, "lines", (size_t)s->w->count);
    s->used = used;
    for (int i = 0; i < s->w->count; i++) {
        const struct world_line *l = &s->w->lines[i];
        used[i] = world_line_angle(l, f->up) < 2 * AGREES * DEGREE || line_heading(f, l) >= 0;
    }
    while (!err->status && f->heading_count < MAX_HEADINGS) {
        double most, error;
        bool apart = true;
        const struct vec3 rough = find_heading(s, f->up, false, &most), d = refine_heading(s, f->up, rough, &error);
        if (!(most >= params->min_heading * length)) break;
        for (int k = 0; k < f->heading_count; k++)
            apart = apart && fabs(vec3_dot(d, f->headings[k].along)) < cos(APART * DEGREE);
        if (apart) add_heading(f, d, error, most / length, err);
        for (int i = 0; i < s->w->count; i++)
            used[i] = used[i] || world_line_angle(&s->w->lines[i], d) < 2 * AGREES * DEGREE;
    }
    free(used);
    s->used = NULL;
    return err->status;
}

int line_heading(const struct room_frame *f, const struct world_line *l)
{
    double least = AGREES * DEGREE;
    int best = -1;
    if (world_line_angle(l, f->up) < least) return -1;
    for (int k = 0; k < f->heading_count; k++) {
        const double angle = world_line_angle(l, f->headings[k].along);
        if (!(angle < least)) continue;
        least = angle;
        best = k;
    }
    return best;
}

enum status line_directions_find(struct room_frame *f, const struct world_lines *w, struct vec3 mean_up,
                                 const struct frame_params *params, struct err *err)
{
    struct search s = {.w = w, .stride = w->count / MOST_LINES + 1};
    double upright, level, *scratch = malloc(((size_t)w->count + 1) * sizeof *scratch);
    struct vec3 errors = {0};
    if (!scratch) return err_nomem(err, "lines", (size_t)w->count * sizeof *scratch);
    const double length = total_length(w, s.stride);
    const struct vec3 up = find_up(&s, mean_up, &upright), x = find_heading(&s, up, true, &level),
                      y = vec3_cross(up, x);
    struct mat3 axes = {{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {up.x, up.y, up.z}}};
    const double weaker =
        fmin(total_support(&s, x, AGREES), total_support(&s, y, AGREES)); /* one alone may be a shelf, or the horizon */
    if (upright >= params->min_up * length && level >= params->min_pair * length &&
        weaker >= params->min_one * length && w->count >= params->min_lines) {
        refine(&axes, w, scratch);
        find_errors(&errors, &axes, w, scratch, err);
        f->known = true;
        f->up = mat3_row(axes, 2);
        f->up_error = sqrt((errors.x * errors.x + errors.y * errors.y) / 2);
        for (int k = 0; k < 2 && !err->status; k++)
            add_heading(f, mat3_row(axes, k), errors.z, total_support(&s, mat3_row(axes, k), AGREES) / length, err);
        if (!err->status) add_other_headings(f, &s, length, params, err);
    }
    free(scratch);
    if (err->status) room_frame_release(f);
    return err->status;
}
