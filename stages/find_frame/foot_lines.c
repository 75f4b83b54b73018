/* foot_lines.c - lines cast on floor or ceiling.
 *
 * A line that runs along a level heading has one unknown, its height. If it is the foot of a wall, its height is the
 * floor's: then the lines of cameras at different places fall on each other in the plan, and those of other heights do
 * not. So the floor is the level at which most of them do [compare Hedau 2009, who casts one picture's lines]. */
#include "stages/find_frame/foot_lines.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/math/numbers.h"

#define MIN_SLOPE   0.05 /* sine of the angle between a ray and the horizon */
#define CELLS_ALONG 6    /* length of a cell, in its widths */
#define MOST_CELLS  400  /* that a line may cross */

enum status foot_lines_add(struct foot_lines *f, const struct world_lines *w, const int *headings,
                           const struct room_frame *frame, const struct camera_set *set, double height, bool head,
                           double reach, struct err *err)
{
    for (int i = 0; i < w->count; i++) {
        const struct world_line *l = &w->lines[i];
        const struct vec3 eye = set->views[l->view].center;
        const double down = height - vec3_dot(frame->up, eye);
        struct vec3 place[2];
        bool meets = headings[i] >= 0;
        for (int k = 0; k < 2 && meets; k++) {
            const double slope = vec3_dot(frame->up, l->ends[k]), distance = down / slope;
            meets = (head ? slope > MIN_SLOPE : slope < -MIN_SLOPE) && distance > 0 && distance <= reach;
            place[k] = vec3_add(eye, vec3_scale(l->ends[k], distance));
        }
        if (!meets) continue;
        const struct vec3 along = frame->headings[headings[i]].along, across = frame_across(frame, headings[i]);
        const double a = vec3_dot(along, place[0]), b = vec3_dot(along, place[1]);
        const struct foot_line o = {i,
                                    headings[i],
                                    l->station,
                                    head,
                                    (vec3_dot(across, place[0]) + vec3_dot(across, place[1])) / 2,
                                    fmin(a, b),
                                    fmax(a, b),
                                    vec3_dot(across, eye),
                                    vec3_dot(along, eye)};
        if (array_append(&f->lines, (size_t)f->count, sizeof o, "lines on the plan", err)) return err->status;
        f->lines[f->count++] = o;
    }
    return ST_OK;
}

void foot_lines_release(struct foot_lines *f)
{
    if (!f) return;
    free(f->lines);
    *f = (struct foot_lines){0};
}

struct vote {
    int heading, across, along, station;
};

static int compare(const void *a, const void *b)
{
    const struct vote *x = a, *y = b;
    if (x->heading != y->heading) return x->heading < y->heading ? -1 : 1;
    if (x->across != y->across) return x->across < y->across ? -1 : 1;
    if (x->along != y->along) return x->along < y->along ? -1 : 1;
    return (x->station > y->station) - (x->station < y->station);
}

static bool same_cell(const struct vote *a, const struct vote *b)
{
    return a->heading == b->heading && a->across == b->across && a->along == b->along;
}

static double pairs_of(const struct vote *votes, int count)
{
    double pairs = 0;
    for (int i = 0, end; i < count; i = end) {
        int stations = 0;
        for (end = i; end < count && same_cell(&votes[i], &votes[end]); end++)
            stations += end == i || votes[end].station != votes[end - 1].station;
        pairs += stations * (stations - 1) / 2.0;
    }
    return pairs;
}

enum status foot_lines_pairs(double *pairs, const struct foot_lines *f, double unit, struct err *err)
{
    struct vote *votes = NULL;
    size_t room = 0;
    *pairs = 0;
    for (int grid = 0; !err->status && grid < 2; grid++) { /* two grids, half a cell apart */
        int count = 0;
        for (int i = 0; !err->status && i < f->count; i++) {
            const struct foot_line *l = &f->lines[i];
            const int across = (int)floor(l->offset / unit + 0.5 * grid),
                      first = (int)floor(l->from / unit / CELLS_ALONG), last = (int)floor(l->to / unit / CELLS_ALONG);
            if (last - first > MOST_CELLS) continue;
            if (array_reserve(&votes, &room, (size_t)(count + last - first + 1), sizeof *votes, "cells", err)) break;
            for (int k = first; k <= last; k++) votes[count++] = (struct vote){l->heading, across, k, l->station};
        }
        if (err->status) break;
        qsort(votes, (size_t)count, sizeof *votes, compare);
        *pairs += pairs_of(votes, count) / 2;
    }
    free(votes);
    return err->status;
}
