/* tour_changes.c - where an edit changed a building; see tour_changes.h.
 *
 * What changed are the parts of faces that the unedited model lacks, rooms that are cleared, and things that go, move
 * or are copied, each with its area. A part belongs to the room that it bounds: the one nearest to a point a little
 * before it. Of a room's parts the mean by area is its place. */
#include "stages/plan_tour/tour_changes.h"

#include <math.h>
#include <stdlib.h>

#include "stages/plan_tour/tour_stops.h"

static const double BEFORE = 0.1; /* of the room's height: how far before a part its room is looked for */
static const double BESIDE = 0.2; /* the same: how far beside the room's outline a part may be, as a window's sill is */
static const double PART_BEFORE = 0.01; /* the same: where one sees a part */

struct sums {
    struct tour_change *list; /* one for each room; places are sums */
    const struct model_plan *plan;
};

/* From a point to a side of a room's outline, in plan. */
static double distance_to_side(const struct model_room_corner *a, const struct model_room_corner *b, struct vec3 p)
{
    const double x = b->x - a->x, y = b->y - a->y, length = x * x + y * y;
    const double t = length > 0 ? fmax(0, fmin(1, ((p.x - a->x) * x + (p.y - a->y) * y) / length)) : 0;
    return hypot(a->x + t * x - p.x, a->y + t * y - p.y);
}

static double distance_to(const struct model_room *room, struct vec3 p)
{
    double least = INFINITY;
    if (tour_room_holds(room, p)) return 0;
    for (int i = 0; i < room->corner_count; i++)
        least = fmin(least, distance_to_side(&room->corners[i], &room->corners[(i + 1) % room->corner_count], p));
    return least;
}

static void add_to(struct sums *s, int room, struct vec3 p, double weight)
{
    s->list[room].place = vec3_add(s->list[room].place, vec3_scale(p, weight));
    s->list[room].weight += weight;
}

/* Keeps the largest parts. */
static void add_part(struct tour_change *c, struct vec3 p, double weight)
{
    int at = c->part_count < TOUR_PARTS ? c->part_count++ : TOUR_PARTS;
    for (; at > 0 && c->part_weights[at - 1] < weight; at--)
        if (at < TOUR_PARTS) {
            c->parts[at] = c->parts[at - 1];
            c->part_weights[at] = c->part_weights[at - 1];
        }
    if (at == TOUR_PARTS) return;
    c->parts[at] = p;
    c->part_weights[at] = weight;
}

/* normal: of a face that changed; 0: something else did. */
static void add(struct sums *s, struct vec3 p, struct vec3 normal, double weight)
{
    double least = INFINITY;
    int nearest = -1;
    double before = 0;
    for (int r = 0; r < s->plan->room_count; r++) {
        const struct model_room *room = &s->plan->rooms[r];
        const double height = model_room_ceiling(room, p.x, p.y) - room->floor;
        const double d = distance_to(room, vec3_add(p, vec3_scale(normal, BEFORE * height)));
        if (d <= BESIDE * height && d < least && p.z < room->floor + (1 + BEFORE) * height &&
            p.z > room->floor - BEFORE * height)
            least = d, nearest = r, before = PART_BEFORE * height;
    }
    if (nearest < 0) return;
    add_to(s, nearest, p, weight);
    if (vec3_length(normal) > 0) add_part(&s->list[nearest], vec3_add(p, vec3_scale(normal, before)), weight);
}

static void add_face(struct sums *s, const struct texture_face *f)
{
    for (int i = 0; i < f->added_count; i++) {
        const struct vec3 *t = f->added[i], middle = vec3_scale(vec3_add(t[0], vec3_add(t[1], t[2])), 1.0 / 3);
        const double area = 0.5 * vec3_length(vec3_cross(vec3_sub(t[1], t[0]), vec3_sub(t[2], t[0])));
        add(s, middle, f->normal, area);
    }
}

/* Rooms whose middle is in a zone that is cleared. */
static void add_zones(struct sums *s, const struct texture_map *map)
{
    for (int r = 0; r < s->plan->room_count; r++) {
        const struct model_room *room = &s->plan->rooms[r];
        struct vec3 middle = {0, 0, 0};
        double area = 0;
        for (int i = 0, j = room->corner_count - 1; i < room->corner_count; j = i++) {
            const struct model_room_corner *a = &room->corners[j], *b = &room->corners[i];
            middle.x += b->x / room->corner_count, middle.y += b->y / room->corner_count;
            area += 0.5 * (a->x * b->y - b->x * a->y);
        }
        middle.z = room->floor + 0.25 * (model_room_ceiling(room, middle.x, middle.y) - room->floor);
        if (texture_map_clears(map, middle)) add_to(s, r, middle, fabs(area));
    }
}

static void add_thing(struct sums *s, const struct texture_thing *edit, const struct thing_list *things)
{
    const int at = things ? thing_list_find(things, edit->from) : -1;
    if (at < 0 || edit->kind == TEXTURE_THING_KEEP) return;
    const struct thing *t = &things->things[at];
    const struct vec3 middle = vec3_scale(vec3_add(t->low, t->high), 0.5), size = vec3_sub(t->high, t->low);
    const double weight = size.x * size.y + size.x * size.z + size.y * size.z;
    const struct vec3 none = {0, 0, 0}, by = {edit->by[0], edit->by[1], edit->by[2]};
    add(s, middle, none, weight);
    if (edit->kind == TEXTURE_THING_MOVE) add(s, vec3_add(middle, by), none, weight);
    if (edit->kind == TEXTURE_THING_PLACE) add(s, vec3_make(by.x, by.y, by.z + 0.5 * size.z), none, weight);
}

static int larger_first(const void *a, const void *b)
{
    const struct tour_change *p = a, *q = b;
    if (p->weight != q->weight) return p->weight > q->weight ? -1 : 1;
    return p->room - q->room;
}

enum status tour_changes_find(struct tour_change **changes, int *count, const struct texture_map *map,
                              const struct thing_list *things, const struct model_plan *plan, struct err *err)
{
    struct sums s = {calloc((size_t)plan->room_count + 1, sizeof *s.list), plan};
    *changes = s.list;
    *count = 0;
    if (!s.list) return err_nomem(err, "rooms", (size_t)plan->room_count * sizeof *s.list);
    for (int r = 0; r < plan->room_count; r++) s.list[r].room = r;
    for (int i = 0; i < map->face_count; i++) add_face(&s, &map->faces[i]);
    if (map->zone_count) add_zones(&s, map);
    for (int i = 0; i < map->thing_count; i++) add_thing(&s, &map->things[i], things);
    for (int r = 0; r < plan->room_count; r++) {
        if (!(s.list[r].weight > 0)) continue;
        s.list[*count] = s.list[r];
        s.list[*count].place = vec3_scale(s.list[r].place, 1 / s.list[r].weight);
        ++*count;
    }
    qsort(s.list, (size_t)*count, sizeof *s.list, larger_first);
    return ST_OK;
}
