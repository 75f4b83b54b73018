/* shared_paths.c - path tracing in which neighbouring pixels share their second vertices and light samples.
 *
 * Most noise of a path tracer indoors is in the indirect light: each path sees one small part of the room. Neighbouring
 * pixels see nearly the same surface, and what a path of one pixel found lights the other pixels as well
 * [Bekaert 2002]. For a group of surface points x_1 ... x_n, found by the rays of n pixels:
 *
 * - Indirect light. From each x_j a direction is sampled from its brdf; the ray hits y. One estimate of the light that
 *   y reflects is made (path_trace.c), and y is connected to all x_i by shadow rays. Seen as a choice of the point y,
 *   the n brdfs are n strategies with the densities per area p_k(y) = pdf_k cos_y / |x_k - y|^2 if x_k sees y, else 0.
 *   The balance heuristic [Veach 1995] gives x_i the share f_i G_i L(y -> x_i) / sum_k p_k(y), with the geometry factor
 *   G_i = cos_y / |x_i - y|^2. As x_j itself can see y, the sum is positive, and f_i G_i / sum_k p_k <= f_i / pdf_i: a
 *   connection is never worth more than a path of x_i's own.
 * - If y is glossy, the direction in which the path goes on from y was chosen for the view from x_j. The strategies
 *   then differ in that direction, too, and the sum over k has the density of both choices.
 * - Direct light. LIGHT_SAMPLES points on lamps and windows and directions to the sun are sampled for the group and
 *   connected to all x_i. The density of these samples and that of x_i's own brdf are combined by the balance heuristic
 *   for each x_i; a lamp or the sky that a brdf sample hits counts for its own ray alone.
 *
 * The error of the rays of a group is correlated, but its mean over the picture does not grow: the same paths are used
 * more often. render.c scatters the pixels of a group.
 *
 * Random numbers: group 1 is for light samples, the groups from 2 are for the paths of the rays. All rays use parts of
 * one sequence, so that the samples of a ray are stratified, and those of all rays together as well.
 *
 * Differs from the source: the sets are single vertices, not whole paths; lights are sampled for the group; shadow rays
 * go in packets, which are coherent because all begin close together and end in one point. */
#include "stages/simulate/shared_paths.h"

#include <math.h>

#include "common/math/numbers.h"

#define N             SHARED_RAYS
#define LIGHT_SAMPLES 8 /* for each group: measured; 4 and 16 have more error for the same time */

/* The surface points of the rays that hit a surface. Coordinates are stored by component for vector code. */
struct group {
    const struct world *world;
    const struct sobol *sampler;
    int count;
    int ray[N];                 /* index of the ray of each point */
    double x[N], y[N], z[N];    /* where paths go on: epsilon off the surface */
    double nx[N], ny[N], nz[N]; /* unit normal, on the side of the ray */
    struct vec3 start[N], normal[N], view[N];
    struct brdf brdf[N];
    double chance[MAX_LIGHTS]; /* of each light to be sampled; all 0: none is */
    struct rgb *radiance;
    uint64_t rays;
};

static bool has(uint32_t set, int i) { return set >> i & 1; }

static void add(struct group *g, int i, struct rgb c)
{
    struct rgb *to = &g->radiance[g->ray[i]];
    *to = rgb_add(*to, c);
}

/* --------------------------------------------------------------------------------------------------------- surfaces */

static void add_surface(struct group *g, int ray, const struct ray_hit *hit, struct vec3 direction)
{
    const struct vec3 n = hit->normal, p = vec3_add(hit->point, vec3_scale(n, g->world->geometry.rays.epsilon));
    const int i = g->count++;
    g->ray[i] = ray;
    g->start[i] = p, g->normal[i] = n, g->view[i] = vec3_scale(direction, -1);
    g->x[i] = p.x, g->y[i] = p.y, g->z[i] = p.z;
    g->nx[i] = n.x, g->ny[i] = n.y, g->nz[i] = n.z;
    g->brdf[i] = path_surface(g->world, hit);
}

