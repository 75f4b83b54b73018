/* path_trace.h - radiance along a ray, and irradiance at a point: path tracing.
 *
 * At each surface one light is sampled (next-event estimation), and one direction sampled from the brdf is followed.
 * The balance heuristic weights the two strategies. Paths end by Russian roulette, which does not change the
 * expectation; nothing is clamped. Units: radiance, scene-linear Rec.709. */
#ifndef REMODEL_SIMULATE_PATH_TRACE_H
#define REMODEL_SIMULATE_PATH_TRACE_H

#include "common/light/sobol.h"
#include "stages/simulate/lights.h"

/* A scene ready for tracing. */
struct world {
    struct scene scene;
    struct scene_geometry geometry;
    struct lights lights;
    int max_bounces;         /* reflections to follow; 0: no limit but Russian roulette */
    bool shell;              /* cameras see through furniture, which still reflects light and casts shadows */
    bool brdf_sampling_only; /* without next-event estimation: slower, with the same expectation (for tests) */
};

/* Reads FOLDER/FILE and prepares it for tracing. {0} is the empty state; on failure nothing has to be released. */
enum status world_read(struct world *w, const char *folder, const char *file, struct provenance *prov, struct err *err);
/* Moves the sun of a scene that has one; degrees. */
enum status world_move_sun(struct world *w, double azimuth, double elevation, struct err *err);
void world_release(struct world *w);

struct path_ray {
    struct vec3 from, direction; /* unit */
};

/* One estimate. Adds the number of rays traced to *rays. Group 0 of the random numbers is left to the caller. */
struct rgb path_radiance(const struct world *w, struct path_ray ray, const struct sobol *s, uint64_t *rays);

/* One estimate of the irradiance on the front of a surface element: the integral of radiance times cosine. */
struct rgb path_irradiance(const struct world *w, struct vec3 point, struct vec3 normal, const struct sobol *s,
                           uint64_t *rays);

#endif
