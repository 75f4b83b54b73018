/* cornell_field.h - the Cornell box as a field of light whose radiance is known.
 *
 * The geometry is that of the OBJ files of the box, metres or not. Each triangle has CORNELL_TEXELS^2 texels over the
 * parallelogram of its first and its last edge. Their radiance, computed here once, is that of the lamp after at most
 * CORNELL_BOUNCES reflections, with the noise of a gather by few rays: what counts is that each process computes the
 * same bits, not that they are those of a converged simulation. */
#ifndef REMODEL_BENCH_CORNELL_FIELD_H
#define REMODEL_BENCH_CORNELL_FIELD_H

#include <stdio.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/base/parallel.h"
#include "common/gather/irradiance.h"
#include "common/light/obj_mesh.h"
#include "common/math/numbers.h"

enum { CORNELL_TEXELS = 16, CORNELL_RAYS = 128, CORNELL_BOUNCES = 2 };

struct cornell_face {
    struct vec3 corner, x, y, dual[2], normal; /* q = corner + a x + b y, a = dual[0] . (q - corner) */
    struct rgb reflectance, emission;
    struct rgb texels[CORNELL_TEXELS * CORNELL_TEXELS]; /* what is reflected */
};

/* {0} is the empty state; must not move once it is made. */
struct cornell_field {
    struct ray_scene rays;
    struct cornell_face *faces;
    int count;
    struct emitter lamp;
    struct light_field field;
    struct rgb *next; /* texels of all faces while they are computed */
};

static inline void cornell_release(struct cornell_field *c)
{
    ray_scene_release(&c->rays);
    free(c->faces);
    *c = (struct cornell_field){0};
}

static inline int cornell_texel(const struct cornell_face *f, struct vec3 p)
{
    const struct vec3 q = vec3_sub(p, f->corner);
    const int i = (int)clamp(CORNELL_TEXELS * vec3_dot(f->dual[0], q), 0, CORNELL_TEXELS - 1);
    const int j = (int)clamp(CORNELL_TEXELS * vec3_dot(f->dual[1], q), 0, CORNELL_TEXELS - 1);
    return j * CORNELL_TEXELS + i;
}

static inline void cornell_look(const void *ctx, const struct vec3 from[RAY_PACKET], struct vec3 normal,
                                const struct vec3 direction[RAY_PACKET], unsigned active,
                                struct light_look seen[RAY_PACKET])
{
    const struct cornell_field *c = ctx;
    struct vec3 origin[RAY_PACKET];
    struct ray_hit hits[RAY_PACKET];
    for (int k = 0; k < RAY_PACKET; k++)
        if (active >> k & 1) origin[k] = vec3_add(from[k], vec3_scale(normal, c->rays.epsilon));
    const unsigned hit = ray_scene_hit_packet(&c->rays, origin, direction, active, hits);
    for (int k = 0; k < RAY_PACKET; k++) {
        if (!(active >> k & 1)) continue;
        seen[k] = (struct light_look){{0, 0, 0}, INFINITY, LIGHT_NONE, -1};
        if (!(hit >> k & 1)) continue;
        const struct cornell_face *f = &c->faces[hits[k].id];
        seen[k] = (struct light_look){f->texels[cornell_texel(f, hits[k].point)], hits[k].t, LIGHT_TEXTURE, -1};
        if (hits[k].front) seen[k].radiance = rgb_add(seen[k].radiance, f->emission);
    }
}

static inline enum status cornell_add_triangle(struct cornell_field *c, const struct vec3 corner[3],
                                               struct rgb reflectance, struct rgb emission, struct err *err)
{
    if (array_append(&c->faces, (size_t)c->count, sizeof *c->faces, "faces", err)) return err->status;
    struct cornell_face *f = &c->faces[c->count];
    *f = (struct cornell_face){.corner = corner[0],
                               .x = vec3_sub(corner[1], corner[0]),
                               .y = vec3_sub(corner[2], corner[0]),
                               .reflectance = reflectance,
                               .emission = emission};
    const struct vec3 n = vec3_cross(f->x, f->y);
    f->normal = vec3_normalize(n);
    f->dual[0] = vec3_scale(vec3_cross(f->y, n), 1 / vec3_dot(n, n));
    f->dual[1] = vec3_scale(vec3_cross(n, f->x), 1 / vec3_dot(n, n));
    return ray_scene_add_triangle(&c->rays, corner, (uint32_t)c->count++, err);
}

/* Triangles of FOLDER/cbox_NAME.obj, lowered by `drop`. */
static inline enum status cornell_add(struct cornell_field *c, const char *folder, const char *name, double drop,
                                      struct rgb reflectance, struct rgb emission, struct err *err)
{
    char path[1024];
    struct obj_mesh mesh = {0};
    snprintf(path, sizeof path, "%s/cbox_%s.obj", folder, name);
    enum status st = obj_mesh_read(&mesh, path, err);
    for (int i = 0; !st && i < mesh.count; i++) {
        for (int k = 0; k < 3; k++) mesh.triangles[i][k].y -= drop;
        st = cornell_add_triangle(c, mesh.triangles[i], reflectance, emission, err);
    }
    obj_mesh_release(&mesh);
    return st;
}

