/* sensors.c - see sensors.h.
 *
 * A room's points are a lattice of the spacing, centred in its outline's box, those kept that lie in the outline and
 * `margin` from its walls, as the method of the IES has it [IES 2012]. A room too small for any has one in its middle.
 * Points of a floor below furniture make up an area of their own: nobody walks there, and their shade says little about
 * the room's light.
 * A place's rectangle is cut into cells no wider than half the spacing, with a point in the middle of each. */
#include "stages/light_levels/sensors.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/math/numbers.h"
#include "stages/light_levels/level_scene.h"

static const double FLOOR = 0.01;                  /* m: height of the points of a floor */
static const double COVER = 2, COVER_ASIDE = 0.05; /* m */
enum { MOST_POINTS = 200000, COVER_RAYS = 5 };

struct spread {
    struct sensors *s;
    const struct model_field *field;
    const struct model_plan *plan;
    const struct levels_params *params;
    const struct model_metre *metre;
};

const char *sensor_kind_word(enum sensor_kind kind)
{
    static const char *const words[SENSOR_KINDS] = {"work-plane", "work-plane-low", "work-plane-high",
                                                    "floor",      "floor-covered",  "place"};
    return words[kind];
}

/* Whether something stands or hangs less than COVER over a point of a floor: most of some rays upwards meet it. Slopes
 * of ceilings do not count. */
static bool is_covered(const struct spread *j, struct vec3 at)
{
    static const double way[COVER_RAYS][2] = {{0, 0}, {1, 0.3}, {-0.3, 1}, {-1, -0.3}, {0.3, -1}};
    const struct model_rays *model = &j->field->model;
    const double aside = COVER_ASIDE * j->metre->units, most = COVER * j->metre->units;
    int met = 0;
    for (int i = 0; i < COVER_RAYS; i++) {
        const struct vec3 from = vec3_make(at.x + aside * way[i][0], at.y + aside * way[i][1], at.z);
        struct ray_hit hit;
        if (!ray_scene_hit(&model->rays, from, vec3_make(0, 0, 1), &hit) || hit.t > most) continue;
        const bool face = (int)hit.id < model->mesh.face_count;
        met += !face || strncmp(solid_face_name(&model->mesh, (int)hit.id), "ceiling/", 8) != 0;
    }
    return 2 * met > COVER_RAYS;
}

static enum status add_point(const struct spread *j, double x, double y, double z, struct err *err)
{
    struct sensors *s = j->s;
    const struct gather_point p = {{x, y, z}, {0, 0, 1}};
    if (level_scene_inside(j->field, p.at)) return ST_OK;
    if (s->count >= MOST_POINTS)
        return err_set(err, ST_DATA, "found more than %d points; raise [light_levels] spacing.", MOST_POINTS);
    if (array_append(&s->points, (size_t)s->count, sizeof *s->points, "points", err)) return err->status;
    s->points[s->count++] = p;
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------------------ rooms */

static double distance_to_side(const struct model_room_corner *a, const struct model_room_corner *b, double x, double y)
{
    const double dx = b->x - a->x, dy = b->y - a->y, length2 = dx * dx + dy * dy;
    const double t = length2 > 0 ? clamp(((x - a->x) * dx + (y - a->y) * dy) / length2, 0, 1) : 0;
    return hypot(x - a->x - t * dx, y - a->y - t * dy);
}

/* Whether a room's outline holds a point, at least `clear` from its sides. */
static bool room_holds(const struct model_room *r, double x, double y, double clear)
{
    bool in = false;
    for (int i = 0, k = r->corner_count - 1; i < r->corner_count; k = i++) {
        const struct model_room_corner *a = &r->corners[i], *b = &r->corners[k];
        if ((a->y > y) != (b->y > y) && x < (b->x - a->x) * (y - a->y) / (b->y - a->y) + a->x) in = !in;
        if (distance_to_side(a, b, x, y) < clear - 1e-9) return false;
    }
    return in;
}

static void room_box(const struct model_room *r, double low[2], double high[2])
{
    low[0] = low[1] = INFINITY;
    high[0] = high[1] = -INFINITY;
    for (int i = 0; i < r->corner_count; i++) {
        const double at[2] = {r->corners[i].x, r->corners[i].y};
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
    }
}

static enum status add_area(const struct spread *j, enum sensor_kind kind, const char *name, int room, double step,
                            struct err *err)
{
    struct sensors *s = j->s;
    if (array_append(&s->areas, (size_t)s->area_count, sizeof *s->areas, "areas", err)) return err->status;
    s->areas[s->area_count++] = (struct sensor_area){kind, name, s->count, 0, room, step};
    return ST_OK;
}

static void end_area(struct sensors *s)
{
    struct sensor_area *a = &s->areas[s->area_count - 1];
    a->count = s->count - a->first;
    if (!a->count) s->area_count--;
}

/* Whether an area of a kind has a point. */
static bool wants(const struct spread *j, enum sensor_kind kind, struct vec3 at)
{
    if (kind == SENSOR_FLOOR) return !is_covered(j, at);
    return kind == SENSOR_FLOOR_COVERED ? is_covered(j, at) : true;
}

static enum status add_room(const struct spread *j, int room, enum sensor_kind kind, double height, struct err *err)
{
    const struct model_room *r = &j->plan->rooms[room];
    const double metre = j->metre->units, step = j->params->spacing * metre, clear = j->params->margin * metre;
    const double z = r->floor + height;
    double low[2], high[2], first[2];
    int counts[2], tried = 0;
    room_box(r, low, high);
    for (int k = 0; k < 2; k++) {
        counts[k] = (int)fmax(0, floor((high[k] - low[k] - 2 * clear) / step + 1e-9)) + 1;
        first[k] = 0.5 * (low[k] + high[k]) - 0.5 * step * (counts[k] - 1);
    }
    if ((double)counts[0] * counts[1] > 4.0 * MOST_POINTS)
        return err_set(err, ST_DATA, "room %s has %d x %d points; raise [light_levels] spacing.", r->name, counts[0],
                       counts[1]);
    if (add_area(j, kind, r->name, room, step, err)) return err->status;
    for (int i = 0; !err->status && i < counts[0] * counts[1]; i++) {
        const struct vec3 at = {first[0] + (i % counts[0]) * step, first[1] + (i / counts[0]) * step, z};
        if (!room_holds(r, at.x, at.y, clear)) continue;
        tried++;
        if (wants(j, kind, at)) add_point(j, at.x, at.y, z, err);
    }
    const struct vec3 middle = {0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), z};
    if (!err->status && !tried && room_holds(r, middle.x, middle.y, 0) && wants(j, kind, middle))
        add_point(j, middle.x, middle.y, z, err);
    if (!err->status) end_area(j->s);
    return err->status;
}