/* Adds what a ray sees directly, and its surface to the group. */
static void arrive(struct group *g, int ray, bool found, const struct ray_hit *hit, struct vec3 direction)
{
    const struct world *w = g->world;
    struct rgb *to = &g->radiance[ray];
    if (!found) {
        *to = rgb_add(*to, sky_radiance(&w->lights.sky, direction));
        return;
    }
    const int material = w->geometry.faces[hit->id].material;
    if (material < 0) { /* lamps reflect nothing */
        *to = rgb_add(*to, lights_emitted(&w->lights, hit, direction));
        return;
    }
    *to = rgb_add(*to, w->scene.materials[material].glow);
    add_surface(g, ray, hit, direction);
}

static void find_surfaces(struct group *g, const struct path_ray ray[N], uint32_t active)
{
    for (int first = 0; first < N; first += RAY_PACKET) {
        const unsigned part = active >> first & ((1u << RAY_PACKET) - 1);
        struct vec3 from[RAY_PACKET], direction[RAY_PACKET];
        struct ray_hit hit[RAY_PACKET];
        if (!part) continue;
        for (int i = 0; i < RAY_PACKET; i++)
            if (has(part, i)) from[i] = ray[first + i].from, direction[i] = ray[first + i].direction, g->rays++;
        const unsigned found =
            ray_scene_hit_packet(geometry_seen(&g->world->geometry, g->world->shell), from, direction, part, hit);
        for (int i = 0; i < RAY_PACKET; i++)
            if (has(part, i)) arrive(g, first + i, has(found, i), &hit[i], direction[i]);
    }
}

/* ------------------------------------------------------------------------------------------------------ connections */

/* Segments from the surface points. `length` is in units of metres. */
struct segments {
    double x[N], y[N], z[N]; /* unit direction */
    double length[N];
    uint32_t wanted; /* which of them exist */
};

static struct vec3 segment_direction(const struct segments *s, int i) { return vec3_make(s->x[i], s->y[i], s->z[i]); }

/* Which segments nothing blocks. */
static uint32_t open_segments(struct group *g, const struct segments *s)
{
    uint32_t open = 0;
    for (int first = 0; first < g->count; first += RAY_PACKET) {
        const unsigned part = s->wanted >> first & ((1u << RAY_PACKET) - 1);
        struct vec3 direction[RAY_PACKET];
        if (!part) continue;
        for (int i = 0; i < RAY_PACKET; i++)
            if (has(part, i)) direction[i] = segment_direction(s, first + i), g->rays++;
        const unsigned blocked =
            ray_scene_blocked_packet(&g->world->geometry.rays, &g->start[first], direction, &s->length[first], part);
        open |= (part & ~blocked) << first;
    }
    return open;
}

/* ----------------------------------------------------------------------------------------------------- direct light */

static void choose_lights(struct group *g)
{
    const struct lights *lights = &g->world->lights;
    struct light_selection own;
    double sum = 0;
    for (int l = 0; l < lights->count; l++) g->chance[l] = 0;
    if (g->world->brdf_sampling_only) return;
    for (int i = 0; i < g->count; i++) {
        lights_select(&own, lights, g->start[i], g->normal[i]);
        for (int l = 0; l < lights->count; l++) g->chance[l] += own.probability[l];
    }
    for (int l = 0; l < lights->count; l++) sum += g->chance[l];
    for (int l = 0; l < lights->count; l++) g->chance[l] = sum > 0 ? g->chance[l] / sum : 0;
}

