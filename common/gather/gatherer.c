/* gatherer.c - irradiance to a target error.
 *
 * `auto` is rays: at 1 % they need a small part of the hemicube's time wherever light is bright in few directions
 * (docs/benchmarks.md, `irradiance`), and their stated error is honest. Rays are repeated with more of them until their
 * stated error is at most the target (mixture.c). `cache` means rays at single points; pictures are filled by
 * irradiance_cache.c.
 *
 * A hemicube's resolution is doubled, from COARSEST on, until the error that it states for the luminance is at most the
 * target. Each has four times the rays of the one before, so that all of them together cost a third more than the last
 * one alone. */
#include "common/gather/gatherer.h"

#include <stdlib.h>
#include <string.h>

enum { COARSEST = 128, MAX_CUBES = 16 };

struct gatherer {
    struct gather_params params;
    struct hemicube *cubes[MAX_CUBES]; /* each twice as fine as the one before; the last one has params.hemicube px */
    int cube_count;
};

enum status gather_params_check(const struct gather_params *p, struct err *err)
{
    if (p->hemicube % 2 == 0) return ST_OK;
    return err_set(err, ST_USAGE, "hemicube = %d is odd, wanted an even number; give %d.", p->hemicube,
                   p->hemicube + 1);
}

bool gather_params_cache(const struct gather_params *p)
{
    return p->target_error > 0 && (!strcmp(p->estimator, "auto") || !strcmp(p->estimator, "cache"));
}

static bool gather_params_hemicube(const struct gather_params *p) { return !strcmp(p->estimator, "hemicube"); }

enum status gatherer_make(struct gatherer **g, const struct gather_params *p, struct err *err)
{
    *g = NULL;
    struct gatherer *made = calloc(1, sizeof *made);
    if (!made) return err_nomem(err, "a gather of light", sizeof *made);
    made->params = *p;
    if (!gather_params_hemicube(p)) {
        *g = made;
        return ST_OK;
    }
    int n = p->hemicube, steps = 1;
    while (p->target_error > 0 && n % 4 == 0 && n / 2 >= COARSEST) {
        n /= 2;
        steps++;
    }
    for (int i = 0; !err->status && i < steps; i++, n *= 2)
        if (!hemicube_make(&made->cubes[i], n, err)) made->cube_count++;
    if (err->status)
        gatherer_free(made);
    else
        *g = made;
    return err->status;
}

void gatherer_free(struct gatherer *g)
{
    if (!g) return;
    for (int i = 0; i < g->cube_count; i++) hemicube_free(g->cubes[i]);
    free(g);
}

static void gather_rays(struct irradiance *e, const struct gatherer *g, const struct light_field *f,
                        struct gather_point p, uint64_t key)
{
    if (g->params.target_error > 0)
        ray_irradiance_to(e, f, p, g->params.target_error, g->params.rays, key);
    else
        ray_irradiance(e, f, p, g->params.rays, key);
}

void gatherer_irradiance(struct irradiance *e, const struct gatherer *g, const struct light_field *f,
                         struct gather_point p, uint64_t key)
{
    int rays = 0;
    if (!g->cube_count) {
        gather_rays(e, g, f, p, key);
        return;
    }
    for (int i = 0; i < g->cube_count; i++) {
        hemicube_irradiance(e, g->cubes[i], f, p);
        rays += e->rays;
        if (rgb_luminance(e->error) <= g->params.target_error * rgb_luminance(e->value)) break;
    }
    e->rays = rays;
}
