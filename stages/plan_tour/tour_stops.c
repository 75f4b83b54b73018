/* tour_stops.c - the stops of a tour: those of tour.txt, or all rooms.
 *
 * A stop is a viewpoint, that is the place of a photograph, because textures are best there. Usable viewpoints are
 * not inside the model's solids, and not too near to them (tour_graph.h). The stop of a room is the usable viewpoint
 * in it that is nearest to the middle of its corners, in plan.
 *
 * Without a script: begin at the viewpoint that sees farthest, then always go to the room whose stop is nearest by
 * way of the graph (Dijkstra, tour_shortest()) and was not visited. That is the nearest-neighbour rule for the
 * travelling salesman: not the shortest tour, but a natural one, and O(rooms x graph). Rooms without a usable
 * viewpoint or without a way to them are left out with a warning. A flat of one room gets the viewpoint farthest
 * from the start as its second stop.
 *
 * With a script, every stop is checked against the one before as it is read: a pair without a way is an error of its
 * line, because a camera must not go through walls.
 *
 * A point is inside a room if a ray to the right crosses its outline an odd number of times, and if it is between
 * floor and ceiling. */
#include "stages/plan_tour/tour_stops.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/log.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"

bool tour_room_holds(const struct model_room *room, struct vec3 p)
{
    bool inside = false;
    for (int i = 0, j = room->corner_count - 1; i < room->corner_count; j = i++) {
        const struct model_room_corner *a = &room->corners[i], *b = &room->corners[j];
        if ((a->y > p.y) != (b->y > p.y) && p.x < (b->x - a->x) * (p.y - a->y) / (b->y - a->y) + a->x) inside = !inside;
    }
    return inside && p.z > room->floor && p.z < model_room_ceiling(room, p.x, p.y);
}

/* The usable viewpoint in a room that is nearest to the middle of its corners; -1: none. */
static int room_stop(const struct tour_graph *g, const struct model_room *room)
{
    double x = 0, y = 0, least = INFINITY;
    int best = -1;
    for (int i = 0; i < room->corner_count; i++) {
        x += room->corners[i].x / room->corner_count;
        y += room->corners[i].y / room->corner_count;
    }
    for (int i = 0; i < g->count; i++) {
        const struct vec3 p = g->nodes[i].centre;
        if (!g->nodes[i].usable || !tour_room_holds(room, p) || hypot(p.x - x, p.y - y) >= least) continue;
        least = hypot(p.x - x, p.y - y);
        best = i;
    }
    return best;
}

