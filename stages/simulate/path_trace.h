/* path_trace.h - the light that arrives along a ray: path tracing.
 *
 * At every surface one light is looked for (next-event estimation) and one direction of the surface's own choice is
 * followed; what both can find is weighed by the balance heuristic. Paths end by Russian roulette, which leaves the
 * expectation as it is; nothing is clamped. Units: radiance, scene-linear Rec.709. */
#ifndef REMODEL_SIMULATE_PATH_TRACE_H
#define REMODEL_SIMULATE_PATH_TRACE_H

#include "common/light/sobol.h"
#include "stages/simulate/lights.h"

/* A scene ready for rays. */
struct world {
    struct scene scene;
    struct scene_geometry geometry;
    struct lights lights;
    int max_bounces;   /* reflections followed; 0: as many as the roulette lets */
    bool only_surface; /* no light is looked for: the slow way, which must give the same */
};

/* Reads FOLDER/FILE and prepares it. {0} is the empty state. */
enum status world_read(struct world *w, const char *folder, const char *file, struct provenance *prov, struct err *err);
void world_release(struct world *w);

struct ray {
    struct vec3 from, direction; /* unit */
};

/* One estimate. Adds to *rays how many rays it took. The sampler's group 0 is the caller's. */
struct rgb path_radiance(const struct world *w, struct ray ray, const struct sobol *s, uint64_t *rays);

/* One estimate of the irradiance on the front of a surface element: the integral of radiance by cosine. */
struct rgb path_irradiance(const struct world *w, struct vec3 point, struct vec3 normal, const struct sobol *s,
                           uint64_t *rays);

#endif
