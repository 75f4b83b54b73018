/* openings.c - openings of a wall from points and lines of sight.
 *
 * In cells finer than those of faces, columns of a wall that are more seen through than solid form runs; the largest
 * run of such rows in them is an opening, which then grows over unseen cells to where the wall is solid. */
#include "stages/suggest_model/openings.h"

#include <stdlib.h>

#include "common/base/array.h"
#include "stages/suggest_model/wall_joins.h"

struct wall_grid { /* a wall in cells of the window's width */
    int across, up;
    float *solid, *open; /* lines of sight to points on it, and through it, by the points' weights */
};

static void wall_grid_release(struct wall_grid *t)
{
    free(t->solid);
    free(t->open);
}

static enum status wall_grid_make(struct wall_grid *t, const struct opening_finder *f, const struct suggested_wall *w,
                                  struct err *err)
{
    const double c = f->params->window * f->height, min_cosine = cos(f->params->max_angle * DEGREE);
    const double within = w->thickness > 0 ? w->thickness : WALL_THICKNESS * f->height;
    t->across = (int)((w->end - w->begin) / c) + 1;
    t->up = (int)(1 / f->params->window) + 1;
    const size_t cells = (size_t)t->across * (size_t)t->up;
    t->solid = calloc(cells, sizeof *t->solid);
    t->open = calloc(cells, sizeof *t->open);
    if (!t->solid || !t->open) return err_nomem(err, "a wall's cells", 2 * cells * sizeof *t->open);
    for (int side = 0; side < (w->thickness > 0 ? 2 : 1); side++) {
        const struct wall_line l = wall_side_line(w, side);
        const struct wall_line behind = {{l.n[0], l.n[1]}, l.at - within};
        for (size_t i = 0; i < f->sights->rays.count; i++) {
            const struct ray *r = &f->sights->rays.rays[i];
            const struct cloud_point *p = &f->sights->points.cloud.points[r->point];
            const double across = line_across(&l, p->position.x, p->position.y);
            const bool faces = sight_faces(p, &l, min_cosine);
            double s, z, unused[2];
            float *count = t->solid;
            if ((fabs(across) < 2 * c && faces) || (-across > c && -across < within - c && !faces)) { /* or a reveal */
                s = line_along(&l, p->position.x, p->position.y);
                z = p->position.z;
            } else if (sight_crosses(f->sights, r, &l, f->height, &s, &z) &&
                       sight_crosses(f->sights, r, &behind, f->height, &unused[0], &unused[1]))
                count = t->open;
            else
                continue;
            const double x = ((side ? -s : s) - w->begin) / c, y = z / c;
            if (x >= 0 && x < t->across && y >= 0 && y < t->up)
                count[(size_t)x * (size_t)t->up + (size_t)y] += f->sights->points.weight[r->point];
        }
    }
    return ST_OK;
}

/* +1: more open than solid cells; -1: the opposite; 0: too few cells are known. */
static int column_state(const struct wall_grid *t, int first, int last, int low, int high)
{
    int open = 0, solid = 0;
    for (int x = first; x < last; x++)
        for (int y = low; y < high; y++) {
            const int i = x * t->up + y;
            open += t->open[i] > t->solid[i];
            solid += t->solid[i] > 0 && t->solid[i] >= t->open[i];
        }
    if (10 * (open + solid) < (last - first) * (high - low)) return 0;
    return open > solid ? 1 : -1;
}

/* The next run of open columns (or, if `up`, of open rows of the columns first .. last) from *begin on. Short gaps of
 * unknown ones belong to the run. */
static bool next_run(const struct wall_grid *t, bool up, int first, int last, int *begin, int *end)
{
    const int n = up ? t->up : t->across;
    bool in = false;
    for (int i = *begin; i < n; i++) {
        const int state = up ? column_state(t, first, last, i, i + 1)
                             : column_state(t, i, i + 1, (int)(0.1 * t->up), (int)(0.7 * t->up));
        if (state > 0) {
            if (!in) *begin = i;
            in = true;
            *end = i + 1;
        } else if (in && (state < 0 || i - *end > 3)) {
            /* a single solid column inside the run is a leg or a lamp */
            const int after = i + 1 < n ? (up ? column_state(t, first, last, i + 1, i + 2)
                                              : column_state(t, i + 1, i + 2, (int)(0.1 * t->up), (int)(0.7 * t->up)))
                                        : -1;
            if (after <= 0) return true;
        }
    }
    return in;
}

/* Lines of sight locate an opening, points of the wall its border: each side moves outwards over unseen cells (sky,
 * dark corners) to where most cells are solid, and stays where it is if there is no such line. rect: begin, foot, end,
 * top. */
static void grow_opening(const struct wall_grid *t, int rect[4])
{
    for (int side = 0; side < 4; side++) { /* begin, foot, end, top */
        const int step = side < 2 ? -1 : 1, limit = side < 2 ? 0 : (side == 2 ? t->across : t->up * 92 / 100);
        const int other = side % 2 ? 0 : 1;
        for (int at = rect[side]; at != limit; at += step) {
            int solid = 0;
            const int line = step < 0 ? at - 1 : at;
            for (int k = rect[other]; k < rect[other + 2]; k++)
                solid += t->solid[side % 2 ? k * t->up + line : line * t->up + k] > 0;
            if (2 * solid < rect[other + 2] - rect[other]) continue;
            rect[side] = at;
            break;
        }
    }
}

enum status openings_find(struct suggestion *s, const struct opening_finder *f, int wall, struct err *err)
{
    const struct suggested_wall *w = &s->walls[wall];
    const double c = f->params->window * f->height, narrow = f->params->min_opening * f->height;
    struct wall_grid t = {0};
    int begin = 0, end = 0;
    wall_grid_make(&t, f, w, err);
    while (!err->status && next_run(&t, false, 0, 0, &begin, &end)) {
        int low = 0, high = 0, best[2] = {0, 0};
        if ((end - begin) * c >= narrow)
            for (; next_run(&t, true, begin, end, &low, &high); low = high + 1)
                if (high - low > best[1] - best[0]) best[0] = low, best[1] = high;
        if ((best[1] - best[0]) * c >= narrow) {
            int rect[4] = {begin, best[0], end, best[1]};
            grow_opening(&t, rect);
            const bool window = rect[1] * c > 0.15 * f->height;
            if (array_append(&s->openings, (size_t)s->opening_count, sizeof *s->openings, "openings", err)) break;
            s->openings[s->opening_count++] = (struct suggested_opening){.wall = wall,
                                                                         .begin = w->begin + rect[0] * c,
                                                                         .end = w->begin + rect[2] * c,
                                                                         .foot = window ? rect[1] * c : 0,
                                                                         .top = rect[3] * c,
                                                                         .window = window};
            if (rect[2] > end) end = rect[2];
        }
        begin = end + 1;
    }
    wall_grid_release(&t);
    return err->status;
}
