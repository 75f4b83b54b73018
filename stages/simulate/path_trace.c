/* path_trace.c - unidirectional path tracing with next-event estimation.
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

enum status world_read(struct world *w, const char *folder, const char *file, struct provenance *prov, struct err *err)
{
    *w = (struct world){0};
    enum status st = scene_read(&w->scene, folder, file, prov, err);
    if (!st) st = geometry_init(&w->geometry, &w->scene, err);
    if (!st && w->scene.base) st = geometry_keep_ids(&w->geometry, folder, w->scene.base, err);
    if (!st) st = geometry_commit(&w->geometry, err);
    if (!st) st = lights_init(&w->lights, &w->scene, &w->geometry, err);
    if (st) world_release(w);
    return st;
}

enum status world_move_sun(struct world *w, double azimuth, double elevation, struct err *err)
{
    struct sun *sun = &w->scene.sky.sun;
    sun->azimuth = azimuth;
    sun->elevation = elevation;
    lights_release(&w->lights);
    return lights_init(&w->lights, &w->scene, &w->geometry, err);
}

void world_release(struct world *w)
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

static struct brdf surface_at(const struct world *w, const struct scene_face *f, const struct ray_hit *hit)
{
    const struct scene_material *m = &w->scene.materials[f->material];
    double u, v;
    geometry_texture_coordinates(f, hit, &u, &v);
    return (struct brdf){m->kind, texture_at(&w->scene.textures[m->texture].texture, f->seed, u, v), m->ks, m->shape,
                         m->gloss};
}

static void follow(struct light_path *p, uint32_t bounce)
{
    const struct world *w = p->world;
    for (; bounce < MAX_BOUNCES; bounce++) {
        struct ray_hit hit;
        const struct vec3 d = p->ray.direction;
        p->rays++;
        if (!ray_scene_hit(geometry_seen(&w->geometry, w->shell && !bounce), p->ray.from, d, &hit)) {
            const struct rgb sky = sky_radiance(&w->lights.sky, d);
            if (rgb_max(sky) > 0)
                add_emission(p, sky, p->surface_pdf > 0 ? lights_pdf_sky(&w->lights, &p->selection, d) : 0);
            return;
        }
        const struct scene_face *f = &w->geometry.faces[hit.id];
        if (f->material < 0) { /* lamps reflect nothing */
            const struct rgb lamp = lights_emitted(&w->lights, &hit, d);
            if (rgb_max(lamp) > 0)
                add_emission(p, lamp, p->surface_pdf > 0 ? lights_pdf_face(&w->lights, &p->selection, &hit, d) : 0);
            return;
        }
        add_emission(p, w->scene.materials[f->material].glow, 0);
        if (w->max_bounces && bounce >= (uint32_t)w->max_bounces) return;
        const struct brdf b = surface_at(w, f, &hit);
        if (!scatter(p, &b, hit.point, hit.normal, vec3_scale(d, -1), bounce)) return;
    }
}

struct rgb path_radiance(const struct world *w, struct path_ray ray, const struct sobol *s, uint64_t *rays)
{
    struct light_path p = {.world = w, .sampler = s, .ray = ray, .weight = {1, 1, 1}};
    follow(&p, 0);
    *rays += p.rays;
    return p.light;
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
