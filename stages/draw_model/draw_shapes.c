/* draw_shapes.c - the surfaces of furniture for the page, which shows them at new places.
 *
 * Corners are counted in steps of a 65535th of the longest side of the thing's box. Each number is the difference from
 * the one of the same kind before it, folded to 0, -1, 1, -2 ...; the bytes of all numbers stand apart, in planes, as
 * those of points do (draw_points.c). */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

#include "common/light/obj_polygon.h"
#include "common/model/thing_mesh.h"
#include "stages/draw_model/draw_data.h"

enum { STEPS = 65535 };

struct packed {
    unsigned char *planes;
    size_t count, at;
    int32_t last[3];
};

static void pack(struct packed *p, int k, int32_t number)
{
    const int32_t by = number - p->last[k];
    const uint32_t folded = ((uint32_t)by << 1) ^ (uint32_t)(by >> 31);
    for (size_t b = 0; b < 4; b++) p->planes[b * p->count + p->at] = (unsigned char)(folded >> 8 * b);
    p->at++;
    p->last[k] = number;
}

/* A rug or a poster: its outline. */
static enum status flat_mesh(struct thing_mesh *m, const struct flat_outline *o, struct err *err)
{
    struct obj_corner *corners = calloc((size_t)o->count, sizeof *corners);
    int *triangles = NULL;
    bool crosses;
    m->vertices = calloc((size_t)o->count, sizeof *m->vertices);
    if (!corners || !m->vertices) {
        free(corners);
        return err_nomem(err, "an outline", (size_t)o->count * sizeof *corners);
    }
    m->vertex_count = o->count;
    for (int i = 0; i < o->count; i++) corners[i].at = m->vertices[i] = flat_outline_corner(o, i);
    if (!obj_polygon_triangles(&triangles, &m->triangle_count, &crosses, corners, o->count, err)) {
        m->triangles = calloc((size_t)m->triangle_count, sizeof *m->triangles);
        for (int i = 0; m->triangles && i < 3 * m->triangle_count; i++) m->triangles[i / 3][i % 3] = triangles[i];
        if (!m->triangles) err_nomem(err, "an outline", (size_t)m->triangle_count * sizeof *m->triangles);
    }
    free(triangles);
    free(corners);
    return err->status;
}

enum status draw_shape_write(FILE *to, const struct thing *t, uint32_t id, const struct thing_volume *volume,
                             struct err *err)
{
    struct thing_mesh m = {0};
    struct packed p = {0};
    if (t->outline.count)
        flat_mesh(&m, &t->outline, err);
    else
        thing_mesh_make(&m, volume, id, err);
    const struct vec3 size = vec3_sub(t->high, t->low);
    const double step = fmax(size.x, fmax(size.y, size.z)) / STEPS;
    p.count = 3 * ((size_t)m.vertex_count + (size_t)m.triangle_count);
    if (!err->status && !(p.planes = calloc(p.count + 1, 4))) err_nomem(err, "a shape", p.count);
    if (!err->status && m.triangle_count) {
        for (int i = 0; i < m.vertex_count; i++) {
            const struct vec3 v = vec3_scale(vec3_sub(m.vertices[i], t->low), 1 / step);
            pack(&p, 0, (int32_t)lround(v.x));
            pack(&p, 1, (int32_t)lround(v.y));
            pack(&p, 2, (int32_t)lround(v.z));
        }
        for (int k = 0; k < 3; k++) p.last[k] = 0;
        for (int i = 0; i < 3 * m.triangle_count; i++) pack(&p, i % 3, m.triangles[i / 3][i % 3]);
        fprintf(to, "{\"low\": [%.9g, %.9g, %.9g], \"step\": %.9g, \"corners\": %d, \"triangles\": %d, \"parts\": ",
                t->low.x, t->low.y, t->low.z, step, m.vertex_count, m.triangle_count);
        draw_data_write_packed(to, p.planes, 4 * p.count, err);
        putc('}', to);
    } else if (!err->status)
        fputs("null", to);
    free(p.planes);
    thing_mesh_release(&m);
    return err->status;
}
