/* ceiling_places.h - a grid of places below the ceilings of a model, where lamps may hang. */
#ifndef REMODEL_CEILING_PLACES_H
#define REMODEL_CEILING_PLACES_H

#include "common/light/model_rays.h"

struct ceiling_grid {
    const struct model_rays *rays;
    double spacing; /* of the grid, at least, as a part of the model's height */
    double below;   /* distance of a place from its ceiling, as a part of the room's height */
    int most;       /* places */
    bool (*may_be)(const void *ctx, struct vec3 at); /* which places are wanted; NULL: all */
    const void *ctx;
};

/* The distance of two places: `spacing`, or more if the model would have more than `most` on one storey. */
double ceiling_places_spacing(const struct ceiling_grid *g);

/* Fills places[], which has room for g->most, row by row, from below; returns how many there are. */
int ceiling_places_list(struct vec3 *places, const struct ceiling_grid *g);

#endif
