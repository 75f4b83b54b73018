/* path_trace.h - light that a surface point reflects, and irradiance at a point: path tracing. Radiance along rays of
 * a camera: shared_paths.h.
 *
 * At each surface one light is sampled (next-event estimation), and one direction sampled from the brdf is followed.
 * The balance heuristic weights the two strategies. Paths end by Russian roulette, which does not change the
 * expectation; nothing is clamped. Units: radiance, scene-linear Rec.709. */
#ifndef REMODEL_SIMULATE_PATH_TRACE_H
#define REMODEL_SIMULATE_PATH_TRACE_H

#include "common/light/sobol.h"
#include "stages/simulate/light_sampling.h"

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
enum status path_world_read(struct world *w, const char *folder, const char *file, struct provenance *prov,
                            struct err *err);
/* Moves the sun of a scene that has one; degrees. */
enum status path_world_move_sun(struct world *w, double azimuth, double elevation, struct err *err);
void path_world_release(struct world *w);

struct path_ray {
    struct vec3 from, direction; /* unit */
};

/* The material at a point of a face that is no lamp. */
struct brdf path_surface(const struct world *w, const struct ray_hit *hit);

/* Light that reaches a surface point from one direction, found by sampling the lights or the brdf. Both strategies
 * together choose the direction with density light_pdf + that of brdf_eval(); divide by it. */
struct path_arrival {
    struct vec3 direction; /* unit, towards the light */
    struct rgb radiance;
    double light_pdf; /* 1/sr; 0 for light that sampling of the lights cannot find */
};

/* A surface point that a ray has hit, and one estimate of the light that reaches it. */
struct path_vertex {
    struct vec3 point, normal; /* the normal faces the ray */
    struct brdf brdf;
    struct rgb glow;
    struct path_arrival arrival[2];
    int arrivals;
};

/* The vertex where the second ray of a path hits; `view`: the direction that the ray comes from. Uses the groups of
 * random numbers from 3. Adds the number of rays traced to *rays. */
void path_vertex_make(struct path_vertex *v, const struct world *w, const struct ray_hit *hit, struct vec3 view,
                      const struct sobol *s, uint64_t *rays);

/* Radiance that a Lambertian vertex reflects, without its glow. */
struct rgb path_vertex_diffuse(const struct path_vertex *v);

/* One estimate of the irradiance on the front of a surface element: the integral of radiance times cosine. Group 0 of
 * the random numbers is left to the caller. */
struct rgb path_irradiance(const struct world *w, struct vec3 point, struct vec3 normal, const struct sobol *s,
                           uint64_t *rays);

#endif
