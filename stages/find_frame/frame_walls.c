/* frame_walls.c - walls where lines on the floor, and on the ceiling, of different places fall on each other.
 *
 * Lines of one heading that are seen from one side are counted on a grid of the plan: a cell holds the places
 * (stations) that show a line there, floor and ceiling apart. The part of a row that most pairs support is a wall:
 * cells that two places show, over short gaps, which furniture and doors make. Its offset is the median of its lines.
 *
 * A line on a wall that is not its foot, such as a window sill, is cast behind it, and so is the edge of a table before
 * it; where cameras stand equally far from the wall, they fall on each other, too. So walls are taken in the order of
 * their support, and each takes away all lines that lie on it at any height between floor and ceiling, as their views
 * see it; the next one is found among the lines that are left.
 *
 * A candidate that views look through is not a wall there: its cells are dropped where two places see something behind
 * it - a sparse point, or a line of a wall that was taken before - below the height of windows, or at any height unless
 * lines show its foot and its head. So the edges of rugs, furniture and grilles in the ceiling drop out, and so do open
 * doors. */
#include "stages/find_frame/frame_walls.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/base/sort.h"
#include "stages/find_frame/wall_grid.h"

/* as parts of the scene's size */
#define GAP          0.35 /* in a wall */
#define MIN_WALL     0.14 /* length */
#define SLACK        0.02 /* beyond its ends, floor and ceiling, where lines are still on it */
#define CORNER_REACH 0.25 /* beyond a wall's end, to the wall across it */
#define CORNER_BACK  0.08 /* before its end */
#define SAME_HEIGHT  0.02 /* of the cameras above the floor: what heights of one line differ by */
#define MIN_CELLS    3    /* that two places show */
#define MIN_PAIRS    5    /* of places that show a cell, in all its cells */

/* The median offset of a wall's lines. values: room for all lines. */
static double median_offset(const struct foot_lines *lines, const bool *used, const struct frame_wall *w, double reach,
                            double *values)
{
    size_t count = 0;
    for (int i = 0; i < lines->count; i++) {
        const struct foot_line *l = &lines->lines[i];
        if (used[l->line] || l->heading != w->heading || foot_line_side(l) != w->side) continue;
        if (fabs(l->offset - w->offset) <= reach && l->to > w->from && l->from < w->to) values[count++] = l->offset;
    }
    return count ? sort_median(values, count) : w->offset;
}

/* The best part of a row: the one with the most pairs. Returns their number; *w: the wall. */
static int best_part(struct frame_wall *w, const struct wall_grid *g, const struct seen_through *through, int row,
                     double size)
{
    int most = 0;
    for (int k = 0; k < g->along; k++) {
        int last = k, cells = 0, pairs = 0, support = 0;
        if (__builtin_popcountll(wall_grid_shown(g, through, row, k)) < 2) continue;
        for (int n = k; n < g->along && n - last <= GAP / WALL_CELL; n++) {
            const int here = __builtin_popcountll(wall_grid_shown(g, through, row, n));
            if (here < 2) continue;
            last = n;
            cells++;
            pairs += here - 1;
            if (here > support) support = here;
        }
        if (cells >= MIN_CELLS && (last + 1 - k) * WALL_CELL >= MIN_WALL && pairs > most) {
            most = pairs;
            w->from = g->from + k * WALL_CELL * size;
            w->to = g->from + (last + 1) * WALL_CELL * size;
            w->offset = g->low + (row + 0.5) * WALL_ROW * size;
            w->support = support;
        }
        k = last;
    }
    return most;
}

