/* rim_light.c - see rim_light.h.
 *
 * Overview. Where an edit walls up a window, the bake filled the new place from the wall around it, hence in the light
 * of there, and smoothly. The light before the edit, by which the texture is divided, must be as smooth: that of the
 * nearest point of the rim jumps where two sides are equally near, and a walled-up window showed four triangles. So
 * light is gathered at nodes along the rim, and interpolated from all of them.
 *
 * Mathematics. The nodes divide each edge of the old areas into segments, between which light is linear. A segment a b
 * that is seen from p under the angle t adds tan(t / 2) / |a - p| to the weight of a, and the same for b: mean value
 * coordinates [Floater 2003], which give back what is linear around a hole, and the rim's own light at the rim. Only
 * segments that turn the old area's outer side to p count, so that the far edges of a wall do not. Whether something
 * lies between is not asked.
 *
 * Source: [Floater 2003]. Different here: the sides need not be closed around p. */
#include "stages/relight/rim_light.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/base/parallel.h"
#include "common/math/numbers.h"

static const double SPACING = 4;  /* of the inset: between nodes */
static const double OUTSIDE = 10; /* of the tolerance of areas */
enum { MAX_SEGMENTS = 64 };       /* of an edge */

struct rim_node {
    struct vec3 at;            /* on the edge */
    struct gather_point light; /* where its light is gathered: a little inside */
    struct irradiance e;
    bool is_rim; /* no old area lies on the other side of the segment that begins here */
};

struct rim_edge {
    int face;
    struct vec3 in;  /* unit, into the old area */
    int first, last; /* nodes */
};

struct rim {
    const struct light_change *c;
    struct rim_edge *edges;
    int edge_count, *first; /* the edges of id are first[id] .. first[id + 1] - 1 */
    struct rim_node *nodes;
    int node_count;
    const struct relight_params *params;
};

static void release(struct rim *r)
{
    free(r->edges);
    free(r->first);
    free(r->nodes);
    *r = (struct rim){0};
}

/* ----------------------------------------------------------------------------------------------------------- nodes */

static struct gather_point inside_of(const struct rim *r, int id, struct vec3 at, struct vec3 in, struct vec3 normal)
{
    struct vec3 nearest, inside = vec3_add(at, vec3_scale(in, r->c->inset));
    int face;
    bool on;
    if (!face_areas_nearest(&r->c->old, id, inside, &nearest, &face, &on) || !on) inside = at;
    return (struct gather_point){inside, normal};
}

/* Whether an old area lies a little outside of a place on an edge: another part of the same surface. */
static bool is_inner(const struct rim *r, int id, struct vec3 at, struct vec3 in)
{
    struct vec3 nearest;
    int face;
    bool on;
    const struct vec3 outside = vec3_sub(at, vec3_scale(in, OUTSIDE * r->c->old.tolerance));
    return face_areas_nearest(&r->c->old, id, outside, &nearest, &face, &on) && on;
}

static enum status add_edge(struct rim *r, int id, int face, struct vec3 a, struct vec3 b, struct err *err)
{
    const struct vec3 along = vec3_sub(b, a), normal = r->c->old.mesh->faces[face].normal;
    const double length = vec3_length(along), margin = fmin(r->c->inset, 0.25 * length);
    if (!(length > 0)) return ST_OK;
    const int segments = (int)clamp(ceil(length / (SPACING * r->c->inset)), 1, MAX_SEGMENTS);
    const struct vec3 in = vec3_normalize(vec3_cross(normal, along));
    if (array_append(&r->edges, (size_t)r->edge_count, sizeof *r->edges, "rims", err)) return err->status;
    r->edges[r->edge_count++] = (struct rim_edge){face, in, r->node_count, r->node_count + segments};
    for (int k = 0; k <= segments; k++) {
        const double t = (double)k / segments, clear = clamp(t, margin / length, 1 - margin / length);
        if (array_append(&r->nodes, (size_t)r->node_count, sizeof *r->nodes, "rims", err)) return err->status;
        struct rim_node *node = &r->nodes[r->node_count++];
        *node = (struct rim_node){.at = vec3_add(a, vec3_scale(along, t))};
        node->light = inside_of(r, id, vec3_add(a, vec3_scale(along, clear)), in, normal);
        node->is_rim = k < segments && !is_inner(r, id, vec3_add(a, vec3_scale(along, (k + 0.5) / segments)), in);
    }
    return ST_OK;
}

static enum status add_face(struct rim *r, int id, int face, struct err *err)
{
    const struct solid_mesh *m = r->c->old.mesh;
    for (int l = m->faces[face].loop; l < m->faces[face].loop + m->faces[face].loops; l++) {
        const int first = m->loops[l].half_edge;
        int h = first;
        do {
            const int next = m->half_edges[h].next;
            if (add_edge(r, id, face, m->vertices[m->half_edges[h].origin].p, m->vertices[m->half_edges[next].origin].p,
                         err))
                return err->status;
            h = next;
        } while (h != first);
    }
    return ST_OK;
}

static void gather_some(void *ctx, size_t begin, size_t end, int thread)
{
    const struct rim *r = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++)
        ray_irradiance_to(&r->nodes[i].e, &r->c->before.plain, r->nodes[i].light, r->params->target_error,
                          r->params->rays, i);
}

