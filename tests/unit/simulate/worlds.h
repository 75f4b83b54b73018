/* worlds.h - helpers of the tests of simulate: scenes from text, means over many light paths. */
#ifndef REMODEL_TESTS_WORLDS_H
#define REMODEL_TESTS_WORLDS_H

#include "tests/unit/scratch.h"

#include "common/math/numbers.h"
#include "stages/simulate/shared_paths.h"
#include "tests/unit/common/light/near.h"

static inline struct world world_from(const char *text)
{
    struct world w = {0};
    struct err err = ERR_INIT;
    char *all = NULL;
    assert_true(asprintf(&all, "remodel-scene 2\n%s", text) > 0);
    scratch_write("scene.txt", all);
    free(all);
    assert_ok(path_world_read(&w, scratch, "scene.txt", NULL, &err), err);
    return w;
}

/* The mean of at least `paths` estimates, in stratified sets of 4096. */
static inline struct rgb mean_irradiance(const struct world *w, struct vec3 point, struct vec3 normal, int paths,
                                         int seed)
{
    const struct rng rng = rng_make((uint64_t)seed, "test", "irradiance");
    struct rgb sum = {0, 0, 0};
    uint64_t rays = 0;
    for (int done = 0; done < paths; done += 4096) {
        struct sobol s = sobol_make(&rng, (uint64_t)done, 4096);
        for (; s.sample < 4096; s.sample++) sum = rgb_add(sum, path_irradiance(w, point, normal, &s, &rays));
    }
    return rgb_scale(sum, 1.0 / ((paths + 4095) / 4096 * 4096));
}

/* The means of at least `paths` estimates of each ray in a group, in stratified sets of 1024. */
static inline void mean_radiances(struct rgb mean[SHARED_RAYS], const struct world *w,
                                  const struct path_ray ray[SHARED_RAYS], uint32_t active, int paths, int seed)
{
    const struct rng rng = rng_make((uint64_t)seed, "test", "radiance");
    uint64_t rays = 0;
    for (int i = 0; i < SHARED_RAYS; i++) mean[i] = rgb_make(0, 0, 0);
    for (int done = 0; done < paths; done += 1024) {
        struct sobol s = sobol_make(&rng, (uint64_t)done, 1024 * SHARED_RAYS);
        for (; s.sample < 1024; s.sample++) shared_paths_radiance(mean, w, ray, active, &s, &rays);
    }
    for (int i = 0; i < SHARED_RAYS; i++) mean[i] = rgb_scale(mean[i], 1.0 / ((paths + 1023) / 1024 * 1024));
}

/* The same for a single ray. */
static inline struct rgb mean_radiance(const struct world *w, struct vec3 from, struct vec3 direction, int paths,
                                       int seed)
{
    const struct path_ray ray[SHARED_RAYS] = {{from, vec3_normalize(direction)}};
    struct rgb mean[SHARED_RAYS];
    mean_radiances(mean, w, ray, 1, paths, seed);
    return mean[0];
}

#endif
