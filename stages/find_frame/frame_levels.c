/* frame_levels.c - floor and ceiling.
 *
 * Floor: see foot_lines.c. Of all heights below the cameras the one is taken at which most lines of different places
 * fall on each other, if it is clearly better than those around, and if few sparse points are below it: tables and beds
 * have straight edges at one height, too, but what is seen goes on below them. Where lines do not say, as in a room
 * seen from few places, it is the level at which the sparse points end, if there they do so at once, and if photos show
 * what lies below. The upper edge of a skirting board is as straight as its lower one, so the height errs by a few
 * hundredths of the camera's.
 *
 * Ceiling: a wall whose foot is known stands at a known distance, so each line above that runs along it has one height
 * on it. Heads of doors and windows have common heights, too; the ceiling is the highest level that many walls and
 * places share, and many lines, since nothing is above it. A moulding below it has several edges: the highest of those
 * that lie together is the ceiling. */
#include "stages/find_frame/frame_levels.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/base/sort.h"
#include "common/math/numbers.h"
#include "common/math/weighted.h"

/* as parts of the scene's size */
#define UNIT    0.012 /* width of a cell of the plan */
#define STEP    0.006 /* between heights that are tried */
#define FINE    0.001
#define LOWEST  1.2  /* how far below the cameras a floor is looked for */
#define HIGHEST 1.6  /* how far above them a ceiling is */
#define LEAST   0.08 /* how far from a camera both must be, and by how much points may be off them */
#define REACH   3.0  /* farthest line that counts */

#define CLEARLY      1.4 /* times the median over the heights around */
#define AROUND       20  /* steps */
#define MIN_PAIRS    12
#define HEAD_SHARE   0.7  /* of the votes of the best height, from which on a higher one is the ceiling */
#define HEAD_CLEARLY 2.0  /* times the votes of a height if they lay anywhere, which the best must have */
#define HEAD_VOTES   0.35 /* of the lines of the height that most lines share, likewise: a few lines agree by chance */
#define MIN_HEADS    3    /* walls and places that show a ceiling */
#define EDGE_WIDTH   2    /* fine steps: how much the heights of one edge differ */
#define BEYOND       0.1  /* of the sparse points, which may be beyond floor and ceiling: reflections, streets */
#define EDGE_POINTS  20   /* that show where points end */
#define EDGE_SHARE   0.01
#define EDGE_RISE    3.0  /* times the points of the step below */
#define EDGE_BELOW   0.03 /* of all points */

struct level_limits {
    double lowest, highest; /* the cameras */
    double floor, ceiling;  /* the highest that the floor can be, and the lowest that the ceiling can */
};

static enum status limits_of(struct level_limits *h, const struct camera_set *set, struct vec3 up, double size,
                             struct err *err)
{
    const struct sfm_model *m = &set->model;
    const size_t count = (size_t)m->point_count;
    struct weighted *heights = malloc((count + 1) * sizeof *heights);
    *h = (struct level_limits){.lowest = INFINITY, .highest = -INFINITY};
    if (!heights) return err_nomem(err, "heights of points", count * sizeof *heights);
    for (int i = 0; i < set->view_count; i++) {
        const double height = vec3_dot(up, set->views[i].center);
        h->lowest = fmin(h->lowest, height);
        h->highest = fmax(h->highest, height);
    }
    h->floor = h->lowest - LEAST * size;
    h->ceiling = h->highest + LEAST * size;
    for (size_t i = 0; i < count; i++) heights[i] = (struct weighted){vec3_dot(up, m->points[i].position), 1};
    if (count) {
        h->floor = fmin(h->floor, weighted_percentile(heights, count, BEYOND) + LEAST * size);
        h->ceiling = fmax(h->ceiling, weighted_percentile(heights, count, 1 - BEYOND) - LEAST * size);
    }
    free(heights);
    return ST_OK;
}

static enum status pairs_at(double *pairs, double height, const struct room_frame *f, const struct world_lines *w,
                            const int *headings, const struct camera_set *set, double size, struct err *err)
{
    struct foot_lines lines = {0};
    *pairs = 0;
    if (!foot_lines_add(&lines, w, headings, f, set, height, false, REACH * size, err))
        foot_lines_pairs(pairs, &lines, UNIT * size, err);
    foot_lines_release(&lines);
    return err->status;
}