static void connect_light(struct group *g, const struct light_point *z)
{
    const struct world *w = g->world;
    struct segments to = {.wanted = 0};
    struct rgb light[N];
    for (int i = 0; i < g->count; i++) {
        struct light_sample s;
        double pdf;
        if (!lights_from_point(&s, &w->lights, g->chance, z, g->start[i])) continue;
        const struct rgb f = brdf_eval(&g->brdf[i], g->normal[i], g->view[i], s.direction, &pdf);
        if (!(rgb_max(f) > 0)) continue;
        light[i] = rgb_scale(rgb_multiply(f, s.radiance), 1 / (LIGHT_SAMPLES * s.pdf + pdf));
        to.x[i] = s.direction.x, to.y[i] = s.direction.y, to.z[i] = s.direction.z;
        to.length[i] = s.distance - 2 * w->geometry.rays.epsilon;
        to.wanted |= 1u << i;
    }
    const uint32_t open = open_segments(g, &to);
    for (int i = 0; i < g->count; i++)
        if (has(open, i)) add(g, i, light[i]);
}

static void add_direct_light(struct group *g)
{
    struct sobol s = *g->sampler;
    choose_lights(g);
    for (uint32_t k = 0; k < LIGHT_SAMPLES; k++) {
        struct light_point z;
        double u[4];
        s.sample = g->sampler->sample * LIGHT_SAMPLES + k;
        sobol_group(&s, 1, u);
        if (lights_choose_point(&z, &g->world->lights, g->chance, u)) connect_light(g, &z);
    }
}

/* --------------------------------------------------------------------------------------------------- indirect light */

/* A vertex as seen from the surface points. */
struct connection {
    struct segments to;
    uint32_t seen;
    struct rgb value[N]; /* brdf of the point, times cosine there, times the geometry factor */
    double density[N];   /* per area, with which the point's brdf finds the vertex */
};

static void connect(struct connection *c, struct group *g, int owner, const struct path_vertex *v)
{
    double cosine[N], geometry[N];
    const struct vec3 n = v->normal, end = vec3_add(v->point, vec3_scale(n, g->world->geometry.rays.epsilon));
    for (int i = 0; i < g->count; i++) {
        const double x = end.x - g->x[i], y = end.y - g->y[i], z = end.z - g->z[i];
        const double d2 = x * x + y * y + z * z, d = sqrt(d2);
        c->to.x[i] = x / d, c->to.y[i] = y / d, c->to.z[i] = z / d;
        c->to.length[i] = d;
        cosine[i] = (x * g->nx[i] + y * g->ny[i] + z * g->nz[i]) / d;
        geometry[i] = -(x * n.x + y * n.y + z * n.z) / (d2 * d);
    }
    c->to.wanted = 0;
    for (int i = 0; i < g->count; i++) {
        if (!(cosine[i] > 0) || !(geometry[i] > 0)) continue;
        double pdf = cosine[i] / PI;
        struct rgb f = rgb_scale(g->brdf[i].albedo, pdf);
        if (g->brdf[i].kind != BRDF_LAMBERT)
            f = brdf_eval(&g->brdf[i], g->normal[i], g->view[i], segment_direction(&c->to, i), &pdf);
        c->value[i] = rgb_scale(f, geometry[i]);
        c->density[i] = pdf * geometry[i];
        if (pdf > 0) c->to.wanted |= 1u << i;
    }
    const uint32_t own = c->to.wanted & 1u << owner; /* the ray that found the vertex is not traced again */
    c->to.wanted &= ~own;
    c->seen = own ? own | open_segments(g, &c->to) : 0;
}

/* Light that leaves the vertex in all directions alike. */
static void share_diffuse(struct group *g, const struct connection *c, struct rgb light)
{
    double density = 0;
    for (int i = 0; i < g->count; i++)
        if (has(c->seen, i)) density += c->density[i];
    if (!(density > 0)) return;
    const struct rgb scaled = rgb_scale(light, 1 / density);
    for (int i = 0; i < g->count; i++)
        if (has(c->seen, i)) add(g, i, rgb_multiply(c->value[i], scaled));
}