/* wanted: of each id, whether its rims are needed. */
static enum status make(struct rim *r, const bool *wanted, struct err *err)
{
    const struct face_areas *old = &r->c->old;
    r->first = calloc((size_t)old->ids + 2, sizeof *r->first);
    if (!r->first) return err_nomem(err, "rims", (size_t)old->ids * sizeof *r->first);
    for (int id = 0; id < old->ids; id++) {
        r->first[id] = r->edge_count;
        for (int k = old->first[id]; wanted[id] && k < old->first[id + 1]; k++)
            if (add_face(r, id, old->faces[k], err)) return err->status;
        r->first[id + 1] = r->edge_count;
    }
    parallel_for((size_t)r->node_count, 1, gather_some, r);
    return ST_OK;
}

/* --------------------------------------------------------------------------------------------------- interpolation */

struct mean {
    struct rgb light;
    double error, weight;
};

static void add_node(struct mean *m, const struct rim_node *node, double weight)
{
    m->light = rgb_add(m->light, rgb_scale(node->e.value, weight));
    m->error += weight * rgb_luminance(node->e.error);
    m->weight += weight;
}

/* False: p lies on the segment, and m is its light there. */
static bool add_segment(struct mean *m, const struct rim_node *from, const struct rim_node *to, struct vec3 p)
{
    const struct vec3 a = vec3_sub(from->at, p), b = vec3_sub(to->at, p);
    const double to_a = vec3_length(a), to_b = vec3_length(b), product = to_a * to_b;
    const double whole = product + vec3_dot(a, b);
    if (whole <= 1e-12 * vec3_dot(vec3_sub(b, a), vec3_sub(b, a))) {
        *m = (struct mean){.weight = 0};
        add_node(m, from, to_b);
        add_node(m, to, to_a);
        return false;
    }
    const double tangent = vec3_length(vec3_cross(a, b)) / whole;
    add_node(m, from, tangent / to_a);
    add_node(m, to, tangent / to_b);
    return true;
}

static double off_plane(const struct rim *r, int face, struct vec3 p)
{
    return vec3_dot(r->c->old.mesh->faces[face].normal, p) - r->c->old.mesh->faces[face].offset;
}

static void mean_of_edges(struct mean *m, const struct rim *r, int id, struct vec3 at)
{
    double plane = INFINITY;
    *m = (struct mean){.weight = 0};
    for (int k = r->first[id]; k < r->first[id + 1]; k++) plane = fmin(plane, fabs(off_plane(r, r->edges[k].face, at)));
    for (int k = r->first[id]; k < r->first[id + 1]; k++) {
        const struct rim_edge *e = &r->edges[k];
        const double off = off_plane(r, e->face, at);
        if (fabs(off) > plane + r->c->old.tolerance) continue;
        const struct vec3 p = vec3_sub(at, vec3_scale(r->c->old.mesh->faces[e->face].normal, off));
        if (vec3_dot(vec3_sub(r->nodes[e->first].at, p), e->in) < 0) continue;
        for (int n = e->first; n < e->last; n++)
            if (r->nodes[n].is_rim && !add_segment(m, &r->nodes[n], &r->nodes[n + 1], p)) return;
    }
}

struct fill_job {
    const struct rim *rim;
    const struct pixels *p;
    const struct irradiance *after;
    struct irradiance *before;
    float *error;
};

static double part(double error, double light) { return light > 0 ? error / light : 0; }

static void fill_some(void *ctx, size_t begin, size_t end, int thread)
{
    const struct fill_job *j = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct mean m;
        if (!j->p->is_new[i]) continue;
        const struct vec3 at =
            vec3_make((double)j->p->texel[i][0], (double)j->p->texel[i][1], (double)j->p->texel[i][2]);
        mean_of_edges(&m, j->rim, j->p->from[i], at);
        if (!(m.weight > 0)) continue;
        j->before[i].value = rgb_scale(m.light, 1 / m.weight);
        j->before[i].error = rgb_grey(m.error / m.weight);
        const double was = part(m.error, rgb_luminance(m.light));
        const double is = part(rgb_luminance(j->after[i].error), rgb_luminance(j->after[i].value));
        j->error[i] = (float)sqrt(was * was + is * is);
    }
}

enum status rim_light_fill(struct irradiance *before, float *error, const struct irradiance *after,
                           const struct pixels *p, const struct light_change *c, const struct relight_params *params,
                           struct err *err)
{
    const size_t n = (size_t)p->width * (size_t)p->height;
    struct rim rim = {.c = c, .params = params};
    bool any = false, *wanted = calloc((size_t)c->old.ids + 1, sizeof *wanted);
    if (!wanted) return err_nomem(err, "faces", (size_t)c->old.ids);
    for (size_t i = 0; i < n; i++)
        if (p->is_new[i]) any = wanted[p->from[i]] = true;
    if (any && !make(&rim, wanted, err)) {
        struct fill_job job = {&rim, p, after, before, error};
        parallel_for(n, 256, fill_some, &job);
    }
    release(&rim);
    free(wanted);
    return err->status;
}
