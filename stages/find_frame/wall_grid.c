/* wall_grid.c - see wall_grid.h. */
#include "stages/find_frame/wall_grid.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"

#define BEHIND        0.06 /* a wall, of the scene's size */
#define USUAL_HEIGHT  0.9  /* of a room whose ceiling is not known yet */
#define LOWEST_SIGHT  0.03 /* of the room's height, where a sight crosses a wall */
#define HIGHEST_SIGHT 0.93
#define WINDOW_SIGHT  0.36 /* of the height, from which on windows begin */
#define MOST_SIGHTS   60000

static uint64_t station_bit(const struct foot_line *l) { return (uint64_t)1 << (2 * l->station + l->head) % 64; }

enum status wall_grid_fill(struct wall_grid *g, const struct foot_lines *lines, const bool *used, int heading, int side,
                           double size, struct err *err)
{
    double low = INFINITY, high = -INFINITY, from = INFINITY, to = -INFINITY;
    *g = (struct wall_grid){0};
    for (int i = 0; i < lines->count; i++) {
        const struct foot_line *l = &lines->lines[i];
        if (used[l->line] || l->heading != heading || foot_line_side(l) != side) continue;
        low = fmin(low, l->offset), high = fmax(high, l->offset);
        from = fmin(from, l->from), to = fmax(to, l->to);
    }
    if (!(high >= low)) return ST_OK;
    g->low = low - 2 * WALL_ROW * size;
    g->from = from;
    g->across = (int)((high - low) / (WALL_ROW * size)) + 5;
    g->along = (int)((to - from) / (WALL_CELL * size)) + 1;
    g->seen = calloc((size_t)g->across * (size_t)g->along, sizeof *g->seen);
    g->through = calloc((size_t)g->along, sizeof *g->through);
    if (!g->seen || !g->through) {
        wall_grid_release(g);
        return err_nomem(err, "cells of the plan", (size_t)g->across * (size_t)g->along * sizeof *g->seen);
    }
    for (int i = 0; i < lines->count; i++) {
        const struct foot_line *l = &lines->lines[i];
        if (used[l->line] || l->heading != heading || foot_line_side(l) != side) continue;
        const int row = (int)((l->offset - g->low) / (WALL_ROW * size)),
                  first = (int)((l->from - g->from) / (WALL_CELL * size)),
                  last = (int)((l->to - g->from) / (WALL_CELL * size));
        for (int k = first; k <= last && k < g->along; k++) g->seen[row * g->along + k] |= station_bit(l);
    }
    return ST_OK;
}

void wall_grid_release(struct wall_grid *g)
{
    if (!g) return;
    free(g->seen);
    free(g->through);
    *g = (struct wall_grid){0};
}

void wall_grid_mark_through(struct wall_grid *g, int row, int heading, int side, const struct room_frame *f,
                            const struct frame_sights *sights, double size)
{
    const struct vec3 along = f->headings[heading].along, across = frame_across(f, heading);
    const double offset = g->low + (row + 0.5) * WALL_ROW * size, low = f->floor.height,
                 high = f->ceiling.known ? f->ceiling.height : low + USUAL_HEIGHT * size;
    memset(g->through, 0, (size_t)g->along * sizeof *g->through);
    for (int i = 0; i < sights->count; i++) {
        const struct frame_sight *s = &sights->list[i];
        const double before = side * (vec3_dot(across, s->eye) - offset),
                     behind = side * (offset - vec3_dot(across, s->place));
        if (!(before > 0 && behind > BEHIND * size)) continue;
        const struct vec3 at = vec3_add(s->eye, vec3_scale(vec3_sub(s->place, s->eye), before / (before + behind)));
        const double part = (vec3_dot(f->up, at) - low) / (high - low);
        const int k = (int)floor((vec3_dot(along, at) - g->from) / (WALL_CELL * size));
        if (!(part > LOWEST_SIGHT && part < HIGHEST_SIGHT && k >= 0 && k < g->along)) continue;
        g->through[k].any |= (uint64_t)1 << s->station % 64;
        if (part < WINDOW_SIGHT) g->through[k].low |= (uint64_t)1 << s->station % 64;
    }
}

/* Where nobody sees the head of a wall it may be furniture, and where nobody sees its foot, a grille in the ceiling or
 * a cupboard that hangs: then being seen through at any height counts. */
uint64_t wall_grid_shown(const struct wall_grid *g, bool marked, int row, int k)
{
    uint64_t all = 0;
    for (int r = row - 1; r <= row + 1; r++)
        if (r >= 0 && r < g->across) all |= g->seen[r * g->along + k];
    const bool both = all & WALL_HEADS && all & ~WALL_HEADS;
    if (marked && __builtin_popcountll(both ? g->through[k].low : g->through[k].any) >= 2) return 0;
    return all;
}

enum status frame_sights_add(struct frame_sights *s, int station, struct vec3 eye, struct vec3 place, struct err *err)
{
    const struct frame_sight one = {station, eye, place};
    if (!array_append(&s->list, (size_t)s->count, sizeof one, "lines of sight", err)) s->list[s->count++] = one;
    return err->status;
}

enum status frame_sights_of_points(struct frame_sights *s, const int *stations, const struct camera_set *set,
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
                frame_sights_add(s, stations[view], set->views[view].center, p->position, err);
        }
    }
    return err->status;
}