/* Light that a glossy vertex reflects from one direction, towards each point. */
static void share_glossy(struct group *g, const struct connection *c, const struct path_vertex *v,
                         const struct path_arrival *a)
{
    struct rgb f[N];
    double density = 0;
    for (int i = 0; i < g->count; i++) {
        double pdf;
        if (!has(c->seen, i)) continue;
        f[i] = brdf_eval(&v->brdf, v->normal, vec3_scale(segment_direction(&c->to, i), -1), a->direction, &pdf);
        density += c->density[i] * (pdf + a->light_pdf);
    }
    if (!(density > 0)) return;
    const struct rgb scaled = rgb_scale(a->radiance, 1 / density);
    for (int i = 0; i < g->count; i++)
        if (has(c->seen, i)) add(g, i, rgb_multiply(rgb_multiply(c->value[i], f[i]), scaled));
}

static void share(struct group *g, int owner, const struct path_vertex *v)
{
    const bool glossy = v->brdf.kind != BRDF_LAMBERT;
    const struct rgb light = glossy ? v->glow : rgb_add(v->glow, path_vertex_diffuse(v));
    if (!(rgb_max(light) > 0) && !v->arrivals) return;
    struct connection c;
    connect(&c, g, owner, v);
    if (rgb_max(light) > 0) share_diffuse(g, &c, light);
    for (int k = 0; glossy && k < v->arrivals; k++) share_glossy(g, &c, v, &v->arrival[k]);
}

/* The index of the random numbers of a ray. Those of one ray are consecutive: as every N-th of the sequence, they would
 * all be in one stratum. */
static uint32_t sample_of_ray(const struct group *g, int i)
{
    const uint32_t all = g->sampler->mask + 1, own = all / N, sample = g->sampler->sample;
    return sample / own * all + (uint32_t)g->ray[i] * own + sample % own;
}

/* Follows the path of point i. */
static void add_indirect_light(struct group *g, int i)
{
    const struct world *w = g->world;
    struct sobol s = *g->sampler;
    struct ray_hit hit;
    struct vec3 d;
    double u[4], pdf;
    s.sample = sample_of_ray(g, i);
    sobol_group(&s, 2, u);
    if (!brdf_sample(&g->brdf[i], g->normal[i], g->view[i], u, &d)) return;
    const struct rgb f = brdf_eval(&g->brdf[i], g->normal[i], g->view[i], d, &pdf);
    if (!(pdf > 0) || !(rgb_max(f) > 0)) return;
    g->rays++;
    if (!ray_scene_hit(&w->geometry.rays, g->start[i], d, &hit)) {
        const double light_pdf = LIGHT_SAMPLES * lights_point_pdf_sky(&w->lights, g->chance, g->start[i], d);
        add(g, i, rgb_scale(rgb_multiply(f, sky_radiance(&w->lights.sky, d)), 1 / (pdf + light_pdf)));
    } else if (w->geometry.faces[hit.id].material < 0) {
        const double light_pdf = LIGHT_SAMPLES * lights_point_pdf_face(&w->lights, g->chance, g->start[i], &hit, d);
        add(g, i, rgb_scale(rgb_multiply(f, lights_emitted(&w->lights, &hit, d)), 1 / (pdf + light_pdf)));
    } else {
        struct path_vertex v;
        path_vertex_make(&v, w, &hit, vec3_scale(d, -1), &s, &g->rays);
        share(g, i, &v);
    }
}

void shared_paths_radiance(struct rgb radiance[SHARED_RAYS], const struct world *w,
                           const struct path_ray ray[SHARED_RAYS], uint32_t active, const struct sobol *s,
                           uint64_t *rays)
{
    struct group g;
    g.world = w, g.sampler = s, g.count = 0, g.radiance = radiance, g.rays = 0;
    find_surfaces(&g, ray, active);
    add_direct_light(&g);
    for (int i = 0; i < g.count; i++) add_indirect_light(&g, i);
    *rays += g.rays;
}