/* The lamp's two triangles share a diagonal: half edges of the rectangle. */
static inline void cornell_name_lamp(struct cornell_field *c, const struct cornell_face *f)
{
    const struct vec3 diagonal = f->y, side = f->x;
    c->lamp = (struct emitter){.kind = EMITTER_QUAD,
                               .centre = vec3_add(f->corner, vec3_scale(diagonal, 0.5)),
                               .x = vec3_scale(side, 0.5),
                               .y = vec3_scale(vec3_sub(diagonal, side), 0.5),
                               .normal = f->normal,
                               .luminance = rgb_luminance(f->emission),
                               .beta = PI / 2};
    c->field = (struct light_field){c, cornell_look, &c->lamp, 1};
}

/* Texels begin..end of all faces: irradiance times the reflectance over pi. Those beyond a triangle's long side stay
 * black. */
static inline void cornell_reflect(void *ctx, size_t begin, size_t end, int thread)
{
    struct cornell_field *c = ctx;
    (void)thread;
    for (size_t t = begin; t < end; t++) {
        const struct cornell_face *f = &c->faces[t / (CORNELL_TEXELS * CORNELL_TEXELS)];
        const int texel = (int)(t % (CORNELL_TEXELS * CORNELL_TEXELS));
        const int i = texel % CORNELL_TEXELS, j = texel / CORNELL_TEXELS;
        const double a = (i + 1.0 / 3) / CORNELL_TEXELS, b = (j + 1.0 / 3) / CORNELL_TEXELS;
        const struct vec3 at = vec3_add(f->corner, vec3_add(vec3_scale(f->x, a), vec3_scale(f->y, b)));
        struct irradiance e = {0};
        if (a + b < 1) ray_irradiance(&e, &c->field, (struct gather_point){at, f->normal}, CORNELL_RAYS, t);
        c->next[t] = rgb_scale(rgb_multiply(e.value, f->reflectance), 1 / PI);
    }
}

static inline enum status cornell_bounce(struct cornell_field *c, struct err *err)
{
    const size_t texels = CORNELL_TEXELS * CORNELL_TEXELS, count = (size_t)c->count * texels;
    c->next = malloc(count * sizeof *c->next);
    if (!c->next) return err_nomem(err, "texels", count * sizeof *c->next);
    for (int bounce = 0; bounce < CORNELL_BOUNCES; bounce++) {
        parallel_for(count, 64, cornell_reflect, c);
        for (size_t t = 0; t < count; t++) c->faces[t / texels].texels[t % texels] = c->next[t];
    }
    free(c->next);
    c->next = NULL;
    return ST_OK;
}

/* FOLDER: of the OBJ files. Reflectances and the lamp are those of the box's description in RGB. */
static inline enum status cornell_make(struct cornell_field *c, const char *folder, struct err *err)
{
    static const struct rgb white = {0.885809, 0.698859, 0.666422}, red = {0.570068, 0.0430135, 0.0443706},
                            green = {0.105421, 0.37798, 0.076425}, box = {0.45, 0.30, 0.90}, black = {0, 0, 0},
                            lamp = {0.936461, 0.740433, 0.705267}, shine = {18.387, 10.9873, 2.75357};
    if (cornell_add(c, folder, "luminaire", 0.5, lamp, shine, err) ||
        cornell_add(c, folder, "floor", 0, white, black, err) ||
        cornell_add(c, folder, "ceiling", 0, white, black, err) ||
        cornell_add(c, folder, "back", 0, white, black, err) ||
        cornell_add(c, folder, "greenwall", 0, green, black, err) ||
        cornell_add(c, folder, "redwall", 0, red, black, err) ||
        cornell_add(c, folder, "smallbox", 0, box, black, err) ||
        cornell_add(c, folder, "largebox", 0, box, black, err) || ray_scene_commit(&c->rays, err))
        return err->status;
    cornell_name_lamp(c, &c->faces[0]);
    return cornell_bounce(c, err);
}

/* What the box's camera sees, row by row, at width x height points. */
static inline void cornell_see(struct gather_point *points, int width, int height, const struct cornell_field *c)
{
    static const struct vec3 eye = {278, 273, -800};
    for (int i = 0; i < width * height; i++) {
        const double x = (i % width + 0.5) / width * 2 - 1, y = 1 - (i / width + 0.5) / height * 2;
        struct ray_hit hit = {0};
        ray_scene_hit(&c->rays, eye, vec3_make(0.33 * x, 0.33 * y, 1), &hit);
        points[i] = (struct gather_point){hit.point, hit.normal};
    }
}

#endif
