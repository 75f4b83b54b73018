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
 * it - a sparse point, or a line of a wall that was taken before - below the height of windows, or at any height if no
 * line shows its head. So the edges of rugs and furniture drop out, and so do open doors. */
#include "stages/find_frame/frame_walls.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/sort.h"

/* as parts of the scene's size */
#define ROW           0.008 /* width of a cell across the lines */
#define CELL          0.07  /* its length */
#define GAP           0.35  /* in a wall */
#define MIN_WALL      0.14  /* length */
#define SLACK         0.02  /* beyond its ends, floor and ceiling, where lines are still on it */
#define CORNER_REACH  0.25  /* beyond a wall's end, to the wall across it */
#define CORNER_BACK   0.08  /* before its end */
#define BEHIND        0.06  /* a wall, of the scene's size */
#define USUAL_HEIGHT  0.9   /* of a room whose ceiling is not known yet */
#define LOWEST_SIGHT  0.03  /* of the room's height, where a sight crosses a wall */
#define HIGHEST_SIGHT 0.93
#define WINDOW_SIGHT  0.36                /* of the height, from which on windows begin */
#define HEADS         0xaaaaaaaaaaaaaaaau /* station_bit() of lines on the ceiling */
#define MOST_SIGHTS   60000
#define SAME_HEIGHT   0.02 /* of the cameras above the floor: what heights of one line differ by */
#define MIN_CELLS     3    /* that two places show */
#define MIN_PAIRS     5    /* of places that show a cell, in all its cells */

struct grid {
    double from, low; /* along and across, of cell 0 */
    int across, along;
    uint64_t *seen; /* of each cell: the stations and levels */
};

static int lines_side(const struct foot_line *l) { return l->eye > l->offset ? 1 : -1; }

static uint64_t station_bit(const struct foot_line *l) { return (uint64_t)1 << (2 * l->station + l->head) % 64; }

static enum status grid_fill(struct grid *g, const struct foot_lines *lines, const bool *used, int heading, int side,
                             double size, struct err *err)
{
    double low = INFINITY, high = -INFINITY, from = INFINITY, to = -INFINITY;
    *g = (struct grid){0};
    for (int i = 0; i < lines->count; i++) {
        const struct foot_line *l = &lines->lines[i];
        if (used[l->line] || l->heading != heading || lines_side(l) != side) continue;
        low = fmin(low, l->offset), high = fmax(high, l->offset);
        from = fmin(from, l->from), to = fmax(to, l->to);
    }
    if (!(high >= low)) return ST_OK;
    g->low = low - 2 * ROW * size;
    g->from = from;
    g->across = (int)((high - low) / (ROW * size)) + 5;
    g->along = (int)((to - from) / (CELL * size)) + 1;
    g->seen = calloc((size_t)g->across * (size_t)g->along, sizeof *g->seen);
    if (!g->seen) return err_nomem(err, "cells of the plan", (size_t)g->across * (size_t)g->along * sizeof *g->seen);
    for (int i = 0; i < lines->count; i++) {
        const struct foot_line *l = &lines->lines[i];
        if (used[l->line] || l->heading != heading || lines_side(l) != side) continue;
        const int row = (int)((l->offset - g->low) / (ROW * size)), first = (int)((l->from - g->from) / (CELL * size)),
                  last = (int)((l->to - g->from) / (CELL * size));
        for (int k = first; k <= last && k < g->along; k++) g->seen[row * g->along + k] |= station_bit(l);
    }
    return ST_OK;
}

/* What a view sees: its place, from that of the view. */
struct sight {
    int station;
    struct vec3 eye, place;
};

struct sights {
    struct sight *list; /* owned */
    int count;
};

/* The stations that see through a cell of a row: below the height of windows, and at any height below the ceiling. */
struct through {
    uint64_t low, any;
};

