/* ceiling_parts.c - cuts a room's outline at the ridge of its ceiling; see ceiling_parts.h.
 *
 * The difference of the two planes of a gable is linear in x and y, and 0 on the ridge. Each part is the outline
 * clipped by the sign of the difference [Sutherland 1974]; where an outline that is not convex falls into several
 * pieces, these are joined by edges along the ridge, which have no area. */
#include "stages/export_model/ceiling_parts.h"

#include <math.h>
#include <stdlib.h>

static const double on_ridge = 1e-9; /* model units of height */

/* The second plane of the ceiling less the first. */
static double difference(const struct model_room *room, const double p[2])
{
    const double *a = room->ceiling[0], *b = room->ceiling[room->ceilings - 1];
    const double d = b[0] - a[0] + (b[1] - a[1]) * p[0] + (b[2] - a[2]) * p[1];
    return fabs(d) > on_ridge ? d : 0;
}

static void add_corner(double (*to)[2], int *count, double x, double y)
{
    to[*count][0] = x;
    to[*count][1] = y;
    ++*count;
}

static double area_of(const double (*p)[2], int count)
{
    double twice = 0;
    for (int i = 0; i < count; i++) {
        const double *a = p[i], *b = p[(i + 1) % count];
        twice += a[0] * b[1] - a[1] * b[0];
    }
    return twice / 2;
}

/* The outline with corners on the ridge. */
static void cut_outline(struct ceiling_parts *parts, const struct model_room *room)
{
    for (int i = 0; i < room->corner_count; i++) {
        const struct model_room_corner *c = &room->corners[i], *n = &room->corners[(i + 1) % room->corner_count];
        const double a[2] = {c->x, c->y}, b[2] = {n->x, n->y}, da = difference(room, a), db = difference(room, b);
        add_corner(parts->outline, &parts->outline_count, a[0], a[1]);
        if (da * db >= 0) continue;
        const double t = da / (da - db);
        add_corner(parts->outline, &parts->outline_count, a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]));
    }
}

enum status ceiling_parts_make(struct ceiling_parts *parts, const struct model_room *room, struct err *err)
{
    const size_t most = 2 * (size_t)room->corner_count + 1;
    *parts = (struct ceiling_parts){.outline = malloc(most * sizeof *parts->outline)};
    for (int k = 0; k < 2; k++) parts->corners[k] = malloc(most * sizeof *parts->corners[k]);
    if (!parts->outline || !parts->corners[0] || !parts->corners[1])
        return err_nomem(err, "a room's outline", most * sizeof *parts->outline);
    cut_outline(parts, room);
    for (int k = 0; k < room->ceilings; k++) {
        for (int i = 0; i < parts->outline_count; i++) {
            const double *p = parts->outline[i], d = difference(room, p);
            if (k ? d <= 0 : d >= 0) add_corner(parts->corners[k], &parts->counts[k], p[0], p[1]);
        }
        if (!(area_of(parts->corners[k], parts->counts[k]) > on_ridge)) parts->counts[k] = 0;
    }
    return ST_OK;
}

void ceiling_parts_release(struct ceiling_parts *parts)
{
    free(parts->outline);
    for (int k = 0; k < 2; k++) free(parts->corners[k]);
    *parts = (struct ceiling_parts){0};
}
