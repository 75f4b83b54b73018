/* path_trace.c - unidirectional path tracing with next-event estimation: paths from their second vertex on, and whole
 * paths from a surface element.
 *
 * Each bounce uses two groups of four random numbers: one for the light (which, two for where) and for Russian
 * roulette; one for the brdf (lobe, two for the direction). A direction may be found by sampling the lights, with
 * density p, or the brdf, with density q. The balance heuristic [Veach 1995] weights each by its share of p + q, so
 * that either estimate is f L / (p + q). The first ROULETTE_AFTER bounces always go on; then a path survives with a
 * probability of the square root of its weight's largest channel, at most MAX_SURVIVAL. */
#include "stages/simulate/path_trace.h"

#include <math.h>

#include "common/light/fast.h"
#include "common/math/numbers.h"

#define ROULETTE_AFTER 3
#define MAX_SURVIVAL   0.95 /* below 1, so that paths in a white box end, too */
#define MAX_BOUNCES    4096 /* reached only through a defect */

/* Bounces are counted from the camera: a vertex of path_vertex_make() is bounce 1. */
enum { VERTEX_BOUNCE = 1 };

enum status path_world_read(struct world *w, const char *folder, const char *file, struct provenance *prov,
                            struct err *err)
{
    *w = (struct world){0};
    if (!scene_read(&w->scene, folder, file, prov, err)) geometry_init(&w->geometry, &w->scene, err);
    if (!err->status && w->scene.base) geometry_keep_ids(&w->geometry, folder, w->scene.base, err);
    if (!err->status && !geometry_commit(&w->geometry, err)) lights_init(&w->lights, &w->scene, &w->geometry, err);
    if (err->status) path_world_release(w);
    return err->status;
}

enum status path_world_move_sun(struct world *w, double azimuth, double elevation, struct err *err)
{
    struct sun *sun = &w->scene.sky.sun;
    sun->azimuth = azimuth;
    sun->elevation = elevation;
    lights_release(&w->lights);
    return lights_init(&w->lights, &w->scene, &w->geometry, err);
}

void path_world_release(struct world *w)
{
    if (!w) return;
    lights_release(&w->lights);
    geometry_release(&w->geometry);
    scene_release(&w->scene);
    *w = (struct world){0};
}

struct light_path {
    const struct world *world;
    const struct sobol *sampler;
    struct path_ray ray;
    struct rgb light, weight;
    struct light_selection selection; /* at the surface that the ray comes from */
    double surface_pdf;               /* density with which its brdf chose the ray; 0: the ray comes from the camera */
    uint64_t rays;
};

/* Adds light that the ray itself hit, weighted against next-event estimation at the surface before. */
static void add_emission(struct light_path *p, struct rgb radiance, double light_pdf)
{
    double share = 1;
    if (p->surface_pdf > 0 && !p->world->brdf_sampling_only) share = p->surface_pdf / (p->surface_pdf + light_pdf);
    p->light = rgb_add(p->light, rgb_scale(rgb_multiply(p->weight, radiance), share));
}

static void sample_direct_light(struct light_path *p, const struct brdf *b, struct vec3 n, struct vec3 view,
                                const double u[4])
{
    const struct world *w = p->world;
    struct light_sample s;
    double pdf;
    if (!lights_sample(&s, &w->lights, &p->selection, u)) return;
    const struct rgb f = brdf_eval(b, n, view, s.direction, &pdf);
    if (!(rgb_max(f) > 0)) return;
    p->rays++;
    if (ray_scene_blocked(&w->geometry.rays, p->selection.point, s.direction,
                          s.distance - 2 * w->geometry.rays.epsilon))
        return;
    const struct rgb gain = rgb_multiply(rgb_multiply(p->weight, f), s.radiance);
    p->light = rgb_add(p->light, rgb_scale(gain, 1 / (s.pdf + pdf)));
}

