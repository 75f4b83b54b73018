/* unseen_fit.h - lamps that nobody marked, from the light that they throw on textured faces. */
#ifndef REMODEL_FIT_LIGHTS_UNSEEN_FIT_H
#define REMODEL_FIT_LIGHTS_UNSEEN_FIT_H

#include "common/gather/atlas_squares.h"
#include "stages/fit_lights/bright_ceilings.h"

enum { MAX_UNSEEN = 16 };

/* A lamp below a ceiling that shines down, its intensity falling with the cosine. */
struct unseen_lamp {
    struct bright_place place; /* its middle and half sides along the model's axes; 0: unknown */
    double intensity[3];       /* straight down: irradiance at distance 1 */
    double error[3];           /* its relative standard error */
    double gain;               /* share of what was unexplained that it explains */
    struct vec3 brightest;     /* the square where it adds most to the other light, */
    int tile;                  /* its tile of the atlas, */
    double excess;             /* and how much that is, as a part of the other light there */
};

/* What is known of the textured faces. */
struct unseen_light {
    const struct atlas_squares *squares;
    double (*known)[3];                      /* irradiance of each square from all that is known */
    const struct model_rays *rays, *shadows; /* the model; what throws shadows, which may have furniture */
    /* whether no photograph shows what is at this place of a ceiling */
    bool (*may_be)(const void *ctx, struct vec3 at);
    const void *ctx;
    const struct bright_place *bright; /* places of ceilings that photographs show as bright */
    int bright_count;
};

/* Fits lamps at the bright places, then finds others one after another, each only if it explains much; at most
 * MAX_UNSEEN together. Adds their light to l->known. ST_NOMEM. Same bits for any number of threads. */
enum status unseen_fit(struct unseen_lamp *lamps, int *count, struct unseen_light *l, struct err *err);

/* Looks for a lamp on a stand or a wall that shines evenly to all sides: its place, to a quarter of a room's height,
 * and its luminance in all three colours. Found only if it explains much of what l->known leaves; its light is then
 * added to l->known. l->may_be is not asked. ST_NOMEM. Same bits for any number of threads. */
enum status unseen_fit_standing(struct unseen_lamp *lamp, bool *found, struct unseen_light *l, struct err *err);

/* The irradiance at a point from a lamp there of intensity 1. */
double unseen_lamp_factor(const struct model_rays *rays, const struct bright_place *lamp, struct vec3 at,
                          struct vec3 normal);

#endif
