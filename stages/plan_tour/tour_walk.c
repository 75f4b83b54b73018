/* tour_walk.c - a walk around what an edit changed; see tour_walk.h.
 *
 * Seen from the changed place, the viewpoints of its room lie in some directions. The walk goes from one side of them
 * to the other, past the farthest viewpoint of each sector, from which most is seen. So the camera moves sideways while
 * it looks at one place: parallax shows the room's depth, and nothing spins. With changes in several rooms, the walk
 * goes on to the next. It is cut, slowed, or walked there and back, to a length that people watch. */
#include "stages/plan_tour/tour_walk.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "stages/plan_tour/tour_stops.h"

enum { SECTORS = 7, ROOMS = 3 };           /* of a walk; rooms that it goes through */
enum { FEWEST = 3 };                       /* stops of a walk: with fewer, viewpoints in other rooms count */
enum { MOST_TIMES = 4 };                   /* that a short way is walked */
static const double LEAST = 20, MOST = 30; /* seconds */
static const double SLOWEST = 0.35;        /* times the speed of walking */
static const double NEAREST = 0.15;        /* of the room's largest side: the eyes would have to turn too fast */
static const double NEARLY = 0.95;         /* of the way to a place on a surface */

struct seen_from {
    int node;
    double azimuth, distance; /* from the changed place */
};

struct walk {
    const struct tour_graph *g;
    const struct model_rays *model;
    const struct model_plan *plan;
    int nodes[ROOMS * SECTORS], count;
    struct vec3 look[ROOMS * SECTORS];
};

static double side_of(const struct model_room *r)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < r->corner_count; i++) {
        const double p[2] = {r->corners[i].x, r->corners[i].y};
        for (int k = 0; k < 2; k++) low[k] = fmin(low[k], p[k]), high[k] = fmax(high[k], p[k]);
    }
    return fmax(high[0] - low[0], high[1] - low[1]);
}

/* Whether nothing is between a viewpoint and the middle of a change, or one of its parts. */
static bool shows(const struct walk *w, const struct tour_change *c, struct vec3 from)
{
    if (!ray_scene_blocked(&w->model->rays, from, vec3_sub(c->place, from), NEARLY)) return true;
    for (int k = 0; k < c->part_count; k++)
        if (!ray_scene_blocked(&w->model->rays, from, vec3_sub(c->parts[k], from), 1)) return true;
    return false;
}

/* Whether a viewpoint sees a change, in its room or, elsewhere, in any. */
static bool sees(struct seen_from *s, const struct walk *w, const struct tour_change *c, int node, bool elsewhere)
{
    const struct model_room *room = &w->plan->rooms[c->room];
    const struct vec3 from = w->g->nodes[node].centre, way = vec3_sub(c->place, from);
    *s = (struct seen_from){node, atan2(-way.y, -way.x), hypot(way.x, way.y)};
    return w->g->nodes[node].usable && (elsewhere || tour_room_holds(room, from)) &&
           s->distance >= NEAREST * side_of(room) && shows(w, c, from);
}

static int by_azimuth(const void *a, const void *b)
{
    const struct seen_from *p = a, *q = b;
    if (p->azimuth != q->azimuth) return p->azimuth < q->azimuth ? -1 : 1;
    return p->node - q->node;
}

/* Turns azimuths so that they begin after the widest gap: there the walk begins and ends. */
static void open_gap(struct seen_from *list, int count)
{
    int first = 0;
    double widest = -1;
    for (int i = 0; i < count; i++) {
        const double gap =
            i ? list[i].azimuth - list[i - 1].azimuth : list[0].azimuth + 2 * M_PI - list[count - 1].azimuth;
        if (gap > widest) widest = gap, first = i;
    }
    const double start = list[first].azimuth;
    for (int i = 0; i < count; i++) list[i].azimuth = fmod(list[i].azimuth - start + 4 * M_PI, 2 * M_PI);
    qsort(list, (size_t)count, sizeof *list, by_azimuth);
}