enum status levels_floor_of_lines(struct room_frame *f, const struct world_lines *w, const int *headings,
                                  const struct camera_set *set, double size, struct err *err)
{
    struct level_limits limits;
    f->floor = (struct frame_level){.known = false};
    if (limits_of(&limits, set, f->up, size, err)) return err->status;
    const double top = limits.lowest - LEAST * size, bottom = limits.lowest - LOWEST * size;
    const int steps = (int)((top - bottom) / (STEP * size)) + 1;
    const int first = (int)ceil(fmax(top - limits.floor, 0) / (STEP * size));
    double *pairs = calloc((size_t)steps, sizeof *pairs), around[2 * AROUND + 1], usual = 0, most = 0;
    int best = -1, count = 0;
    if (!pairs) return err_nomem(err, "heights", (size_t)steps * sizeof *pairs);
    for (int k = 0; !err->status && k < steps; k++) {
        pairs_at(&pairs[k], top - k * STEP * size, f, w, headings, set, size, err);
        if (k >= first && pairs[k] > most) best = k, most = pairs[k];
    }
    for (int k = best - AROUND; !err->status && best >= 0 && k <= best + AROUND; k++)
        if (k >= 0 && k < steps) around[count++] = pairs[k];
    if (count) usual = sort_median(around, (size_t)count);
    free(pairs);
    if (err->status || !(most >= MIN_PAIRS && most >= CLEARLY * usual)) return err->status;
    /* the mean of finer steps around, weighted by what they have more than usual */
    const double rough = top - best * STEP * size;
    double sum = 0, mean = 0, square = 0;
    for (int k = -8; !err->status && k <= 8; k++) {
        double here = 0;
        if (pairs_at(&here, rough + k * FINE * size, f, w, headings, set, size, err)) break;
        const double weight = fmax(here - (most + usual) / 2, 0);
        sum += weight;
        mean += weight * k * FINE * size;
        square += weight * k * k * FINE * FINE * size * size;
    }
    mean = sum > 0 ? mean / sum : 0;
    f->floor =
        (struct frame_level){true, rough + mean, sum > 0 ? sqrt(fmax(square / sum - mean * mean, 0)) : STEP * size};
    return err->status;
}

struct point_height {
    double height;
    bool foot; /* views show what lies below it */
};

static int lower_first(const void *a, const void *b)
{
    const struct point_height *p = a, *q = b;
    return (p->height > q->height) - (p->height < q->height);
}

/* Of the steps that start at a low point, it is the one that has most feet more than the step below it has points. */
enum status levels_floor_of_points(struct room_frame *f, const struct camera_set *set, double size, struct err *err)
{
    struct level_limits limits;
    f->floor = (struct frame_level){.known = false};
    if (limits_of(&limits, set, f->up, size, err)) return err->status;
    const size_t count = (size_t)set->model.point_count;
    struct point_height *p = malloc((count + 1) * sizeof *p);
    size_t below = 0, end = 0; /* the first points of the step below, and behind the step */
    double most = 0, feet = 0; /* feet: in the step */
    if (!p) return err_nomem(err, "heights of points", count * sizeof *p);
    for (size_t i = 0; i < count; i++) {
        const struct vec3 at = set->model.points[i].position;
        p[i] = (struct point_height){vec3_dot(f->up, at), camera_set_shows_below(set, at, vec3_scale(f->up, -1))};
    }
    qsort(p, count, sizeof *p, lower_first);
    for (size_t i = 0; i < count && (double)i <= EDGE_BELOW * (double)count; feet -= p[i++].foot) {
        while (p[below].height < p[i].height - STEP * size) below++;
        while (end < count && p[end].height <= p[i].height + STEP * size) feet += p[end++].foot;
        const double before = (double)(i - below);
        if (feet < fmax(EDGE_POINTS, EDGE_SHARE * (double)count) || feet < EDGE_RISE * before || feet - before <= most)
            continue;
        if (p[i].height > limits.lowest - LEAST * size) break;
        most = feet - before;
        f->floor = (struct frame_level){true, p[i + (end - i) / 2].height, STEP * size / 2};
    }
    free(p);
    return ST_OK;
}

/* A height at which a line above a wall lies on it, if it does. */
struct head_vote {
    double height;
    int group; /* wall and station */
};

static int compare_votes(const void *a, const void *b)
{
    const struct head_vote *x = a, *y = b;
    if (x->height != y->height) return x->height < y->height ? -1 : 1;
    return (x->group > y->group) - (x->group < y->group);
}

/* in_window[i]: of how many groups there are votes at most `width` below vote i; returns the most. groups: zeros, one
 * for each group, which are zeros again after it. */
