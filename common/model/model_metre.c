/* model_metre.c - see model_metre.h.
 *
 * Where no scale is known, something of a typical size has to stand for one. Heights of rooms vary least: homes have
 * 2.3 to 2.6 m, flats of before 1920 up to 3.2. So the median height of the rooms is taken as
 * a typical one, and as 2.2 and 3.2 m at the ends of the interval. */
#include "common/model/model_metre.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/sort.h"

const double model_metre_heights[2] = {2.2, 3.2};

/* Above the middle of the corners. */
static double room_height(const struct model_room *r)
{
    double x = 0, y = 0;
    for (int i = 0; i < r->corner_count; i++) {
        x += r->corners[i].x / r->corner_count;
        y += r->corners[i].y / r->corner_count;
    }
    return model_room_ceiling(r, x, y) - r->floor;
}

enum status model_metre_find(struct model_metre *m, const struct model_axes *axes, const struct model_plan *plan,
                             double typical, struct err *err)
{
    int count = 0;
    *m = (struct model_metre){1, 1, 1, false};
    if (axes->metric) return ST_OK;
    double *heights = malloc(((size_t)plan->room_count + 1) * sizeof *heights);
    if (!heights) return err_nomem(err, "rooms", (size_t)plan->room_count * sizeof *heights);
    for (int i = 0; i < plan->room_count; i++) {
        const double height = room_height(&plan->rooms[i]);
        if (height > 0) heights[count++] = height;
    }
    if (count) {
        sort_doubles(heights, (size_t)count);
        const double middle = 0.5 * (heights[(count - 1) / 2] + heights[count / 2]);
        m->units = middle / typical;
        m->low = fmin(m->units, middle / model_metre_heights[1]);
        m->high = fmax(m->units, middle / model_metre_heights[0]);
        m->guessed = true;
    }
    free(heights);
    return ST_OK;
}