/* Adds the farthest viewpoint of each sector. */
static enum status walk_around(struct walk *w, const struct tour_change *c, bool elsewhere, struct err *err)
{
    struct seen_from *list = malloc(((size_t)w->g->count + 1) * sizeof *list);
    int count = 0, chosen[SECTORS], most = 0;
    if (!list) return err_nomem(err, "viewpoints", (size_t)w->g->count * sizeof *list);
    for (int i = 0; i < w->g->count; i++) count += sees(&list[count], w, c, i, elsewhere);
    qsort(list, (size_t)count, sizeof *list, by_azimuth);
    if (count) open_gap(list, count);
    const double width = count ? list[count - 1].azimuth / SECTORS : 0;
    for (int i = 0; i < count;) {
        const int sector = width > 0 ? (int)fmin(SECTORS - 1, floor(list[i].azimuth / width)) : 0;
        int best = i;
        for (; i < count && (!(width > 0) || (int)fmin(SECTORS - 1, floor(list[i].azimuth / width)) == sector); i++)
            if (list[i].distance > list[best].distance) best = i;
        chosen[most++] = list[best].node;
    }
    free(list);
    /* begin at the end that is nearer to where the walk is */
    const struct vec3 *last = w->count ? &w->g->nodes[w->nodes[w->count - 1]].centre : NULL;
    const bool back = last && most &&
                      vec3_length(vec3_sub(w->g->nodes[chosen[most - 1]].centre, *last)) <
                          vec3_length(vec3_sub(w->g->nodes[chosen[0]].centre, *last));
    for (int i = 0; most > 1 && i < most; i++) {
        w->look[w->count] = c->place;
        w->nodes[w->count++] = chosen[back ? most - 1 - i : i];
    }
    return ST_OK;
}

/* The stop from which ways lead to the most stops: an edit's new wall may divide them. */
static int best_part(double *costs, int *before, const struct walk *w, struct err *err)
{
    int best = 0, most = -1;
    for (int i = 0; !err->status && i < w->count; i++) {
        int reached = 0;
        if (tour_shortest(costs, before, w->g, w->nodes[i], err)) break;
        for (int k = 0; k < w->count; k++) reached += isfinite(costs[w->nodes[k]]);
        if (reached > most) most = reached, best = i;
    }
    return best;
}

/* Lengths of the ways between the stops, in units of the graph; drops stops that no way leads to. */
static enum status measure(double *lengths, struct walk *w, struct err *err)
{
    const size_t n = (size_t)w->g->count;
    double *costs = malloc((n + 1) * sizeof *costs);
    int *before = malloc((n + 1) * sizeof *before), kept = 0;
    if (!costs || !before) err_nomem(err, "ways", n * sizeof *costs);
    const int first = err->status ? 0 : best_part(costs, before, w, err); /* those before it are of another part */
    for (int i = first; !err->status && i < w->count; i++) {
        double length = 0;
        if (kept) {
            if (tour_shortest(costs, before, w->g, w->nodes[kept - 1], err) || !isfinite(costs[w->nodes[i]])) continue;
            for (int at = w->nodes[i]; before[at] >= 0; at = before[at])
                length += vec3_length(vec3_sub(w->g->nodes[at].centre, w->g->nodes[before[at]].centre));
        }
        lengths[kept] = length / w->g->unit;
        w->nodes[kept] = w->nodes[i];
        w->look[kept++] = w->look[i];
    }
    w->count = kept;
    free(costs);
    free(before);
    return err->status;
}

enum status tour_walk_find(struct tour_stop **stops, int *count, const struct tour_graph *g,
                           const struct model_rays *model, const struct model_plan *plan,
                           const struct tour_change *changes, int change_count, double speed, struct err *err)
{
    struct walk w = {.g = g, .model = model, .plan = plan};
    double lengths[ROOMS * SECTORS], whole = 0;
    *stops = NULL;
    *count = 0;
    for (int elsewhere = 0; !err->status && w.count < FEWEST && elsewhere < 2; elsewhere++) {
        w.count = 0;
        for (int k = 0; !err->status && k < change_count && k < ROOMS; k++)
            walk_around(&w, &changes[k], elsewhere, err);
        if (!err->status) measure(lengths, &w, err);
    }
    if (err->status) return err->status;
    for (int i = 0; i < w.count; i++) whole += lengths[i];
    for (; w.count > 2 && whole / speed > MOST; w.count--) whole -= lengths[w.count - 1];
    if (w.count < 2) return ST_OK;
    /* A short way is walked there and back, rather than more slowly. */
    const double slowest = whole / (SLOWEST * speed);
    const int times = slowest > 0 ? (int)fmax(1, fmin(MOST_TIMES, ceil(LEAST / slowest - 1e-9))) : 1;
    const double pace = fmax(SLOWEST, fmin(1, times * whole / speed / LEAST)) * speed;
    for (int k = 0; k < times; k++)
        for (int i = k > 0; i < w.count; i++) {
            const int at = k % 2 ? w.count - 1 - i : i;
            const struct tour_stop stop = {w.nodes[at], pace, i > 0 && i + 1 < w.count, true, w.look[at]};
            if (array_append(stops, (size_t)*count, sizeof **stops, "stops", err)) return err->status;
            (*stops)[(*count)++] = stop;
        }
    return ST_OK;
}
