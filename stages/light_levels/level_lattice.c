/* level_lattice.c - see level_lattice.h. */
#include "stages/light_levels/level_lattice.h"

#include <math.h>
#include <stdlib.h>

enum status level_lattice_make(struct level_lattice *l, const struct sensors *s, const struct sensor_area *a,
                               struct err *err)
{
    double high[2] = {-INFINITY, -INFINITY};
    *l = (struct level_lattice){INFINITY, INFINITY, a->step, 0, 0, NULL};
    for (int i = a->first; i < a->first + a->count; i++) {
        l->x = fmin(l->x, s->points[i].at.x);
        l->y = fmin(l->y, s->points[i].at.y);
        high[0] = fmax(high[0], s->points[i].at.x);
        high[1] = fmax(high[1], s->points[i].at.y);
    }
    l->width = (int)lround((high[0] - l->x) / a->step) + 1;
    l->height = (int)lround((high[1] - l->y) / a->step) + 1;
    const size_t count = (size_t)l->width * (size_t)l->height;
    l->point = malloc(count * sizeof *l->point);
    if (!l->point) return err_nomem(err, "points of a room", count * sizeof *l->point);
    for (size_t i = 0; i < count; i++) l->point[i] = -1;
    for (int i = a->first; i < a->first + a->count; i++) {
        const int x = (int)lround((s->points[i].at.x - l->x) / a->step);
        const int y = (int)lround((s->points[i].at.y - l->y) / a->step);
        l->point[y * l->width + x] = i;
    }
    return ST_OK;
}

void level_lattice_release(struct level_lattice *l)
{
    free(l->point);
    *l = (struct level_lattice){.width = 0};
}