static enum status add_rooms(const struct spread *j, struct err *err)
{
    const struct model_metre *m = j->metre;
    const double height = j->params->work_plane;
    for (int i = 0; !err->status && i < j->plan->room_count; i++) {
        if (add_room(j, i, SENSOR_WORK_PLANE, height * m->units, err)) break;
        if (m->guessed && (add_room(j, i, SENSOR_WORK_PLANE_LOW, height * m->low, err) ||
                           add_room(j, i, SENSOR_WORK_PLANE_HIGH, height * m->high, err)))
            break;
        if (!add_room(j, i, SENSOR_FLOOR, FLOOR * m->units, err))
            add_room(j, i, SENSOR_FLOOR_COVERED, FLOOR * m->units, err);
    }
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------------- places */

static int room_at(const struct model_plan *plan, double x, double y)
{
    for (int i = 0; i < plan->room_count; i++)
        if (room_holds(&plan->rooms[i], x, y, 0)) return i;
    return -1;
}

static enum status add_place(const struct spread *j, const struct place_list *l, const struct light_place_mark *m,
                             struct err *err)
{
    const int room = room_at(j->plan, m->at[0], m->at[1]);
    const double z = (room < 0 ? 0 : j->plan->rooms[room].floor) +
                     (m->height < 0 ? j->params->work_plane * j->metre->units : m->height);
    const double c = cos(m->turn * DEGREE), s = sin(m->turn * DEGREE),
                 widest = 0.5 * j->params->spacing * j->metre->units;
    const int columns = (int)fmax(1, ceil(m->size[0] / widest)), rows = (int)fmax(1, ceil(m->size[1] / widest));
    const int before = j->s->count;
    if (add_area(j, SENSOR_PLACE, m->name, room, fmax(m->size[0] / columns, m->size[1] / rows), err))
        return err->status;
    for (int k = 0; !err->status && k < columns * rows; k++) {
        const double u = m->size[0] * ((k % columns + 0.5) / columns - 0.5);
        const double v = m->size[1] * (((k / columns) + 0.5) / rows - 0.5);
        add_point(j, m->at[0] + c * u - s * v, m->at[1] + s * u + c * v, z, err);
    }
    if (!err->status && j->s->count == before)
        return err_set(
            err, ST_DATA,
            "%s:%d: place %s lies inside a wall or a thing at %g %g, %g m up; move it, or give it another height.",
            l->path, m->line, m->name, m->at[0], m->at[1], z);
    if (!err->status) end_area(j->s);
    return err->status;
}

enum status sensors_make(struct sensors *s, const struct model_field *field, const struct model_plan *plan,
                         const struct place_list *places, const struct levels_params *params,
                         const struct model_metre *metre, struct err *err)
{
    const struct spread j = {s, field, plan, params, metre};
    *s = (struct sensors){0};
    add_rooms(&j, err);
    for (int i = 0; !err->status && i < places->count; i++) add_place(&j, places, &places->items[i], err);
    return err->status;
}

void sensors_release(struct sensors *s)
{
    free(s->points);
    free(s->areas);
    *s = (struct sensors){0};
}
