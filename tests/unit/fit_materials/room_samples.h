/* room_samples.h - samples of a floor in a glossy room, with the light of exact directions or of the stage's own
 * rays. */
#ifndef REMODEL_ROOM_SAMPLES_H
#define REMODEL_ROOM_SAMPLES_H

#include "stages/fit_materials/choose_material.h"
#include "stages/fit_materials/incident.h"
#include "tests/unit/glossy_room.h"

static const struct incident_effort room_effort = {1024, 128, 4096};

/* columns x rows points from `views` views; the floor's reflectance is `truth`; noise is a fraction of the radiance. */
static inline void room_samples(struct material_samples *s, const struct brdf *truth, int columns, int rows, int views,
                                double noise)
{
    const uint64_t seed = 5;
    struct glossy_room room;
    struct err err = ERR_INIT;
    struct brdf lobe = *truth;
    const struct rng rng = rng_make(seed, "room_samples", "noise");
    lobe.albedo = rgb_grey(0);
    room_make(&room, seed);
    const struct light_field field = room_field(&room);
    assert_int_equal(material_samples_init(s, columns * rows * views, &err), ST_OK);
    for (int p = 0; p < columns * rows; p++) {
        struct vec3 view[8];
        const struct vec3 at = room_grid_point(&room, p, columns, rows);
        const struct rgb e = room_irradiance(&room, at);
        for (int v = 0; v < views; v++) {
            const int i = p * views + v;
            view[v] = vec3_normalize(vec3_sub(room_viewer(&room, seed, v), at));
            struct rgb l = rgb_scale(rgb_multiply(truth->albedo, e), 1 / PI);
            if (truth->kind != BRDF_LAMBERT) l = rgb_add(l, room_reflection(&room, &lobe, at, view[v]));
            const double light[3] = {l.r, l.g, l.b};
            for (int c = 0; c < 3; c++) {
                s->radiance[3 * i + c] = light[c] * (1 + noise * room_normal(&rng, (uint64_t)i, (uint64_t)c));
                s->variance[3 * i + c] = pow(fmax(noise, 1e-3) * light[c], 2);
            }
            s->point[i] = p;
        }
        incident_light_at(s, p * views, views, &field, at, vec3_make(0, 0, 1), view, &room_effort, (uint64_t)p, NULL);
    }
}

#endif
