/* incident.h - the light that arrives at a point of a material, gathered for its fit from a field of light. */
#ifndef REMODEL_INCIDENT_H
#define REMODEL_INCIDENT_H

#include "common/gather/light_field.h"
#include "stages/fit_materials/material_samples.h"

struct incident_effort {
    int lobe_rays;    /* of each sample, spread over all angles from the mirror direction */
    int emitter_rays; /* of each point, to each emitter */
    int diffuse_rays; /* of each point */
};

/* Fills the irradiance and the lobes of samples first .. first + count - 1, which are one point seen from the unit
 * directions view[count]. shares[LIGHT_SOURCES], unless it is NULL, gets the share of the irradiance's luminance by
 * source (0 in the dark). `key` selects the random numbers. */
void incident_light_at(struct material_samples *s, int first, int count, const struct light_field *f, struct vec3 at,
                       struct vec3 normal, const struct vec3 *view, const struct incident_effort *effort, uint64_t key,
                       double *shares);

#endif
