/* frame_levels.c - floor and ceiling.
 *
 * Floor: see foot_lines.c. Of all heights below the cameras the one is taken at which most lines of different places
 * fall on each other, if it is clearly better than most heights. The upper edge of a skirting board is as straight as
 * its lower one, so the height errs by a few hundredths of the camera's.
 *
 * Ceiling: a wall whose foot is known stands at a known distance, so each line above that runs along it has one height
 * on it. Heads of doors and windows have common heights, too; the ceiling is the highest level that many walls and
 * places share, since nothing is above it. */
#include "stages/find_frame/frame_levels.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/base/sort.h"
#include "common/math/numbers.h"

/* as parts of the scene's size */
#define UNIT    0.012 /* width of a cell of the plan */
#define STEP    0.006 /* between heights that are tried */
#define FINE    0.001
#define LOWEST  1.2  /* how far below the cameras a floor is looked for */
#define HIGHEST 1.6  /* how far above them a ceiling is */
#define LEAST   0.08 /* how far from a camera both must be */
#define REACH   3.0  /* farthest line that counts */

#define CLEARLY      1.4 /* times the median over all heights */
#define MIN_PAIRS    12
#define HEAD_SHARE   0.7 /* of the votes of the best height, from which on a higher one is the ceiling */
#define HEAD_CLEARLY 2.0 /* times the votes of a height if they lay anywhere, which the best must have */
#define MIN_HEADS    3   /* walls and places that show a ceiling */

struct camera_heights {
    double lowest, highest;
};

static struct camera_heights heights_of_cameras(const struct camera_set *set, struct vec3 up)
{
    struct camera_heights h = {INFINITY, -INFINITY};
    for (int i = 0; i < set->view_count; i++) {
        const double height = vec3_dot(up, set->views[i].center);
        h.lowest = fmin(h.lowest, height);
        h.highest = fmax(h.highest, height);
    }
    return h;
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

enum status levels_find_floor(struct room_frame *f, const struct world_lines *w, const int *headings,
                              const struct camera_set *set, double size, struct err *err)
{
    const struct camera_heights cameras = heights_of_cameras(set, f->up);
    const double top = cameras.lowest - LEAST * size, bottom = cameras.lowest - LOWEST * size;
    const int steps = (int)((top - bottom) / (STEP * size)) + 1;
    double *pairs = calloc((size_t)steps * 2, sizeof *pairs), *sorted = pairs ? pairs + steps : NULL;
    int best = 0;
    if (!pairs) return err_nomem(err, "heights", (size_t)steps * 2 * sizeof *pairs);
    for (int k = 0; !err->status && k < steps; k++) {
        pairs_at(&pairs[k], top - k * STEP * size, f, w, headings, set, size, err);
        sorted[k] = pairs[k];
        if (!err->status && pairs[k] > pairs[best]) best = k;
    }
    const double most = pairs[best], usual = err->status ? 0 : sort_median(sorted, (size_t)steps);
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

enum status levels_find_ceiling(struct room_frame *f, const struct world_lines *w, const int *headings,
                                const struct camera_set *set, double size, struct err *err)
{
    const struct camera_heights cameras = heights_of_cameras(set, f->up);
    const double least = cameras.highest + LEAST * size, most = cameras.highest + HIGHEST * size;
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
    if (!err->status) qsort(votes, (size_t)count, sizeof *votes, compare_votes);
    /* windows of two steps: how many walls and places have a line in each */
    int *groups = calloc((size_t)f->wall_count * (size_t)w->stations + 1, sizeof *groups), best = 0;
    int *in_window = malloc(((size_t)count + 1) * sizeof *in_window);
    if (!groups || !in_window) err_nomem(err, "heights", (size_t)count * sizeof *in_window);
    for (int i = 0, first = 0, distinct = 0; !err->status && i < count; i++) {
        distinct += !groups[votes[i].group]++;
        for (; votes[i].height - votes[first].height > 2 * STEP * size; first++)
            distinct -= !--groups[votes[first].group];
        in_window[i] = distinct;
        if (distinct > best) best = distinct;
    }
    const double usual = count * 2 * STEP * size / (most - least); /* in a window, if they lay anywhere */
    int at = best >= HEAD_CLEARLY * usual ? count - 1 : -1;
    while (!err->status && at >= 0 && !(in_window[at] >= HEAD_SHARE * best && in_window[at] >= MIN_HEADS)) at--;
    if (!err->status && at >= 0) {
        /* the fullest window that overlaps it */
        int fullest = at;
        for (int i = at; i >= 0 && votes[at].height - votes[i].height < 2 * STEP * size; i--)
            if (in_window[i] > in_window[fullest]) fullest = i;
        double sum = 0, square = 0;
        int n = 0;
        for (int i = fullest; i >= 0 && votes[fullest].height - votes[i].height <= 2 * STEP * size; i--, n++) {
            const double d = votes[i].height - votes[fullest].height;
            sum += d;
            square += d * d;
        }
        f->ceiling = (struct frame_level){true, votes[fullest].height + sum / n,
                                          sqrt(fmax(square / n - sum / n * (sum / n), 0) / n)};
    }
    free(votes);
    free(groups);
    free(in_window);
    return err->status;
}
