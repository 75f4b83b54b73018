/* path_trace.c - see path_trace.h.
 *
 * Each bounce uses two groups of four random numbers: light (which, where, where) and roulette; surface (lobe,
 * direction, direction). The balance heuristic (E. Veach, L. Guibas, 1995) for a direction that lights choose with
 * density p and the surface with density q gives both estimates the value f L / (p + q). */
#include "stages/simulate/path_trace.h"

#include <math.h>

#include "common/light/fast.h"
#include "common/math/numbers.h"

#define SURE_BOUNCES  3
#define MOST_SURVIVAL 0.95 /* so that a path in a white box ends, too */
#define HARD_END      4096 /* bounces; never reached but by a program gone wrong */

enum status world_read(struct world *w, const char *folder, const char *file, struct provenance *prov, struct err *err)
{
    *w = (struct world){0};
    enum status st = scene_read(&w->scene, folder, file, prov, err);
    if (!st) st = geometry_init(&w->geometry, &w->scene, err);
    if (!st) st = geometry_commit(&w->geometry, err);
    if (!st) st = lights_init(&w->lights, &w->scene, &w->geometry, err);
    if (st) world_release(w);
    return st;
}

void world_release(struct world *w)
{
    if (!w) return;
    lights_release(&w->lights);
    geometry_release(&w->geometry);
    scene_release(&w->scene);
    *w = (struct world){0};
}

struct path {
    const struct world *world;
    const struct sobol *sampler;
    struct ray ray;
    struct rgb light, weight;
    struct light_chances chances; /* at the surface that the ray left */
    double surface_pdf;           /* with which that surface chose the ray; 0: the camera did */
    uint64_t rays;
};

/* What was met by the ray itself, weighed against the chance that the last surface had looked for it. */
static void meet(struct path *p, struct rgb radiance, double light_pdf)
{
    double share = 1;
    if (p->surface_pdf > 0 && !p->world->only_surface) share = p->surface_pdf / (p->surface_pdf + light_pdf);
    p->light = rgb_add(p->light, rgb_scale(rgb_multiply(p->weight, radiance), share));
}

static void look_for_light(struct path *p, const struct brdf *b, struct vec3 n, struct vec3 view, const double u[4])
{
    const struct world *w = p->world;
    struct light_sample s;
    double pdf;
    if (!lights_sample(&s, &w->lights, &p->chances, u)) return;
    const struct rgb f = brdf_eval(b, n, view, s.direction, &pdf);
    if (!(rgb_max(f) > 0)) return;
    p->rays++;
    if (ray_scene_blocked(&w->geometry.rays, p->chances.point, s.direction, s.distance - 2 * w->geometry.rays.epsilon))
        return;
    const struct rgb gain = rgb_multiply(rgb_multiply(p->weight, f), s.radiance);
    p->light = rgb_add(p->light, rgb_scale(gain, 1 / (s.pdf + pdf)));
}

/* Scatters at a surface point whose normal faces the viewer. False: the path ends. */
static bool scatter(struct path *p, const struct brdf *b, struct vec3 point, struct vec3 n, struct vec3 view,
                    uint32_t bounce)
{
    const struct world *w = p->world;
    double light_u[4], surface_u[4];
    struct vec3 direction;
    sobol_group(p->sampler, 2 * bounce + 1, light_u);
    sobol_group(p->sampler, 2 * bounce + 2, surface_u);

    if (bounce >= SURE_BOUNCES) {
        const double survival = fast_min(MOST_SURVIVAL, sqrt(rgb_max(p->weight)));
        if (light_u[3] >= survival) return false;
        p->weight = rgb_scale(p->weight, 1 / survival);
    }
    const struct vec3 start = vec3_add(point, vec3_scale(n, w->geometry.rays.epsilon));
    lights_chances(&p->chances, &w->lights, start, n);
    if (!w->only_surface) look_for_light(p, b, n, view, light_u);

    if (!brdf_sample(b, n, view, surface_u, &direction)) return false;
    const struct rgb f = brdf_eval(b, n, view, direction, &p->surface_pdf);
    if (!(p->surface_pdf > 0) || !(rgb_max(f) > 0)) return false;
    p->weight = rgb_scale(rgb_multiply(p->weight, f), 1 / p->surface_pdf);
    p->ray = (struct ray){start, direction};
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

static void follow(struct path *p, uint32_t bounce)
{
    const struct world *w = p->world;
    for (; bounce < HARD_END; bounce++) {
        struct ray_hit hit;
        const struct vec3 d = p->ray.direction;
        p->rays++;
        if (!ray_scene_hit(&w->geometry.rays, p->ray.from, d, &hit)) {
            const struct rgb sky = sky_radiance(&w->lights.sky, d);
            if (rgb_max(sky) > 0) meet(p, sky, p->surface_pdf > 0 ? lights_pdf_sky(&w->lights, &p->chances, d) : 0);
            return;
        }
        const struct scene_face *f = &w->geometry.faces[hit.id];
        if (f->material < 0) { /* a lamp reflects nothing */
            const struct rgb lamp = lights_emitted(&w->lights, &hit, d);
            if (rgb_max(lamp) > 0)
                meet(p, lamp, p->surface_pdf > 0 ? lights_pdf_face(&w->lights, &p->chances, &hit, d) : 0);
            return;
        }
        meet(p, w->scene.materials[f->material].glow, 0);
        if (w->max_bounces && bounce >= (uint32_t)w->max_bounces) return;
        const struct brdf b = surface_at(w, f, &hit);
        if (!scatter(p, &b, hit.point, hit.normal, vec3_scale(d, -1), bounce)) return;
    }
}

struct rgb path_radiance(const struct world *w, struct ray ray, const struct sobol *s, uint64_t *rays)
{
    struct path p = {.world = w, .sampler = s, .ray = ray, .weight = {1, 1, 1}};
    follow(&p, 0);
    *rays += p.rays;
    return p.light;
}

struct rgb path_irradiance(const struct world *w, struct vec3 point, struct vec3 normal, const struct sobol *s,
                           uint64_t *rays)
{
    /* what a white surface reflects is E / pi */
    const struct brdf white = {BRDF_LAMBERT, {1, 1, 1}, 0, 0, 0};
    struct path p = {.world = w, .sampler = s, .weight = {1, 1, 1}};
    if (scatter(&p, &white, point, normal, normal, 0)) follow(&p, 1);
    *rays += p.rays;
    return rgb_scale(p.light, PI);
}