/* The wall that the most pairs support among the lines that are not used; returns their number. */
static enum status best_wall(struct frame_wall *best, int *most, const struct room_frame *f,
                             const struct foot_lines *lines, const bool *used, const struct frame_sights *seen,
                             double size, struct err *err)
{
    *most = 0;
    for (int heading = 0; !err->status && heading < f->heading_count; heading++)
        for (int side = -1; !err->status && side <= 1; side += 2) {
            struct frame_wall w = {.heading = heading, .side = side};
            struct wall_grid g = {0};
            struct seen_through *through = NULL;
            if (!wall_grid_fill(&g, lines, used, heading, side, size, err) && g.seen &&
                !(through = malloc((size_t)g.along * sizeof *through)))
                err_nomem(err, "cells of the plan", (size_t)g.along * sizeof *through);
            for (int row = 1; !err->status && g.seen && row + 1 < g.across; row++) {
                if (best_part(&w, &g, NULL, row, size) <= *most) continue; /* before what takes time */
                wall_grid_mark_through(through, &g, row, heading, side, f, seen, size);
                const int pairs = best_part(&w, &g, through, row, size);
                if (pairs <= *most) continue;
                *most = pairs;
                *best = w;
            }
            wall_grid_release(&g);
            free(through);
        }
    return err->status;
}

/* Marks the lines that lie on a wall as used, and adds the sights of those that are on its foot. */
static enum status take_lines(bool *used, struct frame_sights *s, const struct room_frame *f,
                              const struct frame_wall *wall, const struct world_lines *w, const int *headings,
                              const struct camera_set *set, double size, struct err *err)
{
    const struct vec3 along = f->headings[wall->heading].along, across = frame_across(f, wall->heading);
    const double low = f->floor.height - SLACK * size,
                 high = f->ceiling.known ? f->ceiling.height + SLACK * size : INFINITY;
    for (int i = 0; !err->status && i < w->count; i++) {
        double height, place;
        if (used[i] || headings[i] != wall->heading || !world_line_on_wall(&height, &place, &w->lines[i], wall, f, set))
            continue;
        used[i] = height > low && height < high && place > wall->from - SLACK * size && place < wall->to + SLACK * size;
        const struct vec3 at =
            vec3_add(vec3_scale(along, place), vec3_add(vec3_scale(across, wall->offset), vec3_scale(f->up, height)));
        if (used[i]) frame_sights_add(s, w->lines[i].station, set->views[w->lines[i].view].center, at, err);
    }
    return err->status;
}

/* Root mean square of the distance from the mean. */
struct spread {
    double n, sum, square;
};

static void spread_add(struct spread *s, double x)
{
    s->n++;
    s->sum += x;
    s->square += x * x;
}

static double spread_of(const struct spread *s)
{
    return s->n > 0 ? sqrt(fmax(s->square / s->n - s->sum / s->n * (s->sum / s->n), 0)) : 0;
}

/* Whether the lines of wall b may lie on wall a, which is in front of it: at one height of it, as well as at the foot
 * of b. Heights are measured in those of the cameras above the floor. */
static bool is_on(const struct foot_lines *lines, const struct frame_wall *a, const struct frame_wall *b, double size)
{
    const double overlap = fmin(a->to, b->to) - fmax(a->from, b->from);
    struct spread front = {0}, behind = {0};
    if (a->heading != b->heading || a->side != b->side || !(a->side * (a->offset - b->offset) > 0)) return false;
    if (!(overlap > 0.5 * (b->to - b->from)) || 2 * a->support < b->support) return false;
    for (int i = 0; i < lines->count; i++) {
        const struct foot_line *l = &lines->lines[i];
        if (l->heading != b->heading || foot_line_side(l) != b->side ||
            fabs(l->offset - b->offset) > 2 * WALL_ROW * size || !(l->to > b->from && l->from < b->to))
            continue;
        const double near = a->side * (l->eye - a->offset), far = a->side * (l->eye - b->offset),
                     own = a->side * (l->eye - l->offset);
        if (!(near > 0)) return false; /* somebody stands between the two */
        spread_add(&front, near / own);
        spread_add(&behind, far / own);
    }
    return front.n > 0 && spread_of(&front) <= spread_of(&behind) + SAME_HEIGHT;
}

/* Drops walls whose lines may lie on others. */
static enum status drop_explained(struct room_frame *f, const struct foot_lines *lines, double size, struct err *err)
{
    bool *dropped = calloc((size_t)f->wall_count + 1, sizeof *dropped);
    int kept = 0;
    if (!dropped) return err_nomem(err, "walls", (size_t)f->wall_count);
    for (int b = 0; b < f->wall_count; b++)
        for (int a = 0; a < f->wall_count && !dropped[b]; a++)
            dropped[b] = a != b && !dropped[a] && is_on(lines, &f->walls[a], &f->walls[b], size);
    for (int k = 0; k < f->wall_count; k++)
        if (!dropped[k]) f->walls[kept++] = f->walls[k];
    f->wall_count = kept;
    free(dropped);
    return ST_OK;
}