/* Marks the cells of a row that places see through. */
static void mark_through(struct through *through, const struct grid *g, int row, int heading, int side,
                         const struct room_frame *f, const struct sight *sights, int count, double size)
{
    const struct vec3 along = f->headings[heading].along, across = frame_across(f, heading);
    const double offset = g->low + (row + 0.5) * ROW * size, low = f->floor.height,
                 high = f->ceiling.known ? f->ceiling.height : low + USUAL_HEIGHT * size;
    memset(through, 0, (size_t)g->along * sizeof *through);
    for (int i = 0; i < count; i++) {
        const double before = side * (vec3_dot(across, sights[i].eye) - offset),
                     behind = side * (offset - vec3_dot(across, sights[i].place));
        if (!(before > 0 && behind > BEHIND * size)) continue;
        const struct vec3 at =
            vec3_add(sights[i].eye, vec3_scale(vec3_sub(sights[i].place, sights[i].eye), before / (before + behind)));
        const double part = (vec3_dot(f->up, at) - low) / (high - low);
        const int k = (int)floor((vec3_dot(along, at) - g->from) / (CELL * size));
        if (!(part > LOWEST_SIGHT && part < HIGHEST_SIGHT && k >= 0 && k < g->along)) continue;
        through[k].any |= (uint64_t)1 << sights[i].station % 64;
        if (part < WINDOW_SIGHT) through[k].low |= (uint64_t)1 << sights[i].station % 64;
    }
}

/* How many places and levels show cell k of three rows; none if two places see through it. Where nobody sees the head
 * of a wall it may be furniture, and being seen through above counts, too. */
static int shown(const struct grid *g, const struct through *through, int row, int k)
{
    uint64_t all = 0;
    for (int r = row - 1; r <= row + 1; r++)
        if (r >= 0 && r < g->across) all |= g->seen[r * g->along + k];
    if (through && __builtin_popcountll(all & HEADS ? through[k].low : through[k].any) >= 2) return 0;
    return __builtin_popcountll(all);
}

/* The median offset of a wall's lines. values: room for all lines. */
static double median_offset(const struct foot_lines *lines, const bool *used, const struct frame_wall *w, double reach,
                            double *values)
{
    size_t count = 0;
    for (int i = 0; i < lines->count; i++) {
        const struct foot_line *l = &lines->lines[i];
        if (used[l->line] || l->heading != w->heading || lines_side(l) != w->side) continue;
        if (fabs(l->offset - w->offset) <= reach && l->to > w->from && l->from < w->to) values[count++] = l->offset;
    }
    return count ? sort_median(values, count) : w->offset;
}

/* The best part of a row: the one with the most pairs. Returns their number; *w: the wall. */
static int best_part(struct frame_wall *w, const struct grid *g, const struct through *through, int row, double size)
{
    int most = 0;
    for (int k = 0; k < g->along; k++) {
        int last = k, cells = 0, pairs = 0, support = 0;
        if (shown(g, through, row, k) < 2) continue;
        for (int n = k; n < g->along && n - last <= GAP / CELL; n++) {
            const int here = shown(g, through, row, n);
            if (here < 2) continue;
            last = n;
            cells++;
            pairs += here - 1;
            if (here > support) support = here;
        }
        if (cells >= MIN_CELLS && (last + 1 - k) * CELL >= MIN_WALL && pairs > most) {
            most = pairs;
            w->from = g->from + k * CELL * size;
            w->to = g->from + (last + 1) * CELL * size;
            w->offset = g->low + (row + 0.5) * ROW * size;
            w->support = support;
        }
        k = last;
    }
    return most;
}

