/* draft_things.c - furniture and objects in the draft of an edit; see draft_things.h.
 *
 *  * A thing at a new place is looked at where it was: the ray is moved back, and meets the shape that make things
 * found. Of the photographs that show this place of the thing, by their masks and with nothing of the thing before it,
 * the one counts that looks at it most as the ray does.
 *  * An object has the colour of its material, brighter where it faces the camera and where it faces up. */
#include "stages/build_model/live/draft_things.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/math/numbers.h"
#include "stages/build_model/building/objects.h"

static const double SHADE = 0.5, /* of its colour, that a side of an object has that faces neither */
    SELF = 0.05;                 /* of a thing's radius: a surface so much nearer is another one */

/* ------------------------------------------------------------------------------------------------------- furniture */

enum status draft_things_add(struct draft_things *d, const char *name, struct vec3 middle, double radius, bool is_fixed,
                             struct err *err)
{
    if (array_append(&d->things, (size_t)d->thing_count, sizeof *d->things, "things", err)) return err->status;
    struct draft_thing *t = &d->things[d->thing_count];
    *t = (struct draft_thing){.name = strdup(name), .middle = middle, .radius = radius, .is_fixed = is_fixed};
    if (!t->name) return err_nomem(err, "a thing's name", strlen(name));
    d->thing_count++;
    return ST_OK;
}

float *draft_things_corners(struct draft_things *d, int thing, int triangles, struct err *err)
{
    const int most = 10000000;
    if (thing < 0 || thing >= d->thing_count || triangles < 1 || triangles > most) {
        err_set(err, ST_USAGE, "found %d triangles of thing %d, wanted 1 to %d of one of %d.", triangles, thing, most,
                d->thing_count);
        return NULL;
    }
    struct draft_thing *t = &d->things[thing];
    draft_shape_release(&t->shape);
    free(t->corners);
    t->corners = calloc((size_t)triangles, 9 * sizeof *t->corners);
    t->triangle_count = t->corners ? triangles : 0;
    if (!t->corners) err_nomem(err, "a thing", (size_t)triangles * 9 * sizeof *t->corners);
    return t->corners;
}

unsigned char *draft_things_mask(struct draft_things *d, int photo, int columns, int rows, struct err *err)
{
    if (photo < 0 || columns < 1 || rows < 1 || columns > 10000 || rows > 10000) {
        err_set(err, ST_USAGE, "found a mask of %d x %d cells of photo %d, wanted at most 10000 x 10000.", columns,
                rows, photo);
        return NULL;
    }
    while (d->mask_count <= photo) {
        if (array_append(&d->masks, (size_t)d->mask_count, sizeof *d->masks, "masks", err)) return NULL;
        d->masks[d->mask_count++] = (struct draft_mask){0};
    }
    struct draft_mask *m = &d->masks[photo];
    free(m->things);
    *m = (struct draft_mask){columns, rows, calloc((size_t)columns, (size_t)rows)};
    if (!m->things) err_nomem(err, "a mask", (size_t)columns * (size_t)rows);
    return m->things;
}

const struct draft_thing *draft_things_at(const struct draft_things *d, int photo, const struct photo_camera *c,
                                          double u, double v)
{
    if (photo >= d->mask_count || !d->masks[photo].things) return NULL;
    const struct draft_mask *m = &d->masks[photo];
    const int x = (int)(u / c->lens.width * m->columns), y = (int)(v / c->lens.height * m->rows);
    if (x < 0 || y < 0 || x >= m->columns || y >= m->rows) return NULL;
    const int id = m->things[(size_t)y * (size_t)m->columns + (size_t)x];
    return id && id <= d->thing_count ? &d->things[id - 1] : NULL;
}

/* -------------------------------------------------------------------------------------------------------- the edit */

