/* flat_outline.c - see flat_outline.h. */
#include "common/model/flat_outline.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/math/polygon.h"

static double coordinate(struct vec3 p, int axis) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; }

/* The axis that the plane is most across. */
static int main_axis(struct vec3 normal)
{
    const double x = fabs(normal.x), y = fabs(normal.y), z = fabs(normal.z);
    return z >= x && z >= y ? 2 : y >= x ? 1 : 0;
}

enum status flat_outline_init(struct flat_outline *o, struct vec3 normal, double offset, int count, struct err *err)
{
    const int across = main_axis(normal);
    *o = (struct flat_outline){.normal = normal, .offset = offset, .axes = {across == 0, across == 2 ? 1 : 2}};
    if (!(o->xy = calloc((size_t)count + 1, sizeof *o->xy)))
        return err_nomem(err, "an outline", (size_t)count * sizeof *o->xy);
    o->count = count;
    return ST_OK;
}

void flat_outline_put(struct flat_outline *o, int i, struct vec3 p)
{
    const struct vec3 on = vec3_sub(p, vec3_scale(o->normal, flat_outline_height(o, p)));
    for (int k = 0; k < 2; k++) o->xy[i][k] = coordinate(on, o->axes[k]);
}

enum status flat_outline_copy(struct flat_outline *to, const struct flat_outline *from, struct err *err)
{
    *to = *from;
    if (!from->count) return ST_OK;
    if (!(to->xy = malloc((size_t)from->count * sizeof *to->xy))) {
        *to = (struct flat_outline){0};
        return err_nomem(err, "an outline", (size_t)from->count * sizeof *from->xy);
    }
    memcpy(to->xy, from->xy, (size_t)from->count * sizeof *to->xy);
    return ST_OK;
}

void flat_outline_release(struct flat_outline *o)
{
    free(o->xy);
    *o = (struct flat_outline){0};
}

struct vec3 flat_outline_corner(const struct flat_outline *o, int i)
{
    double p[3] = {0};
    const int across = 3 - o->axes[0] - o->axes[1];
    for (int k = 0; k < 2; k++) p[o->axes[k]] = o->xy[i][k];
    p[across] = -flat_outline_height(o, vec3_make(p[0], p[1], p[2])) / coordinate(o->normal, across);
    return vec3_make(p[0], p[1], p[2]);
}

double flat_outline_area(const struct flat_outline *o)
{
    double sum = 0;
    for (int i = 0, j = o->count - 1; i < o->count; j = i++)
        sum += o->xy[j][0] * o->xy[i][1] - o->xy[i][0] * o->xy[j][1];
    return o->count ? fabs(sum / 2 / coordinate(o->normal, 3 - o->axes[0] - o->axes[1])) : 0;
}

double flat_outline_height(const struct flat_outline *o, struct vec3 p) { return vec3_dot(o->normal, p) - o->offset; }

bool flat_outline_holds(const struct flat_outline *o, struct vec3 p)
{
    return polygon_holds((const double(*)[2])o->xy, o->count, coordinate(p, o->axes[0]), coordinate(p, o->axes[1]));
}

bool flat_outline_meets(double *t, const struct flat_outline *o, struct vec3 from, struct vec3 way)
{
    const double slope = -vec3_dot(o->normal, way), above = flat_outline_height(o, from);
    if (!(slope > 0 && above > 0)) return false;
    if (t) *t = above / slope;
    return flat_outline_holds(o, vec3_add(from, vec3_scale(way, above / slope)));
}
