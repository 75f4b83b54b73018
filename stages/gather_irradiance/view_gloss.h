/* view_gloss.h - what the glossy materials in a view reflect towards it. */
#ifndef REMODEL_GATHER_VIEW_GLOSS_H
#define REMODEL_GATHER_VIEW_GLOSS_H

#include "stages/gather_irradiance/gather_job.h"

/* Of each pixel; {0} is the empty state, in which there are none. Owned. */
struct view_gloss {
    uint32_t *material;   /* 1 + the index of its material in materials.txt, 0: none */
    struct rgb *specular; /* the integral I_s, with k_s = 1; 0 for Lambert, for k_s = 0 and without a material */
};

/* For the points that the pixels show, of the faces (ids; 0: none) and with the irradiance found there. Says how many
 * rays it took. Same bits for any number of threads. ST_NOMEM. The caller releases it in each case. */
enum status view_gloss_gather(struct view_gloss *g, const struct gather_job *j, const struct view *view,
                              const struct gather_point *points, const int *faces, const struct irradiance *irradiance,
                              struct err *err);
void view_gloss_release(struct view_gloss *g);

#endif