static int count_in_windows(int *in_window, int *groups, const struct head_vote *votes, int count, double width)
{
    int most = 0, first = 0, distinct = 0;
    for (int i = 0; i < count; i++) {
        distinct += !groups[votes[i].group]++;
        for (; votes[i].height - votes[first].height > width; first++) distinct -= !--groups[votes[first].group];
        in_window[i] = distinct;
        if (distinct > most) most = distinct;
    }
    for (; first < count; first++) groups[votes[first].group]--;
    return most;
}

/* How many votes are at most `width` below vote i. */
static int votes_below(const struct head_vote *votes, int i, double width)
{
    int first = i;
    while (first > 0 && votes[i].height - votes[first - 1].height <= width) first--;
    return i - first + 1;
}

enum status levels_find_ceiling(struct room_frame *f, const struct world_lines *w, const int *headings,
                                const struct camera_set *set, double size, struct err *err)
{
    struct level_limits limits;
    if (limits_of(&limits, set, f->up, size, err)) return err->status;
    const double least = limits.ceiling, most = limits.highest + HIGHEST * size;
    struct head_vote *votes = NULL;
    int count = 0;
    int support = 0;
    for (int k = 0; k < f->wall_count; k++)
        if (f->walls[k].support > support) support = f->walls[k].support;
    for (int k = 0; !err->status && k < f->wall_count; k++)
        for (int i = 0; 2 * f->walls[k].support >= support && !err->status && i < w->count; i++) {
            const struct world_line *l = &w->lines[i];
            struct head_vote v = {.group = k * w->stations + l->station};
            const struct frame_wall *wall = &f->walls[k];
            double place;
            if (headings[i] != wall->heading || !world_line_on_wall(&v.height, &place, l, wall, f, set)) continue;
            if (!(place > wall->from && place < wall->to)) continue;
            if (!(v.height > least && v.height < most)) continue;
            if (!array_append(&votes, (size_t)count, sizeof v, "lines above walls", err)) votes[count++] = v;
        }
    if (!err->status && count) qsort(votes, (size_t)count, sizeof *votes, compare_votes);
    int *groups = calloc((size_t)f->wall_count * (size_t)w->stations + 1, sizeof *groups), best = 0;
    int *in_window = malloc(((size_t)count + 1) * sizeof *in_window);
    if (!groups || !in_window)
        err_nomem(err, "heights", (size_t)count * sizeof *in_window);
    else
        best = count_in_windows(in_window, groups, votes, count, 2 * STEP * size);
    const double usual = count * 2 * STEP * size / (most - least); /* in a window, if they lay anywhere */
    int at = best >= HEAD_CLEARLY * usual ? count - 1 : -1, lines = 0;
    for (int i = 0; !err->status && i < count; i++) {
        const int here = votes_below(votes, i, 2 * STEP * size);
        if (here > lines) lines = here;
    }
    while (!err->status && at >= 0 &&
           !(in_window[at] >= HEAD_SHARE * best && in_window[at] >= MIN_HEADS &&
             votes_below(votes, at, 2 * STEP * size) >= HEAD_VOTES * lines))
        at--;
    if (!err->status && at >= 0) {
        /* the fullest window that overlaps it */
        int fullest = at;
        for (int i = at; i >= 0 && votes[at].height - votes[i].height < 2 * STEP * size; i--)
            if (in_window[i] > in_window[fullest]) fullest = i;
        /* of the edges in both windows the highest that is seen from enough of the places */
        const double lowest = votes[fullest].height - 2 * STEP * size;
        int from = fullest, edge = at;
        while (from > 0 && votes[from - 1].height >= lowest) from--;
        best = count_in_windows(in_window, groups, votes + from, at - from + 1, EDGE_WIDTH * FINE * size);
        while (edge > from && in_window[edge - from] < HEAD_SHARE * best) edge--;
        while (edge > from && in_window[edge - 1 - from] > in_window[edge - from]) edge--;
        double sum = 0, square = 0;
        int n = 0;
        for (int i = edge; i >= from && votes[edge].height - votes[i].height <= EDGE_WIDTH * FINE * size; i--, n++) {
            const double d = votes[i].height - votes[edge].height;
            sum += d;
            square += d * d;
        }
        /* walls are as far away as the floor is low: its error counts, too */
        const double height = votes[edge].height + sum / n, eye = (limits.lowest + limits.highest) / 2,
                     carried = f->floor.error * (height - eye) / (eye - f->floor.height);
        f->ceiling =
            (struct frame_level){true, height, hypot(carried, sqrt(fmax(square / n - sum / n * (sum / n), 0) / n))};
    }
    free(votes);
    free(groups);
    free(in_window);
    return err->status;
}