static enum status add_stop(struct tour_stop **stops, int *count, int node, double speed, struct err *err)
{
    if (*count && (*stops)[*count - 1].node == node) return ST_OK;
    if (array_append(stops, (size_t)*count, sizeof **stops, "stops", err)) return err->status;
    (*stops)[(*count)++] = (struct tour_stop){.node = node, .speed = speed};
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------- tour.txt */

static const char *nth_room(const void *ctx, int i)
{
    const struct model_plan *plan = ctx;
    return i < plan->room_count ? plan->rooms[i].name : NULL;
}

static const char *nth_photo(const void *ctx, int i)
{
    const struct tour_graph *g = ctx;
    return i < g->count ? g->nodes[i].photo : NULL;
}

static enum status unknown(const struct textfile *t, const char *name, const char *what, const char *near,
                           struct err *err)
{
    if (near) return textfile_error(t, err, name, "%s; did you mean %s?", what, near);
    return textfile_error(t, err, name, "%s", what);
}

static enum status read_stop(int *node, const char *kind, struct textfile *t, const struct tour_graph *g,
                             const struct model_plan *plan, struct err *err)
{
    char *name;
    if (textfile_word(t, "a name", &name, err) || textfile_end(t, err)) return err->status;
    *node = -1;
    if (!strcmp(kind, "room")) {
        const int room = model_plan_find_room(plan, name);
        if (room < 0) return unknown(t, name, "a room of the model", scan_nearest(name, nth_room, plan), err);
        *node = room_stop(g, &plan->rooms[room]);
        if (*node >= 0) return ST_OK;
        return textfile_error(t, err, name, "a room in which a photograph was taken, away from its walls");
    }
    for (int i = 0; i < g->count; i++)
        if (!strcmp(g->nodes[i].photo, name)) *node = i;
    if (*node < 0) return unknown(t, name, "a photo's id", scan_nearest(name, nth_photo, g), err);
    if (g->nodes[*node].usable) return ST_OK;
    return textfile_error(t, err, name, "a photo that was not taken inside a wall of this model, or too near to one");
}

static enum status check_way(const struct textfile *t, const struct tour_graph *g, int from, int to, struct err *err)
{
    const size_t n = (size_t)g->count;
    double *costs = malloc((n + 1) * sizeof *costs);
    int *before = malloc((n + 1) * sizeof *before);
    if (!costs || !before) err_nomem(err, "ways", n * sizeof *costs);
    if (!err->status) tour_shortest(costs, before, g, from, err);
    if (!err->status && !isfinite(costs[to]))
        textfile_error(t, err, g->nodes[to].photo,
                       "a stop that a way leads to from the stop before, at %s: walls are between them, or the gap "
                       "is narrower than twice [plan_tour] clearance",
                       g->nodes[from].photo);
    free(costs);
    free(before);
    return err->status;
}

static enum status read_speed(double *speed, struct textfile *t, struct err *err)
{
    return textfile_number(t, "a speed", 0.01, 100, speed, err) ? err->status : textfile_end(t, err);
}

static enum status read_statement(struct tour_stop **stops, int *count, double *speed, struct textfile *t,
                                  const struct tour_graph *g, const struct model_plan *plan, struct err *err)
{
    char *kind;
    int node = -1;
    if (textfile_word(t, "room, photo or speed", &kind, err)) return err->status;
    if (!strcmp(kind, "speed")) return read_speed(speed, t, err);
    if (strcmp(kind, "room") && strcmp(kind, "photo"))
        return textfile_error(t, err, kind, "\"room NAME\", \"photo ID\" or \"speed M\"");
    read_stop(&node, kind, t, g, plan, err);
    if (!err->status && *count) check_way(t, g, (*stops)[*count - 1].node, node, err);
    if (!err->status) add_stop(stops, count, node, *speed, err);
    return err->status;
}

static enum status read_script(struct tour_stop **stops, int *count, const struct tour_graph *g,
                               const struct model_plan *plan, double speed, const char *path, struct provenance *prov,
                               struct err *err)
{
    struct textfile t = {0};
    int64_t version;
    if (provenance_open(prov, "tour.txt", &t, path, err)) return err->status;
    if (!textfile_expect_line(&t, "remodel-tour", err) && !textfile_int(&t, "version", 1, 1, &version, err))
        textfile_end(&t, err);
    while (!err->status && textfile_next(&t)) read_statement(stops, count, &speed, &t, g, plan, err);
    if (!err->status && !*count) textfile_error(&t, err, NULL, "\"room NAME\" or \"photo ID\"");
    textfile_release(&t);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- rooms */

/* The viewpoint that sees farthest. */
static int best_start(const struct tour_graph *g)
{
    int best = -1;
    for (int i = 0; i < g->count; i++)
        if (g->nodes[i].usable && (best < 0 || g->nodes[i].open > g->nodes[best].open)) best = i;
    return best;
}

/* The stop of the room that is nearest to the last one, of those not visited; -1: none can be reached. */
static int next_room(const struct tour_graph *g, const struct model_plan *plan, const bool *visited,
                     const double *costs)
{
    int best = -1;
    for (int r = 0; r < plan->room_count; r++) {
        const int stop = visited[r] ? -1 : room_stop(g, &plan->rooms[r]);
        if (stop < 0 || !isfinite(costs[stop])) continue;
        if (best < 0 || costs[stop] < costs[room_stop(g, &plan->rooms[best])]) best = r;
    }
    return best;
}

static int farthest(const struct tour_graph *g, const double *costs)
{
    int best = -1;
    for (int i = 0; i < g->count; i++)
        if (isfinite(costs[i]) && (best < 0 || costs[i] > costs[best])) best = i;
    return best;
}

static enum status visit_rooms(struct tour_stop **stops, int *count, const struct tour_graph *g,
                               const struct model_plan *plan, double speed, struct err *err)
{
    const size_t n = (size_t)g->count;
    bool *visited = calloc((size_t)plan->room_count + 1, sizeof *visited);
    double *costs = malloc((n + 1) * sizeof *costs);
    int *before = malloc((n + 1) * sizeof *before);
    if (!visited || !costs || !before) err_nomem(err, "rooms", n * sizeof *costs);
    if (!err->status) add_stop(stops, count, best_start(g), speed, err);
    for (int r = 0; !err->status && r < plan->room_count; r++)
        visited[r] = tour_room_holds(&plan->rooms[r], g->nodes[(*stops)[0].node].centre);
    for (int room = 0; !err->status && room >= 0;) {
        tour_shortest(costs, before, g, (*stops)[*count - 1].node, err);
        room = err->status ? -1 : next_room(g, plan, visited, costs);
        if (room < 0) break;
        visited[room] = true;
        add_stop(stops, count, room_stop(g, &plan->rooms[room]), speed, err);
    }
    for (int r = 0; !err->status && r < plan->room_count; r++)
        if (!visited[r])
            log_warn("room %s is left out of the tour: %s", plan->rooms[r].name,
                     room_stop(g, &plan->rooms[r]) < 0 ? "no photograph was taken in it, away from its walls"
                                                       : "no way between viewpoints leads there");
    /* a flat of one room */
    if (!err->status && *count == 1) add_stop(stops, count, farthest(g, costs), speed, err);
    free(visited);
    free(costs);
    free(before);
    return err->status;
}

enum status tour_stops_find(struct tour_stop **stops, int *count, const struct tour_graph *g,
                            const struct model_plan *plan, double speed, const char *script, struct provenance *prov,
                            struct err *err)
{
    *stops = NULL;
    *count = 0;
    return script ? read_script(stops, count, g, plan, speed, script, prov, err)
                  : visit_rooms(stops, count, g, plan, speed, err);
}
