/* incident.c - samples of the light about a point, weighted for lobes of any width.
 *
 * The width of the lobe is unknown while light is gathered, so that rays must serve wide and narrow lobes alike. About
 * a sample's mirror direction R they have the density, with c = 1 - cos of the angle to R,
 *   p(L) = 1 / (2 pi (c + a) ln((2 + a) / a)),    c = a (((2 + a) / a)^u - 1),   u uniform in [0, 1)
 * which gives every octave of width the same number of rays, down to a, the width of the narrowest lobe. Small bright
 * lamps would still be noise in the wide lobes. Rays to points of the emitters are added, and the weights of all follow
 * the balance heuristic [Veach 1995]: radiance over the sum of number times density of all strategies that could have
 * chosen the direction. What look() returns is thus counted once, named as an emitter or not. The irradiance is
 * integrated the same way, with cosine-weighted rays in place of those about R.
 *
 * Points of the square are Owen-scrambled Sobol' points. The rays of a strategy follow each other in packets. */
#include "stages/fit_materials/incident.h"

#include <math.h>

#include "common/light/frame.h"
#include "common/light/sobol.h"
#include "common/math/numbers.h"

#define NARROWEST 5e-5 /* a: n = 5000 falls to 1 / e at 2e-4, alpha = 0.02 at 8e-4 */

struct gather {
    const struct light_field *field;
    struct vec3 at, normal;
    int emitter_rays;
    struct sobol sobol;
};

/* --------------------------------------------------------------------------------------------------------- emitters */

/* A direction to a point of the emitter, uniform over its area (of a sun: over its solid angle). */
static bool emitter_direction(struct vec3 *direction, const struct emitter *e, struct vec3 at, double u, double v)
{
    if (e->kind == EMITTER_SUN) {
        const double cos_t = 1 - u * (1 - e->cone);
        *direction = frame_direction(e->normal, sqrt(fast_max(0, 1 - cos_t * cos_t)), cos_t, v);
        return true;
    }
    double x = 2 * u - 1, y = 2 * v - 1;
    if (e->kind == EMITTER_DISK) {
        const double radius = sqrt(u);
        fast_cos_sin(v, &x, &y);
        x *= radius;
        y *= radius;
    }
    const struct vec3 to = vec3_sub(vec3_add(e->centre, vec3_add(vec3_scale(e->x, x), vec3_scale(e->y, y))), at);
    *direction = vec3_normalize(to);
    return vec3_dot(*direction, *direction) > 0;
}

/* The density of emitter_direction() per solid angle; 0 where it never goes. */
static double emitter_density(const struct emitter *e, struct vec3 at, struct vec3 direction)
{
    if (e->kind == EMITTER_SUN) {
        const double cos_t = vec3_dot(e->normal, direction);
        return cos_t >= e->cone && e->cone < 1 ? 1 / (2 * PI * (1 - e->cone)) : 0;
    }
    const struct vec3 across = vec3_cross(e->x, e->y), to = vec3_sub(e->centre, at);
    const double area2 = vec3_length(across), along = vec3_dot(across, direction), height = vec3_dot(across, to);
    if (!(area2 > 0) || !(along * height > 0)) return 0;
    const double distance = height / along;
    const struct vec3 off = vec3_sub(vec3_scale(direction, distance), to);
    const double x = vec3_dot(off, e->x) / vec3_dot(e->x, e->x), y = vec3_dot(off, e->y) / vec3_dot(e->y, e->y);
    const bool disk = e->kind == EMITTER_DISK;
    if (disk ? x * x + y * y > 1 : fabs(x) > 1 || fabs(y) > 1) return 0;
    const double area = (disk ? PI : 4) * area2, cosine = fabs(along) / area2;
    return distance * distance / (area * cosine);
}

/* Number times density of the rays to all emitters. */
static double emitters_density(const struct gather *g, struct vec3 direction)
{
    double sum = 0;
    for (int i = 0; i < g->field->emitter_count; i++)
        sum += g->emitter_rays * emitter_density(&g->field->emitters[i], g->at, direction);
    return sum;
}

/* ------------------------------------------------------------------------------------------------------------ lobes */

static double ring_density(double c) { return 1 / (2 * PI * (c + NARROWEST) * log((2 + NARROWEST) / NARROWEST)); }

static struct vec3 ring_direction(struct vec3 mirror, double u, double v)
{
    const double c = fast_min(2, NARROWEST * (pow((2 + NARROWEST) / NARROWEST, u) - 1));
    return frame_direction(mirror, sqrt(fast_max(0, c * (2 - c))), 1 - c, v);
}

/* A packet of rays of which none is below the horizon. */
struct packet {
    struct vec3 from[RAY_PACKET], direction[RAY_PACKET];
    struct light_look seen[RAY_PACKET];
    int count;
};

static void look(const struct gather *g, struct packet *p)
{
    for (int k = 0; k < RAY_PACKET; k++) p->from[k] = g->at;
    if (p->count) g->field->look(g->field->ctx, p->from, g->normal, p->direction, (1u << p->count) - 1, p->seen);
}

/* What a ray adds, by whoever gathers. */
typedef void take_fn(void *ctx, struct vec3 direction, const struct light_look *seen);
/* A direction from two numbers in [0, 1); false: there is none. */
typedef bool draw_fn(const void *ctx, struct vec3 at, double u, double v, struct vec3 *direction);

static void flush(const struct gather *g, struct packet *p, take_fn *take, void *ctx)
{
    look(g, p);
    for (int k = 0; k < p->count; k++) take(ctx, p->direction[k], &p->seen[k]);
    p->count = 0;
}

