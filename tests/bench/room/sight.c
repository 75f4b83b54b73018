/* sight.c - what can be seen in a made room.
 *
 * Everything is a box, turned about the vertical: furniture consists of boxes, and a wall is cut into boxes between,
 * above and below its openings. A ray is inside a box where it is between all three pairs of its planes. */
#include "tests/bench/room/sight.h"

#include "common/capture/camera.h"
#include "common/math/numbers.h"

#define SLAB 0.2 /* of floor and ceiling */

static void add_solid(struct sight *s, struct vec3 middle, struct vec3 half, double degrees, int owner)
{
    const double a = degrees * M_PI / 180;
    if (s->count < SIGHT_SOLIDS) s->solids[s->count++] = (struct sight_solid){middle, half, cos(a), sin(a), owner};
}

/* A part of a wall: from s0 to s1 along it. */
static void add_wall_part(struct sight *s, const struct made_wall *w, int owner, double s0, double s1, double z0,
                          double z1)
{
    struct vec3 middle = made_wall_place(w, (s0 + s1) / 2, 0);
    if (!(s1 > s0 && z1 > z0)) return;
    middle.z = (z0 + z1) / 2;
    add_solid(s, middle, vec3_make((s1 - s0) / 2, w->thickness / 2, (z1 - z0) / 2),
              atan2(w->y1 - w->y0, w->x1 - w->x0) * 180 / M_PI, owner);
}

/* The opening of a wall that begins next after s; NULL: none. */
static const struct made_opening *next_opening(const struct made_room *r, int wall, double s)
{
    const struct made_opening *next = NULL;
    for (int i = 0; i < r->opening_count; i++) {
        const struct made_opening *o = &r->openings[i];
        if (o->wall == wall && o->s0 >= s && (!next || o->s0 < next->s0)) next = o;
    }
    return next;
}

static void add_wall(struct sight *s, const struct made_room *r, int wall)
{
    const struct made_wall *w = &r->walls[wall];
    const int owner = SIGHT_WALL + wall;
    double from = 0;
    for (const struct made_opening *o; (o = next_opening(r, wall, from)) != NULL; from = o->s1) {
        add_wall_part(s, w, owner, from, o->s0, 0, r->ceiling);
        add_wall_part(s, w, owner, o->s0, o->s1, 0, o->z0);
        add_wall_part(s, w, owner, o->s0, o->s1, o->z1, r->ceiling);
    }
    add_wall_part(s, w, owner, from, made_wall_length(w), 0, r->ceiling);
}

void sight_build(struct sight *s, const struct made_room *r)
{
    const struct vec3 middle = vec3_make(r->wide / 2, r->deep / 2, 0), half = vec3_make(r->wide, r->deep, SLAB / 2);
    s->count = 0;
    add_solid(s, vec3_add(middle, vec3_make(0, 0, -SLAB / 2)), half, 0, SIGHT_FLOOR);
    add_solid(s, vec3_add(middle, vec3_make(0, 0, r->ceiling + SLAB / 2)), half, 0, SIGHT_CEILING);
    for (int i = 0; i < r->wall_count; i++) add_wall(s, r, i);
    for (int i = 0; i < r->piece_count; i++)
        for (int k = 0; k < made_box_count(&r->pieces[i]); k++) {
            const struct made_box b = made_box_of(&r->pieces[i], k);
            add_solid(s, b.middle, b.half, b.turn, SIGHT_PIECE + i);
        }
}

/* Distance along the ray to where it enters the box; HUGE_VAL: it does not, or starts inside. */
static double enter(const struct sight_solid *b, struct vec3 from, struct vec3 direction, struct vec3 *normal)
{
    const struct vec3 d = vec3_sub(from, b->middle);
    const double p[3] = {b->c * d.x + b->s * d.y, b->c * d.y - b->s * d.x, d.z};
    const double way[3] = {b->c * direction.x + b->s * direction.y, b->c * direction.y - b->s * direction.x,
                           direction.z};
    const double half[3] = {b->half.x, b->half.y, b->half.z};
    double first = -HUGE_VAL, last = HUGE_VAL;
    int axis = 0;
    for (int k = 0; k < 3; k++) {
        if (fabs(way[k]) < 1e-12) {
            if (fabs(p[k]) > half[k]) return HUGE_VAL;
            continue;
        }
        const double side = way[k] > 0 ? 1 : -1, near = (-side * half[k] - p[k]) / way[k];
        if (near > first) {
            first = near;
            axis = k;
        }
        last = fmin(last, (side * half[k] - p[k]) / way[k]);
    }
    if (first < 0 || first > last) return HUGE_VAL;
    const double side = way[axis] > 0 ? -1 : 1;
    if (axis == 2)
        *normal = vec3_make(0, 0, side);
    else
        *normal = axis ? vec3_make(-side * b->s, side * b->c, 0) : vec3_make(side * b->c, side * b->s, 0);
    return first;
}

struct sight_hit sight_cast(const struct sight *s, struct vec3 from, struct vec3 direction)
{
    struct sight_hit hit = {SIGHT_NOTHING, HUGE_VAL, {0, 0, 0}};
    for (int i = 0; i < s->count; i++) {
        struct vec3 normal = {0, 0, 0};
        const double distance = enter(&s->solids[i], from, direction, &normal);
        if (distance < hit.distance) hit = (struct sight_hit){s->solids[i].owner, distance, normal};
    }
    return hit;
}

bool sight_clear(const struct sight *s, struct vec3 from, struct vec3 to)
{
    const struct vec3 way = vec3_sub(to, from);
    return sight_cast(s, from, vec3_normalize(way)).distance > vec3_length(way) - 0.01;
}

/* ----------------------------------------------------------------------------------------------------------- photos */

static struct camera lens(void)
{
    return camera_equisolid(MADE_WIDTH, MADE_HEIGHT, MADE_FOCAL, MADE_WIDTH / 2.0, MADE_HEIGHT / 2.0);
}

struct made_photo photo_looking(struct vec3 at, struct vec3 look_at)
{
    const struct vec3 forward = vec3_normalize(vec3_sub(look_at, at));
    const struct vec3 right = vec3_normalize(vec3_cross(forward, vec3_make(0, 0, 1)));
    const struct vec3 down = vec3_cross(forward, right);
    const struct mat3 rows = {
        {{right.x, right.y, right.z}, {down.x, down.y, down.z}, {forward.x, forward.y, forward.z}}};
    return (struct made_photo){at, look_at, rows};
}

bool photo_project(const struct made_photo *photo, struct vec3 p, double margin, double *u, double *v)
{
    const struct camera camera = lens();
    const struct vec3 seen = mat3_apply(photo->cam_from_world, vec3_sub(p, photo->at));
    return camera_project(&camera, seen, u, v) && *u > margin && *u<MADE_WIDTH - margin && * v> margin &&
           *v < MADE_HEIGHT - margin;
}

struct vec3 photo_ray(const struct made_photo *photo, double u, double v)
{
    const struct camera camera = lens();
    struct vec3 ray = {0, 0, 1};
    camera_unproject(&camera, u, v, &ray);
    return mat3_apply(mat3_transpose(photo->cam_from_world), ray);
}