/* The wall that the most pairs support among the lines that are not used; returns their number. */
static enum status best_wall(struct frame_wall *best, int *most, const struct room_frame *f,
                             const struct foot_lines *lines, const bool *used, const struct sights *seen, double size,
                             struct err *err)
{
    *most = 0;
    for (int heading = 0; !err->status && heading < f->heading_count; heading++)
        for (int side = -1; !err->status && side <= 1; side += 2) {
            struct frame_wall w = {.heading = heading, .side = side};
            struct grid g = {0};
            struct through *through = NULL;
            if (!grid_fill(&g, lines, used, heading, side, size, err) && g.seen &&
                !(through = malloc((size_t)g.along * sizeof *through)))
                err_nomem(err, "cells of the plan", (size_t)g.along * sizeof *through);
            for (int row = 1; !err->status && g.seen && row + 1 < g.across; row++) {
                if (best_part(&w, &g, NULL, row, size) <= *most) continue; /* before what takes time */
                mark_through(through, &g, row, heading, side, f, seen->list, seen->count, size);
                const int pairs = best_part(&w, &g, through, row, size);
                if (pairs <= *most) continue;
                *most = pairs;
                *best = w;
            }
            free(g.seen);
            free(through);
        }
    return err->status;
}

/* Adds a sight from a view to a place. */
static enum status sights_add(struct sights *s, int station, struct vec3 eye, struct vec3 place, struct err *err)
{
    const struct sight one = {station, eye, place};
    if (!array_append(&s->list, (size_t)s->count, sizeof one, "lines of sight", err)) s->list[s->count++] = one;
    return err->status;
}

/* The views' sights of the sparse points. stations: of each view, -1 if it has no line. */
static enum status sights_of_points(struct sights *s, const int *stations, const struct camera_set *set,
                                    struct err *err)
{
    int total = 0;
    for (int i = 0; i < set->model.point_count; i++) total += set->model.points[i].track_count;
    const int stride = total / MOST_SIGHTS + 1;
    for (int i = 0; !err->status && i < set->model.point_count; i += stride) {
        const struct sfm_point *p = &set->model.points[i];
        for (int k = 0; !err->status && k < p->track_count; k++) {
            const int view = p->track[k].image_idx;
            if (view < set->view_count && stations[view] >= 0)
                sights_add(s, stations[view], set->views[view].center, p->position, err);
        }
    }
    return err->status;
}

/* Marks the lines that lie on a wall as used, and adds the sights of those that are on its foot. */
static enum status take_lines(bool *used, struct sights *s, const struct room_frame *f, const struct frame_wall *wall,
                              const struct world_lines *w, const int *headings, const struct camera_set *set,
                              double size, struct err *err)
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
        if (used[i]) sights_add(s, w->lines[i].station, set->views[w->lines[i].view].center, at, err);
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
        if (l->heading != b->heading || lines_side(l) != b->side || fabs(l->offset - b->offset) > 2 * ROW * size ||
            !(l->to > b->from && l->from < b->to))
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
    struct sights seen = {0};
    double *values = malloc(((size_t)lines->count + 1) * sizeof *values);
    f->wall_count = 0;
    free(f->walls);
    f->walls = NULL;
    if (!used || !values || !stations) err_nomem(err, "lines on the plan", (size_t)lines->count * sizeof *values);
    for (int i = 0; !err->status && i < set->view_count; i++) stations[i] = -1;
    for (int i = 0; !err->status && i < w->count; i++) stations[w->lines[i].view] = w->lines[i].station;
    if (!err->status) sights_of_points(&seen, stations, set, err);
    for (int most = MIN_PAIRS; !err->status && most >= MIN_PAIRS;) {
        struct frame_wall wall = {0};
        if (best_wall(&wall, &most, f, lines, used, &seen, size, err) || most < MIN_PAIRS) break;
        wall.offset = median_offset(lines, used, &wall, 1.5 * ROW * size, values);
        if (take_lines(used, &seen, f, &wall, w, headings, set, size, err)) break;
        for (int i = 0; i < lines->count; i++) { /* so that the search ends: also those seen at grazing angles */
            const struct foot_line *l = &lines->lines[i];
            if (l->heading == wall.heading && lines_side(l) == wall.side &&
                fabs(l->offset - wall.offset) <= 2 * ROW * size && l->to > wall.from && l->from < wall.to)
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
