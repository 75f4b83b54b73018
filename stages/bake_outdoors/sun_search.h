/* sun_search.h - the direction of the sun from the patches that it throws on walls and floors. */
#ifndef REMODEL_SUN_SEARCH_H
#define REMODEL_SUN_SEARCH_H

#include "stages/bake_outdoors/sun_fit.h"

/* What a direction explains of the edges between bright and dark. */
struct sun_evidence {
    double score;    /* contrast over its chance deviation; larger is better */
    double contrast; /* mean natural logarithm of lit to unlit, across the edges of the patches */
    double agree;    /* share of the edges that are brighter on the side that should be lit */
    int border;      /* pairs of squares across the edges */
    double sure;     /* how far `agree` is beyond one half, in standard deviations of independent pairs */
};

/* {0} is the empty state. */
struct sun_search {
    bool found;
    struct sun_fit fit;           /* of the best direction, found or not */
    struct sun_evidence evidence; /* its own */
    double next;                  /* what the next best direction, far from it, explains beside it; a gain */
    double rival;                 /* how sure the next best direction, far from it, is */
    struct atlas_squares edges;   /* squares close to the edges of its patches; owned */
};

/* Looks for the direction over all patches at once. Nothing is found where no direction explains bright texels better
 * than chance does. The caller releases s, also after a failure. ST_NOMEM. Same bits for any number of threads. */
enum status sun_search(struct sun_search *s, const struct atlas_scene *scene, struct err *err);

void sun_search_release(struct sun_search *s);

#endif