static bool is_gone(const struct texture_map *map, const struct draft_thing *t)
{
    for (int i = map->thing_count - 1; i >= 0; i--) {
        const struct texture_thing *said = &map->things[i];
        if (!strcmp(said->name, t->name)) return said->kind != TEXTURE_THING_KEEP;
    }
    return !t->is_fixed && texture_map_clears(map, t->middle);
}

static enum status make_shape(struct draft_thing *t, struct err *err)
{
    if (t->shape.count || !t->triangle_count) return ST_OK;
    struct vec3(*triangles)[3] = calloc((size_t)t->triangle_count, sizeof *triangles);
    if (!triangles) return err_nomem(err, "a thing", (size_t)t->triangle_count * sizeof *triangles);
    for (int i = 0; i < 3 * t->triangle_count; i++) {
        const float *c = t->corners + 3 * (size_t)i;
        triangles[i / 3][i % 3] = vec3_make(c[0], c[1], c[2]);
    }
    return draft_shape_make(&t->shape, triangles, t->triangle_count, err);
}

static struct draft_placed *add_placed(struct draft_things *d, struct err *err)
{
    if (array_append(&d->placed, (size_t)d->placed_count, sizeof *d->placed, "things", err)) return NULL;
    struct draft_placed *p = &d->placed[d->placed_count++];
    *p = (struct draft_placed){.thing = -1, .turn = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
    return p;
}

/* Where make remodel puts it too (common/relight/placed_things.c): turned about the middle of its box. */
static enum status place_thing(struct draft_things *d, const struct texture_thing *said, struct err *err)
{
    int at = 0;
    while (at < d->thing_count && strcmp(d->things[at].name, said->from)) at++;
    if (at == d->thing_count) return ST_OK; /* make things did not find it yet */
    const double turn = said->turn * DEGREE, c = cos(turn), s = sin(turn);
    const struct draft_thing *t = &d->things[at];
    if (make_shape(&d->things[at], err)) return err->status;
    struct draft_placed *p = add_placed(d, err);
    if (!p) return err->status;
    struct vec3 to = vec3_add(t->middle, vec3_make(said->by[0], said->by[1], said->by[2]));
    if (said->kind == TEXTURE_THING_PLACE) to = vec3_make(said->by[0], said->by[1], said->by[2] + t->above);
    p->thing = at;
    p->turn = (struct mat3){{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
    p->shift = vec3_sub(to, mat3_apply(p->turn, t->middle));
    return ST_OK;
}

static enum status place_objects(struct draft_things *d, const struct plan *plan, const char *scene, struct err *err)
{
    struct object_list list = {0};
    objects_make(&list, plan, scene, err);
    for (int i = 0; !err->status && i < list.count; i++) {
        struct obj_mesh mesh = {0};
        struct draft_placed *p = add_placed(d, err);
        if (!p || object_mesh_read(&mesh, &list.items[i], scene, err)) break;
        const struct rgb *albedo = &list.items[i].brdf.albedo;
        memcpy(p->albedo, (const double[]){albedo->r, albedo->g, albedo->b}, sizeof p->albedo);
        draft_shape_make(&p->shape, mesh.triangles, mesh.count, err);
        mesh.triangles = NULL; /* of the shape now */
        obj_mesh_release(&mesh);
    }
    object_list_release(&list);
    return err->status;
}

enum status draft_things_begin(struct draft_things *d, const struct texture_map *map, const struct plan *plan,
                               const char *scene, struct err *err)
{
    draft_things_end(d);
    for (int i = 0; i < d->thing_count; i++) d->things[i].is_gone = is_gone(map, &d->things[i]);
    for (int i = 0; !err->status && i < map->thing_count; i++) {
        const struct texture_thing *t = &map->things[i];
        if (t->kind == TEXTURE_THING_MOVE || t->kind == TEXTURE_THING_PLACE) place_thing(d, t, err);
    }
    for (int i = 0; !err->status && i < d->thing_count; i++) make_shape(&d->things[i], err);
    if (!err->status) place_objects(d, plan, scene, err);
    return err->status;
}

struct vec3 draft_things_middle(const struct draft_things *d, int placed)
{
    const struct draft_placed *p = &d->placed[placed];
    const struct vec3 was = p->thing < 0 ? draft_shape_middle(&p->shape) : d->things[p->thing].middle;
    return vec3_add(mat3_apply(p->turn, was), p->shift);
}

/* ------------------------------------------------------------------------------------------------------------- rays */

double draft_things_distance(const struct draft_thing *t, struct vec3 from, struct vec3 ray)
{
    double at = HUGE_VAL;
    return draft_shape_meets(&t->shape, from, ray, &at, NULL) ? at : vec3_length(vec3_sub(t->middle, from)) - t->radius;
}

/* The photo that shows a place of a thing, and looks at it most as along `ray`. */
static struct draft_pixel best_photo(const struct draft_things *d, const struct placer *placer,
                                     const struct draft_thing *t, struct vec3 place, struct vec3 ray)
{
    struct draft_pixel best = {.kind = DRAFT_UNSEEN};
    double most = -1;
    for (int i = 0; i < placer->photo_count; i++) {
        const struct photo_camera *c = &placer->photos[i].camera;
        const struct vec3 to = vec3_sub(place, c->center);
        const double length = vec3_length(to), cosine = vec3_dot(to, ray) / length;
        double u, v, at = length - SELF * t->radius;
        if (!(cosine > most) || !photo_camera_project(c, place, &u, &v) || draft_things_at(d, i, c, u, v) != t ||
            draft_shape_meets(&t->shape, c->center, vec3_scale(to, 1 / length), &at, NULL))
            continue;
        most = cosine;
        best = (struct draft_pixel){DRAFT_PIXEL, i, {u, v}};
    }
    return best;
}

static struct draft_pixel shaded(const struct draft_placed *p, struct vec3 normal, struct vec3 ray)
{
    const double light = SHADE + (1 - SHADE) * (0.5 * fmax(0, normal.z) + 0.5 * fmax(0, -vec3_dot(normal, ray)));
    return (struct draft_pixel){DRAFT_COLOUR, 0, {p->albedo[0] * light, p->albedo[1] * light, p->albedo[2] * light}};
}

bool draft_things_meet(const struct draft_things *d, const struct placer *placer, struct vec3 from, struct vec3 ray,
                       double most, struct draft_pixel *pixel)
{
    double nearest = most;
    bool met = false;
    for (int i = 0; i < d->placed_count; i++) {
        const struct draft_placed *p = &d->placed[i];
        const struct draft_thing *t = p->thing < 0 ? NULL : &d->things[p->thing];
        const struct mat3 back = mat3_transpose(p->turn);
        const struct vec3 was = mat3_apply(back, vec3_sub(from, p->shift)), way = mat3_apply(back, ray);
        struct vec3 normal;
        if (!draft_shape_meets(t ? &t->shape : &p->shape, was, way, &nearest, &normal)) continue;
        *pixel = t ? best_photo(d, placer, t, vec3_add(was, vec3_scale(way, nearest)), way) : shaded(p, normal, way);
        met = true;
    }
    return met;
}

/* --------------------------------------------------------------------------------------------------------- the end */

void draft_things_end(struct draft_things *d)
{
    for (int i = 0; i < d->placed_count; i++) draft_shape_release(&d->placed[i].shape);
    free(d->placed);
    d->placed = NULL;
    d->placed_count = 0;
}

void draft_things_release(struct draft_things *d)
{
    draft_things_end(d);
    for (int i = 0; i < d->thing_count; i++) {
        free(d->things[i].name);
        free(d->things[i].corners);
        draft_shape_release(&d->things[i].shape);
    }
    for (int i = 0; i < d->mask_count; i++) free(d->masks[i].things);
    free(d->things);
    free(d->masks);
    *d = (struct draft_things){0};
}