/* Continues the path at a surface point whose normal faces the viewer. False: the path ends. */
static bool scatter(struct light_path *p, const struct brdf *b, struct vec3 point, struct vec3 n, struct vec3 view,
                    uint32_t bounce)
{
    const struct world *w = p->world;
    double light_u[4], surface_u[4];
    struct vec3 direction;
    sobol_group(p->sampler, 2 * bounce + 1, light_u);
    sobol_group(p->sampler, 2 * bounce + 2, surface_u);

    if (bounce >= ROULETTE_AFTER) {
        const double survival = fast_min(MAX_SURVIVAL, sqrt(rgb_max(p->weight)));
        if (light_u[3] >= survival) return false;
        p->weight = rgb_scale(p->weight, 1 / survival);
    }
    const struct vec3 start = vec3_add(point, vec3_scale(n, w->geometry.rays.epsilon));
    lights_select(&p->selection, &w->lights, start, n);
    if (!w->brdf_sampling_only) sample_direct_light(p, b, n, view, light_u);

    if (!brdf_sample(b, n, view, surface_u, &direction)) return false;
    const struct rgb f = brdf_eval(b, n, view, direction, &p->surface_pdf);
    if (!(p->surface_pdf > 0) || !(rgb_max(f) > 0)) return false;
    p->weight = rgb_scale(rgb_multiply(p->weight, f), 1 / p->surface_pdf);
    p->ray = (struct path_ray){start, direction};
    return true;
}

struct brdf path_surface(const struct world *w, const struct ray_hit *hit)
{
    const struct scene_face *f = &w->geometry.faces[hit->id];
    const struct scene_material *m = &w->scene.materials[f->material];
    double u, v;
    geometry_texture_coordinates(f, hit, &u, &v);
    return (struct brdf){m->kind, texture_at(&w->scene.textures[m->texture].texture, f->seed, u, v), m->ks, m->shape,
                         m->gloss};
}

/* What a ray meets: a surface that reflects, or (false) a lamp or the outdoors. */
static bool meet(struct light_path *p, struct ray_hit *hit, struct rgb *emitted, double *light_pdf)
{
    const struct world *w = p->world;
    const struct vec3 d = p->ray.direction;
    *light_pdf = 0;
    p->rays++;
    if (!ray_scene_hit(&w->geometry.rays, p->ray.from, d, hit)) {
        *emitted = sky_radiance(&w->lights.sky, d);
        if (p->surface_pdf > 0 && rgb_max(*emitted) > 0) *light_pdf = lights_pdf_sky(&w->lights, &p->selection, d);
        return false;
    }
    const struct scene_face *f = &w->geometry.faces[hit->id];
    if (f->material >= 0) {
        *emitted = w->scene.materials[f->material].glow;
        return true;
    }
    *emitted = lights_emitted(&w->lights, hit, d); /* lamps reflect nothing */
    if (p->surface_pdf > 0 && rgb_max(*emitted) > 0) *light_pdf = lights_pdf_face(&w->lights, &p->selection, hit, d);
    return false;
}

static bool last_bounce(const struct world *w, uint32_t bounce)
{
    return w->max_bounces && bounce >= (uint32_t)w->max_bounces;
}

static bool scatter_at(struct light_path *p, const struct ray_hit *hit, uint32_t bounce)
{
    const struct brdf b = path_surface(p->world, hit);
    return scatter(p, &b, hit->point, hit->normal, vec3_scale(p->ray.direction, -1), bounce);
}

static void follow(struct light_path *p, uint32_t bounce)
{
    for (; bounce < MAX_BOUNCES; bounce++) {
        struct ray_hit hit;
        struct rgb emitted;
        double light_pdf;
        const bool surface = meet(p, &hit, &emitted, &light_pdf);
        if (rgb_max(emitted) > 0) add_emission(p, emitted, light_pdf);
        if (!surface || last_bounce(p->world, bounce) || !scatter_at(p, &hit, bounce)) return;
    }
}