/* Moves an end of a wall to the wall across it that is nearest. end: 1 of `to`, -1 of `from`. */
static void meet_wall(struct frame_wall *w, int end, const struct room_frame *f, double size)
{
    const struct vec3 along = f->headings[w->heading].along, across = frame_across(f, w->heading);
    const double at = end > 0 ? w->to : w->from;
    double nearest = INFINITY, best = at;
    for (int k = 0; k < f->wall_count; k++) {
        const struct frame_wall *o = &f->walls[k];
        const struct vec3 theirs = f->headings[o->heading].along, normal = frame_across(f, o->heading);
        const double turn = vec3_dot(along, normal), place = vec3_dot(theirs, across);
        if (!(fabs(turn) > 0.7)) continue;
        /* where the lines of the two meet: along the wall, and along the other */
        const double meet = (o->offset - w->offset * vec3_dot(across, normal)) / turn,
                     there = w->offset * place + meet * vec3_dot(along, theirs);
        const double beyond = end * (meet - at);
        if (!(beyond > -CORNER_BACK * size && beyond < CORNER_REACH * size)) continue;
        if (!(there > o->from - CORNER_REACH * size && there < o->to + CORNER_REACH * size)) continue;
        if (!(fabs(beyond) < nearest)) continue;
        nearest = fabs(beyond);
        best = meet;
    }
    *(end > 0 ? &w->to : &w->from) = best;
}

enum status walls_find(struct room_frame *f, const struct foot_lines *lines, const struct world_lines *w,
                       const int *headings, const struct camera_set *set, double size, struct err *err)
{
    bool *used = calloc((size_t)w->count + 1, sizeof *used);
    int *stations = malloc(((size_t)set->view_count + 1) * sizeof *stations);
    struct frame_sights seen = {0};
    double *values = malloc(((size_t)lines->count + 1) * sizeof *values);
    f->wall_count = 0;
    free(f->walls);
    f->walls = NULL;
    if (!used || !values || !stations) err_nomem(err, "lines on the plan", (size_t)lines->count * sizeof *values);
    for (int i = 0; !err->status && i < set->view_count; i++) stations[i] = -1;
    for (int i = 0; !err->status && i < w->count; i++) stations[w->lines[i].view] = w->lines[i].station;
    if (!err->status) frame_sights_of_points(&seen, stations, set, err);
    for (int most = MIN_PAIRS; !err->status && most >= MIN_PAIRS;) {
        struct frame_wall wall = {0};
        if (best_wall(&wall, &most, f, lines, used, &seen, size, err) || most < MIN_PAIRS) break;
        wall.offset = median_offset(lines, used, &wall, 1.5 * WALL_ROW * size, values);
        if (take_lines(used, &seen, f, &wall, w, headings, set, size, err)) break;
        for (int i = 0; i < lines->count; i++) { /* so that the search ends: also those seen at grazing angles */
            const struct foot_line *l = &lines->lines[i];
            if (l->heading == wall.heading && foot_line_side(l) == wall.side &&
                fabs(l->offset - wall.offset) <= 2 * WALL_ROW * size && l->to > wall.from && l->from < wall.to)
                used[l->line] = true;
        }
        if (!array_append(&f->walls, (size_t)f->wall_count, sizeof wall, "walls", err))
            f->walls[f->wall_count++] = wall;
    }
    if (!err->status) drop_explained(f, lines, size, err);
    for (int k = 0; !err->status && k < f->wall_count; k++)
        for (int end = -1; end <= 1; end += 2) {
            struct frame_wall met = f->walls[k];
            meet_wall(&met, end, f, size);
            if (met.to - met.from > MIN_WALL / 2 * size) f->walls[k] = met;
        }
    free(used);
    free(values);
    free(stations);
    free(seen.list);
    return err->status;
}
