/* light_field.h - light that arrives at a point, by direction, as a gather of irradiance asks for it.
 *
 * A gather integrates over the hemisphere above a point what look() returns. look() answers for whatever there is: a
 * closed form in a test, or a textured model with its windows and lamps (model_field.h). Emitters do not add light.
 * They say where bright light may come from, so that an estimator can send more rays there: a lamp that look() returns
 * and no emitter names is still found, only with more noise. */
#ifndef REMODEL_LIGHT_FIELD_H
#define REMODEL_LIGHT_FIELD_H

#include "common/light/colour.h"
#include "common/light/ray_scene.h"

/* Where light came from: how far it can be trusted. */
enum light_source {
    LIGHT_NONE,        /* nothing is there */
    LIGHT_TEXTURE,     /* a texel that photographs show */
    LIGHT_SYNTHESISED, /* a texel that no photograph shows: synthesised, or of the default colour */
    LIGHT_SKY,         /* outdoors, from a lighting reference image or a photograph */
    LIGHT_SKY_GUESSED, /* outdoors, beyond the field of all of them */
    LIGHT_LAMP,        /* a lamp of lights.txt */
    LIGHT_MATERIAL,    /* a fitted material, by one nested gather */
    LIGHT_OBJECT,      /* furniture, and objects that an edit puts into the model */
    LIGHT_SOURCES
};

struct light_look {
    struct rgb radiance; /* towards the point that asks; never negative, never NaN */
    double distance;     /* of what is seen, in scene units; INFINITY outdoors */
    enum light_source source;
    int face; /* of a textured model: index of the face that is seen, or the number of faces + 2 k for the front of
                 further surface k, + 2 k + 1 for its back; -1: none, or the field does not say */
};

enum emitter_kind {
    EMITTER_DISK, /* centre, x, y: orthogonal half axes of equal length */
    EMITTER_QUAD, /* centre, x, y: half edges of a parallelogram; a lamp, or an opening through which the sky is seen */
    EMITTER_SUN   /* normal: the unit direction towards it; cone: cosine of its angular radius */
};

struct emitter {
    enum emitter_kind kind;
    struct vec3 centre, x, y,
        normal; /* normal: unit, towards the side that it shines to; EMITTER_SUN: away from the point */
    double cone;
    double luminance;      /* of its radiance, roughly: what the number of rays goes by */
    double beta, exponent; /* of a lamp: no light beyond this angle (radians) from the normal; cos^exponent within */
};

struct light_field {
    const void *ctx;
    /* What is seen from `from` in unit directions, for the rays whose bit in `active` is 1; elements of the others are
     * neither read nor written. Called by several threads at once. The origin may lie on a surface: the field sees to
     * it that the surface does not hide itself, given the unit normal of its side. */
    void (*look)(const void *ctx, const struct vec3 from[RAY_PACKET], struct vec3 normal,
                 const struct vec3 direction[RAY_PACKET], unsigned active, struct light_look seen[RAY_PACKET]);
    const struct emitter *emitters;
    int emitter_count;
};

#endif
