/* open_walls.c - see open_walls.h.
 *
 * A seam of the floor across a corridor looks like the foot of a wall to those who stand before it. A camera behind it
 * that sees sparse points in front of it tells the two apart. Sights from the front do not: they may go out by a
 * window, and nobody looks in by one. What is open is the stretch that the sights cross, but for a tenth of them at
 * either end; the longer part beside it stays, if it is long enough. Walls that many places show keep their doors. */
#include "stages/find_frame/open_walls.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/sort.h"

#define MOST_SUPPORT 3    /* places and levels that show a wall */
#define MIN_POINTS   6    /* seen through it */
#define BEHIND       0.06 /* of the scene's size: eye and point are this far from the wall */
#define LEAST_LEFT   0.28 /* likewise: length of what stays */
#define USUAL_HEIGHT 0.9  /* likewise: of a room whose ceiling is not known */
#define LOWEST       0.03 /* of the room's height, where a sight crosses the wall */
#define HIGHEST      0.93
#define STRAY        10 /* one sight in so many may be wrong, on each side */

/* Whether a camera behind the wall sees a point in front of it; *place: where it looks through, along the wall. */
static bool looks_through(double *place, const struct frame_sight *s, const struct frame_wall *w,
                          const struct room_frame *f, double size)
{
    const struct vec3 along = f->headings[w->heading].along, across = frame_across(f, w->heading);
    const double eye = w->side * (vec3_dot(across, s->eye) - w->offset),
                 point = w->side * (vec3_dot(across, s->place) - w->offset);
    if (!(eye < -BEHIND * size && point > BEHIND * size)) return false;
    const struct vec3 at = vec3_add(s->eye, vec3_scale(vec3_sub(s->place, s->eye), eye / (eye - point)));
    const double height = f->ceiling.known ? f->ceiling.height - f->floor.height : USUAL_HEIGHT * size,
                 part = (vec3_dot(f->up, at) - f->floor.height) / height;
    *place = vec3_dot(along, at);
    return part > LOWEST && part<HIGHEST && * place> w->from && *place < w->to;
}

/* Cuts a wall. False: too little of it is left. places: room for all sights. */
static bool cut_wall(struct frame_wall *w, const struct room_frame *f, const struct frame_sights *sights, int points,
                     double size, double *places)
{
    size_t count = 0;
    for (int i = 0; i < points; i++) {
        const struct frame_sight *s = &sights->list[i];
        const bool again = i > 0 && vec3_length(vec3_sub(s->place, s[-1].place)) == 0 && s->station == s[-1].station;
        if (!again && looks_through(&places[count], s, w, f, size)) count++;
    }
    if (count < MIN_POINTS) return true;
    sort_doubles(places, count);
    const double low = places[count / STRAY], high = places[count - 1 - count / STRAY];
    if (low - w->from > w->to - high)
        w->to = low;
    else
        w->from = high;
    return w->to - w->from >= LEAST_LEFT * size;
}

enum status open_walls_cut(struct room_frame *f, const struct frame_sights *sights, int points, double size,
                           struct err *err)
{
    double *places = malloc(((size_t)points + 1) * sizeof *places);
    int kept = 0;
    if (!places) return err_nomem(err, "lines of sight", (size_t)points * sizeof *places);
    for (int k = 0; k < f->wall_count; k++) {
        struct frame_wall w = f->walls[k];
        if (w.support > MOST_SUPPORT || cut_wall(&w, f, sights, points, size, places)) f->walls[kept++] = w;
    }
    f->wall_count = kept;
    free(places);
    return ST_OK;
}