/* Sends `rays` rays of a strategy, with the numbers of a group of dimensions. */
static void send(struct gather *g, int rays, uint32_t group, draw_fn *draw, const void *strategy, take_fn *take,
                 void *ctx)
{
    struct packet p = {.count = 0};
    for (int i = 0; i < rays; i++) {
        double u[4];
        struct vec3 direction;
        g->sobol.sample = (uint32_t)i;
        sobol_group(&g->sobol, group, u);
        if (!draw(strategy, g->at, u[0], u[1], &direction) || !(vec3_dot(direction, g->normal) > 0)) continue;
        p.direction[p.count++] = direction;
        if (p.count == RAY_PACKET) flush(g, &p, take, ctx);
    }
    flush(g, &p, take, ctx);
}

static bool draw_emitter(const void *strategy, struct vec3 at, double u, double v, struct vec3 *direction)
{
    return emitter_direction(direction, strategy, at, u, v);
}

static bool draw_ring(const void *strategy, struct vec3 at, double u, double v, struct vec3 *direction)
{
    (void)at;
    *direction = ring_direction(*(const struct vec3 *)strategy, u, v);
    return true;
}

static bool draw_cosine(const void *strategy, struct vec3 at, double u, double v, struct vec3 *direction)
{
    (void)at;
    *direction = frame_direction(*(const struct vec3 *)strategy, sqrt(u), sqrt(1 - u), v);
    return true;
}

/* ------------------------------------------------------------------------------------------------------ the samples */

struct lobe_sample {
    struct material_samples *s;
    const struct gather *g;
    int i, rays;
    struct vec3 view, mirror;
};

static void take_lobe(void *ctx, struct vec3 direction, const struct light_look *seen)
{
    const struct lobe_sample *l = ctx;
    const struct vec3 apart = vec3_sub(direction, l->mirror);
    const double density = l->rays * ring_density(0.5 * vec3_dot(apart, apart)) + emitters_density(l->g, direction);
    material_samples_add(l->s, l->i, l->g->normal, l->view, direction, rgb_scale(seen->radiance, 1 / density));
}

struct diffuse {
    const struct gather *g;
    struct rgb sum;
    double by_source[LIGHT_SOURCES];
    int rays;
};

static void take_diffuse(void *ctx, struct vec3 direction, const struct light_look *seen)
{
    struct diffuse *d = ctx;
    const double cosine = vec3_dot(direction, d->g->normal);
    const double density = d->rays * cosine / PI + emitters_density(d->g, direction);
    const struct rgb light = rgb_scale(seen->radiance, cosine / density);
    d->sum = rgb_add(d->sum, light);
    d->by_source[seen->source] += rgb_luminance(light);
}

/* Rays to emitters serve all samples of the point. */
struct emitter_rays {
    struct diffuse *diffuse;
    struct lobe_sample *lobes;
    int count;
};

static void take_emitter(void *ctx, struct vec3 direction, const struct light_look *seen)
{
    const struct emitter_rays *e = ctx;
    take_diffuse(e->diffuse, direction, seen);
    for (int k = 0; k < e->count; k++) take_lobe(&e->lobes[k], direction, seen);
}

static void set_irradiance(struct material_samples *s, int first, int count, const struct diffuse *d, double *shares)
{
    const double total = rgb_luminance(d->sum);
    for (int i = first; i < first + count; i++) {
        s->irradiance[3 * i] = d->sum.r;
        s->irradiance[3 * i + 1] = d->sum.g;
        s->irradiance[3 * i + 2] = d->sum.b;
    }
    for (int k = 0; shares && k < LIGHT_SOURCES; k++) shares[k] = total > 0 ? d->by_source[k] / total : 0;
}

enum { MAX_VIEWS = 64 }; /* of a point; more are in further groups */

void incident_light_at(struct material_samples *s, int first, int count, const struct light_field *f, struct vec3 at,
                       struct vec3 normal, const struct vec3 *view, const struct incident_effort *effort, uint64_t key,
                       double *shares)
{
    const struct rng rng = rng_make(0, "fit_materials", "light");
    struct gather g = {f, at, normal, effort->emitter_rays, {0}};
    struct lobe_sample lobes[MAX_VIEWS];
    for (int from = 0; from < count; from += MAX_VIEWS) {
        const int some = count - from < MAX_VIEWS ? count - from : MAX_VIEWS;
        struct diffuse diffuse = {.g = &g, .rays = effort->diffuse_rays};
        struct emitter_rays emitter_rays = {&diffuse, lobes, some};
        for (int k = 0; k < some; k++) {
            const struct vec3 v = view[from + k];
            const struct vec3 mirror = vec3_sub(vec3_scale(normal, 2 * vec3_dot(normal, v)), v);
            lobes[k] = (struct lobe_sample){s, &g, first + from + k, effort->lobe_rays, v, mirror};
        }
        g.sobol = sobol_make(&rng, key, effort->emitter_rays);
        for (int e = 0; e < f->emitter_count; e++)
            send(&g, effort->emitter_rays, 2 + (uint32_t)e, draw_emitter, &f->emitters[e], take_emitter, &emitter_rays);
        g.sobol = sobol_make(&rng, key, effort->diffuse_rays);
        send(&g, effort->diffuse_rays, 0, draw_cosine, &normal, take_diffuse, &diffuse);
        for (int k = 0; k < some; k++) {
            g.sobol = sobol_make(&rng, key ^ ((uint64_t)(from + k + 1) << 40), effort->lobe_rays);
            send(&g, effort->lobe_rays, 1, draw_ring, &lobes[k].mirror, take_lobe, &lobes[k]);
        }
        set_irradiance(s, first + from, some, &diffuse, shares);
    }
}
