/* level_spread.h - how wide the interval of a value is: by how much it changes with the light of each group, and how
 * far that may be off.
 *
 * What a surface reflects is known from photographs, as its radiance over its irradiance: where a lamp is too bright
 * the reflectance is too low. So light that was reflected adds to a value as much as photographed, whatever lamps and
 * sky are, and errors of a group count by its direct light; in states that are not the photographed one also by the
 * part of the reflected light that the state has more or less of it. */
#ifndef REMODEL_LEVELS_SPREAD_H
#define REMODEL_LEVELS_SPREAD_H

#include "stages/light_levels/level_sums.h"
#include "stages/light_levels/light_errors.h"

/* {0} is the empty state; everything is owned. */
struct level_spread {
    double *by;   /* of each group of the errors: the change of the value over the relative change of the group */
    double known; /* part of the value that is light of the photographs */
    int count;
};

/* The caller releases s in each case. ST_NOMEM. */
enum status level_spread_init(struct level_spread *s, const struct light_errors *e, struct err *err);
void level_spread_release(struct level_spread *s);
void level_spread_clear(struct level_spread *s);

/* Light at a place, by the groups of the errors; of the state all that is reflected there. */
struct spread_place {
    const float *whole, *direct;
    double reflected;
};

/* Adds a place to the value, with a weight. factor: of light of the photographs. */
void level_spread_add(struct level_spread *s, const struct spread_place *at, const struct state_weights *w,
                      double factor, double weight);
/* The same of a point; factors: of light of the photographs and of other light. */
void level_spread_add_point(struct level_spread *s, const struct level_points *p, int point,
                            const struct light_groups *g, const struct state_weights *w, const double factors[2],
                            double weight);

/* The ends of the interval of 95 %, as factors of the value. variance: more of it, of the logarithm, to both sides. */
void level_spread_ends(double ends[2], const struct level_spread *s, double value, const struct light_errors *e,
                       const struct light_groups *g, const struct state_weights *w, const struct levels_params *params,
                       const double variance[2]);

#endif