/* Light from the direction that sampling of the lights chooses. */
static void arrive_from_light(struct path_vertex *v, struct light_path *p, struct vec3 start)
{
    const struct ray_scene *rays = &p->world->geometry.rays;
    struct light_sample s;
    double u[4];
    sobol_group(p->sampler, 2 * VERTEX_BOUNCE + 1, u);
    if (!lights_sample(&s, &p->world->lights, &p->selection, u) || !(vec3_dot(s.direction, v->normal) > 0)) return;
    p->rays++;
    if (ray_scene_blocked(rays, start, s.direction, s.distance - 2 * rays->epsilon)) return;
    v->arrival[v->arrivals++] = (struct path_arrival){s.direction, s.radiance, s.pdf};
}

/* Light from the direction that sampling of the brdf chooses. */
static void arrive_by_brdf(struct path_vertex *v, struct light_path *p, struct vec3 start, struct vec3 view)
{
    struct path_arrival a;
    struct ray_hit hit;
    double u[4];
    sobol_group(p->sampler, 2 * VERTEX_BOUNCE + 2, u);
    if (!brdf_sample(&v->brdf, v->normal, view, u, &a.direction)) return;
    const struct rgb f = brdf_eval(&v->brdf, v->normal, view, a.direction, &p->surface_pdf);
    if (!(p->surface_pdf > 0) || !(rgb_max(f) > 0)) return;
    p->ray = (struct path_ray){start, a.direction};
    const bool surface = meet(p, &hit, &a.radiance, &a.light_pdf);
    if (p->world->brdf_sampling_only) a.light_pdf = 0;
    if (surface && !last_bounce(p->world, VERTEX_BOUNCE + 1) && scatter_at(p, &hit, VERTEX_BOUNCE + 1))
        follow(p, VERTEX_BOUNCE + 2);
    a.radiance = rgb_add(a.radiance, p->light);
    if (rgb_max(a.radiance) > 0) v->arrival[v->arrivals++] = a;
}

void path_vertex_make(struct path_vertex *v, const struct world *w, const struct ray_hit *hit, struct vec3 view,
                      const struct sobol *s, uint64_t *rays)
{
    *v = (struct path_vertex){.point = hit->point, .normal = hit->normal};
    v->glow = w->scene.materials[w->geometry.faces[hit->id].material].glow;
    if (last_bounce(w, VERTEX_BOUNCE)) return;
    struct light_path p = {.world = w, .sampler = s, .weight = {1, 1, 1}};
    const struct vec3 start = vec3_add(hit->point, vec3_scale(hit->normal, w->geometry.rays.epsilon));
    v->brdf = path_surface(w, hit);
    lights_select(&p.selection, &w->lights, start, hit->normal);
    if (!w->brdf_sampling_only) arrive_from_light(v, &p, start);
    arrive_by_brdf(v, &p, start, view);
    *rays += p.rays;
}

struct rgb path_vertex_diffuse(const struct path_vertex *v)
{
    struct rgb sum = {0, 0, 0};
    for (int i = 0; i < v->arrivals; i++) {
        const double pdf = vec3_dot(v->normal, v->arrival[i].direction) / PI; /* the brdf's value for albedo 1, too */
        sum = rgb_add(sum, rgb_scale(v->arrival[i].radiance, pdf / (pdf + v->arrival[i].light_pdf)));
    }
    return rgb_multiply(v->brdf.albedo, sum);
}

struct rgb path_irradiance(const struct world *w, struct vec3 point, struct vec3 normal, const struct sobol *s,
                           uint64_t *rays)
{
    /* a white surface has radiance E / pi */
    const struct brdf white = {BRDF_LAMBERT, {1, 1, 1}, 0, 0, 0};
    struct light_path p = {.world = w, .sampler = s, .weight = {1, 1, 1}};
    if (scatter(&p, &white, point, normal, normal, 0)) follow(&p, 1);
    *rays += p.rays;
    return rgb_scale(p.light, PI);
}
