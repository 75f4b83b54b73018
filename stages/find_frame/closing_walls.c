/* closing_walls.c - see closing_walls.h.
 *
 * The outline of a room is closed. Where two walls end and no other wall meets them there, a wall runs from the one end
 * to the other if lines on it say so: two places or levels that show 40 % of it, though they need not show the same
 * part. Without the two ends, that would be too little. */
#include "stages/find_frame/closing_walls.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/math/numbers.h"
#include "stages/find_frame/wall_ends.h"

#define MIN_SHOWN 0.4 /* of the wall's length */

struct loose_end {
    int wall, end;
};

struct search {
    const struct room_frame *f;
    const struct foot_lines *lines;
    const bool *used;
    const struct frame_sights *seen;
    double size;
    struct loose_end *ends; /* owned */
    int end_count;
};

/* Where a wall would end at a loose end, if it can do so with its end `end`. */
static bool ends_at(double *place, const struct search *s, const struct frame_wall *w, int end,
                    const struct loose_end *loose)
{
    const struct frame_wall *o = &s->f->walls[loose->wall];
    double there;
    return walls_cross(place, &there, s->f, w, o) && wall_end_reaches(o, loose->end, there, s->size) &&
           walls_make_corner(s->f, w, end, o, loose->end);
}

/* How many places and levels show the cells of a wall in a row, in all; 0: too little of it is shown. */
static int shown_in(const struct wall_grid *g, int row, struct frame_wall *w, double size)
{
    const double cell = WALL_CELL * size;
    const int first = clamp_int((int)floor((w->from - g->from) / cell), 0, g->along),
              end = clamp_int((int)ceil((w->to - g->from) / cell), 0, g->along);
    uint64_t all = 0;
    int cells = 0, sum = 0;
    for (int k = first; k < end; k++) {
        const uint64_t bits = wall_grid_shown(g, true, row, k);
        all |= bits;
        cells += bits != 0;
        sum += __builtin_popcountll(bits);
    }
    w->support = __builtin_popcountll(all);
    return w->support >= 2 && cells * cell > MIN_SHOWN * (w->to - w->from) ? sum : 0;
}

/* The best wall in a row from loose end to loose end, if it is better than *best. */
static void best_in_row(struct frame_wall *best, int *most, const struct search *s, struct wall_grid *g, int row,
                        struct frame_wall w)
{
    bool marked = false;
    w.offset = g->low + (row + 0.5) * WALL_ROW * s->size;
    for (int i = 0; i < s->end_count; i++)
        for (int k = 0; k < s->end_count; k++) {
            if (!ends_at(&w.from, s, &w, -1, &s->ends[i]) || !ends_at(&w.to, s, &w, 1, &s->ends[k]) ||
                !(w.to - w.from > WALL_SHORTEST * s->size))
                continue;
            if (!marked) wall_grid_mark_through(g, row, w.heading, w.side, s->f, s->seen, s->size);
            marked = true;
            const int sum = shown_in(g, row, &w, s->size);
            if (sum <= *most) continue;
            *most = sum;
            *best = w;
        }
}

/* The wall from loose end to loose end that the most places and levels show; *most: how many, 0: there is none. */
static enum status best_closing(struct frame_wall *best, int *most, const struct search *s, struct err *err)
{
    *most = 0;
    for (int heading = 0; !err->status && heading < s->f->heading_count; heading++)
        for (int side = -1; !err->status && side <= 1; side += 2) {
            const struct frame_wall w = {.heading = heading, .side = side};
            struct wall_grid g = {0};
            wall_grid_fill(&g, s->lines, s->used, heading, side, s->size, err);
            for (int row = 1; !err->status && g.seen && row + 1 < g.across; row++)
                best_in_row(best, most, s, &g, row, w);
            wall_grid_release(&g);
        }
    return err->status;
}

/* Removes the ends at which a wall begins or ends. */
static void remove_ends(struct search *s, const struct frame_wall *w)
{
    int kept = 0;
    for (int k = 0; k < s->end_count; k++) {
        double place;
        const struct loose_end *e = &s->ends[k];
        if (!(ends_at(&place, s, w, -1, e) && fabs(place - w->from) < WALL_ROW * s->size) &&
            !(ends_at(&place, s, w, 1, e) && fabs(place - w->to) < WALL_ROW * s->size))
            s->ends[kept++] = *e;
    }
    s->end_count = kept;
}

enum status closing_walls_add(struct room_frame *f, const struct foot_lines *lines, const bool *used,
                              const struct frame_sights *seen, double size, struct err *err)
{
    struct search s = {f, lines, used, seen, size, NULL, 0};
    for (int k = 0; !err->status && k < f->wall_count; k++)
        for (int end = -1; !err->status && end <= 1; end += 2)
            if (wall_end_is_loose(f, k, end, size) &&
                !array_append(&s.ends, (size_t)s.end_count, sizeof *s.ends, "ends of walls", err))
                s.ends[s.end_count++] = (struct loose_end){k, end};
    while (!err->status) {
        struct frame_wall w;
        int most;
        if (best_closing(&w, &most, &s, err) || !most) break;
        if (array_append(&f->walls, (size_t)f->wall_count, sizeof w, "walls", err)) break;
        f->walls[f->wall_count++] = w;
        remove_ends(&s, &w);
    }
    free(s.ends);
    return err->status;
}
