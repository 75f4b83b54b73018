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
 * doors.
 *
 * Lastly, walls that may be edges on others are dropped (explained_walls.c), gaps between the ends of walls are closed
 * where a few lines show that there is a wall (closing_walls.c), and what is open in walls is cut out
 * (open_walls.c). */
#include "stages/find_frame/frame_walls.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/base/sort.h"
#include "stages/find_frame/closing_walls.h"
#include "stages/find_frame/explained_walls.h"
#include "stages/find_frame/open_walls.h"
#include "stages/find_frame/wall_ends.h"
#include "stages/find_frame/wall_grid.h"

/* as parts of the scene's size */
#define GAP       0.35 /* in a wall */
#define SLACK     0.02 /* beyond its ends, floor and ceiling, where lines are still on it */
#define MIN_CELLS 3    /* that two places show */
#define MIN_PAIRS 5    /* of places that show a cell, in all its cells */
#define MIN_BOTH  3    /* cells that three places and levels show, foot and head among them, of a sure wall */

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

/* A wall that was found, and what speaks for it. */
struct candidate {
    struct frame_wall wall;
    int pairs; /* of places and levels, in all its cells */
    int both;  /* cells that three places and levels show, foot and head among them */
};

/* The best part of a row: the one with the most pairs. c has the wall's heading and side; no pairs: there is none. */
static void best_part(struct candidate *c, const struct wall_grid *g, bool marked, int row, double size)
{
    struct frame_wall *w = &c->wall;
    c->pairs = 0;
    for (int k = 0; k < g->along; k++) {
        int last = k, cells = 0, pairs = 0, both = 0, support = 0;
        if (__builtin_popcountll(wall_grid_shown(g, marked, row, k)) < 2) continue;
        for (int n = k; n < g->along && n - last <= GAP / WALL_CELL; n++) {
            const uint64_t bits = wall_grid_shown(g, marked, row, n);
            const int here = __builtin_popcountll(bits);
            if (here < 2) continue;
            last = n;
            cells++;
            pairs += here - 1;
            both += here > 2 && bits & WALL_HEADS && bits & ~WALL_HEADS;
            if (here > support) support = here;
        }
        if (cells >= MIN_CELLS && (last + 1 - k) * WALL_CELL >= WALL_SHORTEST && pairs > c->pairs) {
            c->pairs = pairs;
            c->both = both;
            w->from = g->from + k * WALL_CELL * size;
            w->to = g->from + (last + 1) * WALL_CELL * size;
            w->offset = g->low + (row + 0.5) * WALL_ROW * size;
            w->support = support;
        }
        k = last;
    }
}

/* The wall that the most pairs support among the lines that are not used. */
static enum status best_wall(struct candidate *best, const struct room_frame *f, const struct foot_lines *lines,
                             const bool *used, const struct frame_sights *seen, double size, struct err *err)
{
    *best = (struct candidate){0};
    for (int heading = 0; !err->status && heading < f->heading_count; heading++)
        for (int side = -1; !err->status && side <= 1; side += 2) {
            struct candidate c = {.wall = {.heading = heading, .side = side}};
            struct wall_grid g = {0};
            wall_grid_fill(&g, lines, used, heading, side, size, err);
            for (int row = 1; !err->status && g.seen && row + 1 < g.across; row++) {
                best_part(&c, &g, false, row, size);
                if (c.pairs <= best->pairs) continue; /* before what takes time */
                wall_grid_mark_through(&g, row, heading, side, f, seen, size);
                best_part(&c, &g, true, row, size);
                if (c.pairs > best->pairs) *best = c;
            }
            wall_grid_release(&g);
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

enum status walls_find(struct room_frame *f, const struct foot_lines *lines, const struct world_lines *w,
                       const int *headings, const struct camera_set *set, double size, struct err *err)
{
    bool *used = calloc((size_t)w->count + 1, sizeof *used);
    int *stations = malloc(((size_t)set->view_count + 1) * sizeof *stations);
    struct frame_sights seen = {0};
    double *values = malloc(((size_t)lines->count + 1) * sizeof *values);
    bool *sure = NULL; /* of the walls */
    f->wall_count = 0;
    free(f->walls);
    f->walls = NULL;
    if (!used || !values || !stations) err_nomem(err, "lines on the plan", (size_t)lines->count * sizeof *values);
    for (int i = 0; !err->status && i < set->view_count; i++) stations[i] = -1;
    for (int i = 0; !err->status && i < w->count; i++) stations[w->lines[i].view] = w->lines[i].station;
    if (!err->status) frame_sights_of_points(&seen, stations, set, err);
    const int points = seen.count;
    while (!err->status) {
        struct candidate best;
        if (best_wall(&best, f, lines, used, &seen, size, err) || best.pairs < MIN_PAIRS) break;
        struct frame_wall wall = best.wall;
        wall.offset = median_offset(lines, used, &wall, 1.5 * WALL_ROW * size, values);
        if (take_lines(used, &seen, f, &wall, w, headings, set, size, err)) break;
        for (int i = 0; i < lines->count; i++) { /* so that the search ends: also those seen at grazing angles */
            const struct foot_line *l = &lines->lines[i];
            if (l->heading == wall.heading && foot_line_side(l) == wall.side &&
                fabs(l->offset - wall.offset) <= 2 * WALL_ROW * size && l->to > wall.from && l->from < wall.to)
                used[l->line] = true;
        }
        if (!array_append(&sure, (size_t)f->wall_count, sizeof *sure, "walls", err) &&
            !array_append(&f->walls, (size_t)f->wall_count, sizeof wall, "walls", err)) {
            sure[f->wall_count] = best.both >= MIN_BOTH;
            f->walls[f->wall_count++] = wall;
        }
    }
    if (!err->status) explained_walls_drop(f, sure, lines, size, err);
    if (!err->status && f->ceiling.known) closing_walls_add(f, lines, used, &seen, size, err);
    for (int k = 0; !err->status && k < f->wall_count; k++)
        for (int end = -1; end <= 1; end += 2) {
            struct frame_wall met = f->walls[k];
            wall_end_meet(&met, end, f, size);
            if (met.to - met.from > WALL_SHORTEST / 2 * size) f->walls[k] = met;
        }
    if (!err->status) open_walls_cut(f, &seen, points, size, err);
    free(used);
    free(sure);
    free(values);
    free(stations);
    free(seen.list);
    return err->status;
}
